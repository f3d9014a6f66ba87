"""`mechsym report`: the answer first, what fails is named and loses nothing else, the same page for the same case."""

import json
import re
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.out.pdf import NAMES
from mechsym.report import case_report, html
from mechsym.report.build import digest

LINK = re.compile(r'(?:src|href)="(?!#)([^"]*)"')


def run(*words):
    return CliRunner().invoke(mechsym, ["report", *words], catch_exceptions=False)


def ids(text):
    return re.findall(r'\bid="([^"]+)"', text)


@pytest.fixture(scope="module")
def both():
    names = ("nunes-slider-crank", "nunes-hypocycloid")
    return [case_report(cases.load(name), ("cycle", "hinge")) for name in names]


@pytest.fixture(scope="module")
def text(both):
    return html(both, "22 November 2026")


def test_two_cases_side_by_side_on_one_page(both, text):
    assert text.index("Side by side") < text.index("The answer") < text.index("Contents") < text.index("Figure 1.")
    assert "22 November 2026" in text and all(one.digest in text for one in both)
    assert len(set(ids(text))) == len(ids(text)) > 15
    assert not LINK.findall(text) and "http-equiv" not in text
    numbers = [int(n) for n in re.findall(r"Figure (\d+)\.", text)]
    assert numbers == list(range(1, len(numbers) + 1)) and len(numbers) == 2
    assert {t for t in re.findall(r'<a href="#([^"]+)"', text)} <= set(ids(text))


def test_the_same_case_gives_the_same_page(both, text):
    assert html(both, "22 November 2026") == text


def test_what_is_missing_is_named_and_the_rest_is_there(both, text):
    assert [part.state for part in both[0].parts] == ["done", "left out"]
    assert "Hinge, guide and spring: this kind of engine has no hinge ([spring], [guide], [rollers], [limits])" in text


def test_every_value_stands_with_its_origin(text):
    assert text.count("<code>chamber.<wbr>bore</code>") == 2 and "where from" in text


def test_the_digest_changes_with_every_value():
    plain, other = cases.load("zotov-89"), cases.load("zotov-89", {"p0": "6 MPa"})
    of = [digest(one, {}) for one in (plain, other, cases.load("zotov-142"))]
    assert len({*of, digest(plain, {"p.csv": "1"}), digest(plain, {"p.csv": "2"})}) == 5
    assert of[0] == digest(cases.load("zotov-89"), {})


def test_json_carries_the_numbers_and_the_text_names_the_file(tmp_path):
    file = tmp_path / "r.html"
    done = run("nunes-slider-crank", "--parts", "cycle", "--out", str(file), "--json")
    told = json.loads(done.output)
    part = told["reports"][0]["parts"]["cycle"]
    assert part["state"] == "done" and part["result"]["power_kw"][0] > 0 and told["doubts"] == []
    assert told["written"] == [str(file)] and "prefers-color-scheme: dark" in file.read_text(encoding="utf-8")


@pytest.mark.parametrize("command", ["hinge", "forces", "simulate", "cycle"])
def test_numbers_of_a_part_have_the_units_of_its_command(tmp_path, command):
    def units_of(*words):
        answer = CliRunner().invoke(mechsym, [*words, "--json", "--with-units"], catch_exceptions=False)
        return json.loads(answer.stdout)["units"]

    page = str(tmp_path / "page.html")
    told = units_of("report", "zotov-89", "--parts", command, "--out", page)
    part = f"reports[0].parts.{command}.result."
    own = {path: unit for path, unit in units_of(command, "zotov-89").items() if path != "wall_s"}
    assert {
        path.removeprefix(part): unit for path, unit in told.items() if path.startswith(part)
    }.items() <= own.items()
    assert len(told) > 10


def test_units_are_obeyed_in_text_tables_and_axes(tmp_path):
    file = tmp_path / "r.html"
    run("nunes-slider-crank", "--parts", "cycle", "--out", str(file), "--units", "psi, hp")
    text = file.read_text(encoding="utf-8").partition('<h2 id="live-')[0]  # what simulates has units of its own
    assert " hp" in text and " psi" in text and not re.search(r"kW(?!.?h\))", text) and "MPa" not in text


def test_a_page_is_named_so_that_a_browser_opens_it(tmp_path):
    done = run("balandin", "--parts", "cycle", "--out", str(tmp_path / "mine"))
    assert done.exit_code == 0 and (tmp_path / "mine" / "balandin-report.html").is_file()


def test_an_own_case_fills_the_title_block(tmp_path):
    case = tmp_path / "mine.toml"
    case.write_text(
        cases.text("nunes-slider-crank") + '\n[report]\nproject = "Boat <7>"\nauthor = "A. B."\ndate = "May"\n'
    )
    run(str(case), "--parts", "cycle", "--out", str(tmp_path / "r.html"))
    text = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert "Boat &lt;7&gt;" in text and "<dd>A. B.</dd>" in text and "<dd>May</dd>" in text


def test_a_part_that_is_not_known_is_refused():
    done = CliRunner().invoke(mechsym, ["report", "zotov-89", "--parts", "cycel"])
    assert "did you mean 'cycle'" in str(done.exception)


def test_without_a_chromium_pdf_is_refused_before_the_work(monkeypatch, tmp_path):
    monkeypatch.setattr(shutil, "which", lambda name: None)
    done = CliRunner().invoke(mechsym, ["report", "zotov-89", "--pdf", "--out", str(tmp_path / "r.html")])
    assert "apt-get install chromium" in str(done.exception) and not list(tmp_path.iterdir())


@pytest.mark.slow
def test_a_chromium_prints_it(tmp_path):
    if not any(map(shutil.which, NAMES)):
        pytest.skip("no chromium is installed")
    done = run("nunes-slider-crank", "--parts", "cycle", "--pdf", "--out", str(tmp_path / "r.html"))
    assert done.exit_code == 0 and (tmp_path / "r.pdf").read_bytes().startswith(b"%PDF")


def test_a_measured_cycle_stands_in_the_report_without_the_writers_folders(tmp_path):
    file = tmp_path / "r.html"
    done = run("generator", "--parts", "cycle", "--out", str(file))
    text = file.read_text(encoding="utf-8")
    assert done.exit_code == 0 and "The measured cycles give a net IMEP of 3.7" in text and "Cycle by cycle" in text
    assert "generator-synthetic.csv" in text and str(Path(cases.__file__).parent) not in text


@pytest.mark.slow
def test_an_infeasible_hinge_is_on_the_first_page_and_loses_nothing(tmp_path):
    file = tmp_path / "r.html"
    done = run("zotov-89", "--parts", "cycle,hinge", "--set", "limits.roller_reaction=50 kN", "--out", str(file))
    text = file.read_text(encoding="utf-8")
    assert done.exit_code == 1 and "CANNOT be built: roller reaction" in text[: text.index("Contents")]
    assert "Figure 3." in text and "<code>limits.<wbr>roller_<wbr>reaction</code>" in text


@pytest.mark.slow
def test_a_refused_part_is_named_and_the_rest_is_there(tmp_path):
    file = tmp_path / "r.html"
    done = run("zotov-89", "--parts", "cycle,hinge", "--set", "retune.case=chmielewski", "--out", str(file))
    text = file.read_text(encoding="utf-8")
    assert done.exit_code == 2 and "could not be computed" in text[: text.index("Contents")] and "Figure 1." in text


def test_extremes_have_the_digits_that_the_larger_has():
    from mechsym.report.parts import _extremes

    assert _extremes({"max": 2610.4, "min": 0.7121, "unit": "N"}) == ["2.61 kN", "0.0007 kN"]
    assert _extremes({"max": -421.04, "min": -30981.0, "unit": "N"}) == ["-0.421 kN", "-30.98 kN"]
    assert _extremes({"max": 0.0, "min": 0.0, "unit": "N"}) == ["0 N", "0 N"]


def test_nothing_fires_in_a_stirling_engine():
    from mechsym import cases
    from mechsym.jobs.gas import gas

    told = {name: gas(cases.load(name)).view.pictures[0].see for name in ("alpha-stirling", "zotov-89")}
    assert "over the crank angle" in told["alpha-stirling"] and "firing dead centre" in told["zotov-89"]

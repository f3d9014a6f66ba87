"""What people read: no digits of round-off, every heading with its unit, the same in JSON and CSV as ever in SI."""

import csv
import html
import json
import re

import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym

ENGINES = sorted(set(cases.names()) - {"chmielewski", "generator"})
TEXTS = [
    *((command, name) for command in ("cycle", "forces") for name in ENGINES),
    ("hinge", "zotov-89"), ("hinge", "zotov-142"), ("size", "nunes-hypocycloid"),
    ("optimise", "nunes-hypocycloid"), ("flywheel", "zotov-89", "--ripple", "2%"), ("check", "zotov-89"),
    ("compare", "nunes-slider-crank", "nunes-hypocycloid", "--speeds", "2000,6000"),
    ("report", "zotov-89", "--parts", "cycle,hinge,forces"),
    pytest.param(("report", "generator", "nunes-slider-crank"), marks=pytest.mark.heavy),
    ("codesign", "zotov-89", "--ripple", "2%"), ("simulate", "chmielewski", "--no-check"),
    ("simulate", "alpha-stirling", "--set", "simulation.turns=3"), ("eval", "crosshead", "--case", "zotov-89"),
    ("reproduce", "prymak"), ("reproduce", "moroianu2017"), ("sections", "spring"), ("mechanisms",), ("cases",),
    ("audit", "--source", "prymak"),
]  # fmt: skip
TABLES = [("hinge", "zotov-89"), ("forces", "opposed-pistons"), ("forces", "balandin"), ("forces", "nunes-hypocycloid"),
          ("cycle", "nunes-slider-crank"),
          ("compare", "nunes-slider-crank", "nunes-hypocycloid", "--speeds", "2000,6000"),
          pytest.param(("sweep", "nunes-slider-crank", "--over", "chamber.compression_ratio=8..14:2"),
                       marks=pytest.mark.heavy),
          ("sweep", "nunes-hypocycloid", "--of", "forces", "--over", "speed_rpm=2000,3000"),
          *(pytest.param(("sweep", *words), marks=pytest.mark.heavy)
            for words in (("nunes-hypocycloid", "--of", "size", "--over", "speed_rpm=4000"),
                          ("balandin", "--of", "forces", "--over", "speed_rpm=1500"),
                          ("zotov-89", "--show", "all", "--over", "spring.p0=5 MPa"))),
          ("size", "nunes-slider-crank"), ("flywheel", "zotov-89"),
          ("simulate", "alpha-stirling", "--set", "simulation.turns=3")]  # fmt: skip
WITHOUT = re.compile(
    r"^(source|mechanism|verdict|note|failure|phi_deg|quantity|unit|a|b|guide\.reason|status|end"  # words
    r"|component|value|limit|safety_factor|rule|wanted|holds"  # rows that each have a unit of their own
    r"|.*_(rad_s|rpm|bar|mpa|kpa|kw|deg|g_kwh|pa|k|m3|n|nm|j))$"
)


# every command that a case can run, but those above
_MORE = {
    "eval": (), "forces": (), "cycle": (), "hinge": (), "size": (), "simulate": ("--set", "simulation.turns=2"),
    "flywheel": (), "report": (), "optimise": (),
}  # fmt: skip


def run(*words):
    return CliRunner().invoke(mechsym, [*words], catch_exceptions=False)


def read(page):
    """What stands in a page, without its figures."""
    bare = re.sub(r"(?s)<(svg|style|script)\b.*?</\1>", " ", page.read_text(encoding="utf-8"))
    return html.unescape(re.sub(r"<[^>]+>", " ", bare)).replace("\u2011", "-")


def round_off(text):
    """Digit strings that no one measured; the usual tolerance, 1e-10, may be told."""
    tiny = [n for n in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?e-\d+", text) if 0 < abs(float(n)) < 1e-10]
    long = re.findall(r"\d+\.\d{12,}", text)
    return tiny + [n for n in long if len(n.replace(".", "").lstrip("0")) > 12]


def test_digits_of_round_off_are_seen(tmp_path):
    page = tmp_path / "a.html"
    page.write_text("<p>margin <b>2.9e\u201117</b> 1e-10 0.5661</p><svg>3e-16</svg><td>0.30000000000000004</td>")
    assert round_off(read(page)) == ["2.9e-17", "0.30000000000000004"]


@pytest.mark.slow
@pytest.mark.parametrize("words", TEXTS, ids=" ".join)
def test_no_digits_of_round_off(words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # report writes into the working folder
    text = "\n".join([run(*words).output, *map(read, tmp_path.rglob("*.html"))])
    assert text and not round_off(text), round_off(text)
    assert not re.findall(r"\b\d{3}_[0-9a-f]{16}\b", text)  # a source has a name


@pytest.mark.slow
@pytest.mark.heavy
@pytest.mark.parametrize("name", cases.names())
def test_no_digits_of_round_off_in_any_command_of_a_case(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    able = [c for c, missing in json.loads(run("check", name, "--json").output)["commands"].items() if not missing]
    found = {}
    for command in sorted({*able, "report"} & set(_MORE)):
        more = _MORE[command] if command != "simulate" or "cycle" in able else ()
        words = ("eval", cases.load(name).mechanism, "--case", name) if command == "eval" else (command, name, *more)
        done = run(*words)
        assert done.exit_code in (0, 1) or "diagram" in done.output, done.output
        found[command] = round_off(done.output)
    found["pages"] = [n for page in tmp_path.rglob("*.html") for n in round_off(read(page))]
    assert {command: tiny for command, tiny in found.items() if tiny} == {}


@pytest.mark.slow
@pytest.mark.parametrize("words", TABLES, ids=" ".join)
def test_every_column_has_its_unit(words, tmp_path):
    run(*words, "--out", str(tmp_path))
    files = list(tmp_path.glob("*.csv"))
    assert files
    for file in files:
        names = next(csv.reader(file.read_text(encoding="utf-8").splitlines()))
        assert [name for name in names if not re.search(r" \[[^\]]+\]$", name) and not WITHOUT.match(name)] == []


def test_json_stays_in_si():
    plain, chosen = (
        json.loads(run("cycle", "moroianu", "--json", *more).output) for more in ([], ["--units", "kN*m, hp"])
    )
    assert plain == chosen


def test_the_case_may_choose_the_units(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(cases.text("moroianu") + '\n[report]\nunits = "kN*m, hp, bar"\n')
    assert "power [hp]" in run("cycle", str(path)).output and "power [kW]" in run("cycle", "moroianu").output
    assert "power [PS]" in run("cycle", str(path), "--units", "PS").output

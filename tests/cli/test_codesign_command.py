"""`mechsym codesign` on two speeds of the marine engine: its JSON, its exit status, its report, bad input."""

import html
import json
import re
from pathlib import Path

import pytest
from captions import numbers_of, unsaid
from pictures import drawn, faults, ids

from mechsym.cli import main

COMPRESSOR = str(Path(__file__).parents[2] / "examples" / "mechanisms" / "compressor.toml")

KEYS = {
    "status", "flywheel_inertia", "flywheel_inertia_bare", "speed_rpm", "load", "speed_ripple", "p0", "bound", "active",
    "verified", "losses", "misfire_speed_share", "doubts",
}  # fmt: skip


def run(monkeypatch, *words):
    monkeypatch.setattr("sys.argv", ["mechsym", "codesign", *words])
    with pytest.raises(SystemExit) as stop:
        main()
    return stop.value.code or 0


def test_parts_of_a_spring_are_refused(monkeypatch, capsys):
    assert run(monkeypatch, "zotov-89", "--set", "codesign.springs=1.5") == 2
    assert "springs = 1.5" in capsys.readouterr().err


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """One run with files: its JSON, its figures."""
    folder = tmp_path_factory.mktemp("codesign")
    with pytest.MonkeyPatch.context() as patch, pytest.MonkeyPatch.context() as echo:
        said = []
        echo.setattr("click.echo", lambda text="", **_: said.append(str(text)))
        figures = drawn(patch)
        code = run(patch, "zotov-89", "--speeds", "89,142", "--pareto", "2,5%", "--cylinders", "2", "--realise",
                   "gas_volume", "--json", "--out", str(folder))  # fmt: skip
    return code, json.loads(said[0]), folder, figures


@pytest.mark.slow
def test_json_of_two_speeds(done):
    code, numbers, *_ = done
    assert code == 0
    assert set(numbers) >= KEYS
    assert numbers["status"] == "optimal"
    assert numbers["speed_rpm"] == pytest.approx([89, 142])
    assert 0 < numbers["flywheel_inertia"] < numbers["flywheel_inertia_cut_for_one"] < numbers["flywheel_inertia_bare"]
    assert len(numbers["p0"]) == 1 and len(numbers["p0"][0]) == 2
    assert numbers["bound"]["swing"][1] == 0.0  # two springs are two guides for two speeds
    for way in ("steady_ripple", "time_ripple"):
        assert numbers["verified"][way] == pytest.approx(numbers["speed_ripple"], rel=5e-3)
    assert {row["limit"] for row in numbers["active"]} >= {"ripple"}
    used, guide = numbers["verified"]["used"], numbers["guides"][0]
    assert used["spring_pressure"] == pytest.approx(guide["spring_pressure_max"] / 25e6)
    assert used["closing_share"] == pytest.approx(guide["z_max"] / guide["H"] / 0.9)
    assert used["hertz_stress"] == pytest.approx(guide["hertz_stress_max"] / 1500e6)
    assert max(used.values()) < 1.005
    assert [row["ripple"] for row in numbers["pareto"]] == [0.02, 0.05]
    assert all(0.1 < share < 0.25 for share in numbers["losses"]["share"])
    assert numbers["misfire_speed_share"] == [0.0, 0.0]  # so small a flywheel does not survive one
    assert numbers["doubts"] == []


@pytest.mark.slow
def test_what_captions_say_is_drawn(done):
    _, _, folder, figures = done
    page = html.unescape((folder / "report.html").read_text(encoding="utf-8"))
    told = re.findall(r"(?s)<figure[^>]*>.*?<title[^>]*>(.*?)</title>.*?<figcaption>(.*?)</figcaption>", page)
    titles = {figure.get_label(): figure for figure in figures}
    shown = {title: see for title, see in told if title in titles}
    assert len(shown) >= 6 and sum(len(numbers_of(see)) for see in shown.values()) >= 10
    assert {see: missing for title, see in shown.items() if (missing := unsaid(see, titles[title]))} == {}


@pytest.mark.slow
def test_more_cylinders_and_other_hardware(done):
    _, numbers, *_ = done
    one, two = numbers["cylinders"]
    assert one["flywheel_inertia_bare"] == pytest.approx(numbers["flywheel_inertia_bare"])
    # D_1 by the ripple is the estimate of all that turns, on the mean
    own = numbers["bound"]["estimate"][0] - numbers["rollers_inertia"] - one["flywheel_inertia_estimate"]
    assert own == pytest.approx(115, abs=5)
    assert two["flywheel_inertia_bare"] < one["flywheel_inertia_bare"]
    made, (guide,) = numbers["realised"], numbers["realised"]["guides"]
    assert made["status"] == "optimal" and made["after"][0] < made["before"][0]
    assert made["after"][0] == pytest.approx(guide["A"] * guide["H"], rel=1e-6)


@pytest.mark.slow
def test_texts_of_its_figures_keep_clear(done):
    _, _, folder, figures = done
    assert len(figures) == 8
    assert {figure.get_label(): faults(figure) for figure in figures if faults(figure)} == {}
    assert not ids((folder / "report.html").read_text())


@pytest.mark.slow
def test_report_says_what_kills_it(done):
    _, numbers, folder, _ = done
    page = (folder / "report.html").read_text()
    assert "nan" not in re.sub(r"<svg.*?</svg>", "", page, flags=re.S).lower()
    for words in (
        "What to make",
        "What it holds",
        "What it costs",
        "What kills it",
        "How sure",
        "the shaft stops",
        "scavenge step",
        "controller:",
        "leak:",
        "start:",
        "swings back and rests at",
    ):
        assert words in page
    assert (folder / "guide.csv").read_text().splitlines()[0].startswith("theta [rad],rho [m]")
    names = {p.name for p in folder.iterdir()}
    assert names >= {"summary.json", "points.csv", "front.svg", "works.svg", "map.svg", "spread.svg", "scenarios.svg"}


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--free", "spring.n"), "free"),
        (("--curve", "river"), "curve"),
        (("--ripple", "2 kg"), "--ripple"),
        (("--speeds", "60,60"), "speeds"),
        (("--robust", "guide.rho0=1%"), "spring.p0"),
        (("--set", "codesign.scavenge=mep)"), "scavenge"),
        (("--pareto", "0,5%"), "--pareto"),
        (("--realise", "beauty"), "goal"),
    ],
)
def test_bad_input_is_one_line(monkeypatch, capsys, words, message):
    assert run(monkeypatch, "zotov-89", *words) == 2
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert message in line


@pytest.mark.parametrize(
    ("case", "words", "message"),
    [
        ("moroianu", (), "this kind of engine has no hinge"),
        ("generator", ("--speeds", "2000,3000"), "the diagram is of 3000.01 rpm and not at 2000 rpm"),
        ("generator", ("--loads", "0.5,1"), "it has one load"),
    ],
)
def test_other_cases_say_what_is_missing(monkeypatch, capsys, case, words, message):
    assert run(monkeypatch, case, *words) == 2
    assert message in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize(("case", "words"), [("generator", ()), (COMPRESSOR, ("--speeds", "600,900"))])
def test_a_case_without_the_section_has_its_own_speed_and_load(monkeypatch, capsys, case, words):
    assert run(monkeypatch, case, "--json", *words) == 0
    numbers = json.loads(capsys.readouterr().out)
    assert numbers["flywheel_inertia"] == pytest.approx(0, abs=1e-6) and numbers["flywheel_inertia_bare"] > 0.01
    assert numbers["verified"]["steady_ripple"] == pytest.approx(numbers["verified"]["time_ripple"], rel=1e-3)
    # what takes work has no combustion to lose
    assert (numbers["misfire_speed_share"][0] is None) == (case == COMPRESSOR)


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        ("--set", "limits.roller_reaction=10 kN"),  # the mass of the rollers alone asks for more
        ("--set", "limits.roller_reaction=50 kN"),
        ("--set", "limits.pressure_angle=1 deg"),
        ("--set", "limits.spring_pressure=1 MPa"),
        ("--ripple", "0.01%"),
    ],
)
def test_hardly_possible_tasks_end_with_the_bound(monkeypatch, capsys, words):
    code = run(monkeypatch, "zotov-89", "--speeds", "60,142", "--json", *words)
    numbers = json.loads(capsys.readouterr().out)
    assert code == (0 if numbers["feasible"] else 1)
    assert numbers["feasible"] == (words == ("--ripple", "0.01%"))  # a heavy flywheel is no hinge
    assert numbers["feasible"] or numbers["reason"]
    assert not (numbers["feasible"] and numbers["verified"]["broken"])
    assert numbers["bound"]["total_inertia"][0] >= 0
    assert not numbers["feasible"] or numbers["total_inertia"] >= numbers["bound"]["total_inertia"][0]

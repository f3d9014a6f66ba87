"""What people read: no digits of round-off, every heading with its unit, the same in JSON and CSV as ever in SI."""

import json
import re

import pytest
from click.testing import CliRunner
from tables import read_table

from mechsym import cases
from mechsym.cli import mechsym

ENGINES = sorted(set(cases.names()) - {"chmielewski", "generator"})
TEXTS = [
    *((command, name) for command in ("cycle", "forces") for name in ENGINES),
    ("hinge", "zotov-89"), ("hinge", "zotov-142"), ("size", "nunes-hypocycloid"),
    ("optimise", "nunes-hypocycloid"), ("flywheel", "zotov-89", "--ripple", "2%"), ("check", "zotov-89"),
    ("compare", "nunes-slider-crank", "nunes-hypocycloid", "--speeds", "2000,6000"),
    ("report", "zotov-89", "--parts", "cycle,hinge,forces"), ("report", "generator", "nunes-slider-crank"),
    ("codesign", "zotov-89", "--ripple", "2%"), ("simulate", "chmielewski", "--no-check"),
    ("simulate", "alpha-stirling", "--set", "simulation.turns=3"), ("eval", "crosshead", "--case", "zotov-89"),
    ("reproduce", "prymak"), ("reproduce", "moroianu2017"), ("sections", "spring"), ("mechanisms",), ("cases",),
    ("audit", "--source", "prymak"),
]  # fmt: skip
TABLES = [("hinge", "zotov-89"), ("forces", "opposed-pistons"), ("forces", "balandin"), ("forces", "nunes-hypocycloid"),
          ("cycle", "nunes-slider-crank"), ("simulate", "alpha-stirling", "--set", "simulation.turns=3")]  # fmt: skip
WITHOUT = re.compile(
    r"^(source|mechanism|verdict|note|failure|phi_deg|.*_(rpm|bar|mpa|kpa|kw|deg|g_kwh|pa|k|m3|n|nm|j))$"
)


def run(*words):
    return CliRunner().invoke(mechsym, [*words], catch_exceptions=False)


@pytest.mark.slow
@pytest.mark.parametrize("words", TEXTS, ids=" ".join)
def test_no_digits_of_round_off(words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # report writes into the working folder
    text = run(*words).output
    tiny = [
        n for n in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?e-\d+", text) if 0 < abs(float(n)) < 1e-10
    ]  # the usual tolerance may be told
    long = re.findall(r"\d\.\d{12,}", text)
    assert text and not tiny + long, tiny + long
    assert not re.findall(r"\b\d{3}_[0-9a-f]{16}\b", text)  # a source has a name


@pytest.mark.slow
@pytest.mark.parametrize("words", TABLES, ids=" ".join)
def test_every_column_has_its_unit(words, tmp_path):
    run(*words, "--out", str(tmp_path))
    files = list(tmp_path.glob("*.csv"))
    assert files
    for file in files:
        _, units = read_table(file)
        assert [name for name, unit in units.items() if not unit and not WITHOUT.match(name)] == [], file.name


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

"""The command `size`: exit status, JSON keys, files."""

import csv
import json

import pytest
from click.testing import CliRunner

from mechsym.cli.size import size
from mechsym.sizing.rows import COLUMNS

STEP = ("--set", "sizing.speed_step=500 rpm", "--set", "sizing.rival=")


def run(*args):
    return CliRunner().invoke(size, args)


def test_sized_engine_holds_and_is_written(tmp_path):
    result = run("nunes-slider-crank", "--json", "--out", str(tmp_path), "--set", "sizing.speed_step=500 rpm")
    assert result.exit_code == 0, result.output
    rows = json.loads(result.stdout)
    assert set(rows[0]) == set(COLUMNS)
    assert {"component", "quantity", "value", "unit", "limit", "safety_factor", "rule", "source"} <= set(rows[0])
    assert all(row["holds"] in (True, None) for row in rows)
    assert any(row["quantity"].startswith("crossover") for row in rows)
    with (tmp_path / "parts.csv").open() as file:
        assert len(list(csv.DictReader(file))) == len(rows)
    assert json.loads((tmp_path / "parts.json").read_text()) == rows
    assert "<svg" in (tmp_path / "section.svg").read_text()


def test_printed_parts_end_with_status_1():
    result = run("nunes-hypocycloid", "--as-printed", "--json", "--set", "sizing.speed_step=500 rpm")
    assert result.exit_code == 1
    failing = [row for row in json.loads(result.stdout) if row["holds"] is False]
    assert any(row["component"] == "output shaft" and row["safety_factor"] < 0.5 for row in failing)


def test_text_marks_what_is_below():
    result = run("nunes-hypocycloid", "--as-printed", "--set", "sizing.speed_step=500 rpm")
    assert "BELOW  output shaft" in result.stdout and "are below the wanted ones" in result.stdout


@pytest.mark.slow
@pytest.mark.parametrize("args", [
    ("nunes-slider-crank", "--as-printed"), ("nunes-hypocycloid", "--set", "sizing.life=5 m"),
    ("nunes-hypocycloid", "--set", "sizing.gears=steel"), ("nunes-hypocycloid", "--set", "part_bearings.main=6099"),
])  # fmt: skip
def test_bad_input_is_refused(args):
    from mechsym.errors import BadInput

    result = run(*args)
    assert isinstance(result.exception, BadInput)

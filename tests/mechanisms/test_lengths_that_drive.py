"""A coordinate that is a length: a rack, a cylinder."""

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym.cli import mechsym
from mechsym.derive import files
from mechsym.errors import BadInput

PAGE = (Path(__file__).parents[2] / "docs" / "own-mechanism.md").read_text()


def block(name):
    return re.search(rf"```\w+ file={re.escape(name)}\n(.*?)```", PAGE, re.DOTALL)[1]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("boom.py", "boom.toml"):
        Path(name).write_text(block(name))
    return tmp_path


def run(*words):
    done = CliRunner().invoke(mechsym, [str(w) for w in words])
    assert done.exit_code == 0, (words, done.output, done.exception)
    return done.output


def test_a_cylinder_bears_what_virtual_work_says(folder):
    """Slowly: F ds = m g dy, by the angle of the triangle foot, pivot, top."""
    s, foot, pin, weight = 1.25, 0.5 - 0.3j, 1.2 - 0.05j, 1.5 + 0.1j
    between = np.arccos((abs(foot) ** 2 + abs(pin) ** 2 - s**2) / (2 * abs(foot) * abs(pin)))
    turned = np.exp(1j * (np.angle(foot) + between - np.angle(pin)))
    top, weight = pin * turned, weight * turned
    arm = top - foot
    assert abs(arm) == pytest.approx(s, abs=1e-12)
    slope = s / (1j * top * np.conj(arm)).real  # of the angle by s
    run("forces", "boom.toml", "--set", "motion.duration=1000 s", "--out", "slow")
    with open("slow/forces.csv") as file:
        rows = [{n.partition(" [")[0]: float(v) for n, v in row.items()} for row in csv.DictReader(file)]
    row = min(rows, key=lambda row: abs(row["s"] - s))
    exact = 300 * 9.81 * (1j * weight).imag * slope
    assert row["driving_s"] == pytest.approx(exact, rel=2e-3)


def test_its_drawing_says_where_the_length_stands(folder):
    run("derive", "./boom.py", "--draw", "--out", "drawn")
    text = (folder / "drawn/boom.svg").read_text()
    assert "s = 1100 mm" in text and "crank" not in text


def test_a_pose_without_the_length_is_told_what_it_lacks(folder):
    Path("boom.py").write_text(block("boom.py").replace('    m.pose(s="1.1 m")\n', ""))
    done = CliRunner().invoke(mechsym, ["derive", "./boom.py", "--draw"])
    assert done.exit_code == 2 or isinstance(done.exception, BadInput)
    assert "m.pose(s=..)" in done.output + str(done.exception)


def test_one_mechanism_of_a_file_runs_beside_another_that_is_refused(folder):
    Path("two.py").write_text(block("boom.py") + "\n\ndef other():\n    return Mechanism('other').no_such_thing\n")
    assert files.chosen(Path("two.py"), "boom").name == "boom"
    with pytest.raises(BadInput, match=r"two\.py:\d+: AttributeError"):
        files.chosen(Path("two.py"), "other")
    with pytest.raises(BadInput, match=r"two\.py:\d+: AttributeError"):
        files.chosen(Path("two.py"))


def test_check_reads_a_file_of_the_working_folder(folder):
    told = json.loads(run("check", "boom.toml", "--json"))
    assert told["skipped"] == [] and told["problems"] == []
    Path("boom.py").write_text(block("boom.py").replace('inputs("F", "N")', 'inputs("F", "N*m")'))
    done = CliRunner().invoke(mechsym, ["check", "boom.toml"])
    assert done.exit_code == 2 or isinstance(done.exception, BadInput)
    assert "boom.py:" in done.output + str(done.exception)

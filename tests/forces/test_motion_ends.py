"""Motions that end by themselves, and that repeat: a disc and a slide, whose forces are I theta'' and m s''."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.jobs.forces import motion

PARTS = """
from mechsym.derive import Mechanism

def disc():
    m = Mechanism("disc", about="A disc.")
    a = m.coordinates("a")
    m.pin("O", m.frame, m.link("disc", turns=a, mass="3 kg", inertia="2 kg*m^2"))
    m.torque(m.inputs("T", "N*m"), along=a)
    return m

def arm():
    m = Mechanism("arm", about="An arm.")
    a = m.coordinates("a")
    m.pin("O", m.frame, m.link("arm", turns=a, mass="3 kg", centre=("0.2 m", 0), inertia="0.1 kg*m^2"))
    m.torque(m.inputs("T", "N*m"), along=a)
    return m

def slide():
    m = Mechanism("slide", about="A slide.")
    s = m.coordinates("s", "m")
    m.body("slide", mass="5 kg", at=(s, 0))
    m.force(m.inputs("F", "N"), along=s)
    return m
"""
RATE = 2 * np.pi  # of what repeats every second [rad/s]


@pytest.fixture
def moved(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "parts.py").write_text(PARTS)
    t = np.linspace(0, 1, 73)
    turns = np.degrees(RATE * t + 0.1 * np.sin(RATE * t))
    for name, values in (("a [deg]", turns), ("s [mm]", 200 * np.cos(RATE * t))):
        rows = [f"{x:.12g}, {value:.12g}" for x, value in zip(t, values, strict=True)]
        (tmp_path / f"{name[0]}.csv").write_text("\n".join([f"t [s], {name}", *rows]) + "\n")

    def driven(part, section):
        (tmp_path / "case.toml").write_text(f'mechanism = "./parts.py:{part}"\n[motion]\n{section}\n')
        return motion(cases.load("case.toml")).columns

    return driven


def test_an_even_turn_ends_after_one_turn(moved):
    table = moved("disc", 'a = "300 rpm"')
    assert table["t"][-1] == pytest.approx(0.2, rel=1e-12)
    assert table["a"][-1] - table["a"][0] == pytest.approx(2 * np.pi, rel=1e-12)
    assert table["driving_a"] == pytest.approx(np.zeros(len(table["t"])), abs=1e-9)


def test_an_angle_of_a_file_that_repeats_goes_on_turn_by_turn(moved):
    table = moved("disc", 'file = "a.csv"\nperiodic = true\nt_end = "3 s"')
    t = table["t"]
    assert table["a"] == pytest.approx(RATE * t + 0.1 * np.sin(RATE * t), abs=1e-9)
    assert table["driving_a"] == pytest.approx(-2 * 0.1 * RATE**2 * np.sin(RATE * t), abs=1e-4)
    assert table["power_a"] == pytest.approx(table["driving_a"] * table["ad"], abs=1e-12)


def test_a_length_of_a_file_that_repeats_comes_back(moved):
    table = moved("slide", 'file = "s.csv"\nperiodic = true\nt_end = "3 s"')
    t = table["t"]
    assert table["s"] == pytest.approx(0.2 * np.cos(RATE * t), abs=1e-9)
    assert table["driving_s"] == pytest.approx(-5 * 0.2 * RATE**2 * np.cos(RATE * t), abs=1e-4)


def test_files_and_work_of_a_motion(moved, tmp_path):
    moved("slide", 's = "cycloid"\nrise = "100 mm"\nduration = "0.5 s"')
    result = CliRunner().invoke(mechsym, ["forces", "case.toml", "--out", "out", "--json"], catch_exceptions=False)
    told = json.loads(result.stdout)
    assert {file.name for file in (tmp_path / "out").iterdir()} >= {"forces.csv", "summary.json", "driving.svg"}
    assert told["t_end"] == 0.5 and told["work"]["s"] == pytest.approx(0.0, abs=1e-6)  # it begins and ends at rest
    # a cycloid of rise h in T: s'' = 2 pi h / T^2 sin(2 pi t / T)
    assert told["max"]["driving_s"] == pytest.approx(5 * 2 * np.pi * 0.1 / 0.5**2, rel=1e-4)
    text = CliRunner().invoke(mechsym, ["forces", "case.toml"], catch_exceptions=False).stdout
    assert "work of the drive of s: " in text


@pytest.mark.parametrize(("part", "seen"), [("disc", False), ("arm", True)])
def test_a_link_that_moves_is_seen_to_move_where_it_has_an_extent(moved, tmp_path, part, seen):
    moved(part, 'a = "300 rpm"')
    for command in (["forces", "case.toml", "--out", "out"], ["report", "case.toml", "--out", "r.html"]):
        assert CliRunner().invoke(mechsym, command, catch_exceptions=False).exit_code == 0
    assert (tmp_path / "out" / "mechanism.html").exists() == seen

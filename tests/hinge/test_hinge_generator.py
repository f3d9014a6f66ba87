"""The hinge of a four-stroke engine from its measured diagram: on a half-speed shaft, or for what repeats each turn."""

import dataclasses
import json
import math
import sys

import numpy as np
import pytest
from tables import read_table

from mechsym import cases
from mechsym.cli import main
from mechsym.files import to_json
from mechsym.hinge import shown
from mechsym.hinge import steady as steadiness
from mechsym.hinge.guide import crank_torque
from mechsym.hinge.summary import HingeNumbers
from mechsym.jobs import hinge as design
from mechsym.machine.loads import ConstantLoad, PropellerLoad
from mechsym.quantities.results import tell


@pytest.fixture(scope="session")
def diagram(measured_data):
    return str(measured_data / "generator-half-load.csv")


@pytest.fixture(scope="session")
def generator(diagram):
    return design(cases.load("generator"), diagram)


@pytest.mark.slow
def test_hinge_on_a_half_speed_shaft_can_be_built(generator):
    numbers = tell(HingeNumbers(judged=generator))
    assert numbers["guide"]["feasible"] and numbers["guide"]["margin"] > 0
    assert generator.hinge.period == pytest.approx(4 * math.pi)
    assert generator.guide.parameters.shaft_ratio == 0.5
    assert generator.guide.rho.x[-1] == pytest.approx(2 * math.pi)
    assert abs(generator.hinge.mean_torque) < 1e-9 * -generator.hinge.torque_min
    for load in ("constant", "propeller"):
        assert numbers["runs"][f"hinge_{load}"]["speed_ripple"] < 1e-6


def test_virtual_work_returns_the_torque(generator, rng):
    phi = rng.uniform(0, 4 * math.pi, 20_000)
    given = crank_torque(generator.guide, phi)
    assert np.abs(given - generator.hinge.torque(phi)).max() < 1e-8 * -generator.hinge.torque_min


def test_both_ways_are_offered_with_the_ripple_they_leave(generator):
    whole, every = tell(HingeNumbers(judged=generator))["offers"]
    assert (whole["balance"], whole["shaft_ratio"]) == ("whole_cycle", 0.5)
    assert (every["balance"], every["shaft_ratio"]) == ("every_turn", 1.0)
    assert whole["ripple_constant_load"] == whole["ripple_propeller_load"] == whole["work_left"] == 0
    assert every["feasible"] and every["work_left"] > 10


@pytest.mark.parametrize(
    ("load", "key"), [(ConstantLoad(), "ripple_constant_load"), (PropellerLoad(), "ripple_propeller_load")]
)
def test_remaining_ripple_is_that_of_the_guide_at_work(generator, load, key):
    (every,) = generator.instead
    machine = dataclasses.replace(generator.machine, load=load)
    steady = steadiness.with_guide(machine, generator.hinge, every.track)
    assert steady.speed_ripple == pytest.approx(getattr(every.taken, key), rel=1e-3)
    assert steady.speed_ripple > 0.1


def test_part_of_every_turn_repeats_every_turn(generator):
    (every,) = generator.instead
    phi = np.linspace(0, 2 * math.pi, 999)
    torque, part = generator.hinge.torque, every.taken.torque
    assert part(phi) == pytest.approx((torque(phi) + torque(phi + 2 * math.pi)) / 2, abs=1e-8)
    given = crank_torque(every.track, phi)
    assert given == pytest.approx(part(phi), abs=1e-6)


def test_flywheel_is_found_although_the_diagram_has_noise(generator):
    # a spline through measured points is integrated to about 1e-6; the balance of the load must not hang on that
    assert 0.01 < tell(HingeNumbers(judged=generator))["flywheel_inertia_saved"] < 0.2


@pytest.mark.slow
def test_files_hold_two_turns(generator, tmp_path):
    files = {file.name: file for file in shown.write(generator, tmp_path)}
    table, _ = read_table(files["hinge.csv"])
    assert table["phi"][-1] == pytest.approx(4 * math.pi)
    for name in ("pressure", "hinge_torque", "hinge_work"):
        assert table[name][0] == pytest.approx(table[name][-1], rel=1e-6, abs=1e-6 * np.abs(table[name]).max())
    guide, _ = read_table(files["guide.csv"])
    assert guide["theta"][-1] == pytest.approx(2 * math.pi) and guide["phi"][-1] == pytest.approx(4 * math.pi)
    assert guide["rho"][0] == pytest.approx(guide["rho"][-1], rel=1e-12)
    assert json.loads(files["summary.json"].read_text()) == json.loads(to_json(tell(HingeNumbers(judged=generator))))


@pytest.mark.slow
def test_report_tells_what_was_measured_and_assumed(generator, tmp_path):
    text = shown.write(generator, tmp_path)[0].read_text(encoding="utf-8")
    for words in (
        "firing dead centre at", "95 %:", "12 cycles", "nearly misfired", "were taken off", "scaled by",
        "spread evenly", "two ways to give it", "what repeats every turn", "turns even without a flywheel",
    ):  # fmt: skip
        assert words in text
    assert "kN m" not in text


@pytest.mark.slow
def test_command_for_the_other_way(diagram, monkeypatch, capsys):
    settings = ("guide.balance=every_turn", "guide.shaft_ratio=1", "trials.turns=4")
    options = [word for text in settings for word in ("--set", text)]
    monkeypatch.setattr(sys, "argv", ["mechsym", "hinge", "generator", "--diagram", diagram, "--json", *options])
    with pytest.raises(SystemExit) as end:
        main()
    numbers = json.loads(capsys.readouterr().out)
    assert not end.value.code
    assert [offer["balance"] for offer in numbers["offers"]] == ["every_turn", "whole_cycle"]
    assert numbers["check"]["speed_ripple"] > 0.1


@pytest.mark.slow
def test_command_with_a_track_that_does_not_close(diagram, monkeypatch, capsys):
    monkeypatch.setattr(
        sys, "argv", ["mechsym", "hinge", "generator", "--diagram", diagram, "--set", "guide.shaft_ratio=1"]
    )
    with pytest.raises(SystemExit) as end:
        main()
    printed = capsys.readouterr()
    assert end.value.code == 2 and printed.out == ""
    assert "does not close" in printed.err and "use 0.5" in printed.err

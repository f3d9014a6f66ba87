"""Crank trains in time: a torque at the free end, gas on every piston, a load at the flywheel; twist by section."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cases.settings import settings_of
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.machine import turn
from mechsym.jobs.problem import driving_of, problem_of
from mechsym.mechanisms import crank_train
from mechsym.mechanisms.shaft import elastic, with_torque
from mechsym.simulate import simulate
from mechsym.torsion import twist

# the crankshaft and flywheel of Chmielewski et al. (2015) as a crank train of one throw
ONE = """
mechanism = "crank_train"
source = "002_d7297926d6c52225"
about = "start-up by a torque at the free end"

[parameters]
throw = [1]
phase = 0.0
r = "0.06 m"
l1 = "0.06 m"
l2 = "0.20 m"
m_rod = 0.0
I_rod = 0.0
m_piston = "1.1 kg"
I0 = "0.26 kg*m^2"
I_f = "0.58 kg*m^2"
k = "6500 N*m/rad"
c = "0.2 N*m*s/rad"

[drive]
torque = "1.5 N*m"
time = "1 s"

[simulation]
t_end = "5 s"
output_step = "0.005 s"
window = "2 s"
"""
RUN = '\n[load]\nlaw = "propeller"\n\n[simulation]\nturns = 3\n'


@pytest.fixture
def written(tmp_path):
    def write(text):
        path = tmp_path / "train.toml"
        path.write_text(text)
        return str(path)

    return write


def numbers(*arguments):
    result = CliRunner().invoke(mechsym, ["simulate", *arguments, "--json"])
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def finished(case):
    return simulate(problem_of(case), settings_of(case))


def test_one_throw_is_the_crankshaft_with_flywheel(written):
    train = cases.load(written(ONE))
    other = cases.load("chmielewski", {"c1": "0.2", "t_end": "5 s"})
    ours, theirs = finished(train), finished(other)
    assert ours.columns["phi1d"][-1] == pytest.approx(theirs.columns["phi0d"][-1], rel=1e-8)
    assert ours.energy.work["drive"] == pytest.approx(theirs.energy.work["drive"], rel=1e-8)
    (section,), (printed,) = (
        twist.sections(elastic(train.mechanism, train.need("parameters")), ours, 3.0),
        twist.sections(elastic(other.mechanism, other.need("parameters")), theirs, 3.0),
    )
    assert section.twist_amplitude == pytest.approx(printed.twist_amplitude, rel=1e-5)
    assert twist.natural_frequencies(train.mechanism, train.need("parameters")) == pytest.approx(
        twist.natural_frequencies(other.mechanism, other.need("parameters")), rel=1e-9
    )


def test_command_reports_residual_and_twist(written, tmp_path):
    found = numbers(written(ONE), "--out", str(tmp_path / "out"))
    assert found["status"] == "converged" and abs(found["energy_residual"]) < 1e-9
    (section,) = found["twist"]
    assert section["section"] == "phi1-phi_f"
    # what the shaft carries on average accelerates the flywheel: 1.5 N m shared by the inertias
    assert found["findings"] == [
        "there is no [load]: nothing brakes the flywheel, and the speed is not that of steady running"
    ]
    whole = 0.26 + 0.58 + 1.1 * 0.06**2 / 2
    assert section["torque_mean"] == pytest.approx(1.5 * 0.58 / whole, rel=5e-3)
    assert 0 < section["twist_amplitude"] < section["twist_peak"]
    assert (tmp_path / "out/twist.svg").read_text().startswith("<svg")
    assert "natural frequencies 30.2 Hz" in CliRunner().invoke(mechsym, ["simulate", written(ONE)]).stdout


def test_a_rigid_shaft_has_no_twist():
    found = numbers("zotov-89", "--set", "simulation.turns=1", "--no-check")
    assert found["twist"] == [] and found["natural_frequencies"] == []


def test_gas_drives_and_the_propeller_takes_the_work():
    found = numbers("alpha-stirling", "--set", "c=20 N*m*s/rad", "--set", "turns=20")
    assert found["end"] == "turns" and abs(found["energy_residual"]) < 1e-9
    mean = float(np.mean(turn(cases.load("alpha-stirling")).torque))
    assert found["twist"][0]["torque_mean"] == pytest.approx(mean, rel=0.03)
    assert found["speeds"]["phi_f"]["mean"] == pytest.approx(600 * np.pi / 30, rel=0.02)
    work = found["energy"]["work"]
    assert work["gas_1"] + work["gas_2"] == pytest.approx(found["energy"]["work_in"]) and work["load"] < 0


def test_each_piston_follows_its_own_throw(written):
    case = cases.load(written(cases.text("opposed-pistons") + RUN))
    problem = problem_of(case)
    assert {k.coordinate for k in problem.kinks} == {"phi1", "phi2"}
    result = finished(case)
    assert result.status == "converged" and abs(result.energy.residual) < 1e-9
    shaft = elastic(case.mechanism, case.need("parameters"))
    first, second = twist.sections(shaft, result, float(result.t[-1] - 0.06))
    # the flywheel takes the torque of both throws, the first section that of one
    assert second.torque_mean / first.torque_mean == pytest.approx(2, rel=0.05)


def test_kinks_and_forces_are_those_of_the_firing_angles(written):
    text = cases.text("opposed-pistons").replace('firing = ["0 deg", "0 deg"]', 'firing = ["0 deg", "20 deg"]')
    gas = driving_of(cases.load(written(text)))
    first, second = (p.value for p in gas.parts)
    phi = np.linspace(0, 2 * np.pi, 50)
    assert second.value(phi + np.radians(20)) == pytest.approx(first.value(phi), rel=1e-12)
    shifted = np.sort((np.array(first.kinks) + np.radians(20)) % (2 * np.pi))
    assert gas.kinks[1].angles == pytest.approx(shifted, abs=1e-12)


def test_drive_and_gas_together(written):
    text = cases.text("alpha-stirling").replace("turns = 30", 't_end = "0.5 s"\nspeed_start = "300 rpm"')
    case = cases.load(written(text + '\n[drive]\ntorque = "10 N*m"\ntime = "0.1 s"\n'))
    result = finished(case)
    assert set(result.energy.work) == {"drive", "gas_1", "gas_2", "load"}
    assert result.energy.work["drive"] > 0 and abs(result.energy.residual) < 1e-9


def test_torque_at_the_free_end_turns_the_first_throw_only():
    p = cases.load("opposed-pistons").need("parameters")
    plain = crank_train.build(p)
    driven = with_torque(plain, "M_drive")
    state = [0.3, 0.2, 0.1, 9.0, 8.0, 7.0, 100.0, 50.0, 4.0]
    before = [np.array(v) for v in plain.functions["dynamics"](*state)]
    after = [np.array(v) for v in driven.functions["dynamics"](*state, 6.0)]
    assert (after[2] - before[2]).ravel() == pytest.approx([6.0, 0.0, 0.0], abs=1e-12)
    assert np.array_equal(after[0], before[0]) and np.array_equal(after[1], before[1])


@pytest.mark.parametrize(
    "changes, words",
    [
        (
            {"[drive]": "[load]\nlaw = 'propeller'\nspeed = 60\n[drive]", 'torque = "1.5 N*m"\ntime = "1 s"': ""},
            "torque",
        ),
        ({'[drive]\ntorque = "1.5 N*m"\ntime = "1 s"': ""}, "nothing turns the shaft"),
        ({"[drive]": "[load]\nlaw = 'constant'\n[drive]"}, "pull the shaft backwards"),
        ({"[drive]": "[load]\nlaw = 'propeller'\n[drive]"}, "[operation] is missing"),
        ({'t_end = "5 s"': "turns = 3", 'output_step = "0.005 s"\n': ""}, "simulation.t_end or speed_start"),
        ({'t_end = "5 s"': "turns = 3"}, "is not used over turns"),
        ({"[drive]": "[drive]\ninput = 'X'"}, "has not"),
        ({"[drive]": "[startup]\n[drive]"}, "a shaft with two discs"),
    ],
)
def test_bad_cases_are_refused(written, changes, words):
    text = ONE
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    result = CliRunner().invoke(mechsym, ["simulate", written(text)])
    assert isinstance(result.exception, BadInput) and words in str(result.exception)


def test_gas_that_the_train_cannot_carry_is_refused(written):
    apart = cases.text("alpha-stirling").replace("throw = [1, 1]", "throw = [1, 2]")
    with pytest.raises(BadInput, match="put them on one throw"):
        driving_of(cases.load(written(apart)))

"""Torque to pressure and back: round trip, gaps at the dead centres, intervals that hold the truth."""

import json
import math

import numpy as np
import pytest
from click.testing import CliRunner
from tables import read_table

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.forces.textbook import NORMAL_95, CrankTorque, gaps, pressure_from_torque, scatter, shaft_lines, work
from mechsym.jobs.indicated import common_gas, indicated
from mechsym.jobs.machine import turn


def written(path, one, torque, head="torque_with_inertia"):
    rpm = one.omega * 30 / math.pi
    rows = [f"{math.degrees(a):.17g},{m:.17g},{rpm:.17g}" for a, m in zip(one.phi, torque, strict=True)]
    path.write_text("\n".join([f"phi [deg],{head} [N*m],speed [rpm]", *rows]) + "\n")
    return str(path)


NAMES = ("zotov-89", "moroianu", "nunes-slider-crank", "nunes-hypocycloid", "alpha-stirling", "opposed-pistons")


@pytest.mark.parametrize("name", NAMES)
def test_the_torque_of_a_pressure_tells_that_pressure(tmp_path, name):
    """Forwards from virtual work and energies, backwards through the equations of motion."""
    case = cases.load(name)
    one = turn(case)
    truth = one.gas.pressure.absolute(one.phi)
    told = indicated(case, written(tmp_path / "m.csv", one, one.torque), 0.0)
    measured, found = told.measured, told.indicated
    assert np.abs(found.p - truth)[found.clear].max() < 1e-9 * truth.max()
    assert 1 <= (~found.clear).sum() <= 4  # the dead centres alone
    done, error = work(measured, found, one.period)
    assert error == 0 and done == pytest.approx(one.gas_power.mean() * one.period / one.omega, rel=1e-12)
    assert told.doubts == []


def test_a_torque_without_inertia_is_that_of_the_gas(tmp_path):
    case = cases.load("nunes-slider-crank")
    one = turn(case)
    found = indicated(case, written(tmp_path / "m.csv", one, one.gas_power / one.omega, "torque"), 0.0).indicated
    truth = one.gas.pressure.absolute(one.phi)
    assert np.abs(found.p - truth)[found.clear].max() < 1e-9 * truth.max()


def test_inertia_left_in_a_torque_without_it_is_noticed(tmp_path):
    """The wrong heading shifts the pressure by far more than its interval, and below zero."""
    case = cases.load("nunes-slider-crank")
    one = turn(case)
    told = indicated(case, written(tmp_path / "m.csv", one, one.torque, "torque"), 0.01)
    assert {doubt.code for doubt in told.doubts} == {"pressure_below_zero"}


@pytest.fixture(scope="module")
def marine():
    case = cases.load("moroianu")
    one, acting = turn(case), common_gas(case)
    lines = shaft_lines(acting.mechanism, acting.areas, one.phi, one.omega, acting.held)
    return one, lines, acting.p_back


def told_of(marine, torque, noise):
    one, lines, p_back = marine
    measured = CrankTorque(phi=one.phi, torque=torque, omega=one.omega, noise=noise)
    return measured, pressure_from_torque(measured, *lines, p_back)


@pytest.mark.parametrize("noise", [20.0, 20e3])
def test_intervals_hold_the_truth_19_times_in_20(marine, noise):
    one = marine[0]
    truth, done = one.gas.pressure.absolute(one.phi), one.gas_power.mean() * one.period / one.omega
    rng, held, works = np.random.default_rng(3), [], []
    for _ in range(200):
        measured, found = told_of(marine, one.torque + rng.normal(0, noise, one.phi.size), noise)
        held.append((np.abs(found.p - truth) < NORMAL_95 * found.error)[found.clear].mean())
        value, error = work(measured, found, one.period)
        works.append(abs(value - done) < NORMAL_95 * error)
    assert np.mean(held) == pytest.approx(0.95, abs=0.003)  # of 280 000 values
    assert 0.90 <= np.mean(works) <= 0.99


def test_gaps_grow_with_the_noise_and_lie_at_the_dead_centres(marine):
    one, (_, lever), _ = marine
    widths = []
    for noise in (0.0, 5e3, 20e3, 80e3):
        _, found = told_of(marine, one.torque, noise)
        assert np.abs(lever[~found.clear]).max() < np.abs(lever[found.clear]).min()
        assert NORMAL_95 * found.error[found.clear].max() < found.limit
        found_gaps = gaps(found)
        assert found_gaps[0][0] == 0 and any(a <= math.pi <= b for a, b in found_gaps)
        widths.append((~found.clear).sum())
    assert widths == sorted(set(widths))


def test_noise_that_the_rows_show_and_the_user_does_not_is_a_doubt(marine):
    one = marine[0]
    rough = one.torque + np.random.default_rng(5).normal(0, 20e3, (50, one.phi.size))
    assert np.mean([scatter(row) for row in rough]) == pytest.approx(20e3, rel=0.03)
    assert scatter(one.torque) < 20


def run(*words):
    return CliRunner().invoke(mechsym, ["cycle", *words])


def test_the_command_tells_and_writes_the_pressure(tmp_path):
    case = cases.load("moroianu")
    one = turn(case)
    rough = one.torque + np.random.default_rng(5).normal(0, 20e3, one.phi.size)
    file = written(tmp_path / "m.csv", one, rough)
    words = ("moroianu", "--torque", file, "--noise")
    told = json.loads(run(*words, "20 kN*m", "--json", "--out", str(tmp_path)).output)
    assert told["noise"] == 20e3 and told["told"] < told["samples"] == 1440 and told["doubts"] == []
    columns, _ = read_table(tmp_path / "pressure.csv")
    assert list(columns) == ["phi_deg", "p_pa", "p_low_pa", "p_high_pa"]
    assert columns["p_pa"] == pytest.approx(told["pressure"]["p_pa"], rel=1e-9)
    assert np.all(columns["p_low_pa"] < columns["p_high_pa"]) and len(columns["p_pa"]) == told["told"]
    picture = (tmp_path / "pressure.svg").read_text()
    assert "absolute pressure [" in picture and "95 %" in picture and "crank angle [" in picture
    text = run(*words, "20 N*m").output
    assert "not told" in text and "rows scatter more than --noise says" in text


WRONG = [
    (["moroianu", "--noise", "1"], "give both"),
    (["moroianu", "--torque", "FILE"], "needs --noise"),
    (["moroianu", "--torque", "FILE", "--noise", "-1"], "0 or more"),
    (["moroianu", "--torque", "FILE", "--noise", "1 bar"], "--noise"),
    (["moroianu", "--torque", "FILE", "--noise", "1e9"], "hides the torque"),
    (["moroianu", "--torque", "FILE", "--noise", "1", "--loop", "3"], "does nothing beside --torque"),
    (["nunes-slider-crank", "--torque", "FILE", "--noise", "1"], "goes over 360 deg"),
    (["balandin", "--torque", "FILE", "--noise", "1"], "one after the other"),
    (["chmielewski", "--torque", "FILE", "--noise", "1"], "[cycle]"),
    (["moroianu", "--torque", "TWO", "--noise", "1"], "2 curves"),
]


@pytest.mark.parametrize(("words", "said"), WRONG, ids=[said for _, said in WRONG])
def test_what_tells_no_pressure_is_refused(tmp_path, words, said):
    rows = [(a, math.sin(math.radians(a))) for a in range(360)]
    for name, speeds in (("FILE", (127,)), ("TWO", (100, 127))):
        text = "\n".join(f"{a},{m},{speed}" for speed in speeds for a, m in rows)
        (tmp_path / name).write_text(f"phi [deg],torque [N*m],speed [rpm]\n{text}\n")
    found = run(*(str(tmp_path / word) if word in ("FILE", "TWO") else word for word in words))
    assert isinstance(found.exception, BadInput) or found.exit_code == 2
    assert said in str(found.exception) + found.output

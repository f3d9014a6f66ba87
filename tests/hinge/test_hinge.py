"""Hinge torque: existence, parts, virtual work, harmonics; which part of a four-stroke torque is balanced."""

import dataclasses

import numpy as np
import pytest
from hinges import HIGHER, LOWER, built, built_four_stroke, engine, exact_torque, four_stroke
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import cumulative_trapezoid, quad, solve_ivp
from scipy.optimize import brentq

from mechsym import cases, jobs, periodic
from mechsym.errors import BadInput
from mechsym.hinge import balance, guide
from mechsym.hinge import limits as feasibility
from mechsym.hinge.torque import EngineTorques, engine_torques, exists, hinge_of, torque
from mechsym.papers.zotov2024.equations_printed import hinge_torque_printed, load_torque_printed

TURN = 2 * np.pi
BOTH = pytest.mark.parametrize("name", [LOWER, HIGHER])


def peak(found):
    return max(found.torque_max, -found.torque_min)


@BOTH
def test_mean_vanishes(name):
    found = built(name)
    assert found.exists
    assert abs(found.mean_torque) < 1e-9 * peak(found)
    assert abs(found.work(TURN * (1 - 1e-15)) - found.work(0.0)) < 1e-9 * (found.work_max - found.work_min)


@BOTH
def test_torque_keeps_the_speed_constant_between_the_knots(name, rng):
    phi = rng.uniform(-10, 10, 5000)
    wrong = built(name).torque(phi) - exact_torque(name, phi)
    assert np.max(np.abs(wrong)) < 1e-10 * peak(built(name))


@BOTH
def test_no_acceleration_in_the_equation_of_motion(name, rng):
    machine, found = engine(name), built(name)
    dynamics = machine.mechanism.functions["dynamics"]
    for phi in rng.uniform(0, TURN, 50):
        inputs = {
            "F": float(machine.gas.force(np.array([phi]))[0]),
            "M_r": found.load_torque,
            "M_h": float(found.torque(phi)),
        }
        value = dynamics(phi=phi, phid=machine.omega, **inputs)
        residual = float(value["generalized_force"] - value["bias"])
        assert abs(residual) < 1e-9 * peak(found)


@BOTH
def test_parts_sum_to_the_torque_and_are_what_they_say(name, rng):
    phi, found, torques = rng.uniform(0, TURN, 1000), built(name), engine_torques(engine(name))
    sum_of_parts = found.inertia_part(phi) + found.gas_part(phi) + found.gravity_part(phi)
    assert sum_of_parts == pytest.approx(found.torque(phi), abs=1e-10 * peak(found))
    expected = {
        "inertia_part": found.omega**2 / 2 * torques.dinertia_dphi(phi),
        "gas_part": found.load_torque - torques.gas_torque(phi),
        "gravity_part": -torques.gravity_torque(phi),
    }
    for part, values in expected.items():
        assert getattr(found, part)(phi) == pytest.approx(values, abs=1e-10 * peak(found))
        assert abs(periodic.mean(getattr(found, part))) < 1e-10 * peak(found)


@BOTH
def test_4_5_load_torque_takes_the_work_of_the_gas(name):
    work, _ = quad(
        lambda phi: float(engine_torques(engine(name)).gas_torque(np.array([phi]))[0]),
        0, TURN, points=engine(name).gas.pressure.kinks[1:], limit=200, epsrel=1e-10,
    )  # fmt: skip
    assert built(name).load_torque == pytest.approx(work / TURN, rel=1e-9)


@BOTH
def test_work_is_the_integral_of_the_torque(name):
    work, _ = quad(lambda phi: float(built(name).torque(phi)), 0, 2.0, points=[1.9198621771937625], limit=200)
    assert float(built(name).work(2.0)) == pytest.approx(work, rel=1e-9)


@BOTH
def test_more_than_four_fifths_of_the_torque_are_odd(name):
    found = built(name)
    amplitudes = np.abs(np.fft.rfft(found.torque(np.arange(4096) * TURN / 4096)))
    assert np.sqrt(np.sum(amplitudes[1::2] ** 2) / np.sum(amplitudes**2)) > 0.8


def test_a_mean_of_a_billionth_of_the_peak_is_none():
    for mean, there in ((0.9e-9, True), (-0.9e-9, True), (1.2e-9, False), (-1.2e-9, False)):
        poly = periodic.fit(lambda phi: 3 * np.sin(phi), (), TURN, 1e-14)
        poly.c[-1] += 3 * mean - periodic.mean(poly)
        assert exists(poly) is there


def test_8_printed_torque_against_the_exact_one(zotov):
    phi = np.linspace(0, TURN, 2000, endpoint=False)
    force, found = engine().gas.force(phi), built()
    load = load_torque_printed(zotov, force, phi)
    printed = hinge_torque_printed(zotov, found.omega, force, load, phi)
    wrong = np.max(np.abs(printed - found.torque(phi))) / peak(found)
    # truncated kinematics and the wrong sign in (2): not small, and not the same curve
    assert load == pytest.approx(found.load_torque, rel=0.02)
    assert 0.01 < wrong < 0.1


def test_torque_grows_with_speed_but_not_with_its_square():
    ratio = peak(built(HIGHER)) / peak(built(LOWER))
    assert 2.3 < ratio < 2.6  # the paper says "approximately 2" and omega squared would be 2.546
    inertia = periodic.extremes(built(LOWER).inertia_part)[2]
    assert 0.05 < inertia / peak(built(LOWER)) < 0.15


def test_a_torque_with_a_mean_has_no_hinge():
    poly = periodic.fit(lambda phi: 1 + np.sin(phi), (), TURN)
    assert not exists(poly)
    assert exists(periodic.fit(np.sin, (), TURN))


@given(st.floats(1, 100), st.floats(-0.5, 0.5), st.floats(0.01, 10), st.sampled_from([TURN, 2 * TURN]))
def test_any_engine_has_a_hinge(omega, wobble, gas, period):
    torques = EngineTorques(
        inertia=lambda phi: 2 + wobble * np.cos(phi),
        dinertia_dphi=lambda phi: -wobble * np.sin(phi),
        gas_torque=lambda phi: gas * np.mod(phi - 0.4, period) ** 1.8 * np.sin(phi),
        gravity_torque=np.cos,
        kinks=(0.4,),
        period=period,
    )
    found = hinge_of(torques, omega)
    assert found.exists
    assert found.work_max >= 0 >= found.work_min


def test_four_stroke_parts_add_up(rng):
    found, phi = built_four_stroke(), rng.uniform(-30, 30, 500)
    part = balance.balance(found, "every_turn")
    assert part.period == pytest.approx(TURN)
    assert part.torque(phi) + part.rest(phi) == pytest.approx(found.torque(phi), abs=1e-8 * peak(found))
    assert part.rest(phi) + part.rest(phi + TURN) == pytest.approx(0 * phi, abs=1e-8 * peak(found))
    assert abs(periodic.mean(part.torque)) < 1e-9 * peak(found)


def four_stroke_run(part, load, start, turns, points):
    """Speed of the crank with the hinge of `part`; `load` is a torque by speed, `points` are of the last two turns."""
    engine, found = four_stroke(), built_four_stroke()

    def rate(_, state):
        phi = np.array([state[0]])
        given = engine.gas_torque(phi) + engine.gravity_torque(phi) + part.torque(phi)
        slope = engine.dinertia_dphi(phi) * state[1] ** 2 / 2
        return [state[1], float((given - load(state[1]) - slope)[0] / engine.inertia(phi)[0])]

    def at(_, state):
        return state[0] - turns * TURN

    at.terminal = True
    time = 3 * turns * TURN / found.omega
    run = solve_ivp(rate, (0, time), [0.0, start], rtol=1e-9, atol=1e-9, events=at, dense_output=True)
    end = run.t[-1]
    before = brentq(lambda t: run.sol(t)[0] - (turns - 2) * TURN, 0, end)
    return run.sol(np.linspace(before, end, points))[1], end - before


def test_four_stroke_rest_ripples_as_a_run_does():
    found = built_four_stroke()
    part = balance.balance(found, "every_turn")
    load = found.load_torque
    phid, _ = four_stroke_run(part, lambda w: load * (w / found.omega) ** 2, found.omega, 24, 4000)
    assert part.ripple_propeller_load == pytest.approx(np.ptp(phid) / found.omega, rel=2e-3)

    def faster(start):
        return 2 * TURN / four_stroke_run(part, lambda w: load, start, 2, 2)[1] / found.omega - 1

    start = brentq(faster, 0.9 * found.omega, 1.5 * found.omega, xtol=1e-6 * found.omega)
    phid, _ = four_stroke_run(part, lambda w: load, start, 2, 4000)
    assert part.ripple_constant_load == pytest.approx(np.ptp(phid) / found.omega, rel=2e-3)


def test_swing_of_the_rest_is_that_of_its_integral():
    part = balance.balance(built_four_stroke(), "every_turn")
    phi = np.linspace(0, 2 * TURN, 200_001)
    work = cumulative_trapezoid(part.rest(phi), phi, initial=0)
    assert part.rest_swing == pytest.approx(np.ptp(work), rel=1e-7)
    assert part.work(1.0) == pytest.approx(quad(part.torque, 0, 1.0, epsabs=0, epsrel=1e-10)[0], rel=1e-9)


def test_whole_cycle_leaves_nothing():
    part = balance.balance(built_four_stroke(), "whole_cycle")
    assert part.rest_swing == part.ripple_constant_load == part.ripple_propeller_load == 0
    assert part.period == pytest.approx(2 * TURN)


def test_two_stroke_balances_are_the_same():
    one, two = (balance.balance(built(), kind) for kind in balance.BALANCES)
    assert one.torque is two.torque
    assert dataclasses.replace(one, kind="every_turn", rest=two.rest, work=two.work) == two


def test_unknown_balance_is_refused():
    with pytest.raises(BadInput, match="whole_cycle, every_turn"):
        balance.balance(built(), "half")


@pytest.mark.slow
def test_measured_diagram_drives_the_hinge_of_the_generator(measured_data, rng):
    case = cases.load("generator")
    found = torque(jobs.machine(case, str(measured_data / "generator-half-load.csv")))
    assert found.exists
    assert found.period == pytest.approx(2 * TURN)
    part, phi = balance.balance(found, case.need("guide").balance), rng.uniform(0, 30, 500)
    cut = guide.cut(part, case.need("spring"), case.need("guide"))
    assert feasibility.judge(cut, case.need("rollers"), case.need("limits")).feasible
    assert guide.crank_torque(cut, phi) == pytest.approx(found.torque(phi), abs=1e-8 * peak(found))
    # on the crank itself the hinge can take only what repeats every turn
    assert balance.balance(found, "every_turn").ripple_propeller_load > 0.1

"""A guide cut for a gas that exchanges heat: its torque against the gas integrated anew, its limits, and its runs."""

import dataclasses
from dataclasses import replace

import numpy as np
import pytest
from hinges import built_four_stroke
from scipy.integrate import solve_ivp

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.hinge.guide import affine, crank_torque, cut, gas_turn, kept_torque, refit, spring_state, torque_function
from mechsym.hinge.springs.air import AirAbsolute
from mechsym.hinge.springs.air_thermal import AirThermal
from mechsym.hinge.torque import torque
from mechsym.jobs import hinge as design
from mechsym.jobs.machine import machine
from mechsym.out.block import LawPoint, hinge_law

SPRING = '[spring]\nlaw = "air_thermal"\nA = "0.031 m^2"\nH = "1 m"\np0 = "5 MPa"\ntau = "0.139 s"\n'


@pytest.fixture(scope="module")
def wanted():
    return torque(machine(cases.load("zotov-89")))


@pytest.fixture(scope="module")
def choices():
    return cases.load("zotov-89").need("guide")


def spring(tau, **changes):
    return AirThermal(A=0.031, H=1.0, p0=5e6, tau=tau, **changes)


def through(guide):
    theta = np.linspace(0, 2 * np.pi, 1440, endpoint=False)
    z = 2 * (guide.parameters.rho0 - guide.rho(theta))
    return theta, z


@pytest.mark.parametrize("tau", [10.0, 0.139, 0.05])
def test_the_gas_integrated_along_the_path_gives_the_torque(wanted, choices, tau):
    """First law in time with an adaptive method, until it repeats: no formula of the cut, nor of the periodic turn."""
    guide = cut(wanted, spring(tau), choices)
    full = (5e6 + 101325.0) * 0.031 * 1.0 / 320.0
    slope = guide.rho.derivative()

    def rate(theta, T):
        V = 0.031 * (1.0 - 2 * (guide.parameters.rho0 - guide.rho(theta)))
        dV = 0.031 * 2 * slope(theta)
        return -0.4 * T * dV / V - (T - 320.0) / (wanted.omega * tau)

    theta, z = through(guide)
    start = gas_turn(guide).temperature[0]
    turn = solve_ivp(rate, (0, 2 * np.pi), [start], t_eval=theta, rtol=1e-10, atol=1e-7, max_step=0.02)
    again = solve_ivp(rate, (0, 2 * np.pi), [start], rtol=1e-10, atol=1e-7, max_step=0.02).y[0, -1]
    assert again == pytest.approx(start, rel=1e-6)  # it repeats
    force = full * turn.y[0] / (1.0 - z) - 0.031 * 101325.0
    given, size = 2 * force * slope(theta), np.abs(wanted.torque(theta)).max()
    assert np.abs(given - (wanted.torque(theta) - kept_torque(guide))).max() < 2e-5 * size
    assert -given.mean() == pytest.approx(kept_torque(guide), abs=1e-5 * size)
    assert np.abs(crank_torque(guide, theta) - given).max() < 1e-5 * size


def test_the_work_of_a_gas_with_a_state_is_that_of_its_torque_less_its_mean(wanted, choices):
    parts = affine(cut(wanted, spring(0.139), choices), wanted)
    torque, work = parts.torque_0 + 5e6 * parts.torque_1, parts.work_0 + 5e6 * parts.work_1
    step = wanted.period / torque.size
    between = np.diff(np.append(work, work[0])) / step
    swing = torque - torque.mean()
    # of trapezia, whose ends are the angles of the work
    assert between == pytest.approx((swing + np.roll(swing, -1)) / 2, abs=1e-9 * np.abs(torque).max())


def test_on_a_half_speed_shaft_the_gas_has_twice_the_time(choices):
    wanted = built_four_stroke()
    guide = cut(wanted, AirThermal(A=0.01, H=0.5, p0=3e5, tau=0.2), replace(choices, rho0=0.4, shaft_ratio=0.5))
    kept = kept_torque(guide)
    assert kept > 1e-3 * np.abs(wanted.torque(np.linspace(0, 12, 500))).max()
    phi = np.linspace(0, 4 * np.pi, 4000, endpoint=False)
    given = crank_torque(guide, phi)
    assert given == pytest.approx(wanted.torque(phi) - kept, abs=1e-4 * np.abs(given).max())
    # the loss of a turn of the shaft, by the first law in time
    slope, z = guide.rho.derivative(), lambda theta: guide.rollers * (guide.parameters.rho0 - guide.rho(theta))

    def rate(theta, state):
        T, height = state[0], 0.5 - z(theta)
        heat = (T - 320.0) / (wanted.omega / 2 * 0.2)
        return [-0.4 * T * guide.rollers * slope(theta) / height - heat, heat]

    start = gas_turn(guide).temperature[0]
    turn = solve_ivp(rate, (0, 2 * np.pi), [start, 0.0], rtol=1e-10, atol=1e-7, max_step=0.02)
    assert turn.y[0, -1] == pytest.approx(start, rel=1e-5)
    lost = turn.y[1, -1] * (3e5 + 101325.0) * 0.01 * 0.5 / 320.0 / 0.4  # c_v m by the filling at 320 K
    assert lost == pytest.approx(4 * np.pi * kept, rel=1e-3)


def test_slow_exchange_is_the_adiabatic_spring(wanted, choices):
    guide = cut(wanted, spring(1e5), choices)
    theta, z = through(guide)
    _, pressure = spring_state(guide, theta, z)
    constant = (pressure + 101325.0) * (1.0 - z) ** 1.4
    assert np.ptp(constant) < 1e-4 * constant.mean()
    assert kept_torque(guide) < 1e-5 * wanted.load_torque
    same = AirAbsolute(A=0.031, H=1.0, p0=float(constant.mean()) - 101325.0, n=1.4)
    assert np.abs(cut(wanted, same, choices).rho(theta) - guide.rho(theta)).max() < 5e-6


def test_fast_exchange_is_the_isothermal_spring(wanted, choices):
    guide = cut(wanted, spring(5e-4), choices)
    theta, _ = through(guide)
    same = cut(wanted, AirAbsolute(A=0.031, H=1.0, p0=5e6, n=1.0), choices)
    assert np.abs(same.rho(theta) - guide.rho(theta)).max() < 2e-3
    assert kept_torque(guide) < 2e-3 * wanted.load_torque


def test_between_the_limits_heat_is_lost_most_where_the_index_is_near_its_middle(wanted, choices):
    lost = {tau: kept_torque(cut(wanted, spring(tau), choices)) / wanted.load_torque for tau in (10.0, 1.0, 0.1, 0.005)}
    assert lost[10.0] < lost[1.0] < lost[0.1] > lost[0.005]
    assert 0.03 < lost[0.1] < 0.1


def test_start_as_printed_begins_at_the_free_height(wanted, choices):
    printed = dataclasses.replace(choices, start="as_printed", rho0=1.5)
    guide = cut(wanted, spring(0.139, gamma=1.3), printed)
    assert guide.rho(0.0) == pytest.approx(1.5, abs=1e-9)


def test_what_the_gas_cannot_hold_has_no_guide(wanted, choices):
    weak = cut(wanted, dataclasses.replace(spring(0.139), p0=2e5), choices)
    assert weak.rho is None and weak.status in ("spring_pulls", "spring_bottoms") and weak.reason
    near = cut(wanted, dataclasses.replace(spring(0.139)), dataclasses.replace(choices, rho0=0.12))
    assert near.status == "crosses_axis"
    with pytest.raises(BadInput, match="tau"):
        spring(0.0)
    with pytest.raises(BadInput, match="tau = 1e-05 s.*at least 0.00021 s"):
        cut(wanted, spring(1e-5), choices)


def test_floats_arrays_and_the_exported_text_are_one_law(wanted, choices):
    guide = cut(wanted, spring(0.139), choices)
    law, one = hinge_law("hinge", guide, guide.spring), torque_function(guide)
    letters = {p.name: p.start for p in law.parameters}
    angles = np.linspace(0.1, 12.0, 23)
    for phi, value in zip(angles, crank_torque(guide, angles), strict=True):
        at = phi % (2 * np.pi)
        curves = [(float(c.poly(at)), float(c.poly.derivative()(at))) for c in law.curves]
        assert one(float(phi)) == pytest.approx(value, rel=1e-9, abs=1e-6)
        point = LawPoint(t=0.0, q=[phi], u=[9.0], letters=letters, curves=curves, s=[])
        assert law.value(point) == pytest.approx(value, rel=1e-9, abs=1e-6)
    assert {"A", "H", "p0", "pa", "rho0"} == set(letters)


def test_another_pressure_keeps_the_temperature(wanted, choices):
    """The torque is a straight line over p0: retuning rests on it."""
    guide = cut(wanted, spring(0.139), choices)
    phi = np.linspace(0, 6, 50)
    low, mid, high = (crank_torque(refit(guide, dataclasses.replace(guide.spring, p0=p)), phi) for p in (4e6, 5e6, 6e6))
    assert low + high == pytest.approx(2 * mid, rel=1e-9, abs=1e-3)


@pytest.mark.slow
def test_a_case_with_that_spring_runs_steadily(tmp_path):
    text = cases.text("zotov-89")
    start, end = text.index("[spring]"), text.index("[guide]")
    file = tmp_path / "warm.toml"
    file.write_text(text[:start] + SPRING + text[end:])
    found = design(cases.load(str(file), {"trials.turns": 8}))
    assert found.verdict.feasible
    runs = {t.name: t for t in found.trials}
    for key in ("hinge_constant", "hinge_propeller"):
        assert runs[key].speed_ripple < 1e-4
        assert abs(runs[key].result.energy.residual) < 1e-9
        work = runs[key].result.energy.work  # the gas keeps what the load misses
        assert work["hinge"] / 8 == pytest.approx(-2 * np.pi * kept_torque(found.guide), rel=2e-3)
    assert found.price.losses.gas == pytest.approx(kept_torque(found.guide), rel=1e-4)
    assert found.retuned.steady.speed_ripple is not None
    assert [s.name for s in found.sensitivities] == ["p0", "tau"]

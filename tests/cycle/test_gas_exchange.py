"""Filling and emptying against closed forms, limits and balances; no published measurement was found to compare."""

import math

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from mechsym.cycle.breathing import run
from mechsym.cycle.breathing.engine import _curve
from mechsym.cycle.breathing.flow import (
    Breathing,
    FreshCharge,
    HeatSink,
    Surroundings,
    critical_ratio,
    curtain_area,
    orifice_flow,
    port_area,
    valve_lift,
)
from mechsym.cycle.breathing.run import Cylinder, breathe, repeating
from mechsym.cycle.heat import Woschni
from mechsym.errors import BadInput

AREA, STROKE = math.pi / 4 * 0.06**2, 0.104
SWEPT = AREA * STROKE
SMALL = {
    "inlet_diameter": 0.028, "inlet_lift": 0.008, "exhaust_diameter": 0.024, "exhaust_lift": 0.008,
    "throttle_diameter": 0.03, "plenum_volume": 1e-3, "tailpipe_diameter": 0.03, "manifold_volume": 1e-3,
}  # fmt: skip
FIRED = FreshCharge(heat=2.5e6, ignition=math.radians(-10), duration=math.radians(40))
COLD = FreshCharge(heat=0.0, ignition=0.0, duration=0.5)


def breathed(breathing, charge, speeds, **around):
    return breathe(Cylinder(breathing=breathing, charge=charge, volume=volume), Surroundings(**around), speeds)


def volume(phi):
    return SWEPT / 9 + SWEPT / 2 * (1 - ca.cos(phi))


@pytest.mark.parametrize("gamma", [1.2, 1.4, 5 / 3])
def test_choked_discharge_of_a_vessel_has_a_closed_form(gamma):
    # p/p0 = (1 + (gamma - 1)/2 k t)^(-2 gamma/(gamma - 1)), the gas inside expanding without heat
    R, V, A, p0, T0 = 287.0, 1e-3, 1e-5, 20e5, 600.0

    def rate(t, y):
        p, T = y
        flow = float(orifice_flow(A, (p, T), (1e5, 300.0), gamma, R))
        return [-gamma * R * T * flow / V, -(gamma - 1) * T * flow * R * T / (p * V)]

    k = A * math.sqrt(gamma * R * T0) / V * (2 / (gamma + 1)) ** ((gamma + 1) / (2 * (gamma - 1)))
    t = 0.05
    p, T = solve_ivp(rate, (0, t), [p0, T0], rtol=1e-11, atol=1e-9).y[:, -1]
    factor = 1 + (gamma - 1) / 2 * k * t
    assert p > 1e5 / critical_ratio(gamma)
    assert p / p0 == pytest.approx(factor ** (-2 * gamma / (gamma - 1)), rel=1e-8)
    assert T / T0 == pytest.approx(factor**-2, rel=1e-8)


def test_flow_below_choking_is_the_isentropic_one_and_joins_the_choked():
    gamma, R = 1.4, 287.0
    ratio = critical_ratio(gamma)
    below, above = (float(orifice_flow(1e-4, (2e5, 300.0), (2e5 * r, 300.0), gamma, R)) for r in (ratio, ratio / 3))
    assert below == pytest.approx(above, rel=1e-14)
    T = 300.0 * 0.8 ** (0.4 / 1.4)  # in the throat, at r = 0.8
    speed = math.sqrt(2 * 1.4 * R / 0.4 * (300.0 - T))
    assert float(orifice_flow(1e-4, (2e5, 300.0), (1.6e5, 280.0), gamma, R)) == pytest.approx(
        1e-4 * speed * 1.6e5 / (R * T), rel=1e-13
    )


@given(st.floats(0.5, 20), st.floats(0.5, 20), st.floats(250, 2000), st.floats(250, 2000))
def test_flow_turns_round_with_the_pressures(p_1, p_2, T_1, T_2):
    one, other = (p_1 * 1e5, T_1), (p_2 * 1e5, T_2)
    there, back = float(orifice_flow(1e-4, one, other, 1.4, 287.0)), float(orifice_flow(1e-4, other, one, 1.4, 287.0))
    if p_1 != p_2:
        assert there == pytest.approx(-back, rel=1e-12)
    assert there * (p_1 - p_2) >= 0


def test_cam_has_no_jump_in_speed_or_acceleration():
    opens, closes = math.radians(345), math.radians(590)
    phi = ca.SX.sym("phi")
    lift = valve_lift(phi, opens, closes, 0.008)
    slope = ca.gradient(lift, phi)
    both = ca.Function("cam", [phi], [slope, ca.gradient(slope, phi)])
    for angle in (opens, closes):
        for value in both(angle + 1e-9 if angle == opens else angle - 1e-9):
            assert abs(float(value)) < 1e-8
    assert float(valve_lift(opens - 0.1, opens, closes, 0.008)) == 0
    assert float(valve_lift((opens + closes) / 2 + 4 * math.pi, opens, closes, 0.008)) == pytest.approx(0.008)


def test_areas_saturate():
    assert float(curtain_area(0.1, 0.02, 0.7)) == pytest.approx(0.7 * math.pi / 4 * 0.02**2)
    assert float(port_area(0.05, 0.08, 0.02, 0.1, 0.7)) == 0
    assert float(port_area(0.2, 0.08, 0.02, 0.1, 0.7)) == pytest.approx(0.7 * 0.1 * 0.02)


def test_mass_and_energy_are_conserved_and_the_cycle_repeats():
    for found in breathed(Breathing(**SMALL), FIRED, [100.0, 400.0, 800.0]):
        assert found.closure < 1e-9
        assert found.mass_residual < 1e-9
        assert found.energy_residual < 1e-9
        assert 0 < found.residual < 0.15
        assert found.work > 0 > found.pumping


def test_events_between_the_steps_of_a_grid_cost_no_order(monkeypatch):
    """Where combustion ends the pressure has a corner; a step across it would be of first order."""
    burns = FreshCharge(heat=2.5e6, ignition=-0.1771, duration=0.7123)
    valves = SMALL | {"exhaust_opens": 2.4567, "inlet_closes": 10.3211}
    phi = np.linspace(0, 4 * math.pi, 7919)
    curves, works = [], []
    for steps in (1440, 5760):
        monkeypatch.setattr(run, "_STEPS", steps)
        (breath,) = breathed(Breathing(**valves), burns, [300.0])
        curves.append(_curve(breath)(phi))
        works.append(breath.work)
    fine = curves[1]
    assert np.abs(curves[0] - fine).max() < 1e-5 * fine.max() and works[0] == pytest.approx(works[1], rel=1e-6)
    # at the corner itself, too, where one spline through all nodes would swing
    corner = abs(phi - (burns.ignition + burns.duration)) < 0.05
    assert corner.any() and np.abs(curves[0] - fine)[corner].max() < 1e-6 * fine.max()


def test_what_is_drawn_is_what_burns_and_what_is_lost():
    """Valves that overlap blow fresh gas through under a boost; a fast engine blows burnt gas back at the throttle."""
    early = SMALL | {"inlet_opens": math.radians(310), "exhaust_closes": math.radians(420)}
    (through,) = breathed(Breathing(**early), FIRED, [150.0], p_in=1.4e5)
    (back,) = breathed(Breathing(**SMALL), FIRED, [600.0])
    assert through.trapping_efficiency < 0.95 and back.trapping_efficiency == pytest.approx(1.0, abs=3e-4)
    for found, p_in in ((through, 1.4e5), (back, 101325.0)):
        fresh = found.trapped * (1 - found.residual)
        assert found.heat == pytest.approx(FIRED.heat * fresh, rel=1e-4)  # what is trapped burns
        assert found.trapping_efficiency == pytest.approx(fresh / found.drawn, rel=1e-12)
        full = p_in * np.ptp(found.room) / (287.0 * 288.15)
        assert found.volumetric_efficiency * full == pytest.approx(found.drawn, rel=1e-12)


@pytest.mark.slow
def test_slow_cold_engine_is_the_ideal_pump():
    """Throats wide, speed low, exhaust at another pressure than inlet: the two strokes work (p_i - p_e) V."""
    wide = SMALL | {"inlet_opens": math.radians(359), "inlet_closes": math.radians(541),
                    "exhaust_opens": math.radians(179), "exhaust_closes": math.radians(361)}  # fmt: skip
    (found,) = breathed(Breathing(**wide), COLD, [20.0], p_out=1.2e5)
    assert found.pumping == pytest.approx((101325.0 - 1.2e5) * SWEPT, rel=0.02)
    (level,) = breathed(Breathing(**wide), COLD, [20.0])
    assert abs(level.pumping) < 5e-3 * 101325.0 * SWEPT
    assert level.volumetric_efficiency == pytest.approx(1.0, abs=0.03)


def test_a_speed_at_which_no_engine_turns_is_refused_before_it_takes_minutes():
    with pytest.raises(BadInput, match=r"at 3\.34 rpm is not computed"):
        breathed(Breathing(**SMALL), FIRED, [0.35, 300.0])


def test_closed_period_is_the_adiabat():
    (found,) = breathed(Breathing(**SMALL), COLD, [200.0])
    room = np.array([float(volume(a)) for a in found.phi])
    closed = found.phi < 4 * math.pi + math.radians(129)
    p = found.pressures["cylinder"]
    np.testing.assert_allclose(p[closed] * room[closed] ** 1.4, p[0] * room[0] ** 1.4, rtol=1e-9)


def test_higher_speed_breathes_worse_and_a_throttle_costs_work():
    slow, fast = breathed(Breathing(**SMALL), FIRED, [200.0, 800.0])
    assert fast.volumetric_efficiency < slow.volumetric_efficiency
    assert fast.pumping < slow.pumping
    (throttled,) = breathed(Breathing(**(SMALL | {"throttle_diameter": 0.006})), FIRED, [200.0])
    assert throttled.volumetric_efficiency < 0.8 * slow.volumetric_efficiency
    assert throttled.pumping < 1.5 * slow.pumping
    assert throttled.residual > slow.residual


def test_walls_take_heat_and_the_balance_still_closes():
    walls = HeatSink(law=Woschni(wall_temperature=420.0), bore=0.06, stroke=STROKE, displacement=SWEPT)
    cylinder = Cylinder(breathing=Breathing(**SMALL), charge=FIRED, volume=volume, walls=walls)
    (warm,), (without,) = breathe(cylinder, Surroundings(), [300.0]), breathed(Breathing(**SMALL), FIRED, [300.0])
    assert warm.energy_residual < 1e-9
    assert 0.1 < warm.wall_heat / warm.heat < 0.5
    assert without.wall_heat == 0
    assert warm.work < without.work
    assert warm.T_exhaust < without.T_exhaust


def test_newton_finds_the_state_that_repeats_and_none_that_runs_away():
    mix = np.array([[0.999, 1e-3], [2e-4, 0.2]])
    point = np.array([[3.0], [5.0]])

    def cycle(states, lane, by=mix):
        return point + by @ (states - point) + 1e-3 * (states - point) ** 2

    found = repeating(cycle, np.array([[1.0], [9.0]]), [0, 1], 1e-10)
    np.testing.assert_allclose(found, point, rtol=1e-6)
    assert repeating(lambda s, lane: cycle(s, lane, 1.5 * mix), np.array([[2.9], [5.1]]), [0, 1], 1e-10) is None
    assert repeating(lambda s, lane: np.nan * s, point, [0, 1], 1e-10) is None


@pytest.mark.slow
def test_large_volumes_are_the_limit_of_constant_pressure():
    """A plenum of a cubic metre fills for minutes; the cycle that repeats is found all the same."""
    large = [SMALL | {"plenum_volume": v, "manifold_volume": v} for v in (0.1, 1.0)]
    (some,), (many,) = (breathed(Breathing(**one), FIRED, [300.0]) for one in large)
    assert many.mass_residual < 1e-9 and many.energy_residual < 1e-9
    assert np.ptp(many.pressures["plenum"]) < 0.2 * np.ptp(some.pressures["plenum"])
    assert many.volumetric_efficiency == pytest.approx(some.volumetric_efficiency, rel=3e-3)

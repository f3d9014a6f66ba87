"""The adiabatic Stirling cycle against known figures, Schmidt's closed form, an independent integrator, the laws."""

import dataclasses
import math

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from mechsym.cycle.kinds.stirling_spaces import GASES, FiveSpaces, StirlingCylinders, areas, five_spaces, swept
from mechsym.cycle.kinds.stirling_turn import turn
from mechsym.errors import BadInput

HELIUM = (5 / 3, 2077.0)
AIR = (1.4, 287.0)


def slider(phi, r=0.06, length=0.26):
    return r * (1 - ca.cos(phi)) + length - ca.sqrt(length**2 - (r * ca.sin(phi)) ** 2)


def alpha(share, gas=AIR, length=0.26, **letters):
    """The built-in engine with a share of its dead volumes in the cylinders."""
    area = math.pi / 4 * 0.09**2

    def volumes(phi):
        hot, cold = slider(phi + math.pi / 2, length=length), slider(phi, length=length)
        return 1e-4 * share + area * hot, 0.8e-4 * share + area * cold

    numbers = {"gamma": gas[0], "R": gas[1], "T_h": 900.0, "T_k": 330.0, "mean_pressure": 5e5} | letters
    return FiveSpaces(volumes=volumes, V_h=1e-4 * (1 - share), V_k=0.8e-4 * (1 - share), V_r=1.2e-4, **numbers)


def schmidt_closed_form(share):
    """Work of the isothermal cycle of sinusoidal volumes: Urieli and Berchowitz (1984), equations 3.12 to 3.22."""
    v, T_h, T_k, lead = math.pi / 4 * 0.09**2 * 0.12, 900.0, 330.0, math.pi / 2
    T_r = (T_h - T_k) / math.log(T_h / T_k)
    dead = 1e-4 / T_h + 1.2e-4 / T_r + 0.8e-4 / T_k
    s = dead + v / 2 * (1 / T_h + 1 / T_k)
    cos, sin = v / 2 * (math.cos(lead) / T_h + 1 / T_k), v / 2 * math.sin(lead) / T_h
    beta, b = math.atan2(sin, cos), math.hypot(sin, cos) / s
    factor = math.pi * 5e5 * (math.sqrt(1 - b**2) - 1) / b
    return factor * v * (math.sin(beta) + math.sin(beta - lead))


# the figures of the issue: all dead volume in the exchangers, and half of it clearance
@pytest.mark.parametrize(
    ("share", "gas", "work", "efficiency"),
    [(0.0, AIR, 197.8, 0.497), (0.5, AIR, 201.2, 0.491), (0.0, HELIUM, 168.0, 0.408), (0.5, HELIUM, 167.9, 0.392)],
)
def test_figures_at_the_built_in_data(share, gas, work, efficiency):
    found = turn(alpha(share, gas))
    assert found.work == pytest.approx(work, abs=0.06)
    assert found.work / found.heat_in == pytest.approx(efficiency, abs=0.0006)


@pytest.mark.parametrize(("share", "work"), [(0.0, 193.0), (0.5, 199.5)])
def test_work_at_the_mass_of_the_isothermal_engine(share, work):
    case, phi = alpha(share), np.arange(720) * math.pi / 360
    angle = ca.SX.sym("phi")
    volume = np.asarray(ca.Function("v", [angle], [ca.vertcat(*case.volumes(angle))])(phi.reshape(1, -1)))
    inverse = (volume[0] + case.V_h) / 900 + case.V_r * math.log(900 / 330) / 570 + (volume[1] + case.V_k) / 330
    mass = 5e5 / (1 / inverse).mean() / 287.0
    found = turn(case)  # pressures and masses are proportional
    assert found.work * mass / found.mass == pytest.approx(work, abs=0.06)


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_first_law_mass_and_ideal_regenerator(share):
    found = turn(alpha(share))
    assert abs(found.residual) < 1e-10
    assert found.closure < 1e-10
    assert abs(found.sums["Q_r"]) < 1e-9 * found.heat_in  # what the matrix takes it gives back
    case = alpha(share)
    exchangers = case.V_h / 900 + case.V_r * math.log(900 / 330) / 570 + case.V_k / 330
    with np.errstate(invalid="ignore", divide="ignore"):
        spaces = found.V_e / found.T_e + found.V_c / found.T_c
    masses = found.p / 287.0 * (spaces + exchangers)
    np.testing.assert_allclose(masses, found.mass, rtol=1e-10)
    fine = turn(case, steps=256)
    assert np.trapezoid(fine.p, fine.V_e + fine.V_c) == pytest.approx(found.work, rel=2e-5)


def test_more_steps_change_nothing():
    coarse, fine = (turn(alpha(0.5), steps=steps) for steps in (8, 64))
    assert coarse.work == pytest.approx(fine.work, rel=1e-9)
    assert turn(alpha(0.5)).work == pytest.approx(fine.work, rel=1e-12)


@pytest.mark.parametrize(("ratio", "error"), [(1e3, 2e-5), (1e6, 1e-6)])
def test_gamma_to_one_is_schmidts_closed_form(ratio, error):
    # a rod of a thousand cranks leaves the volumes a thousandth away from sinusoidal, hence the first error
    isothermal = schmidt_closed_form(0.5)
    far, near = (turn(alpha(0.5, (1 + d, 287.0), length=0.06 * ratio)).work / isothermal - 1 for d in (4e-4, 2e-4))
    assert abs(2 * near - far) < error


@pytest.mark.slow
def test_film_to_infinity_is_schmidts_closed_form():
    isothermal = schmidt_closed_form(0.5)

    def error(film):
        case = dataclasses.replace(alpha(0.5, length=60.0), film_e=film, film_c=film)
        found = turn(case, steps=500)
        assert abs(found.residual) < 1e-10
        return found.work / isothermal - 1

    coarse, fine = error(20.0), error(40.0)
    assert fine == pytest.approx(coarse / 2, rel=0.06)
    assert abs(2 * fine - coarse) < 2e-3


def test_against_an_independent_integration():
    """Urieli's set of equations, temperatures as states, turn after turn by an adaptive method until periodic."""
    case, area = alpha(0.5), math.pi / 4 * 0.09**2
    R, gamma = 287.0, 1.4
    exchangers = case.V_h / 900 + case.V_r * math.log(900 / 330) / 570 + case.V_k / 330
    mass = turn(case).mass

    def x(phi):
        s, c, root = math.sin(phi), math.cos(phi), math.sqrt(0.26**2 - (0.06 * math.sin(phi)) ** 2)
        return 0.06 * (1 - c) + 0.26 - root, 0.06 * s + 0.06**2 * s * c / root

    def rate(phi, y):
        (x_e, dx_e), (x_c, dx_c) = x(phi + math.pi / 2), x(phi)
        v_e, v_c = 0.5e-4 + area * x_e, 0.4e-4 + area * x_c
        p = mass * R / (v_e / y[0] + v_c / y[1] + exchangers)
        T_e, T_c = y[0], y[1]
        for hot in (900.0, T_e):  # the directions that agree with themselves
            for cold in (330.0, T_c):
                dp = -gamma * p * (area * dx_c / cold + area * dx_e / hot)
                dp /= v_c / cold + gamma * exchangers + v_e / hot
                m_e = (p * area * dx_e + v_e * dp / gamma) / (R * hot)
                m_c = (p * area * dx_c + v_c * dp / gamma) / (R * cold)
                if (m_e > 0) == (hot == 900.0) and (m_c > 0) == (cold == 330.0):
                    break
            else:
                continue
            break
        slope_e = T_e * (dp / p + area * dx_e / v_e - m_e * R * T_e / (p * v_e))
        slope_c = T_c * (dp / p + area * dx_c / v_c - m_c * R * T_c / (p * v_c))
        return [slope_e, slope_c, p * area * (dx_e + dx_c)]

    y = [900.0, 330.0, 0.0]
    for _ in range(12):
        y = [*solve_ivp(rate, (0, 2 * math.pi), [*y[:2], 0.0], rtol=1e-9, atol=1e-9, max_step=0.02).y[:, -1]]
    assert turn(case).work == pytest.approx(y[2], rel=2e-6)


@pytest.mark.slow
@settings(max_examples=12)
@given(
    share=st.floats(0, 1), lead=st.floats(0.9, 2.2), T_h=st.floats(500, 1200), dead=st.floats(2e-5, 4e-4),
    gas=st.sampled_from(sorted(GASES)),
)  # fmt: skip
def test_any_engine_obeys_both_laws(share, lead, T_h, dead, gas):
    area, fluid = math.pi / 4 * 0.09**2, GASES[gas]
    base = alpha(share, (fluid.gamma, fluid.R), T_h=T_h)

    def volumes(phi):
        return 1e-4 * share + area * slider(phi + lead), 0.8e-4 * share + area * slider(phi)

    found = turn(dataclasses.replace(base, volumes=volumes, V_r=dead))
    assert abs(found.residual) < 1e-10
    assert found.work < (1 - 330.0 / T_h) * found.heat_in


def cylinders(**letters):
    given_ = {"bore": 0.09, "dead_hot": 1e-4, "dead_cold": 0.8e-4, "dead_regenerator": 1.2e-4, "T_e": 900.0,
              "T_c": 330.0, "mean_pressure": 5e5, "p_back": 5e5}  # fmt: skip
    return StirlingCylinders(**(given_ | letters))


@pytest.mark.parametrize("arrangement", ["alpha", "beta", "gamma"])
def test_arrangements_keep_their_clearances_and_their_push(arrangement):
    cycle = cylinders(arrangement=arrangement, rod_diameter=0.01, clearance_share_hot=0.2, clearance_share_cold=0.3)
    volumes = swept(cycle, (lambda a: slider(a + math.pi / 2), slider))
    angle = ca.SX.sym("phi")
    both = ca.vertcat(*volumes(angle))
    f = ca.Function("v", [angle], [both, ca.jacobian(both, angle)])
    phi = np.arange(3600) * math.pi / 1800
    volume, slope = (np.asarray(part) for part in f(phi.reshape(1, -1)))
    np.testing.assert_allclose(volume.min(axis=1), [0.2e-4, 0.24e-4], rtol=1e-4)
    # virtual work: what pushes the pistons is the slope of all the gas
    h = 1e-6
    dx = [(float(slider(1.0 + a + h)) - float(slider(1.0 + a - h))) / (2 * h) for a in (math.pi / 2, 0.0)]
    push = areas(cycle).sum(axis=0) @ dx
    assert float(ca.sum1(f(1.0)[1])) == pytest.approx(push, rel=1e-6)
    assert turn(five_spaces(cycle, volumes)).work > 0


def test_bad_input_names_the_way_out():
    with pytest.raises(BadInput, match="heat pump"):
        cylinders(T_e=300.0)
    with pytest.raises(BadInput, match="rod_diameter"):
        cylinders(rod_diameter=0.1)
    with pytest.raises(BadInput, match="options are air, helium, hydrogen"):
        cylinders(gas="argon")

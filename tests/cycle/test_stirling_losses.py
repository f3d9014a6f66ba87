"""Losses of a Stirling engine, each against another kind of answer: a grid, limits, hand values."""

import math

import numpy as np
import pytest
from scipy.linalg import solve_banded

from mechsym.cycle.kinds import stirling_films as film
from mechsym.cycle.kinds import stirling_losses as loss


def swinging_tube(Va, n=4000):
    """Dissipation of a laminar flow of sinusoidal mean speed, by that of a steady one, on a grid of the radius."""
    r = (np.arange(n) + 0.5) / n
    edge = np.arange(n + 1) / n
    inner, outer = edge[:-1] * n**2 / r, edge[1:] * n**2 / r
    outer[-1] *= 2  # half a cell to the wall
    diagonal = 1j * Va + inner + outer  # i omega u = G + (r u')'/r, radius and viscosity 1
    banded = np.array([np.append(0, -outer[:-1]), diagonal, np.append(-inner[1:], 0)])
    u = solve_banded((1, 1), banded, np.ones(n, dtype=complex))
    mean = complex((2 * r * u).sum() / n)
    return (1 / mean).real / 8  # gradient in phase with a mean speed of 1; Poiseuille has 8


@pytest.mark.parametrize("Va", [0.1, 10.0, 31.0, 300.0, 1000.0])
def test_laminar_flow_that_swings_is_that_of_the_grid(Va):
    assert film.laminar_swing(Va) == pytest.approx(swinging_tube(Va), rel=1e-5)


def test_laminar_flow_that_swings_has_its_limits():
    assert film.laminar_swing(0.0) == 1 == pytest.approx(film.laminar_swing(0.01), abs=1e-5)
    for Va in (9e4, 2e5):  # a boundary layer: sqrt(Va / 2) / 4, and a constant
        assert film.laminar_swing(Va) == pytest.approx(math.sqrt(Va / 2) / 4, rel=0.01)


def test_tubes_in_steady_flow_and_in_swinging_flow():
    assert film.tube_friction(1000.0) == 0.064
    assert film.tube_friction(1e4) == pytest.approx(0.0316)
    assert film.tube_friction(1000.0, Va=1000.0) == pytest.approx(0.064 * film.laminar_swing(1000.0))
    assert film.tube_nusselt(1000.0, 0.7, Va=0.1) == 3.66
    assert film.tube_nusselt(1000.0, 0.7, Va=360 / 1.4) == pytest.approx(3.66 * math.sqrt(10))
    # a quick swing stays laminar longer: 882 sqrt(900) is 26460
    assert film.turbulent_share(2e4, 900.0) == 0 < film.turbulent_share(2e4)
    # within a turbulent turn the slow instants are no less than laminar
    turn = np.array([100.0, 2e4])
    assert film.tube_friction(turn) == pytest.approx([0.64, 0.316 * 2e4**-0.25])
    assert film.tube_nusselt(turn, 0.7)[0] == 3.66


def test_bends_and_ends_by_hand():
    assert film.bend_heads(math.pi / 2, 1.0) == pytest.approx(1.05 * 0.21)
    assert film.bend_heads(math.pi, 4.0) == pytest.approx(1.4 * 0.105)
    assert film.bend_heads(math.radians(30), 1.0) == pytest.approx(0.45 * 0.21)
    steps = np.diff([film.bend_heads(math.radians(a), 2.0) for a in np.linspace(0, 180, 721)])
    assert (steps > 0).all() and steps.max() < 1e-3
    assert film.end_heads(0.0) == 1.5 and film.end_heads(1.0) == 0


def test_screens_against_the_laws_of_steady_flow():
    """Kays and London as fitted by Urieli and Berchowitz (1984): 4/Re (54 + 1.43 Re^0.78); within a factor of two."""
    Re = np.geomspace(5, 500, 20)
    steady = 4 / Re * (54 + 1.43 * Re**0.78)
    assert np.all((film.screen_friction(Re) / steady > 0.5) & (film.screen_friction(Re) / steady < 1.0))
    steady_nusselt = 0.46 * Re**0.6  # St Re Pr
    assert np.all(film.screen_nusselt(Re, 0.7, 0.7) / steady_nusselt > 0.5)
    assert np.all(film.screen_nusselt(Re, 0.7, 0.7) / steady_nusselt < 2.0)
    assert film.screen_friction(1.0) == pytest.approx(131.91)
    assert film.screen_nusselt(1e-9, 0.7, 1.0) == pytest.approx(1.0, abs=1e-5)


def test_conduction_along_screens_has_its_ends():
    assert film.screen_conductivity(0.2, 20.0, 1 - 1e-9) == pytest.approx(0.2, rel=1e-4)
    assert film.screen_conductivity(0.2, 20.0, 1e-9) == pytest.approx(20.0, rel=1e-4)
    assert film.screen_mixing(1e-9, 0.7, 0.7) == pytest.approx(0.73, abs=1e-4)


def resting_gas(Pe, n=4000):
    """Share of a gas between two plates that lags, by finite volumes: -Im of the mean of 1 - T over the half gap."""
    z2 = Pe / 8  # omega a^2 / (2 alpha): d = 4 a for a gap of 2 a
    h = 1 / n
    side = 1 / h**2
    diagonal = np.full(n, 2j * z2 + 2 * side)
    diagonal[0] -= side  # symmetry
    diagonal[-1] += side  # half a cell to the wall
    banded = np.array([np.append(0, -np.full(n - 1, side)), diagonal, np.append(-np.full(n - 1, side), 0)])
    T = solve_banded((1, 1), banded, np.full(n, 2j * z2))
    return -(1 - T.mean()).imag


@pytest.mark.parametrize("Pe", [0.01, 1.0, 10.0, 100.0])
def test_heat_that_lags_in_a_gas_at_rest_is_that_of_the_grid(Pe):
    assert loss.lagging_share(Pe) == pytest.approx(resting_gas(Pe), rel=1e-4)


def test_heat_that_lags_in_a_stirred_gas():
    Pe = 1784.0
    assert loss.lagging_share(Pe) > resting_gas(Pe)
    nusselt = 0.56 * Pe**0.69 * (1 + 1j)
    assert loss.lagging_share(Pe) == pytest.approx(-(nusselt / (nusselt + 1j * Pe)).imag)
    steps = np.array([loss.lagging_share(Pe) for Pe in np.geomspace(1e-3, 1e6, 3000)])
    assert abs(np.diff(steps)).max() < 0.004 and 0 < steps.min() < steps.max() < 0.42


def test_hysteresis_is_near_that_of_a_thin_layer():
    """Urieli and Berchowitz (1984): sqrt(omega gamma^3 (gamma-1) T p k/32) (dV/2V)^2 A, without its 2 (g-1)/g."""
    omega, gamma, T, p, k, ratio, area, volume = 262.0, 5 / 3, 300.0, 4e6, 0.15, 0.25, 0.03, 4.6e-4
    alpha = k * T * (gamma - 1) / (gamma * p)
    layer = math.sqrt(omega * gamma**3 * (gamma - 1) * T * p * k / 32) * (ratio / 2) ** 2 * area
    d = 4 * volume / area
    y = math.sqrt(omega * d**2 / (8 * alpha))
    found = loss.hysteresis_loss(omega, p, gamma * p * ratio / 2, volume, area, gamma, alpha)
    at_rest = found / loss.lagging_share(omega * d**2 / (4 * alpha)) / y
    assert at_rest == pytest.approx(layer * 2 * (gamma - 1) / gamma, rel=1e-9)
    assert at_rest < found < 4 * at_rest
    # a space so small that its gas follows the walls: as the square of the pressure
    low, high = (loss.hysteresis_loss(5.0, q, 0.3 * q, 2e-6, 2e-3, gamma, alpha * p / q) for q in (1e5, 2e5))
    assert high / low == pytest.approx(4, rel=1e-3)


def test_gap_by_its_published_sines():
    omega, swing, stroke, phase, gap, bore = 262.0, 1.4e6, 0.0315, 1.1, 2.8e-4, 0.0699
    t = np.arange(4096) * 2 * math.pi / 4096
    work = (swing * np.sin(t + phase) * stroke / 2 * omega * np.cos(t)).mean()
    assert work == pytest.approx(omega * swing * stroke * math.sin(phase) / 4)
    bracket = 2.5 * math.log(3.0) / 2 - 0.5
    want = math.pi * bore * gap * work * bracket
    assert loss.gap_enthalpy_loss(work, gap, bore, 5 / 3, 900.0, 300.0) == pytest.approx(want)
    assert loss.gap_enthalpy_loss(-work, gap, bore, 5 / 3, 900.0, 300.0) < 0  # a heat pump


def test_pumping_grows_as_the_powers_of_the_law():
    known = {"swing": 2.8e6, "frequency": 41.7, "gap": 2.8e-4, "length": 0.0436, "bore": 0.07, "k": 0.25,
             "gamma": 5 / 3, "T_hot": 900.0, "T_cold": 340.0}  # fmt: skip
    base = loss.pumping_loss(**known)
    for name, power in (("gap", 2.6), ("swing", 1.6), ("frequency", 1.6), ("length", 1), ("bore", 0.6), ("k", -0.6)):
        assert loss.pumping_loss(**(known | {name: 2 * known[name]})) == pytest.approx(base * 2**power)
    # by hand: (0.2199/0.25)^0.6 = 0.9260; 2*0.0436*560/1.5 = 32.55; (2.5*2*41.7*2.8e6/1240)^1.6 = 1.259e9
    assert base == pytest.approx(0.9260 * 32.55 * (2.5 * 2 * 41.7 * 2.8e6 / 1240) ** 1.6 * 2.8e-4**2.6, rel=1e-3)


def test_work_of_a_leak_is_its_volume_by_the_pressure():
    dp, gap, length, bore, rho, mu = 1.3e5, 2e-5, 0.02, 0.07, 4.0, 3e-5
    flow = loss.seal_flow(dp, gap, length, bore, rho, mu)
    assert loss.leakage_loss(dp**2, gap, length, bore, mu) == pytest.approx(flow / rho * dp)
    assert loss.bypass_loss(flow, 5193.0, 600.0) == pytest.approx(flow * 5193.0 * 300.0)


def test_the_shuttle_carries_what_its_displacement_leads_through_the_gap():
    """A piston x off its mean place sees the cylinder x dT/L warmer and carries that on: pi D k/gap dT/L mean(x^2)."""
    x = 0.031 / 2 * np.cos(np.arange(720) * 2 * np.pi / 720)
    wanted = np.pi * 0.07 * 0.2 / 0.00028 * 600.0 / 0.043 * np.mean(x**2)
    assert loss.shuttle_loss(0.031, 0.00028, 0.043, 0.07, 0.2, 600.0) == pytest.approx(wanted, rel=1e-12)

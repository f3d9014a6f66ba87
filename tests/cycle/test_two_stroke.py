"""The algebraic two-stroke cycle: its phases by their formulas, continuity, and the wanted mean pressure."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from shen2020 import SHEN_2020
from slider_crank import slider_crank

from mechsym.cycle.chamber import dvolume_dphi, piston_area, volume
from mechsym.cycle.gas import Gas, quadrature
from mechsym.cycle.kinds.two_stroke import (
    TwoStrokeMarine,
    back_pressure,
    events,
    kinks,
    scavenging_pressure,
    solve,
    two_stroke_pressure,
)
from mechsym.cycle.wiebe import double_wiebe
from mechsym.errors import BadInput

DEG = math.pi / 180


def marine_cycle(**changes) -> TwoStrokeMarine:
    values = {
        "bore": 0.3, "compression_ratio": 17.0, "mean_indicated_pressure": 8e5, "p_s": 1.6e5, "T_evc": 360.0,
        "evc": -110 * DEG, "soc": 0.0, "duration": 45 * DEG, "evo": 110 * DEG, "spo": 140 * DEG,
        "n_c": 1.40, "n_e": 1.30, **SHEN_2020[0], **changes,
    }  # fmt: skip
    return TwoStrokeMarine(**values)


LOADS = {
    "low": marine_cycle(),
    "high": marine_cycle(mean_indicated_pressure=20e5, p_s=3.6e5, **SHEN_2020[3]),
}


@pytest.mark.parametrize("load", LOADS)
def test_wanted_mean_pressure_is_met(load, marine):
    cycle = LOADS[load]
    pressure = two_stroke_pressure(cycle, marine)
    corners = [cycle.evc, cycle.soc, cycle.soc + cycle.duration, cycle.evo, cycle.spo, cycle.evc + 2 * math.pi]
    pieces = zip(corners, corners[1:], strict=False)
    work = sum(
        quad(lambda phi: float(pressure.absolute(phi) * dvolume_dphi(marine, phi)), a, b, epsabs=1e-9, epsrel=1e-13)[0]
        for a, b in pieces
    )
    assert work / marine.displacement == pytest.approx(cycle.mean_indicated_pressure, rel=1e-10)
    assert pressure.mean_indicated == pytest.approx(cycle.mean_indicated_pressure, rel=1e-13)


@pytest.mark.parametrize("load", LOADS)
def test_continuous_at_every_event_and_periodic(load, marine):
    cycle = LOADS[load]
    absolute = two_stroke_pressure(cycle, marine).absolute
    for angle in [*events(cycle).values(), *kinks(cycle), math.pi]:
        for turn in (0, -3, 5):
            left, at, right = absolute(angle + 2 * math.pi * turn + np.array([-1e-9, 0.0, 1e-9]))
            assert left == pytest.approx(at, rel=1e-6) and right == pytest.approx(at, rel=1e-6)
    phi = np.linspace(-2, 4, 201)
    assert np.allclose(absolute(phi), absolute(phi + 6 * math.pi), rtol=1e-11)


def test_smooth_between_the_kinks_and_only_there(marine):
    # the step of the slope over one grid step halves with the grid where p is smooth and stays where p has a corner
    cycle = LOADS["high"]
    absolute = two_stroke_pressure(cycle, marine).absolute

    def steps(count):
        phi = np.linspace(0, 2 * math.pi, count + 1)
        jump = np.abs(np.diff(absolute(phi), 2)) / phi[1]
        away = np.abs(phi[1:-1, None] - np.asarray(kinks(cycle)))
        return jump[away.min(axis=1) > 0.05].max(), [jump[column < 1e-3].max() for column in away.T[1:]]

    (smooth, corners), (smooth_fine, corners_fine) = steps(20000), steps(40000)
    assert smooth_fine == pytest.approx(smooth / 2, rel=0.01)
    assert np.all(np.array(corners_fine) > 0.6 * np.array(corners))


def test_compression_and_expansion_are_polytropic(marine):
    cycle = LOADS["low"]
    pressure = two_stroke_pressure(cycle, marine)

    def exponent(phi):
        return -np.polyfit(np.log(volume(marine, phi)), np.log(pressure.absolute(phi)), 1)[0]

    assert exponent(np.linspace(-109, -1, 50) * DEG) == pytest.approx(1.40, abs=1e-12)
    # burnt out by then: 1 - f < 1e-9 from 90 degrees on
    assert exponent(np.linspace(95, 109, 50) * DEG) == pytest.approx(1.30, abs=1e-6)


def test_combustion_interpolates_between_the_two_polytropes(marine):
    cycle, phi = LOADS["high"], 20 * DEG
    state, v = solve(cycle, marine), volume(marine, 20 * DEG) / marine.clearance
    f = double_wiebe(phi / cycle.duration, **SHEN_2020[3])
    expected = (1 - f) * state.p_comp * v**-1.40 + f * state.p_ref * v**-1.30
    assert two_stroke_pressure(cycle, marine).absolute(phi) == pytest.approx(expected, rel=1e-14)
    assert state.p_ref / state.p_comp == pytest.approx((state.T_comp + state.dT) / state.T_comp, rel=1e-14)


def test_blow_down_is_a_straight_line_to_the_scavenging_pressure(marine):
    cycle = LOADS["low"]
    pressure, state = two_stroke_pressure(cycle, marine), solve(cycle, marine)
    line = pressure.absolute(np.linspace(cycle.evo, cycle.spo, 31))
    assert np.abs(np.diff(line, 2)).max() < 1e-9 * state.p_evo
    assert line[0] == pytest.approx(state.p_evo, rel=1e-14) and line[-1] == pytest.approx(state.p_evc, rel=1e-14)
    assert np.all(pressure.absolute(np.linspace(141, 249, 50) * DEG) == state.p_evc)


def test_scavenging_pressure_as_published():
    # Shen et al. 2020: p_evc = 0.9749 p_s - 0.1029 bar
    assert scavenging_pressure(3.6e5) == pytest.approx((0.9749 * 3.6 - 0.1029) * 1e5, rel=1e-14)


def test_compression_ratio_is_geometric(marine):
    assert volume(marine, math.pi) / volume(marine, 0.0) == pytest.approx(17.0, rel=1e-14)
    # read as trapped, compression alone would reach 180 bar at full load, above the peaks of the source (125 bar)
    trapped = scavenging_pressure(3.6e5) * 17**1.4
    assert trapped > 175e5 > solve(LOADS["high"], marine).p_comp * 1.4


@pytest.mark.parametrize(
    ("load", "p_max_bar", "dT", "p_evo_bar"),
    [("low", (70, 80), (1300, 1500), (4, 5)), ("high", (170, 185), (1450, 1600), (10, 12))],
)
def test_size_of_the_built_in_loads(load, p_max_bar, dT, p_evo_bar, marine):
    pressure, state = two_stroke_pressure(LOADS[load], marine), solve(LOADS[load], marine)
    assert p_max_bar[0] < pressure.p_max / 1e5 < p_max_bar[1]
    assert 5 < math.degrees(pressure.phi_p_max) < 20
    assert dT[0] < state.dT < dT[1] and p_evo_bar[0] < state.p_evo / 1e5 < p_evo_bar[1]
    assert 1.8 < state.excess_air < 2.5 and 0.45 < state.efficiency < 0.58
    assert pressure.doubts == ()


def test_peaks_of_the_fitted_sets_rise_with_load_like_the_published_ones():
    # Shen et al. 2020: four plotted points peak at about 82, 105, 115, 125 bar. Their scavenge and mean pressures are
    # not printed in the material at hand: the values here are a propeller curve of such an engine, so only order counts
    cylinder = slider_crank(0.5, 1.55, 0.3, 14.5)
    points = [(1.9e5, 9e5), (2.5e5, 12.5e5), (3.0e5, 15.5e5), (3.4e5, 18e5)]
    peaks = [
        two_stroke_pressure(
            marine_cycle(compression_ratio=14.5, p_s=p_s, mean_indicated_pressure=p_mi, **fitted), cylinder
        ).p_max / 1e5
        for (p_s, p_mi), fitted in zip(points, SHEN_2020, strict=True)
    ]  # fmt: skip
    assert peaks == sorted(peaks) and 70 < peaks[0] < 90 and 110 < peaks[-1] < 150


def test_force_and_back_pressure(marine):
    pressure, area = two_stroke_pressure(LOADS["low"], marine), piston_area(0.3)
    phi = np.linspace(0, 7, 50)
    room = dataclasses.replace(marine, back_pressure=back_pressure(LOADS["low"]))
    force = Gas(pressure=pressure, chamber=room).force(phi)
    assert np.allclose(force, (pressure.absolute(phi) - 101325.0) * area, rtol=1e-15)
    assert back_pressure(dataclasses.replace(LOADS["low"], crank_side="scavenge")) == 1.6e5


def test_peak_is_the_largest_value(marine):
    pressure = two_stroke_pressure(LOADS["high"], marine)
    assert pressure.absolute(pressure.phi_p_max) == pressure.p_max
    assert pressure.p_max >= pressure.absolute(np.linspace(-1, 1, 200001)).max() * (1 - 1e-14)


def test_facts_say_what_was_assumed(marine):
    facts = " ".join(two_stroke_pressure(LOADS["low"], marine).facts)
    for word in ("geometric", "absolute", "mirror", "under the piston", "temperature rise", "atmosphere"):
        assert word in facts


def test_implausible_cycle_is_doubted(marine):
    pressure = two_stroke_pressure(marine_cycle(mean_indicated_pressure=25e5), marine)
    assert any("stoichiometric" in doubt for doubt in pressure.doubts)


def test_quadrature_integrates_a_kinked_function():
    phi, weights = quadrature(4 * math.pi, (1.0, 2.5))
    kinked = np.where(phi < 1.0, 0.0, np.where(phi < 2.5, phi - 1.0, 1.5))
    assert weights @ kinked == pytest.approx(1.5**2 / 2 + 1.5 * (4 * math.pi - 2.5), rel=1e-14)


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"evo": 150 * DEG}, "evo"),
        ({"soc": 50 * DEG, "evo": 45 * DEG}, "soc"),
        ({"evc": 10 * DEG}, "evc"),
        ({"compression_ratio": 1.0}, "compression_ratio"),
        ({"n_c": 0.9}, "n_c"),
        ({"b": 1.2}, "b"),
        ({"m_d": -0.5}, "m_d"),
        ({"p_s": 1.6}, "p_s"),
        ({"p_s": math.nan}, "p_s"),
        ({"crank_side": "vacuum"}, "crank_side"),
        ({"p_back": -1.0}, "p_back"),
    ],
)
def test_bad_inputs_are_refused_by_name(changes, named):
    with pytest.raises(BadInput, match=named):
        marine_cycle(**changes)


def test_mean_pressure_below_the_cycle_without_fuel_is_refused(marine):
    with pytest.raises(BadInput, match="needs no fuel"):
        two_stroke_pressure(marine_cycle(mean_indicated_pressure=1e4, n_c=1.4, n_e=1.2), marine)


@settings(deadline=None, derandomize=True, max_examples=25)
@given(
    p_mi=st.floats(4e5, 22e5),
    p_s=st.floats(1.3e5, 4e5),
    soc=st.floats(-8, 8),
    duration=st.floats(30, 70),
    n_c=st.floats(1.3, 1.42),
    n_e=st.floats(1.2, 1.35),
    fitted=st.sampled_from(SHEN_2020),
)
def test_any_cycle_is_closed_and_continuous(p_mi, p_s, soc, duration, n_c, n_e, fitted):
    cylinder = slider_crank(0.5, 1.55, 0.3, 17.0)
    cycle = marine_cycle(
        mean_indicated_pressure=p_mi, p_s=p_s, soc=soc * DEG, duration=duration * DEG, n_c=n_c, n_e=n_e, **fitted
    )
    pressure = two_stroke_pressure(cycle, cylinder)
    assert pressure.mean_indicated == pytest.approx(p_mi, rel=1e-12)
    at = np.asarray(pressure.kinks)
    assert np.allclose(pressure.absolute(at - 1e-10), pressure.absolute(at + 1e-10), rtol=1e-7)
    assert pressure.absolute(np.linspace(0, 7, 500)).min() > 0

"""Loads against the derived mechanism and against a beam solved numerically."""

import dataclasses

import casadi as ca
import numpy as np
import pytest

from mechsym.mechanisms.hypocycloid import HypocycloidParameters, build
from mechsym.mechanisms.record import bind
from mechsym.sizing.loads import (
    Spans,
    journal_load_massless,
    over_period,
    side_loads,
    side_vectors,
    tooth_load_printed,
    tooth_share_one_end,
)
from mechsym.sizing.rules.crankshaft import slider_crank_chain
from mechsym.sizing.rules.turning_shaft import Section, Shaft, fatigue_factor, inner_slope, moment, outer_shares

THETA = np.arange(720) * 4 * np.pi / 720
OMEGA = np.array([300.0, 800.0])
SPANS = Spans(inner=0.043, gear=0.0715, outer=0.099, outboard=0.118)


def reactions(parameters, force):
    function = build(parameters).functions["reactions"]
    shape = force.shape
    rows = {"theta": np.broadcast_to(THETA, shape), "thetad": np.broadcast_to(OMEGA[:, None], shape), "F": force}
    inputs = [ca.DM(np.reshape(rows.get(n, np.zeros(shape)), (1, -1))) for n in function.name_in()]
    return {n: np.asarray(v).reshape(shape) for n, v in zip(function.name_out(), function.call(inputs), strict=True)}


@pytest.fixture(scope="module")
def gas():
    return 2e4 * np.exp(-((np.cos(THETA / 2) - 1) ** 2) / 0.001)[None, :] * np.array([[1.0], [0.7]])


MASSES = HypocycloidParameters(e=0.013, I1=0.002, u1=-0.37 * 0.013, m2=0.37, I2=1e-5, m3=0.54, alpha_n=np.radians(25))
NO_MASS = dataclasses.replace(MASSES, m2=0.0, m3=0.0, u1=0.0, alpha_n=0.0)


def test_printed_tooth_load_is_that_of_the_derived_mechanism_without_mass(gas):
    out = reactions(NO_MASS, gas)
    assert np.abs(out["tooth_force"]) == pytest.approx(np.abs(tooth_load_printed(gas, THETA)), abs=1e-6)


def test_massless_journal_load_is_that_of_the_derived_mechanism(gas):
    out = reactions(NO_MASS, gas)
    found = np.hypot(out["journal_force_x"], out["journal_force_y"])
    assert found == pytest.approx(journal_load_massless(gas, THETA), abs=1e-6)


def test_side_loads_add_up_to_the_derived_journal_and_main_bearing(gas):
    out = reactions(MASSES, gas)
    spin = MASSES.m2 * MASSES.e * OMEGA**2
    vectors = side_vectors(out["pin_force"], out["tooth_force"], out["tooth_force_radial"], spin, THETA)
    force, teeth, centrifugal = vectors
    journal = np.array([out["journal_force_x"], out["journal_force_y"]])
    # the crank holds the planet: reaction = -(sum of what acts on the planet), both sides
    assert -2 * (force + teeth + centrifugal) == pytest.approx(journal, abs=1e-6)
    main = np.array([out["main_bearing_force_x"], out["main_bearing_force_y"]])
    assert -2 * (force + teeth) == pytest.approx(main, abs=1e-6)
    # when the outer places take nothing, everything is at the inner journal and the main bearing
    alone = side_loads(vectors, SPANS, (0.0, 0.0))
    assert 2 * alone["inner_journal"] == pytest.approx(np.hypot(*journal), abs=1e-6)
    assert 2 * alone["main"] == pytest.approx(np.hypot(*main), abs=1e-6)


def test_power_of_the_forces(gas):
    """Piston force times travel per angle equals the tooth load's and the journal's work: 2 e F sin(theta)."""
    out = reactions(MASSES, gas)
    assert out["piston_torque"] == pytest.approx(2 * MASSES.e * out["pin_force"] * np.sin(THETA), abs=1e-6)


def test_slider_crank_chain_is_the_derived_rod_force():
    sizes = {"r1": 0.0, "r2": 0.026, "l1": 0.045, "l2": 0.045, "I01": 0.002}
    values = dict.fromkeys(("m1", "m2", "m3", "m4", "m5", "IC2", "g", "axis_tilt"), 0.0) | sizes
    function = bind("crosshead", values).functions["kinematics"]
    dx = np.asarray(function.call([ca.DM(THETA).T])[function.name_out().index("dx_dphi")]).ravel()
    F = 1e4 * (1.2 + np.cos(THETA))[None, :]
    chain = slider_crank_chain(F, THETA, 0.026, 0.09)
    assert chain["tangential"][0] * 0.026 == pytest.approx(F[0] * dx, rel=1e-9, abs=1e-6)
    assert np.hypot(chain["tangential"], chain["radial"]) == pytest.approx(np.abs(chain["rod"]))


def beam_by_elements(shaft, half_force, load):
    """Oracle: half the shaft as Euler-Bernoulli elements, one a segment, slope 0 in the middle, both journals held."""
    z, face = shaft.spans, shaft.pin_half + shaft.web
    nodes = np.array([0, shaft.pin_half, face, z.inner, shaft.seat_end, z.gear, z.outer])
    solid = [(shaft.pin**4 - shaft.pin_bore**4), 1e4 * shaft.pin**4, shaft.seat**4, shaft.seat**4, *2 * [shaft.thin**4]]
    size = 2 * nodes.size
    K, f = np.zeros((size, size)), np.zeros(size)
    for i, (L, d4) in enumerate(zip(np.diff(nodes), solid, strict=True)):
        k = np.array([[12, 6 * L, -12, 6 * L], [6 * L, 4 * L**2, -6 * L, 2 * L**2],
                      [-12, -6 * L, 12, -6 * L], [6 * L, 2 * L**2, -6 * L, 4 * L**2]])  # fmt: skip
        K[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += 2e11 * np.pi / 64 * d4 / L**3 * k
    f[0], f[10] = half_force, load
    held = [1, 6, 12]  # slope in the middle, inner journal, outer journal
    free = np.setdiff1d(np.arange(size), held)
    u = np.zeros(size)
    u[free] = np.linalg.solve(K[np.ix_(free, free)], f[free])
    reaction = K @ u - f
    return reaction[6], reaction[12], u[7]


SHAFT = Shaft(
    spans=SPANS, pin=0.025, pin_bore=0.012, pin_half=0.017, web=0.015, seat=0.0193, seat_end=0.054, thin=0.015
)


@pytest.mark.parametrize(("force", "load"), [(1e4, 0.0), (0.0, 3e3), (1e4, -2e3)])
def test_outer_journal_takes_what_the_beam_says(force, load):
    s_F, s_T = outer_shares(SHAFT)
    inner, outer, slope = beam_by_elements(SHAFT, force, load)
    assert outer == pytest.approx(s_F * force - s_T * load, rel=2e-3)
    assert inner == pytest.approx(-(1 + s_F) * force - (1 - s_T) * load, rel=2e-3)
    at = np.array([force, 0.0])[:, None, None], np.array([load, 0.0])[:, None, None]
    found = inner_slope(SHAFT, 2e11, lambda z: moment(z, SPANS, (s_F, s_T), *at))
    assert found[0, 0] == pytest.approx(abs(slope), rel=5e-3)


def test_one_sided_take_off_is_never_an_equal_share():
    stiff, soft = tooth_share_one_end(SPANS, 1e6), tooth_share_one_end(SPANS, 0.0)
    assert stiff == pytest.approx(0.5, abs=1e-4) and soft == pytest.approx(1.5)


def test_pressure_over_the_period_is_that_of_the_closed_part_and_the_surroundings():
    phi = np.linspace(-np.pi, np.pi, 100)[None, :]
    found = over_period(THETA, phi, 5 + np.cos(phi), 1.0)[0]
    closed = (THETA <= np.pi) | (THETA >= 3 * np.pi)
    assert found[closed] == pytest.approx(5 + np.cos(THETA[closed]), abs=2e-3)
    assert np.all(found[~closed] == 1.0)


def test_a_turning_shaft_under_a_still_load_and_a_still_shaft_under_a_turning_load_are_alike():
    section = Section(d=0.02, S_e=3e8, S_ut=9e8)
    still, none = np.full((1, 720), 50.0), np.zeros((1, 720))
    turning = fatigue_factor(section, still, none, THETA, none)
    load = fatigue_factor(section, 50 * np.cos(THETA)[None, :], 50 * np.sin(THETA)[None, :], 0 * THETA, none)
    assert turning[0] == pytest.approx(load[0], rel=1e-9)
    assert turning[0] == pytest.approx(3e8 * np.pi * 0.02**3 / 32 / 50, rel=1e-6)


def test_each_of_24_fibres_of_a_turning_section_is_seen():
    random = np.random.default_rng(3)
    M_x, M_y, T = random.normal(20, 50, (3, 4, 90))
    turn = np.linspace(0, 4 * np.pi, 90, endpoint=False)
    section = Section(d=0.02, S_e=2e8, S_ut=8e8, K_f=1.6, K_fs=1.3, bore=0.008)
    solid = np.pi * section.d**3 / 32 * (1 - 0.4**4)
    used = []
    for alpha in np.radians(np.arange(0, 360, 15)):
        sigma = (M_x * np.cos(turn + alpha) + M_y * np.sin(turn + alpha)) / solid
        (sigma_a, sigma_m), (tau_a, tau_m) = ((np.ptp(s, axis=1) / 2, (s.max(axis=1) + s.min(axis=1)) / 2)
                                              for s in (sigma, T / (2 * solid)))  # fmt: skip
        amplitude = np.sqrt((1.6 * sigma_a) ** 2 + 3 * (1.3 * tau_a) ** 2)
        mean = np.sqrt((1.6 * np.maximum(sigma_m, 0)) ** 2 + 3 * (1.3 * tau_m) ** 2)
        used.append(amplitude / section.S_e + mean / section.S_ut)
    np.testing.assert_allclose(fatigue_factor(section, M_x, M_y, turn, T), 1 / np.max(used, axis=0), rtol=1e-13)

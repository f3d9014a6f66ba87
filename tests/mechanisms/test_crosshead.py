"""The crosshead engine against absolute coordinates, T - V, sympy's mechanics, and its limits."""

import dataclasses
import math

import casadi as ca
import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st
from rigid_bodies import System, lagrange, motion
from sympy.physics.mechanics import LagrangesMethod, Particle, Point, ReferenceFrame, RigidBody, dynamicsymbols, inertia

from mechsym.errors import BadInput
from mechsym.mechanisms.crank_throw import CrankThrowParameters
from mechsym.mechanisms.crank_throw import build as build_throw
from mechsym.mechanisms.crosshead import CrossheadParameters, build
from mechsym.mechanisms.record import curves
from mechsym.mechanisms.state import state

STATE = {"phi": 1.0, "phid": 9.32, "F": 1e5, "M_r": 9000.0, "M_h": -20000.0}


def numbers(low, high):
    return st.floats(low, high, allow_nan=False)


parameters = st.builds(
    CrossheadParameters,
    r1=numbers(0, 0.5),
    r2=numbers(0.05, 0.5),
    l1=numbers(0.6, 2),
    l2=numbers(0.6, 2),
    **{f"m{i}": numbers(0, 20) for i in (1, 2, 3, 4, 5)},
    I01=numbers(0.1, 50),
    IC2=numbers(0, 20),
    g=st.sampled_from((0.0, 9.81)),
    axis_tilt=numbers(-2, 2),
)
states = st.fixed_dictionaries(
    {"phi": numbers(-7, 7), "phid": numbers(-20, 20)} | {n: numbers(-100, 100) for n in ("F", "M_r", "M_h")}
)


def absolute(p: CrossheadParameters, s) -> System:
    """Crank, rod, crosshead; pins as constraints, in the order of the joints of the derivation."""
    down = (-p.g * math.sin(p.axis_tilt), -p.g * math.cos(p.axis_tilt))
    cross = p.m3 + p.m4 + p.m5

    def joints(X):
        xc, yc, a, xr, yr, b, x, y, turn = (X[i] for i in range(9))
        pin = ca.vertcat(xc + p.r2 * ca.cos(a), yc + p.r2 * ca.sin(a))
        return ca.vertcat(
            xc - p.r1 * ca.cos(a),
            yc - p.r1 * ca.sin(a),
            xr - p.l1 * ca.cos(b) - pin[0],
            yr - p.l1 * ca.sin(b) - pin[1],
            x - xr - p.l2 * ca.cos(b),
            y - yr - p.l2 * ca.sin(b),
            y,
            turn,
        )

    def forces(X):
        rows = [m * d for m in (p.m1, p.m2, cross) for d in down]
        return [*rows[:2], s["M_h"] - s["M_r"], *rows[2:4], 0, rows[4] - s["F"], rows[5], 0]

    return System((p.m1, p.m2, cross), (p.I01 - p.m1 * p.r1**2, p.IC2, 1.0), joints, forces)


def guess(p, phi):
    r, l = p.r1 + p.r2, p.l1 + p.l2
    psi = math.asin(r / l * math.sin(phi))
    c, s = math.cos(phi), math.sin(phi)
    rod = (r * c + p.l1 * math.cos(psi), p.l2 * math.sin(psi), -psi)
    return np.array([p.r1 * c, p.r1 * s, phi, *rod, r * c + l * math.cos(psi), 0, 0])


@given(parameters, states)
def test_motion_and_reactions_agree_with_absolute_coordinates(p, s):
    found = state(build(p), s)
    out = found.outputs
    truth = motion(absolute(p, s), guess(p, s["phi"]), 2, s["phi"], s["phid"])
    scale = 1 + np.abs(truth.joint_forces).max()
    assert found.acceleration[0] == pytest.approx(truth.acceleration[2], rel=1e-10, abs=1e-10)
    assert p.r1 + p.r2 + p.l1 + p.l2 - out["x"] == pytest.approx(truth.pose[6], rel=1e-13)
    assert -out["dx_dphi"] * s["phid"] == pytest.approx(truth.velocity[6], abs=1e-11)
    assert out["psi"] == pytest.approx(-truth.pose[5], abs=1e-13)
    for name, force in zip(("x_O", "y_O", "x_A", "y_A", "x_B", "y_B", "y_G"), truth.joint_forces, strict=False):
        assert out[f"R_{name}"] == pytest.approx(force, abs=1e-9 * scale), name


@given(parameters, states)
def test_acceleration_agrees_with_t_minus_v(p, s):
    r, l, cross = p.r1 + p.r2, p.l1 + p.l2, p.m3 + p.m4 + p.m5

    def places(q):
        psi = ca.asin(r / l * ca.sin(q))
        rod = ca.vertcat(r * ca.cos(q) + p.l1 * ca.cos(psi), p.l2 * ca.sin(psi))
        return ca.vertcat(p.r1 * ca.cos(q), p.r1 * ca.sin(q)), rod, r * ca.cos(q) + l * ca.cos(psi), psi

    def kinetic(q, u):
        _, rod, x, psi = places(q)
        parts = p.m2 * ca.sumsqr(ca.jacobian(rod, q)) + p.IC2 * ca.jacobian(psi, q) ** 2
        return (p.I01 + parts + cross * ca.jacobian(x, q) ** 2) * u**2 / 2

    def potential(q):
        crank, rod, x, _ = places(q)
        up = (math.sin(p.axis_tilt), math.cos(p.axis_tilt))
        heights = p.m1 * (crank[0] * up[0] + crank[1] * up[1]) + p.m2 * (rod[0] * up[0] + rod[1] * up[1])
        return p.g * (heights + cross * x * up[0])

    def force(q, u):
        return -s["F"] * ca.gradient(places(q)[2], q) + s["M_h"] - s["M_r"]

    truth = float(lagrange(kinetic, potential, force, 1)(s["phi"], s["phid"]))
    assert state(build(p), s).acceleration[0] == pytest.approx(truth, rel=1e-10, abs=1e-10)


def test_acceleration_agrees_with_sympy_mechanics(zotov):
    r1, r2, l1, l2, m1, m2, m3, I01, IC2, g, F, M = sp.symbols("r1 r2 l1 l2 m1 m2 m3 I01 IC2 g F M")
    phi = dynamicsymbols("phi")
    psi = sp.asin((r1 + r2) / (l1 + l2) * sp.sin(phi))
    N, O = ReferenceFrame("N"), Point("O")
    O.set_vel(N, 0)
    crank, rod = N.orientnew("crank", "Axis", [phi, N.z]), N.orientnew("rod", "Axis", [-psi, N.z])
    C1, A = O.locatenew("C1", r1 * crank.x), O.locatenew("A", (r1 + r2) * crank.x)
    C2, B = A.locatenew("C2", l1 * rod.x), A.locatenew("B", (l1 + l2) * rod.x)
    for point in (C1, A, C2, B):
        point.set_vel(N, point.pos_from(O).dt(N))
    bodies = [
        RigidBody("crank", C1, crank, m1, (inertia(crank, 0, 0, I01 - m1 * r1**2), C1)),
        RigidBody("rod", C2, rod, m2, (inertia(rod, 0, 0, IC2), C2)),
        Particle("cross", B, m3),
    ]
    loads = [(B, -F * N.x), (crank, M * N.z), (C1, -m1 * g * N.y), (C2, -m2 * g * N.y), (B, -m3 * g * N.y)]
    method = LagrangesMethod(sum(b.kinetic_energy(N) for b in bodies), [phi], forcelist=loads, frame=N)
    method.form_lagranges_equations()
    p = zotov
    values = {r1: p.r1, r2: p.r2, l1: p.l1, l2: p.l2, m1: p.m1, m2: p.m2, m3: p.m3 + p.m4 + p.m5}
    values |= {I01: p.I01, IC2: p.IC2, g: p.g, F: STATE["F"], M: STATE["M_h"] - STATE["M_r"]}
    at = [(phi.diff(), STATE["phid"]), (phi, STATE["phi"])]
    mass = float(method.mass_matrix[0].subs(at).subs(values))
    force = float(method.forcing[0].subs(at).subs(values))
    assert state(build(zotov), STATE).acceleration[0] == pytest.approx(force / mass, rel=1e-12)


@given(parameters, states)
def test_every_body_is_in_balance(p, s):
    found = state(build(p), s)
    o, a, w = found.outputs, found.acceleration[0], s["phid"]
    r, l = p.r1 + p.r2, p.l1 + p.l2
    down = -p.g * np.array([math.sin(p.axis_tilt), math.cos(p.axis_tilt)])
    R = {n: np.array([o[f"R_x_{n}"], o[f"R_y_{n}"]]) for n in "OAB"}
    n, c, psi = math.sin(s["phi"]), math.cos(s["phi"]), o["psi"]
    turn = o["dpsi_dphi"] * w
    turning = (o["dpsi_dphi"] * a) + (-r / l * n + math.sin(psi) * o["dpsi_dphi"] ** 2) / math.cos(psi) * w**2
    radial, tangent = np.array([c, n]), np.array([-n, c])
    rod, across = np.array([math.cos(psi), -math.sin(psi)]), np.array([-math.sin(psi), -math.cos(psi)])
    pin = r * (a * tangent - w**2 * radial)
    C2 = pin + p.l1 * (turning * across - turn**2 * rod)
    B = pin + l * (turning * across - turn**2 * rod)
    scale = 1 + max(np.abs(v).max() for v in R.values()) + abs(p.I01 * a) + abs(o["R_y_G"])
    assert np.abs(R["O"] - R["A"] + p.m1 * (down - p.r1 / r * pin)).max() < 1e-10 * scale

    def moment(arm, force):
        return arm[0] * force[1] - arm[1] * force[0]

    about_O = s["M_h"] - s["M_r"] - moment(r * radial, R["A"]) + moment(p.r1 * radial, p.m1 * down)
    assert abs(about_O - p.I01 * a) < 1e-10 * scale
    assert np.abs(R["A"] - R["B"] + p.m2 * (down - C2)).max() < 1e-10 * scale
    about_C2 = moment(-p.l1 * rod, R["A"]) - moment(p.l2 * rod, R["B"])
    assert abs(about_C2 + p.IC2 * turning) < 1e-10 * scale
    cross = p.m3 + p.m4 + p.m5
    assert abs(R["B"][0] - s["F"] + cross * (down[0] - B[0])) < 1e-10 * scale
    assert abs(R["B"][1] + o["R_y_G"] + cross * down[1]) < 1e-10 * scale


def test_a_long_rod_tends_to_the_scotch_yoke(zotov):
    phi = np.linspace(0, 6.3, 40)
    errors = []
    for l in (50.0, 500.0):
        found = curves(build(dataclasses.replace(zotov, l1=l / 2, l2=l / 2)), phi)
        errors.append(np.abs(found["x"] - 0.5 * (1 - np.cos(phi))).max())
    assert errors[0] < 3e-3
    assert errors[1] == pytest.approx(errors[0] / 10, rel=1e-3)


def test_without_rod_and_pistons_it_is_a_wheel(zotov):
    wheel = dataclasses.replace(zotov, m2=0, m3=0, m4=0, m5=0, IC2=0, g=0)
    found = state(build(wheel), STATE | {"F": 0})
    assert found.acceleration[0] == pytest.approx(-29000 / 30, rel=1e-14)


def test_hinge_off_is_the_engine_alone(zotov):
    off = state(build(zotov), STATE | {"M_h": 0.0})
    on = state(build(zotov), STATE)
    torque = on.mass_matrix[0][0] * (on.acceleration[0] - off.acceleration[0])
    assert torque == pytest.approx(STATE["M_h"], rel=1e-12)


@given(parameters, states)
def test_it_is_a_crank_throw_without_offset(p, s):
    throw = CrankThrowParameters(
        r=p.r1 + p.r2,
        **{"l1": p.l1, "l2": p.l2, "m0": p.m1, "m_rod": p.m2, "m_piston": p.m3 + p.m4 + p.m5, "I0": p.I01},
        **{"I_rod": p.IC2, "u0": p.m1 * p.r1, "g": p.g, "axis_tilt": p.axis_tilt},
    )
    here = state(build(p), s)
    there = state(build_throw(throw), s | {"M": s["M_h"] - s["M_r"]})
    scale = 1 + max(abs(v) for v in here.outputs.values())
    assert here.acceleration == pytest.approx(there.acceleration, rel=1e-10, abs=1e-9)
    for name, value in there.outputs.items():
        assert here.outputs[name] == pytest.approx(value, abs=1e-9 * scale), name


def test_the_crank_angle_is_periodic_and_the_travel_symmetric(zotov):
    phi = np.linspace(0.1, 3.0, 30)
    here, there, back = (curves(build(zotov), angles) for angles in (phi, phi + 2 * np.pi, -phi))
    assert here["inertia"] == pytest.approx(there["inertia"], rel=1e-13)
    assert here["x"] == pytest.approx(back["x"], rel=1e-12)
    assert here["dx_dphi"] == pytest.approx(-back["dx_dphi"], rel=1e-12)


def test_a_flywheel_only_adds_inertia(zotov):
    heavy = state(build(dataclasses.replace(zotov, I01=zotov.I01 + 100.0)), STATE)
    assert heavy.mass_matrix[0][0] - state(build(zotov), STATE).mass_matrix[0][0] == pytest.approx(100, rel=1e-12)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [({"l1": 0.0, "l2": 0.4}, "rod too short"), ({"m3": -1}, "m3 = -1 kg"), ({"r1": 0, "r2": 0}, "no crank")],
)
def test_impossible_data_are_refused(zotov, wrong, message):
    with pytest.raises(BadInput, match=message):
        dataclasses.replace(zotov, **wrong)

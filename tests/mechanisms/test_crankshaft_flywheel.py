"""Crankshaft and flywheel against absolute coordinates, T - V, sympy's mechanics; the printed model beside it."""

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

from mechsym import mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms.crankshaft_flywheel import CrankshaftFlywheelParameters, build
from mechsym.mechanisms.state import state

STATE = {"phi0": 1.0, "phi2": 0.99, "phi0d": 50.0, "phi2d": 51.0, "M": 1.5}


def numbers(low, high):
    return st.floats(low, high, allow_nan=False)


parameters = st.builds(
    CrankshaftFlywheelParameters,
    I0=numbers(0.05, 5),
    I2=numbers(0.05, 5),
    r=numbers(0.01, 0.5),
    l=numbers(0.6, 3),
    m0=numbers(0, 5),
    k1=numbers(0, 1000),
    c1=numbers(0, 10),
)
states = st.fixed_dictionaries(
    {"phi0": numbers(-7, 7), "phi2": numbers(-7, 7), "phi0d": numbers(-20, 20), "phi2d": numbers(-20, 20)}
    | {"M": numbers(-50, 50), "F": numbers(-100, 100)}
)


def shaft_torque(p, s):
    return p.k1 * (s["phi0"] - s["phi2"]) + p.c1 * (s["phi0d"] - s["phi2d"])


@given(parameters, states)
def test_motion_and_rod_force_agree_with_absolute_coordinates(p, s):
    """Crank and piston at a distance l of the pin; the massless rod is the one constraint between them."""

    def joints(X):
        xc, yc, a, x, y, turn = (X[i] for i in range(6))
        rod = ca.sqrt((x - xc - p.r * ca.cos(a)) ** 2 + (y - yc - p.r * ca.sin(a)) ** 2)
        return ca.vertcat(xc, yc, rod - p.l, y, turn)

    def forces(X):
        return [0, 0, s["M"] - shaft_torque(p, s), -s["F"], 0, 0]

    system = System((1.0, p.m0), (p.I0, 1.0), joints, forces)
    c, n = math.cos(s["phi0"]), math.sin(s["phi0"])
    guess = np.array([0, 0, s["phi0"], p.r * c + math.sqrt(p.l**2 - (p.r * n) ** 2), 0, 0])
    truth = motion(system, guess, 2, s["phi0"], s["phi0d"])
    found = state(build(p), s)
    assert found.acceleration[0] == pytest.approx(truth.acceleration[2], rel=1e-10, abs=1e-10)
    assert found.acceleration[1] == pytest.approx(shaft_torque(p, s) / p.I2, rel=1e-12, abs=1e-12)
    assert p.r + p.l - found.outputs["x0"] == pytest.approx(truth.pose[3], rel=1e-13)
    # the multiplier stretches the rod: positive multiplier, compressed rod
    scale = 1 + np.abs(truth.joint_forces).max()
    assert found.outputs["rod_force"] == pytest.approx(-truth.joint_forces[2], abs=1e-9 * scale)


@given(parameters, states)
def test_acceleration_agrees_with_t_minus_v(p, s):
    def piston(q):
        return p.r * ca.cos(q[0]) + p.l * ca.cos(ca.asin(p.r / p.l * ca.sin(q[0])))

    def kinetic(q, u):
        return (p.I0 * u[0] ** 2 + p.I2 * u[1] ** 2 + p.m0 * ca.jtimes(piston(q), q, u) ** 2) / 2

    def force(q, u):
        loss = p.c1 * (u[0] - u[1])
        return ca.vertcat(s["M"] - loss, loss) - s["F"] * ca.gradient(piston(q), q)

    function = lagrange(kinetic, lambda q: p.k1 * (q[0] - q[1]) ** 2 / 2, force, 2)
    truth = np.asarray(function([s["phi0"], s["phi2"]], [s["phi0d"], s["phi2d"]])).ravel()
    assert state(build(p), s).acceleration == pytest.approx(truth, rel=1e-10, abs=1e-10)


def test_acceleration_agrees_with_sympy_mechanics(chmielewski):
    I0, I2, r, l, m0, k1, M, F = sp.symbols("I0 I2 r l m0 k1 M F")
    phi0, phi2 = dynamicsymbols("phi0 phi2")
    N, O = ReferenceFrame("N"), Point("O")
    O.set_vel(N, 0)
    crank, disc = N.orientnew("crank", "Axis", [phi0, N.z]), N.orientnew("disc", "Axis", [phi2, N.z])
    B = O.locatenew("B", (r * sp.cos(phi0) + sp.sqrt(l**2 - r**2 * sp.sin(phi0) ** 2)) * N.x)
    B.set_vel(N, B.pos_from(O).dt(N))
    piston = Particle("piston", B, m0)
    piston.potential_energy = k1 * (phi0 - phi2) ** 2 / 2
    bodies = [
        RigidBody("crank", O, crank, 0, (inertia(crank, 0, 0, I0), O)),
        RigidBody("disc", O, disc, 0, (inertia(disc, 0, 0, I2), O)),
        piston,
    ]
    T = sum(b.kinetic_energy(N) for b in bodies)
    loads = [(B, -F * N.x), (crank, M * N.z)]
    method = LagrangesMethod(T - piston.potential_energy, [phi0, phi2], forcelist=loads, frame=N)
    method.form_lagranges_equations()
    p, s = chmielewski, STATE | {"F": 120.0}
    at = [(phi0.diff(), s["phi0d"]), (phi2.diff(), s["phi2d"]), (phi0, s["phi0"]), (phi2, s["phi2"])]
    values = {I0: p.I0, I2: p.I2, r: p.r, l: p.l, m0: p.m0, k1: p.k1, M: s["M"], F: s["F"]}
    mass, force = (np.array(v.subs(at).subs(values), float) for v in (method.mass_matrix, method.forcing))
    truth = np.linalg.solve(mass, force).ravel()
    assert state(build(p), s).acceleration == pytest.approx(truth, rel=1e-12)


@given(parameters, states)
def test_power_is_balanced(p, s):
    m = build(p)
    found, out = state(m, s), state(m, s).outputs
    q, u = ca.SX.sym("q", 2), ca.SX.sym("u", 2)
    total = sum(m.functions["energy"](*ca.vertsplit(q), *ca.vertsplit(u)))
    rate = ca.Function("rate", [q, u], [ca.gradient(total, q), ca.gradient(total, u)])
    rates = np.array([s["phi0d"], s["phi2d"]])
    by_q, by_u = (np.asarray(v).ravel() for v in rate([s["phi0"], s["phi2"]], rates))
    change = by_q @ rates + by_u @ np.array(found.acceleration)
    power = s["M"] * s["phi0d"] + s["F"] * out["dx0_dphi0"] * s["phi0d"] - p.c1 * (rates[0] - rates[1]) ** 2
    scale = 1 + np.abs([*(by_q * rates), *(by_u * found.acceleration), power]).max()
    assert abs(change - power) < 1e-11 * scale


def test_a_long_rod_tends_to_the_scotch_yoke(chmielewski):
    s, errors = STATE | {"F": 100.0}, []
    m0, r, I0 = chmielewski.m0, chmielewski.r, chmielewski.I0
    n, c = math.sin(1.0), math.cos(1.0)
    torque = 1.5 - shaft_torque(chmielewski, s) + 100.0 * r * n - m0 * r**2 * n * c * 50.0**2
    limit = torque / (I0 + m0 * r**2 * n**2)
    for l in (30.0, 300.0):
        errors.append(abs(state(build(dataclasses.replace(chmielewski, l=l)), s).acceleration[0] - limit))
    assert errors[1] == pytest.approx(errors[0] / 10, rel=0.02)
    assert errors[1] < 2e-3 * abs(limit)


def build_printed(parameters):
    return mechanisms.build("crankshaft_flywheel_printed", parameters)


def test_printed_model_equals_the_exact_one_only_as_the_rod_grows(chmielewski):
    """(6) with (11): the exact transmission against the first order of the acceleration."""
    gap = []
    for l in (0.26, 2.6, 26.0):
        p = dataclasses.replace(chmielewski, l=l)
        exact, printed = (state(make(p), STATE).acceleration[0] for make in (build, build_printed))
        gap.append(abs(printed - exact))
    assert gap[0] > 0.01
    assert gap[1] < 0.05 * gap[0]
    assert gap[2] < 0.05 * gap[1]


def test_printed_model_is_equation_6_with_11(chmielewski):
    p, s = chmielewski, STATE
    phi, w, lam = s["phi0"], s["phi0d"], p.r / p.l
    transmission = math.sin(phi) + lam * math.sin(phi) * math.cos(phi) / math.sqrt(1 - (lam * math.sin(phi)) ** 2)
    found = state(build_printed(p), s).acceleration

    def residual(phidd):
        xdd = p.r * (
            phidd * (math.sin(phi) + lam / 2 * math.sin(2 * phi)) + w**2 * (math.cos(phi) + lam * math.cos(2 * phi))
        )  # (11)
        return s["M"] / p.I0 - transmission * p.r * p.m0 * xdd / p.I0 - p.k1 * (phi - s["phi2"]) / p.I0 - phidd  # (6)

    assert residual(found[0]) == pytest.approx(0, abs=1e-10 * abs(found[0]))


@pytest.mark.parametrize(
    ("wrong", "message"), [({"l": 0.05}, "rod too short"), ({"I0": 0}, "I0 = 0"), ({"c1": -1}, "c1")]
)
def test_impossible_data_are_refused(chmielewski, wrong, message):
    with pytest.raises(BadInput, match=message):
        dataclasses.replace(chmielewski, **wrong)

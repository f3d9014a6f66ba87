"""The hypocycloid against absolute coordinates, T - V, sympy's mechanics, and the formulas of Nunes (2017)."""

import dataclasses
import math

import casadi as ca
import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from rigid_bodies import System, lagrange, motion, relative
from sympy.physics.mechanics import LagrangesMethod, Particle, Point, ReferenceFrame, RigidBody, dynamicsymbols, inertia

from mechsym.errors import BadInput
from mechsym.mechanisms.hypocycloid import HypocycloidParameters, build
from mechsym.mechanisms.record import curves
from mechsym.mechanisms.state import state

SAMPLE = HypocycloidParameters(e=0.013, I1=2e-3, u1=4e-3, m2=0.31, I2=8e-5, m3=0.25, alpha_n=math.radians(25))
STATE = {"theta": 0.8, "thetad": 310.0, "F": 2.1e4, "M": 35.0}


def numbers(low, high):
    return st.floats(low, high, allow_nan=False)


parameters = st.builds(
    HypocycloidParameters,
    e=numbers(0.01, 1),
    I1=numbers(0.01, 5),
    u1=numbers(-2, 2),
    m2=numbers(0, 5),
    I2=numbers(0, 1),
    m3=numbers(0, 5),
    alpha_n=numbers(0, 1),
)
states = st.fixed_dictionaries(
    {"theta": numbers(-7, 7), "thetad": numbers(-20, 20), "F": numbers(-100, 100), "M": numbers(-50, 50)}
)


def absolute(p: HypocycloidParameters, F: float, M: float, radial: float) -> System:
    """Crank, planet, piston; the ring's tooth force is the multiplier of rolling, its radial part is applied."""
    arm = 0.5 * p.e  # any place for the unbalance: u1 = mass times arm
    mass = p.u1 / arm

    def joints(X):
        xc, yc, a, xp, yp, b, x, y, turn = (X[i] for i in range(9))
        return ca.vertcat(
            xc - arm * ca.cos(a),
            yc - arm * ca.sin(a),
            xp - xc - (p.e - arm) * ca.cos(a),
            yp - yc - (p.e - arm) * ca.sin(a),
            p.e * (b + ca.atan2(yp, xp)),
            x - xp - p.e * ca.cos(b),
            y,
            turn,
        )

    def forces(X):
        xp, yp = X[3], X[4]
        return [0, 0, -M, -radial * xp / p.e, -radial * yp / p.e, 0, -F, 0, 0]

    return System((mass, p.m2, p.m3), (p.I1 - mass * arm**2, p.I2, 1.0), joints, forces)


def guess(p, theta):
    c, s = p.e * math.cos(theta), p.e * math.sin(theta)
    return np.array([c / 2, s / 2, theta, c, s, -theta, 2 * c, 0, 0])


def oracle(p, s):
    """Acceleration and joint forces in absolute coordinates; theta is taken within (-pi, pi) for the rolling angle."""
    theta = math.remainder(s["theta"], 2 * math.pi)
    without = motion(absolute(p, s["F"], s["M"], 0.0), guess(p, theta), 2, theta, s["thetad"])
    radial = abs(without.joint_forces[4]) * math.tan(p.alpha_n)
    return motion(absolute(p, s["F"], s["M"], radial), guess(p, theta), 2, theta, s["thetad"])


@settings(deadline=None, derandomize=True, max_examples=40)
@given(parameters, states)
def test_motion_and_reactions_agree_with_absolute_coordinates(p, s):
    found, truth = state(build(p), s), oracle(p, s)
    out = found.outputs
    assert found.acceleration[0] == pytest.approx(truth.acceleration[2], rel=1e-10, abs=1e-9)
    assert out["x"] == pytest.approx(2 * p.e - truth.pose[6], abs=1e-13)
    assert out["dx_dtheta"] * s["thetad"] == pytest.approx(-truth.velocity[6], abs=1e-12)
    forces = truth.joint_forces
    scale = np.abs(forces).max() + 1
    names = ["main_bearing_force_x", "main_bearing_force_y", "journal_force_x", "journal_force_y", "tooth_force"]
    for name, force in zip([*names, "pin_force"], forces, strict=False):
        assert out[name] == pytest.approx(force, abs=1e-9 * scale), name


@settings(deadline=None, derandomize=True, max_examples=40)
@given(parameters, states)
def test_acceleration_agrees_with_t_minus_v(p, s):
    def kinetic(q, u):
        c, pin = p.e * ca.vertcat(ca.cos(q), ca.sin(q)), 2 * p.e * ca.cos(q)
        linear = p.m2 * ca.sumsqr(ca.jacobian(c, q)) + p.m3 * ca.jacobian(pin, q) ** 2
        return (p.I1 + p.I2 + linear) * u**2 / 2

    def force(q, u):
        return -s["F"] * ca.gradient(2 * p.e * ca.cos(q), q) - s["M"]

    truth = float(lagrange(kinetic, lambda q: 0, force, 1)(s["theta"], s["thetad"]))
    assert state(build(p), s).acceleration[0] == pytest.approx(truth, rel=1e-10, abs=1e-10)


def test_acceleration_agrees_with_sympy_mechanics():
    e, I1, I2, m2, m3, F, M = sp.symbols("e I1 I2 m2 m3 F M")
    theta = dynamicsymbols("theta")
    N, O = ReferenceFrame("N"), Point("O")
    O.set_vel(N, 0)
    A, B = N.orientnew("A", "Axis", [theta, N.z]), N.orientnew("B", "Axis", [-theta, N.z])
    C = O.locatenew("C", e * A.x)
    P = C.locatenew("P", e * B.x)
    for point in (C, P):
        point.set_vel(N, point.pos_from(O).dt(N))
    bodies = [
        RigidBody("crank", O, A, 0, (inertia(A, 0, 0, I1), O)),
        RigidBody("planet", C, B, m2, (inertia(B, 0, 0, I2), C)),
        Particle("piston", P, m3),
    ]
    T = sum(body.kinetic_energy(N) for body in bodies)
    method = LagrangesMethod(T, [theta], forcelist=[(P, -F * N.x), (A, -M * N.z)], frame=N)
    method.form_lagranges_equations()
    p = SAMPLE
    rate = theta.diff()
    values = {e: p.e, I1: p.I1, I2: p.I2, m2: p.m2, m3: p.m3, F: STATE["F"], M: STATE["M"]}
    right = method.rhs()[1].subs(rate, STATE["thetad"]).subs(theta, STATE["theta"]).subs(values)
    assert state(build(p), STATE).acceleration[0] == pytest.approx(float(right), rel=1e-12)


def test_torque_and_tooth_force_are_the_papers():
    """Thesis: torque 2 e F_n sin(theta) (2.73), tooth force F_n sin(theta) (2.75), here with the planet's inertia."""
    found = state(build(SAMPLE), STATE)
    out, acceleration, p = found.outputs, found.acceleration[0], SAMPLE
    xdd = out["dx_dtheta"] * acceleration + out["d2x_dtheta2"] * STATE["thetad"] ** 2
    F_n = STATE["F"] - p.m3 * xdd
    s = math.sin(STATE["theta"])
    assert out["pin_force"] == pytest.approx(F_n, rel=1e-12)
    assert out["piston_torque"] == pytest.approx(2 * p.e * F_n * s, rel=1e-12)
    assert out["tooth_force"] == pytest.approx(F_n * s - p.I2 * acceleration / p.e, rel=1e-12)
    assert out["tooth_force_radial"] == pytest.approx(abs(out["tooth_force"]) * math.tan(p.alpha_n), rel=1e-12)


def at_constant_speed(p, theta, omega, F):
    """Reactions where M balances everything, so that the speed is constant."""
    reactions = build(p).functions["reactions"]
    given = {"theta": theta, "thetad": omega, "thetadd": 0, "F": F}
    return {k: np.asarray(v).ravel() for k, v in reactions(M=0, **given).items()}


@pytest.mark.parametrize("theta", np.linspace(-3, 3, 7))
def test_journal_load_at_constant_speed_with_massless_planet(theta):
    """E21: F sqrt(1 + 3 sin^2), and with the separating force a radial part more."""
    massless = dataclasses.replace(SAMPLE, m2=0, I2=0, u1=0, m3=0)
    F, s, c = 2.7e4, math.sin(theta), math.cos(theta)
    plain = at_constant_speed(dataclasses.replace(massless, alpha_n=0), theta, 300.0, F)
    assert math.hypot(plain["journal_force_x"][0], plain["journal_force_y"][0]) == pytest.approx(
        F * math.sqrt(1 + 3 * s**2), rel=1e-13
    )
    loaded, radial = at_constant_speed(massless, theta, 300.0, F), abs(F * s) * math.tan(massless.alpha_n)
    assert loaded["journal_force_x"][0] == pytest.approx(F * (1 + s**2) + radial * c, rel=1e-12)
    assert loaded["journal_force_y"][0] == pytest.approx(-F * s * c + radial * s, abs=1e-9)


@settings(deadline=None, derandomize=True, max_examples=30)
@given(parameters, states)
def test_every_body_is_in_balance(p, s):
    found = state(build(p), s)
    out, a = found.outputs, found.acceleration[0]
    sn, cs = math.sin(s["theta"]), math.cos(s["theta"])
    main = np.array([out["main_bearing_force_x"], out["main_bearing_force_y"]])
    journal = np.array([out["journal_force_x"], out["journal_force_y"]])
    tangent, along = np.array([-sn, cs]), np.array([cs, sn])
    ring = out["tooth_force"] * tangent - out["tooth_force_radial"] * along
    centre = p.e * (a * tangent - s["thetad"] ** 2 * along)
    pin = np.array([out["pin_force"], 0.0])
    scale = np.abs([*main, *journal, *ring, *pin, s["F"]]).max() + 1
    torque = -s["M"] - p.e * (along[0] * journal[1] - along[1] * journal[0])
    moment = p.e * out["tooth_force"] - p.e * (-sn) * -pin[0]
    assert np.abs(main - journal - p.u1 / p.e * centre).max() < 1e-11 * scale
    assert abs(torque - p.I1 * a) < 1e-11 * (scale + p.I1 * abs(a))
    assert np.abs(journal + ring - pin - p.m2 * centre).max() < 1e-11 * scale
    assert abs(moment + p.I2 * a) < 1e-11 * (scale + p.I2 * abs(a))


def test_kinematics_are_a_pure_cosine():
    theta = np.linspace(0, 2 * np.pi, 41)
    found = curves(build(SAMPLE), theta)
    assert relative(found["x"], 2 * SAMPLE.e * (1 - np.cos(theta))) < 1e-15
    assert found["inertia"][0] == pytest.approx(SAMPLE.I1 + SAMPLE.I2 + SAMPLE.m2 * SAMPLE.e**2, rel=1e-14)


def test_limit_without_planet_and_piston_is_a_wheel():
    wheel = dataclasses.replace(SAMPLE, m2=0, I2=0, m3=0)
    found = state(build(wheel), {**STATE, "F": 0})
    assert found.acceleration[0] == pytest.approx(-STATE["M"] / wheel.I1, rel=1e-14)


@pytest.mark.parametrize("wrong", [{"e": 0}, {"m3": -1}, {"I1": 0}, {"alpha_n": 1.6}, {"u1": math.nan}])
def test_impossible_data_are_refused(wrong):
    with pytest.raises(BadInput, match=next(iter(wrong))):
        dataclasses.replace(SAMPLE, **wrong)

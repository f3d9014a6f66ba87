"""The rodless mechanism against absolute coordinates, its rank, the closing rules and the claims of Prymak."""

import dataclasses
import math

import casadi as ca
import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from rigid_bodies import System, lagrange, motion
from scipy.optimize import minimize_scalar
from sympy.physics.mechanics import LagrangesMethod, Particle, Point, ReferenceFrame, RigidBody, dynamicsymbols, inertia

from mechsym import mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms import constraints
from mechsym.mechanisms.closing import RodlessFaces
from mechsym.mechanisms.hypocycloid import HypocycloidParameters
from mechsym.mechanisms.hypocycloid import build as build_hypocycloid
from mechsym.mechanisms.record import curves
from mechsym.mechanisms.rodless import CrankFreeRadially, RodlessParameters, Stiffnesses, build, closed
from mechsym.mechanisms.state import state

SAMPLE = RodlessParameters(r=0.05, I1=0.04, u1=0.02, m_link=1.3, I_link=2e-3, m_a=2.4, m_b=1.9)
STATE = {"alpha": 0.8, "alphad": 210.0, "F_a": -2.1e4, "F_b": 700.0, "M": 35.0}


def numbers(low, high):
    return st.floats(low, high, allow_nan=False)


parameters = st.builds(
    RodlessParameters,
    r=numbers(0.01, 1),
    I1=numbers(0.01, 5),
    u1=numbers(-2, 2),
    m_link=numbers(0.1, 5),
    I_link=numbers(0, 1),
    m_a=numbers(0, 5),
    m_b=numbers(0, 5),
)
states = st.fixed_dictionaries(
    {
        "alpha": numbers(-7, 7),
        "alphad": numbers(-20, 20),
        "F_a": numbers(-100, 100),
        "F_b": numbers(-100, 100),
        "M": numbers(-50, 50),
    }
)


def slotted_crank(p: RodlessParameters, s: dict) -> System:
    """Crank, link, slider a, slider b; the link's middle is free along the crank, which makes all forces unique."""
    arm = 0.5 * p.r
    mass = p.u1 / arm

    def joints(X):
        xc, yc, a, xl, yl, b, xa, ya, ta, xb, yb, tb = (X[i] for i in range(12))
        return ca.vertcat(
            xc - arm * ca.cos(a),
            yc - arm * ca.sin(a),
            (yl - yc) * ca.cos(a) - (xl - xc) * ca.sin(a),
            xa - xl - p.r * ca.cos(b),
            ya - yl - p.r * ca.sin(b),
            ya,
            ta,
            xb - xl + p.r * ca.cos(b),
            yb - yl + p.r * ca.sin(b),
            xb,
            tb,
        )

    def forces(X):
        return [0, 0, -s["M"], 0, 0, 0, s["F_a"], 0, 0, 0, s["F_b"], 0]

    masses = (mass, p.m_link, p.m_a, p.m_b)
    return System(masses, (p.I1 - mass * arm**2, p.I_link, 1.0, 1.0), joints, forces)


def slotted_motion(p, s):
    a = s["alpha"]
    c, n = p.r * math.cos(a), p.r * math.sin(a)
    guess = np.array([c / 2, n / 2, a, c, n, -a, 2 * c, 0, 0, 0, 2 * n, 0])
    return motion(slotted_crank(p, s), guess, 2, a, s["alphad"])


@settings(deadline=None, derandomize=True, max_examples=40)
@given(parameters, states)
def test_motion_and_reactions_agree_with_absolute_coordinates(p, s):
    found, truth = state(closed(build(p), CrankFreeRadially()), s), slotted_motion(p, s)
    out, forces = found.outputs, truth.joint_forces
    scale = np.abs(forces).max() + 1
    assert found.acceleration[0] == pytest.approx(truth.acceleration[2], rel=1e-10, abs=1e-9)
    assert out["x_a"] == pytest.approx(truth.pose[6], abs=1e-13)
    assert out["x_b"] == pytest.approx(truth.pose[10], abs=1e-13)
    assert out["dx_a_dalpha"] * s["alphad"] == pytest.approx(truth.velocity[6], abs=1e-12)
    # the multiplier of y_a = 0 acts on slider a along y, that of x_b = 0 on slider b along x
    wanted = {
        "pin_force_tangential": forces[2],
        "X_a": forces[5],
        "X_b": forces[9],
        "journal_force_a_along": forces[3],
        "journal_force_a_across": forces[4],
        "journal_force_b_across": forces[7],
        "journal_force_b_along": forces[8],
        "main_bearing_force_x": forces[0],
        "main_bearing_force_y": forces[1],
    }
    for name, force in wanted.items():
        assert out[name] == pytest.approx(force, abs=1e-9 * scale), name
    combination = out["X_a"] * math.cos(s["alpha"]) - out["X_b"] * math.sin(s["alpha"])
    assert out["guide_combination"] == pytest.approx(combination, abs=1e-10 * scale)


def determined(solution, combination):
    """Value of a combination of multipliers, None where the rank leaves it open."""
    weights = np.array([float(combination.get(n, 0.0)) for n in solution.names])
    return None if np.abs(weights @ solution.free).max() > 1e-9 else float(weights @ solution.particular)


@settings(deadline=None, derandomize=True, max_examples=25)
@given(parameters, states)
def test_rank_is_three_of_four_and_names_what_is_determined(p, s):
    free = mechanisms.build("rodless_constraints", p)
    c, n = math.cos(s["alpha"]), math.sin(s["alpha"])
    pose = {"x_C": p.r * c, "y_C": p.r * n, "beta": -s["alpha"]}
    solution = constraints.solve(free, constraints.close(free, s | pose))
    assert (solution.rank, solution.count) == (3, 4)
    null = np.array([c, n, -n, -c])  # S along OC on the link, X_a = -S sin, X_b = -S cos
    assert np.abs(null @ solution.free) == pytest.approx(np.sqrt(2), rel=1e-9)
    open_ones = [force is None for force in solution.multipliers.values()]
    assert all(is_open or abs(part) < 1e-8 for is_open, part in zip(open_ones, null, strict=True))
    found = state(build(p), s)
    assert solution.acceleration[0] == pytest.approx(found.acceleration[0], rel=1e-10, abs=1e-9)
    wanted = {
        "pin_force_tangential": {"pin_x": -n, "pin_y": c},
        "guide_combination": {"guide_a": c, "guide_b": -n},
        "pin_and_guide_x": {"pin_x": 1, "guide_b": 1},
        "pin_and_guide_y": {"pin_y": 1, "guide_a": 1},
    }
    scale = 1 + max(abs(found.outputs[name]) for name in wanted)
    for name, combination in wanted.items():
        value = determined(solution, combination)
        assert value == pytest.approx(found.outputs[name], abs=1e-9 * scale), name
    assert determined(solution, {"pin_x": c, "pin_y": n}) is None


def test_close_finds_the_link_from_the_crank_alone():
    free = mechanisms.build("rodless_constraints", SAMPLE)
    found = constraints.close(free, {"alpha": 0.8, "alphad": 3.0})
    assert found["x_C"] == pytest.approx(0.05 * math.cos(0.8), abs=1e-14)
    assert found["beta"] == pytest.approx(-0.8, abs=1e-12)
    assert found["betad"] == pytest.approx(-3.0, rel=1e-12)
    with pytest.raises(BadInput, match="does not close"):
        constraints.close(free, {"alpha": 0.8, "x_C": 1.0})
    with pytest.raises(BadInput, match="velocities"):
        constraints.close(free, {"alpha": 0.8, "alphad": 1.0, "betad": 1.0})


@settings(deadline=None, derandomize=True, max_examples=15)
@given(parameters, states, numbers(0.1, 10), numbers(0.1, 10), numbers(0.1, 10))
def test_stiffnesses_give_the_least_strain_energy(p, s, k_a, k_b, k_c):
    free = state(closed(build(p), CrankFreeRadially()), s).outputs
    held = state(closed(build(p), Stiffnesses(k_a=k_a, k_b=k_b, k_c=k_c)), s).outputs
    n, c = math.sin(s["alpha"]), math.cos(s["alpha"])

    def energy(S):
        return (free["X_a"] - S * n) ** 2 / k_a + (free["X_b"] - S * c) ** 2 / k_b + S**2 / k_c

    S = minimize_scalar(energy).x
    scale = abs(free["X_a"]) + abs(free["X_b"]) + 1
    assert held["pin_force_radial"] == pytest.approx(S, abs=1e-6 * scale)
    assert held["X_a"] == pytest.approx(free["X_a"] - S * n, abs=1e-6 * scale)
    assert held["X_b"] == pytest.approx(free["X_b"] - S * c, abs=1e-6 * scale)


@settings(deadline=None, derandomize=True, max_examples=30)
@given(parameters, states, numbers(0.1, 10), numbers(0.1, 10), numbers(0.1, 10))
def test_every_body_is_in_balance_under_any_rule(p, s, k_a, k_b, k_c):
    found = state(closed(build(p), Stiffnesses(k_a=k_a, k_b=k_b, k_c=k_c)), s)
    o, a, w = found.outputs, found.acceleration[0], s["alphad"]
    n, c = math.sin(s["alpha"]), math.cos(s["alpha"])
    middle = p.r * (a * np.array([-n, c]) - w**2 * np.array([c, n]))
    pin = np.array([o["pin_force_x"], o["pin_force_y"]])
    on_a = np.array([o["journal_force_a_along"], o["journal_force_a_across"]])
    on_b = np.array([o["journal_force_b_across"], o["journal_force_b_along"]])
    main = np.array([o["main_bearing_force_x"], o["main_bearing_force_y"]])
    scale = 1 + np.abs([*pin, *on_a, *on_b, *main, p.I1 * a]).max()
    assert np.abs(pin - on_a - on_b - p.m_link * middle).max() < 1e-11 * scale
    moment = -p.r * (c * on_a[1] + n * on_a[0]) + p.r * (c * on_b[1] + n * on_b[0])
    assert abs(moment + p.I_link * a) < 1e-11 * scale
    assert abs(on_a[0] + s["F_a"] - 2 * p.m_a * middle[0]) < 1e-11 * scale
    assert abs(on_b[1] + s["F_b"] - 2 * p.m_b * middle[1]) < 1e-11 * scale
    assert abs(on_a[1] + o["X_a"]) + abs(on_b[0] + o["X_b"]) < 1e-11 * scale
    assert np.abs(main - pin - p.u1 / p.r * middle).max() < 1e-11 * scale
    assert abs(-s["M"] - p.r * (c * pin[1] - n * pin[0]) - p.I1 * a) < 1e-11 * scale
    assert o["pin_force"] == pytest.approx(math.hypot(*pin), rel=1e-12, abs=1e-12)


@settings(deadline=None, derandomize=True, max_examples=30)
@given(parameters, states)
def test_acceleration_agrees_with_t_minus_v(p, s):
    def kinetic(q, u):
        link = p.r * ca.vertcat(ca.cos(q), ca.sin(q))
        linear = p.m_link * ca.sumsqr(ca.jacobian(link, q))
        sliders = 4 * p.r**2 * (p.m_a * ca.sin(q) ** 2 + p.m_b * ca.cos(q) ** 2)
        return (p.I1 + p.I_link + linear + sliders) * u**2 / 2

    def force(q, u):
        return ca.gradient(2 * p.r * (s["F_a"] * ca.cos(q) + s["F_b"] * ca.sin(q)), q) - s["M"]

    truth = float(lagrange(kinetic, lambda q: 0, force, 1)(s["alpha"], s["alphad"]))
    assert state(build(p), s).acceleration[0] == pytest.approx(truth, rel=1e-10, abs=1e-10)


def test_acceleration_agrees_with_sympy_mechanics():
    r, I1, I2, ml, ma, mb, Fa, Fb, M = sp.symbols("r I1 I2 ml ma mb Fa Fb M")
    alpha = dynamicsymbols("alpha")
    N, O = ReferenceFrame("N"), Point("O")
    O.set_vel(N, 0)
    crank, link = N.orientnew("crank", "Axis", [alpha, N.z]), N.orientnew("link", "Axis", [-alpha, N.z])
    C = O.locatenew("C", r * crank.x)
    A, B = C.locatenew("A", r * link.x), C.locatenew("B", -r * link.x)
    for point in (C, A, B):
        point.set_vel(N, point.pos_from(O).dt(N))
    bodies = [
        RigidBody("c", O, crank, 0, (inertia(crank, 0, 0, I1), O)),
        RigidBody("l", C, link, ml, (inertia(link, 0, 0, I2), C)),
        Particle("a", A, ma),
        Particle("b", B, mb),
    ]
    loads = [(A, Fa * N.x), (B, Fb * N.y), (crank, -M * N.z)]
    method = LagrangesMethod(sum(b.kinetic_energy(N) for b in bodies), [alpha], forcelist=loads, frame=N)
    method.form_lagranges_equations()
    p, s = SAMPLE, STATE
    values = {r: p.r, I1: p.I1, I2: p.I_link, ml: p.m_link, ma: p.m_a, mb: p.m_b}
    values |= {Fa: s["F_a"], Fb: s["F_b"], M: s["M"]}
    right = method.rhs()[1].subs(alpha.diff(), s["alphad"]).subs(alpha, s["alpha"]).subs(values)
    assert state(build(p), s).acceleration[0] == pytest.approx(float(right), rel=1e-12)


def test_inertia_resultant_is_constant_and_turns_with_the_crank():
    """Prymak (4), (5): 4 m r omega^2 with m a rod journal, two journals an axis; here with the link's share."""
    m, omega = 1.7, 180.0
    p = dataclasses.replace(SAMPLE, m_a=2 * m, m_b=2 * m, u1=0.0)
    rates = build(p).functions["momentum"]
    for alpha in np.linspace(0, 2 * np.pi, 13):
        found = rates(alpha=alpha, alphad=omega, alphadd=0)
        resultant = -float(found["momentum_rate_x"]), -float(found["momentum_rate_y"])
        size = (4 * m + p.m_link) * p.r * omega**2
        assert resultant == pytest.approx((size * math.cos(alpha), size * math.sin(alpha)), rel=1e-12, abs=1e-9)
        assert float(found["angular_momentum_rate"]) == pytest.approx(0, abs=1e-9)


def test_a_counterweight_on_the_crank_balances_equal_sliders():
    balanced = dataclasses.replace(SAMPLE, m_b=SAMPLE.m_a, u1=-(2 * SAMPLE.m_a + SAMPLE.m_link) * SAMPLE.r)
    found = build(balanced).functions["momentum"](alpha=0.7, alphad=180.0, alphadd=0)
    assert abs(float(found["momentum_rate_x"])) + abs(float(found["momentum_rate_y"])) < 1e-8


def test_kinematics_are_those_of_the_hypocycloid():
    theta = np.linspace(0, 2 * np.pi, 31)
    hypocycloid = HypocycloidParameters(
        e=SAMPLE.r, I1=SAMPLE.I1, m2=SAMPLE.m_link, I2=SAMPLE.I_link, m3=SAMPLE.m_a, alpha_n=0
    )
    one = dataclasses.replace(SAMPLE, m_b=0)
    a, h = curves(build(one), theta), curves(build_hypocycloid(hypocycloid), theta)
    for order in ("x", "dx_dtheta", "d2x_dtheta2"):
        travel = a[order.replace("x", "x_a", 1).replace("theta", "alpha")]
        shift = 2 * SAMPLE.r if order == "x" else 0.0
        assert shift - travel == pytest.approx(h[order], abs=1e-15)
    assert a["inertia"] == pytest.approx(h["inertia"], rel=1e-14)


def test_equal_sliders_have_constant_inertia():
    p = dataclasses.replace(SAMPLE, m_b=SAMPLE.m_a)
    inertia_curve = curves(build(p), np.linspace(0, 6, 20))["inertia"]
    assert inertia_curve == pytest.approx(p.I1 + p.I_link + (p.m_link + 4 * p.m_a) * p.r**2, rel=1e-14)


def four_stroke(**changes):
    values = {
        "sides": ("a+", "b+", "a-", "b-"),
        "areas": (0.01, 0.01, 0.008, 0.008),
        "firing": tuple(math.radians(d) for d in (0, 450, 180, 630)),
    }
    return RodlessFaces(**(values | changes))


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"sides": ("a+", "b+", "a-", "c")}, "side 'c'"),
        ({"firing": (0.0, 0.0, 0.0, 0.0)}, "no dead centre of side b\\+; give 90 deg or 450 deg"),
        ({"areas": (0.01,)}, "one value a face"),
        ({"areas": (0.01, 0.01, 0.0, 0.01)}, "areas = 0 m\\^2"),
    ],
)
def test_impossible_faces_are_refused(wrong, message):
    with pytest.raises(BadInput, match=message):
        four_stroke(**wrong)


@pytest.mark.parametrize("wrong", [{"r": 0}, {"m_a": -1}, {"I1": 0}, {"u1": math.inf}])
def test_impossible_data_are_refused(wrong):
    with pytest.raises(BadInput, match=next(iter(wrong))):
        dataclasses.replace(SAMPLE, **wrong)

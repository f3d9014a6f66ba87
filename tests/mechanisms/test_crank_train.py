"""The crank train against T - V in one common frame, absolute coordinates, and the single throw on a stiff shaft."""

import dataclasses
import math
import time

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rigid_bodies import System, lagrange, motion
from scipy.integrate import solve_ivp
from trains import in_line_six, v_eight

from mechsym.derive import derive
from mechsym.derive.build import declared
from mechsym.derive.emit import module_text
from mechsym.mechanisms import crank_throw
from mechsym.mechanisms.crank_train import build, build_rigid
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each
from mechsym.mechanisms.record import acceleration_function
from mechsym.mechanisms.state import state

DEG = math.pi / 180


def numbers(low, high):
    return st.floats(low, high, allow_nan=False)


def per(count, low, high):
    return st.tuples(*[numbers(low, high)] * count)


trains = st.builds(
    CrankTrainParameters,
    throw=st.just((1, 2, 2)),
    phase=per(3, -4, 4),
    bank=per(3, -2, 2),
    r=per(3, 0.02, 0.3),
    l1=per(3, 0.3, 0.5),
    l2=per(3, 0.2, 0.5),
    offset=per(3, -0.1, 0.1),
    m_rod=per(3, 0, 3),
    I_rod=per(3, 0, 0.5),
    m_piston=per(3, 0, 3),
    z_rod=per(3, -0.1, 0.1),
    I0=per(2, 0.05, 2),
    m0=per(2, 0, 5),
    u0=per(2, -0.5, 0.5),
    u_phase=per(2, -4, 4),
    sense=st.tuples(st.sampled_from((1.0, -1.0)), st.sampled_from((1.0, -1.0))),
    axis_x=per(2, -1, 1),
    axis_y=per(2, -1, 1),
    z=per(2, -1, 1),
    I_f=numbers(0.1, 2),
    k=per(2, 1, 1000),
    c=per(2, 0, 10),
    g=st.sampled_from((0.0, 9.81)),
    axis_tilt=numbers(-2, 2),
)
states = st.fixed_dictionaries(
    {name: numbers(-3, 3) for name in ("phi1", "phi2", "phi_f", "phi1d", "phi2d", "phi_fd")}
    | {name: numbers(-50, 50) for name in ("F1", "F2", "F3", "M")}
)


def points(p: CrankTrainParameters, q):
    """Crank pins, rod centres, rod angles and piston pins in the common frame, from q = (phi1, phi2, phi_f)."""
    found = []
    for i, k in enumerate(p.throw):
        v = {n: each(p, n)[i] for n in ("phase", "bank", "r", "l1", "l2", "offset")}
        sense = each(p, "sense")[k - 1]
        O = ca.vertcat(each(p, "axis_x")[k - 1], each(p, "axis_y")[k - 1])
        turn = sense * (q[k - 1] + v["phase"])
        A = O + v["r"] * ca.vertcat(ca.cos(turn), ca.sin(turn))
        along = ca.vertcat(math.cos(v["bank"]), math.sin(v["bank"]))
        across = sense * ca.vertcat(-math.sin(v["bank"]), math.cos(v["bank"]))
        gap = ca.dot(A - O, across) - v["offset"]
        l = v["l1"] + v["l2"]
        B = A + ca.sqrt(l**2 - gap**2) * along - gap * across
        angle = ca.atan2(B[1] - A[1], B[0] - A[0])
        found.append((O, A, A + v["l1"] / l * (B - A), angle, B, along, across))
    return found


def t_minus_v(p: CrankTrainParameters, s):
    def linear(position, q, u):
        return ca.sumsqr(ca.jtimes(position, q, u))

    def kinetic(q, u):
        T = p.I_f * u[2] ** 2 / 2
        for k in range(2):
            T += each(p, "I0")[k] * u[k] ** 2 / 2
        for i, (_, _, C, angle, B, _, _) in enumerate(points(p, q)):
            T += p.m_rod[i] * linear(C, q, u) / 2 + p.I_rod[i] * linear(angle, q, u) / 2
            T += p.m_piston[i] * linear(B, q, u) / 2
        return T

    def potential(q):
        down = ca.vertcat(-p.g * math.sin(p.axis_tilt), -p.g * math.cos(p.axis_tilt))
        V = sum(k * (q[i] - q[i + 1]) ** 2 / 2 for i, k in enumerate(p.k))
        for k in range(2):
            turn = p.sense[k] * (q[k] + p.u_phase[k])
            V -= p.u0[k] * ca.dot(down, ca.vertcat(ca.cos(turn), ca.sin(turn)))
        for i, (_, _, C, _, B, _, _) in enumerate(points(p, q)):
            V -= p.m_rod[i] * ca.dot(down, C) + p.m_piston[i] * ca.dot(down, B)
        return V

    def force(q, u):
        Q = -s["M"] * ca.vertcat(0, 0, 1)
        for i, (_, _, _, _, B, along, _) in enumerate(points(p, q)):
            Q += -s[f"F{i + 1}"] * ca.gradient(ca.dot(B, along), q)
        for i, c in enumerate(p.c):
            torque = c * (u[i] - u[i + 1])
            Q -= torque * ca.vertcat(*(1 if j == i else -1 if j == i + 1 else 0 for j in range(3)))
        return Q

    return lagrange(kinetic, potential, force, 3)


@pytest.mark.slow
@settings(deadline=None, derandomize=True, max_examples=25)
@given(trains, states)
def test_acceleration_agrees_with_t_minus_v_in_the_common_frame(p, s):
    q = [s[n] for n in ("phi1", "phi2", "phi_f")]
    u = [s[n] for n in ("phi1d", "phi2d", "phi_fd")]
    truth = np.asarray(t_minus_v(p, s)(q, u)).ravel()
    assert state(build(p), s).acceleration == pytest.approx(truth, rel=1e-10, abs=1e-10 * (1 + np.abs(truth).max()))


@pytest.mark.slow
@settings(deadline=None, derandomize=True, max_examples=25)
@given(trains, states)
def test_power_is_balanced(p, s):
    m = build(p)
    found = state(m, s)
    energy = m.functions["energy"]
    q = ca.SX.sym("q", 3)
    u = ca.SX.sym("u", 3)
    total = sum(energy(*ca.vertsplit(q), *ca.vertsplit(u)))
    rate = ca.Function("rate", [q, u], [ca.gradient(total, q), ca.gradient(total, u)])
    rates = np.array([s[f"{n}d"] for n in m.coordinates])
    by_q, by_u = (np.asarray(v).ravel() for v in rate([s[n] for n in m.coordinates], rates))
    change = by_q @ rates + by_u @ np.array(found.acceleration)
    out = found.outputs
    work = [s[f"F{i + 1}"] * out[f"dx_{i + 1}_dphi{k}"] * s[f"phi{k}d"] for i, k in enumerate(p.throw)]
    loss = [c * (a - b) ** 2 for c, a, b in zip(p.c, rates[:-1], rates[1:], strict=True)]
    terms = [*work, -s["M"] * s["phi_fd"], *(-x for x in loss)]
    scale = 1 + np.abs([*terms, *(by_q * rates), *(by_u * found.acceleration)]).max()
    assert abs(change - sum(terms)) < 1e-10 * scale


def two_rods(p: CrankTrainParameters, s) -> System:
    """Throw 2 of a train alone: crank, and rod and piston of cylinders 2 and 3, in absolute coordinates."""
    sense, O = p.sense[1], (p.axis_x[1], p.axis_y[1])
    arm = 0.37
    mass = p.u0[1] / arm
    out = points(p, ca.DM([0, 0, 0]))

    def joints(X):
        a = X[2]  # the crank's angle; its unbalance stands at a + sense * u_phase
        U = ca.vertcat(ca.cos(a + sense * p.u_phase[1]), ca.sin(a + sense * p.u_phase[1]))
        rows = [X[0] - O[0] - arm * U[0], X[1] - O[1] - arm * U[1]]
        centre = ca.vertcat(X[0], X[1]) - arm * U
        for j, i in enumerate((1, 2)):
            rod, piston = X[3 + 6 * j : 6 + 6 * j], X[6 + 6 * j : 9 + 6 * j]
            across = out[i][6]
            turn = a + sense * p.phase[i]
            A = centre + p.r[i] * ca.vertcat(ca.cos(turn), ca.sin(turn))
            direction = ca.vertcat(ca.cos(rod[2]), ca.sin(rod[2]))
            rows += [rod[:2] - A - p.l1[i] * direction, piston[:2] - rod[:2] - p.l2[i] * direction]
            rows += [ca.dot(piston[:2] - ca.vertcat(*O), across) - p.offset[i], piston[2]]
        return ca.vertcat(*rows)

    def forces(X):
        down = (-p.g * math.sin(p.axis_tilt), -p.g * math.cos(p.axis_tilt))
        rows = [mass * down[0], mass * down[1], sense * s["torque"]]
        for i in (1, 2):
            gas = -s[f"F{i + 1}"] * out[i][5]
            rows += [p.m_rod[i] * down[0], p.m_rod[i] * down[1], 0]
            rows += [p.m_piston[i] * down[0] + gas[0], p.m_piston[i] * down[1] + gas[1], 0]
        return rows

    masses = (mass, p.m_rod[1], p.m_piston[1], p.m_rod[2], p.m_piston[2])
    inertias = (p.I0[1] - mass * arm**2, p.I_rod[1], 1.0, p.I_rod[2], 1.0)
    return System(masses, inertias, joints, forces)


def pose(p, phi):
    sense = p.sense[1]
    found = points(p, ca.DM([0, phi, 0]))
    U = sense * (phi + p.u_phase[1])
    rows = [p.axis_x[1] + 0.37 * math.cos(U), p.axis_y[1] + 0.37 * math.sin(U), sense * phi]
    for i in (1, 2):
        _, _, C, angle, B, _, _ = found[i]
        rows += [*np.asarray(C).ravel(), float(angle), *np.asarray(B).ravel(), 0.0]
    return np.array(rows)


@pytest.mark.slow
@settings(deadline=None, derandomize=True, max_examples=25)
@given(trains, states)
def test_reactions_agree_with_absolute_coordinates(p, s):
    unbalance = abs(p.u0[1])
    p = dataclasses.replace(p, u0=(0.0, unbalance), m0=(0.0, unbalance / 0.37))
    found = state(build(p), s)
    out = found.outputs
    s = s | {"torque": out["shaft_torque_1"] - out["shaft_torque_2"]}
    truth = motion(two_rods(p, s), pose(p, s["phi2"]), 2, p.sense[1] * s["phi2"], p.sense[1] * s["phi2d"])
    assert found.acceleration[1] == pytest.approx(p.sense[1] * truth.acceleration[2], rel=1e-10, abs=1e-10)
    forces = truth.joint_forces
    scale = 1 + np.abs(forces).max()
    bearing = [out["main_bearing_force_x_2"], out["main_bearing_force_y_2"]]
    assert bearing == pytest.approx(forces[:2], abs=1e-9 * scale)
    for j, i in enumerate((2, 3)):
        rows = forces[2 + 6 * j : 8 + 6 * j]
        along, across = (np.asarray(v).ravel() for v in points(p, ca.DM([0, 0, 0]))[i - 1][5:])
        pin = [out[f"pin_force_x_{i}"], out[f"pin_force_y_{i}"]]
        piston_pin = out[f"piston_pin_force_along_{i}"] * along + out[f"piston_pin_force_across_{i}"] * across
        assert pin == pytest.approx(rows[:2], abs=1e-9 * scale)
        assert piston_pin == pytest.approx(rows[2:4], abs=1e-9 * scale)
        assert out[f"side_force_{i}"] == pytest.approx(rows[4], abs=1e-9 * scale)


@settings(deadline=None, derandomize=True, max_examples=15)
@given(trains, states)
def test_frame_gas_and_weight_make_the_momentum(p, s):
    m = build(p)
    found = state(m, s)
    out, momentum = found.outputs, m.functions["momentum"]
    moving = [s[n] for n in m.coordinates] + [s[f"{n}d"] for n in m.coordinates] + found.acceleration
    rates = dict(zip(momentum.name_out(), (float(v) for v in momentum(*moving)), strict=True))
    down = np.array([-math.sin(p.axis_tilt), -math.cos(p.axis_tilt)]) * p.g
    total = down * (sum(p.m0) + sum(p.m_rod) + sum(p.m_piston))
    for k in (1, 2):
        total += np.array([out[f"main_bearing_force_x_{k}"], out[f"main_bearing_force_y_{k}"]])
    for i, (_, _, _, _, _, along, across) in enumerate(points(p, ca.DM([0, 0, 0]))):
        along, across = (np.asarray(v).ravel() for v in (along, across))
        total += out[f"side_force_{i + 1}"] * across - s[f"F{i + 1}"] * along
    scale = 1 + np.abs(total).max() + np.abs(list(rates.values())).max()
    assert total == pytest.approx([rates["momentum_rate_x"], rates["momentum_rate_y"]], abs=1e-9 * scale)


@pytest.mark.parametrize("train", [in_line_six, v_eight])
def test_a_stiff_shaft_gives_the_single_throws(train):
    p = train(g=9.81, axis_tilt=math.pi / 2)
    rigid, phi, rate = build_rigid(p), 0.7, 120.0
    forces = {f"F{i + 1}": 1000.0 * i - 2000 for i in range(len(p.throw))}
    found = state(rigid, {"phi": phi, "phid": rate, "M": 30.0, **forces})
    mass, bias, force = p.I_f, 0.0, -30.0
    for k in range(max(p.throw)):
        mass += each(p, "I0")[k]
    for i in range(len(p.throw)):
        names = ("r", "l1", "l2", "offset", "m_rod", "m_piston", "I_rod")
        letters = {n: each(p, n)[i] for n in names} | {"I0": 1.0, "g": p.g}
        bank = each(p, "bank")[i]
        one = crank_throw.CrankThrowParameters(**letters, axis_tilt=p.axis_tilt + bank)
        own = {"phi": phi + each(p, "phase")[i] - bank, "phid": rate, "F": forces[f"F{i + 1}"]}
        single = state(crank_throw.build(one), own)
        mass += single.mass_matrix[0][0] - 1.0
        bias += single.bias[0]
        force += single.generalized_force[0]
    assert found.mass_matrix[0][0] == pytest.approx(mass, rel=1e-13)
    assert found.bias[0] == pytest.approx(bias, rel=1e-11, abs=1e-9)
    assert found.generalized_force[0] == pytest.approx(force, rel=1e-12)
    # the elastic train adds up to the same when all throws move alike
    alike = {f"{n}{dot}": v for n in build(p).coordinates for dot, v in (("", phi), ("d", rate))}
    elastic = state(build(p), alike | {"M": 30.0} | forces)
    assert np.sum(elastic.mass_matrix) == pytest.approx(mass, rel=1e-13)
    assert sum(elastic.generalized_force) == pytest.approx(force, rel=1e-12)


def run(mechanism, n, phi_end, given):
    accelerate = acceleration_function(mechanism)
    solution = solve_ivp(
        lambda t, y: np.concatenate([y[n:], np.asarray(accelerate(*y, *given)).ravel()]),
        (0.0, phi_end / 100.0),
        np.concatenate([np.zeros(n), np.full(n, 100.0)]),
        method="DOP853",
        rtol=1e-9,
        atol=1e-11,
    )
    return solution.y[n - 1, -1]


def test_motion_tends_to_the_rigid_shaft_as_the_stiffness_grows():
    p = in_line_six(throw=(1, 2), phase=(0.0, 2.0), firing=(), z=0.0)
    given = [400.0, -250.0, 5.0]
    rigid = run(build_rigid(p), 1, 1.0, given)
    errors = [abs(run(build(dataclasses.replace(p, k=k, c=5.0)), 3, 1.0, given) - rigid) for k in (1e4, 1e5)]
    assert errors[1] < 0.2 * errors[0]
    assert errors[1] < 1e-3


@pytest.mark.parametrize("train", [in_line_six, v_eight])
def test_derived_generated_and_built_in_two_seconds(train):
    start = time.process_time()
    module_text(derive(declared("crank_throw")), "derivations/crank_throw.py", "0" * 16)
    build(train())
    assert time.process_time() - start < 2.0

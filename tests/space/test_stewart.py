"""A Stewart platform against the own code of spatial.py: forward, inverse, reactions; how long its code is."""

from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from spatial import EYE, GROUND, Body, Machine, about, prismatic, spherical, universal

from mechsym.mechanisms import loops
from mechsym.mechanisms.record import bind
from mechsym.mechanisms.state import state

FILE = str(Path(__file__).parents[2] / "examples/space/stewart.py")
P = dict(R=1.0, r=0.6, half=0.4, gap=0.2, plate_mass=30.0, low=3.0, up=2.0, I=2.0, A=0.1, C=0.005, g=9.81)
TURN = np.array([0.2, -0.15, 0.3])
PLACE, SPEED, SPIN = np.array([0.05, -0.08, 1.1]), np.array([0.4, -0.3, 0.5]), np.array([0.6, 0.9, -0.7])
FORCES = np.array([120.0, 80.0, 60.0, 140.0, 90.0, 70.0])


def platform():
    plate = Body(P["plate_mass"], (P["I"], P["I"], 2 * P["I"]), PLACE, about(TURN, np.linalg.norm(TURN)))
    bodies, joints, loads = [plate], [], []
    for k, F in enumerate(FORCES):
        side = 1 if k % 2 else -1
        foot, head = (2 * k + 1 - side) * np.pi / 6 + side * P["gap"], (2 * k + 1 + side) * np.pi / 6 - side * P["gap"]
        at = P["R"] * np.array([np.cos(foot), np.sin(foot), 0])
        on = P["r"] * np.array([np.cos(head), np.sin(head), 0])
        top = plate.r + plate.R @ on
        z = (top - at) / np.linalg.norm(top - at)
        y = np.cross(z, EYE[0])
        y /= np.linalg.norm(y)
        R, half = np.column_stack([np.cross(y, z), y, z]), np.array([0, 0, P["half"]])
        below = Body(P["low"], (P["A"], P["A"], P["C"]), at + R @ half, R)
        above = Body(P["up"], (P["A"], P["A"], P["C"]), top - R @ half, R)
        bodies += [below, above]
        joints += [
            universal(f"U{k + 1}", GROUND, below, at, -half, EYE[0], EYE[1]),
            prismatic(f"L{k + 1}", below, above, -half, half, EYE[2]),
            spherical(f"S{k + 1}", above, plate, half, on),
        ]
        loads += [(above, F * z, np.zeros(3), half), (below, -F * z, np.zeros(3), -half)]
    machine = Machine(bodies, joints, (0, 0, -P["g"])).close().move([*SPEED, *SPIN])
    return machine, loads


def quaternion():
    angle = np.linalg.norm(TURN)
    e = np.array([np.cos(angle / 2), *(np.sin(angle / 2) * TURN / angle)])
    w = about(TURN, angle).T @ SPIN  # in axes of the plate
    return e, 0.5 * np.array([-e[1:] @ w, *(e[0] * w + np.cross(e[1:], w))])


def test_forward_inverse_and_reactions():
    mechanism, (machine, loads) = bind(FILE, P), platform()
    e, ed = quaternion()
    values = dict(zip(("x_P", "y_P", "z_P"), PLACE, strict=True)) | {f"e{k}_P": e[k] for k in (1, 2, 3)}
    values |= dict(zip(("x_Pd", "y_Pd", "z_Pd"), SPEED, strict=True)) | {f"e{k}_Pd": ed[k] for k in (1, 2, 3)}
    inputs = {f"F{k + 1}": F for k, F in enumerate(FORCES)}
    found = state(mechanism, {**values, **inputs})
    accelerations, reactions, _ = machine.solve(loads)
    a = dict(zip(mechanism.coordinates, found.acceleration, strict=True))
    assert [a["x_P"], a["y_P"], a["z_P"]] == pytest.approx(accelerations[0, :3], rel=1e-10, abs=1e-10)
    largest = max(np.abs(r).max() for r in reactions.values())
    for joint in machine.joints:
        for k, kind in enumerate(("R_x", "R_y", "R_z", "M_x", "M_y", "M_z")):
            wanted = reactions[joint.name][k]
            assert found.outputs.get(f"{kind}_{joint.name}", 0.0) == pytest.approx(wanted, abs=1e-10 * largest)
    asked = {f"slide_L{k}dd": a[f"slide_L{k}"] for k in range(1, 7)}
    back = state(mechanism, {**values, **asked})
    assert [back.outputs[f"driving_slide_L{k}"] for k in range(1, 7)] == pytest.approx(FORCES, rel=1e-10)


def test_its_code_is_short():
    mechanism = bind(FILE, P)
    n, held = len(mechanism.coordinates), tuple(mechanism.dependents)
    q, u, w = ca.SX.sym("q", n), ca.SX.sym("u", 6), ca.SX.sym("w", 6)
    T, c = loops.motion(mechanism, q, u, held)
    mass, bias, force = mechanism.functions["dynamics"](
        *ca.vertsplit(q), *ca.vertsplit(ca.mtimes(T, u)), *ca.vertsplit(w)
    )
    reduced, right = ca.mtimes(T.T, ca.mtimes(mass, T)), ca.mtimes(T.T, force - bias - ca.mtimes(mass, c))
    whole = ca.Function("whole", [q, u, w], [ca.solve(reduced, right)], {"cse": True})
    generated = [mechanism.functions[name].n_instructions() for name in ("dynamics", "constraints")]
    assert sum(generated) < 4000 and whole.n_instructions() < 6000

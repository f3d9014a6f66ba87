"""Slow, independent truths for plane mechanisms: every body has x, y and an angle of its own, joints are constraints.

Nothing is eliminated by hand: closure by Newton's method, motion and joint forces from one linear system with
multipliers (Newton-Euler), and Lagrange's equations by automatic differentiation of T - V.
"""

from collections.abc import Callable
from dataclasses import dataclass

import casadi as ca
import numpy as np


@dataclass(frozen=True)
class System:
    """Bodies and joints in absolute coordinates.

    `masses` and `inertias` one a body; `joints(X)` maps the 3 n coordinates to what must vanish; `forces(X)` gives
    the 3 n applied forces and moments.
    """

    masses: tuple[float, ...]
    inertias: tuple[float, ...]
    joints: Callable
    forces: Callable


@dataclass(frozen=True)
class Motion:
    """Pose, velocity, acceleration (3 n each) and the joint forces (multipliers) of a System at one state."""

    pose: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    joint_forces: np.ndarray


def motion(system: System, guess: np.ndarray, driver: int, angle: float, rate: float) -> Motion:
    """Newton-Euler at the state where coordinate `driver` has the given angle and rate."""
    X, V = ca.SX.sym("X", len(guess)), ca.SX.sym("V", len(guess))
    g = system.joints(X)
    J = ca.jacobian(g, X)
    gamma = ca.jtimes(ca.jtimes(g, X, V), X, V)
    forces = ca.SX(ca.vertcat(*system.forces(X)))
    look = ca.Function("look", [X, V], [g, J, gamma, forces])
    pose = np.array(guess, float)
    pose[driver] = angle
    unit = np.zeros((1, len(pose)))
    unit[0, driver] = 1
    for _ in range(30):
        g_now, J_now, _, _ = (np.asarray(v) for v in look(pose, pose * 0))
        step = np.linalg.solve(np.vstack([J_now, unit]), np.append(-g_now, 0.0))
        pose = pose + step
        if np.abs(step).max() < 1e-15 * np.abs(pose).max():
            break
    J_now = np.asarray(look(pose, pose * 0)[1])
    velocity = np.linalg.solve(np.vstack([J_now, unit]), np.append(np.zeros(len(J_now)), rate))
    _, _, gamma_now, forces_now = (np.asarray(v) for v in look(pose, velocity))
    mass = np.diag([m for a, b in zip(system.masses, system.inertias, strict=True) for m in (a, a, b)])
    zero = np.zeros((len(J_now), len(J_now)))
    matrix = np.block([[mass, -J_now.T], [J_now, zero]])
    solution = np.linalg.solve(matrix, np.vstack([forces_now, -gamma_now])).ravel()
    return Motion(pose, velocity, solution[: len(pose)], solution[len(pose) :])


def lagrange(kinetic: Callable, potential: Callable, force: Callable, n: int) -> ca.Function:
    """(q, u) -> accelerations from T(q, u) - V(q) and generalised forces Q(q, u) by automatic differentiation."""
    q, u = ca.SX.sym("q", n), ca.SX.sym("u", n)
    L = kinetic(q, u) - potential(q)
    momentum = ca.gradient(L, u)
    bias = ca.jtimes(momentum, q, u) - ca.gradient(L, q)
    return ca.Function("lagrange", [q, u], [ca.solve(ca.jacobian(momentum, u), force(q, u) - bias)])


def relative(found, wanted) -> float:
    """Largest difference of two arrays, relative to the largest entry of the second."""
    found, wanted = np.asarray(found, float), np.asarray(wanted, float)
    return float(np.abs(found - wanted).max() / np.abs(wanted).max())

"""Small mechanisms with known answers, written down directly as CasADi functions."""

import casadi as ca

from mechsym.mechanisms.record import Mechanism


def mechanism(coordinates, inputs, mass, bias, force, kinetic, potential):
    """A mechanism from functions of lists q, u and inputs w that return matrices and scalars."""
    n = len(coordinates)
    q, u, w = ([ca.SX.sym(name) for name in names] for names in (coordinates, [f"{c}d" for c in coordinates], inputs))
    letters = [*q, *u, *w]
    names = [v.name() for v in letters]
    dynamics = ca.Function(
        "dynamics",
        letters,
        [ca.SX(mass(q)), ca.SX(bias(q, u)), ca.SX(force(q, u, w))],
        names,
        ["mass_matrix", "bias", "generalized_force"],
    )
    energy = ca.Function(
        "energy",
        letters[: 2 * n],
        [ca.SX(kinetic(q, u)), ca.SX(potential(q))],
        names[: 2 * n],
        ["kinetic_energy", "potential_energy"],
    )
    functions = {"dynamics": dynamics, "energy": energy}
    return Mechanism(
        name="stand_in", coordinates=tuple(coordinates), inputs=tuple(inputs), parameters={}, functions=functions
    )


def oscillator(inertia=2.0, stiffness=50.0, damping=0.0):
    """I phi'' = M - k phi - c phi'."""
    return mechanism(
        ["phi"],
        ["M"],
        mass=lambda q: inertia,
        bias=lambda q, u: 0.0,
        force=lambda q, u, w: w[0] - stiffness * q[0] - damping * u[0],
        kinetic=lambda q, u: inertia * u[0] ** 2 / 2,
        potential=lambda q: stiffness * q[0] ** 2 / 2,
    )


def shaft(inertia=3.0, unbalance=0.0):
    """A rigid shaft with drive M and load M_r; unbalance is the torque of a weight, - unbalance sin phi."""
    return mechanism(
        ["phi"],
        ["M", "M_r"],
        mass=lambda q: inertia,
        bias=lambda q, u: 0.0,
        force=lambda q, u, w: w[0] - w[1] - unbalance * ca.sin(q[0]),
        kinetic=lambda q, u: inertia * u[0] ** 2 / 2,
        potential=lambda q: unbalance * (1 - ca.cos(q[0])),
    )


def double_pendulum():
    """Two equal point masses on massless rods of unit length; chaotic at high energy."""
    g = 9.81
    return mechanism(
        ["a", "b"],
        ["M"],
        mass=lambda q: ca.blockcat([[2, ca.cos(q[0] - q[1])], [ca.cos(q[0] - q[1]), 1]]),
        bias=lambda q, u: ca.vertcat(ca.sin(q[0] - q[1]) * u[1] ** 2, -ca.sin(q[0] - q[1]) * u[0] ** 2),
        force=lambda q, u, w: ca.vertcat(w[0] - 2 * g * ca.sin(q[0]), -g * ca.sin(q[1])),
        kinetic=lambda q, u: u[0] ** 2 + u[1] ** 2 / 2 + ca.cos(q[0] - q[1]) * u[0] * u[1],
        potential=lambda q: -2 * g * ca.cos(q[0]) - g * ca.cos(q[1]),
    )

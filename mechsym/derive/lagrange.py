r"""Exact equations of motion from a declaration, in the geometric form.

With body positions as explicit functions of the coordinates,

.. math:: M = \sum J^T m J, \quad h = \sum J^T m \dot J u, \quad M \ddot q + h = Q(q, u)

is Lagrange's equation (textbook.py proves it for every mechanism) at a fraction of its operations. A joint
displacement is one more coordinate whose acceleration is zero: its equation gives the reaction.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from sympy import Expr, Integer, Rational, Symbol

from mechsym.derive.closing import finish
from mechsym.derive.declare import Body, Declaration
from mechsym.derive.figures import draw_cams
from mechsym.derive.rates import acceleration, curvature, velocities, velocity
from mechsym.derive.refuse import refuse, require_declaration
from mechsym.derive.roles import require_reactions


@dataclass(frozen=True, kw_only=True)
class Equations:
    """The derived equations of a mechanism; every expression is in the names of its tape.

    Parameters
    ----------
    mechanism : Declaration
        The declaration, with its tape
    mass_matrix : tuple of tuple of Expr, shape (n, n)
        Mass matrix
    bias, generalized_force : tuple of Expr, shape (n,)
        Velocity terms on the left; gravity, springs, dampers and inputs on the right
    kinetic_energy, potential_energy : Expr or None
        Energies; None for a model given only by its equations
    reactions : dict of str to Expr
        Joint reactions and dynamic outputs by name
    kinematics : dict of str to Expr
        Kinematic outputs by name
    momentum : dict of str to Expr
        Rates of linear momentum and of angular momentum about the origin, all bodies together
    constraint_jacobian : tuple of tuple of Expr, shape (m, n)
        Rows of the constraints, empty without constraints
    constraint_bias : tuple of Expr, shape (m,)
        Velocity terms of the constraints' second derivatives
    """

    mechanism: Declaration
    mass_matrix: tuple[tuple[Expr, ...], ...]
    bias: tuple[Expr, ...]
    generalized_force: tuple[Expr, ...]
    kinetic_energy: Expr | None
    potential_energy: Expr | None
    reactions: dict[str, Expr]
    kinematics: dict[str, Expr]
    momentum: dict[str, Expr]
    constraint_jacobian: tuple[tuple[Expr, ...], ...] = ()
    constraint_bias: tuple[Expr, ...] = ()
    checked: Callable[[], tuple[int, float]] | None = None  #: Another check than that of the plane
    written: tuple[dict[str, str], ...] = ()  #: The equations for a reader, where the steps are too many to be read


def given_equations(m: Declaration, mass_matrix: list[list[Expr]], bias: list[Expr], force: list[Expr]) -> None:
    """Declare a model by its equations only: mass_matrix * qdd + bias = force. It has no energies.

    m: the declaration, without bodies; mass_matrix: coefficients of the accelerations; bias: terms with velocities, on
    the left; force: right-hand sides.
    """
    require_declaration(m, "given_equations(m, [[I]], [0], [M])")
    n = len(m.q)
    if not all(isinstance(part, list) and len(part) == n for part in (mass_matrix, bias, force)):
        refuse(f"{n} coordinates have {n} equations; write lists of {n} rows of the mass matrix, biases and forces")
    if not all(isinstance(row, list) and len(row) == n for row in mass_matrix):
        refuse(f"{n} coordinates have a mass matrix of {n} rows of {n}; write a list of lists")

    def named(value: Expr | float) -> Expr:
        return m.tape.named(m._checked(value, "", "equation"))

    m.given = ([[named(e) for e in row] for row in mass_matrix], [named(e) for e in bias], [named(e) for e in force])


def derive(m: Declaration) -> Equations:
    """Exact equations of a declared mechanism.

    Returns equations: mass matrix, bias, forces, energies, reactions.
    """
    if (own := m.own_equations()) is not None:
        return own
    finish(m)
    if not m.q:
        refuse(f"{m.name} has no coordinate; declare one: phi = m.coordinates('phi')", m.where[m.name])
    # without dependents only the rank is wanted, see mechsym.mechanisms.constraints
    held, count = len(m.dependent_list), len(m.constraints)
    if held != count and (held or (count and m.joint_list)):
        why = f"{count} constraints hold {held} dependent coordinates"
        state = "open" if count < held else "held twice"
        refuse(f"{why}; the loop is {state}: declare as many m.dependents", m.where[m.name])
    require_reactions(m, m.link_joints)
    if m.given is not None:
        rows, bias, force = m.given
        return Equations(
            mechanism=m,
            mass_matrix=tuple(map(tuple, rows)),
            bias=tuple(bias),
            generalized_force=tuple(force),
            kinetic_energy=None,
            potential_energy=None,
            reactions=dict(m.dynamic_outputs),
            kinematics={s.name: s for s in m.kinematic_outputs},
            momentum={},
            **_held(m),
        )
    mass = [[sum((_body_mass(m, body, a, b) for body in m.bodies), Integer(0)) for b in m.q] for a in m.q]
    _require_mass(m, mass)
    kinematics: dict[str, Expr] = {s.name: s for s in m.kinematic_outputs}
    if len(m.q) == 1:
        q, per = m.q[0], m.units[m.q[0].name]
        unit, slope = "kg" if per == "m" else "kg*m^2", f"dinertia_d{q}"
        inertia = m.let("inertia", mass[0][0], unit)
        mass = [[inertia]]
        kinematics |= {"inertia": inertia, slope: m.tape.derivative(inertia, q)}
        m.units[slope] = f"{unit}/{per}"
    u = velocities(m)
    terms = (mass[i][j] * u[i] * u[j] for i in range(len(u)) for j in range(len(u)))
    weight = [-b.mass * g * p for b in m.bodies for g, p in zip(m.gravity, b.at, strict=True)]
    springs = [Rational(1, 2) * s.value * s.along**2 for s in m.springs]
    result = Equations(
        mechanism=m,
        mass_matrix=tuple(map(tuple, mass)),
        bias=tuple(sum((_body_bias(m, body, v) for body in m.bodies), Integer(0)) for v in m.q),
        generalized_force=tuple(generalized_force(m, v) for v in m.q),
        kinetic_energy=Rational(1, 2) * sum(terms, Integer(0)),
        potential_energy=m.tape.named(sum([*weight, *springs, *m.stores], Integer(0))),
        reactions=_reactions(m),
        kinematics=kinematics,
        momentum=_momentum(m),
        **_held(m),
    )
    draw_cams(m)  # last: what it names stands behind what moves
    return result


def _held(m: Declaration) -> dict[str, Any]:
    """Jacobian of the constraints, and the velocity terms of their second derivatives."""
    return {
        "constraint_jacobian": tuple(tuple(m.tape.diff(g, v) for v in m.q) for g in m.constraints.values()),
        "constraint_bias": tuple(curvature(m, g) for g in m.constraints.values()),
    }


def _require_mass(m: Declaration, mass: list[list[Expr]]) -> None:
    for i, q in enumerate(m.q):
        # what a loop moves may have no mass of its own, as a massless rod or the length of a cylinder
        held = any(not m.tape.diff(g, q).is_zero for g in m.constraints.values())
        if mass[i][i].is_zero and (not held or all(row[j].is_zero for j, row in enumerate(mass))):
            why = f"nothing that moves with {q} has a mass; give a body on it a mass or an inertia"
            refuse(why, m.where[q.name])


def _body_mass(m: Declaration, body: Body, a: Symbol, b: Symbol) -> Expr:
    d = m.tape.diff
    turning = body.inertia * d(body.turns, a) * d(body.turns, b)
    if body.about_axis:
        return turning
    return body.mass * sum((d(p, a) * d(p, b) for p in body.at), Integer(0)) + turning


def _body_bias(m: Declaration, body: Body, a: Symbol) -> Expr:
    d = m.tape.diff
    turning = body.inertia * d(body.turns, a) * curvature(m, body.turns)
    if body.about_axis:
        return turning
    return body.mass * sum((d(p, a) * curvature(m, p) for p in body.at), Integer(0)) + turning


def generalized_force(m: Declaration, a: Symbol) -> Expr:
    r"""Generalised force by virtual work, :math:`Q_a = \sum f\,\partial s / \partial a`.

    a: coordinate or joint displacement. Returns force: gravity, springs, dampers and applied forces together.
    """
    d = m.tape.diff
    weight = [b.mass * g * d(p, a) for b in m.bodies for g, p in zip(m.gravity, b.at, strict=True)]
    applied = [f.value * d(f.along, a) for f in m.forces]
    springs = [-s.value * s.along * d(s.along, a) for s in m.springs]
    dampers = [-c.value * velocity(m, c.along) * d(c.along, a) for c in m.dampers]
    stored = [-d(energy, a) for energy in m.stores]
    return m.tape.named(sum([*weight, *applied, *springs, *stored, *dampers], Integer(0)))


def _reactions(m: Declaration) -> dict[str, Expr]:
    # friction and separating forces depend on other reactions: these are put in, in the order of the joints
    reactions: dict[Symbol, Expr] = {}
    for joint in m.joint_list:
        reactions[m.reaction_of[joint]] = _reaction(m, joint).xreplace(reactions)
    multipliers = {s.name: s for s in m.multiplier_of.values()}
    outputs = {s.name: e for s, e in reactions.items()} | multipliers
    outputs |= {n: e.xreplace(reactions) for n, e in m.dynamic_outputs.items()}
    for name, expression in outputs.items():
        if unknown := sorted(s.name for s in expression.free_symbols & reactions.keys()):
            raise ValueError(f"{name} depends on {', '.join(unknown)}; declare the joint of that reaction earlier")
    return outputs


def _reaction(m: Declaration, joint: Symbol) -> Expr:
    d, total = m.tape.diff, Integer(0)
    for body in m.bodies:
        total += body.mass * sum((acceleration(m, p) * d(p, joint) for p in body.at), Integer(0))
        total += body.inertia * acceleration(m, body.turns) * d(body.turns, joint)
    held = (multiplier(m, name) * d(g, joint) for name, g in m.constraints.items())
    return total - generalized_force(m, joint) - sum(held, Integer(0))


def multiplier(m: Declaration, constraint: str) -> Symbol:
    """Letter of a constraint's multiplier: the reaction of the joint that it closes, or `force_<constraint>`.

    Returns symbol: an argument of the reactions.
    """
    return m.multiplier_of.get(constraint, Symbol(f"force_{constraint}", real=True))


def _momentum(m: Declaration) -> dict[str, Expr]:
    x, y, turning = Integer(0), Integer(0), Integer(0)
    for body in m.bodies:
        (px, py), (ax, ay) = body.at, (acceleration(m, p) for p in body.at)
        x, y = x + body.mass * ax, y + body.mass * ay
        turning += body.inertia * acceleration(m, body.turns)
        turning += 0 if body.about_axis else body.mass * (px * ay - py * ax)
    return {"momentum_rate_x": x, "momentum_rate_y": y, "angular_momentum_rate": turning}

r"""Equations of motion in space from a declaration: tree, closure, reactions, and which of these are determined.

.. math:: M \ddot q + h = Q + J^T \mu, \qquad J \ddot q + \gamma = 0

Rows that hold what others hold already are left out, as are reactions that hang on the forces between them.
"""

from collections.abc import Mapping

from sympy import Expr, Integer, Rational, Symbol

from mechsym.derive import vectors as vec
from mechsym.derive.lagrange import Equations, generalized_force, multiplier
from mechsym.derive.rates import curvature, velocity
from mechsym.derive.refuse import refuse
from mechsym.derive.roles import require_reactions
from mechsym.derive.space import SpatialDeclaration
from mechsym.derive.space_joints import KINDS, rows_of
from mechsym.derive.space_parts import SpaceJoint
from mechsym.derive.space_rank import ClosureChoice, choose, difference
from mechsym.derive.space_rows import ClosureRow, Push
from mechsym.derive.space_tree import Column, TreeBody, Wrench
from mechsym.derive.vectors import NONE, O, Vector

_HALF = Rational(1, 2)
_WRITTEN = tuple(
    {"title": title, "latex": left, "mathml": f"<mtext>{words}</mtext>"}
    for title, left, words in (
        ("velocities, from the frame on", r"\omega = E^T \omega_p + S_\omega \eta", "ω = Eᵀω_p + S_ω η"),
        (
            "velocities, from the frame on",
            r"v = E^T (v_p + \omega_p \times p) + S_v \eta",
            "v = Eᵀ(v_p + ω_p × p) + S_v η",
        ),
        (
            "forces of a body",
            r"F = m a + \alpha \times h + \omega \times (\omega \times h)",
            "F = m a + α × h + ω × (ω × h)",
        ),
        ("forces of a body", r"N = I \alpha + \omega \times I \omega + h \times a", "N = I α + ω × I ω + h × a"),
        ("motion", r"M \ddot q + h = Q + J^T \mu", "M q̈ + h = Q + Jᵀ μ"),
        ("loops", r"J \ddot q + \gamma = 0", "J q̈ + γ = 0"),
    )
)


def equations(m: SpatialDeclaration) -> Equations:
    """Exact equations of a mechanism in space."""
    m.settle()
    if not m.q:
        refuse(f"{m.name} has no coordinate; declare one: phi = m.coordinates('phi')", m.where[m.name])
    m.by_expression = dict(m.constraints)
    for link in m.space_links:
        w, _ = m.tree.rates(link.part)
        if link.flat and (w[0] != 0 or w[1] != 0):
            refuse(
                f"the inertia of {link.name} is about z, and it turns about more; give three numbers or six", link.where
            )
    if not any(link.mass != 0 or link.inertia != (NONE, NONE, NONE) for link in m.space_links):
        refuse(f"nothing in {m.name} has a mass; give a link a mass or an inertia", m.where[m.name])
    require_reactions(m, ())
    rows = _rows(m)
    slopes = {name: row.slopes(m.tree) for name, row in rows.items()}
    jacobian = {name: [m.tape.step(f"J_{name}", row.get(q, O)) for q in m.q] for name, row in slopes.items()}
    jacobian |= {name: [m.tape.diff(g, q) for q in m.q] for name, g in m.by_expression.items()}
    closures = {name: row.value(m.tree) for name, row in rows.items()} | m.by_expression
    mass = m.tree.mass_matrix(m.q)
    force = _forces(m)
    chosen = choose(m, closures, jacobian, mass)
    kept = [name for name in closures if name in chosen.rows]
    _take(m, chosen, closures, kept)
    pushes = {name: row.pushes(m.tree, multiplier(m, name)) for name, row in rows.items()}
    reactions = _reactions(m, rows, pushes, chosen)
    biases = {n: rows[n].bias(m.tree) if n in rows else curvature(m, closures[n]) for n in kept}
    _draw(m)
    kinematics: dict[str, Expr] = {s.name: s for s in m.kinematic_outputs}
    if len(m.q) == 1:
        kinematics |= _inertia(m, mass[0][0])
    total = O
    for part in m.tree.parts:
        if part.mass != 0 and m.gravity != NONE:
            at = vec.add(vec.scaled(part.mass, part.origin), vec.times(part.world, part.moment))
            total -= vec.dot(m.gravity, at)
    springs = [_HALF * s.value * s.along**2 for s in m.springs]
    result = Equations(
        mechanism=m,
        mass_matrix=tuple(map(tuple, mass)),
        bias=tuple(m.tree.generalized({p: m.tree.inertial(p, False) for p in m.tree.parts}, m.q, "b")),
        generalized_force=tuple(force),
        kinetic_energy=_HALF * m.tree.energy(),
        potential_energy=m.tape.named(sum([total, *springs, *m.stores], Integer(0))),
        reactions=reactions,
        kinematics=kinematics,
        momentum=_momentum(m),
        constraint_jacobian=tuple(tuple(jacobian[n]) for n in kept),
        constraint_bias=tuple(biases[n] for n in kept),
        checked=lambda: difference(m, result, chosen),
        written=_WRITTEN,
    )
    return result


def _rows(m: SpatialDeclaration) -> dict[str, ClosureRow]:
    """Rows of all joints that hang nothing, and of quaternions."""
    rows = dict(m.norms)
    for joint in m.space_joints:
        if joint.child is None:
            if joint.given:
                named = ", ".join(map(str, joint.given))
                refuse(f"the joint {joint.name!r} closes a loop and cannot have {named}; declare it before those that "
                       "hang its bodies", joint.where)  # fmt: skip
            joint.rows = rows_of(joint)
            rows |= joint.rows
            m.words.append(f"{joint.name} closes a loop")
    return rows


def _inertia(m: SpatialDeclaration, value: Expr) -> dict[str, Expr]:
    """The inertia that the only coordinate feels, and its slope."""
    q, per = m.q[0], m.units[m.q[0].name]
    unit, slope = "kg" if per == "m" else "kg*m^2", f"dinertia_d{q}"
    inertia = m.let("inertia", value, unit)
    m.units[slope] = f"{unit}/{per}"
    return {"inertia": inertia, slope: m.tape.derivative(inertia, q)}


def _forces(m: SpatialDeclaration) -> list[Expr]:
    """Generalised forces of what acts, and of weight by what each joint carries."""
    applied = [generalized_force(m, q) for q in m.q]
    if m.gravity == NONE:
        return applied
    weight = m.tree.generalized({part: _weight(m, part) for part in m.tree.parts}, m.q, "g")
    return [a + w for a, w in zip(applied, weight, strict=True)]


def _weight(m: SpatialDeclaration, part: TreeBody) -> Wrench:
    if part.mass == 0 or m.gravity == NONE:
        return NONE, NONE
    g = m.tape.vector(f"g_{part.name}", vec.back(part.world, m.gravity))
    return vec.cross(part.moment, g), vec.scaled(part.mass, g)


def _momentum(m: SpatialDeclaration) -> dict[str, Expr]:
    """Rates of momentum, and of that of rotation about the origin, of all bodies."""
    whole = m.tree.carried({part: m.tree.inertial(part, True) for part in m.tree.parts}, "o")
    n, f = whole.get(m.tree.frame, (NONE, NONE))
    rates = {f"momentum_rate_{a}": x for a, x in zip("xyz", f, strict=True)}
    rates |= {f"angular_momentum_rate_{a}": x for a, x in zip("xyz", n, strict=True)}
    return rates | {"angular_momentum_rate": n[2]}


def _take(m: SpatialDeclaration, chosen: ClosureChoice, closures: Mapping[str, Expr], kept: list[str]) -> None:
    """Let the declaration have what was chosen: dependent coordinates and rows; and say what is left out."""
    m.dependent_list = [q for q in m.q if q in chosen.dependents]
    m.guesses = {q.name: chosen.guesses[q] for q in m.dependent_list}
    m.constraints = {name: closures[name] for name in kept}
    m.words += [f"{q} is held by the loops, from {m.guesses[q.name]:g} on" for q in m.dependent_list]
    m.words += [f"{q} moves freely" for q in m.own if q not in chosen.dependents]
    m.redundant = chosen.redundant


def _reactions(
    m: SpatialDeclaration, rows: Mapping[str, ClosureRow], pushes: Mapping[str, list[Push]], chosen: ClosureChoice
) -> dict[str, Expr]:
    """Six components at every joint, at the point of the second body; those that are not determined are left out."""
    tree, outer = m.tree, _outer(m)
    for push in (p for name in rows if name in pushes for p in pushes[name]):
        _add(m, outer, push)
    total = {}
    for part in tree.parts:
        (n, f), (n_, f_), weight = tree.inertial(part, True), outer.get(part, (NONE, NONE)), _weight(m, part)
        total[part] = vec.less(vec.less(n, n_), weight[0]), vec.less(vec.less(f, f_), weight[1])
    carried = tree.carried(total, "r")
    reactions: dict[str, Expr] = {}
    for joint in m.space_joints:
        force, moment = _closed(joint, pushes) if joint.child is None else _borne(m, joint, carried)
        if KINDS[joint.kind].forces == "n":
            reactions[f"R_{joint.name}"] = multiplier(m, joint.name)
            continue
        axes = (joint.axes or m.frame).part
        if axes.path:
            force, moment = (m.tape.vector("seen", vec.back(axes.world, v)) for v in (force, moment))
        for stem, letters, values in (("R", KINDS[joint.kind].forces, force), ("M", KINDS[joint.kind].moments, moment)):
            reactions |= {f"{stem}_{a}_{joint.name}": values["xyz".index(a)] for a in letters}
    absent = {multiplier(m, n): O for n in rows if n not in chosen.rows}
    m.undetermined = chosen.open_reactions(m, rows, reactions)
    for name, value in (*reactions.items(), *m.dynamic_outputs.items()):
        hanging = sorted(s.name for s in value.free_symbols if s.name in m.undetermined)
        if hanging:
            refuse(f"{name} hangs on {', '.join(hanging)}, which no equation determines: {m.redundant[0]}")
    known = {Symbol(n, real=True): v for n, v in reactions.items()}
    outputs = {n: _without(m, v, absent) for n, v in reactions.items() if n not in m.undetermined}
    outputs |= {n: _without(m, e.xreplace(known), absent) for n, e in m.dynamic_outputs.items()}
    return {n: v for n, v in outputs.items() if v != 0}


def _without(m: SpatialDeclaration, value: Expr, absent: Mapping[Symbol, Expr]) -> Expr:
    """A value with the multipliers of rows that are left out at 0, all through the tape."""
    if not absent:
        return value
    known: dict[Symbol, Expr] = dict(absent)
    for symbol in m.tape.needed([value]):
        entry = m.tape.entries[symbol]
        if entry.free_symbols & known.keys():
            known[symbol] = m.tape.step(f"{symbol.name}_", entry.xreplace(known))
    return value.xreplace(known)


def _add(m: SpatialDeclaration, outer: dict[TreeBody, Wrench], push: Push) -> None:
    part, force, moment, at = push
    if not part.path:
        return
    arm = m.tape.vector("arm", vec.less(at, part.origin))
    moment = vec.add(moment, vec.cross(arm, force))
    n, f = (m.tape.vector("on", vec.back(part.world, v)) for v in (moment, force))
    before = outer.get(part, (NONE, NONE))
    outer[part] = vec.add(before[0], n), vec.add(before[1], f)


def _outer(m: SpatialDeclaration) -> dict[TreeBody, Wrench]:
    """What acts on the bodies themselves: every element by the points that its displacement is made of."""
    elements = [(f.value, f.along) for f in m.forces]
    elements += [(-s.value * s.along, s.along) for s in m.springs]
    elements += [(-c.value * velocity(m, c.along), c.along) for c in m.dampers]
    elements += [(Integer(-1), energy) for energy in m.stores]
    elements += [(multiplier(m, n), g) for n, g in m.by_expression.items()]
    outer: dict[TreeBody, Wrench] = {}
    for value, along in elements:
        expression = _of_points(m, along)
        for symbol in sorted(expression.free_symbols & m.places.keys(), key=lambda s: s.name):
            point, k = m.places[symbol]
            push = m.tape.step("pushed", value * m.tape.named(expression.diff(symbol)))
            force: Vector = tuple(push if i == k else O for i in range(3))
            _add(m, outer, (point.link.part, force, NONE, m.tree.place(point.link.part, point.at)))
    return outer


def _of_points(m: SpatialDeclaration, value: Expr) -> Expr:
    """An expression in coordinates, places of points and parameters."""
    while names := (value.free_symbols & m.tape.entries.keys()) - m.places.keys():
        value = value.xreplace({name: m.tape.entries[name] for name in names})
    return value


def _closed(joint: SpaceJoint, pushes: Mapping[str, list[Push]]) -> tuple[Vector, Vector]:
    """Force and moment of the first on the second, of a joint that closes a loop."""
    force = moment = NONE
    for name in joint.rows:
        (_, f, n, _), *_ = pushes[name]
        force, moment = vec.add(force, f), vec.add(moment, n)
    return force, moment


def _borne(m: SpatialDeclaration, joint: SpaceJoint, carried: Mapping[TreeBody, Wrench]) -> tuple[Vector, Vector]:
    """The same of one that hangs a body, without what acts along its freedoms."""
    if joint.kind == "free":
        return NONE, NONE
    part, tree = joint.parts[-1], m.tree
    sign = 1 if joint.child is joint.second.link else -1
    n, f = (m.tape.vector("out", vec.times(part.world, v)) for v in carried[part])
    second = joint.sides[1]
    arm = m.tape.vector("arm", vec.less(tree.place(second.part, second.at), part.origin))
    n = vec.less(n, vec.cross(arm, f))
    f, n = (m.tape.vector("joint", vec.scaled(sign, v)) for v in (f, n))
    for one in joint.parts:
        for column in one.columns:
            if _free(column):
                axis = tree.out(one, column.axis)
                along = m.tape.step("along", vec.dot(axis, n if column.turns else f))
                if column.turns:
                    n = vec.less(n, vec.scaled(along, axis))
                else:
                    f = vec.less(f, vec.scaled(along, axis))
    return f, n


def _free(column: Column) -> bool:
    """Whether a freedom is a coordinate of its own, along which the joint itself bears nothing."""
    return len(column.by) == 4 or list(column.by.values()) in ([1], [-1])


def _draw(m: SpatialDeclaration) -> None:
    """Every link as lines through what its joints hold, and struts, where the declaration draws nothing."""
    if m.shapes:
        return
    for link in m.space_links:
        sides = [s for j in m.space_joints for s in (j.first, j.second) if s.link is link and j.kind != "free"]
        sides += [p for p in m.watched.values() if p.link is link]
        points = list({s.at: link.at(*s.at) for s in sides}.values())
        if link.centre not in {p.at for p in points} and (len(points) < 2):
            points.append(link.at(*link.centre))
        role = "crank" if any(j.given and j.child is link for j in m.space_joints) else "rod"
        if len(points) > 1:
            m.draw_line(*points, *(points[:1] if len(points) > 2 else ()), role=role)
    for strut in (joint for joint in m.space_joints if joint.kind == "strut"):
        m.draw_line(strut.first, strut.second, role="rod")


SpatialDeclaration.solved_by = equations

"""The equations of a mechanism as LaTeX and MathML, stored beside the generated code so that reports need no sympy."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import NotRequired, TypedDict, cast

from sympy import Eq, Expr, Function, Integer, Mul, Symbol, atan, atan2, cos, latex, mathml, sin, tan

from mechsym.derive.declare import Body, Declaration, Element
from mechsym.derive.emit import groups
from mechsym.derive.lagrange import Equations
from mechsym.derive.linkage import Link, LinkPoint
from mechsym.derive.rates import accelerations, velocities
from mechsym.derive.space import SpatialDeclaration
from mechsym.derive.space_parts import SpaceLink
from mechsym.files import Json

_DOT, _TWO_DOTS = "\u0307", "\u0308"
_LATEX = {"lam": r"\lambda", "phi": r"\varphi", "inertia": "I"}
_PLACED = ("revolute", "universal", "spherical")  # joints in space that stand at a point of both bodies
_FEW = 6  # names in the formula of a centre
_GREEK = {
    "phi": "\u03c6", "psi": "\u03c8", "theta": "\u03b8", "alpha": "\u03b1", "beta": "\u03b2", "gamma": "\u03b3",
    "delta": "\u03b4", "lam": "\u03bb", "mu": "\u03bc", "xi": "\u03be", "eta": "\u03b7", "rho": "\u03c1",
    "sigma": "\u03c3", "tau": "\u03c4", "chi": "\u03c7", "omega": "\u03c9", "inertia": "I",
}  # fmt: skip


class Listing(TypedDict):
    """What is stored of a mechanism beside its code; units are by letter."""

    name: str
    about: str
    source: str
    coordinates: dict[str, str]
    parameters: dict[str, str]
    inputs: dict[str, str]
    outputs: dict[str, str]
    reactions: NotRequired[dict[str, str]]  #: What bears each
    constraints: NotRequired[list[str]]
    checked: NotRequired[int]  #: Random states at which T - V agreed
    equations: list[dict[str, str]]  #: Title, LaTeX and MathML of each
    dependents: NotRequired[list[str]]
    pose: NotRequired[dict[str, float]]  #: Of independent coordinates, where it was assembled
    guesses: NotRequired[dict[str, float]]
    multipliers: NotRequired[dict[str, str]]
    ranges: NotRequired[dict[str, Json]]
    requires: NotRequired[list[dict[str, str]]]
    roles: NotRequired[dict[str, list[Json]]]  #: Of each kind of `mechsym.mechanisms.roles`
    shapes: NotRequired[list[Json]]
    pins: NotRequired[dict[str, list[str]]]  #: Where each pin is drawn, and each slide, with a place across it
    sketch: NotRequired[list[Json]]
    links: NotRequired[list[Json]]
    bodies: NotRequired[dict[str, list[str]]]  #: Centres of what is no link, by coordinates and parameters
    solids: NotRequired[list[list[str]]]  #: Mass, inertia and angle of bodies that are no links
    weight: NotRequired[list[str]]  #: Acceleration of free fall along each axis
    springs: NotRequired[list[str]]
    dampers: NotRequired[list[str]]
    stretches: NotRequired[list[list[str]]]  #: Stiffness and stretch of springs, by coordinates and parameters
    watched: NotRequired[list[str]]  #: Points that `m.watch` names
    undetermined: NotRequired[list[str]]  #: Reactions that joints hold against one another, in space
    redundant: NotRequired[list[str]]  #: Which joints these are, in words
    tensors: NotRequired[dict[str, list[str]]]  #: Inertia of bodies in space: xx, yy, zz, xy, xz, yz
    open_sides: NotRequired[list[str]]  #: Joints of loops of pins whose side nobody chose


def listing(equations: Equations) -> Listing:
    """Letters, units, source and equations of a mechanism, ready for JSON.

    Returns listing: keys name, about, source, coordinates, parameters, inputs, outputs, reactions, equations.
    """
    m = equations.mechanism
    outputs = [name for g in groups(equations) if g.name in ("kinematics", "reactions") for name in g.outputs]
    stored = {
        "name": m.name,
        "about": m.about,
        "source": m.source,
        "coordinates": {s.name: m.units[s.name] for s in m.q},
        "parameters": {s.name: m.units[s.name] for s in m.parameter_list},
        "inputs": {s.name: m.units[s.name] for s in m.input_list},
        "outputs": {name: _unit(m, name) for name in outputs},
        "reactions": {m.reaction_of.get(s, s).name: about for s, about in m.joint_about.items()},
        "constraints": list(m.constraints),
        **_own(m),
        "equations": [*equations.written] or [_equation(m, *row) for row in _rows(equations)],
    }
    return cast(Listing, stored)


def _own(m: Declaration) -> Json:
    """What only some declarations say."""
    said = {
        "dependents": [s.name for s in m.dependent_list],
        "pose": {q.name: m.poses[q.name] for q in m.q if q.name in m.poses and q not in m.dependent_list},
        "guesses": m.guesses,
        "multipliers": {c: s.name for c, s in m.multiplier_of.items()},
        "ranges": m.ranges,
        "requires": m.requires,
        "roles": m.roles,
        "shapes": m.shapes,
        "pins": m.pins,
        "sketch": m.sketches,
        "links": [link for link in (*map(partial(_link, m), m.links), *_in_space(m)) if link],
        "bodies": _bodies(m),
        "solids": [[str(b.mass), str(b.inertia), str(b.turns), *_short(m, b.at)] for b in _loose(m) if b.inertia != 0],
        "weight": [*map(str, m.gravity)] if any(m.gravity) else [],
        "springs": _constants(m, m.springs),
        "dampers": _constants(m, m.dampers),
        "stretches": [[str(s.value), *short] for s in m.springs if (short := _short(m, [s.along]))],
        "watched": [*m.watched],
        "undetermined": m.undetermined,
        "redundant": m.redundant,
        "tensors": m.tensors,
        "open_sides": [side.joint for side in m.sides if side.pins and not side.by],
    }
    return {key: value for key, value in said.items() if value}


def _constants(m: Declaration, elements: Sequence[Element]) -> list[str]:
    """Stiffness or damping of elements, by letters of the parameters; one that moves is left out."""
    return [str(e.value) for e in elements if e.value.free_symbols <= {*m.parameter_list}]


def _bodies(m: Declaration) -> dict[str, list[str]]:
    """Centres that move as a short formula of coordinates says; links are told by themselves."""
    return {body.name: place for body in _loose(m) if (place := _short(m, body.at))}


def _loose(m: Declaration) -> list[Body]:
    """Bodies with a mass that are no links."""
    links = {link.name for link in m.links}
    return [body for body in m.bodies if body.name not in links and body.mass != 0]


def _short(m: Declaration, formulas: Sequence[Expr]) -> list[str]:
    """Formulas of what moves by coordinates and parameters; none where they are long, or hang on anything else."""
    if len(m.tape.needed(formulas)) > _FEW:
        return []
    flat, moves = [m.tape.flat(formula) for formula in formulas], {*m.q} - {*m.dependent_list}
    letters = {s for one in flat for s in one.free_symbols}
    plain = all(isinstance(f, (sin, cos, tan, atan, atan2)) for one in flat for f in one.atoms(Function))
    return [str(one) for one in flat] if plain and letters & moves and letters <= moves | {*m.parameter_list} else []


def _link(m: Declaration, link: Link) -> Json:
    """Mass, inertia, centre, joints and watched points of a link in its axes, by letters of the parameters, if any."""
    joints = [joint for joint in m.link_joints if link in (joint.first.link, joint.second.link)]
    sides = [*(joint.side(link) for joint in joints), *(p for p in m.watched.values() if isinstance(p, LinkPoint))]
    sides = [side for side in sides if side.link is link]
    points = list(dict.fromkeys((str(p.u), str(p.v)) for p in sides if isinstance(p, LinkPoint)))
    free = {s for p in sides if isinstance(p, LinkPoint) for s in p.u.free_symbols | p.v.free_symbols}
    alone = len(points) == 1 and points[0] != tuple(map(str, link.centre))  # hangs on its joint
    if link.mass == link.inertia == 0 or len(points) < 2 and not alone or not free <= {*m.parameter_list}:
        return {}
    ground = [joint.side(link) for joint in joints if joint.other(link).link is m.frame and joint.kind == "pin"]
    known = None if link.turns is None else m.tape.flat(link.turns)
    driver = [q for q in m.q if q not in m.dependent_list and known is not None and not (known - q).free_symbols]
    return {
        "name": link.name,
        "mass": str(link.mass),
        "inertia": str(link.inertia),
        "centre": [str(c) for c in link.centre],
        "points": points,
        "pivot": next(((str(p.u), str(p.v)) for p in ground if isinstance(p, LinkPoint)), None),
        "turns": str(driver[0]) if driver else "",
    }


def _in_space(m: Declaration) -> list[Json]:
    if not isinstance(m, SpatialDeclaration):
        return []
    return [_body(m, body) for body in m.space_links]


def _body(m: SpatialDeclaration, body: SpaceLink) -> Json:
    """As `_link`; the inertia is half the trace, mass times squared distance of all that is in it from its centre."""
    held = [
        (joint, side, other)
        for joint in m.space_joints
        for side, other in ((joint.first, joint.second), (joint.second, joint.first))
        if side.link is body and joint.kind in _PLACED
    ]
    places = [*(side.at for _, side, _ in held), *(p.at for p in m.watched.values() if p.link is body)]
    points = list(dict.fromkeys(tuple(map(str, at)) for at in places))
    free = {s for at in places for x in at for s in x.free_symbols}
    inertia = body.inertia[2][2] if body.flat else sum(body.inertia[i][i] for i in range(3)) / 2
    if body.mass == inertia == 0 or not points or not free <= {*m.parameter_list}:
        return {}
    ground = [(joint, side) for joint, side, other in held if other.link is m.frame]
    turns = [q for joint, _ in ground for q in joint.given if q in m.q and q not in m.dependent_list]
    return {
        "name": body.name,
        "mass": str(body.mass),
        "inertia": str(inertia),
        "centre": [*map(str, body.centre)],
        "points": points,
        "pivot": next((tuple(map(str, side.at)) for _, side in ground), None),
        "turns": str(turns[0]) if turns else "",
    }


def _unit(m: Declaration, name: str) -> str:
    if name in m.units:
        return m.units[name]
    root, by = m.tape.derived_from(Symbol(name, real=True))
    bottom = "*".join(m.units[v.name] for v in by)
    top = m.units.get(root.name, "")
    return f"{top}/{bottom}" if len(by) == 1 else f"{top}/({bottom})"


def _rows(equations: Equations) -> list[tuple[str, Expr, Expr]]:
    m, rows = equations.mechanism, []
    held = dict.fromkeys(m.joint_list, Integer(0))
    masses = [entry for row in equations.mass_matrix for entry in row]
    wanted = [*equations.kinematics.values(), *equations.generalized_force, *equations.bias, *masses]
    for symbol in m.tape.needed(wanted):
        if not symbol.name.startswith(("sin_", "cos_")) or symbol.name[4:] not in {v.name for v in m.tape.variables}:
            rows.append(("kinematics", symbol, m.tape.entries[symbol].xreplace(held)))
    for i, a in enumerate(m.q):
        row = sum(e * x for e, x in zip(equations.mass_matrix[i], accelerations(m), strict=True))
        rows.append((f"motion of {a.name}", row + equations.bias[i], equations.generalized_force[i].xreplace(held)))
    if equations.kinetic_energy is not None and equations.potential_energy is not None:
        rows.append(("kinetic energy", Symbol("T"), equations.kinetic_energy))
        rows.append(("potential energy", Symbol("V"), equations.potential_energy.xreplace(held)))
    return rows


def _equation(m: Declaration, title: str, left: Expr, right: Expr) -> dict[str, str]:
    equation = Eq(_physical(m, left), _physical(m, right), evaluate=False)
    names = {s: _latex_name(m, s) for s in equation.free_symbols}
    letters = {s: Symbol(_math_name(m, s)) for s in equation.free_symbols}
    times = "dot" if any(_has_word(m, product) for product in equation.atoms(Mul)) else None
    return {
        "title": title,
        "latex": latex(equation, symbol_names=names, mul_symbol=times),
        "mathml": mathml(equation.xreplace(letters), printer="presentation", mul_symbol=times),
    }


def _has_word(m: Declaration, product: Expr) -> bool:
    """Whether a word is a factor: without a sign it runs into the next one."""
    factors = [f.as_base_exp()[0] for f in product.args if not f.is_number]
    symbols = [f for f in factors if f.is_Symbol and not _circular(m, f)]
    stems = [_split(_stem(m, m.tape.derived_from(s)[0])[0])[0] for s in symbols]
    return len(factors) > 1 and any(len(stem) > 1 and stem not in _GREEK for stem in stems)


def _physical(m: Declaration, expression: Expr) -> Expr:
    """Names such as sin_phi turned back into sin(phi); their derivatives stay names."""
    values: dict[Symbol, Expr] = {}
    for symbol in expression.free_symbols:
        circular = _circular(m, symbol)
        if circular and not m.tape.derived_from(symbol)[1]:
            kind, inner = circular
            values[symbol] = {"sin": sin, "cos": cos}[kind](inner)
    return expression.xreplace(values)


def _circular(m: Declaration, symbol: Symbol) -> tuple[str, Symbol] | None:
    kind, _, angle = m.tape.derived_from(symbol)[0].name.partition("_")
    inner = Symbol(angle, real=True)
    return (kind, inner) if kind in ("sin", "cos") and inner in (*m.tape.variables, *m.tape.entries) else None


def _stem(m: Declaration, symbol: Symbol) -> tuple[str, int]:
    for order, rates in enumerate((velocities(m), accelerations(m)), 1):
        names = [s.name for s in rates]
        if symbol.name in names:
            return m.q[names.index(symbol.name)].name, order
    return symbol.name, 0


def _split(name: str) -> tuple[str, str]:
    letters, _, index = name.partition("_")
    stem = letters.rstrip("0123456789")
    if stem[0] == "I" and stem[1:].isupper():  # IC2 is an I about the point C2
        stem = "I"
    return stem, ", ".join(part for part in (letters[len(stem) :], index) if part)


def _marks(m: Declaration, by: tuple[Symbol, ...], name: Callable[[Declaration, Symbol], str]) -> tuple[str, str]:
    """Primes where there is one coordinate, else the variables as further indices after a comma."""
    if not by:
        return "", ""
    return ("\u2032" * len(by), "") if len(m.q) == 1 else ("", "," + "".join(name(m, v) for v in by))


def _latex_name(m: Declaration, symbol: Symbol) -> str:
    root, by = m.tape.derived_from(symbol)
    primes, further = _marks(m, by, _latex_name)
    primes = "'" * len(primes)
    if circular := _circular(m, symbol):
        body, index = rf"(\{circular[0]} {_latex_name(m, circular[1])})", ""
    else:
        name, dots = _stem(m, root)
        stem, index = _split(name)
        greek = _LATEX.get(stem, f"\\{stem}" if stem in _GREEK else stem)
        body = ("", r"\dot", r"\ddot")[dots] + (f"{{{greek}}}" if dots else greek)
    # braces keep a power apart from the primes, which are powers to LaTeX
    return (f"{{{body}{primes}}}" if primes else body) + (f"_{{{index}{further}}}" if index or further else "")


def _math_name(m: Declaration, symbol: Symbol) -> str:
    root, by = m.tape.derived_from(symbol)
    primes, further = _marks(m, by, _math_name)
    if circular := _circular(m, symbol):
        body, index = f"({circular[0]} {_math_name(m, circular[1])})", ""
    else:
        name, dots = _stem(m, root)
        stem, index = _split(name)
        body = _GREEK.get(stem, stem) + ("", _DOT, _TWO_DOTS)[dots]
    further = further.replace("_", "")
    return f"{body}{primes}" + (f"_{index}{further}" if index or further else "")

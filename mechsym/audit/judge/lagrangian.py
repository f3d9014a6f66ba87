r"""Equations of motion that follow from the energies which a text prints, by the Lagrange equation that stands there.

.. math:: \frac{d}{dt}\frac{\partial L}{\partial\dot q} - \frac{\partial L}{\partial q} = Q
"""

import ast
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from mechsym.audit.judge.motion import energies_of
from mechsym.audit.judge.sampled import alike, free, is_multiple, states
from mechsym.audit.judge.world import World
from mechsym.audit.read.lagrange import LagrangeEquation, Term, plain_letter
from mechsym.audit.read.slopes import slope_in
from mechsym.audit.read.tree import Node, binary, is_operation, letters, name, negative, number, substitute, value_of
from mechsym.audit.theory.record import Theory, dependencies
from mechsym.audit.theory.tape import derivative, is_zero, minus, over, plus, slope_by, times
from mechsym.quantities import record

_INDEX = re.compile(r"(\w+?)_?([ijkrs])$")
_MOST = 12  # laws of one text
_DEEPEST = 12  # definitions within definitions


@record
class MotionLaw:
    """The equation of motion of a coordinate."""

    coordinate: str
    residual: Node  #: What the energies give, in letters that the text does not define
    order: int  #: Place of its Lagrange equation in the text [-]
    acts: str | None  #: The letter that stands on the other side, empty for 0, None where it is not known

    def vanishing(self, used: set[str], right: str = "") -> Node:
        """Both sides on one side; what acts is 0 where an equation does not have it, `right` where no law names it."""
        acts = right if self.acts is None else self.acts if self.acts in used else ""
        return minus(self.residual, name(acts)) if acts else self.residual


@dataclass
class Energies:
    """What the energies of a text say of its equations of motion."""

    world: World
    laws: Sequence[MotionLaw]
    shares: dict[str, Node] = field(default_factory=dict)  #: Letters before an acceleration, and what they have to be

    def __post_init__(self) -> None:
        """Find the letters that stand before an acceleration in an equation of motion."""
        defined = {d.letter for d in self.world.defined}
        for order, said in enumerate(self.world.paper.said):
            for law in self._at(order):
                if len(said.sides) != 2 or not isinstance(said.sides[0], ast.Name) or said.sides[0].id != law.acts:
                    continue
                for q in self.world.coordinates:
                    before, wanted = (slope_by(tree, f"{q}dd") for tree in (said.sides[1], law.residual))
                    if isinstance(before, ast.Name) and before.id in defined:
                        self.shares[before.id] = wanted

    def _at(self, order: int) -> list[MotionLaw]:
        # of each coordinate the last law in front of an equation, or behind it in its section
        said = self.world.paper.said
        chosen: dict[str, MotionLaw] = {}
        for law in self.laws:
            behind = law.coordinate not in chosen and said[law.order].section == said[order].section
            if law.order <= order or behind:
                chosen[law.coordinate] = law
        return [*chosen.values()]

    def tells(self, order: int, theory: Theory, sides: Sequence[Node]) -> bool:
        """Whether the energies say something of an equation: it has an acceleration, or is what stands before one."""
        if not self._at(order) or len(sides) != 2:
            return False
        left, right = sides
        if isinstance(left, ast.Name):
            return bool(self._of_letter(order, left.id, right, theory)) and left.id not in letters(right)
        return any(f"{q}dd" in letters(side) for side in sides for q in self.world.coordinates)

    def _of_letter(self, order: int, letter: str, right: Node, theory: Theory) -> list[Node]:
        wanted = [law.residual for law in self._at(order) if law.acts == letter]
        if coupled := self._coupled(order, letter):
            rates = accelerations(coupled, _used(theory, [right]))
            wanted += [tree for rate, tree in rates.items() if rate == letter]
        return wanted + [tree for share, tree in self.shares.items() if share == letter]

    def _coupled(self, order: int, rate: str) -> list[MotionLaw]:
        # the laws that a second rate follows from: its own, and those of the second rates in them
        chosen: dict[str, MotionLaw] = {}
        waiting = [rate]
        while waiting:
            wish = waiting.pop()
            own = next((law for law in self._at(order) if f"{law.coordinate}dd" == wish), None)
            if own is not None and wish not in chosen:
                chosen[wish] = own
                waiting += [k for k in letters(own.residual) if k.endswith("dd")]
        return [*chosen.values()]

    def holds(self, order: int, theory: Theory, sides: Sequence[Node]) -> bool:
        """Whether an equation follows from the energies, as it stands or times what does not move."""
        left, right = sides
        if isinstance(left, ast.Name):
            return any(alike(states(theory), tree, right) for tree in self._of_letter(order, left.id, right, theory))
        (left, _), (right, _) = (self._acted(order, theory, side) for side in sides)
        used, whole = _used(theory, (left, right)), minus(left, right)
        acts = right.id if isinstance(right, ast.Name) else ""
        wanted = [law.vanishing(used, acts) for law in self._at(order)]
        return any(same_motion(theory, self.world.coordinates, whole, tree) for tree in wanted)

    def _acted(self, order: int, theory: Theory, tree: Node) -> tuple[Node, Node]:
        # a side without terms of what acts from outside, whose letters no energy has, and these terms
        laws = self._at(order)
        if isinstance(tree, ast.Name) or any(law.acts is not None for law in laws):
            return tree, number(0)
        known = {k for law in laws for k in letters(law.residual)} | {f"{law.coordinate}d" for law in laws}
        return _within(theory, tree, known)

    def wanted(self, order: int, theory: Theory, sides: Sequence[Node]) -> tuple[Node, list[Node], Node]:
        """The side that a slip is looked for in, what it may have to be, and what acts from outside beside it."""
        left, right = sides
        if isinstance(left, ast.Name):
            return right, self._of_letter(order, left.id, right, theory), number(0)
        (left, beside), (right, _) = (self._acted(order, theory, side) for side in sides)
        acting = {right.id} if isinstance(right, ast.Name) else set()
        printed = left if acting or value_of(right) == 0 else minus(left, right)
        own = [law for law in self._at(order) if f"{law.coordinate}dd" in letters(printed)]
        used = _used(theory, sides) - acting
        chosen = [law for law in own if not acting or law.acts in {*acting, None}]
        # the slip may stand in what is before the acceleration
        every = [tree for law in chosen for tree in (law.vanishing(used), scaled(law, printed, used))]
        return printed, every, beside if printed is left else number(0)


def _used(theory: Theory, sides: Sequence[Node]) -> set[str]:
    # and what the text defines by nothing but these: Q where its own formula stands
    inside = [k for side in sides for k in letters(side)]
    used = {*inside, *dependencies(theory, [k for k in inside if k in theory.tape])}
    defined = {k: {*letters(tree)} for k, tree in theory.tape.items() if isinstance(tree, ast.expr)}
    return used | {k for k, needs in defined.items() if needs and needs <= used}


def _within(theory: Theory, tree: Node, known: set[str]) -> tuple[Node, Node]:
    # the terms of a sum that are in known letters, and the others
    if is_operation(tree, ast.Add, ast.Sub):
        joined = plus if isinstance(tree.op, ast.Add) else minus
        left, right = _within(theory, tree.left, known), _within(theory, tree.right, known)
        return joined(left[0], right[0]), joined(left[1], right[1])
    return (tree, number(0)) if free(theory, tree) <= known else (number(0), tree)


def laws(world: World) -> list[MotionLaw]:
    """What the Lagrange equations of a text come to for its coordinates."""
    printed = [(order, said.law) for order, said in enumerate(world.paper.said) if said.law is not None]
    every = [law for order, equation in printed or _implied(world) for law in _of(world, order, equation)]
    return every if len(every) <= _MOST else []


def _implied(world: World) -> Iterator[tuple[int, LagrangeEquation]]:
    # of a text that prints its energies and only speaks of Lagrange
    energies = energies_of(world.paper)
    orders = [d.order for d in world.defined if d.letter in energies]
    for q in sorted(world.coordinates) if len(orders) >= len(energies) > 0 else ():
        timed = Term(of=energies[0], by=f"{q}d", sign=1, timed=True)
        slopes = (Term(of=of, by=q, sign=sign, timed=False) for of, sign in zip(energies, (-1, 1), strict=False))
        yield max(orders), LagrangeEquation(terms=(timed, *slopes), right="")


def _of(world: World, order: int, printed: LagrangeEquation) -> Iterator[MotionLaw]:
    theory = world.theory(order)
    written = next(t.by for t in printed.terms if t.timed).removesuffix("d")
    generic = None if written in world.coordinates else _INDEX.match(written)
    coordinates = [written]
    if generic:
        coordinates = sorted(q for q in world.coordinates if re.fullmatch(rf"{generic[1]}\d", q))
        coordinates = coordinates or sorted(world.coordinates)
    for q in coordinates:
        residual: Node = number(0)
        for term in printed.terms:
            by = f"{q}d" if term.by == f"{written}d" else q if term.by == written else term.by
            whole = _whole(theory, world.coordinates, term.of)
            if whole is None:
                return
            part = slope_by(whole, by)
            part = derivative(part, lambda k: _rate(theory, world.coordinates, k)) if term.timed else part
            residual = (minus if term.sign < 0 else plus)(residual, part)
        if not is_zero(residual) and f"{q}dd" in theory.letters:
            index = q[len(q.rstrip("0123456789")) :] if generic else ""
            acts = _acts(printed.right, index, theory, world)
            yield MotionLaw(coordinate=q, residual=residual, order=order, acts=acts)


def _rate(theory: Theory, coordinates: frozenset[str], letter: str) -> Node:
    # J_d is no rate of J, and what moves in another section is still here
    moves = letter in coordinates or letter.removesuffix("d") in coordinates
    return name(f"{letter}d") if moves and f"{letter}d" in theory.letters else number(0)


def _acts(right: str, index: str, theory: Theory, world: World) -> str | None:
    if right == "0":
        return ""
    letter = plain_letter(right)
    generic = _INDEX.match(letter)
    if generic and index.isdigit():
        letter = f"{generic[1]}{index}"
    used = letter in theory.letters or any(d.letter == letter for d in world.defined)
    return letter if letter and used else None


def _whole(theory: Theory, coordinates: frozenset[str], letter: str, depth: int = 0) -> Node | None:
    """A letter in those that the text does not define, with rates of the others multiplied out."""
    tree = theory.tape.get(letter)
    if not isinstance(tree, ast.expr) or depth > _DEEPEST:
        return None
    inner: dict[str, Node | None] = {}
    for k in letters(tree):
        stem = k.removesuffix("d")
        if k in theory.tape:
            inner[k] = _whole(theory, coordinates, k, depth + 1)
        elif theory.angle and (slope := slope_in(k, theory.angle)) and slope.integrated in theory.tape:
            of = _whole(theory, coordinates, slope.integrated, depth + 1)
            inner[k] = None if of is None else slope_by(of, theory.angle)
        elif k.endswith("d") and k not in theory.letters and stem in theory.tape:
            of = _whole(theory, coordinates, stem, depth + 1)
            inner[k] = None if of is None else derivative(of, lambda one: _rate(theory, coordinates, one))
    if any(v is None for v in inner.values()):
        return None
    return substitute(tree, lambda n: inner.get(n.id) if isinstance(n, ast.Name) else None)


def accelerations(every: Sequence[MotionLaw], used: set[str]) -> Mapping[str, Node]:
    """What the second rates of one or two coordinates are, by the rule of Cramer."""
    size = len(every)
    if size not in (1, 2) or len({law.coordinate for law in every}) < size:
        return {}
    rates = [f"{law.coordinate}dd" for law in every]
    rows = [law.vanishing(used) for law in every]
    matrix = [[slope_by(row, rate) for rate in rates] for row in rows]
    rest = [substitute(row, lambda n: number(0) if isinstance(n, ast.Name) and n.id in rates else None) for row in rows]
    if size == 1:
        return {rates[0]: negative(over(rest[0], matrix[0][0]))}
    (a, b), (c, d) = matrix
    whole = minus(times(a, d), times(b, c))
    return {
        rates[0]: over(minus(times(b, rest[1]), times(d, rest[0])), whole),
        rates[1]: over(minus(times(c, rest[0]), times(a, rest[1])), whole),
    }


def scaled(law: MotionLaw, printed: Node, used: set[str]) -> Node:
    """What an equation has to come to, whose author divided it by what stands before the acceleration."""
    rate = f"{law.coordinate}dd"
    own, theirs = (slope_by(tree, rate) for tree in (law.residual, printed))
    whole = law.vanishing(used)
    return whole if is_zero(own) or is_zero(theirs) else binary(ast.Mult, whole, over(theirs, own))


def same_motion(theory: Theory, coordinates: frozenset[str], left: Node, right: Node) -> bool:
    """Whether two expressions vanish for the same motions: one is the other times what does not move."""
    at = states(theory)
    moving = {f"{q}{dots}" for q in coordinates for dots in ("", "d", "dd")}
    for letter in theory.letters.keys() - moving:
        at.values[letter] = np.full_like(at.values[letter], at.values[letter][0])
    return is_multiple(at, left, right)

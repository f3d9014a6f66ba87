"""Which shipped theories a text is about: found by the values of its own formulas, and what they then say of the rest.

A theory fits where two formulas of the text with at least two letters are its quantities at random states, under one
reading of the letters: by their names and units, and by which of the theory's quantities they must be.
"""

import ast
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import islice, product

import numpy as np

from mechsym.audit.judge.dimensions import kind_of
from mechsym.audit.judge.kinds import Kinds
from mechsym.audit.judge.lexicon import are_both_heats
from mechsym.audit.judge.world import World
from mechsym.audit.read.algebra import FLOATS, evaluate
from mechsym.audit.read.said import Said
from mechsym.audit.read.tree import Node, letters, name, walk
from mechsym.audit.theory.catalogue import named, names
from mechsym.audit.theory.record import Theory, complete
from mechsym.errors import BadInput
from mechsym.quantities import record

_STATES = 16
_READINGS = 80  # readings of the letters of one formula that are tried
_CLOSE = 1e-9
_SAME = {"R": "r", "L": "l", "varphi": "phi", "psi": "beta"}
_UNFIT = re.compile("_(?:constraints|truncated|printed)$")  # what an author has cut short is no theory
_INNER = re.compile(
    "residual_|bias|force_phi|force_theta|force_alpha|R_[xy]_|.*_phi$|generalized_force|.*energy"
)  # names that no text has
_FORCE = re.compile(r"\b(?:gas|driving|external|applied|useful)\b.*\bforce\b|\bforce of the gas\b", re.IGNORECASE)
_SPARE = {"force", "piston", "of", "on", "the", "total"}


@record
class Met:
    """A formula that is a quantity of a theory."""

    quantity: str
    sign: int  #: -1 where the text counts it the other way [-]


@dataclass
class Match:
    """A theory with the reading of the text's letters under which it fits."""

    theory: Theory
    values: dict[str, np.ndarray]
    kinds: dict[str, tuple[object, ...] | None]
    asked: list[str] = field(default_factory=list)  #: Quantities that a formula may be
    table: np.ndarray = field(default_factory=lambda: np.empty((0, _STATES)))  #: Their values, a row for each
    meant: dict[str, str] = field(default_factory=dict)
    met: dict[tuple[int, int], Met] = field(default_factory=dict)  #: By place of the equation and its side
    strong: set[int] = field(default_factory=set)  #: Equations that can hardly agree by chance

    def of_kind(self, kind: tuple[object, ...] | None) -> list[str]:
        """Names of the theory that have a unit, all where it is not known."""
        outer = [n for n in self.values if n != "pi" and not _INNER.match(n)]
        return [n for n in outer if kind is None or self.kinds.get(n) in (None, kind[:4])]


@cache
def _states(theory_name: str) -> "Match":
    theory = named(theory_name)
    rng = np.random.default_rng(3)
    values: dict[str, np.ndarray] = {"pi": np.full(_STATES, np.pi)}
    for letter, about in theory.letters.items():
        sign = 1.0 if about.positive else rng.choice((-1.0, 1.0), _STATES)
        values[letter] = (about.value or 1.0) * rng.uniform(0.7, 1.4, _STATES) * sign
        if about.domain:
            values[letter] = rng.uniform(*about.domain, _STATES)
        if letter == theory.angle:
            values[letter] = rng.uniform(-6, 6, _STATES)
    with np.errstate(all="ignore"):
        for wish in [*theory.results, *theory.tape, *_rates(theory)]:
            try:
                if wish in theory.tape:
                    complete(theory, values, [wish], FLOATS)
            except (BadInput, ValueError, TypeError, RecursionError, KeyError):
                values.pop(wish, None)
    values = {n: v for n, v in values.items() if np.shape(v) == (_STATES,)}
    kinds = {n: _kind(theory, n) for n in values}
    asked = [q for q in (*theory.results, *_rates(theory)) if q in values and not _INNER.match(q)]
    return Match(theory=theory, values=values, kinds=kinds, asked=asked, table=np.array([values[q] for q in asked]))


def _rates(theory: Theory) -> list[str]:
    # of what moves: travel, and the angles of links
    moving = [q for q in theory.results if q in ("x", "s", "beta", "psi", "x0")]
    return [f"{q}_{d}" for q in moving for d in ("d", "dd")] if theory.angle else []


def _kind(theory: Theory, letter: str) -> tuple[object, ...] | None:
    try:
        kind = kind_of(theory, name(letter))
    except (BadInput, RecursionError):
        return None
    return None if kind is None else tuple(kind[:4])


def fits(world: World) -> list[Match]:
    """The theories that fit a text, those that say most of it first."""
    sides = list(_sides(world))
    used = {n.replace("_", "") for *_, tree in sides for n in letters(tree)}
    matches = []
    for theory_name in names() if sides else ():
        if _UNFIT.search(theory_name) or not _alike(theory_name, used, world.angle):
            continue
        fit = replace(_states(theory_name), meant={}, met={}, strong=set())
        for order, side, tree in sides:
            _meet(fit, world, order, side, tree)
        matches.append(fit)
    prose = world.paper.prose.lower()
    strange = {f.theory.name: sum(w not in prose for w in f.theory.name.split("_")) for f in matches}
    kept: list[Match] = []
    for fit in sorted(matches, key=lambda f: (strange[f.theory.name], -len(f.strong), len(f.theory.name))):
        # what says nothing new fits by chance
        if len(fit.strong - {o for f in kept for o in f.strong}) > 1:
            kept.append(fit)
    return kept


def _alike(theory_name: str, used: set[str], angle: str) -> bool:
    theory = named(theory_name)
    own = {n.replace("_", "") for n in (*theory.letters, *theory.results)}
    return sum(n in own or _SAME.get(n, "") in own for n in used) + bool(angle and theory.angle) > 2


def _sides(world: World) -> Iterator[tuple[int, int, Node]]:
    for order, said in enumerate(world.paper.said):
        for k, side in enumerate(said.sides):
            if k and not said.inline:
                yield order, k, world.plain(side)


def _by_name(fit: Match, world: World, letter: str) -> str:
    theory = fit.theory
    if world.angle and letter.startswith(world.angle) and theory.angle:
        rest = letter[len(world.angle) :]
        if rest in ("", "d", "dd") and theory.angle + rest in fit.values:
            return theory.angle + rest
    for wanted in (letter, _SAME.get(letter, letter)):
        for known in fit.values:
            if known.replace("_", "") == wanted.replace("_", "") and _one_kind(fit, world.kinds, letter, known):
                return known
    return ""


def _one_kind(fit: Match, kinds: Kinds, letter: str, known: str) -> bool:
    mine, its = kinds.of(letter), fit.kinds.get(known)
    if letter in kinds.turns and known in fit.theory.letters:
        return False  # theories count turns in a second
    return mine is None or its is None or tuple(mine[:4]) == its


def _meet(fit: Match, world: World, order: int, side: int, tree: Node) -> None:
    used = [n for n in letters(tree) if n != "pi"]
    heavy = sum(isinstance(n, (ast.BinOp, ast.Call)) for _, n in walk(tree))
    if not used or heavy < 1 or len(used) > 9:
        return
    said = world.paper.said[order]
    left = said.sides[0].id if isinstance(said.sides[0], ast.Name) else ""
    turning = any(isinstance(n, ast.Call) for _, n in walk(tree))
    strong = len(used) > 1 and heavy > 2 and (turning or len(used) > 3)
    choices = [_choices(fit, world, letter, strong) for letter in used]
    if not all(choices) or not any(letter in fit.meant or _by_name(fit, world, letter) for letter in used):
        return  # letters of which none is the theory's may be anything of their units
    every = [r for r in islice(product(*choices), _READINGS) if len(set(r)) == len(r)]
    for reading, value in zip(every, _values(fit, tree, used, every), strict=True):
        meant = dict(zip(used, reading, strict=True))
        quantity, sign = _quantity(fit, world, value, meant, left)
        if not quantity:
            continue
        fit.meant |= meant
        if left and sign > 0:
            fit.meant.setdefault(left, quantity)
        fit.met[order, side] = Met(quantity=quantity, sign=sign)
        if strong:
            fit.strong.add(order)
        return


def _values(fit: Match, tree: Node, used: Sequence[str], every: Sequence[tuple[str, ...]]) -> np.ndarray:
    """Values of a tree at the states, a row for each reading of its letters; nan where it has none."""
    meanings = zip(*every, strict=True) if every else [()] * len(used)
    at = {k: np.ravel([fit.values[m] for m in meant]) for k, meant in zip(used, meanings, strict=True)}
    at["pi"] = np.full(len(every) * _STATES, np.pi)
    with np.errstate(all="ignore"):
        try:
            value = np.asarray(evaluate(tree, at, FLOATS), dtype=float)
        except (KeyError, ValueError, TypeError):
            value = np.full(1, np.nan)
    if value.size != len(every) * _STATES:
        value = np.full(len(every) * _STATES, np.nan)
    return value.reshape(len(every), _STATES)


def _choices(fit: Match, world: World, letter: str, strong: bool) -> list[str]:
    if letter in fit.meant:
        return [fit.meant[letter]]
    if by_name := _by_name(fit, world, letter):
        kind = world.kinds.of(letter)
        # an F may be the force of the gas, or all of it
        return [
            by_name,
            *(n for n in fit.of_kind(kind) if n != by_name and kind is not None and n in fit.theory.results),
        ][:10]
    kind = world.kinds.of(letter)
    if not strong:
        return []  # a product of three letters is one of many things
    every = [n for n in fit.of_kind(kind) if kind is not None or n in fit.theory.letters or n in fit.theory.results]
    every = [n for n in every if not are_both_heats(letter, n)]
    return [n for n in every if n in fit.theory.letters or not _is_called_otherwise(n, world.phrase(letter))][:24]


def _is_called_otherwise(quantity: str, about: str) -> bool:
    # the gas force is no normal force
    words = quantity.split("_")
    plain = {w for w in words if len(w) > 3} - _SPARE
    return len(words) > 1 and bool(plain) and bool(_FORCE.search(about)) and not any(w in about for w in plain)


def _quantity(fit: Match, world: World, value: np.ndarray, reading: Mapping[str, str], left: str) -> tuple[str, int]:
    if not np.all(np.isfinite(value)) or np.ptp(value) == 0:
        return "", 0
    kind = world.kinds.of(left) if left else None
    wanted = fit.meant.get(left, "")
    others = {*reading.values(), *(q for letter, q in fit.meant.items() if left and letter != left)}
    for sign in (1, -1):
        close = np.all(np.abs(value - sign * fit.table) <= _CLOSE * (np.abs(fit.table) + 1e-300), axis=1)
        for quantity in (fit.asked[i] for i in np.flatnonzero(close)):
            same_kind = kind is None or fit.kinds.get(quantity) in (None, tuple(kind[:4]))
            # two letters of a text are two quantities: a second one with this formula may be a slip
            if same_kind and quantity not in others and wanted in ("", quantity):
                return quantity, sign
    return "", 0


def readings(fit: Match, world: World, used: Sequence[str]) -> list[dict[str, str]]:
    """What the letters of a formula mean in a theory: as other formulas have shown, or as they are called."""
    by_name = {n: _by_name(fit, world, n) for n in used}
    both = ({n: fit.meant.get(n) or by_name[n] for n in used}, {n: by_name[n] or fit.meant.get(n, "") for n in used})
    return [r for i, r in enumerate(both) if all(r.values()) and (not i or r != both[0])]


def candidates(fit: Match, said: Said, world: World) -> Sequence[str]:
    """Quantities that a text's words call what an equation gives, of the right unit, that no other formula is."""
    left = said.sides[0].id if isinstance(said.sides[0], ast.Name) else ""
    if not left:
        return []
    if left in fit.meant:
        return [fit.meant[left]]
    stem = left.rstrip("d")  # the acceleration of what the theory knows
    rate = fit.meant.get(stem, "") + left.removeprefix(stem)
    if stem in world.dotted and rate in fit.theory.results:
        return [rate]
    about = world.paper.named.get(left)
    around = f"{said.before} {about.meaning if about else ''}".lower()
    taken, kind = set(fit.meant.values()), world.kinds.of(left)
    chosen = []
    for quantity in fit.theory.results:
        words = set(re.findall(r"[a-z]{4,}", quantity.lower())) - _SPARE
        fits_kind = kind is None or fit.kinds.get(quantity) in (None, tuple(kind[:4]))
        if words and quantity not in taken and fits_kind and all(w in around for w in words):
            chosen.append(quantity)
    return chosen[:3]

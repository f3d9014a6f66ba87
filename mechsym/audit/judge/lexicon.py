"""Which theory a program's names fit: letters by names, comments and units, quantities by what they are called."""

import ast
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from itertools import islice, product

import numpy as np

from mechsym.audit.judge.dimensions import ANGLE, kind_of, kind_of_unit
from mechsym.audit.judge.question import Question, drawn, float_values, used_names
from mechsym.audit.read import tree as trees
from mechsym.audit.read.algebra import FLOATS, Values, evaluate
from mechsym.audit.read.programs.claims import Claim, base, inlined
from mechsym.audit.read.programs.statements import OF
from mechsym.audit.read.reader import RESERVED, Formula, read_expression
from mechsym.audit.read.tree import Node, letters
from mechsym.audit.theory.record import Theory, complete, dependencies, known
from mechsym.audit.theory.tape import needed
from mechsym.errors import BadInput
from mechsym.quantities import record

# what the angle that turns, and its rates, are called in programs
ANGLES = ("theta", "phi", "th", "theta deg", "crank angle", "ca", "cad", "crankangle", "angle", "varphi")
_RATES = {"d": ("omega", "w", "angular velocity", "angular speed"), "dd": ("alpha", "angular acceleration")}
_LEAST_LETTERS = 3  # of a formula that is told by its numbers and not by its name
_MEANINGS, _TRIED, _READINGS = 3, 200, 4  # of a letter; of a formula at most: looked at, and held against numbers
_POINTS, _TURNS, _STEPS = 24, 4, 7  # states at which numbers are compared, and of turns
_SAME = 1e-9
# factors by which units differ: degrees, minutes, inches and feet, thousands
_SCALES = (1.0, np.pi / 180, 60.0, 2 * np.pi, np.pi / 30, 12.0, 25.4, 0.3048, 25.4**2, 25.4**3)
_UNITS = tuple(
    sign * 10.0**n * scale**power
    for n in (-9, -6, -3, -2, -1, 0, 1, 2, 3, 5, 6, 9)
    for scale in _SCALES
    for power in (1, -1)
    for sign in (1.0, -1.0)
)


@record
class Fitted:
    """A claim in the letters of a theory."""

    theory: Theory
    claim: Claim
    tree: Node  #: In the program's letters that have a meaning, other names put in
    meanings: Mapping[str, str]  #: Letter of the program to its meaning in the theory
    quantities: Sequence[str]  #: That the name is called like
    spare: Mapping[str, str]  #: Other letters of its function that have one meaning, which no letter of it has
    strong: int  #: Letters that a word tells, and not a single sign
    rank: int  #: How well its name tells the quantities, as of `Lexicon.meanings`


def words(text: str) -> tuple[str, ...]:
    """The words of a name or a comment: 'crankRad_1' is crank, rad, 1; a single letter keeps its case."""
    parts = re.findall(r"[A-Za-z]+|\d+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text))
    return tuple(p if len(p) == 1 else p.lower() for p in parts)


@lru_cache(maxsize=20_000)
def _word_list(text: str) -> tuple[str, ...]:
    return words(text)


def _joined(said: Sequence[str]) -> str:
    # V_d and Vd alike, and a single letter as it is
    whole = "".join(said)
    return whole.lower() if len(whole) > 1 else whole


class Lexicon:
    """What the letters and quantities of a theory are called."""

    def __init__(self, theory: Theory) -> None:
        self.theory = theory
        self.phrases: list[tuple[tuple[str, ...], str]] = []
        for name in [*theory.letters, *theory.results]:
            self.phrases.append((words(name), name))
        for meaning, said in theory.words.items():
            self.phrases += [(words(one), meaning) for one in said]
        if theory.angle:
            self.phrases += [(words(one), theory.angle) for one in ANGLES]
            for dots, said in _RATES.items():
                self.phrases += [(words(one), theory.angle + dots) for one in said]
        self.heads = {_joined(phrase) for phrase, _ in self.phrases}
        self.parts = {word for phrase, _ in self.phrases for word in phrase if len(word) > 2}
        self.known: dict[tuple[str, str], list[tuple[int, str]]] = {}
        self._states: dict[tuple[str, ...], Probes] = {}

    def states(self, form: Formula) -> "Probes":
        """Where the numbers of a formula are compared: what it does not have, and may be none, is none."""
        rest = at_rest(self.theory, form)
        if rest not in self._states:
            self._states[rest] = Probes(self.theory, rest)
        return self._states[rest]

    def touches(self, names: Iterable[str]) -> bool:
        """Whether two names at least may mean something here."""
        alike = 0
        for name in names:
            own = _word_list(name)
            tail = _joined(_word_list(name.rpartition(OF)[2]))
            alike += tail in self.heads or _joined(own) in self.heads or not self.parts.isdisjoint(own)
        return alike > 1

    def meanings(self, name: str, about: str) -> list[tuple[int, str]]:
        """What a name may mean, with how well it is told: 4 by a comment, 3 by words, 2 by a part, 1 by one sign."""
        if (name, about) not in self.known:
            self.known[name, about] = self._meanings(name, about)
        return self.known[name, about]

    def _meanings(self, name: str, about: str) -> list[tuple[int, str]]:
        own, said = _word_list(name), _word_list(_UNIT.sub(" ", about))
        tail = _word_list(name.rpartition(OF)[2])
        counts: dict[str, int] = {}
        for phrase, meaning in self.phrases:
            rank, whole = 0, _joined(phrase)
            if whole in (_joined(own), _joined(tail)):
                rank = 1 if whole in _GREEK else min(len(whole), 3)
            elif len(whole) > 3 and (own[-len(phrase) :] == phrase or own[: len(phrase)] == phrase):
                rest = own[: -len(phrase)] if own[-len(phrase) :] == phrase else own[len(phrase) :]
                rank = 2 if all(w in _QUALIFIERS for w in rest) else 0
            if len(phrase) > 1 and len(whole) > 4 and _stands_in(phrase, said):
                rank = max(rank, 4)
            if rank > counts.get(meaning, 0):
                counts[meaning] = rank
        if slope := self._slope(name.rpartition(OF)[2]):
            counts[slope] = 3
        return sorted(((r, m) for m, r in counts.items()), reverse=True)

    def _slope(self, name: str) -> str:
        # dV_dtheta: the slope of what V is, by the angle
        match, angle = _DERIVATIVE.fullmatch(name), self.theory.angle
        if not angle or not match or match["by"] not in (angle, *ANGLES):
            return ""
        return next((f"d{m}_d{angle}" for _, m in self.meanings(match["of"], "") if m in self.theory.results), "")

    def meaning(self, name: str, about: str) -> tuple[int, str]:
        """The one thing that a name means; empty where it means none or several alike."""
        ranked = self.meanings(name, about)
        several = len(ranked) > 1 and ranked[0][0] == ranked[1][0]
        return ranked[0] if ranked and not several else (0, "")


_DERIVATIVE = re.compile(r"d_?(?P<of>\w+?)_?d_?(?P<by>[A-Za-z]+)")
# (rad/sec) says nothing of a crank rad: what stands in brackets and has short words only
_UNIT = re.compile(r"[\[(](?:[^\[\]()A-Za-z]|(?<![A-Za-z])[A-Za-z]{1,4}(?![A-Za-z]))*[\])]")
# a sign spelled out is no word
_GREEK = set("alpha beta gamma delta theta phi varphi psi omega lambda lam rho mu nu sigma tau epsilon eta".split())
# what stands beside a name without changing what it is
_QUALIFIERS = set(
    "m c i M C 0 1 2 rad deg cyl engine geom mm cm in inst piston get calc compute calculate formula".split()
)


def _stands_in(phrase: tuple[str, ...], said: tuple[str, ...]) -> bool:
    n = len(phrase)
    return any(said[i : i + n] == phrase for i in range(min(6, len(said) - n + 1)))


def readings(claim: Claim, vocabulary: Lexicon) -> Iterator[Fitted]:
    """A claim in a theory's letters, the best told way first; none where a name in it means nothing there."""
    theory = vocabulary.theory
    rank, called = _called(claim, vocabulary)
    tree, options = _of_either_sign(claim.tree), dict[str, list[tuple[int, str]]]()
    for _ in range(12):
        put_in = {}
        for letter in letters(tree):
            if letter in options or letter == "pi":
                continue
            ranked = [
                (r, m)
                for r, m in vocabulary.meanings(base(letter), claim.abouts.get(base(letter), ""))
                if base(m) not in called
            ]
            unsure = not ranked or len(ranked) > 1 and ranked[0][0] == ranked[1][0]
            told = ranked[0][0] if ranked else 0
            if letter in claim.values and (unsure or _is_told_better(letter, told, claim, vocabulary)):
                put_in[letter] = claim.values[letter]
            elif ranked:
                options[letter] = ranked[:_MEANINGS]
            else:
                return
        if not put_in:
            break
        whole = inlined(tree, put_in, keep={k: 1 for k in claim.values if k not in put_in})
        if whole is None:
            return
        tree = whole
    used = [k for k in letters(tree) if k != "pi"]
    if not used or any(k not in options for k in used):
        return
    for reading in _distinct([options[k] for k in used]):
        meanings = {k: _in_degrees(k, m, tree, theory) for k, (_, m) in zip(used, reading, strict=True)}
        strong = sum(r > 1 for r, _ in reading)
        quantities = called if rank else ()
        yield Fitted(
            theory=theory,
            claim=claim,
            tree=tree,
            meanings=meanings,
            quantities=quantities,
            spare=_spare(claim, meanings, vocabulary),
            strong=strong,
            rank=rank,
        )


def _spare(claim: Claim, meanings: Mapping[str, str], vocabulary: Lexicon) -> dict[str, str]:
    told = {p: vocabulary.meaning(p, claim.abouts.get(p, ""))[1] for p in claim.parameters if p not in meanings}
    counts = Counter([*told.values(), *meanings.values()])
    return {p: m for p, m in told.items() if m.isidentifier() and counts[m] == 1}


def _distinct(options: Sequence[Sequence[tuple[int, str]]]) -> Iterator[tuple[tuple[int, str], ...]]:
    # no two letters mean one thing; those that words tell best, and ties between them
    best = [o[0][0] for o in options]
    chosen = (c for c in islice(product(*options), _TRIED) if len({m for _, m in c}) == len(c))
    ranked = sorted(chosen, key=lambda c: -sum(r for r, _ in c))
    if ranked:
        least = sum(r for r, _ in ranked[0])
        plain = least == sum(best)
        yield from islice((c for c in ranked if not plain or sum(r for r, _ in c) == least), _READINGS)


def _is_told_better(letter: str, told: int, claim: Claim, vocabulary: Lexicon) -> bool:
    # phi = radians(pressure_angle): another letter in its place, whose name says more
    inside = letters(claim.values[letter])
    named = [k for k in inside if k != "pi"]
    return len(named) == 1 and vocabulary.meaning(base(named[0]), claim.abouts.get(base(named[0]), ""))[0] > told


def _of_either_sign(tree: Node) -> Node:
    # the size of a quantity is the quantity, as signs are not told
    while isinstance(tree, ast.Call) and isinstance(tree.func, ast.Name) and tree.func.id == "abs":
        tree = tree.args[0]
    return tree


def _called(claim: Claim, vocabulary: Lexicon) -> tuple[int, list[str]]:
    # quantities that the name or the comment of a claim says, or the function that gives it back
    names = [claim.scope] if claim.name == "return" else [claim.name, *[claim.scope] * claim.last]
    best, called = 0, dict[str, None]()
    for name in names:
        ranked = [(r, m) for r, m in vocabulary.meanings(name, claim.about) if m in vocabulary.theory.tape]
        called |= dict.fromkeys(m for r, m in ranked if r == ranked[0][0])
        best = max(best, ranked[0][0] if ranked else 0)
    return best, list(called)


def _in_degrees(letter: str, meaning: str, tree: Node, theory: Theory) -> str:
    # theta*pi/180 says that theta counts degrees
    if meaning not in theory.letters or theory.letters[meaning].unit != "rad":
        return meaning
    for _, node in trees.walk(tree):
        if isinstance(node, ast.BinOp) and letters(node) and set(letters(node)) <= {letter, "pi"}:
            numbers = [trees.value_of(n) for _, n in trees.walk(node) if isinstance(n, ast.Constant)]
            if letter in letters(node) and 180 in numbers:
                return f"{meaning}*180/pi"
    return meaning


def formula(fitted: Fitted) -> Formula:
    """A fit as the auditor's formula. Raises BadInput."""
    theory = fitted.theory
    renamed = {k: safe(k) for k in letters(fitted.tree) if k != "pi"}
    tree = trees.substitute(
        fitted.tree, lambda n: trees.name(renamed.get(n.id, n.id)) if isinstance(n, ast.Name) else None
    )
    trees.check(tree)
    own = {renamed[k]: read_expression(v, [*known(theory), "pi"], theory.tape)[0] for k, v in fitted.meanings.items()}
    return Formula(tree=tree, letters=own)


def safe(letter: str) -> str:
    """A program's name as a letter that a formula may hold."""
    plain = letter.replace("__v", "_").replace("__w", "_").replace(OF, "_").strip("_") or "x"
    return f"{plain}_own" if plain in RESERVED or plain in ("lambda", "in", "is", "if", "as", "or") else plain


def at_rest(theory: Theory, form: Formula) -> tuple[str, ...]:
    """Letters that a formula does not have and that are 0 in many machines: an offset, the angular acceleration."""
    used = {m for tree in form.letters.values() for m in letters(tree)}
    offsets = [k for k, about in theory.letters.items() if about.unit == "m" and about.sign == "any"]
    rates = [f"{theory.angle}dd"] if theory.angle and f"{theory.angle}d" in used else []
    return tuple(k for k in (*offsets, *rates) if k not in used)


def of_same_letters(theory: Theory, form: Formula, quantity: str) -> bool:
    """Whether a formula has the letters that a quantity is made of, or names made of them, and no other."""
    used = {m for tree in form.letters.values() for m in letters(tree)} - {"pi"}
    reached: set[str] = set()
    waiting = [quantity]
    while waiting:
        wish = waiting.pop()
        if wish not in reached and (wish not in used or wish == quantity):
            reached.add(wish)
            waiting += needed(theory.tape[wish]) if wish in theory.tape else []
    lacking = reached & theory.letters.keys() - used - {*at_rest(theory, form)}
    return not lacking and used <= dependencies(theory, [quantity])


@record
class Nearness:
    """Numbers of a formula beside those of a quantity, at random states."""

    away: float  #: Largest difference by the quantity's largest size [-]
    ratio: float | None  #: Where the formula is the quantity times one number [-]
    shift: bool  #: Whether it is the quantity, of either sign, but for what does not turn


class Probes:
    """Random states of a theory, and turns of its angle from four of them, with the values of its names as needed."""

    def __init__(self, theory: Theory, rest: Sequence[str] = ()) -> None:
        self.theory = theory
        question = Question(formula=Formula(tree=trees.number(1)), theory=theory, quantity=theory.results[-1])
        draws = float_values(drawn(question, _POINTS, seed=5))
        self.random: dict[str, Values] = {"pi": np.pi, **draws}
        few = float_values(drawn(question, _TURNS, seed=6))
        turned = {k: np.repeat(v, _STEPS) for k, v in few.items()}
        if theory.angle:
            turned[theory.angle] = np.tile(np.linspace(0.3, 5.9, _STEPS), _TURNS)
        for letter in rest:
            self.random[letter], turned[letter] = np.zeros(_POINTS), np.zeros(_TURNS * _STEPS)
        self.turned: dict[str, Values] = {"pi": np.pi, **turned}

    def values(self, at: dict[str, Values], form: Formula, quantity: str) -> tuple[np.ndarray, np.ndarray]:
        """Numbers of a formula and of a quantity at states [unit of each]. Raises BadInput and ArithmeticError."""
        with np.errstate(all="ignore"):
            complete(self.theory, at, [quantity], FLOATS)
        return self.of(form, at), _as_row(at[quantity], at)

    def of(self, form: Formula, at: dict[str, Values] | None = None) -> np.ndarray:
        """Numbers of a formula at states, those drawn where none are given [its unit]. Raises as `values`."""
        at = self.random if at is None else at
        with np.errstate(all="ignore"):
            complete(self.theory, at, used_names(form), FLOATS)
            own = {k: evaluate(tree, at, FLOATS) for k, tree in form.letters.items()}
            return _as_row(evaluate(form.tree, {**at, **own}, FLOATS), at)


def _as_row(values: Values, at: dict[str, Values]) -> np.ndarray:
    count = len(next(v for k, v in at.items() if k != "pi"))
    return np.broadcast_to(np.asarray(values, dtype=float), (count,))


def compared(form: Formula, states: Probes, quantity: str) -> Nearness | None:
    """A formula's numbers beside a quantity's; None where there are none."""
    try:
        printed, expected = states.values(states.random, form, quantity)
        turns = states.values(states.turned, form, quantity) if states.theory.angle else None
    except (BadInput, ArithmeticError, ValueError, KeyError, RecursionError):
        return None
    good = np.isfinite(expected) & np.isfinite(printed)
    if np.count_nonzero(good) < _POINTS // 2 or not np.any(expected[good]):
        return None
    p, e = printed[good], expected[good]
    with np.errstate(all="ignore"):
        ratios = p / e
    middle = float(np.median(ratios))
    constant = bool(np.all(np.abs(ratios - middle) <= _SAME * abs(middle))) and middle != 0
    away = min(float(np.max(np.abs(p - e))), float(np.max(np.abs(p + e)))) / float(np.max(np.abs(e)))
    return Nearness(
        away=away,
        ratio=middle if constant else None,
        shift=turns is not None and _shifted(*turns) and _is_place(states.theory, quantity),
    )


def _is_place(theory: Theory, quantity: str) -> bool:
    # what may be counted from another place
    return kind_of(theory, trees.name(quantity)) in (ANGLE, kind_of_unit("m"), kind_of_unit("m^3"))


def _shifted(printed: np.ndarray, expected: np.ndarray) -> bool:
    # counted from another place: the difference does not change with the angle
    if not np.all(np.isfinite(printed)) or not np.all(np.isfinite(expected)):
        return False
    moves = np.ptp(expected.reshape(_TURNS, _STEPS), axis=1)
    rests = [np.ptp((printed - sign * expected).reshape(_TURNS, _STEPS), axis=1) for sign in (1, -1)]
    return bool(np.all(moves > 0)) and any(bool(np.all(rest <= _SAME * moves)) for rest in rests)


@record
class Near:
    """A formula beside a quantity of a theory that it may be."""

    away: float  #: Largest difference by the quantity's largest size; 0 where it is the quantity [-]
    fitted: Fitted
    form: Formula
    quantity: str  #: Empty where it is near to none
    states: Probes


_SLIPS = tuple(k**power for k in (2.0, 3.0, 4.0, np.pi, 2 * np.pi) for power in (1, -1, 0.5, -0.5))


def is_slip(ratio: float | None) -> bool:
    """Whether a ratio [-] is one that is lost or taken twice; another one is somebody's own number."""
    return ratio is None or any(abs(abs(ratio) / k - 1) < 1e-5 for k in _SLIPS)


def of_units(ratio: float | None) -> bool:
    """Whether a ratio of numbers [-] is one of units, or of sign alone."""
    return ratio is not None and any(abs(ratio / u - 1) < 1e-5 for u in _UNITS)


def nearest(fitted: Fitted, form: Formula, states: Probes) -> Iterator[tuple[float, str]]:
    """Quantities whose numbers a formula comes near to, the nearest first, with how far it is off [-]."""
    theory = fitted.theory
    used = {m for t in form.letters.values() for m in letters(t)}
    near = []
    for quantity in theory.results:
        needed = dependencies(theory, [quantity])
        if quantity in used or not used & needed or isinstance(theory.tape[quantity], tuple):
            continue
        if (met := compared(form, states, quantity)) is not None:
            near.append((0.0 if of_units(met.ratio) or met.shift else met.away, quantity))
    yield from sorted(near)

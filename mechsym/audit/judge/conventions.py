"""What sources take for granted: constant speed, a rod without mass; where the angle starts, which way is positive."""

import ast
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from mechsym.audit.judge.dimensions import ANGLE, NUMBER, Kind, kind_of, kind_of_letter, kind_of_unit
from mechsym.audit.judge.prover import POINTS, Judges, agreement, judges
from mechsym.audit.judge.question import Question, bench, names, peak, shaped, used_names, value
from mechsym.audit.read.algebra import FLOATS, Values, evaluate
from mechsym.audit.read.reader import read_expression
from mechsym.audit.read.tree import Node, letters, name, substitute
from mechsym.audit.theory.record import Theory, dependencies
from mechsym.audit.theory.tape import retaped
from mechsym.errors import BadInput
from mechsym.quantities import record


@record
class Condition:
    """Letters that vanish, in words."""

    words: str
    letters: tuple[str, ...]

    @property
    def told(self) -> str:
        """The words with the letters."""
        return f"{self.words} ({', '.join(f'{k} = 0' for k in self.letters)})"


def conditions(question: Question, written: bool = False) -> Iterator[Condition]:
    """Conditions under which the quantity loses letters that the formula does not have.

    `written`: only letters that stand in the formula count, and not those of a derived name: in a/omega^2 for the
    second slope, a is the acceleration at constant speed.
    """
    theory = question.theory
    used = set(used_names(question.formula))
    used = used if written else dependencies(theory, used)
    asked = [question.quantity, *used] if written else [question.quantity]
    needed = dependencies(theory, asked) - set(question.hold)
    fitting = []
    for words, vanishing in taken_for_granted(theory).items():
        lost = tuple(k for k in vanishing if k in needed)
        if lost and not used & set(lost):
            fitting.append(Condition(words=words, letters=lost))
    yield from fitting
    if len(fitting) > 1:
        yield Condition(words=" and ".join(c.words for c in fitting), letters=sum((c.letters for c in fitting), ()))


def taken_for_granted(theory: Theory) -> dict[str, tuple[str, ...]]:
    """Conditions of a theory: words to the letters that vanish."""
    speeds = tuple(k for k, letter in theory.letters.items() if letter.unit == "rad/s^2")
    return ({"constant speed": speeds} if speeds else {}) | dict(theory.conditions)


def under(question: Question, condition: Condition) -> Question:
    """The same question where a condition holds."""
    return replace(question, hold={**question.hold, **dict.fromkeys(condition.letters, 0.0)})


RATIO = "the ratio the other way round"  #: Told of a convention
_TOLD = {
    "bottom": "the angle from bottom dead centre",
    "reversed": "the angle the other way round",
    "quadrature": "the angle from the perpendicular, pi/2 - angle",
    "sign": "the quantity reversed",
    "inverse": RATIO,
    "double": "twice the quantity, as a diameter for a radius",
    "half": "half of the quantity, as a radius for a diameter",
    "turns": "in turns where the quantity is in radians",
    "radians": "in radians where the quantity is in turns",
    "rate": "per radian where the quantity is per second",
    "degrees": "the angle in degrees",
    "rpm": "the speed in revolutions per minute",
}
# what the author's quantity is in the theory's, @
_OWN_WAY = {"sign": "-(@)", "inverse": "1/(@)", "double": "2*(@)", "half": "(@)/2", "turns": "(@)/(2*pi)",
            "radians": "2*pi*(@)"}  # fmt: skip
_ANGLES = ("bottom", "reversed", "quadrature")


def checked(text: str) -> tuple[str, ...]:
    """Conventions by name, refused where there is no such one."""
    chosen = tuple(filter(None, (p.strip() for p in text.replace(";", ",").split(","))))
    unknown = [c for c in chosen if c not in (*_TOLD, "show")]
    if unknown:
        there = ", ".join(f"{k} ({v})" for k, v in _TOLD.items())
        raise BadInput(f"--convention {unknown[0]!r} is not known; there are show, {there}")
    return chosen


def told(chosen: Iterable[str]) -> str:
    """Conventions in words."""
    return " and ".join(_TOLD[c] for c in chosen)


def converted(question: Question, chosen: Iterable[str]) -> Question:
    """The question in the author's conventions: his letters mean the theory's, and so does his quantity."""
    theory, formula = question.theory, question.formula
    angle, quantity, own = theory.angle, question.quantity, dict(formula.letters)
    for convention in chosen:
        if convention in (*_OWN_WAY, "rate"):
            speed = name(f"{theory.angle}d")
            if convention == "rate" and speed.id not in theory.letters:
                raise BadInput(f"--convention rate: {theory.name} has no speed")
            way = _OWN_WAY.get(convention, f"@*{speed.id}").replace("@", quantity)
            own_way = read_expression(way, [quantity, speed.id, "pi"])[0]
            quantity = f"{quantity}_{convention}"
            tape = retaped(theory.tape, {quantity: own_way}, theory.letters, theory.angle)
            theory = replace(theory, tape=tape)
            continue
        rates = [f"{angle}d", f"{angle}dd"]
        texts = {
            "bottom": {angle: f"{angle} + pi"},
            "reversed": {k: f"-{k}" for k in (angle, *rates)},
            "quadrature": {angle: f"pi/2 - {angle}"} | {k: f"-{k}" for k in rates},
            "degrees": {angle: f"{angle}*180/pi"},
            "rpm": {rates[0]: f"{rates[0]}*30/pi"},
        }[convention]
        shift = {k: read_expression(text, [angle, *rates, "pi"])[0] for k, text in texts.items()}
        if not angle or any(k not in theory.letters and k != "pi" for t in shift.values() for k in letters(t)):
            raise BadInput(f"--convention {convention}: {theory.name} has no angle and speed for it")
        own = shift | {k: substitute(tree, partial(_shifted, shift)) for k, tree in own.items()}
    return replace(question, theory=theory, quantity=quantity, formula=replace(formula, letters=own))


def _shifted(shift: Mapping[str, Node], node: Node) -> Node | None:
    return shift.get(node.id) if isinstance(node, ast.Name) else None


def also_exact(question: Question, from_top: bool = False) -> tuple[str, ...]:
    """Under which other conventions a formula would be exact; none where there is none.

    from_top: the author says that the angle counts from the top dead centre.
    """
    if not question.theory.angle or question.theory.angle in question.hold:
        return ()
    for angle in ("", *_ANGLES) if not from_top else ("", "reversed"):
        for sign in ((), ("sign",)):
            chosen = (*((angle,) if angle else ()), *sign)
            if chosen and holds_with(question, chosen):
                return chosen
    return ()


def holds_with(question: Question, chosen: tuple[str, ...]) -> bool:
    """Whether a formula is exact under conventions."""
    try:
        other = converted(question, chosen)
    except BadInput:
        return False
    judged = judges(other)
    with np.errstate(all="ignore"):
        printed, expected = value(judged.quick, other.formula.tree), judged.quick.expected
        close = np.abs(printed - expected) <= 1e-8 * peak(expected)
    return bool(np.all(close)) and agreement(judged, other.formula.tree).exact


# by kind of a letter or a quantity: by what the author's is more than the theory's, and in which words
_FACTORS: dict[Kind, dict[str, float]] = {
    kind_of_unit("m"): {"twice it, as a diameter for a radius": 2.0, "half of it, as a radius for a diameter": 0.5},
    kind_of_unit("Pa"): {"twice it, as 2E for E": 2.0, "half of it, as E/2 for E": 0.5},
    kind_of_unit("1/s"): {
        "turns per second": 0.5 / np.pi,
        "turns per minute": 30 / np.pi,
        "radians per second": 2 * np.pi,
        "per minute": 60.0,
    },
    ANGLE: {"degrees": 180 / np.pi},
}
_UNITS = {kind_of_unit("Pa"): {"kPa": 1e-3, "bar": 1e-5, "MPa": 1e-6}, kind_of_unit("m"): {"mm": 1e3}}
_SAME, _TURN = 1e-9, 12
_ROUND, _ELASTIC = "bBdDrR", "eEG"  # what radii and diameters, what moduli are called


def reading(judged: Judges, tree: Node) -> str:
    """A convention under which a formula is right that its author may well have meant, in words; empty without one.

    The whole reversed, turned over, doubled or halved, in turns or degrees, from another origin; or one letter so.
    """
    asked, kind = judged.quick, kind_of(judged.question.theory, name(judged.question.quantity))
    known = names(asked, letters(tree))
    with np.errstate(all="ignore"):
        printed, expected = value(asked, tree), np.asarray(asked.expected, dtype=float)
        for words, other in _others(kind, expected, judged.question.quantity):
            if _agree(printed, other):
                return f"the quantity as {words}"
        if _agree(printed, -expected):
            return "the quantity reversed"
        if shifted := _other_origin(judged, tree):
            return shifted
        for letter in letters(tree):
            own = kind_of_letter(judged.question, letter)
            mapped = letter in judged.question.formula.letters
            if own is None or letter == "pi" or mapped != (own == NUMBER):
                continue  # what was said to be a radius is one; nobody turns an exponent over, but a ratio of letters
            for words, other in _others(own, known.get(letter), letter):
                if _agree(shaped(asked, evaluate(tree, {**known, letter: other}, FLOATS)), expected):
                    return f"{letter} as {words}"
            for unit, factor in _UNITS.get(own, {}).items():
                scaled = shaped(asked, evaluate(tree, {**known, letter: factor * known[letter]}, FLOATS))
                halves = 2 * np.log(np.abs(scaled / printed)) / np.log(factor)
                # in a fit, whose powers are no whole or half ones: elsewhere a thousand too much is a slip
                if _agree(scaled, expected) and np.nanmin(np.abs(halves - np.round(halves))) > _SAME:
                    return f"{letter} as a number of {unit}"
    return ""


def _others(kind: Kind | None, values: Values, called: str) -> Iterator[tuple[str, Values]]:
    if kind == NUMBER:
        yield RATIO, 1 / values
        yield f"{RATIO}, reversed", -1 / values
    round_ones = kind != kind_of_unit("m") or called[0] in _ROUND and "_d" not in called or "radius" in called
    elastic = kind != kind_of_unit("Pa") or called[0] in _ELASTIC
    for words, factor in _FACTORS.get(kind, {}).items() if kind and round_ones and elastic else ():
        yield words, factor * values


def _agree(one: Values, other: Values) -> bool:
    valued = np.isfinite(other)
    close = np.abs(one - other) <= _SAME * np.abs(other)
    return bool(np.sum(valued) > POINTS // 2 and np.all(close | ~valued) and np.any(other != 0))


def _other_origin(judged: Judges, tree: Node) -> str:
    # what is left of formula and quantity, or of formula less quantity, is the same at every angle
    question, theory = judged.question, judged.question.theory
    kind = kind_of(theory, name(question.quantity))
    places = [kind_of_unit(unit) for unit in ("m", "m^3")]
    if not theory.angle or theory.angle in question.hold or kind not in (*places, ANGLE):
        return ""
    states = {k: np.ravel(judged.quick.base[k])[:2] for k in theory.letters}
    turned = {k: np.repeat(v, _TURN) for k, v in states.items()}
    turned[theory.angle] = np.tile(0.1 + np.linspace(0, 2 * np.pi, _TURN, endpoint=False), 2)
    asked = bench(question, turned, FLOATS)
    rows = [np.reshape(np.broadcast_to(v, (2 * _TURN,)), (2, -1)) for v in (value(asked, tree), asked.expected)]
    for sign, words in ((1, "from another origin"), (-1, "from another origin, the other way")):
        left = rows[0] - sign * rows[1]
        moves = np.ptp(rows[1], axis=1)
        if np.all(np.isfinite(left)) and np.all(moves > 0) and np.all(np.ptp(left, axis=1) <= _SAME * moves):
            return f"the quantity {words}"
    return ""

"""What sources take for granted: constant speed, a rod without mass; where the angle starts, which way is positive."""

import ast
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from mechsym.audit.judge.prover import agreement, judges
from mechsym.audit.judge.question import Question, peak, used_names, value
from mechsym.audit.read.reader import read_expression
from mechsym.audit.read.tree import Node, binary, letters, name, negative, substitute
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


_TOLD = {
    "bottom": "the angle from bottom dead centre",
    "reversed": "the angle the other way round",
    "quadrature": "the angle from the perpendicular, pi/2 - angle",
    "sign": "the quantity reversed",
    "rate": "per radian where the quantity is per second",
    "degrees": "the angle in degrees",
    "rpm": "the speed in revolutions per minute",
}
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
        if convention in ("sign", "rate"):
            speed = name(f"{theory.angle}d")
            if convention == "rate" and speed.id not in theory.letters:
                raise BadInput(f"--convention rate: {theory.name} has no speed")
            own_way = negative(name(quantity)) if convention == "sign" else binary(ast.Mult, name(quantity), speed)
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


def also_exact(question: Question) -> str:
    """Under which other conventions a formula would be exact, in words; empty where there is none."""
    if not question.theory.angle or question.theory.angle in question.hold:
        return ""
    for angle in ("", *_ANGLES):
        for sign in ((), ("sign",)):
            chosen = (*((angle,) if angle else ()), *sign)
            if chosen and _holds(question, chosen):
                return told(chosen)
    return ""


def _holds(question: Question, chosen: tuple[str, ...]) -> bool:
    try:
        other = converted(question, chosen)
    except BadInput:
        return False
    judged = judges(other)
    with np.errstate(all="ignore"):
        printed, expected = value(judged.quick, other.formula.tree), judged.quick.expected
        close = np.abs(printed - expected) <= 1e-8 * peak(expected)
    return bool(np.all(close)) and agreement(judged, other.formula.tree).exact

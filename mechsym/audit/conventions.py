"""Conventions of reference: where the angle starts, which way is positive, what is counted in degrees or per second."""

import ast
from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from mechsym.audit.bench import peak, value
from mechsym.audit.prover import agreement, judges
from mechsym.audit.question import Question
from mechsym.audit.reader import read_expression
from mechsym.audit.theory.record import Theory
from mechsym.audit.theory.tape import retaped
from mechsym.audit.tree import Node, letters, name, negative, substitute
from mechsym.errors import BadInput

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
            theory, quantity = _quantity(theory, quantity, convention)
            continue
        shift = _meaning(convention, angle)
        if not angle or any(k not in theory.letters and k != "pi" for t in shift.values() for k in letters(t)):
            raise BadInput(f"--convention {convention}: {theory.name} has no angle and speed for it")
        own = {k: _put(tree, shift) for k, tree in own.items()} | {k: t for k, t in shift.items() if k not in own}
    return replace(question, theory=theory, quantity=quantity, formula=replace(formula, letters=own))


def _meaning(convention: str, angle: str) -> dict[str, Node]:
    rates = [f"{angle}d", f"{angle}dd"]
    texts = {
        "bottom": {angle: f"{angle} + pi"},
        "reversed": {k: f"-{k}" for k in (angle, *rates)},
        "quadrature": {angle: f"pi/2 - {angle}"} | {k: f"-{k}" for k in rates},
        "degrees": {angle: f"{angle}*180/pi"},
        "rpm": {rates[0]: f"{rates[0]}*30/pi"},
    }[convention]
    return {k: read_expression(text, [angle, *rates, "pi"])[0] for k, text in texts.items()}


def _put(tree: Node, shift: Mapping[str, Node]) -> Node:
    return substitute(tree, lambda n: shift.get(n.id) if isinstance(n, ast.Name) else None)


def _quantity(theory: Theory, quantity: str, convention: str) -> tuple[Theory, str]:
    new = f"{quantity}_{convention}"
    speed = name(f"{theory.angle}d")
    tree = negative(name(quantity)) if convention == "sign" else ast.BinOp(name(quantity), ast.Mult(), speed)
    if convention == "rate" and speed.id not in theory.letters:
        raise BadInput(f"--convention rate: {theory.name} has no speed")
    return replace(theory, tape=retaped(theory.tape, {new: tree}, theory.letters, theory.angle)), new


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

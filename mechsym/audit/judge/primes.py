"""Primes and dots of letters that a text defines: derivatives by its angle, or in time."""

import ast
import re

from mechsym.audit.read.slopes import PRIMES, Slope, slope_in
from mechsym.audit.read.tree import Node, name, substitute
from mechsym.audit.theory.record import Theory

PRIMED = re.compile(r"(\w+?)prime(prime)?")


def primed(tree: Node, by: str, theory: Theory) -> Node:
    """One prime or two under the name of a derivative; by: that of the first, with `{}` for the quantity."""
    slope = slope_in(by.format("x"))
    names = {1: by, 2: Slope("{}", slope.by, 2).name if slope else f"{by}d"}

    def changed(node: Node) -> Node | None:
        match = PRIMES.fullmatch(node.id) if isinstance(node, ast.Name) and node.id not in theory.tape else None
        if match is None or match[1] not in theory.results:
            return None
        known = names.get(match[2].count("prime"), "").format(match[1])
        return name(known) if known in theory.tape else None

    return substitute(tree, changed)


def by_angle(tree: Node, theory: Theory) -> Node:
    """One prime and two as slopes by the angle of a theory."""

    def changed(node: Node) -> Node | None:
        known = PRIMED.fullmatch(node.id) if isinstance(node, ast.Name) and node.id not in theory.tape else None
        if known is None or known[1] not in theory.results or not theory.angle:
            return None
        return name(slope_of(known[0], theory.angle))

    return substitute(tree, changed)


def rated(tree: Node, theory: Theory) -> Node:
    """Dots and slopes by time of the text's own letters under the names of the tape."""

    def changed(node: Node) -> Node | None:
        if not isinstance(node, ast.Name) or node.id in theory.tape or node.id in theory.letters:
            return None
        for dots in ("dd", "d"):
            stem = node.id.removesuffix(dots)
            if node.id.endswith(dots) and stem in theory.results and f"{stem}_{dots}" in theory.tape:
                return name(f"{stem}_{dots}")
        rate = slope_in(node.id, "t")
        return name(f"{rate.of}_{'d' * rate.order}") if rate else None

    return substitute(tree, changed)


def slope_of(letter: str, angle: str) -> str:
    """The name of the slope that a letter with one prime or two is."""
    stem, twice = letter.partition("prime")[0], letter.count("prime") > 1
    return Slope(stem, angle, 2 if twice else 1).name


def is_rate(tree: Node) -> bool:
    """Whether a side is a derivative: a fraction, or a letter with primes."""
    return is_slope(tree) or isinstance(tree, ast.Name) and bool(PRIMES.fullmatch(tree.id))


def is_slope(tree: Node) -> bool:
    """Whether a side is a derivative that is written as a fraction."""
    return isinstance(tree, ast.Name) and slope_in(tree.id) is not None


def stems_of(letter: str) -> list[str]:
    """What a letter may be a derivative of: x of dx_dphi, x_d, xd and xprime."""
    slope = slope_in(letter)
    return [slope.of] if slope else [s for s in (re.sub(r"(?:_?dd?|(?:prime)+)$", "", letter),) if s != letter]

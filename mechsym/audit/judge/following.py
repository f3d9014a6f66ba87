"""What an equation has to be that a text solves the one before it for: which gives, hence, from which."""

import ast
import re
from collections.abc import Iterator, Mapping
from functools import partial

from mechsym.audit.judge.motion import ANGLES
from mechsym.audit.judge.solving import isolate
from mechsym.audit.judge.world import World
from mechsym.audit.read.nomenclature import OPENED
from mechsym.audit.read.tree import Node, letters, name, number
from mechsym.audit.theory.tape import derivative, minus

_SOLVED = re.compile(
    r"\b(?:gives?|yields?|follows?|hence|thus|therefore|so that|from which|whence|obtains?|leads? to)\b", re.IGNORECASE
)
_DERIVED = re.compile(r"\b(?:differentiat\w+|(?:time )?derivatives?|derived by time)\b", re.IGNORECASE)
_BEFORE = 6  # equations in front of one that it may be the derivative of
_DISPLAY = re.compile(r"\$\$|\\end\{[a-z*]+\}|\\\]|```")


def solved(world: World, order: int) -> tuple[Node, int] | None:
    """The letter of an equation as the one before it gives it, and that one's place; None where no word says so."""
    said = world.paper.said[order]
    place = next((k for k in range(order - 1, -1, -1) if not world.paper.said[k].inline), None)
    if place is None or len(said.sides) != 2 or not isinstance(said.sides[0], ast.Name) or said.claim:
        return None
    source, letter = world.paper.said[place], said.sides[0].id
    between = _DISPLAY.split(OPENED.sub("", said.before.rstrip()))
    if len(between) < 2 or not _SOLVED.search(between[-1]) or source.section != said.section or source.claim:
        return None
    sides = [world.plain(side) for side in source.sides]
    inside = [letter in letters(side) for side in sides]
    if len(sides) != 2 or sum(inside) != 1 or isinstance(sides[inside.index(True)], ast.Name):
        return None
    tree = isolate(sides[inside.index(True)], letter, sides[inside.index(False)])
    return None if tree is None else (tree, place)


def differentiated(world: World, order: int) -> Iterator[tuple[Node, int]]:
    """What equations in front of one come to by time, where a word says that it is the derivative of one of them."""
    said = world.paper.said[order]
    between = _DISPLAY.split(OPENED.sub("", said.before.rstrip()))
    if len(said.sides) != 2 or said.claim or not _DERIVED.search(between[-1]):
        return
    used = {n for side in said.sides for n in letters(world.plain(side))}
    for place in range(order - 1, max(order - _BEFORE, -1), -1):
        source = world.paper.said[place]
        if source.inline or source.claim or len(source.sides) != 2 or source.section != said.section:
            continue
        whole = minus(*(world.plain(side) for side in source.sides))
        rates = {letter: _rate_in(letter, used) for letter in letters(whole)}
        if any(rates.values()):
            yield derivative(whole, partial(_rate_of, rates)), place


def _rate_of(rates: Mapping[str, str], letter: str) -> Node:
    return name(rates[letter]) if rates[letter] else number(0)


def _rate_in(letter: str, used: set[str]) -> str:
    # the rate of an angle with an index may be an omega with it
    stem = next((a for a in ANGLES if letter.startswith(a)), "")
    named = [f"{rate}{letter.removeprefix(stem)}" for rate in ("omega", "w")] if stem and letter != stem else []
    return next((rate for rate in (f"{letter}d", *named) if rate in used), "")

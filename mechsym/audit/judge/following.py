"""What an equation has to be that a text solves the one before it for: which gives, hence, from which."""

import ast
import re

from mechsym.audit.judge.solving import isolate
from mechsym.audit.judge.world import World
from mechsym.audit.read.nomenclature import OPENED
from mechsym.audit.read.tree import Node, letters

_SOLVED = re.compile(
    r"\b(?:gives?|yields?|follows?|hence|thus|therefore|so that|from which|whence|obtains?|leads? to)\b", re.IGNORECASE
)
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

"""A slip of an energy, which shows in every equation of motion of a text: told where one change makes them follow."""

import ast
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from itertools import takewhile

from mechsym.audit.judge.forms import known
from mechsym.audit.judge.lagrangian import Energies, laws
from mechsym.audit.judge.motion import energies_of
from mechsym.audit.judge.primes import by_angle
from mechsym.audit.judge.world import World
from mechsym.audit.read.tree import Node, is_operation, letters
from mechsym.audit.repair.edits import apply
from mechsym.audit.repair.rules import BITS, Words, listed_edits
from mechsym.errors import BadInput
from mechsym.quantities import record

_MOST = 3600  # changes that are tried, likely ones first, times the equations that each has read anew
_MOTIONS = 8  # equations of motion that are asked


@record
class EnergySlip:
    """An energy as it should be, and what it says then."""

    order: int  #: Place of its equation in the text [-]
    right: Node
    follow: Sequence[str]  #: Names of the equations of motion that follow from it
    energies: Energies


def energy_slip(world: World, energies: Energies) -> EnergySlip | None:
    """The one energy whose slip explains why no equation of motion follows from what is printed; None otherwise."""
    names = energies_of(world.paper)
    if not energies.laws or not names:
        return None
    motions = [order for order in range(len(world.paper.said)) if _is_told(world, energies, order)]
    motions = motions[:_MOTIONS]
    if len(motions) < 2 or any(_holds(world, energies, order) for order in motions):
        return None
    best: EnergySlip | None = None
    for defined in world.defined:
        said = world.paper.said[defined.order]
        if defined.letter not in names or not defined.side or len(said.sides) != 2:
            continue
        edits = sorted(listed_edits(said.sides[1], Words()), key=lambda edit: BITS.get(edit.kind, 0))
        for edit in edits[: _MOST // len(world.paper.said)]:
            right = apply(said.sides[1], edit)
            if {*letters(right)} != {*letters(said.sides[1])}:
                continue
            every = [*world.paper.said]
            every[defined.order] = replace(said, sides=(said.sides[0], right))
            other = World(paper=replace(world.paper, said=every), kinds=world.kinds)
            try:
                then = Energies(world=other, laws=laws(other))
            except (BadInput, KeyError, RecursionError):
                continue
            # two slips explain as much where one equation is left: told then only if it is the sign of a difference
            sign = edit.kind == "sign" and is_operation(edit.new, ast.Sub)
            follow = [*(filter if sign else takewhile)(partial(_holds, other, then), motions)]
            if (sign or len(follow) == len(motions)) and len(follow) > len(best.follow if best else ()):
                names_of = [world.paper.said[order].name for order in follow]
                best = EnergySlip(order=defined.order, right=right, follow=names_of, energies=then)
            if len(follow) == len(motions):
                return best
    return best


def _is_told(world: World, energies: Energies, order: int) -> bool:
    said = world.paper.said[order]
    moves = any(k.endswith("dd") for side in said.sides for k in letters(side))
    if said.inline or said.law is not None or len(said.sides) != 2 or not moves:
        return False
    try:
        return energies.tells(order, world.theory(order), _sides(world, order))
    except (BadInput, KeyError, RecursionError):
        return False


def _holds(world: World, energies: Energies, order: int) -> bool:
    try:
        return energies.holds(order, world.theory(order), _sides(world, order))
    except (BadInput, KeyError, RecursionError):
        return False


def _sides(world: World, order: int) -> list[Node]:
    theory = world.theory(order)
    return [by_angle(known(world, side, theory), theory) for side in world.paper.said[order].sides]

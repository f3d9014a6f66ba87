"""What earlier slips of a text make of its later equations: carried along, or right once they are corrected."""

import ast
from collections.abc import Sequence
from itertools import product

from mechsym.audit.hosts.asking import Asking
from mechsym.audit.hosts.judged import Judged
from mechsym.audit.hosts.paper import CARRIED
from mechsym.audit.judge.forms import known, readings, steady
from mechsym.audit.judge.sampled import alike, states
from mechsym.audit.judge.world import World
from mechsym.audit.read.said import Said
from mechsym.audit.read.tree import letters
from mechsym.errors import BadInput


def believed(world: World, asking: Asking, order: int, said: Said, pair: tuple[int, int]) -> Judged | None:
    """What follows from an earlier slip as it is printed, or is right without it; pair: the sides that are compared."""
    i, k = pair
    wrong = asking.wrong
    if not wrong:
        return None
    for names, mended in product([*([w] for w in wrong), list(wrong)], (False, True)):
        put_in = {w: right if mended else printed for w, (_, printed, right) in wrong.items() if w in names}
        theory = world.theory(order, put_in)
        left, right = known(world, said.sides[i], theory), known(world, said.sides[k], theory)
        for first, second in readings(world, left, right, theory):
            try:
                same = alike(states(steady(world, theory, said)), first, second)
            except (BadInput, KeyError, RecursionError):
                continue
            if same and mended:
                corrected = ", ".join(f"({wrong[w][0]})" for w in names)
                return Judged(verdict="exact", matched="the text", error=0.0, note=f"with {corrected} as corrected")
            if same:
                return follows(asking, names)
    return None


def follows(asking: Asking, names: Sequence[str]) -> Judged:
    """The verdict of what follows from slips of the letters that are named."""
    sources = tuple(asking.wrong[n][0] for n in names)
    why = f"follows from {', '.join(f'({s})' for s in sources)} as printed, and is no slip of its own"
    return Judged(verdict=CARRIED, matched="the text", note=why, follows=sources)


def carried(world: World, asking: Asking, order: int, said: Said, verdict: Judged) -> Judged:
    """The verdict of what is right by the text's own letters, one of which is wrong, and not so with the right one."""
    own = said.sides[0].id if isinstance(said.sides[0], ast.Name) else ""
    for letter, (source, _, right) in asking.wrong.items():
        if letter == own or source == said.name:
            continue
        theory = world.theory(order, {letter: right})
        trees = [known(world, s, theory) for s in said.sides]
        if len(trees) < 3 or not any(letter in letters(t) for t in trees):
            continue
        try:
            if alike(states(theory), trees[1], trees[2]) is False:
                return follows(asking, [letter])
        except (BadInput, KeyError):
            continue
    return verdict

"""What an equation has to be by those before it and the words between: solved for a letter, derived, reduced."""

import ast
import re
from collections.abc import Iterator
from functools import reduce

import numpy as np

from mechsym.audit.judge.by_energy import Expected, halved, rate_in, reduced, stored
from mechsym.audit.judge.kinds import of_unit
from mechsym.audit.judge.linear import characteristic, natural
from mechsym.audit.judge.reciprocal import mended
from mechsym.audit.judge.solving import isolate
from mechsym.audit.judge.turn import averaged, held, over_a_turn
from mechsym.audit.judge.world import World
from mechsym.audit.read.algebra import FLOATS, evaluate
from mechsym.audit.read.clause import OPENED
from mechsym.audit.read.latex import read_latex
from mechsym.audit.read.refused import SIGN
from mechsym.audit.read.said import Said
from mechsym.audit.read.slopes import Slope, slope_in
from mechsym.audit.read.spelling import SPEEDS
from mechsym.audit.read.tree import (
    Node,
    function_of,
    is_operation,
    letters,
    name,
    negative,
    number,
    substitute,
    value_of,
    walk,
)
from mechsym.audit.theory.record import dependencies
from mechsym.audit.theory.tape import derivative, minus, over, plus, slope_by, times
from mechsym.errors import BadInput

_SOLVED = re.compile(
    r"\b(?:solved for|solving|gives?|yields?|follows?|hence|thus|therefore|so that|from which|whence|obtains?"
    r"|leads? to)\b",
    re.IGNORECASE,
)
_STEADY = re.compile(r"\buniform(?:ly)?\b|\b(?:constant|steady) (?:angular )?(?:speed|velocity)\b", re.IGNORECASE)
_DERIVED = re.compile(r"\b(?:differentiat\w+|(?:time )?derivatives?|derived by time)\b", re.IGNORECASE)
_DERIVED_OF = re.compile(r"\bdifferentiat\w+\s+(?:\w+\s+){0,2}\(([\w.]+)\)[^.;:]*\btime\b", re.IGNORECASE)
_REDUCED = re.compile(r"\breduc(?:ed|tion|ing)\b|\b(?:equivalent|effective) (?:moment of )?inertia\b", re.IGNORECASE)
_PUSHES = re.compile(r"\b(?:piston|gas|plunger|yoke|slider|crosshead)\b")
_ELSEWHERE = re.compile(r"\b(?:second|third|other|ahead|behind|degrees|leads?|lags?)\b|°|\\circ")  # at another angle
_TORQUE = re.compile(r"\btorque\b|\bmoment\b(?! of)", re.IGNORECASE)
CUT_SHORT = re.compile(r"lineari[sz]|small|neglect|approximat|\bnear\b|constant speed", re.IGNORECASE)
_ITS_SPEED = re.compile(r"\bits\s+(?:velocity|speed)\b", re.IGNORECASE)
_STORED = re.compile(r"\b(?:stor(?:es?|ed)|potential energy|elastic energy)\b", re.IGNORECASE)
_SPEED, _WAYS = re.compile(r"\b(?:speeds?|velocit(?:y|ies))\b", re.IGNORECASE), "xyzsh"
_AT_A_VALUE = re.compile(
    rf"\b(?:At|For|With|Where)\s+\$({SIGN})\s*=\s*([^$=]+)\$\s+(?:this|that|it)\s+(?:is|becomes|gives)\s*$"
)
_GEARED = re.compile(r"\b(?:half|twice|double|camshaft|gear|pinion|wheel|belt|pulley|pole)", re.IGNORECASE)
_AT_REST = re.compile(r"\b(?:equilibrium|static(?:ally)?|at rest|(?:to|must|can) hold|holds?)\b", re.IGNORECASE)
_NEEDS = re.compile(
    r"\b(?:needs?|takes?|requires?|absorbs?|consumes?|must (?:give|deliver|supply|provide))\b", re.IGNORECASE
)
_MEAN = re.compile(
    r"\b(?:mean|average)\b"
    r"|\b(?:over|in|during) (?:a|one|each|every) (?:revolution|turn)\b[^.]*\bwork\b[^.]*\b(?:that of|equals?|same)\b",
    re.IGNORECASE,
)
_SEVERAL = re.compile(
    r"\b(?:two|both|three|each|every|all|twin|pair|(?!its|this|is|parts|masses)[a-z]+[a-rt-z]s)\b", re.IGNORECASE
)
_IN_FRONT = 3  # equations in front of one that may give it as it stands
_BEFORE = 6  # equations in front of one that it may be the derivative of
_DISPLAY = re.compile(r"\$\$|\\end\{[a-z*]+\}|\\\]|```")


def solved(world: World, order: int) -> tuple[Node, int] | None:
    """The letter of an equation as the one before it gives it, and that one's place; None where no word says so."""
    said = world.paper.said[order]
    if len(said.sides) != 2 or not isinstance(said.sides[0], ast.Name) or said.claim:
        return None
    letter = said.sides[0].id
    # of the sentence in front, with which it is solved, before the display in front of that
    near = [k for k in range(order - 1, -1, -1) if not world.paper.said[k].inline or _has(world.paper.said[k], letter)]
    if not near:
        return None
    place, source = near[0], world.paper.said[near[0]]
    between = _DISPLAY.split(OPENED.sub("", said.before.rstrip()))
    steady = len(between) > 1 and _STEADY.search(between[-1]) is not None
    if (
        len(between) < 2
        or CUT_SHORT.search(said.before.replace(between[-1], _STEADY.sub("", between[-1])))
        or not (steady or _SOLVED.search(between[-1]))
        or source.section != said.section
        or source.claim
    ):
        return None
    sides = [world.plain(side) for side in source.sides]
    if len(sides) > 2 and letter not in letters(sides[0]):  # of a chain the form that has the letter
        sides = [sides[0], *(side for side in sides[1:] if letter in letters(side))]
    if not any(letter in letters(side) for side in sides):  # the hinge's moment within Q
        inner = {d.letter: world.plain(world.paper.said[d.order].sides[1]) for d in world.defined if d.order < place}
        inner = {k: tree for k, tree in inner.items() if letter in letters(tree)}
        sides = [substitute(s, lambda n: inner.get(n.id) if isinstance(n, ast.Name) else None) for s in sides]
    if steady:  # nothing is accelerated that turns
        rates = {f"{world.angle}dd", *(f"{k}d" for k in (*SPEEDS, *world.aliases))}
        sides = [
            substitute(s, lambda n: number(0) if isinstance(n, ast.Name) and n.id in rates else None) for s in sides
        ]
    inside = [letter in letters(side) for side in sides]
    if len(sides) != 2 or sum(inside) != 1 or isinstance(sides[inside.index(True)], ast.Name):
        return None
    tree = isolate(sides[inside.index(True)], letter, sides[inside.index(False)])
    return None if tree is None else (tree, place)


def implied_by(world: World, order: int) -> int | None:
    """The place of one of the displayed equations right before one, in its section, that gives it exactly."""
    said = world.paper.said[order]
    here = [world.plain(side) for side in said.sides]
    used = {k for side in here for k in letters(side)} - {"pi"}
    before = [k for k in range(order - 1, -1, -1) if not world.paper.said[k].inline][:_IN_FRONT]
    for place in before:
        one = world.paper.said[place]
        source = [world.plain(side) for side in one.sides]
        if one.section != said.section or one.claim or len(source) != 2:
            continue
        own = {k for side in source for k in letters(side)} - {"pi"}
        for letter in sorted(own) if own <= used else ():
            inside = [letter in letters(side) for side in source]
            if sum(inside) == 1:
                tree = isolate(source[inside.index(True)], letter, source[inside.index(False)])
                whole = [_with(side, letter, tree) for side in here] if tree is not None else []
                if whole and (_are_one(whole) or len(whole) > 2 and _are_one(whole[1:])):  # what the first is it says
                    return place
    return None


def _with(side: Node, letter: str, tree: Node) -> Node:
    return substitute(side, lambda n: tree if isinstance(n, ast.Name) and n.id == letter else None)


def _are_one(sides: list[Node]) -> bool:
    # for any positive numbers
    names = sorted({k for side in sides for k in letters(side)} - {"pi"})
    numbers = np.random.default_rng(7).uniform(0.2, 0.9, (len(names), 24))
    with np.errstate(all="ignore"):
        rows = [
            np.broadcast_to(evaluate(s, {"pi": np.pi, **dict(zip(names, numbers, strict=True))}, FLOATS), 24)
            for s in sides
        ]
    good = np.all(np.isfinite(rows), axis=0)
    return bool(good.sum() > 4) and all(np.allclose(row[good], rows[0][good], rtol=1e-9) for row in rows[1:])


def _has(said: Said, letter: str) -> bool:
    return any(letter in letters(side) for side in said.sides[1:]) and not said.equates


def expected(world: World, order: int) -> Iterator[Expected]:
    """What an equation may have to say by those before it: a derivative, an inertia, a torque or a frequency."""
    said = world.paper.said[order]
    between = _DISPLAY.split(OPENED.sub("", said.before.rstrip()))
    # the velocities are v_1 = .. and v_2 = ..
    words = between[-2] if len(between) > 1 and between[-1].strip() in ("and", "to be", "as") else between[-1]
    if len(said.sides) == 2 and not said.claim:
        yield from _transmitted(world, said)
        left = getattr(said.sides[0], "id", "")
        of_speed = _SPEED.search(world.paper.called.get(left, "")) or _SPEED.search(words)
        if left and of_speed and not CUT_SHORT.search(_STEADY.sub("", words)):
            yield from _speed_of_its_way(world, order, said, left)
    if len(said.sides) == 2 and not said.claim and not CUT_SHORT.search(words):
        if (tree := mended(world, order)) is not None:
            note = "what acts on a neighbour comes back with the same coefficient"
            yield Expected(tree=tree, printed=said.sides[0], note=note, scaled=True)
        if _DERIVED.search(words):
            yield from _differentiated(world, order, said)
        if left and world.angle and (of := _DERIVED_OF.search(words)):
            yield from _rate_of(world, said, of[1])
        of_torque = _TORQUE.search(words) or _TORQUE.search(world.paper.called.get(left, ""))
        if of_torque and not _ELSEWHERE.search(words) and not re.search(r"[2-9]$", left):
            yield from _by_virtual_work(world, order, said)
        if world.angle and "virtual work" in words:
            yield from _along_its_ways(world, said)
        if function_of(said.sides[1]) == "sqrt" and left.startswith(SPEEDS):
            yield from natural(world, order, said)
        if {"stroke", "compression ratio"} & {world.paper.called.get(left, ""), said.about}:
            yield from over_a_turn(world, order, said)
        if left and _AT_REST.search(words):
            yield from held(world, said)
        if left and _NEEDS.search(words):
            yield from _needed(world, said)
        yield from characteristic(world, order, said)
        if not _GEARED.search(words):
            yield from _of_turns(world, said)
        yield from _turned(world, said, left)
        if at := _AT_A_VALUE.search(words):
            yield from _at_value(world, order, said, *at.groups())
        if _MEAN.search(words) and not re.fullmatch("[aA]_?0", left):  # Fourier's a_0 is twice the mean
            yield from averaged(said)
        if left and "kinetic" in f"{world.paper.called.get(left, said.about)} {words}" and not _SEVERAL.search(words):
            yield from halved(world, said)
        if left and _STORED.search(f"{world.paper.called.get(left, said.about)} {words}"):
            yield from stored(world, order, said)
        yield from _by_primes(world, said, left)
        if _REDUCED.search(words) and isinstance(said.sides[0], ast.Name):
            yield from reduced(world, order, said)


def _turned(world: World, said: Said, left: str) -> Iterator[Expected]:
    r"""What hangs on an angle that turns evenly: \ddot R = omega^2 R'', whatever R is."""
    for stem, dots in ((left.removesuffix("dd"), 2), (left.removesuffix("d"), 1)):
        printed, slope = world.plain(said.sides[1]), stem + "prime" * dots
        used = letters(printed)
        rates = [n for n in used if n in SPEEDS or n == f"{world.angle}d"]
        if stem != left and {*used} == {slope, *rates} and len(rates) == 1:
            rate = name(rates[0])
            tree = times(rate if dots == 1 else times(rate, rate), name(slope))
            yield Expected(tree=tree, printed=printed, note=f"by the slope of {stem} at an even speed")


def _at_value(world: World, order: int, said: Said, letter: str, value: str) -> Iterator[Expected]:
    """The equation before it, of the same letter, where another letter has a value."""
    place = next((k for k in range(order - 1, -1, -1) if not world.paper.said[k].inline), None)
    source = None if place is None else world.paper.said[place]
    if source is None or len(source.sides) != 2 or source.section != said.section:
        return
    if ast.dump(source.sides[0]) != ast.dump(said.sides[0]):
        return
    try:
        at, there = (read_latex(text, whole=True)[0] for text in (letter, value))
    except BadInput:
        return
    tree = substitute(source.sides[1], lambda n: there if ast.dump(n) == ast.dump(at) else None)
    yield Expected(tree=world.plain(tree), printed=world.plain(said.sides[1]), note=f"by ({source.name}) there")


def _by_primes(world: World, said: Said, left: str) -> Iterator[Expected]:
    # the slope of what is printed by rho and its primes
    slope = slope_in(left, world.angle) if world.angle else None
    own = next((d.tree for d in world.defined if slope and d.letter == slope.of), None)
    if slope and slope.order == 1 and own is not None and any(f"{k}prime" in world.used for k in letters(own)):
        moving = {k: name(f"{k}prime") for k in letters(own) if f"{k}prime" in world.used}
        tree = derivative(own, lambda k: moving.get(k, number(0)))
        yield Expected(tree=tree, printed=world.plain(said.sides[1]), note=f"the slope of {slope.of}")


def _by_virtual_work(world: World, order: int, said: Said) -> Iterator[Expected]:
    # the torque of a force on what moves with the angle: that force times the slope of its way
    printed, theory = world.plain(said.sides[1]), world.theory(order)
    forces = [k for k in _above(printed) if world.kinds.of(k) == of_unit("N")]
    forces = [k for k in forces if _PUSHES.search(world.paper.called.get(k, ""))]
    ways = [d.letter for d in world.defined if world.kinds.of(d.letter) == of_unit("m") and world.turns(d.letter)]
    if len(forces) != 1 or not world.angle or world.angle not in dependencies(theory, letters(printed)):
        return
    for way in dict.fromkeys(ways):
        work = times(name(forces[0]), name(Slope(way, world.angle).name))
        for tree in (work, negative(work)):
            yield Expected(tree=tree, printed=printed, note=f"the work of {forces[0]} on {way}", whole=True)


def _along_its_ways(world: World, said: Said) -> Iterator[Expected]:
    # F_x along x and F_y along y
    printed = world.plain(said.sides[1])
    ways = {d.letter for d in world.defined if world.turns(d.letter)}
    along = {k: k[1:] for k in letters(printed) if world.kinds.of(k) == of_unit("N") and k[1:] in ways}
    if len(along) > 1:
        work = reduce(plus, (times(name(k), name(Slope(way, world.angle).name)) for k, way in along.items()))
        yield Expected(tree=work, printed=printed, note=f"the work of {' and '.join(along)}", whole=True)


def _speed_of_its_way(world: World, order: int, said: Said, left: str) -> Iterator[Expected]:
    # v_i is the rate of x_i, of the one way with the same index that the text has; so is v, where it is its velocity
    index = left[1:]
    before = (d for d in world.defined if d.order < order and d.letter[1:] == index and d.letter[0] in _WAYS)
    ways = [d.letter for d in before if world.turns(d.letter) and not world.paper.said[d.order].claim]
    of_it = index or _ITS_SPEED.search(_DISPLAY.split(OPENED.sub("", said.before.rstrip()))[-1])
    if of_it and len(set(ways)) == 1 and left[0] in "vcuw" and world.angle:
        rate = times(name(Slope(ways[0], world.angle).name), name(f"{world.angle}d"))
        for tree in (rate, negative(rate)):
            yield Expected(tree=tree, printed=world.plain(said.sides[1]), note=f"the rate of {ways[0]}", whole=True)


def _rate_of(world: World, said: Said, source: str) -> Iterator[Expected]:
    # differentiating (5) by time gives v, at an even speed
    for other in world.paper.said:
        if other.name == source and len(other.sides) == 2 and isinstance(other.sides[0], ast.Name):
            even = times(slope_by(world.plain(other.sides[1]), world.angle), name(f"{world.angle}d"))
            printed = world.plain(said.sides[1])
            yield Expected(tree=even, printed=printed, note=f"the rate of ({source})", whole=True)


def _above(tree: Node) -> list[str]:
    # letters that multiply a whole expression
    if isinstance(tree, ast.UnaryOp):
        return _above(tree.operand)
    if is_operation(tree, ast.Mult):
        return [*_above(tree.left), *_above(tree.right)]
    return _above(tree.left) if is_operation(tree, ast.Div) else [tree.id] if isinstance(tree, ast.Name) else []


def _transmitted(world: World, said: Said) -> Iterator[Expected]:
    """A torque by another one and the ratio of their speeds: what goes in comes out, so that the ratio is turned."""
    own, used = getattr(said.sides[0], "id", ""), letters(said.sides[1])
    speeds = {k.removeprefix(s): k for k in used for s in SPEEDS if k.startswith(s)}  # by their indices
    torques = [k for k in used if k not in speeds.values()]
    if len(torques) != 1 or torques[0][:1] != own[:1] or own[1:] == torques[0][1:]:
        return
    if speeds.keys() == {own[1:], torques[0][1:]}:
        tree = times(name(torques[0]), over(name(speeds[torques[0][1:]]), name(speeds[own[1:]])))
        for whole in (tree, negative(tree)):
            note = "the power of both is the same"
            yield Expected(tree=world.plain(whole), printed=world.plain(said.sides[1]), note=note)


def _of_turns(world: World, said: Said) -> Iterator[Expected]:
    """An angular velocity by what counts turns: pi/30 of those in a minute, 2 pi of those in a second."""
    left, printed = getattr(said.sides[0], "id", ""), said.sides[1]
    counted = [k for k in letters(printed) if k != "pi"]
    if not left.startswith(SPEEDS) or "pi" not in letters(printed) or len(counted) != 1 or counted[0][0] not in "nNf":
        return
    minute = any(value_of(n) in (30, 60, 900, 3600) for _, n in walk(printed))
    each = over(name("pi"), number(30)) if minute else times(number(2), name("pi"))
    yield Expected(tree=times(each, name(counted[0])), printed=printed, note="a turn is 2 pi")


def _needed(world: World, said: Said) -> Iterator[Expected]:
    """What a machine needs is what it gives by its efficiency, and not times that."""
    printed = world.plain(said.sides[1])
    if world.kinds.of(getattr(said.sides[0], "id", "")) not in (of_unit("W"), of_unit("N*m")):
        return
    for letter in _above(printed):
        if "efficiency" in world.phrase(letter):
            tree = over(printed, times(name(letter), name(letter)))
            yield Expected(tree=tree, printed=printed, note="what is needed is more than what is given")


def _differentiated(world: World, order: int, said: Said) -> Iterator[Expected]:
    left, right = (world.plain(side) for side in said.sides)
    used = {*letters(left), *letters(right)}
    for place in range(order - 1, max(order - _BEFORE, -1), -1):
        source = world.paper.said[place]
        if source.inline or source.claim or len(source.sides) != 2 or source.section != said.section:
            continue
        whole = minus(*(world.plain(side) for side in source.sides))
        rates = {letter: name(rate) for letter in letters(whole) if (rate := rate_in(letter, used))}
        if rates:
            moving = rates | {"t": number(1)}
            tree = derivative(whole, lambda k, known=moving: known.get(k, number(0)))  # type: ignore[misc]
            yield Expected(tree=tree, printed=minus(left, right), note=f"the rate of ({source.name})", scaled=True)

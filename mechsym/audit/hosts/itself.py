"""What a program says of itself, without a theory: slopes by their names, angles that are converted twice, the wrong
way, or in most places and in another not, and a 1 that was an l.
"""

import ast
import functools
import math
import re
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from mechsym.audit.hosts.slips import asked_once, renamed_to
from mechsym.audit.judge.fitted import safe
from mechsym.audit.judge.lexicon import ANGLES
from mechsym.audit.judge.nearness import Probes, compared, of_units
from mechsym.audit.read import tree as trees
from mechsym.audit.read.algebra import FLOATS, evaluate
from mechsym.audit.read.programs.claims import Claim, Reading, base, inlined
from mechsym.audit.read.reader import Formula
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.tree import Node, letters
from mechsym.audit.repair.rules import CIRCULAR
from mechsym.audit.row import Row
from mechsym.audit.theory.record import Letter, Theory
from mechsym.audit.theory.tape import TheoryTape, slope_by
from mechsym.audit.verdict import PASSED
from mechsym.errors import BadInput

_SLOPE = re.compile(
    r"^(?:d_?(?P<of>\w+?)_?d_?(?P<by>\w+)|(?:d_|d|deriv_|grad_)(?P<f>\w+)|(?P<g>\w+?)_?(?:prime|deriv|derivative))$"
)


def slope_beside(claim: Claim, claims: Sequence[Claim]) -> Row | None:
    """What names like dV_dtheta and dV say: the derivative of V, which stands in the same scope, by an angle."""
    match, names = _SLOPE.match(claim.name), {c.name for c in claims if c.scope == claim.scope}
    of = claim.name[1:].lstrip("_") if claim.name[:1] == "d" else ""
    of = of if of in names else (match["of"] or "") if match else ""
    alike = [c for c in claims if c.scope == claim.scope and c.name == of]
    if len(alike) != 1 or alike[0].case != claim.case:
        return None
    if claim.name in map(base, letters(alike[0].tree)):  # x = x - dx: a step
        return None
    whole, slope = inlined(alike[0].tree, alike[0].values), inlined(claim.tree, claim.values)
    if whole is None or slope is None:
        return None
    wanted = (match["by"],) if match and match["of"] == of else ANGLES
    by = [k for k in letters(whole) if base(k) in wanted]
    if len(by) != 1 or not set(letters(slope)) <= set(letters(whole)):
        return None
    return _derived(whole, slope, by[0], claim.name, of)


def slopes(reading: Reading) -> Iterator[tuple[Claim, Row]]:
    """Functions of one letter that are called the derivative of another function."""
    for claim in reading.claims:
        match = _SLOPE.match(claim.scope) if claim.name == "return" else None
        of = (match["f"] or match["g"] or "") if match else ""
        if of not in reading.functions or claim.scope not in reading.functions:
            continue
        (parameters, whole), (again, slope) = reading.functions[of], reading.functions[claim.scope]
        if len(parameters) != 1 or len(again) != 1:
            continue
        named_alike = _with_name(slope, again[0], parameters[0])
        if set(letters(named_alike)) <= set(letters(whole)) and parameters[0] in letters(named_alike):
            row = _derived(whole, named_alike, parameters[0], claim.scope, of)
            if row is not None:
                yield claim, row


def _with_name(tree: Node, old: str, new: str) -> Node:
    return trees.substitute(tree, lambda n: renamed_to(n, {old: new}))


def _derived(whole: Node, slope: Node, by: str, called: str, of: str) -> Row | None:
    if by not in letters(whole):
        return None
    try:
        rate = slope_by(with_safe_names(whole), safe(by))
        theory = itself(whole, of_itself=with_safe_names(whole), slope=rate)
        printed = with_safe_names(slope)
        trees.check(printed)
        met = compared(Formula(tree=printed), Probes(theory), "slope")
    except (BadInput, RecursionError):
        return None
    if met is None or of_units(met.ratio):
        return None if met is None else {"verdict": "agrees", "claim": f"derivative of {of}"}
    row, _ = asked_once(to_python(printed), theory, "slope", {}, ())
    if row["verdict"] in (*PASSED, "untestable"):
        return row | {"verdict": "agrees"}
    why = f"{called} is called the derivative of {of} by {base(by)}, and is not; one of the two is wrong"
    return row | {
        "verdict": "derivative",
        "claim": f"the derivative of {of} by {base(by)}",
        "note": f"{why}; {row['note']}",
    }


_TURN = math.pi / 180
_HALVES = np.arange(1.0, 9.0)[:, None]  # of an angle: of which sines are taken


def converted_twice(claim: Claim) -> Row | None:
    """A sine, cosine or tangent whose angle is turned from degrees to radians, and has been so before, or back."""
    for path, node in trees.walk(claim.tree):
        argument = trees.argument_of(node, *CIRCULAR)
        whole = None if argument is None else inlined(argument, claim.values)
        if argument is None or whole is None or letters(argument) == letters(whole):
            continue
        here, in_all = _factors(argument), _factors(whole)
        for turn in (_TURN, 1 / _TURN):
            if _is_once(here, turn) and _is_once(in_all, turn**2):
                (angle,) = here
                right = trees.replace(claim.tree, (*path, "argument"), trees.name(angle))
                return _otherwise(claim, right, f"{base(angle)} has been converted before")
    return None


def into_degrees(claim: Claim) -> Row | None:
    """A sine, cosine or tangent of radians, whose angle is turned into degrees."""
    for path, node in trees.walk(claim.tree):
        argument = trees.argument_of(node, *CIRCULAR)
        factors = {} if argument is None else _factors(argument)
        if _is_once(factors, 1 / _TURN):
            (angle,) = factors
            turned = trees.binary(
                ast.Div, trees.binary(ast.Mult, trees.name(angle), trees.name("pi")), trees.number(180)
            )
            right = trees.replace(claim.tree, (*path, "argument"), turned)
            return _otherwise(claim, right, f"{base(angle)} is turned into degrees where radians are taken")
    return None


def converted_here_and_not_there(claims: Sequence[Claim]) -> Iterator[tuple[Claim, Row]]:
    """Formulas with the bare sine of a letter whose degrees are turned to radians in most others of its branch."""
    used: dict[tuple[str, int, str], tuple[list[Claim], list[Claim]]] = {}
    for claim in claims:
        for letter, plain in {use for _, node in trees.walk(claim.tree) for use in _angle_of(node)}:
            used.setdefault((claim.scope, claim.case, letter), ([], []))[plain].append(claim)
    for (_, _, letter), (converted, bare) in used.items():
        if len(converted) <= len(bare) or any(claim in converted for claim in bare):
            continue
        lines = ", ".join(str(claim.line) for claim in converted[:3])
        for claim in bare:
            right = trees.substitute(claim.tree, functools.partial(_turned, letter))
            row = _otherwise(claim, right, f"{base(letter)} is in degrees, and is converted in line {lines}")
            if row is not None:
                yield claim, row


def one_for_a_letter(claim: Claim) -> Row | None:
    """A power of 1 where the program has an l of its own that the formula does without: 1**2 for l**2."""
    for path, node in trees.walk(claim.tree):
        if not trees.is_operation(node, ast.Pow) or trees.value_of(node.left) != 1:
            continue
        known = {*claim.values, *claim.parameters} - set(letters(claim.tree))
        letter = next((k for k in ("l", "I") if k in known), "")
        if letter and not (letter in claim.values and trees.value_of(claim.values[letter]) == 1):
            right = trees.replace(claim.tree, (*path, "left"), trees.name(letter))
            row = _otherwise(claim, right, f"a power of 1 is 1, and {letter} stands beside it unused")
            return row and row | {"correction": to_python(right)}
    return None


def _otherwise(claim: Claim, right: Node, why: str) -> Row | None:
    """The row of a formula that should be another one; None where that makes no difference."""
    row, _ = asked_once(
        to_python(with_safe_names(claim.tree)), itself(right, right=with_safe_names(right)), "right", {}, ()
    )
    if row["verdict"] not in ("misprint", "wrong"):
        return None
    return row | {"claim": "what its own letters give", "note": f"{why}; {row['note']}"}


def _angle_of(node: Node) -> Iterator[tuple[str, bool]]:
    """The letters whose sum has a node as its sine, cosine or tangent, and whether they stand there bare."""
    argument = trees.argument_of(node, *CIRCULAR)
    factors = _factors(argument) if argument is not None else {}
    for bare, turn in ((True, 1.0), (False, _TURN)):
        if factors and bool(np.isclose(2 * np.abs([*factors.values()]) / turn, _HALVES, rtol=1e-5).any(axis=0).all()):
            yield from ((letter, bare) for letter in factors)


def _factors(tree: Node) -> dict[str, float]:
    """Factors of the letters of a sum of multiples of them; none where it is anything else."""
    own = [k for k in letters(tree) if k != "pi"]
    ones = np.vstack([np.zeros(len(own)), np.eye(len(own)), np.ones(len(own))])
    with np.errstate(all="ignore"):
        rows = evaluate(tree, {"pi": math.pi, **dict(zip(own, ones.T, strict=True))}, FLOATS)
    nothing, *factors, together = np.broadcast_to(np.asarray(rows, dtype=float), (len(ones),)).tolist()
    linear = nothing == 0 and math.isclose(sum(factors), together, rel_tol=1e-9, abs_tol=1e-12)
    return dict(zip(own, factors, strict=True)) if linear else {}


def _turned(letter: str, node: Node) -> Node | None:
    argument = trees.argument_of(node, *CIRCULAR)
    if argument is None or (letter, True) not in _angle_of(node):
        return None
    radians = trees.binary(ast.Div, trees.binary(ast.Mult, argument, trees.name("pi")), trees.number(180))
    return trees.call(str(trees.function_of(node)), radians)


def _is_once(factors: Mapping[str, float], factor: float) -> bool:
    """Whether factors are of one letter alone, and that one."""
    return len(factors) == 1 and all(math.isclose(own, factor, rel_tol=1e-6) for own in factors.values())


def itself(tree: Node, **quantities: Node) -> Theory:
    """A theory of a program's own formulas, whose letters are all free."""
    # no two alike, so that none cancels another where the data are looked at
    free = {safe(k): Letter(unit="-", value=1 + 0.37 * i) for i, k in enumerate(letters(tree)) if k != "pi"}
    tape = TheoryTape(quantities, free, "", declared=True)
    return Theory(name="itself", letters=free, tape=tape, results=tuple(quantities), data="the program itself")


def with_safe_names(tree: Node) -> Node:
    """A program's formula with names that no theory has a use of its own for."""
    return trees.substitute(
        tree, lambda n: trees.name(safe(n.id)) if isinstance(n, ast.Name) and n.id != "pi" else None
    )

"""A function beside the formula in its own description: where they differ one of the two is wrong."""

import ast
import contextlib
import math
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from fractions import Fraction

from mechsym.audit.hosts.itself import itself, with_safe_names
from mechsym.audit.hosts.slips import asked_once, renamed_to
from mechsym.audit.judge.nearness import Probes, compared, of_units
from mechsym.audit.read import tree as trees
from mechsym.audit.read.latex import read_latex
from mechsym.audit.read.programs.claims import Claim, Reading, base, inlined, with_base_names
from mechsym.audit.read.programs.statements import OF
from mechsym.audit.read.reader import Formula, read_expression
from mechsym.audit.read.restructured import with_dollars
from mechsym.audit.read.said import read_text_whole
from mechsym.audit.read.spelling import ALIASES, to_python
from mechsym.audit.read.tree import Node, letters
from mechsym.audit.row import Row
from mechsym.audit.verdict import PASSED
from mechsym.errors import BadInput
from mechsym.quantities import record

_DOXYGEN = re.compile(r"[\\@]f([$\[\]])")
_INLINE = re.compile(r"(?m)(?<!\$)\$([^$\n]*=[^$\n]*)\$(?!\$)(?=[ \t]*[.,;]?[ \t]*$)")
# `:param name: what it is` and `name : type` with what it is in the lines below, up to the next one
_PARAMETER = re.compile(r"(?m)^[ \t]*(?::param (?:\w+ )?)?(\w+) ?:((?:.*\n?)(?:(?!^[ \t]*(?::|\w+ ?:)).*\S.*\n?)*)")
# a formula that stands alone in plain text, behind a colon at most
_LINE = re.compile(r"(?m)^[ \t]*(?:[A-Z][\w ,\-]{2,40}:[ \t]*)?([A-Za-z_]\w*) ?= ?([^=$\n]{3,200}?)[ \t]*[.,;]?[ \t]*$")
_RETURNED = re.compile(r"Returns?\s*\n\s*-+\s*\n\s*([A-Za-z_]\w*)\s*:")  # what is given back, as numpy's pages name it
_ROUNDED = 1e-3  # by which numbers that are rounded, and what keeps a divisor from 0, move a formula [-]
_ZEROS = {Fraction(k) for k in ("273.15", "273", "273.16", "459.67", "32")}  # of scales of temperature
# from degrees, and of thousands
_CONVERSIONS = (math.pi / 180, 180 / math.pi, *(10.0**k for k in (-9, -6, -3, 3, 6, 9)))
_INDICES = {*"ijkn"}
_FEWEST = 2  # letters that a formula and a function have in common: of one, any formula is a slip of any other
_GREEK = ALIASES | {"lambd": "lam", "lamda": "lam", "eps": "epsilon"}  # letters as programs spell them


@record
class _Described:
    """A formula of a description."""

    left: str  #: Letter that it gives; empty where it is the logarithm or the slope of one
    right: Node


def descriptions(reading: Reading) -> Iterator[tuple[Claim, Row]]:
    """What each function gives that its description has a formula of, in the same letters."""
    for scope, text in reading.described.items():
        if "=" not in text:
            continue
        claims = [c for c in reading.claims if c.scope == scope]
        signs = _signs(text)
        formulas = [*_formulas(text, {base(k) for c in claims for k in (c.name, *letters(c.tree))}, signs)]
        names = {_plain(c.name) for c in claims}
        given = _RETURNED.search(text)
        best: dict[int, tuple[Claim, Row]] = {}
        for claim in claims:
            called = _plain(given[1] if given and claim.name == "return" else claim.name)
            same = [t for t in formulas if t.left == called or (called == "return" and t.left and t.left not in names)]
            if (met := _beside(claim, same)) is not None:
                one, row = met
                # what a branch gives may have a formula that another branch has not
                if row["verdict"] == "agrees" or (id(one) not in best and not claim.case):
                    best[id(one)] = claim, row
        yield from best.values()


def _signs(text: str) -> dict[str, str]:
    """The letters of a description by which it calls the parameters, and their names in the program."""
    signs: dict[str, str] = {}
    for name, about in _PARAMETER.findall(with_dollars(text)):
        for sign in re.findall(r"\$([^$=\n]{1,30})\$", about)[:1]:
            with contextlib.suppress(BadInput, RecursionError):
                tree = read_latex(sign, whole=True)[0]
                if isinstance(tree, ast.Name):
                    signs.setdefault(tree.id, name)
    return {k: v for k, v in signs.items() if list(signs.values()).count(v) == 1}


def _formulas(text: str, names: Collection[str], signs: Mapping[str, str]) -> Iterator[_Described]:
    """The formulas of a description; names of the program are letters in them as well."""
    text = _DOXYGEN.sub(lambda m: "$" if m[1] == "$" else "$$", text)
    for match in _LINE.finditer(text):
        with contextlib.suppress(BadInput, RecursionError):
            yield _Described(left=_plain(match[1]), right=read_expression(match[2], names)[0])
    words = "|".join(sorted((k for k in names if k.isalpha() and len(k) > 1), key=len, reverse=True))
    text = _INLINE.sub(r"$$\1$$", with_dollars(text))
    text = re.sub(r"\\Delta\s*([A-Za-z])(?![A-Za-z])", r"\\text{delta\1}", text)
    if words:
        text = re.sub(rf"(?<![A-Za-z\\{{])(?:{words})(?![A-Za-z])", r"\\text{\g<0>}", text)
    try:
        said = read_text_whole(text).said
    except (BadInput, RecursionError):
        return
    for one in said:
        for left, right in zip(one.sides, one.sides[1:], strict=False):
            named = trees.substitute(right, lambda n: renamed_to(n, signs))
            yield _Described(left=_plain(left.id) if isinstance(left, ast.Name) else "", right=named)


def _plain(letter: str) -> str:
    """A letter without the signs by which texts and programs differ."""
    word = base(letter).rpartition(OF)[2]
    return "".join(_GREEK.get(part, part) for part in re.split(r"_+", word))


def _beside(claim: Claim, formulas: Sequence[_Described]) -> tuple[_Described, Row] | None:
    """The formula that has the letters of a claim, what stands for its other variables put in, with its row."""
    met: tuple[_Described, Row] | None = None
    for one in formulas:
        theirs = {_plain(k): k for k in letters(one.right) if k != "pi"}
        kept = {k: 1 for k in claim.values if _plain(k) in theirs}
        own = inlined(claim.tree, claim.values, kept)
        called = {_plain(k): k for k in letters(own) if k != "pi"} if own is not None else {}
        if own is None or len(called) < _FEWEST or theirs.keys() != called.keys():
            continue
        if len(called) < len({*letters(own)} - {"pi"}):  # a name with two values
            continue
        if _INDICES & called.keys() - {*claim.parameters}:  # of a loop, which a program counts from 0
            continue
        names = {theirs[k]: base(called[k]).replace(OF, "_") for k in theirs}
        row = _compared(with_base_names(own), one.right, names)
        met = met if row is None else (one, row)
        if row is not None and row["verdict"] == "agrees":
            break  # a description may have several forms of a formula, and others beside it
    return met


def _compared(own: Node, theirs: Node, names: dict[str, str]) -> Row | None:
    printed, right = with_safe_names(own), with_safe_names(trees.substitute(theirs, lambda n: renamed_to(n, names)))
    try:
        theory = itself(own, described=right)
        met = compared(Formula(tree=printed), Probes(theory), "described")
        if met is None or of_units(met.ratio):
            return None if met is None else {"verdict": "agrees"}
        row, _ = asked_once(to_python(printed), theory, "described", {}, ())
    except (BadInput, RecursionError):
        return None
    if row["verdict"] == "untestable":
        return None
    if row["verdict"] in PASSED or met.away < _ROUNDED or _scaled(own, theirs):
        return row | {"verdict": "agrees"}
    plain = compared(
        Formula(tree=_unconverted(printed)), Probes(itself(own, described=_unconverted(right))), "described"
    )
    if plain is not None and of_units(plain.ratio):
        return {"verdict": "agrees"}
    why = f"its description gives {to_python(theirs)}; one of the two is wrong"
    # no repair: it would be one towards the description
    nothing = {"correction": None, "corrected_max_rel_error": None, "max_rel_error": met.away}
    return row | nothing | {"verdict": "wrong", "claim": "what its description says", "note": why}


def _unconverted(tree: Node) -> Node:
    """A formula without factors that turn one unit into another, which a description leaves to its words."""
    return trees.substitute(tree, _without_units)


def _without_units(node: Node) -> Node | None:
    if not trees.is_operation(node, ast.Mult, ast.Div):
        return None
    number = 1.0
    rest: Node = node
    above: list[Node] = []
    below: list[Node] = []
    while trees.is_operation(rest, ast.Mult, ast.Div):
        over = isinstance(rest.op, ast.Div)
        value = _number(rest.right)
        if value is None:
            (below if over else above).append(rest.right)
        else:
            number *= 1 / value if over else value
        rest = rest.left
    first = _number(rest)
    number *= 1.0 if first is None else first
    above += [rest] if first is None else []
    if not above or not any(math.isclose(number, unit, rel_tol=1e-5) for unit in _CONVERSIONS):
        return None
    product, *others = [_unconverted(one) for one in reversed(above)]
    for one in others:
        product = trees.binary(ast.Mult, product, one)
    for one in below:
        product = trees.binary(ast.Div, product, _unconverted(one))
    return product


def _number(node: Node) -> float | None:
    value = math.pi if isinstance(node, ast.Name) and node.id == "pi" else trees.value_of(node)
    return None if not value else float(value)


def _scaled(own: Node, theirs: Node) -> bool:
    """Whether a function turns temperatures to another scale, which its description leaves to its words."""
    added, described = (
        {trees.value_of(side) for _, n in trees.walk(tree) if trees.is_operation(n, ast.Add, ast.Sub)
         for side in (n.left, n.right)} for tree in (own, theirs)
    )  # fmt: skip
    return bool((added - described) & _ZEROS)

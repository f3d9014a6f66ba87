"""The table of slips: rewrite rules from what is printed to what was meant, tried in the equal forms of every part.

a, b, c are any parts, f any function, n a number, x a letter; `+` stands for plus and for minus, the same on both sides
of a rule, and `-` for the other one; so do `*` and `/`. `@` is times only, `//` by only. On the right alone, `alike` is
a letter that x may be taken for, `pure` a pure number of the theory, `turned` an angle, `known` any letter. A rule that
reads `<->` holds both ways.
"""

import ast
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib import resources
from itertools import combinations

from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.tree import (
    Node,
    Path,
    argument_of,
    at,
    binary,
    call,
    children,
    digest,
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
from mechsym.audit.repair.edits import (
    Edit,
    Spot,
    chained,
    is_exponent,
    is_product,
    is_term,
    places,
    scaled,
    without_double_signs,
)
from mechsym.quantities import record

# kind; where it is tried: `wide` when nothing else mends the formula, `alike` at all parts that say the same at once,
# `all` at all places at once; and the rules
TABLE = (resources.files("mechsym.audit.repair") / "rules.txt").read_text(encoding="utf-8")
# what a slip of a kind costs to tell, of the table's and of other kinds; a symbol that it brings costs more [bits]
BITS = {
    "sign": 0, "factor": 1, "argument": 1, "number": 1, "unit": 2, "letter": 3, "sine and cosine": 3, "power": 4,
    "bracket": 5, "squares": 5, "operator": 5, "degrees": 5, "left out": 6, "put back": 6, "root": 7,
    "inverted": 8, "angle": 8, "everywhere": 9,
}  # fmt: skip
SYMBOL, OPERATION, DIGIT = 4.0, 2.0, 3.3  # what a letter or a function costs, an operation, a digit [bits]
_LONGEST = 7  # sum or product of which every run is tried
CIRCULAR = ("sin", "cos", "tan")
_EXACT = {ast.MatMult: ast.Mult, ast.FloorDiv: ast.Div, ast.Pow: ast.Pow}
_OTHER = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult}
_FAMILY = {ast.Add: "+", ast.Sub: "+", ast.Mult: "*", ast.Div: "*"}
_WORDS = ("alike", "pure", "turned", "known")
_HOW = {"wide", "alike", "all"}


def length(tree: Node) -> float:
    """Length of the description of a formula, if nothing is known of it [bits]."""
    return _told(symbols(tree)) + OPERATION * sum(isinstance(n, ast.BinOp) for _, n in walk(tree))


def symbols(tree: Node) -> Counter[str]:
    """Letters, numbers and functions of an expression."""
    return Counter(function_of(n) or to_python(n) for _, n in walk(tree) if not children(n) or isinstance(n, ast.Call))


def description(tree: Node, edit: Edit) -> float:
    """Length of the description of a slip: its kind, and the symbols that it lost or that it brought [bits]."""
    new, old = symbols(edit.new), symbols(at(tree, edit.path))
    brought, lost = (Counter(dict.fromkeys(d, 1)) if edit.about else d for d in (new - old, old - new))
    if edit.kind == "degrees":  # a kind that tells its numbers
        brought, lost = (Counter({k: n for k, n in d.items() if k not in ("pi", "180")}) for d in (brought, lost))
    return BITS[edit.kind] + max(_told(brought), _told(lost))


def _told(words: Counter[str]) -> float:
    # a long number has more to tell than a letter
    return sum(count * max(SYMBOL, DIGIT * sum(map(str.isdigit, k)) * k[0].isdigit()) for k, count in words.items())


@record
class Rule:
    """One row of the table, one way."""

    kind: str
    where: frozenset[str]
    printed: Node
    meant: tuple[Node, ...]


@record
class Words:
    """What a theory knows that a rule may bring in."""

    alike: Callable[[str], Sequence[str]] = lambda _: ()  #: Letters that one may be taken for
    kind: Callable[[str], object] = lambda _: None  #: Dimension of a letter
    is_pure: Callable[[str], bool] = lambda _: False
    pure: Sequence[str] = ()
    turned: Sequence[str] = ()
    known: Sequence[str] = ()


def _rules() -> Iterator[Rule]:
    for line in TABLE.strip().splitlines():
        kind, where, texts = (part.strip() for part in line.split("|"))
        for text in texts.split(";"):
            left, right = text.replace("<->", "->").split("->")
            printed, *meant = (ast.parse(t.strip(), mode="eval").body for t in [left, *right.split(" , ")])
            yield Rule(kind=kind, where=frozenset(where.split()), printed=printed, meant=tuple(meant))
            if "<->" in text:
                yield Rule(kind=kind, where=frozenset(where.split()), printed=meant[0], meant=(printed,))


RULES = tuple(_rules())


def _head(node: Node) -> str:
    # what a rule and a part must have in common
    if isinstance(node, ast.BinOp):
        return _FAMILY.get(_EXACT.get(type(node.op), type(node.op)), "**")
    return "f" if isinstance(node, ast.Call) else ""


_BY_HEAD = {head: [r for r in RULES if _head(r.printed) in ("", head)] for head in ("+", "*", "**", "f", "")}
Bound = dict[str, Node | bool]


def _matches(rule: Node, node: Node, bound: Bound) -> bool:
    if isinstance(rule, ast.Name):
        if rule.id == "pi":
            return isinstance(node, ast.Name) and node.id == "pi"
        if rule.id == "n" and value_of(node) is None or rule.id == "x" and not isinstance(node, ast.Name):
            return False
        same = bound.setdefault(rule.id, node)
        return isinstance(same, ast.expr) and digest(same) == digest(node)
    if isinstance(rule, ast.Constant):
        return value_of(node) == rule.value
    if isinstance(rule, ast.Call):
        argument, function = argument_of(node), function_of(rule)
        if argument is None or function not in ("f", function_of(node)):
            return False
        bound["f"] = name(str(function_of(node)))
        return _matches(rule.args[0], argument, bound)
    if not isinstance(rule, ast.BinOp) or not isinstance(node, ast.BinOp):
        return False
    if type(rule.op) in _EXACT:
        fits = type(node.op) is _EXACT[type(rule.op)]
    else:
        family, turned = _FAMILY[type(rule.op)], type(node.op) is not type(rule.op)
        fits = _FAMILY.get(type(node.op)) == family and bound.setdefault(family, turned) == turned
    return fits and _matches(rule.left, node.left, bound) and _matches(rule.right, node.right, bound)


def _meant(rule: Node, bound: Bound) -> Node:
    if isinstance(rule, ast.Name):
        return bound.get(rule.id, rule)  # type: ignore[return-value]
    if isinstance(rule, ast.Call):
        return call(to_python(_meant(rule.func, bound)), _meant(rule.args[0], bound))
    if isinstance(rule, ast.UnaryOp):
        return negative(_meant(rule.operand, bound))
    if not isinstance(rule, ast.BinOp):
        return rule
    operator = _EXACT.get(type(rule.op), type(rule.op))
    if type(rule.op) in _OTHER and bound.get(_FAMILY[type(rule.op)]):
        operator = _OTHER[operator]
    return _plain(operator, _meant(rule.left, bound), _meant(rule.right, bound))


def _plain(operator: type[ast.operator], left: Node, right: Node) -> Node:
    """An operation of which the numbers are computed."""
    one, other = value_of(left), value_of(right)
    if operator is ast.Pow:
        return left if other == 1 else number(1) if other == 0 else binary(operator, left, right)
    if operator in (ast.Add, ast.Sub):
        if one is not None and other is not None:
            return number(one + other if operator is ast.Add else one - other)
        return binary(operator, left, right) if one != 0 else right if operator is ast.Add else negative(right)
    if operator is ast.Mult and 0 in (one, other):
        return number(0)
    if one is not None and operator is ast.Mult:
        return scaled(right, one)
    if other and (one is None or one != 1 or operator is ast.Mult):
        return scaled(left, other if operator is ast.Mult else 1 / other)
    return binary(operator, left, right)


_SUM, _PRODUCT = (ast.Add, ast.Sub), (ast.Mult, ast.Div)
Run = list[tuple[bool, Node]]  # terms or factors, each with whether it is added or multiplied


@record
class Regrouped:
    """A part in one of its equal forms."""

    place: Spot
    node: Node
    where: frozenset[str]
    around: tuple[Run, bool, Run] | None = None  #: What stands before and after a run, and whether the run is added

    def instead(self, new: Node) -> Node:
        """What stands at the place with a new part."""
        if self.around is None:
            return new
        before, first, after = self.around
        family = _SUM if is_operation(self.place.node, *_SUM) else _PRODUCT
        return _joined([*before, *_parts(new, family, first), *after], family)


def forms(tree: Node, wide: bool) -> Iterator[Regrouped]:
    """Every part of a formula as it is printed, and runs of sums and products with brackets moved about."""
    for place in places(tree):
        yield Regrouped(place=place, node=place.node, where=_where(place))
        for family, top in ((_SUM, is_term(place)), (_PRODUCT, is_product(place) or is_term(place))):
            if not is_operation(place.node, *family) or not top:
                continue
            parts = _parts(place.node, family)
            if not wide or len(parts) <= _LONGEST:
                yield from _regrouped(place, parts, family, wide)


def _regrouped(place: Spot, parts: Run, family: tuple[type[ast.operator], ...], wide: bool) -> Iterator[Regrouped]:
    for start in range(len(parts)):
        for end in range(start + 2, len(parts) + 1 if wide else min(start + 3, len(parts) + 1)):
            first = parts[start][0]
            inside = [(sign == first, part) for sign, part in parts[start:end]]
            around = parts[:start], first, parts[end:]
            words = {"anywhere"} | ({"sum"} if family is _SUM else {"factors", "plain"}) if wide else {"anywhere"}
            for cut in range(1, len(inside)) if wide else ([1] if start else []):
                plus = inside[cut][0]
                last = _joined([(sign == plus, part) for sign, part in inside[cut:]], family)
                node = binary(family[not plus], _joined(inside[:cut], family), last)
                yield Regrouped(place=place, node=node, where=frozenset(words), around=around)


def _where(place: Spot) -> frozenset[str]:
    node, parent = place.node, place.parent
    angle = parent is not None and function_of(parent) in CIRCULAR
    summed = parent is not None and is_operation(parent, *_SUM) and place.path[-1] == "left"
    power, exponent = parent is not None and is_operation(parent, ast.Pow), is_exponent(place)
    single = not isinstance(node, (ast.Constant, ast.UnaryOp)) and not is_operation(node, *_PRODUCT, ast.Pow)
    words = {
        "anywhere": True,
        "lead": parent is None or summed and not is_operation(node, *_SUM) or exponent,
        "product": is_product(place) and not isinstance(node, ast.UnaryOp) and not angle,
        "angle": angle and not isinstance(node, ast.UnaryOp),
        "whole": isinstance(node, ast.Constant) and isinstance(node.value, int) and not exponent,
        "factor": single and not power,
        "base": (isinstance(node, ast.Name) or is_operation(node, *_SUM, ast.Div)) and not power,
        "plain": not exponent and value_of(node) is None and not isinstance(node, (ast.UnaryOp, ast.Compare)),
        "pure": isinstance(node, ast.Name) and node.id != "pi",
        "inner": bool(children(node)) and value_of(node) is None,
    }
    return frozenset(k for k, holds in words.items() if holds)


def rewritten(form: Regrouped, words: Words, wide: bool = False) -> Iterator[tuple[str, Node]]:
    """What may have been meant by a part: the kind of the slip, and what stands at the place of the form without it."""
    for rule in _BY_HEAD[_head(form.node)]:
        widely = "wide" in rule.where
        if rule.kind == "everywhere" or widely and not wide or wide and not widely and form.around is None:
            continue
        if rule.where - _HOW <= form.where:
            for new in _applied(rule, form.node, words):
                yield rule.kind, form.instead(new)


def _applied(rule: Rule, node: Node, words: Words) -> Iterator[Node]:
    bound: Bound = {}
    if not _matches(rule.printed, node, bound):
        return
    letter = node.id if isinstance(node, ast.Name) else ""
    if "pure" in rule.where and not words.is_pure(letter):
        return
    for meant in rule.meant:
        wanted = next((k for k in _WORDS if k in letters(meant)), "")
        brought = words.alike(letter) if wanted == "alike" else getattr(words, wanted) if wanted else [""]
        for word in brought:
            new = _meant(meant, {**bound, wanted: name(word)})
            if "whole" not in rule.where or (value_of(new) or 0) > 0:
                yield new


def listed_edits(tree: Node, words: Words, wide: bool = False) -> list[Edit]:
    """Slips of one place, or the wider ones, of several parts at once; some give the same function."""
    edits: dict[tuple[Path, bytes], Edit] = {}
    for form in forms(tree, wide):
        for kind, new in rewritten(form, words, wide):
            edits.setdefault((form.place.path, digest(new)), Edit(kind=kind, path=form.place.path, new=new))
    return [*edits.values()]


def repeated_edits(tree: Node, words: Words, wide: bool = False) -> list[Edit]:
    """One slip wherever the same part stands, and one rule at all of its places."""
    parts = {p.node: p for p in places(tree)}
    counts = Counter(map(digest, parts))
    first = {said: node for node in reversed(parts) if counts[said := digest(node)] > 1}
    edits = []
    for rule in RULES:
        if ("wide" in rule.where) is not wide:
            continue
        if "alike" in rule.where:
            for said, node in first.items():
                if rule.where - _HOW <= _where(parts[node]):
                    for new in _applied(rule, node, words):
                        instead = {n: new for n in parts if digest(n) == said}
                        about = f"{to_python(node)} becomes {to_python(new)} in {counts[said]} places"
                        edits.append(_everywhere(tree, instead, about))
        if "all" in rule.where:
            fitting = [n for n, p in parts.items() if rule.where - _HOW <= _where(p)]
            news = {n: [*_applied(rule, n, words)] for n in fitting}
            for k in range(len(rule.meant)):
                instead = {n: new[k] for n, new in news.items() if len(new) > k}
                if len(instead) > 1:
                    old, changed = map(to_python, next(iter(instead.items())))
                    shown = f"{old} becomes {changed}, in {len(instead)} places alike"
                    edits.append(_everywhere(tree, instead, shown))
    return edits


def _everywhere(tree: Node, instead: Mapping[Node, Node], about: str) -> Edit:
    new = without_double_signs(substitute(tree, instead.get))
    return Edit(kind="everywhere", path=(), new=new, about=about)


def exchanged_edits(tree: Node, kind: Callable[[str], object]) -> Iterator[Edit]:
    """Two letters for each other that are of one kind."""
    kinds = {k: kind(k) for k in letters(tree) if k != "pi"}
    for one, other in combinations(kinds, 2):
        if kinds[one] is not None and kinds[one] == kinds[other]:
            both = {one: name(other), other: name(one)}
            new = substitute(tree, lambda n, both=both: both.get(to_python(n)))  # type: ignore[misc]
            yield Edit(kind="everywhere", path=(), new=new, about=f"{one} and {other} are taken for each other")


def _parts(node: Node, family: tuple[type[ast.operator], ...], first: bool = True) -> Run:
    # terms of a sum or factors of a product, through brackets of the same kind
    if not is_operation(node, *family):
        return [] if family is _PRODUCT and value_of(node) == 1 else [(first, node)]
    last = first == isinstance(node.op, family[0])
    return [*_parts(node.left, family, first), *_parts(node.right, family, last)]


def _joined(parts: Run, family: tuple[type[ast.operator], ...]) -> Node:
    # what is added or multiplied first, then the rest; a product has one fraction bar
    first, rest = ([part for sign, part in parts if sign == plus] for plus in (True, False))
    if family is _PRODUCT:
        above = chained(ast.Mult, first) if first else number(1)
        return binary(ast.Div, above, chained(ast.Mult, rest)) if rest else above
    return chained(ast.Sub, [chained(ast.Add, first), *rest]) if first else negative(chained(ast.Add, rest))

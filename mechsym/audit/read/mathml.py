"""Formulas as a book sets them: MathML of the tree that an author printed, and what a correction changes marked.

A computer algebra system would order the terms anew; here they stand as printed. A long formula is many pieces of
`<math>`, between which a line may break: its terms, and the factors of a term.
"""

import ast
import difflib
import html
import re
from collections.abc import Sequence

from mechsym.audit.read.lagrange import lagrange_equation
from mechsym.audit.read.reader import AnyLetter, read_expression
from mechsym.audit.read.slopes import slope_in
from mechsym.audit.read.spelling import ATOM, NAME, POWER, PRODUCT, SIDES, SUM, SYMBOLS
from mechsym.audit.read.statement import statement
from mechsym.audit.read.tree import Node, children, digest, function_of, name, substitute
from mechsym.errors import BadInput

_DOTS = {"d": "˙", "dd": "¨"}
_FUNCTIONS = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "log": "ln"}
_INDEXED = re.compile(r"\\?([A-Za-z]+)_\{?([A-Za-z0-9]+)\}?")
_ONE_PIECE = 60  # characters of a formula that stays on its line
Marks = frozenset[int]  # of nodes, by identity; the negative of one marks the sign before it
_NONE: Marks = frozenset()
SLIP = ' class="slip"'


def formula(text: str, marked: Marks = _NONE) -> str:
    """A formula in Python syntax or LaTeX as MathML; as text where it cannot be read."""
    tree = _read(text)
    return _whole(text, tree, marked)


def corrected(printed: str, correction: str) -> tuple[str, str]:
    """A formula as printed and as corrected, what differs marked in both: the smallest parts that do.

    >>> first, second = corrected("r*(1 + cos(phi))", "r*(1 - cos(phi))")
    >>> '<mo form="infix" class="slip">+</mo>' in first, '<mo form="infix" class="slip">−</mo>' in second
    (True, True)
    """
    first, second = _read(printed), _read(correction)
    marked = slips(first, second) if first is not None and second is not None else _NONE
    return _whole(printed, first, marked), _whole(correction, second, marked)


def slips(a: Node, b: Node) -> Marks:
    """The smallest parts in which two trees differ, in each; of two signs the signs alone."""
    if digest(a) == digest(b):
        return _NONE
    for chain in (_terms, _factors):
        if len(chain(a)) > 1 or len(chain(b)) > 1:
            return _aligned(chain(a), chain(b))
    inner = list(zip(children(a), children(b), strict=False))
    if not inner or _head(a) != _head(b) or len(children(a)) != len(children(b)):
        return frozenset((id(a), id(b)))
    return frozenset().union(*(slips(x, y) for (_, x), (_, y) in inner))


def _aligned(a: "Sequence[Signed]", b: "Sequence[Signed]") -> Marks:
    """What differs between two sums, or two products, whose common parts stand in the same order."""
    first, second = ([(sign, digest(node)) for sign, node in chain] for chain in (a, b))
    marked: Marks = _NONE
    for kind, low, high, start, end in difflib.SequenceMatcher(None, first, second, autojunk=False).get_opcodes():
        old, new = a[low:high], b[start:end]
        if kind == "equal":
            continue
        if len(old) != len(new):
            marked |= {id(node) for _, node in (*old, *new)}
            continue
        for (sign, x), (other, y) in zip(old, new, strict=True):
            marked |= slips(x, y) | (_NONE if sign == other else {_signed(sign, x), _signed(other, y)})
    return marked


def _signed(sign: str, node: Node) -> int:
    """The mark of a sign; of one that is not printed that of its term."""
    return -id(node) if sign else id(node)


def _head(node: Node) -> tuple[object, ...]:
    return type(node), function_of(node), type(getattr(node, "op", None))


Signed = tuple[str, Node]


def _terms(node: Node) -> list[Signed]:
    """The terms of a sum with their signs."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Add, ast.Sub)):
        return [*_terms(node.left), ("+" if isinstance(node.op, ast.Add) else "−", node.right)]
    return [("−", node.operand)] if isinstance(node, ast.UnaryOp) else [("", node)]


def _factors(node: Node) -> list[Signed]:
    """The factors of a product."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
        return [*_factors(node.left), ("", node.right)]
    return [("", node)]


def _read(text: str) -> Node | None:
    try:
        tree, spelled = read_expression(statement(text).right[-1], (), AnyLetter())
    except (BadInput, IndexError):
        return None
    # l_{c2} where its plain name does not tell the index
    apart = {k: m for k, v in spelled.items() if NAME.fullmatch(k) is None and (m := _INDEXED.fullmatch(v.strip()))}
    return substitute(
        tree,
        lambda n: name(f"{apart[n.id][1]}_{apart[n.id][2]}") if isinstance(n, ast.Name) and n.id in apart else None,
    )


def _whole(text: str, tree: Node | None, marked: Marks) -> str:
    left = statement(text).left if tree is not None else ""
    lead = _read(left) if left else None
    if tree is None or left and lead is None or lagrange_equation(text):
        return f"<code>{html.escape(text)}</code>"
    parts = [*([_set(lead, marked)[0] + _operator("=")] if lead is not None else [])]
    parts += _pieces(tree, marked) if len(text) > _ONE_PIECE else [_set(tree, marked)[0]]
    shown = "&#8203;".join(f"<math>{part}</math>" for part in parts)  # where a line may break
    return f'<span class="formula" role="img" aria-label="{html.escape(text)}">{shown}</span>'


def _pieces(node: Node, marked: Marks) -> list[str]:
    """Pieces between which a line may break: terms, factors, and those of a sum in brackets."""
    if id(node) in marked:
        return [_set(node, marked)[0]]
    if len(terms := _terms(node)) > 1 or isinstance(node, ast.UnaryOp):
        rows = [(_sign(sign, term, marked, i > 0), _term(term, marked)) for i, (sign, term) in enumerate(terms)]
        return [piece for sign, pieces in rows for piece in (sign + pieces[0], *pieces[1:])]
    return _term(node, marked)


def _term(node: Node, marked: Marks) -> list[str]:
    if id(node) in marked or len(_terms(node)) > 1:
        return _in_brackets(node, marked)
    pieces: list[str] = []
    before: Node | None = None
    for _, factor in _factors(node):
        own = [_factor(factor, True, marked)] if before is None and _signs(factor) else _in_brackets(factor, marked)
        pieces += [_between(before, factor) + own[0], *own[1:]]
        before = factor
    return pieces


def _in_brackets(node: Node, marked: Marks) -> list[str]:
    """A factor in pieces: a sum in brackets of the height of a line."""
    if id(node) in marked or len(_terms(node)) < 2:
        return [_at_least(node, POWER, marked)]
    inner = _pieces(node, marked)
    inner[0] = '<mo stretchy="false">(</mo>' + inner[0]
    inner[-1] += '<mo stretchy="false">)</mo>'
    return inner


def _factor(node: Node, first: bool, marked: Marks) -> str:
    """A factor; the sign of the first needs no bracket."""
    return _at_least(node, SUM if first and _signs(node) else POWER, marked)


def _signs(node: Node) -> bool:
    return isinstance(node, ast.UnaryOp)


def _set(node: Node, marked: Marks) -> tuple[str, int]:
    """MathML of a node and how tightly it binds."""
    text, level = _plain(node, marked)
    return (f'<mrow class="slip">{text}</mrow>' if id(node) in marked else text), level


def _plain(node: Node, marked: Marks) -> tuple[str, int]:
    if isinstance(node, ast.Name):
        return letter(node.id), ATOM
    if isinstance(node, ast.Constant):
        return _number(str(node.value))
    if isinstance(node, ast.Call):
        return _call(str(function_of(node)), node.args[0], marked), ATOM
    if isinstance(node, ast.IfExp):
        cells = [(_set(node.body, marked)[0], _set(node.test, marked)[0]), (_set(node.orelse, marked)[0], "")]
        rows = "".join(f"<mtr><mtd>{a}</mtd><mtd>{b or '<mtext>else</mtext>'}</mtd></mtr>" for a, b in cells)
        return f'<mrow><mo>{{</mo><mtable columnalign="left">{rows}</mtable></mrow>', ATOM
    if isinstance(node, ast.Compare):
        left, right = (_set(n, marked)[0] for n in (node.left, node.comparators[0]))
        return left + _operator(SIDES[type(node.ops[0])]) + right, SUM
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div):
        above, below = (f"<mrow>{_set(n, marked)[0]}</mrow>" for n in (node.left, node.right))
        return f"<mfrac>{above}{below}</mfrac>", ATOM
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
        return _power(node, marked), POWER
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
        chain = [factor for _, factor in _factors(node)]
        parts = (_between(b, f) + _factor(f, b is None, marked) for b, f in zip([None, *chain], chain, strict=False))
        return "".join(parts), SUM if isinstance(chain[0], ast.UnaryOp) else PRODUCT
    terms = enumerate(_terms(node))
    return "".join(_sign(sign, t, marked, i > 0) + _at_least(t, PRODUCT, marked) for i, (sign, t) in terms), SUM


_CHANGE = re.compile(r"Delta(\w+)")


def letter(name: str) -> str:
    """A plain name as MathML: Greek letters, an index, dots of a rate.

    >>> letter("phi0d")
    '<msub><mover><mi>φ</mi><mo>˙</mo></mover><mn>0</mn></msub>'
    """
    if slope := slope_in(name):
        d, by = "<mi>d</mi>", letter(slope.by)
        if slope.order > 1:
            d, by = (f"<msup>{part}<mn>{slope.order}</mn></msup>" for part in (d, by))
        return f"<mfrac><mrow>{d}{letter(slope.of)}</mrow><mrow><mi>d</mi>{by}</mrow></mfrac>"
    match = NAME.fullmatch(name)
    if match is None and (change := _CHANGE.fullmatch(name)):
        return f"<mrow><mi>Δ</mi>{letter(change[1])}</mrow>"
    if match is None:
        base, _, index = name.partition("_")
        words = html.escape(index.replace("_", " "))
        return (
            f"<msub><mi>{html.escape(SYMBOLS.get(base, base))}</mi><mtext>{words}</mtext></msub>"
            if index
            else f"<mi>{base}</mi>"
        )
    stem, index, dots = match["stem"], match["digits"] or match["word"], match["dots"]
    base = f"<mi>{SYMBOLS.get(stem, stem)}</mi>"
    base = f"<mover>{base}<mo>{_DOTS[dots]}</mo></mover>" if dots else base
    kind = "mn" if index and index.isdigit() else "mi"
    return f"<msub>{base}<{kind}>{index}</{kind}></msub>" if index else base


def _number(text: str) -> tuple[str, int]:
    mantissa, exponential, exponent = text.partition("e")
    if not exponential:
        return f"<mn>{text}</mn>", ATOM
    power = f"<msup><mn>10</mn><mn>{int(exponent)}</mn></msup>".replace("-", "−")
    return f"<mn>{mantissa}</mn>{_operator('·')}{power}", PRODUCT


def _call(function: str, argument: Node, marked: Marks, power: str = "") -> str:
    inner, level = _set(argument, marked)
    if function == "sqrt":
        return f"<msqrt>{inner}</msqrt>"
    if function == "abs":
        return f"<mrow><mo>|</mo>{inner}<mo>|</mo></mrow>"
    name = "<mo>∑</mo>" if function == "sum" else f"<mi>{_FUNCTIONS.get(function, function)}</mi>"
    name = f"<msup>{name}{power}</msup>" if power else name
    bare = level == ATOM and isinstance(argument, ast.Name)
    return f"<mrow>{name}<mo>&#8289;</mo>{inner if bare else _bracketed(inner)}</mrow>"


def _power(node: ast.BinOp, marked: Marks) -> str:
    exponent, base, called = f"<mrow>{_set(node.right, marked)[0]}</mrow>", node.left, function_of(node.left)
    whole = isinstance(node.right, ast.Constant) and id(base) not in marked
    if isinstance(base, ast.Call) and called not in ("sqrt", "abs", "sum") and whole:
        return _call(str(called), base.args[0], marked, exponent)
    simple = isinstance(base, (ast.Name, ast.Constant)) or called in ("sqrt", "abs")
    inner = _set(base, marked)[0]
    return f"<msup><mrow>{inner if simple else _bracketed(inner)}</mrow>{exponent}</msup>"


def _at_least(node: Node, level: int, marked: Marks) -> str:
    text, tightness = _set(node, marked)
    return text if tightness >= level else _bracketed(text)


def _bracketed(inner: str) -> str:
    return f"<mrow><mo>(</mo>{inner}<mo>)</mo></mrow>"


def _sign(sign: str, node: Node, marked: Marks, second: bool) -> str:
    return _operator(sign, -id(node) in marked).replace("infix", "infix" if second else "prefix") if sign else ""


def _operator(sign: str, slip: bool = False) -> str:
    # by itself an operator that begins a piece would have no space around it
    return f'<mo form="infix"{SLIP if slip else ""}>{html.escape(sign)}</mo>'


def _between(before: Node | None, after: Node) -> str:
    """What stands between two factors: a dot where two numbers would be read as one."""
    if before is None:
        return ""
    numbers = isinstance(after, ast.Constant) or function_of(before) is not None and isinstance(after, ast.Name)
    return _operator("·") if numbers else "<mo>&#8290;</mo>"


STYLE = (
    ".formula{display:block;max-width:100%;overflow-x:auto;overflow-y:hidden;line-height:2.4}"
    ".slip{background:#f2b8b5;padding:.15em .2em;color:#7a0b0b;outline:1px solid #b5342b;print-color-adjust:exact}"
    "@media print{.formula{overflow:visible;font-size:.85em}}"
)

"""Slips of authors, typesetters and programmers, made on the text of a formula.

Written from lists of errata, not from the auditor: nothing of mechsym.audit is imported here, so that what the repair
search tries and what it is tried on have no common code. Works on Python text and gives Python text.
"""

import ast
import copy
import random
from collections.abc import Callable, Iterator, Mapping

KINDS = (
    "sign", "factor", "bracket", "exponent", "inverse", "sine and cosine", "lost square", "lost factor",
    "swapped letter", "degrees", "lost term", "lost root",
)  # fmt: skip
_FACTORS = ("2", "1/2", "3", "4")


def slips(text: str, alike: Mapping[str, str]) -> dict[str, list[str]]:
    """Every slip of every kind; `alike` maps a letter to letters it is mistaken for, separated by spaces."""
    makers: dict[str, Callable[[ast.expr], Iterator[ast.expr]]] = {
        "sign": _sign, "factor": _factor, "bracket": _bracket, "exponent": _exponent, "inverse": _inverse,
        "sine and cosine": _sine, "lost square": _square, "lost factor": _lost_factor, "degrees": _degrees,
        "lost term": _lost_term, "lost root": _root,
        "swapped letter": lambda node: _letter(node, alike),
    }  # fmt: skip
    found = {kind: list(dict.fromkeys(_everywhere(text, makers[kind]))) for kind in KINDS}
    return {kind: [t for t in texts if t != ast.unparse(ast.parse(text))] for kind, texts in found.items()}


def one(text: str, alike: Mapping[str, str], generator: random.Random, kind: str = "") -> tuple[str, str] | None:
    """One slip at random: its kind and the spoiled text; None where the kind does not apply."""
    found = {k: t for k, t in slips(text, alike).items() if t and kind in ("", k)}
    if not found:
        return None
    chosen = generator.choice(sorted(found))
    return chosen, generator.choice(found[chosen])


def _everywhere(text: str, make: Callable[[ast.expr], Iterator[ast.expr]]) -> Iterator[str]:
    tree = ast.parse(text, mode="eval")
    spots = [node for node in ast.walk(tree) if isinstance(node, ast.expr) and not isinstance(node, ast.Load)]
    for index, node in enumerate(spots):
        for new in make(node):
            fresh = copy.deepcopy(tree)
            twin = [n for n in ast.walk(fresh) if isinstance(n, ast.expr) and not isinstance(n, ast.Load)][index]
            yield ast.unparse(_Put(twin, copy.deepcopy(new)).visit(fresh))


class _Put(ast.NodeTransformer):
    """Puts one node in the place of another."""

    def __init__(self, old: ast.expr, new: ast.expr) -> None:
        self.old, self.new = old, new

    def visit(self, node: ast.AST) -> ast.AST:
        """The new node for the old one, everything else as it is."""
        return self.new if node is self.old else self.generic_visit(node)


def _is(node: ast.AST, *operators: type[ast.operator]) -> bool:
    return isinstance(node, ast.BinOp) and isinstance(node.op, operators)


def _make(operator: type[ast.operator], left: ast.expr, right: ast.expr) -> ast.BinOp:
    return ast.BinOp(left=left, op=operator(), right=right)


def _text(text: str) -> ast.expr:
    return ast.parse(text, mode="eval").body


def _sign(node: ast.expr) -> Iterator[ast.expr]:
    if _is(node, ast.Add, ast.Sub):
        yield _make(ast.Sub if _is(node, ast.Add) else ast.Add, node.left, node.right)  # type: ignore[attr-defined]
    if isinstance(node, ast.UnaryOp):
        yield node.operand


def _factor(node: ast.expr) -> Iterator[ast.expr]:
    if isinstance(node, ast.Constant) and isinstance(node.value, int):
        yield from (ast.Constant(value=n) for n in (2 * node.value, 3 * node.value, node.value + 1))
    if _is(node, ast.Add, ast.Sub):
        yield from (_make(type(node.op), node.left, _make(ast.Mult, _text(f), node.right)) for f in _FACTORS)  # type: ignore[attr-defined]


def _bracket(node: ast.expr) -> Iterator[ast.expr]:
    if not isinstance(node, ast.BinOp):
        if isinstance(node, ast.Call) and _is(node.args[0], ast.Add, ast.Sub):
            inner = node.args[0]
            yield _make(type(inner.op), ast.Call(node.func, [inner.left], []), inner.right)  # type: ignore[attr-defined]
        return
    if _is(node, ast.Mult, ast.Div) and _is(node.left, ast.Add, ast.Sub):
        yield _make(type(node.left.op), node.left.left, _make(type(node.op), node.left.right, node.right))  # type: ignore[attr-defined]
    if _is(node, ast.Mult, ast.Div) and _is(node.right, ast.Add, ast.Sub):
        yield _make(type(node.right.op), _make(type(node.op), node.left, node.right.left), node.right.right)  # type: ignore[attr-defined]
    if _is(node, ast.Pow) and _is(node.left, ast.Mult, ast.Div, ast.Add, ast.Sub):
        yield _make(type(node.left.op), node.left.left, _make(ast.Pow, node.left.right, node.right))  # type: ignore[attr-defined]


def _exponent(node: ast.expr) -> Iterator[ast.expr]:
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow) and isinstance(node.right, ast.Constant):
        value = node.right.value
        assert isinstance(value, (int, float))
        yield _make(ast.Pow, node.left, ast.Constant(value=value + 1))


def _square(node: ast.expr) -> Iterator[ast.expr]:
    if _is(node, ast.Pow):
        yield node.left  # type: ignore[attr-defined]


def _inverse(node: ast.expr) -> Iterator[ast.expr]:
    if _is(node, ast.Div):
        yield _make(ast.Mult, node.left, node.right)  # type: ignore[attr-defined]
        yield _make(ast.Div, node.right, node.left)  # type: ignore[attr-defined]


def _sine(node: ast.expr) -> Iterator[ast.expr]:
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("sin", "cos"):
        other = "cos" if node.func.id == "sin" else "sin"
        yield ast.Call(ast.Name(other, ast.Load()), node.args, [])


def _lost_factor(node: ast.expr) -> Iterator[ast.expr]:
    if _is(node, ast.Mult):
        yield node.left  # type: ignore[attr-defined]
        yield node.right  # type: ignore[attr-defined]
    if _is(node, ast.Div):
        yield node.left  # type: ignore[attr-defined]


def _letter(node: ast.expr, alike: Mapping[str, str]) -> Iterator[ast.expr]:
    if isinstance(node, ast.Name):
        yield from (ast.Name(other, ast.Load()) for other in alike.get(node.id, "").split())


def _degrees(node: ast.expr) -> Iterator[ast.expr]:
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("sin", "cos", "tan"):
        yield from (ast.Call(node.func, [_make(ast.Mult, node.args[0], _text(f))], []) for f in ("pi/180", "180/pi"))


def _lost_term(node: ast.expr) -> Iterator[ast.expr]:
    if _is(node, ast.Add, ast.Sub):
        yield node.left  # type: ignore[attr-defined]
        yield node.right  # type: ignore[attr-defined]


def _root(node: ast.expr) -> Iterator[ast.expr]:
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "sqrt":
        yield node.args[0]

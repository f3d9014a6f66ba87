"""Edits that put back a term or a factor that was left out."""

import ast
from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Any, TypeGuard

from mechsym.audit.bench import Bench
from mechsym.audit.edits import Edit, Spot, is_product, is_term, places, scaled
from mechsym.audit.insertion import Product, Vocabulary, Words, product, product_tree
from mechsym.audit.required import Required, quotient
from mechsym.audit.tree import Node, Path, binary, children, is_operation, negative, value_of, walk


def insertions(
    asked: Bench, tree: Node, wishes: Required, memo: Mapping[Node, Any], words: Vocabulary
) -> Iterator[Edit]:
    """Terms and factors that would make a part of the formula what it is required to be.

    Parameters
    ----------
    words : Vocabulary
        What missing terms and factors may be made of
    """
    # what is put back must not be more than what stands there, or any formula could be mended
    most = sum(not children(p.node) for p in places(tree))
    nodes = {p.path: p.node for p in places(tree)}
    for place in places(tree):
        if place.path not in wishes or value_of(place.node) is not None and not _is_bare(place):
            continue
        wish, old = wishes[place.path], memo[place.node]
        if is_product(place):
            yield from lost_factor(nodes, place, product(asked, words, quotient(asked, wish, old)), most)
        if is_term(place):
            yield from lost_term(place, product(asked, words, wish - old), most)


def _is_bare(place: Spot) -> bool:
    # a number that is a term of its own may have lost a letter
    return place.parent is not None and is_operation(place.parent, ast.Add, ast.Sub)


def lost_factor(nodes: Mapping[Path, Node], place: Spot, found: Product | None, most: int) -> Iterator[Edit]:
    """A factor put back, where it is one."""
    if _is_little(found, most) and not _cancels(nodes, place.path, found[1]):
        yield Edit(kind="put back", path=place.path, new=_times(place.node, *found))


def lost_term(place: Spot, found: Product | None, most: int) -> Iterator[Edit]:
    """A term put back, where it is one."""
    if _is_little(found, most):
        yield Edit(kind="put back", path=place.path, new=_plus(place.node, *found))


def _is_little(found: Product | None, most: int) -> TypeGuard[Product]:
    return found is not None and 1 <= len(found[1]) and sum(_leaves(word) for word, _ in found[1]) <= most


def _leaves(node: Node) -> int:
    return sum(not children(below) for _, below in walk(node))


def _cancels(nodes: Mapping[Path, Node], path: Path, used: Words) -> bool:
    # R*R times sin(phi)/R puts nothing back: it takes an R away
    top, above = path, True
    while top and is_operation(nodes[top[:-1]], ast.Mult, ast.Div):
        above ^= top[-1] == "right" and is_operation(nodes[top[:-1]], ast.Div)
        top = top[:-1]
    factors = {a: {ast.dump(f) for f in _factors(nodes[top], a)} for a in (True, False)}
    return any(ast.dump(word) in factors[(exponent < 0) == above] for word, exponent in used)


def _factors(node: Node, above: bool) -> Iterator[Node]:
    if is_operation(node, ast.Mult, ast.Div):
        assert isinstance(node, ast.BinOp)
        yield from _factors(node.left, above)
        yield from _factors(node.right, above == isinstance(node.op, ast.Mult))
    elif above:
        yield node.left if is_operation(node, ast.Pow) else node  # type: ignore[attr-defined]


def _times(node: Node, factor: Fraction, used: Words) -> Node:
    above = [(w, e) for w, e in used if e > 0]
    below = [(w, -e) for w, e in used if e < 0]
    new = scaled(negative(node) if factor < 0 else node, abs(factor))
    if above:
        new = binary(ast.Mult, new, product_tree(Fraction(1), above))
    return binary(ast.Div, new, product_tree(Fraction(1), below)) if below else new


def _plus(node: Node, factor: Fraction, used: Words) -> Node:
    return binary(ast.Sub if factor < 0 else ast.Add, node, product_tree(abs(factor), used))

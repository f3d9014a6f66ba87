"""An equation solved for the one letter that nothing has defined yet."""

import ast
import re
from collections import Counter

from mechsym.audit.read.tree import Node, argument_of, binary, call, function_of, is_operation, letters, walk

_FORCES = re.compile(r"[FMNTSQRK]\w*")
_INVERSE = {"sin": "asin", "tan": "atan", "asin": "sin", "acos": "cos", "atan": "tan", "exp": "log", "log": "exp"}


def targets(tree: Node, known: set[str], any_letter: bool) -> list[str]:
    """Letters that an expression may be solved for: what stands under a sine, and forces of a balance."""
    counts = Counter(n.id for _, n in walk(tree) if isinstance(n, ast.Name))
    under = [a.id for _, n in walk(tree) if isinstance(a := argument_of(n, "sin", "tan"), ast.Name)]
    forces = [n for n in counts if _FORCES.fullmatch(n) and is_operation(tree, ast.Add, ast.Sub)]
    chosen = list(counts) if any_letter else [*under, *forces]
    return [
        n for n in dict.fromkeys(chosen) if counts[n] == 1 and n not in known and n != "pi" and not n.endswith("dd")
    ]


def isolate(tree: Node, letter: str, other: Node) -> Node | None:
    """What a letter is where tree = other, None where it cannot be told: the letter stands in the tree once."""
    while not (isinstance(tree, ast.Name) and tree.id == letter):
        if isinstance(tree, ast.UnaryOp):
            tree, other = tree.operand, ast.UnaryOp(op=ast.USub(), operand=other)
        elif isinstance(tree, ast.Call) and (inverse := _INVERSE.get(str(function_of(tree)))):
            tree, other = tree.args[0], call(inverse, other)
        elif isinstance(tree, ast.BinOp) and not isinstance(tree.op, ast.Pow):
            inside = letter in letters(tree.left)
            part, rest = (tree.left, tree.right) if inside else (tree.right, tree.left)
            back = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult}[type(tree.op)]
            if not inside and isinstance(tree.op, (ast.Sub, ast.Div)):
                other = binary(type(tree.op), rest, other)
            else:
                other = binary(back, other, rest)
            tree = part
        else:
            return None
    return other

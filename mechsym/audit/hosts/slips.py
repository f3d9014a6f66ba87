"""One formula of a program that comes near to a quantity: what the auditor says of it, and whether that explains it."""

import ast
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from mechsym.audit.judge.asked import Asked, question_of
from mechsym.audit.judge.conventions import also_exact
from mechsym.audit.judge.lexicon import Fitted, Probes, at_rest, safe
from mechsym.audit.read import tree as trees
from mechsym.audit.read.programs.claims import base
from mechsym.audit.read.programs.statements import OF
from mechsym.audit.read.reader import Formula, statement
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.tree import Node, letters
from mechsym.audit.repair.examination import Repair
from mechsym.audit.row import Row, formula_row, unread_row
from mechsym.audit.theory.record import Theory
from mechsym.audit.verdict import PASSED, decide
from mechsym.errors import BadInput

_EXACT = 1e-9  # relative error of a correction that explains a formula: a limit of long rods does not [-]
_LARGEST = 120  # parts of a formula for which a slip is searched: the search is the one thing here that takes long


def asked_once(
    text: str, theory: Theory, quantity: str, own: Mapping[str, str], rest: Sequence[str], twice: bool = False
) -> tuple[Row, Repair | None]:
    """The row of a formula, of one slip at most, with its repair; twice: the same one may stand in both halves."""
    against = f"{theory.name}.{quantity}"
    try:
        assume = [f"{k} = 0" for k in rest if k in theory.letters]
        asked = Asked(text=text, against=against, letters=own, hidden="noted", given=theory, assume=assume)
        question = question_of(asked, statement(text))
        verdict = decide(question, one=not twice)
        if twice and verdict.repairs and len({edit.kind for edit in verdict.repairs[0].edits}) > 1:
            verdict = decide(question, one=True)
        right = also_exact(question) if verdict.verdict not in PASSED else ""
    except BadInput as error:
        return unread_row("", against, text, str(error)), None
    row = {"claim": against} | formula_row(question, verdict, text, "", "")
    if right:
        row |= {"verdict": "convention", "note": f"exact with {right}"}
    return row, verdict.repairs[0] if verdict.repairs else None


# edits that take away no slip: what is on the way to a quantity lacks a term or a factor, and programs mix units
_NO_SLIP = {"left out", "put back", "degrees", "unit"}


def _explains(repair: Repair, tree: Node, own: Mapping[str, str]) -> bool:
    # nobody mistakes a variable for one that the program has not; a limit of long rods is a step, too
    if repair.max_rel_error >= _EXACT or not set(letters(repair.tree)) <= {*own, "pi"}:
        return False
    return not any(edit.kind in _NO_SLIP or _counts_otherwise(edit.new, tree) for edit in repair.edits)


def _counts_otherwise(new: Node, tree: Node) -> bool:
    # m becomes m + 1: an exponent, or a number of teeth, that its author counts in another way; not so m - 1 that does
    letter = _beside_one(new)
    if not letter or any(_beside_one(n) == letter for _, n in trees.walk(tree)):
        return False
    return sum(isinstance(n, ast.Name) and n.id == letter for _, n in trees.walk(tree)) == 1


def _beside_one(tree: Node) -> str:
    # the letter that 1 is added to, or taken from
    if not trees.is_operation(tree, ast.Add, ast.Sub) or not isinstance(tree.left, ast.Name):
        return ""
    return tree.left.id if trees.value_of(tree.right) == 1 else ""


_OTHER_OF_TWO = str.maketrans("12", "21")


def _is_of_two_alike(fitted: Fitted, form: Formula, states: Probes) -> bool:
    # 1 and 2 may change places in it, as the bodies of a contact do
    letter_of = {meaning: safe(letter) for letter, meaning in fitted.meanings.items()}
    other = {letter: letter_of.get(meaning.translate(_OTHER_OF_TWO), "") for meaning, letter in letter_of.items()}
    if not all(other.values()) or all(one == another for one, another in other.items()):
        return False
    turned = replace(form, tree=trees.substitute(form.tree, lambda n: renamed_to(n, other)))
    try:
        one, another = (states.values(states.random, each, fitted.theory.results[0])[0] for each in (form, turned))
    except (BadInput, ArithmeticError, ValueError, KeyError):
        return False
    return bool(np.allclose(one, another, rtol=1e-9, atol=0.0))


def renamed_to(node: Node, names: Mapping[str, str]) -> Node | None:
    """A letter under its other name."""
    return trees.name(names[node.id]) if isinstance(node, ast.Name) and node.id in names else None


def slip(fitted: Fitted, form: Formula, quantity: str, states: Probes) -> Row | None:
    """What is said of a formula: it agrees, one slip takes it away from a quantity, or it is wrong; None: not sure.

    Programs count a way or a speed in either direction: what goes against the quantity is asked about turned, too.
    """
    if sum(1 for _ in trees.walk(form.tree)) > _LARGEST:
        return None
    own = {safe(k): v for k, v in fitted.meanings.items()}
    twice, wrong = _is_of_two_alike(fitted, form, states), None
    printed, expected = states.values(states.random, form, quantity)
    good = np.isfinite(printed) & np.isfinite(expected)
    against = float(np.sum((printed * expected)[good])) < 0
    for turned in (False, True) if against else (False,):
        tree = _negative(form.tree) if turned else form.tree
        row, repair = asked_once(to_python(tree), fitted.theory, quantity, own, at_rest(fitted.theory, form), twice)
        if row["verdict"] in PASSED:
            return row | {"verdict": "agrees"}
        if row["verdict"] == "misprint" and repair is not None and _explains(repair, tree, own):
            row |= {"correction": to_python(_negative(repair.tree))} if turned else {}
            meant = {base(k).replace(OF, "."): v for k, v in fitted.meanings.items()}
            return _renamed(row, fitted) | {"letters": meant}
        if row["verdict"] not in ("wrong", "nearer"):
            return None
        wrong = row | {"verdict": "wrong"}
    return wrong


def _negative(tree: Node) -> Node:
    # -(a*b) is (-a)*b to a reader of Python
    if isinstance(tree, ast.UnaryOp) and isinstance(tree.op, ast.USub):
        return tree.operand
    if trees.is_operation(tree, ast.Mult, ast.Div) and _is_negative(tree.left):
        return ast.BinOp(_negative(tree.left), tree.op, tree.right)
    return ast.UnaryOp(ast.USub(), tree)


def _is_negative(tree: Node) -> bool:
    if trees.is_operation(tree, ast.Mult, ast.Div):
        return _is_negative(tree.left)
    return isinstance(tree, ast.UnaryOp) and isinstance(tree.op, ast.USub)


def _renamed(row: Row, fitted: Fitted) -> Row:
    # the program's own names again
    names = {safe(k): base(k).replace(OF, ".") for k in fitted.meanings if safe(k) != k}
    if not names:
        return row
    pattern = re.compile(rf"\b(?:{'|'.join(map(re.escape, sorted(names, key=len, reverse=True)))})\b")
    texts = {k: pattern.sub(lambda m: names[m[0]], row[k]) for k in ("correction", "note") if row[k]}
    return row | texts

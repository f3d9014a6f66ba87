"""One formula of a program that comes near to a quantity: what the auditor says of it, and whether that explains it."""

import ast
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from mechsym.audit.judge.asked import Asked, question_of
from mechsym.audit.judge.conventions import RATIO, also_exact, holds_with, told
from mechsym.audit.judge.fitted import Fitted, safe
from mechsym.audit.judge.lexicon import OTHER_OF_TWO
from mechsym.audit.judge.nearness import Near, Probes, at_rest, shown_as
from mechsym.audit.judge.question import Question
from mechsym.audit.read import tree as trees
from mechsym.audit.read.programs.claims import base
from mechsym.audit.read.programs.statements import OF
from mechsym.audit.read.reader import Formula
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.statement import statement
from mechsym.audit.read.tree import Node, letters
from mechsym.audit.repair.examination import Repair
from mechsym.audit.row import Row, formula_row, unread_row
from mechsym.audit.theory.record import Theory
from mechsym.audit.verdict import PASSED, RIGHT_WITH, decide
from mechsym.errors import BadInput

_EXACT = 1e-9  # relative error of a correction that explains a formula: a limit of long rods does not [-]
_GROWS = 12  # parts that what is put back may have at the most
_LARGEST = 120  # parts of a formula for which a slip is searched: the search is the one thing here that takes long


def asked_once(
    text: str,
    theory: Theory,
    quantity: str,
    own: Mapping[str, str],
    rest: Sequence[str],
    twice: bool = False,
    beside: Sequence[Near] = (),
    of_angle: Sequence[Near] = (),
    settled: bool = False,
    from_top: bool = False,
) -> tuple[Row, Repair | None]:
    """The row of a formula, of one slip at most, with its repair; twice: the same one may stand in both halves;
    settled, from_top: no other way of counting a letter or the angle is open.

    beside, of_angle: others of the same program that agree, which have the same letters and count the same angle.
    """
    against = shown_as(theory, quantity)
    try:
        question = _question(text, theory, quantity, own, rest)
        verdict = decide(question, settled=settled, one=not twice)
        if twice and verdict.repairs and len({edit.kind for edit in verdict.repairs[0].edits}) > 1:
            verdict = decide(question, one=True)
        turned = RATIO in verdict.note and not _is_ratio(theory, quantity)
        if verdict.verdict == "untestable" and (turned or _is_told_otherwise(verdict.note, own, beside)):
            verdict = decide(question, settled=True, one=True)
        right = also_exact(question, from_top) if verdict.verdict not in PASSED else ()
        if right and any(not _holds_beside(near, right, own) for near in of_angle):
            right = ()
    except BadInput as error:
        return unread_row("", against, text, str(error)), None
    row = {"claim": against} | formula_row(question, verdict, text, "", "")
    if right:
        row |= {"verdict": "convention", "note": f"exact with {told(right)}"}
    return row, verdict.repairs[0] if verdict.repairs else None


def _question(text: str, theory: Theory, quantity: str, own: Mapping[str, str], rest: Sequence[str]) -> Question:
    assume = [f"{k} = 0" for k in rest if k in theory.letters]
    against = f"{theory.name}.{quantity}"
    asked = Asked(text=text, against=against, letters=own, hidden="noted", given=theory, assume=assume)
    return question_of(asked, statement(text))


def _is_ratio(theory: Theory, quantity: str) -> bool:
    # which may be counted either way, as a life may not
    called = theory.words.get(quantity, ())
    return not called or any("ratio" in said for said in (quantity, *called))


def _is_told_otherwise(note: str, own: Mapping[str, str], beside: Sequence[Near]) -> bool:
    # a radius for a diameter, say, of a letter that has its plain meaning in a formula that agrees
    letter = re.search(rf"{RIGHT_WITH} (\w+) as ", note)
    plain = {m for near in beside for m in near.fitted.meanings.values()}
    return letter is not None and own.get(letter[1]) in plain


def _holds_beside(near: Near, chosen: tuple[str, ...], own: Mapping[str, str]) -> bool:
    # whether a formula that agrees would do so with a convention, too; of either sign where its value is not used
    letters_of = {safe(k): v for k, v in near.fitted.meanings.items()}
    theory, rest = near.fitted.theory, at_rest(near.fitted.theory, near.form)
    angle = tuple(c for c in chosen if c != "sign")
    if not angle:
        return True
    try:
        question = _question(to_python(near.form.tree), theory, near.quantity, letters_of, rest)
    except BadInput:
        return True
    signs = ((),) if safe(near.fitted.claim.name) in own else ((), ("sign",))
    return any(holds_with(question, (*angle, *sign)) for sign in signs)


# edits that take away no slip: what is on the way to a quantity lacks a term or a factor, and programs mix units
_NO_SLIP = {"left out", "put back", "degrees", "unit"}


def _explains(repair: Repair, near: Near, tree: Node, own: Mapping[str, str], beside: Sequence[Near]) -> bool:
    # nobody mistakes a variable for one that the program has not; a limit of long rods is a step, too
    if repair.max_rel_error >= _EXACT or not set(letters(repair.tree)) <= {*own, "pi"}:
        return False
    # where neighbours agree, a power that is lost of a letter that stands there is no step on the way
    named = bool(beside) and near.quantity in near.fitted.quantities
    whole = named and set(letters(repair.tree)) == set(letters(tree))
    steps = _NO_SLIP - ({"put back"} if whole else set())
    plain = {m for other in beside for m in other.fitted.meanings.values()}
    counted = [own.get(_counted_otherwise(edit.new, tree), "pi") for edit in repair.edits]
    counted = [m for m in counted if not _is_no_count(near, m)]
    grown = sum(1 for _ in trees.walk(repair.tree)) - sum(1 for _ in trees.walk(tree))
    if grown > _GROWS and any(edit.kind == "put back" for edit in repair.edits):
        return False
    if any(edit.kind in steps for edit in repair.edits) or any(m != "pi" and m not in plain for m in counted):
        return False
    others = {k: trees.name(m) for k, m in own.items() if m.isidentifier()}
    return not _is_idle(repair.tree, replace(near.form, letters={**others, **near.form.letters}), near.states)


def _is_no_count(near: Near, meaning: str) -> bool:
    # a ratio, of specific heats or of compression, is nothing that somebody begins with another number
    theory = near.fitted.theory
    letter = theory.letters.get(meaning)
    exponent = letter is not None and letter.unit == "-" and letter.domain is not None and letter.domain[1] <= 2
    return exponent or any("ratio" in said for said in theory.words.get(meaning, ()))


def _is_idle(tree: Node, form: Formula, states: Probes) -> bool:
    # an edit that makes a difference of what is alike takes a term away, as none mistypes it
    differences = (node for _, node in trees.walk(tree) if trees.is_operation(node, ast.Sub))
    return any(_alike(node.left, node.right, form, states) for node in differences)


def _alike(left: Node, right: Node, form: Formula, states: Probes) -> bool:
    if not letters(left) or not letters(right):
        return False
    try:
        one, other = (states.of(replace(form, tree=part)) for part in (left, right))
    except (BadInput, ArithmeticError, ValueError, KeyError):
        return False
    return bool(np.allclose(one, other, rtol=1e-9, atol=0.0))


def _counted_otherwise(new: Node, tree: Node) -> str:
    # m becomes m + 1: an exponent, or a number of teeth, that its author counts in another way; not so m - 1 that does
    letter = _beside_one(new)
    if not letter or any(_beside_one(n) == letter for _, n in trees.walk(tree)):
        return ""
    return letter if sum(isinstance(n, ast.Name) and n.id == letter for _, n in trees.walk(tree)) == 1 else ""


def _beside_one(tree: Node) -> str:
    # the letter that 1 is added to, or taken from
    if not trees.is_operation(tree, ast.Add, ast.Sub) or not isinstance(tree.left, ast.Name):
        return ""
    return tree.left.id if trees.value_of(tree.right) == 1 else ""


def _is_of_two_alike(fitted: Fitted, form: Formula, states: Probes) -> bool:
    # 1 and 2 may change places in it, as the bodies of a contact do
    letter_of = {meaning: safe(letter) for letter, meaning in fitted.meanings.items()}
    other = {letter: letter_of.get(meaning.translate(OTHER_OF_TWO), "") for meaning, letter in letter_of.items()}
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


def slip(near: Near, beside: Sequence[Near], of_angle: Sequence[Near]) -> Row | None:
    """What is said of a formula: it agrees, one slip takes it away from a quantity, or it is wrong; None: not sure.

    A letter that it has not is looked for where nothing else explains it.
    """
    row = _slip(replace(near, fitted=replace(near.fitted, spare={})), beside, of_angle)
    if near.fitted.spare and (row is None or row["verdict"] == "wrong"):
        return _slip(near, beside, of_angle)
    return row


def _slip(near: Near, beside: Sequence[Near], of_angle: Sequence[Near]) -> Row | None:
    """The same with all letters of its function.

    Programs count a way or a speed in either direction: what goes against the quantity is asked about turned, too.
    """
    fitted, form, quantity, states = near.fitted, near.form, near.quantity, near.states
    if sum(1 for _ in trees.walk(form.tree)) > _LARGEST:
        return None
    own = {safe(k): v for k, v in {**fitted.spare, **fitted.meanings}.items()}
    twice, wrong = _is_of_two_alike(fitted, form, states), None
    printed, expected = states.values(states.random, form, quantity)
    good = np.isfinite(printed) & np.isfinite(expected)
    # the square of a difference says nothing of its sense
    squared = any(map(_is_squared_difference, ast.walk(form.tree)))
    against = squared or float(np.sum((printed * expected)[good])) < 0
    # an offset lies on either side, as it does for an angle from the bottom
    sided = any(one.unit == "m" and not one.positive for one in fitted.theory.letters.values())
    from_top = fitted.claim.from_top and not sided
    for turned in (False, True) if against else (False,):
        tree = _negative(form.tree) if turned else form.tree
        rest = at_rest(fitted.theory, form)
        text = to_python(tree)
        row, repair = asked_once(
            text, fitted.theory, quantity, own, rest, twice, beside, of_angle, near.settled, from_top
        )
        if row["verdict"] in PASSED:
            # it passes as what: exact, a truncation, by a convention
            return row | {"verdict": "agrees", "passed": row["verdict"]}
        if row["verdict"] == "misprint" and repair is not None:
            repair = replace(repair, tree=_in_own_letters(repair.tree, fitted.theory, own))
            if _explains(repair, near, tree, own, beside):
                row |= {"correction": to_python(_negative(repair.tree) if turned else repair.tree)}
                meant = {base(k).replace(OF, "."): v for k, v in fitted.meanings.items()}
                return _renamed(row, fitted, own) | {"letters": meant}
        if row["verdict"] not in ("wrong", "nearer") and (turned or not squared):
            return None
        wrong = row | {"verdict": "wrong"}
    return wrong


def _is_squared_difference(node: ast.AST) -> bool:
    # of two letters: (w_1 - w_2)**2
    if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Pow) or trees.value_of(node.right) != 2:
        return False
    sides = (node.left.left, node.left.right) if trees.is_operation(node.left, ast.Sub) else ()
    return bool(sides) and all(isinstance(side, ast.Name) for side in sides)


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


def _own_names(own: Mapping[str, str]) -> dict[str, str]:
    # the program's letter for what the theory calls otherwise
    return {meaning: letter for letter, meaning in own.items() if meaning.isidentifier() and meaning not in own}


def _in_own_letters(tree: Node, theory: Theory, own: Mapping[str, str]) -> Node:
    """In the program's letters, with what it has none for written out in them: the rest of a length."""
    names = _own_names(own)

    def written(node: Node) -> Node | None:
        if not isinstance(node, ast.Name) or node.id in (*own, *own.values()):
            return None
        entry = theory.tape.get(node.id)
        if not isinstance(entry, ast.BinOp) or not isinstance(entry.op, ast.Sub):
            return None
        return entry if {*letters(entry)} <= {*own.values()} else None

    return trees.substitute(trees.substitute(tree, written), lambda n: renamed_to(n, names))


def _renamed(row: Row, fitted: Fitted, own: Mapping[str, str]) -> Row:
    # the program's own names again
    every = {**fitted.meanings, **fitted.spare}
    plain = {safe(k): base(k).replace(OF, ".") for k in every}
    names = {k: v for k, v in plain.items() if k != v} | {m: plain[k] for m, k in _own_names(own).items()}
    if not names:
        return row
    pattern = re.compile(rf"(?<!')\b(?:{'|'.join(map(re.escape, sorted(names, key=len, reverse=True)))})\b")
    texts = {k: pattern.sub(lambda m: names[m[0]], row[k]) for k in ("correction", "note") if row[k]}
    if note := texts.get("note"):  # what is the theory's by another name there
        texts["note"] = re.sub(r"\b(\w+) means \1 here, not the theory's \1(?:; |$)", "", note)
    return row | texts

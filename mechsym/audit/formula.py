"""The user's own formula: compared, proved or repaired like a published one."""

import ast
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from mechsym.audit import claims, conventions
from mechsym.audit.assumptions import assumed
from mechsym.audit.findings import Row, formula_row, unread_row
from mechsym.audit.question import Question
from mechsym.audit.reader import AnyLetter, Formula, letter_pairs, read, read_expression
from mechsym.audit.redefinition import refuse_left, refuse_letters
from mechsym.audit.statement import Statement, statement
from mechsym.audit.theory.catalogue import named, target
from mechsym.audit.theory.record import Theory, check_sums, dependencies, known, need_result
from mechsym.audit.theory.tape import TheoryTape, retaped
from mechsym.audit.tree import letters as letters_of
from mechsym.audit.verdict import PASSED, Decision, decide
from mechsym.errors import BadInput
from mechsym.files import read_text
from mechsym.quantities import record

_TEXTS = ("text", "against", "case", "name", "claim", "convention", "theory")
_KEYS = (*_TEXTS, "letters", "assume")
# the worst first: what is said of a = b = c
_WORST = ("wrong", "nearer", "misprint", "mixed", "untestable", "convention", "truncation", "exact")
_IDENTITY = "left_side"


@record
class Asked:
    """A formula and everything that its author says of it."""

    text: str
    against: str
    letters: str | Mapping[str, str] = ""
    case: str = ""
    name: str = ""
    assume: str | Sequence[str] = ""
    claim: str = ""
    convention: str = ""
    theory: str = ""  #: TOML file that declares the theory
    given: Theory | None = None  #: The theory itself, where it is at hand
    #: What an author's letter that is one of the theory's, too, comes to: a program cannot be told to rename its own
    hidden: str = "refused"


def check_formula(text: str, against: str, letters: str | Mapping[str, str] = "", case: str = "", **more: Any) -> Row:
    """Is this formula that quantity?

    Parameters
    ----------
    text : str
        Python syntax or LaTeX; `name = expression` or the expression alone
    case : str
        Case whose data the error is measured with; empty for the source's
    **more : object
        name, assume, claim, convention, theory: as in `Asked`

    Returns
    -------
    row : dict
        The keys of an audit row; `understood` is the formula as it was read

    Raises
    ------
    BadInput
        Cannot be read, unknown letters, or no such quantity

    Examples
    --------
    >>> check_formula("r*sin(phi + psi)/cos(psi)", "crosshead.dx_dphi")["verdict"]
    'exact'
    """
    return answer(Asked(text=text, against=against, letters=letters, case=case, **more))


def answer(asked: Asked) -> Row:
    """The row of one formula; of a = b = c that of the worst equality."""
    said = statement(asked.text)
    claim = claims.checked(asked.claim)
    rows = [_row(asked, replace(said, right=(right,)), claim) for right in said.right]
    return min(rows, key=lambda r: _WORST.index(r["verdict"]))


def _row(asked: Asked, said: Statement, claim: str) -> Row:
    chosen = conventions.checked(asked.convention)
    question = question_of(asked, said)
    verdict = decide(question)
    notes = [_held(question), _said(question, asked, said)]
    shown = [c for c in chosen if c != "show"]
    if shown and verdict.verdict not in ("exact", "convention"):
        other = conventions.converted(question, shown)
        found = decide(other)
        if found.verdict in PASSED:
            note = f"{found.verdict} with {conventions.told(shown)}"
            found = replace(found, verdict="convention", note="; ".join(n for n in (found.note, note) if n))
        question, verdict = other, found
    if verdict.verdict not in PASSED and (also := conventions.also_exact(question)):
        notes.append(f"also exact with {also}")
    head = {"source": "own", "equation": asked.name or said.number or "-", "claim": _claimed(asked, question)}
    row = head | formula_row(question, verdict, asked.text, "; ".join(n for n in notes if n), "")
    return row | _kept(claim, question, verdict, row) if claim else row


def _kept(claim: str, question: Question, verdict: Decision, row: Row) -> Row:
    holds, why = claims.kept(claim, question, verdict)
    told = f"the claim {claim!r} {'is kept' if holds else 'is broken'}: {why}"
    return {"claimed": claim, "claim_kept": holds, "note": "; ".join(n for n in (row["note"], told) if n)}


def _claimed(asked: Asked, question: Question) -> str:
    return f"{question.theory.name}.{target(asked.against)[1]}"


def question_of(asked: Asked, said: Statement) -> Question:
    """The question that a user asks; letters that are zero in the case and not in the formula stay zero."""
    theory, quantity = _quantity(asked)
    pairs = letter_pairs(asked.letters) if isinstance(asked.letters, str) else dict(asked.letters)
    text = said.right[0]
    formula = read(text, known(theory), pairs, theory.tape)
    if asked.hidden == "refused":
        refuse_letters(theory, formula)
        refuse_left(theory, quantity, said.left, formula)
    check_sums(theory, formula.tree)
    under = assumed(theory, asked.assume, formula.letters)
    theory, quantity = _with_left(under.theory, quantity, said, formula)
    used = {n for tree in (formula.tree, *formula.letters.values()) for n in letters_of(tree)}
    needed = dependencies(theory, [quantity])
    zero = [k for k, letter in theory.letters.items() if letter.value == 0 and k in needed and k != theory.angle]
    hold = {k: 0.0 for k in zero if k not in used} | dict(under.hold)
    note = "; ".join(n for n in (formula.note, said.note) if n)
    return Question(formula=replace(formula, note=note), theory=theory, quantity=quantity, hold=hold, where=under.where)


def _quantity(asked: Asked) -> tuple[Theory, str]:
    name, quantity = target(asked.against)
    if not name:
        raise BadInput(f"--against {asked.against!r} is not THEORY.QUANTITY, as slider_crank.x, nor ./FILE.py:QUANTITY")
    found = asked.given or named(name, asked.case, asked.theory)
    need_result(found, quantity)
    return found, quantity


def _with_left(theory: Theory, quantity: str, said: Statement, formula: Formula) -> tuple[Theory, str]:
    # l*sin(beta) = r*sin(phi) is a law: its sides are compared with each other
    if not said.left:
        return theory, quantity
    try:
        left = read_expression(said.left, [*formula.letters, *known(theory)], theory.tape)[0]
    except BadInput:
        if _is_name(said.left):
            return theory, quantity
        raise
    if isinstance(left, ast.Name) and isinstance(formula.letters.get(left.id, left), ast.Name):
        return theory, quantity
    meant = {m for n in letters_of(left) for m in letters_of(formula.letters.get(n, ast.Name(n, ast.Load())))}
    if not meant & {quantity, *dependencies(theory, [quantity])}:
        raise BadInput(f"the left side {said.left[:40]!r} has nothing of {quantity}; write '{quantity} = expression'")
    tape = theory.tape.base if isinstance(theory.tape, TheoryTape) else dict(theory.tape)
    full = {k: t for k, t in formula.letters.items() if k not in theory.letters and k not in tape}
    return replace(
        theory, tape=retaped(theory.tape, {**full, _IDENTITY: left}, theory.letters, theory.angle)
    ), _IDENTITY


def _is_name(text: str) -> bool:
    try:
        return isinstance(read_expression(text, (), AnyLetter())[0], ast.Name)
    except BadInput:
        return False


def _said(question: Question, asked: Asked, said: Statement) -> str:
    if not said.left:
        return ""
    if question.quantity.startswith(_IDENTITY):
        return f"a law: its left side {said.left} is compared with its right side"
    found = {k: t for k, t in question.formula.letters.items() if isinstance(t, ast.Name)}
    try:
        left = read_expression(said.left, [*found, *known(question.theory)], question.theory.tape)[0]
    except BadInput:
        return ""
    meant = found.get(left.id, left) if isinstance(left, ast.Name) else left
    quantity = target(asked.against)[1]
    if isinstance(meant, ast.Name) and meant.id != quantity and (meant.id in question.theory.tape):
        return f"its left side names {meant.id}, and it is compared with {quantity}"
    return ""


def _held(question: Question) -> str:
    return f"compared at {', '.join(f'{k} = {v:g}' for k, v in question.hold.items())}" if question.hold else ""


def check_file(path: Path, theory: str = "") -> list[Row]:
    """Check the formulas of a TOML file: one row each, `untestable` with the reason for what cannot be read.

    Parameters
    ----------
    path : Path
        With tables `[[formula]]` of text, against and perhaps name, letters, case, assume, claim, convention, theory
    """
    content = _content(path)
    own = theory or str(content.get("theory", ""))
    found = []
    for number, table in enumerate(content["formula"], start=1):
        try:
            asked = _asked(table, number, own, path)
        except BadInput as error:
            raise BadInput(f"{path}: formula {table.get('name', number)}: {error}") from None
        try:
            found.append(answer(asked))
        except BadInput as error:
            found.append(unread_row(asked.name, asked.against, asked.text, str(error)))
    return found


def _content(path: Path) -> dict[str, Any]:
    try:
        content = tomllib.loads(read_text(path))
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"{path}: not valid TOML: {error}") from None
    tables = content.get("formula")
    if not isinstance(tables, list) or not tables or not all(isinstance(t, dict) for t in tables):
        raise BadInput(
            f"{path}: there is no [[formula]] in it; each has text, against and perhaps {', '.join(_KEYS[2:])}"
        )
    return content


def _asked(table: dict[str, Any], number: int, theory: str, path: Path) -> Asked:
    unknown = sorted(table.keys() - set(_KEYS))
    if unknown or not {"text", "against"} <= table.keys():
        raise BadInput(
            f"keys are {', '.join(sorted(_KEYS))}, of which text and against are needed; found {sorted(table)}"
        )
    letters, assume = table.get("letters", {}), table.get("assume", "")
    texts = [table[k] for k in _TEXTS if k in table]
    pairs = list(letters.values()) if isinstance(letters, dict) else [letters]
    relations = assume if isinstance(assume, list) else [assume]
    if not all(isinstance(v, str) for v in [*texts, *pairs, *relations]):
        raise BadInput("every value is a text in quotes")
    given = {k: table[k] for k in _TEXTS if k in table}
    file = given.get("theory", theory)
    beside = path.parent / file if file and not Path(file).is_absolute() and (path.parent / file).is_file() else file
    more = {"name": str(table.get("name", number)), "theory": str(beside), "letters": letters, "assume": assume}
    return Asked(**(given | more))

"""The user's own formula: compared, proved or repaired like a published one."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mechsym.audit.findings import Row, formula_row
from mechsym.audit.question import Question
from mechsym.audit.reader import letter_pairs, read
from mechsym.audit.theory.catalogue import names, theory
from mechsym.audit.theory.record import Theory, check_sums, dependencies, known, need_result
from mechsym.audit.tree import letters as letters_of
from mechsym.audit.verdict import decide
from mechsym.errors import BadInput

_KEYS = {"text", "against", "letters", "case", "name"}


def check_formula(
    text: str, against: str, letters: str | Mapping[str, str] = "", case: str = "", name: str = ""
) -> Row:
    """Is this formula that quantity?

    Parameters
    ----------
    text : str
        Python syntax or LaTeX; `name = expression` or the expression alone
    case : str
        Case whose data the error is measured with; empty for the source's
    name : str
        What the formula is called in the answer

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
    question = question_of(text, against, letters, case)
    verdict = decide(question)
    head = {"source": "own", "equation": name or "-", "claim": f"{question.theory.name}.{question.quantity}"}
    return head | formula_row(question, verdict, text, _held(question), "")


def question_of(text: str, against: str, letters: str | Mapping[str, str], case: str) -> Question:
    """The question that a user asks.

    Returns
    -------
    question : Question
        Letters that are zero in the case and not in the formula stay zero

    Raises
    ------
    BadInput
        As for `check_formula`
    """
    found, quantity = _quantity(against, case)
    pairs = letter_pairs(letters) if isinstance(letters, str) else dict(letters)
    formula = read(text, known(found), pairs)
    check_sums(found, formula.tree)
    used = {n for tree in (formula.tree, *formula.letters.values()) for n in letters_of(tree)}
    needed = dependencies(found, [quantity])
    zero = [k for k, letter in found.letters.items() if letter.value == 0 and k in needed and k != found.angle]
    hold = {k: 0.0 for k in zero if k not in used}
    return Question(formula=formula, theory=found, quantity=quantity, hold=hold)


def _quantity(against: str, case: str) -> tuple[Theory, str]:
    name, dot, quantity = against.strip().partition(".")
    if not dot or name not in names():
        raise BadInput(f"--against {against!r} is not THEORY.QUANTITY; theories are {', '.join(names())}")
    found = theory(name, case)
    need_result(found, quantity)
    return found, quantity


def _held(question: Question) -> str:
    return f"compared at {', '.join(f'{k} = 0' for k in question.hold)}" if question.hold else ""


def check_file(path: Path) -> list[Row]:
    """Check the formulas of a TOML file.

    Parameters
    ----------
    path : Path
        With tables `[[formula]]` of text, against and perhaps letters, case, name

    Raises
    ------
    BadInput
        Names file, formula and what is wrong
    """
    found = []
    for number, table in enumerate(_tables(path), start=1):
        where = f"{path}: formula {table.get('name', number)}"
        try:
            found.append(_check_table(table, number))
        except BadInput as error:
            raise BadInput(f"{where}: {error}") from None
    return found


def _tables(path: Path) -> list[dict[str, Any]]:
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise BadInput(f"{path}: cannot be read ({getattr(error, 'strerror', None) or 'not UTF-8 text'})") from None
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"{path}: not valid TOML: {error}") from None
    tables = content.get("formula")
    if not isinstance(tables, list) or not tables or not all(isinstance(t, dict) for t in tables):
        raise BadInput(f"{path}: there is no [[formula]] in it; each has text, against and perhaps letters, case, name")
    return tables


def _check_table(table: dict[str, Any], number: int) -> Row:
    unknown = sorted(table.keys() - _KEYS)
    if unknown or not {"text", "against"} <= table.keys():
        raise BadInput(
            f"keys are {', '.join(sorted(_KEYS))}, of which text and against are needed; found {sorted(table)}"
        )
    letters = table.get("letters", {})
    texts = [v for k, v in table.items() if k != "letters"]
    pairs = list(letters.values()) if isinstance(letters, dict) else [letters]
    if not all(isinstance(v, str) for v in [*texts, *pairs]):
        raise BadInput("every value is a text in quotes")
    own = str(table.get("name", number))
    return check_formula(table["text"], table["against"], letters, table.get("case", ""), own)

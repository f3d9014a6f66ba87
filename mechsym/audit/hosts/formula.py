"""The user's own formulas: one as typed, or those of a TOML file."""

import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mechsym import budget
from mechsym.audit.judge.asked import Asked
from mechsym.audit.read.reader import joined
from mechsym.audit.row import Row, answer, answer_or_why, shared
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.files.inputs import read_text

SECONDS = 0.5  # that a formula takes at most in the mean: exact ones hundredths, misprints half a second [s]
_TEXTS = ("text", "against", "case", "name", "claim", "convention", "theory")
_KEYS = (*_TEXTS, "letters", "assume")


def check_formula(text: str, against: str, letters: str | Mapping[str, str] = "", case: str = "", **more: Any) -> Row:
    """Is this formula that quantity? The keys of an audit row; `understood` is the formula as it was read.

    text: python syntax, LaTeX or print; `name = expression` or the expression alone; case: case whose data the error is
    measured with; empty for the source's; **more: name, assume, claim, convention, theory: as in `Asked`. Raises
    BadInput: cannot be read, unknown letters, or no such quantity.

    >>> check_formula("r*sin(phi + psi)/cos(psi)", "crosshead.dx_dphi")["verdict"]
    'exact'
    """
    asked = Asked(text=text, against=against, letters=letters, case=case, **more)
    row = answer(asked)
    said = [text, *asked.pairs.values(), *([asked.assume] if isinstance(asked.assume, str) else asked.assume)]
    idle = [k for k in asked.pairs if not re.search(rf"(?<!\w){re.escape(k)}(?!\w)", " ; ".join(said))]
    return row | {"note": joined(row["note"], f"not read: {', '.join(idle)} of --letters" if idle else "")}


def check_file(path: Path, theory: str = "") -> list[Row]:
    """Check the formulas of a TOML file: one row each, `untestable` with the reason for what cannot be read.

    path: with tables `[[formula]]` of text, against and perhaps name, letters, case, assume, claim, convention, theory.
    """
    try:
        content = tomllib.loads(read_text(path))
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"{path}: not valid TOML: {error}") from None
    tables = content.get("formula")
    if not isinstance(tables, list) or not tables or not all(isinstance(t, dict) for t in tables):
        raise BadInput(
            f"{path}: there is no [[formula]] in it; each has text, against and perhaps {', '.join(_KEYS[2:])}"
        )
    budget.require(f"{path}: {len(tables)} formulas", SECONDS * len(tables), 0.0, "give a part of them")
    rows = []
    for number, table in enumerate(tables, start=1):
        try:
            asked = _asked(table, number, theory or str(content.get("theory", "")), path)
        except BadInput as error:
            raise BadInput(f"{path}: formula {table.get('name', number)}: {error}") from None
        rows.append(answer_or_why(asked))
    return shared(rows)


def _asked(table: Json, number: int, theory: str, path: Path) -> Asked:
    unknown = sorted(table.keys() - set(_KEYS))
    if unknown or not {"text", "against"} <= table.keys():
        raise BadInput(
            f"keys are {', '.join(sorted(_KEYS))}, of which text and against are needed; found {sorted(table)}"
        )
    letters, assume = table.get("letters", {}), table.get("assume", "")
    texts = {k: table[k] for k in _TEXTS if k in table}
    pairs = list(letters.values()) if isinstance(letters, dict) else [letters]
    relations = assume if isinstance(assume, list) else [assume]
    if not all(isinstance(v, str) for v in [*texts.values(), *pairs, *relations]):
        raise BadInput("every value is a text in quotes")
    file = texts.get("theory", theory)
    beside = path.parent / file if file and not Path(file).is_absolute() and (path.parent / file).is_file() else file
    more = {"name": str(table.get("name", number)), "theory": str(beside), "letters": letters, "assume": assume}
    return Asked(**(texts | more))

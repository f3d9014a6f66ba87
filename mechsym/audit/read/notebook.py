"""Cells of a Jupyter notebook: its code, and its words as a text."""

import json
import re
from collections.abc import Sequence

from mechsym.errors import BadInput

LONGEST = 50_000_000  #: Characters of a file, its pictures among them
_CELL = re.compile(r'\s*"cell_type":\s*"(\w+)"')
_SOURCE = re.compile(r'\s*"source":\s*\[\s*')


def cells_of(text: str, kind: str) -> Sequence[str]:
    """The sources of all cells of a kind, `code` or `markdown`. Raises BadInput: it is no notebook."""
    try:
        content = json.loads(text)
        cells = content["cells"] if "cells" in content else [c for w in content["worksheets"] for c in w["cells"]]
        return ["".join(c.get("source", c.get("input", ""))) for c in cells if c["cell_type"] == kind]
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        raise BadInput("no notebook: JSON with cells is expected, as Jupyter writes it") from None


def words_of_notebook(text: str) -> str:
    """The words of a notebook, each line where the file has it as far as it has lines. Raises BadInput: none."""
    cells = cells_of(text, "markdown")
    placed, kind, inside = [], "", False
    for line in text.split("\n"):
        kind = match[1] if (match := _CELL.match(line)) else kind
        said = ""
        if inside and kind == "markdown" and line.strip().startswith('"'):
            said = json.loads(line.strip().rstrip(","))
        inside = bool(_SOURCE.fullmatch(line)) or inside and not line.strip().startswith("]")
        placed.append(said.rstrip("\n"))
    whole = "\n".join(placed)
    return whole if "".join(whole.split()) == "".join("".join(cells).split()) else "\n\n".join(cells)

"""What a paper prints, read from its `printed.toml`: one [[entry]] a formula, a definition or a claim of the text.

equation = "2"                        # its number, or where it stands: "text", "table 4.9"
claim = "reduced moment of inertia"   # what it claims to be, in words
statement = "..."                     # as printed, in the author's letters
quantity = "crosshead.inertia"        # a formula: what is derived
letters = { R = "r" }                 # of the author; or the name of a table in [letters], or a list of both
hold = { phidd = 0.0 }                # what is taken for granted; the same with [hold]
turn, effect = "claims.loads"         # functions of the paper's folder
verdict = "definition"                # instead of a quantity: it is not there to be proved
decide = "claims.about_twice"         # instead of a statement: what decides a claim made in words
note = "..."                          # what else there is to say
"""

import tomllib
from collections.abc import Mapping
from importlib import resources
from typing import TYPE_CHECKING, Any

from mechsym.quantities import load

if TYPE_CHECKING:
    from mechsym.audit.entries import Entry

_FUNCTIONS, _TABLES = ("turn", "effect", "decide"), ("letters", "hold")


def entries(folder: str) -> "tuple[Entry, ...]":
    """The entries of a paper in the order of the text."""
    text = (resources.files(f"mechsym.papers.{folder}") / "printed.toml").read_text(encoding="utf-8")
    content = tomllib.loads(text)
    return tuple(_entry(f"mechsym.papers.{folder}", one, content) for one in content["entry"])


def _entry(room: str, said: Mapping[str, Any], content: Mapping[str, Any]) -> "Entry":
    from mechsym.audit.entries import Listed, Printed, TextClaim

    functions = {k: load(f"{room}.{said[k].replace('.', ':')}") for k in _FUNCTIONS if k in said}
    tables = {k: _table(said[k], content.get(k, {})) for k in _TABLES if k in said}
    kind = Printed if "quantity" in said else Listed if "verdict" in said else TextClaim
    return kind(**{**said, **functions, **tables})


def _table(said: Any, shared: Mapping[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for one in said if isinstance(said, list) else [said]:
        found |= shared[one] if isinstance(one, str) else one
    return found

"""The recorded outcome: what every source gave when last recorded, and how a new run differs.

`findings.csv` has one line for each row that is not plainly reproduced, and one line `*` per source that counts the
rest. A finding is a result; only a change of findings is a failure.
"""

import csv
import io
from collections import Counter
from collections.abc import Iterable, Sequence
from importlib import resources
from pathlib import Path
from typing import Any

from mechsym.files import write_text
from mechsym.reproduce.record import REPRODUCED

_COLUMNS = ("source", "item", "verdict", "rows")
_FILE = "findings.csv"

Outcome = Counter[tuple[str, str, str]]


def outcome(rows: Iterable[dict[str, Any]]) -> Outcome:
    """How often each finding occurs.

    Parameters
    ----------
    rows : iterable of dict
        Rows of a reproduction

    Returns
    -------
    outcome : Counter
        (source, item, verdict) to count; the item is `*` for what is plainly reproduced
    """
    return Counter((r["source"], "*" if r["verdict"] == REPRODUCED else r["item"], r["verdict"]) for r in rows)


def recorded(sources: Sequence[str]) -> Outcome:
    """The recorded outcome of some sources.

    Parameters
    ----------
    sources : sequence of str
        File stems

    Returns
    -------
    outcome : Counter
        As from `outcome`
    """
    text = (resources.files("mechsym.reproduce") / _FILE).read_text(encoding="utf-8")
    lines = csv.DictReader(io.StringIO(text))
    return Counter({(r["source"], r["item"], r["verdict"]): int(r["rows"]) for r in lines if r["source"] in sources})


def differences(found: Outcome, known: Outcome) -> list[str]:
    """What is new and what is gone.

    Parameters
    ----------
    found, known : Counter
        Outcome now and as recorded

    Returns
    -------
    lines : list of str
        Empty when both are the same
    """
    changed = [key for key in sorted(found.keys() | known.keys()) if found[key] != known[key]]
    return [f"{', '.join(key)}: {known[key]} rows as recorded, {found[key]} now" for key in changed]


def record(rows: Sequence[dict[str, Any]], path: Path | None = None) -> Path:
    """Record the outcome of a run over all sources as the one to compare with.

    Parameters
    ----------
    rows : sequence of dict
        Rows of all sources
    path : Path, optional
        Another file than the package's

    Returns
    -------
    path : Path
        File written
    """
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(_COLUMNS)
    writer.writerows((*key, count) for key, count in sorted(outcome(rows).items()))
    return write_text(path or Path(str(resources.files("mechsym.reproduce") / _FILE)), buffer.getvalue())

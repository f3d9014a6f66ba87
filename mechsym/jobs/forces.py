"""`mechsym forces`: the forces of a case over one cycle at constant speed."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from mechsym.cases import Case
from mechsym.forces import report, result
from mechsym.forces.comparison import ComparisonSettings, compare
from mechsym.forces.result import Forces
from mechsym.forces.rings import NoRings
from mechsym.jobs.gas import of
from mechsym.jobs.turn import turn


def forces(case: Case, comparison: bool = False) -> Forces:
    """Forces of a case over one cycle at constant speed.

    Parameters
    ----------
    case : Case
        See `turn`; `[friction]`, `[rings]`, `[shaking]` and `[comparison]` are read where they stand
    comparison : bool
        Whether the mechanisms are put side by side as well

    Examples
    --------
    >>> from mechsym import cases
    >>> found = forces(cases.load("zotov-89"))
    >>> round(float(found.columns["crank_pin_load"].max()) / 1e3, 1)
    485.8
    """
    one, given = turn(case), case.sections
    friction, rings = given.get("friction"), given.get("rings", NoRings())
    found = result.forces(one, friction, rings, given.get("shaking"))
    if not comparison:
        return found
    with of(case):
        rows = compare(one, friction, rings, given.get("comparison", ComparisonSettings()))
    return replace(found, comparison=rows)


def write(case: Case, found: Forces, numbers: dict[str, Any], folder: Path) -> list[Path]:
    """Write page, tables, summary and pictures.

    Parameters
    ----------
    folder : Path
        Where to write; made when missing
    """
    return report.write(found, numbers, folder, case.about)

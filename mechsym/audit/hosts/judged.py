"""What is said of an equation of a text."""

from mechsym.audit.judge.conventions import told
from mechsym.audit.row import Row
from mechsym.audit.verdict import RIGHT_WITH
from mechsym.quantities import record

AGREES = "units agree"
OTHER_SENSE = f"{RIGHT_WITH} {told(('sign',))}"  # what nothing tells of a quantity that may be counted the other way


@record
class Judged:
    """What is said of an equation."""

    verdict: str
    matched: str = ""  #: What it was compared with
    note: str = ""
    error: float | None = None  #: Largest relative difference over the states compared [-]
    correction: str | None = None
    follows: tuple[str, ...] = ()


def passed(row: Row, matched: str) -> Judged:
    """The verdict of a formula that is right."""
    return Judged(verdict=row["verdict"], matched=matched, note=row["note"], error=row["max_rel_error"])

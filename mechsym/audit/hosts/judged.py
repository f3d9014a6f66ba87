"""What is said of an equation of a text."""

from mechsym.audit.judge.twins import Twins
from mechsym.audit.row import Row
from mechsym.audit.verdict import RIGHT_WITH
from mechsym.quantities import record

AGREES = "units agree"


@record
class Judged:
    """What is said of an equation."""

    verdict: str
    matched: str = ""  #: What it was compared with
    note: str = ""
    error: float | None = None  #: Largest relative difference over the states compared [-]
    correction: str | None = None
    follows: tuple[str, ...] = ()


UNTOLD = Judged(verdict="untestable", note="nothing in the text or a theory is told of it")


def passed(row: Row, matched: str) -> Judged:
    """The verdict of a formula that is right."""
    return Judged(verdict=row["verdict"], matched=matched, note=row["note"], error=row["max_rel_error"])


def settled(row: Row) -> Row:
    """The row of a formula whose text leaves no other way of counting open: a misprint then."""
    head, _, rest = row["note"].partition("; ")
    if not row["correction"] or not head.startswith(RIGHT_WITH):
        return row
    return row | {"verdict": "misprint", "note": rest}


def of_other_left(twins: Twins, order: int) -> Judged | None:
    """The verdict of a row whose left side is the letter of the row before it."""
    meant = twins.other_left(order)
    if meant is None:
        return None
    said = twins.world.paper.said
    note = f"({said[meant[1]].name}) gives this letter already, and no equation gives {meant[0]}"
    return Judged(verdict="misprint", matched="the text", note=note, correction=f"{meant[0]} = {said[order].texts[1]}")

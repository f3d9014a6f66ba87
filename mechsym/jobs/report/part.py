"""A part of a report: what one command would say of a case, or why it says nothing."""

from typing import Any

from mechsym.page import Grid, View
from mechsym.plausible import Doubt
from mechsym.quantities import record

DONE, INFEASIBLE, REFUSED, LEFT_OUT = "done", "infeasible", "refused", "left out"


@record
class ReportPart:
    """One part, also one that failed."""

    name: str  #: The command that gives it
    title: str
    state: str = (
        DONE  #: `done`, `infeasible` (or not converged), `refused` (bad input), `left out` (what it needs is not there)
    )
    reason: str = ""  #: Why it is not done
    view: View | None = None
    verdict: str = ""  #: One sentence for the first page
    facts: tuple[str, ...] = ()
    grids: tuple[Grid, ...] = ()
    limits: tuple[str, ...] = ()  #: What limits the design, the tightest first
    decide: tuple[str, ...] = ()  #: What somebody has to decide
    silent: tuple[str, ...] = ()  #: What it does not say
    numbers: Any = None  #: As the command gives them with --json
    doubts: tuple[Doubt, ...] = ()

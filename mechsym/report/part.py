"""One part of a report, also one that failed, and what has to be known before its numbers."""

from collections.abc import Callable
from typing import Any

from mechsym.files import Json
from mechsym.page import Finding, Grid, View
from mechsym.page.finding import NOT_MET
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
    turning: Callable[[], list[Json]] = list  #: Scenes of what turns at the head of the report
    beside: tuple[Finding, ...] = ()  #: What has to be known first besides what its view says

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What has to be known before its numbers."""
        if self.state == REFUSED:
            return (Finding(rank=NOT_MET, words=f"{self.title} could not be computed: {self.reason}"),)
        return (*(self.view.findings() if self.view else ()), *self.beside)

"""One part of a report, also one that failed or that only moves, and what has to be known before its numbers."""

from collections.abc import Callable
from typing import Any

from mechsym.cases import Case
from mechsym.files import Json
from mechsym.forces import driven
from mechsym.jobs.forces import motion
from mechsym.page import Finding, Grid, View, grid
from mechsym.page.finding import NOT_MET
from mechsym.plausible import Doubt
from mechsym.quantities import record
from mechsym.quantities.display import quantity_text

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
    numbers: Any = None  #: The result that the command gives
    doubts: tuple[Doubt, ...] = ()
    turning: Callable[[], list[Json]] = list  #: Scenes of what turns at the head of the report
    beside: tuple[Finding, ...] = ()  #: What has to be known first besides what its view says

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What has to be known before its numbers."""
        if self.state == REFUSED:
            return (Finding(rank=NOT_MET, words=f"{self.title} could not be computed: {self.reason}"),)
        return (*(self.view.findings() if self.view else ()), *self.beside)


def over_time(title: str, case: Case) -> ReportPart:
    """Drives, and what bears what, of a mechanism that moves as `[motion]` says."""
    moved = motion(case)
    numbers = driven.numbers(moved, case.name)
    units = numbers.max.units
    shown = [name for name, unit in units.items() if name in moved.one.driven or unit in ("N", "N*m", "W")]
    ends = {"most": numbers.max, "least": numbers.min}
    rows = [{"quantity": n} | {end: quantity_text(of[n], units[n], 4) for end, of in ends.items()} for n in shown]
    drives = {q: f"driving_{q}" for q in numbers.driven}
    largest = {q: max(abs(numbers.max[name]), abs(numbers.min[name])) for q, name in drives.items()}
    most = [f"{quantity_text(largest[q], units[name], 4)} along {q}" for q, name in drives.items()]
    return ReportPart(
        name="forces", title=title, view=driven.view(moved),
        verdict=f"The drives give at most, either way, {', '.join(most)} in {quantity_text(numbers.t_end, 's')}.",
        grids=(grid("Drives and what bears what, over time", rows, ["quantity", "most", "least"]),),
        silent=("rigid links without play; friction is that of the declaration",), numbers=numbers,
    )  # fmt: skip

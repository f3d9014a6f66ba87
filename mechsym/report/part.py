"""One part of a report, also one that failed, and what has to be known before its numbers.

And the report in numbers, as `mechsym report --json` tells it.
"""

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from mechsym.cases import Case
from mechsym.cycle.columns import CycleColumns
from mechsym.files import Json
from mechsym.forces import driven
from mechsym.hinge.summary import HingeNumbers
from mechsym.jobs.forces import ForceReport, motion
from mechsym.jobs.measured import MeasuredDiagram
from mechsym.page import Finding, Grid, View, grid
from mechsym.page.finding import NOT_MET
from mechsym.plausible import Doubt
from mechsym.quantities import record
from mechsym.quantities.display import quantity_text
from mechsym.quantities.results import part, result, tell
from mechsym.report.build import CaseReport
from mechsym.simulate.result import RunNumbers
from mechsym.sizing.rows import SizeRow

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
    pressed: Callable[[Json], Json] | None = None  #: Adds what presses in the joints to a scene of the machine
    beside: tuple[Finding, ...] = ()  #: What has to be known first besides what its view says

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What has to be known before its numbers."""
        if self.state == REFUSED:
            return (Finding(rank=NOT_MET, words=f"{self.title} could not be computed: {self.reason}"),)
        return (*(self.view.findings() if self.view else ()), *self.beside)


@result
class PartNumbers:
    """A part of a report."""

    state: str = part()
    reason: str = part()
    result: CycleColumns | MeasuredDiagram | HingeNumbers | ForceReport | Sequence[SizeRow] | RunNumbers | None = part()


@result
class CaseNumbers:
    """A case of a report."""

    case: str = part()
    sha256: str = part()
    parts: Mapping[str, PartNumbers] = part()  #: What each command tells
    values: list[dict[str, str]] = part()  #: Every value with its meaning and where it comes from


@result
class ReportNumbers:
    """Reports of one or more cases, and the files that were written."""

    reports: list[CaseNumbers] = part()
    written: list[str] = part()


def numbers(reports: Sequence[CaseReport], files: Sequence[Path]) -> ReportNumbers:
    """Reports in numbers."""
    told = [
        CaseNumbers(
            case=one.case.name,
            sha256=one.digest,
            parts={p.name: PartNumbers(state=p.state, reason=p.reason, result=p.numbers) for p in one.parts},
            values=[dataclasses.asdict(value) for value in one.values],
        )
        for one in reports
    ]
    return ReportNumbers(reports=told, written=[str(file) for file in files])


def over_time(title: str, case: Case) -> ReportPart:
    """Drives, and what bears what, of a mechanism that moves as `[motion]` says."""
    found = motion(case)
    numbers = driven.numbers(found, case.name)
    units = numbers.max.units
    shown = [name for name, unit in units.items() if name in found.one.driven or unit in ("N", "N*m", "W")]
    ends = {"largest": numbers.max, "smallest": numbers.min}
    rows = [{"quantity": n} | {end: quantity_text(of[n], units[n], 4) for end, of in ends.items()} for n in shown]
    most = [f"{quantity_text(numbers.max[f'driving_{q}'], units[f'driving_{q}'], 4)} along {q}" for q in numbers.driven]
    return ReportPart(
        name="forces", title=title, view=driven.view(found),
        verdict=f"The drives give at most {' and '.join(most)} in {quantity_text(numbers.t_end, 's')}.",
        grids=(grid("Drives and what bears what, over time", rows, ["quantity", "largest", "smallest"]),),
        silent=("rigid links without play; friction is that of the declaration",), numbers=tell(numbers),
    )  # fmt: skip

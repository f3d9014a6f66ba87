"""A report in numbers, as `mechsym report --json` tells it."""

import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path

from mechsym.cycle.columns import CycleColumns
from mechsym.hinge.summary import HingeNumbers
from mechsym.jobs.forces import ForceReport
from mechsym.jobs.measured import MeasuredDiagram
from mechsym.quantities.results import part, result
from mechsym.report.build import CaseReport
from mechsym.simulate.result import RunNumbers
from mechsym.sizing.rows import SizeRow


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
    each = [
        CaseNumbers(
            case=one.case.name,
            sha256=one.digest,
            parts={p.name: PartNumbers(state=p.state, reason=p.reason, result=p.numbers) for p in one.parts},
            values=[dataclasses.asdict(value) for value in one.values],
        )
        for one in reports
    ]
    return ReportNumbers(reports=each, written=[str(file) for file in files])

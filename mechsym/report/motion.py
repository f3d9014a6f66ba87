"""The part of a report on a mechanism that moves as its `[motion]` says."""

from mechsym.cases import Case
from mechsym.forces import driven
from mechsym.jobs.forces import motion
from mechsym.page import grid
from mechsym.quantities.display import quantity_text
from mechsym.quantities.results import tell
from mechsym.report.part import ReportPart


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

"""What `sweep` and `study` share: doubts of a sweep, its time, its files, its numbers."""

import contextlib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym.cli.common import doubted, in_rows
from mechsym.errors import BadInput, MissingExtra
from mechsym.files import Json
from mechsym.interrupts import asked_to_stop, whole
from mechsym.plausible import Doubt, proportion
from mechsym.quantities.units import Second

if TYPE_CHECKING:
    import numpy as np

    from mechsym.sweep.run import Layout, Plan, Sweep

_UNKEPT = 1800.0  # time of a processor from which a sweep without --out is refused: too much to lose [s]
_NUMBERS = ("min", "max", "mean", "std")
INTERRUPTED = 130  # as everywhere when a run is stopped from the keyboard


def judge(plan: "Plan", points: "Layout") -> None:
    """Put the doubts of a case, and of it at the ends of the axes, into what the command prints."""
    from mechsym.sweep import ends

    doubted(plan.case, plan.overrides)
    for end in ends(points):
        with contextlib.suppress(BadInput):  # a point that is refused is a gap
            doubted(plan.case, {**plan.overrides, **points.ties.at(end)})


def kept_or_short(count: int, seconds: Second, out: Path | None) -> None:
    """Refuse long work that leaves nothing; make the folder of what is kept. seconds: of all on one processor."""
    from mechsym.files import make_folder

    if out is not None:
        make_folder(out)
    elif seconds > _UNKEPT:
        raise BadInput(
            f"the sweep has {count} points, about {seconds / 60:.0f} minutes of a processor ({seconds / count:g} s "
            "each), and without --out nothing of it is kept; give --out DIR, where the same command goes on if it is "
            "stopped, or fewer points"
        )


def ended(found: "Sweep", finish: Callable[["Sweep"], None]) -> "Sweep":
    """A sweep, written by `finish`: after an interrupt, in the writing too, what is finished, however long it takes."""
    if not found.interrupted:
        with asked_to_stop():
            finish(found)
            return found
        found = replace(found, interrupted=True)
    with whole():
        finish(found)
    return found


def picture_of(found: "Sweep", name: str = "") -> str:
    """The picture of a sweep as SVG; empty where there is nothing to draw, or no time after an interrupt.

    name: keeps its ids its own on a page.
    """
    if found.interrupted:
        return ""
    from mechsym.style import svg
    from mechsym.sweep import plots as plots_sweep

    figure = plots_sweep.picture(found)
    return "" if figure is None else svg(figure, name)


def write(found: "Sweep", out: Path, picture: str) -> list[Path]:
    """Table, netCDF where it can be written, picture; after an interrupt the table alone."""
    from mechsym.files import write_text
    from mechsym.sweep import store, write_netcdf, write_table

    files = [write_table(found, out)]
    if found.interrupted:
        return [*files, out / store.NAME]
    try:
        files.append(write_netcdf(found, out))
    except MissingExtra as error:
        click.echo(f"no netCDF file: {error}", err=True)
    pictures = [write_text(out / "sweep.svg", picture)] if picture else []
    return [*files, *pictures, out / store.NAME]


def gaps(found: "Sweep") -> tuple[Doubt, ...]:
    """A sweep whose points are all refused."""
    refused = [o for o in found.outcomes if getattr(o, "of_input", False)]
    return proportion("gaps", "points that are refused / all", len(refused) / len(found.outcomes))


def rows_of(found: "Sweep") -> list[Json]:
    """Smallest and largest of the main results and where they are, each in the unit that suits it."""
    from mechsym.sweep import main_results

    rows = [_row(found, name, column) | {"unit": found.units[name]} for name, column in main_results(found).items()]
    return in_rows(rows, _NUMBERS)


def _row(found: "Sweep", name: str, column: "np.ndarray") -> Json:
    import numpy as np

    ends = np.nanmin(column), np.nanmax(column)
    # of points that differ by round-off the first
    low, high = (int(np.flatnonzero(np.abs(column - end) <= 1e-12 * np.abs(end))[0]) for end in ends)
    numbers = dict(zip(_NUMBERS, map(float, (*ends, np.nanmean(column), np.nanstd(column))), strict=True))
    largest = max(map(abs, numbers.values()))
    return {
        "name": name, "at min": place(found, low), "at max": place(found, high),
        **{key: 0.0 if abs(v) < 1e-12 * largest else v for key, v in numbers.items()},
    }  # fmt: skip


def place(found: "Sweep", index: int) -> str:
    """Where a point is, in words."""
    parts = [(a, v if isinstance(v, str) else f"{v:.6g}") for a, v in zip(found.axes, found.points[index], strict=True)]
    plain = {"-", *(a.unit for a, _ in parts if a.key.endswith(f"_{a.unit}"))}  # the name carries it; else SI
    units = {a.key: a.suffix or ("" if a.unit in plain else a.unit) for a, _ in parts}
    return ", ".join(f"{a.key}={v} {units[a.key]}".rstrip() for a, v in parts)

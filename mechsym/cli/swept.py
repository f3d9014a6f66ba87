"""What `sweep` and `study` share: doubts of a sweep, its time, its files, its numbers."""

import contextlib
from pathlib import Path
from typing import Any

import click

from mechsym.cli.common import case_of, in_rows
from mechsym.errors import BadInput, MissingExtra

_UNKEPT = 1800.0  # time of a processor from which a sweep without --out is refused: too much to lose [s]
_NUMBERS = ("min", "max", "mean", "std")
INTERRUPTED = 130  # as everywhere when a run is stopped from the keyboard


def judge(plan: Any, points: Any) -> None:
    """Put the doubts of a case, and of it at the ends of the axes, into what the command prints."""
    from mechsym.sweep import ends

    case_of(plan.case, plan.overrides)
    for end in ends(points):
        with contextlib.suppress(BadInput):  # a point that is refused is a gap
            case_of(plan.case, {**plan.overrides, **points.ties.at(end)})


def kept_or_short(count: int, seconds: float, out: Path | None) -> None:
    """Refuse long work that nothing would be left of; make the folder of what is kept.

    Parameters
    ----------
    seconds : float
        What all points take on one processor [s]
    """
    from mechsym.files import make_folder

    if out is not None:
        make_folder(out)
    elif seconds > _UNKEPT:
        raise BadInput(
            f"the sweep has {count} points, about {seconds / 60:.0f} minutes of a processor ({seconds / count:g} s "
            "each), and without --out nothing of it is kept; give --out DIR, where the same command goes on if it is "
            "stopped, or fewer points"
        )


def picture_of(found: Any, name: str = "") -> str:
    """The picture of a sweep as SVG; empty where there is nothing to draw. `name` keeps its ids its own on a page."""
    from mechsym.style import svg
    from mechsym.sweep import plots as plots_sweep

    figure = plots_sweep.picture(found)
    return "" if figure is None else svg(figure, name)


def write(found: Any, out: Path, picture: str) -> list[Path]:
    """Table, netCDF where it can be written, picture."""
    from mechsym.files import write_text
    from mechsym.sweep import store, write_netcdf, write_table

    files = [write_table(found, out)]
    try:
        files.append(write_netcdf(found, out))
    except MissingExtra as error:
        click.echo(f"no netCDF file: {error}", err=True)
    pictures = [write_text(out / "sweep.svg", picture)] if picture else []
    return [*files, *pictures, out / store.NAME]


def report_of(found: Any, files: list[Path]) -> dict[str, Any]:
    """A sweep as JSON."""
    from mechsym.sweep import columns, failures
    from mechsym.sweep.sensitivity import indices

    sampled, data = "sample" in found.dims, columns(found)
    reasons = failures(found)
    return {
        "case": found.case,
        "analysis": found.analysis,
        "dims": dict(found.dims),
        "shape": list(found.dims.values()),
        "axes": {
            a.key: {"unit": a.unit, "values": [p[i] for p in found.points] if sampled else list(a.values)}
            for i, a in enumerate(found.axes)
        },
        "units": {name: found.units[name] for name in data},
        # a word that is not there is null, as a number
        "data": {name: [v if v != "" else None for v in column.tolist()] for name, column in data.items()},
        "failed": [{"index": i, "at": _values(found, i), "reason": reason} for i, reason in reasons.items()],
        "sobol": [vars(row) for row in indices(found)] if found.sobol else [],
        "interrupted": found.interrupted,
        "kept": found.kept,
        "set_aside": found.aside or None,
        "files": [str(f) for f in files],
    }


def rows_of(found: Any) -> list[dict[str, Any]]:
    """Smallest and largest of the main results and where they are, each in the unit that suits it."""
    from mechsym.sweep import main_results

    rows = [_row(found, name, column) | {"unit": found.units[name]} for name, column in main_results(found).items()]
    return in_rows(rows, _NUMBERS)


def _row(found: Any, name: str, column: Any) -> dict[str, Any]:
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


def _values(found: Any, index: int) -> dict[str, Any]:
    return {a.key: v for a, v in zip(found.axes, found.points[index], strict=True)}


def place(found: Any, index: int) -> str:
    """Where a point is, in words."""
    parts = [(a, v if isinstance(v, str) else f"{v:.6g}") for a, v in zip(found.axes, found.points[index], strict=True)]
    plain = {"-", *(a.unit for a, _ in parts if a.key.endswith(f"_{a.unit}"))}  # the name carries it; else SI
    units = {a.key: a.suffix or ("" if a.unit in plain else a.unit) for a, _ in parts}
    return ", ".join(f"{a.key}={v} {units[a.key]}".rstrip() for a, v in parts)

"""`mechsym sweep`: a case at many points, side by side."""

import contextlib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym.cli.common import (
    doubted,
    emit,
    in_rows,
    json_option,
    out_option,
    pairs,
    progress,
    refuse_idle,
    set_option,
    table,
)
from mechsym.errors import BadInput, MissingExtra
from mechsym.files import Json
from mechsym.interrupts import asked_to_stop, whole
from mechsym.plausible import Doubt, proportion
from mechsym.quantities.units import Second

if TYPE_CHECKING:
    from mechsym.sweep.data import SweepNumbers
    from mechsym.sweep.run import Layout, Plan, Sweep

_ANALYSES = ["simulate", "hinge", "guides", "cycle", "forces", "size", "codesign"]


@click.command(short_help="Run a case over ranges of its values.")
@click.argument("case")
@click.option("--over", multiple=True, required=True, metavar="KEY=RANGE", help="a..b UNIT:n, a list, a..b or m+-s.")
@click.option("--of", "analysis", type=click.Choice(_ANALYSES), help="What to compute.")
@click.option("--samples", type=click.IntRange(min=1), help="Monte Carlo: so many samples of ranges a..b and m+-s.")
@click.option("--sobol", type=click.IntRange(min=2), help="Sobol indices out of so many base samples: a power of two.")
@click.option("--tie", "tied", multiple=True, metavar="KEY=FORMULA", help="A value that follows from others.")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of the samples.")
@click.option("--show", multiple=True, metavar="NAME", help="Compute only this result or group; all: everything.")
@click.option("--jobs", type=click.IntRange(min=1), help="Processes; as many as pay off where left away.")
@click.option("--scheduler", default="", metavar="ADDRESS", help="Compute on a dask cluster: tcp://HOST:8786.")
@click.option("--fresh", is_flag=True, help="Compute all points again, whatever --out keeps.")
@set_option
@out_option
@json_option
@click.pass_context
def sweep(ctx: click.Context, case: str, over: tuple[str, ...], analysis: str | None, samples: int | None,
          sobol: int | None, tied: tuple[str, ...], seed: int, show: tuple[str, ...], jobs: int | None, scheduler: str,
          fresh: bool, overrides: tuple[str, ...], out: Path | None) -> None:  # fmt: skip
    """Run CASE over ranges of its values; results as one labelled data set.

    A driven shaft is simulated, an engine with a spring gets its hinge, another engine runs its cycle; --of chooses
    these or guides, forces, size, codesign.
    With --out: sweep.csv, sweep.nc (where xarray is installed) and sweep.svg; sweep.db takes the points as they come,
    and the same command goes on where it stopped, whatever stopped it; another sweep sets it aside.

    Of a hinge only torque, guide, verdict and flywheel are computed; --show check.speed_ripple runs it too, and
    --show retune, --show losses, --show all cost a hundred times as much. --of guides asks only which guides can be
    built: margins of all limits by one compiled function, within 1e-4 of those of --of hinge.

    --tie makes a value follow from others at every point, by a formula in SI over keys of the case and letters that an
    earlier --tie defines. --sobol N runs (axes + 2) N samples and tells how much of each result's variance a value
    brings by itself and with the others, each with a 95 % interval.

    A point that cannot be computed is a gap with a reason: null, an empty cell, NaN; one that kills its process is
    tried once more. Exit status 1 when all are gaps. An interrupt (Ctrl-C, SIGTERM) keeps the points that are finished,
    writes their table and ends within a second with status 130. What takes more than half an hour of a processor needs
    --out.

    \b
    Examples: mechsym sweep zotov-89 --over "spring.p0=3..8 MPa:11" --over speed_rpm=80,89,100 --out map
              mechsym sweep zotov-89 --of guides --over "spring.p0=2..9 MPa:60" --over spring.H=0.6..1.4:60 --out map
              mechsym sweep chmielewski --over c1=0.1..5:50 --show speed_max
              mechsym sweep chmielewski --samples 200 --over "k1=6500+-200 N*m/rad" --over m0=1.0..1.2
              mechsym sweep nunes-hypocycloid --over "e=11..15 mm:9" --tie "bore=sqrt(2.94e-4/(2*pi*e))"
              mechsym sweep chmielewski --sobol 64 --over "k1=6500+-200 N*m/rad" --over m0=1.0..1.2
              mechsym sweep nunes-slider-crank --over speed_rpm=1000..8000:71 --over "ignition=-25..-5 deg:21"
    """
    from mechsym import sweep as sweeps
    from mechsym.sweep.data import numbers

    if not samples and not sobol:
        refuse_idle("without --samples or --sobol", "seed")
    plan = sweeps.Plan(
        case=case, over=over, overrides=pairs(overrides), analysis=analysis, samples=samples, seed=seed, show=show,
        sobol=sobol, tied=tied,
    )  # fmt: skip
    points = sweeps.layout(plan)
    count = len(points.points)
    judge(plan, points)
    seconds = sweeps.forecast(plan, count)
    kept_or_short(count, 0.0 if scheduler else seconds, out)
    means = sweeps.Means(jobs=jobs or 0, folder=out, fresh=fresh, scheduler=scheduler)
    with progress(count, f"sweep of {case}, about {max(seconds, 1):.0f} s of a processor") as bar:
        result = sweeps.sweep(plan, bar.update, means)

    def finish(result: "Sweep") -> None:
        summary = numbers(result, [] if out is None else write(result, out, picture_of(result)))
        # the table tells which points an interrupt has left
        left, beside = ("data", "failed") if result.interrupted else ("data",), {"doubts": gaps(result)}
        emit(summary, lambda: _text(result, summary), beside=beside, leave_out=left, files=summary.files)

    result = ended(result, finish)
    ctx.exit(INTERRUPTED if result.interrupted else 1 if len(sweeps.failures(result)) == count else 0)


def _text(result: "Sweep", summary: "SweepNumbers") -> str:
    sampled, rows = "sample" in result.dims, rows_of(result)
    dims = " x ".join(f"{size} {name}" for name, size in result.dims.items())
    lines = [f"{result.analysis} of {result.case} over {dims}: {len(summary.failed)} of {len(result.points)} failed"]
    lines += [f"{result.kept} points kept from before"] if result.kept else []
    lines += [f"the folder's points of another sweep are set aside in {result.aside}"] if result.aside else []
    if rows:
        spread = ["mean", "std"] if sampled else []
        lines += ["", table(rows, ["name", "unit", "min", "at min", "max", "at max", *spread], named=["name"]), ""]
        if more := len(summary.data) - len(rows):
            runs = result.analysis == "hinge" and not result.show
            further = "; check, runs, retune, sensitivity, losses, misfire_speed_share with --show" * runs
            lines.append(f"{more} more results with --json or --out{further}")
    if summary.sobol:
        indices = [
            {
                "result": one.result,
                "value": one.key,
                "first": f"{one.first:.3f} ({one.first_low:.3f} to {one.first_high:.3f})",
                "total": f"{one.total:.3f} ({one.total_low:.3f} to {one.total_high:.3f})",
            }
            for one in summary.sobol
        ]
        shown = table(indices, ["result", "value", "first", "total"], named=["result", "value"])
        lines += ["Sobol indices, with 95 % intervals", shown, ""]
    lines += [f"failed at {place(result, gap.index)}: {gap.reason}" for gap in summary.failed[:5]]
    if len(summary.failed) > 5:
        lines.append(f"and {len(summary.failed) - 5} more")
    return "\n".join(lines)


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


def ended(result: "Sweep", finish: Callable[["Sweep"], None]) -> "Sweep":
    """A sweep, written by `finish`: after an interrupt, in the writing too, what is finished, however long it takes."""
    if not result.interrupted:
        with asked_to_stop():
            finish(result)
            return result
        result = replace(result, interrupted=True)
    with whole():
        finish(result)
    return result


def picture_of(result: "Sweep", name: str = "") -> str:
    """The picture of a sweep as SVG; empty where there is nothing to draw, or no time after an interrupt.

    name: keeps its ids its own on a page.
    """
    if result.interrupted:
        return ""
    from mechsym.style import svg
    from mechsym.sweep.plots import picture

    figure = picture(result)
    return "" if figure is None else svg(figure, name)


def write(result: "Sweep", out: Path, picture: str) -> list[Path]:
    """Table, netCDF where it can be written, picture; after an interrupt the table alone."""
    from mechsym.files import write_text
    from mechsym.sweep import store, write_netcdf, write_table

    files = [write_table(result, out)]
    if result.interrupted:
        return [*files, out / store.NAME]
    try:
        files.append(write_netcdf(result, out))
    except MissingExtra as error:
        click.echo(f"no netCDF file: {error}", err=True)
    pictures = [write_text(out / "sweep.svg", picture)] if picture else []
    return [*files, *pictures, out / store.NAME]


def gaps(result: "Sweep") -> tuple[Doubt, ...]:
    """A sweep whose points are all refused."""
    refused = [gap for gap in result.outcomes.gaps.values() if gap.of_input]
    return proportion("gaps", "points that are refused / all", len(refused) / len(result.outcomes))


def rows_of(result: "Sweep") -> list[Json]:
    """Smallest and largest of the main results and where they are, each in the unit that suits it."""
    import numpy as np

    from mechsym.sweep import main_results

    rows = []
    for name, column in main_results(result).items():
        ends = np.nanmin(column), np.nanmax(column)
        # of points that differ by no more than a run is known to the first
        low, high = (int(np.flatnonzero(np.abs(column - end) <= 1e-9 * np.abs(end))[0]) for end in ends)
        numbers = dict(zip(_NUMBERS, map(float, (*ends, np.nanmean(column), np.nanstd(column))), strict=True))
        largest = max(map(abs, numbers.values()))
        row = {"name": name, "unit": result.units[name], "at min": place(result, low), "at max": place(result, high)}
        rows.append(row | {key: 0.0 if abs(v) < 1e-12 * largest else v for key, v in numbers.items()})
    return in_rows(rows, _NUMBERS)


def place(result: "Sweep", index: int) -> str:
    """Where a point is, in words."""
    parts = [
        (a, v if isinstance(v, str) else f"{v:.6g}") for a, v in zip(result.axes, result.points[index], strict=True)
    ]
    plain = {"-", *(a.unit for a, _ in parts if a.key.endswith(f"_{a.unit}"))}  # the name carries it; else SI
    units = {a.key: a.suffix or ("" if a.unit in plain else a.unit) for a, _ in parts}
    return ", ".join(f"{a.key}={v} {units[a.key]}".rstrip() for a, v in parts)

"""`mechsym sweep`: a case at many points, side by side."""

import contextlib
from pathlib import Path
from typing import Any

import click

from mechsym.cli.common import case_of, emit, json_option, out_option, pairs, progress, set_option, table
from mechsym.errors import BadInput, MissingExtra

_ANALYSES = ["simulate", "hinge", "guides", "cycle", "forces", "size", "codesign"]
_UNKEPT = 1800.0  # time of a processor from which a sweep without --out is refused: too much to lose [s]
_INTERRUPTED = 130  # as everywhere when a run is stopped from the keyboard


@click.command(short_help="Run a case over ranges of its values.")
@click.argument("case")
@click.option("--over", multiple=True, required=True, metavar="KEY=RANGE", help="a..b UNIT:n, a list, a..b or m+-s.")
@click.option("--of", "analysis", type=click.Choice(_ANALYSES), help="What to compute.")
@click.option("--samples", type=click.IntRange(min=1), help="Monte Carlo: so many samples of ranges a..b and m+-s.")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of the samples.")
@click.option("--show", multiple=True, metavar="NAME", help="Compute only this result or group; all: everything.")
@click.option("--jobs", type=click.IntRange(min=1), help="Processes; as many as pay off where left away.")
@click.option("--scheduler", default="", metavar="ADDRESS", help="Compute on a dask cluster: tcp://HOST:8786.")
@click.option("--fresh", is_flag=True, help="Compute all points again, whatever --out keeps.")
@set_option
@out_option
@json_option
@click.pass_context
def sweep(ctx: click.Context, case: str, over: tuple[str, ...], analysis: str | None, samples: int | None, seed: int,
          show: tuple[str, ...], jobs: int | None, scheduler: str, fresh: bool, overrides: tuple[str, ...],
          out: Path | None, as_json: bool) -> None:  # fmt: skip
    """Run CASE over ranges of its values; results as one labelled data set.

    A driven shaft is simulated, an engine with a spring gets its hinge, another engine runs its cycle; --of chooses
    these or guides, forces, size, codesign.
    With --out: sweep.csv, sweep.nc (where xarray is installed) and sweep.svg; sweep.db takes the points as they come,
    and the same command goes on where it stopped, whatever stopped it.

    Of a hinge only torque, guide, verdict and flywheel are computed; --show check.speed_ripple runs it too, and
    --show retune, --show losses, --show all cost a hundred times as much. --of guides asks only which guides can be
    built: margins of all limits by one compiled function, within 1e-4 of those of --of hinge.

    A point that cannot be computed is a gap with a reason: null, an empty cell, NaN; one that kills its process is
    tried once more. Exit status 1 when all are gaps. An interrupt (Ctrl-C, SIGTERM) keeps the points that are finished,
    writes the files and ends with status 130. What takes more than half an hour of a processor needs --out.

    \b
    Examples: mechsym sweep zotov-89 --over "spring.p0=3..8 MPa:11" --over speed_rpm=80,89,100 --out map
              mechsym sweep zotov-89 --of guides --over "spring.p0=2..9 MPa:60" --over spring.H=0.6..1.4:60 --out map
              mechsym sweep chmielewski --over c1=0.1..5:50 --show speed_max
              mechsym sweep chmielewski --samples 200 --over "k1=6500+-200 N*m/rad" --over m0=1.0..1.2
              mechsym sweep nunes-slider-crank --over speed_rpm=1000..8000:71 --over "ignition=-25..-5 deg:21"
    """
    from mechsym import sweep as sweeps
    from mechsym.files import make_folder

    plan = sweeps.Plan(
        case=case, over=over, overrides=pairs(overrides), analysis=analysis, samples=samples, seed=seed, show=show
    )
    points = sweeps.layout(plan)
    count = len(points.points)
    case_of(case, pairs(overrides))
    for ends in sweeps.ends(points):
        with contextlib.suppress(BadInput):  # a point that is refused is a gap
            case_of(case, {**pairs(overrides), **ends})
    seconds = sweeps.forecast(plan, count)
    if out is not None:
        make_folder(out)
    elif seconds > _UNKEPT and not scheduler:
        raise BadInput(
            f"the sweep has {count} points, about {seconds / 60:.0f} minutes of a processor ({seconds / count:g} s "
            "each), and without --out nothing of it is kept; give --out DIR, where the same command goes on if it is "
            "stopped, or fewer points"
        )
    with progress(count, f"sweep of {case}, about {max(seconds, 1):.0f} s of a processor") as bar:
        found = sweeps.sweep(
            plan, bar.update, sweeps.Means(jobs=jobs or 0, folder=out, fresh=fresh, scheduler=scheduler)
        )
    report = _report(found, [] if out is None else _write(found, out))
    emit(report, as_json, lambda: _text(found, report), leave_out=("data",))
    ctx.exit(_INTERRUPTED if found.interrupted else 1 if len(report["failed"]) == count else 0)


def _write(found: Any, out: Path) -> list[Path]:
    from mechsym.files import write_text
    from mechsym.style import svg
    from mechsym.sweep import plots as plots_sweep
    from mechsym.sweep import store, write_netcdf, write_table

    files = [write_table(found, out)]
    try:
        files.append(write_netcdf(found, out))
    except MissingExtra as error:
        click.echo(f"no netCDF file: {error}", err=True)
    figure = plots_sweep.picture(found)
    pictures = [] if figure is None else [write_text(out / "sweep.svg", svg(figure))]
    return [*files, *pictures, out / store.NAME]


def _report(found: Any, files: list[Path]) -> dict[str, Any]:
    from mechsym.sweep import columns, failures
    from mechsym.sweep.units import unit_of

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
        "units": {name: unit_of(name) for name in data},
        # a word that is not there is null, as a number
        "data": {name: [v if v != "" else None for v in column.tolist()] for name, column in data.items()},
        "failed": [{"index": i, "at": _values(found, i), "reason": reason} for i, reason in reasons.items()],
        "interrupted": found.interrupted,
        "kept": found.kept,
        "files": [str(f) for f in files],
    }


def _text(found: Any, report: dict[str, Any]) -> str:
    from mechsym.sweep import main_results
    from mechsym.sweep.units import unit_of

    sampled, main = "sample" in found.dims, main_results(found)
    rows = [_row(found, name, column) | {"unit": unit_of(name)} for name, column in main.items()]
    dims = " x ".join(f"{size} {name}" for name, size in found.dims.items())
    lines = [f"{found.analysis} of {found.case} over {dims}: {len(report['failed'])} of {len(found.points)} failed"]
    lines += [f"{found.kept} points kept from before"] if found.kept else []
    if rows:
        spread = ["mean", "std"] if sampled else []
        lines += ["", table(rows, ["name", "unit", "min", "at min", "max", "at max", *spread]), ""]
        lines += [f"{len(report['data']) - len(rows)} more results with --json or --out" + _more(found)]
    lines += [f"failed at {_place(found, f['index'])}: {f['reason']}" for f in report["failed"][:5]]
    if len(report["failed"]) > 5:
        lines.append(f"and {len(report['failed']) - 5} more")
    return "\n".join([*lines, *(f"wrote {f}" for f in report["files"])])


def _more(found: Any) -> str:
    runs = found.analysis == "hinge" and not found.show
    return "; check, runs, retune, sensitivity, losses, misfire_speed_share with --show" if runs else ""


def _row(found: Any, name: str, column: Any) -> dict[str, Any]:
    import numpy as np

    low, high = int(np.nanargmin(column)), int(np.nanargmax(column))
    return {
        "name": name, "min": float(column[low]), "at min": _place(found, low), "max": float(column[high]),
        "at max": _place(found, high), "mean": float(np.nanmean(column)), "std": float(np.nanstd(column)),
    }  # fmt: skip


def _values(found: Any, index: int) -> dict[str, Any]:
    return {a.key: v for a, v in zip(found.axes, found.points[index], strict=True)}


def _place(found: Any, index: int) -> str:
    parts = [(a, v if isinstance(v, str) else f"{v:.6g}") for a, v in zip(found.axes, found.points[index], strict=True)]
    return ", ".join(f"{a.key}={v}{' ' + a.suffix if a.suffix else ''}" for a, v in parts)

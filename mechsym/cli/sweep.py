"""`mechsym sweep`: a case at many points, side by side."""

from pathlib import Path
from typing import Any

import click

from mechsym.cli.common import emit, json_option, out_option, pairs, progress, set_option, table


@click.command()
@click.argument("case")
@click.option("--over", multiple=True, required=True, metavar="KEY=RANGE", help="a..b UNIT:n, a list, a..b or m+-s.")
@click.option("--of", "analysis", type=click.Choice(["simulate", "hinge", "cycle"]), help="What to compute.")
@click.option("--samples", type=int, help="Monte Carlo: so many samples of the ranges and distributions.")
@click.option("--seed", default=0, show_default=True, help="Of the samples.")
@set_option
@out_option
@json_option
@click.pass_context
def sweep(
    ctx: click.Context,
    case: str,
    over: tuple[str, ...],
    analysis: str | None,
    samples: int | None,
    seed: int,
    overrides: tuple[str, ...],
    out: Path | None,
    as_json: bool,
) -> None:  # fmt: skip
    """Run CASE over ranges of its values; results as one labelled data set.

    A driven case is simulated, an engine with a spring gets its hinge, another engine runs its cycle; --of chooses.
    Points that fail are gaps with a reason. Exit status 1 when all of them failed.

    \b
    Examples: mechsym sweep zotov-89 --over "spring.p0=3..8 MPa:11" --over speed_rpm=80,89,100 --out map
              mechsym sweep chmielewski --over c1=0.1..5:50
              mechsym sweep chmielewski --samples 200 --over "k1=6500+-200 N*m/rad" --over m0=1.0..1.2
    """
    from mechsym import sweep_data
    from mechsym.files import make_folder
    from mechsym.sweep import Plan
    from mechsym.sweep import sweep as run
    from mechsym.sweep_axes import parse_axis, points

    axes = tuple(parse_axis(text) for text in over)
    plan = Plan(case=case, axes=axes, overrides=pairs(overrides), analysis=analysis, samples=samples, seed=seed)
    count = len(points(axes, samples, seed)[1])
    if out is not None:
        make_folder(out)
    with progress(count, f"sweep of {case}") as bar:
        found = run(plan, bar.update)
    report = _report(found, [] if out is None else sweep_data.write(found, out))
    emit(report, as_json, lambda: _text(found, report))
    ctx.exit(1 if len(report["failed"]) == count else 0)


def _report(found: Any, files: list[Path]) -> dict[str, Any]:
    from mechsym.sweep_data import columns, failures

    sampled = "sample" in found.dims
    values = {a.key: [p[i] for p in found.points] if sampled else list(a.values) for i, a in enumerate(found.axes)}
    return {
        "case": found.case,
        "analysis": found.analysis,
        "dims": dict(found.dims),
        "shape": list(found.dims.values()),
        "axes": {a.key: {"unit": a.unit or "SI", "values": values[a.key]} for a in found.axes},
        "data": {name: column.tolist() for name, column in columns(found).items()},
        "failed": [{"index": i, "reason": reason} for i, reason in failures(found).items()],
        "files": [str(f) for f in files],
    }


def _text(found: Any, report: dict[str, Any]) -> str:
    import numpy as np

    rows, sampled = [], "sample" in found.dims
    for name, column in report["data"].items():
        numbers = np.array([v for v in column if isinstance(v, float) and np.isfinite(v)])
        if numbers.size:
            spread = {"mean": float(numbers.mean()), "std": float(numbers.std())} if sampled else {}
            rows.append({"name": name, "min": float(numbers.min()), "max": float(numbers.max()), **spread})
    dims = " x ".join(f"{size} {name}" for name, size in found.dims.items())
    lines = [f"{found.analysis} of {found.case} over {dims}: {len(report['failed'])} of {len(found.points)} failed", ""]
    lines.append(table(rows, ["name", "min", "max", *(["mean", "std"] if sampled else [])]))
    lines += [f"failed at {_place(found, f['index'])}: {f['reason']}" for f in report["failed"][:5]]
    return "\n".join([*lines, *(f"wrote {f}" for f in report["files"])])


def _place(found: Any, index: int) -> str:
    return ", ".join(f"{a.key} = {v} {a.unit}".rstrip() for a, v in zip(found.axes, found.points[index], strict=True))

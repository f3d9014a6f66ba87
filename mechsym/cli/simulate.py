"""`mechsym simulate`: time simulation of a case."""

import dataclasses
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mechsym.cli.common import case_of, emit, json_option, out_option, pairs, set_option, table
from mechsym.errors import MissingExtra
from mechsym.files import write_text
from mechsym.quantities import ranges
from mechsym.quantities.display import figure, ratio_text

if TYPE_CHECKING:
    from mechsym.jobs.run import FinishedRun


@click.command(short_help="Simulate over time, with an energy audit.")
@click.argument("case")
@click.option("--tolerance", help="Tolerance of a step; the case's, or 1e-10.")
@click.option("--backend", help="Integrator by name, e.g. scipy-dop853, sundials, heyoka.")
@click.option("--no-check", is_flag=True, help="Leave out the second run at a hundredth of the tolerance.")
@click.option("--dampings", metavar="C1,C1..", help="Further values of c1 for a start-up, e.g. 0.2,1,5.")
@set_option
@out_option
@json_option
@click.pass_context
def simulate(
    ctx: click.Context,
    case: str,
    tolerance: str | None,
    backend: str | None,
    no_check: bool,
    dampings: str | None,
    overrides: tuple[str, ...],
    out: Path | None,
    as_json: bool,
) -> None:
    """Simulate CASE over time, with an energy audit and a check of the tolerance.

    Exit status 1 when the run did not converge; a stall is an event, not a failure. An engine needs no [simulation]:
    it turns 20 times from its speed of operation, without [load] against a propeller that takes its mean torque; the
    gas of spark ignition is integrated with the motion, as in cycle --loop. An elastic shaft reports the twist of each
    section. A crank train takes [drive] (a torque at the free end, switched on at a time), [cycle] or both.

    \b
    Example: mechsym simulate chmielewski --set c1=0.2 --out startup
             mechsym simulate nunes-hypocycloid --out engine
             mechsym simulate alpha-stirling --set c="5 N*m*s/rad"
             mechsym simulate alpha-stirling --set speed_start="250 rpm" --set simulation.turns=300
    """
    from mechsym.jobs.run import run

    options = {"simulation.tolerance": tolerance, "simulation.backend": backend}
    given = {k: v for k, v in options.items() if v is not None}
    found = case_of(case, pairs(overrides) | given)
    done = run(found, _dampings(dampings), "none" if no_check else "tolerance")
    report = _report(found.name, done)
    report["files"] = [] if out is None else _write(done, out)
    emit(report, as_json, lambda: _text(report))
    ctx.exit(1 if done.result.status in ("failed", "not converged", "chaotic") else 0)


def _dampings(text: str | None) -> tuple[float, ...]:
    return tuple(ranges.values(text, "N*m*s/rad", "--dampings", most=1000)) if text is not None else ()


def _report(name: str, run: "FinishedRun") -> dict[str, Any]:
    from mechsym.torsion.findings import numbers

    return {
        "case": name,
        "backend": run.settings.backend,
        "tolerance": run.settings.tolerance,
        **run.summary,
        "natural_frequencies": list(run.natural_frequencies),
        "twist": [dataclasses.asdict(s) for s in run.twist],
        "vibration": None if run.vibration is None else dataclasses.asdict(run.vibration),
        "findings": list(run.findings),
        "start_up": [numbers(s) for s in run.start_ups],
        "settling": dataclasses.asdict(run.settling) if run.settling else None,
        "doubts": run.doubts,
    }


def _write(run: "FinishedRun", out: Path) -> list[str]:
    from mechsym.simulate import write_netcdf, write_series
    from mechsym.style import svg

    result = run.result
    files = [write_series(result, out / "series.csv")]
    try:
        files.append(write_netcdf(result, out / "series.nc"))
    except MissingExtra as error:
        click.echo(f"no netCDF file: {error}", err=True)
    files += [write_text(out / f"{picture.name}.svg", svg(picture.draw())) for picture in run.view.pictures]
    return [str(f) for f in files]


def _text(report: dict[str, Any]) -> str:
    keys = ["t_end", "end", "status", "energy_residual", "tolerance_difference", "steps", "wall_s"]
    units = {"t_end": " s"}
    lines = [f"{key:22}{_figure(key, report[key])}{units.get(key, '')}" for key in keys]
    lines.append(f"{'reason':22}{report['reason']}")
    if report["event"]:
        lines.append(f"{'event':22}" + ", ".join(f"{k} {_number(v)}" for k, v in report["event"].items()))
    rows = [{"over the last": f"{report['window']:.6g} s", "of": c, **v} for c, v in report["speeds"].items()]
    rates = dict.fromkeys(("mean", "min", "max"), "rad/s")
    lines += ["", table(rows, ["over the last", "of", *rates], rates)]
    if report["twist"]:
        columns = ["section", "twist_mean", "twist_amplitude", "twist_peak", "torque_mean", "torque_amplitude"]
        natural = ", ".join(figure(f / math.tau, 4) for f in report["natural_frequencies"])
        lines += [
            "",
            table(report["twist"], columns, dict.fromkeys(columns[1:4], "rad")),
            f"natural frequencies {natural} Hz",
        ]
    if len(report["start_up"]) > 1:
        held = [{**s, "held_s": sum(c["t_end"] - c["t_start"] for c in s["captures"])} for s in report["start_up"]]
        lines += [
            "",
            table(held, ["c1", "held_s", "speed_mean_end", "twist_peak", "torque_peak", "model_holds"], _UNITS),
        ]
    if report["findings"]:
        lines += ["", *(f"- {line}" for line in report["findings"])]
    return "\n".join([*lines, *(f"wrote {f}" for f in report["files"])])


_UNITS = {"c1": "N*m*s/rad", "held_s": "s", "speed_mean_end": "rad/s", "twist_peak": "rad", "torque_peak": "N*m"}


def _figure(key: str, value: Any) -> str:
    return ratio_text(value) if key in ("energy_residual", "tolerance_difference") else _number(value)


def _number(value: Any) -> str:
    return f"{value:.8g}" if isinstance(value, float) else str(value)

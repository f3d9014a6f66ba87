"""`mechsym simulate`: time simulation of a case."""

import functools
import math
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym.cli.common import (
    case_of,
    emit,
    heads,
    in_rows,
    json_option,
    out_option,
    pairs,
    refuse_idle,
    set_option,
    table,
)
from mechsym.errors import MissingExtra
from mechsym.files import Json, write_text
from mechsym.quantities import ranges
from mechsym.quantities.display import figure, quantity_text, residual_text
from mechsym.quantities.results import tell

if TYPE_CHECKING:
    from mechsym.cases import Case
    from mechsym.torsion.startup import FinishedRun

_EVENTS = 12  # shown of a run
_ENDS = {"turns": "after its turns", "t_end": "as planned"}


@click.command(short_help="Simulate over time, with an energy audit.")
@click.argument("case")
@click.option("--tolerance", help="Tolerance of a step; the case's, or 1e-10.")
@click.option("--backend", help="Integrator by name, e.g. scipy-dop853, sundials, heyoka.")
@click.option("--no-check", is_flag=True, help="Leave out the second run at a hundredth of the tolerance.")
@click.option(
    "--rest", is_flag=True, help="In place of a run: the poses in which it stays at rest, and their stability."
)
@click.option("--dampings", metavar="C1,C1..", help="Further values of c1 for a start-up, e.g. 0.2,1,5.")
@set_option
@out_option
@json_option
def simulate(
    case: str, tolerance: str | None, backend: str | None, no_check: bool, rest: bool,
    dampings: str | None,
    overrides: tuple[str, ...], out: Path | None,
) -> None:  # fmt: skip
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

    options = {"tolerance": tolerance, "backend": backend}
    given = tuple(f"simulation.{name}={value}" for name, value in options.items() if value is not None)
    loaded = case_of(case, pairs((*overrides, *given)))
    if rest:
        refuse_idle("beside --rest", "tolerance", "backend", "no_check", "dampings")
        _rest(loaded)
        return
    dampers = () if dampings is None else tuple(ranges.values(dampings, "N*m*s/rad", "--dampings", most=1000))
    done = run(loaded, dampers, "none" if no_check else "tolerance")
    files = [] if out is None else _write(done, out)
    text = functools.partial(_text, tell(done), done.result.units)
    emit(done, text, beside={"files": files}, files=files, findings=done.view.findings())
    if done.result.status in ("failed", "not converged", "chaotic"):
        sys.exit(1)


def _rest(case: "Case") -> None:
    from mechsym.jobs.run import at_rest

    done = at_rest(case)
    rows = [
        {**pose.at, "": pose.kind, "frequencies [Hz]": ", ".join(figure(f / math.tau, 5) for f in pose.frequencies)}
        for pose in done.rests
    ]
    places = [*(done.rests[0].at if done.rests else ())]
    units = done.rests[0].at.units if done.rests else {}
    more = "" if done.complete else "\nlooked for about the start: there may be more"
    if done.singular:
        ends = ", ".join(f"{math.degrees(angle):.2f} deg" for angle in done.singular)
        more = f"\nlooked for up to singular poses of the loops, {ends}: behind them there may be more"
    text = table(rows, [*places, "", "frequencies [Hz]"], units) if rows else "it stays at rest nowhere"
    emit(done, lambda: text + more)


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


def _text(report: Json, of: Mapping[str, str]) -> str:
    from mechsym.simulate.result import RunEvent
    from mechsym.torsion.startup import StartUpNumbers
    from mechsym.torsion.twist import ShaftSection, section_words

    report_rows = {
        "ended": f"{_ENDS.get(report['end'], report['end'])} at {_number(report['t_end'])} s",
        "energy residual": residual_text(report["energy_residual"]),
        "accuracy": report["reason"] or "not checked at a finer tolerance",
        "steps": f"{report['steps']}, {_number(report['wall_s'])} s by the clock",
    }
    lines = [f"{name:22}{words}" for name, words in report_rows.items()]
    if report["event"]:
        lines.append(f"{'event':22}" + ", ".join(f"{k} {_number(v)}" for k, v in report["event"].items()))
    if report["events"]:
        lines += ["", table(report["events"][:_EVENTS], ["t", "name", "kind", "lost"], heads(RunEvent))]
        more, lost = len(report["events"]) - _EVENTS, sum(one["lost"] for one in report["events"])
        lines += [f"and {more} more; --json has all"] if more > 0 else []
        lines += [f"blows take {figure(lost, 6)} J"] if lost else []
    rubs = report["energy"]["friction"].items()
    lines += [f"friction of {name.removeprefix('friction_')} takes {quantity_text(heat, 'J')}" for name, heat in rubs]
    rows = [{"over the last": f"{report['window']:.6g} s", "of": c, **v} for c, v in report["speeds"].items()]
    for unit in dict.fromkeys(of[f"{c}d"] for c in report["speeds"]):
        rates = dict.fromkeys(("mean", "min", "max"), unit)
        alike = [row for row in rows if of[f"{row['of']}d"] == unit]
        if "phi_f" in report["speeds"]:  # a shaft with throws
            alike = [row | {"of": row["of"].replace("phi_f", "flywheel").replace("phi", "throw ")} for row in alike]
        lines += ["", table(alike, ["over the last", "of", *rates], rates)]
    if "outputs" in report:
        ends_of = [{"output": name, **ends, "unit": of[name]} for name, ends in report["outputs"].items()]
        lines += ["", table(in_rows(ends_of, ("min", "max", "end")), ["output", "min", "max", "end", "unit"])]
    if sections := report["twist"]:
        columns = ["section", "twist_mean", "twist_amplitude", "twist_peak", "torque_mean", "torque_amplitude"]
        named = [s | {"section": section_words(k, len(sections))} for k, s in enumerate(sections)]
        natural = ", ".join(figure(f / math.tau, 4) for f in report["natural_frequencies"])
        lines += ["", table(named, columns, heads(ShaftSection)), f"natural frequencies {natural} Hz"]
    if len(report["start_up"]) > 1:
        held = [{**s, "held_s": sum(c["t_end"] - c["t_start"] for c in s["captures"])} for s in report["start_up"]]
        columns = ["c1", "held_s", "speed_mean_end", "twist_peak", "torque_peak", "model_holds"]
        lines += ["", table(held, columns, heads(StartUpNumbers) | {"held_s": "s"})]
    if report["findings"]:
        lines += ["", *(f"- {line}" for line in report["findings"])]
    return "\n".join(lines)


def _number(value: object) -> str:
    return f"{value:.8g}" if isinstance(value, float) else str(value)

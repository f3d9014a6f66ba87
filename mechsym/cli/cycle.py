"""`mechsym cycle`: the engine cycle at one or many speeds."""

import dataclasses
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mechsym.cases import Case
from mechsym.cli import cycle_pages as pages
from mechsym.cli.common import (
    case_of,
    emit,
    heads,
    json_option,
    judge_ends,
    only_of,
    out_option,
    pairs,
    parse_over,
    parse_speeds,
    progress,
    set_option,
)
from mechsym.cycle.columns import UNITS
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.quantities.results import tell

if TYPE_CHECKING:
    import numpy as np

    from mechsym.cycle.source import GasSource


@click.command(short_help="Engine cycle at one or many speeds.")
@click.argument("case")
@click.option("--speeds", metavar="A:B:STEP", help="Speeds in rpm; without it the case's operating speed.")
@click.option("--over", metavar="NAME=A:B:STEP", help="Run over another value of the engine, at one speed.")
@click.option(
    "--diagram",
    type=click.Path(dir_okay=False),
    multiple=True,
    help="CSV of a measured diagram: combustion from pressure; again: more of the same encoder.",
)
@click.option("--motored", type=click.Path(dir_okay=False), help="CSV without combustion, same encoder: dead centre.")
@click.option("--torque", type=click.Path(dir_okay=False), help="CSV of a measured crank torque: pressure from it.")
@click.option("--noise", metavar="TORQUE", help="Standard deviation of each torque of --torque, such as '2 N*m'.")
@click.option("--loop", type=click.FloatRange(0.5, 1000), help="Engine cycles to run with the mechanism in the loop.")
@json_option
@out_option
@set_option
def cycle(case: str, speeds: str | None, over: str | None, diagram: tuple[str, ...], motored: str | None,
          torque: str | None, noise: str | None, loop: float | None, as_json: bool, out: Path | None,
          overrides: tuple[str, ...]) -> None:  # fmt: skip
    """Engine cycle of CASE: torque, power, consumption, energy shares, peak pressure.

    Torque and power are the engine's, all cylinders together; of several cylinders those of one stand beside them.

    With --diagram, or a case of kind "diagram": combustion out of measured pressure, cycle by cycle; --motored, a
    record of the same encoder without combustion, gives its dead centre. The sensor's lag is in it; cycles of several
    speeds (a run-down with time_s) tell the lag apart, with its interval. With --torque: the cylinder pressure out of a
    torque over the angle (a file as [torque] takes it), with gaps at the dead centres. With --loop: gas and motion
    integrated together, against the case's load (a propeller without [load]).

    \b
    Examples: mechsym cycle nunes-slider-crank --speeds 500:8000:500
              mechsym cycle nunes-hypocycloid --set cycle.method=nunes2017_printed --speeds 10:8000:10 --json
              mechsym cycle nunes-slider-crank --over "cycle.ignition=-30 deg:0 deg:2 deg" --speeds 4000
              mechsym cycle generator --diagram measured.csv --motored motored.csv
              mechsym cycle zotov-89 --torque torque.csv --noise "200 N*m"
              mechsym cycle nunes-hypocycloid --loop 10
              mechsym cycle alpha-stirling --set cycle.kind=stirling-adiabatic
              mechsym cycle generator-breathing --speeds 1000:4000:500
              mechsym cycle zotov-142 --set scavenging.source=turbocharger --set "scavenging.altitude=2000 m"
    """
    from mechsym.cases.needs import NO_FILE, require
    from mechsym.cycle.kinds import kind_of

    loaded = case_of(case, pairs(overrides))
    require(loaded, "cycle", NO_FILE if diagram else "")
    if torque or noise:
        if speeds or over or diagram or motored or loop:
            raise BadInput("--torque stands alone: leave out --speeds, --over, --diagram, --motored and --loop")
        _show_torque(loaded, torque, noise, as_json, out)
    elif diagram or motored or kind_of(loaded.need("cycle")).measured:
        _show_diagram(loaded, diagram, motored, as_json, out)
    elif loop:
        _show_loop(loaded, loop, as_json, out)
    else:
        omega = parse_speeds(speeds) if speeds is not None else [loaded.need("operation").speed]
        judge_ends(loaded, "operation.speed", omega)
        _show_figures(loaded, omega, over, as_json, out)


def _show_torque(case: Case, file: str | None, noise: str | None, as_json: bool, out: Path | None) -> None:
    from mechsym.files import write_quantities
    from mechsym.forces.plots import pressure_picture
    from mechsym.jobs.indicated import indicated
    from mechsym.quantities import parse

    if file is None:
        raise BadInput("--noise belongs to --torque FILE; give both")
    if noise is None:
        raise BadInput("--torque needs --noise, the standard deviation of each torque, such as --noise '2 N*m'")
    result = indicated(case, file, parse(noise, "N*m", "--noise"))
    files = [
        write_quantities(out / "pressure.csv", result.pressure, result.pressure.units),
        pressure_picture(out / "pressure.svg", result.found, result.period),
    ] if out else []  # fmt: skip
    emit(result, as_json, lambda: pages.torque(result), files=files)


def _show_diagram(case: Case, diagram: tuple[str, ...], motored: str | None, as_json: bool, out: Path | None) -> None:
    from mechsym.files import write_quantities, write_text
    from mechsym.jobs.measured import MeasuredCycle, measured_combustion

    case = only_of(case, "cycle")
    result = measured_combustion(case, diagram, motored)
    names = [field.name for field in dataclasses.fields(MeasuredCycle)]
    columns = {name: [getattr(cycle, name) for cycle in result.cycles] for name in names}
    files = []
    if out:
        from mechsym.report.build import combustion_html

        files = [write_quantities(out / "combustion.csv", columns, heads(MeasuredCycle)),
                 write_text(out / "combustion.html", combustion_html(case, result))]  # fmt: skip
    emit(result, as_json, lambda: pages.diagram(result), files=files)


def _show_loop(case: Case, cycles: float, as_json: bool, out: Path | None) -> None:
    from mechsym.cases.outcomes import of_limits
    from mechsym.files import write_quantities
    from mechsym.jobs.run import loop
    from mechsym.simulate.loop.run import run_loop, series, summary

    machine = loop(case)
    run = run_loop(machine, case.need("operation").speed, cycles)
    result = summary(machine, run)
    files = [write_quantities(out / "loop.csv", series(machine, run))] if out else []
    told = tell(result)
    emit(told | {"doubts": of_limits(case, told)}, as_json, lambda: pages.loop(result), files=files)
    if result.status != "done":
        sys.exit(1)


def _show_figures(case: Case, omega: list[float], over: str | None, as_json: bool, out: Path | None) -> None:
    from mechsym.cases.outcomes import of_cycle
    from mechsym.cycle.source import ENGINE_PAGE
    from mechsym.jobs.cycle import cycle
    from mechsym.jobs.gas import one_cylinder
    from mechsym.jobs.gas import source as source_of

    units: dict[str, str] = {}
    found: Any
    if over:
        found, units = _over(case, omega, over)
    else:
        with progress(len(omega), "cycles") as bar:
            found = cycle(case, _array(omega), bar.update)
    source = source_of(one_cylinder(case)) if over else found.source
    files = _write(case, source, found, omega, out) if out else []
    page, units = source.page if source is not None else ENGINE_PAGE, {**UNITS, **units}
    doubts = () if over else of_cycle(case, found, source_of(case).bound)
    emit(found | {"doubts": doubts}, as_json, lambda: pages.figures(found, page, units), files=files,
         findings=() if over else found.view.findings())  # fmt: skip


def _over(case: Case, omega: list[float], over: str) -> tuple[Json, dict[str, str]]:
    """Figures over another value of the engine at one speed, and the units of its names."""
    from mechsym.cycle.engine import columns, over_design
    from mechsym.cycle.kinds import kind_of
    from mechsym.jobs.cycle import cylinders, engine, of_engine
    from mechsym.jobs.gas import one_cylinder
    from mechsym.optimise.solver import design_units

    cylinders(case)  # what is wrong with them is said before the work begins
    if not kind_of(case.need("cycle")).closed:
        raise BadInput("--over needs a cycle of kind spark-ignition; for others use 'mechsym sweep'")
    machine = engine(one_cylinder(case))
    if len(omega) > 1:
        raise BadInput("--over runs at one speed; give --speeds one value, or leave it out")
    units = design_units(machine)
    name, values = parse_over(over, units)
    judge_ends(case, name, values)
    design = {"omega": _array(omega), name: _array(values)}
    with progress(len(values), "cycles") as bar:
        found = columns(over_design(machine, design, bar.update))
    return of_engine(case, {name: design[name]} | found, None), units


def _array(values: list[float]) -> "np.ndarray":
    import numpy as np

    return np.asarray(values)


def _write(case: Case, source: "GasSource | None", found: Json, omega: list[float], out: Path) -> list[Path]:
    from mechsym.cycle.plots import performance_picture
    from mechsym.files import write_quantities

    told = ("fractions", "loads", "losses", "cylinders", "each", "per_cylinder", "pistons")
    flat = {name: values for name, values in found.items() if name not in told}
    if found.get("cylinders", 1) > 1:
        flat |= {f"{name}_per_cylinder": values for name, values in found["per_cylinder"].items()}
    flat |= {f"fraction_{name}": values for name, values in found["fractions"].items()} | found["loads"]
    flat |= {f"loss_{name}_w": values for name, values in found.get("losses", {}).items()}
    units = {**UNITS, **{f"{name}_per_cylinder": unit for name, unit in UNITS.items()}}
    units |= dict.fromkeys(found["loads"], UNITS["loads"])
    files = [write_quantities(out / "performance.csv", flat, units)]
    for name, one in found.get("pistons", {}).items():
        files.append(write_quantities(out / f"performance-{name}.csv", {"speed_rpm": found["speed_rpm"], **one}, UNITS))
    if source is not None and (curves := source.curves(_array(omega), case.need("operation").speed)):
        files += [write_quantities(out / "cycle.csv", curves), source.picture(out / "cycle.svg", curves)]
    if "losses" not in found and len(set(flat["speed_rpm"])) > 1:
        files.append(performance_picture(out / "performance.svg", {"": found}))
    return files

"""`mechsym cycle`: the engine cycle at one or many speeds."""

from pathlib import Path
from typing import Any

import click

from mechsym.cli import cycle_breathing, cycle_stirling
from mechsym.cli.common import case_of, emit, json_option, judge_ends, out_option, pairs, progress, set_option, table
from mechsym.cli.speeds import parse_over, parse_speeds
from mechsym.errors import BadInput
from mechsym.quantities.display import quantity_text, ratio_text
from mechsym.quantities.names import stem_and_unit

_SHOWN = ("speed_rpm", "torque_avg", "torque_max", "power_kw", "mep_kpa", "sfc_g_kwh", "efficiency", "p_max_mpa")
_SCAVENGED = ("speed_rpm", "p_in_kpa", "t_in_k", "p_out_kpa", "t_turbine_k", "t_evc_k", "delivery_ratio",
              "residual_gas", "air_kg_h")  # fmt: skip
_ONE = ("speed_rpm", "torque_avg", "torque_max", "power_kw")


@click.command(short_help="Engine cycle at one or many speeds.")
@click.argument("case")
@click.option("--speeds", metavar="A:B:STEP", help="Speeds in rpm; without it the case's operating speed.")
@click.option("--over", metavar="NAME=A:B:STEP", help="Run over another value of the engine, at one speed.")
@click.option("--diagram", type=click.Path(dir_okay=False), help="CSV of a measured diagram: combustion from pressure.")
@click.option("--motored", type=click.Path(dir_okay=False), help="CSV without combustion, same encoder: dead centre.")
@click.option("--torque", type=click.Path(dir_okay=False), help="CSV of a measured crank torque: pressure from it.")
@click.option("--noise", metavar="TORQUE", help="Standard deviation of each torque of --torque, such as '2 N*m'.")
@click.option("--loop", type=click.FloatRange(0.5, 1000), help="Engine cycles to run with the mechanism in the loop.")
@json_option
@out_option
@set_option
def cycle(case: str, speeds: str | None, over: str | None, diagram: str | None, motored: str | None,
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
    from mechsym.cli import cycle_loop, cycle_measured, cycle_torque
    from mechsym.cycle.kinds import kind_of

    loaded = case_of(case, pairs(overrides))
    if torque or noise:
        if speeds or over or diagram or motored or loop:
            raise BadInput("--torque stands alone: leave out --speeds, --over, --diagram, --motored and --loop")
        cycle_torque.show(loaded, torque, noise, (as_json, out))
    elif diagram or motored or kind_of(loaded.need("cycle")).measured:
        cycle_measured.show(loaded, (diagram, motored), as_json, out)
    elif loop:
        cycle_loop.show(loaded, loop, as_json, out)
    else:
        omega = parse_speeds(speeds) if speeds is not None else [loaded.need("operation").speed]
        judge_ends(loaded, "operation.speed", omega)
        _show_map(loaded, omega, over, (as_json, out))


def _show_map(case: Any, omega: list[float], over: str | None, output: tuple[bool, Path | None]) -> None:
    from mechsym.cycle.kinds import kind_of
    from mechsym.jobs.cycle import columns_of_cylinder, cycle, engine
    from mechsym.jobs.gas import one_cylinder
    from mechsym.jobs.whole_engine import cylinders, of_engine, other_piston

    given = kind_of(case.need("cycle")).given
    if given == "train" and not over:
        cycle_stirling.show(case, _array(omega), *output)
        return
    if not over and other_piston(case):
        _show(case, None, cycle(case, _array(omega)), {}, output)
        return
    cylinders(case)  # what is wrong with them is said before the work begins
    if given == "breathing" and not over:
        cycle_breathing.show(case, _array(omega), *output)
        return
    if given == "engine":
        machine = engine(one_cylinder(case))
        found = _map(case, machine, omega, over)
    elif over:
        raise BadInput("--over needs a cycle of kind spark-ignition; for others use 'mechsym sweep'")
    else:
        machine, found = None, columns_of_cylinder(case, _array(omega))
    found = of_engine(case, found, None if over else omega)
    _show(case, machine, found, _units(machine) if over else {}, output)


def _show(
    case: Any, machine: Any, found: dict[str, Any], units: dict[str, str], output: tuple[bool, Path | None]
) -> None:
    from mechsym.jobs.judged import of_cycle

    as_json, out = output
    files = _write(out, machine, found, case.need("operation").speed) if out else []
    doubts = () if units else of_cycle(case, found)
    emit(
        found | {"doubts": doubts},
        as_json,
        lambda: "\n".join([_text(found, units), *(f"written: {file}" for file in files)]),
    )


def _map(case: Any, machine: Any, omega: list[float], over: str | None) -> dict[str, Any]:
    from mechsym.cycle.engine import columns, over_design

    design: dict[str, Any] = {"omega": _array(omega)}
    if over:
        if len(omega) > 1:
            raise BadInput("--over runs at one speed; give --speeds one value, or leave it out")
        name, values = parse_over(over, _units(machine))
        judge_ends(case, name, values)
        design[name] = _array(values)
    points = max(v.size for v in design.values())
    with progress(points, "cycles") as bar:
        found = columns(over_design(machine, design, bar.update))
    return ({name: design[name]} if over else {}) | found


def _units(machine: Any) -> dict[str, str]:
    from mechsym.optimise.problem import design_units

    return design_units(machine)


def _array(values: list[float]) -> Any:
    import numpy as np

    return np.asarray(values)


def _text(found: dict[str, Any], units: dict[str, str]) -> str:
    count = len(found["speed_rpm"])
    every = max(1, -(-count // 20))
    shown = [k for k in found if "." in k] + list(_SHOWN)
    lines = [_rows(found, shown, every, units)]
    for name, one in found.get("pistons", {}).items():
        lines += ["", f"piston {name}", _rows({"speed_rpm": found["speed_rpm"], **one}, list(_SHOWN), every, {})]
    each = found.get("each", "cylinder")
    if found["per_cylinder"] and found["cylinders"] > 1:
        one = {"speed_rpm": found["speed_rpm"], **found["per_cylinder"]}
        lines = [
            f"engine of {found['cylinders']} {each}s",
            *lines,
            "",
            f"one {each}",
            _rows(one, list(_ONE), every, {}),
        ]
    if every > 1:
        lines.append(f"{-(-count // every)} of {count} points shown; all with --json or --out")
    if count > 1 and shown[0] == "speed_rpm":
        peaks = [(n, int(found[n].argmax())) for n in ("torque_avg", "torque_max", "power_kw", "p_max_mpa")]
        lines += [
            f"largest {_peak(name, float(found[name][k]))} at {found['speed_rpm'][k]:.0f} rpm" for name, k in peaks
        ]
    worst = abs(found["energy_residual"]).max()
    if "delivery_ratio" in found:
        lines += ["", "turbocharger and scavenging", _rows(found, list(_SCAVENGED), every, {})]
    closed = f"first law closed to {ratio_text(worst, 1)} of the fuel's heating value"
    return "\n".join([*lines, closed if worst == worst else "an algebraic cycle: no fuel, no first law to close"])


def _peak(name: str, value: float) -> str:
    stem, unit = stem_and_unit(name)
    return f"{stem} {quantity_text(value, unit)}"


def _rows(found: dict[str, Any], names: list[str], every: int, units: dict[str, str]) -> str:
    shown = range(0, len(found["speed_rpm"]), every)
    return table([{name: float(found[name][i]) for name in names} for i in shown], names, units)


def _write(out: Path, machine: Any, found: dict[str, Any], omega: float) -> list[Path]:
    from mechsym.cycle.engine import curves
    from mechsym.cycle.plots import cycle_picture, performance_picture
    from mechsym.files import write_quantities

    flat = {
        k: v
        for k, v in found.items()
        if k not in ("fractions", "loads", "cylinders", "each", "per_cylinder", "pistons")
    }
    if found["cylinders"] > 1:
        flat |= {f"{k}_per_cylinder": v for k, v in found["per_cylinder"].items()}
    flat |= {f"fraction_{k}": v for k, v in found["fractions"].items()} | found["loads"]
    files = [write_quantities(out / "performance.csv", flat)]
    for name, one in found.get("pistons", {}).items():
        files.append(write_quantities(out / f"performance-{name}.csv", {"speed_rpm": found["speed_rpm"], **one}))
    if machine is not None:
        one = curves(machine, omega)
        files += [write_quantities(out / "cycle.csv", one), cycle_picture(out / "cycle.svg", one)]
    if len(set(flat["speed_rpm"])) > 1:
        files.append(performance_picture(out / "performance.svg", {"": found}))
    return files

"""`mechsym cycle`: the engine cycle at one or many speeds."""

from pathlib import Path
from typing import Any

import click

from mechsym.cli.common import emit, json_option, out_option, pairs, set_option, table
from mechsym.errors import BadInput

_MOST_SPEEDS = 100_000
_SHOWN = ("speed_rpm", "torque_avg", "torque_max", "power_kw", "mep_kpa", "sfc_g_kwh", "efficiency", "p_max_mpa")


@click.command()
@click.argument("case")
@click.option("--speeds", metavar="A:B:STEP", help="Speeds in rpm; without it the case's operating speed.")
@click.option("--diagram", type=click.Path(dir_okay=False), help="CSV of a measured diagram: combustion from pressure.")
@json_option
@out_option
@set_option
def cycle(
    case: str, speeds: str | None, diagram: str | None, as_json: bool, out: Path | None, overrides: tuple[str, ...]
) -> None:
    """Engine cycle of CASE: torque, power, consumption, energy shares, peak pressure.

    With --diagram, or a case of kind "diagram": combustion out of measured pressure, cycle by cycle.

    \b
    Examples: mechsym cycle nunes-slider-crank --speeds 500:8000:500
              mechsym cycle nunes-hypocycloid --set cycle.method=nunes2017_printed --speeds 10:8000:10 --json
              mechsym cycle generator --diagram measured.csv
    """
    from mechsym.cases import load
    from mechsym.cycle import columns, engine, over_speeds

    loaded = load(case, pairs(overrides))
    if diagram or hasattr(loaded.need("cycle"), "alignment"):
        _measured(loaded, diagram, as_json, out)
        return
    machine = engine(loaded)
    omega = parse_speeds(speeds) if speeds is not None else [loaded.need("operation").speed]
    found = columns(over_speeds(machine, _array(omega)))
    files = _write(out, machine, found, loaded.need("operation").speed) if out else []
    emit(found, as_json, lambda: "\n".join([_text(found), *(f"written: {file}" for file in files)]))


def parse_speeds(text: str) -> list[float]:
    """Speeds from A:B:STEP or a list with commas, in rpm.

    Parameters
    ----------
    text : str
        `500:8000:500`, `2000` or `1000,2000`

    Returns
    -------
    omega : list of float
        Crank speeds [rad/s]

    Raises
    ------
    BadInput
        Not numbers, not positive, or too many
    """
    from mechsym.quantities import parse

    parts = text.split(":")
    if len(parts) == 3:
        first, last, step = (parse(part, "-", "--speeds") for part in parts)
        if step <= 0 or last < first or (last - first) / step > _MOST_SPEEDS:
            raise BadInput(f"--speeds {text}: needs A <= B, STEP > 0 and at most {_MOST_SPEEDS} speeds")
        rpm = [first + k * step for k in range(int((last - first) / step * (1 + 1e-12) + 1e-9) + 1)]
    elif len(parts) == 1:
        rpm = [parse(part, "-", "--speeds") for part in text.split(",")]
    else:
        raise BadInput(f"--speeds {text}: write A:B:STEP in rpm, for example 500:8000:500")
    if min(rpm) <= 0:
        raise BadInput(f"--speeds {text}: speeds must be > 0 rpm")
    return [parse(f"{value!r} rpm", "rad/s") for value in rpm]


def _measured(case: Any, diagram: str | None, as_json: bool, out: Path | None) -> None:
    from mechsym.files import write_csv
    from mechsym.measured import measured_combustion, summary

    found = summary(measured_combustion(case, diagram))
    rows = found["cycles"]
    files = [write_csv(out / "combustion.csv", {k: [row[k] for row in rows] for k in rows[0]})] if out else []
    emit(found, as_json, lambda: "\n".join([_measured_text(found), *(f"written: {file}" for file in files)]))


def _measured_text(found: dict[str, Any]) -> str:
    weak = ", ".join(map(str, found["weak_cycles"])) or "none"
    spread = found["tdc_uncertainty_deg"]
    known = "not estimated" if spread is None else f"+- {spread:.2f} deg"
    fits = [
        f"{name}: " + ", ".join(f"{k} {v['value']:.4g} +- {v['confidence']:.2g}" for k, v in fit.items() if k != "rms")
        for name, fit in ((n, found[n]) for n in ("wiebe", "double_wiebe", "compression_line"))
    ]
    lines = [
        table(found["cycles"], list(found["cycles"][0])),
        f"nearly misfired (less than 0.7 of the median work): cycle {weak}",
        f"trapped mass {found['trapped_mass']:.4g} kg",
        f"dead centre {known}; one degree later changes work by {100 * found['per_degree']['work']:+.2f} % and heat "
        f"by {100 * found['per_degree']['heat']:+.2f} %",
    ]
    return "\n".join([*lines, *fits])


def _array(values: list[float]) -> Any:
    import numpy as np

    return np.asarray(values)


def _text(found: dict[str, Any]) -> str:
    count = len(found["speed_rpm"])
    every = max(1, -(-count // 20))
    rows = [{k: float(found[k][i]) for k in _SHOWN} for i in range(0, count, every)]
    lines = [table(rows, list(_SHOWN))]
    if count > 1:
        peaks = ((name, int(found[name].argmax())) for name in ("torque_avg", "torque_max", "power_kw", "p_max_mpa"))
        lines += [f"largest {name} {found[name][k]:.6g} at {found['speed_rpm'][k]:.0f} rpm" for name, k in peaks]
    worst = abs(found["energy_residual"]).max()
    return "\n".join([*lines, f"first law closed to {worst:.1g} of the fuel's heating value"])


def _write(out: Path, machine: Any, found: dict[str, Any], omega: float) -> list[Path]:
    from mechsym.cycle import curves
    from mechsym.engine_plots import cycle_picture, performance_picture
    from mechsym.files import write_csv

    flat = {k: v for k, v in found.items() if k not in ("fractions", "loads")}
    flat |= {f"fraction_{k}": v for k, v in found["fractions"].items()} | found["loads"]
    one = curves(machine, omega)
    files = [write_csv(out / "performance.csv", flat), write_csv(out / "cycle.csv", one)]
    files.append(cycle_picture(out / "cycle.svg", one))
    if len(flat["speed_rpm"]) > 1:
        files.append(performance_picture(out / "performance.svg", {"": found}))
    return files

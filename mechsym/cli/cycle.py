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
@json_option
@out_option
@set_option
def cycle(case: str, speeds: str | None, as_json: bool, out: Path | None, overrides: tuple[str, ...]) -> None:
    """Engine cycle of CASE: torque, power, consumption, energy shares, peak pressure.

    \b
    Examples: mechsym cycle nunes-slider-crank --speeds 500:8000:500
              mechsym cycle nunes-hypocycloid --set cycle.method=nunes2017_printed --speeds 10:8000:10 --json
    """
    from mechsym.cases import load
    from mechsym.cycle import columns, engine, over_speeds

    loaded = load(case, pairs(overrides))
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

"""`mechsym cycle --torque`: cylinder pressure out of a measured torque on the shaft."""

from pathlib import Path
from typing import Any

from mechsym.cli.common import emit, table
from mechsym.errors import BadInput
from mechsym.quantities.display import quantity_text

_ROWS = 16  # shown on the terminal


def show(case: Any, file: str | None, noise: str | None, output: tuple[bool, Path | None]) -> None:
    """Print what a measured torque tells of the pressure, and write its table and picture.

    Parameters
    ----------
    file : str or None
        CSV of the torque over the angle; None: only the noise was typed
    noise : str or None
        Standard deviation of each torque, as it was typed
    """
    from mechsym.files import write_quantities
    from mechsym.forces.plots_indicated import pressure_picture
    from mechsym.jobs.indicated import columns, indicated, period_of, summary
    from mechsym.quantities import parse

    as_json, out = output
    if file is None:
        raise BadInput("--noise belongs to --torque FILE; give both")
    if noise is None:
        raise BadInput("--torque needs --noise, the standard deviation of each torque, such as --noise '2 N*m'")
    measured, found = indicated(case, file, parse(noise, "N*m", "--noise"))
    told = summary(case, measured, found)
    files = []
    if out:
        files = [write_quantities(out / "pressure.csv", columns(found)),
                 pressure_picture(out / "pressure.svg", found, period_of(found))]  # fmt: skip
    emit(told, as_json, lambda: "\n".join([_text(told), *(f"written: {name}" for name in files)]))


def _text(told: dict[str, Any]) -> str:
    low, high = (quantity_text(end, "J", 4) for end in told["work_interval_j"])
    blind = ", ".join(f"{a:.4g}" if a == b else f"{a:.4g} to {b:.4g}" for a, b in told["gaps_deg"])
    pressure, every = told["pressure"], max(1, -(-told["told"] // _ROWS))
    rows = [{name: float(values[i]) for name, values in pressure.items()} for i in range(0, told["told"], every)]
    return "\n".join([
        f"{told['case']} at {told['speed_rpm']:.6g} rpm: pressure at {told['told']} of {told['samples']} angles",
        table(rows, list(pressure)),
        f"{len(rows)} of {told['told']} angles shown; all with --json or --out",
        f"work of the gas {quantity_text(told['work_j'], 'J', 4)}, 95 %: {low} to {high}",
        f"not told, as the piston hardly moves there: {blind or 'nowhere'} [deg]",
        "low and high: 95 % of each value by itself, from the noise of the torque alone; friction counts as gas",
    ])  # fmt: skip

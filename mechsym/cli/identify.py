"""`mechsym identify`: parameters of a machine out of a measured run."""

import math
from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym.cases import Case
from mechsym.cli.common import budget_option, case_command, emit, listed, out_option
from mechsym.quantities.display import SMALLEST, figure

if TYPE_CHECKING:
    from mechsym.optimise.identify import Identified


@case_command("Parameters of a machine out of measured speeds.", out_option)
@click.option("--trace", required=True, type=click.Path(dir_okay=False), help="CSV: t [s], a speed, measured torques.")
@click.option("--free", required=True, metavar="NAMES", help="Parameters to find, divided by commas.")
@budget_option
def identify(case: Case, trace: str, free: str, out: Path | None) -> None:
    """Find inertia, stiffness, damping or friction of CASE in a measured run, each with its 95 % interval.

    The equations of motion hold exactly, the noise sits on the speeds. What is not named by --free is taken from the
    case; friction.constant and friction.viscous act on the first coordinate, against its motion. Columns are named by
    the mechanism: speeds such as phi0d [rad/s] or speed [rpm], inputs such as M [N*m]; without one [drive] acts.

    \b
    Examples: mechsym simulate chmielewski --set "simulation.t_end=3 s" --set "simulation.window=1 s" --out run
              mechsym identify chmielewski --trace run/series.csv --free I2,k1
    Exit status 1: the search did not converge.
    """
    from mechsym.jobs.identify import identify as find

    names = listed(free, "--free")
    identified = find(case, trace, names)
    files = _write(out, identified) if out else []
    emit(identified, lambda: _text(identified), files=files)
    if identified.status != "found":
        raise click.exceptions.Exit(1)


def _told_apart(value: float, low: float, high: float) -> list[str]:
    """A value and its interval with as many digits as tell them apart; five where that is round-off."""
    shown = [[figure(v, digits) for v in (value, low, high)] for digits in range(5, 9)]
    texts = next((texts for texts in shown if len(set(texts)) == 3), shown[-1])
    if high - low < 1e-8 * abs(value):
        texts = [figure(value)] * 3
    return [text if math.isfinite(v) else "no end" for text, v in zip(texts, (value, low, high), strict=True)]


def _text(identified: "Identified") -> str:
    lines = [
        f"{identified.status} ({identified.reason}): {identified.samples} samples over {identified.intervals} intervals"
    ]
    for e in identified.estimates:
        unit = "" if e.unit == "-" else f" {e.unit}"
        value, low, high = _told_apart(e.value, e.low, e.high)
        alike = "no ends" if math.isinf(e.high - e.low) else "no wider than 1e-8 of it"
        within = f"{low} to {high}{unit}" if low != high else alike
        lines.append(f"{e.name} = {value}{unit}, 95 %: {within}")
    # the record of a simulation leaves round-off only; else the noise, and whether it comes in runs
    largest = max(float(abs(values).max()) for values in identified.measured.values())
    left = f"{figure(identified.noise, 3)} {identified.unit} rms, Durbin-Watson {identified.durbin_watson:.2f}"
    if identified.noise < SMALLEST * largest:
        left = f"0 (below {SMALLEST:.0e}".replace("e-09", "e-9") + " of the largest speed)"
    return "\n".join([*lines, f"left over: {left}"])


def _write(out: Path, identified: "Identified") -> list[Path]:
    from mechsym.files import write_quantities
    from mechsym.optimise.shown import trace_picture

    columns = {"t": identified.t}
    for name, values in identified.measured.items():
        columns |= {
            f"{name}_measured [{identified.unit}]": values,
            f"{name}_fitted [{identified.unit}]": identified.fitted[name],
        }
    return [write_quantities(out / "trace.csv", columns), trace_picture(out / "trace.svg", identified)]

"""Forces of a mechanism some of whose coordinates are driven over time."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import scipy

from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.forces.motion import DrivenMotion
from mechsym.mechanisms import constraints, driven
from mechsym.mechanisms.record import Mechanism, velocities
from mechsym.page import Card, Picture, View
from mechsym.quantities import record
from mechsym.quantities.display import quantity_text
from mechsym.quantities.results import Columns, part, quantity, result
from mechsym.style import BLUE, axis_unit, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@result
class DrivenNumbers:
    """What `mechsym forces` tells of a motion."""

    case: str
    mechanism: str
    driven: list[str] = part()  #: Coordinates that `[motion]` moves
    free: list[str] = part()  #: Independent coordinates that move by themselves
    t_end: float = quantity("s")  #: How long
    max: Columns = part()  #: Largest of every column
    min: Columns = part()  #: Smallest of every column
    work: Mapping[str, float] = quantity("J")  #: What each drive gives in that time
    #: Power of the drives less what the energies gain and other forces take, by the largest power of a drive
    power_residual: float | None = quantity("-")


@record
class DrivenForces:
    """The forces of a motion over time."""

    name: str  #: Of the mechanism
    one: driven.DrivenMechanism
    columns: Columns  #: shape (k,): The table `forces.csv`


def forces(
    mechanism: Mechanism,
    section: driven.MotionSettings,
    start: Mapping[str, float],
    inputs: Mapping[str, float],
    units: Json,
) -> DrivenForces:
    """Forces of a mechanism that moves as `[motion]` says.

    start: places and speeds at the start; of what the loops hold, guesses [rad or m, by time]. inputs: constants by
    name [SI]. units: of the outputs.
    """
    names = mechanism.coordinates
    kinds = {q: mechanism.units.get(q, "rad") for q in names}
    motion = DrivenMotion(section, kinds, start)
    moved = tuple(q for q in names if q in motion.curves)
    driven.refuse_more(mechanism, moved)
    places = motion.law(moved, np.zeros(1))[0]
    free = {q: start.get(q, 0.0) for q in names if q not in mechanism.dependents}
    pose = {**free, **dict(zip(moved, places[:, 0].tolist(), strict=True))}
    if mechanism.dependents:
        rates = dict.fromkeys((f"{q}d" for q in names), 0.0)
        pose = {q: v for q, v in constraints.close(mechanism, pose | rates).items() if q in names}
    one = driven.drive(mechanism, moved, pose)
    t = np.linspace(0.0, motion.t_end, section.points)
    values = [inputs.get(n, 0.0) for n in mechanism.inputs]
    rates = {f"{q}d": start.get(f"{q}d", 0.0) for q in one.free}
    found = driven.path(one, lambda at: motion.law(one.driven, at), t, pose | rates, values)
    table = {"t": t, **dict(zip((*names, *velocities(mechanism)), (*found.q, *found.u), strict=True))}
    table |= dict(zip((f"{q}dd" for q in names), found.a, strict=True)) | driven.outputs(one, found, values)
    known = {"t": "s", **units}
    for q, kind in kinds.items():
        known |= {q: kind, f"{q}d": f"{kind}/s", f"{q}dd": f"{kind}/s^2", f"power_{q}": "W"}
        known |= {f"driving_{q}": "N*m" if kind == "rad" else "N"}
    known |= {"power_residual": "W"} | {n: "N*m" for n in table if n.startswith("M_") and n not in known}
    bad = [n for n, v in table.items() if not np.isfinite(v).all()]
    if bad:
        raise BadInput(f"{mechanism.name}: {bad[0]} is not finite on the way; give another path")
    shown = {mechanism.shown.get(n, n): n for n in table}
    columns = Columns({n: table[of] for n, of in shown.items()}, {n: known.get(of, "N") for n, of in shown.items()})
    return DrivenForces(name=mechanism.name, one=one, columns=columns)


def view(found: DrivenForces) -> View:
    """What of a motion is worth seeing: places and forces of what is driven."""
    table, units = found.columns, found.columns.units
    largest = {n: float(np.abs(table[n]).max()) for n in table if n.startswith("driving_")}
    cards = [Card(name=n.replace("_", " "), value=quantity_text(most, units[n], 4), about="largest")
             for n, most in largest.items()]  # fmt: skip

    def draw() -> "Figure":
        names = [*found.one.driven, *largest]
        figure, axes = panels(9.0, 1.4 * len(names) + 0.6, len(names), 1, "Driven places and forces", sharex=True)
        for axis, name in zip(axes, names, strict=True):
            factor, unit = axis_unit(units[name], table[name])
            axis.plot(table["t"], table[name] * factor, color=BLUE)
            axis.set_ylabel(f"{name.replace('_', ' ')} [{unit}]")
        axes[-1].set_xlabel("time [s]")
        return figure

    see = "What each drive does, and the torque or force that it takes."
    pictures = (Picture(name="driving", see=see, draw=draw),)
    return View(title=f"Forces of {found.name}", cards=tuple(cards), pictures=pictures, columns=lambda: table)


def numbers(found: DrivenForces, case: str) -> DrivenNumbers:
    """The same in numbers: largest and smallest of every column, work of every drive."""
    table, units = found.columns, found.columns.units
    powers = {q: table[f"power_{q}"] for q in found.one.driven}
    curves = {q: scipy.interpolate.CubicSpline(table["t"], power) for q, power in powers.items()}
    largest = max(float(np.abs(p).max()) for p in powers.values())
    shown = [n for n in table if n not in ("t", "power_residual")]
    ends = ({n: float(f(table[n])) for n in shown} for f in (np.max, np.min))
    high, low = (Columns(end, {n: units[n] for n in end}) for end in ends)
    residual = table.get("power_residual")
    return DrivenNumbers(
        case=case, mechanism=found.name, driven=list(found.one.driven), free=list(found.one.free),
        t_end=float(table["t"][-1]), max=high, min=low,
        work={q: float(curve.integrate(0.0, table["t"][-1])) for q, curve in curves.items()},
        power_residual=None if residual is None or not largest > 0 else float(np.abs(residual).max()) / largest,
    )  # fmt: skip

r"""How driven coordinates move: evenly, by a word from rest to rest, or through the points of a file; the forces then.

Words are laws of a rise over its duration (periodic/rises.py). The rows of a
file are joined by splines of degree 5, whose fourth derivative is continuous; a periodic one also at its ends.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np
import scipy

from mechsym.errors import BadInput, suggest
from mechsym.files import Json, to_json, write_quantities, write_text
from mechsym.files.tables import columns_of
from mechsym.forces.loads import with_resultants
from mechsym.mechanisms import constraints, driven
from mechsym.mechanisms.driven import MotionSettings
from mechsym.mechanisms.plots import turning_page
from mechsym.mechanisms.record import Mechanism, velocities
from mechsym.page import Card, Picture, View
from mechsym.periodic.rises import RISES
from mechsym.quantities import parse, record
from mechsym.quantities.display import quantity_text
from mechsym.quantities.results import Columns, part, quantity, result
from mechsym.quantities.units import Array, Second
from mechsym.style import BLUE, axis_unit, panels, svg

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Curve = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]  # times [s] to place, speed, acceleration


def rise_of(law: str) -> Curve:
    """A rise from 0 to 1 with its first and second derivatives."""
    x = ca.SX.sym("x")
    *earlier, (value, _) = RISES[law](x, ca)
    for piece, end in reversed(earlier):
        value = ca.if_else(x < end / 8, piece, value)
    rate = ca.gradient(value, x)
    function = ca.Function("rise", [x], [value, rate, ca.gradient(rate, x)])

    def rise(at: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        s, ds, dds = (np.asarray(ca.densify(v)).ravel() for v in function(np.atleast_2d(at)))
        return s, ds, dds

    return rise


WORDS = tuple(law for law in RISES if law != "harmonic")  # it begins and ends with a jump of its acceleration


def word_of(value: object) -> tuple[str, str]:
    """The word by which a coordinate moves and the rise that stands behind it, each empty where there is none.

    >>> word_of("cycloid"), word_of("3-4-5 -90 deg"), word_of("300 rpm")
    (('cycloid', ''), ('3-4-5', '-90 deg'), ('', ''))
    """
    text = value.strip() if isinstance(value, str) else ""
    word = next((word for word in WORDS if f"{text} ".startswith(f"{word} ")), "")
    return word, text[len(word) :].strip() if word else ""


class DrivenMotion:
    """The driven coordinates of a section `[motion]`.

    Raises BadInput: nothing is driven, a coordinate twice, or what a word or a file needs is missing.
    """

    def __init__(self, section: MotionSettings, units: Mapping[str, str], start: Mapping[str, float]) -> None:
        given = {q: getattr(section, q) for q in units if getattr(section, q) is not None}
        if section.periodic and not section.file:
            raise BadInput("motion.periodic is for a file that repeats; name it, motion.file, or leave periodic out")
        table = _table(section.file, units) if section.file else {}
        if twice := sorted(given.keys() & table.keys()):
            raise BadInput(f"motion.{twice[0]} stands in the section and in {section.file}; keep one")
        self.curves: dict[str, Curve] = {}
        for q, value in given.items():
            self.curves[q] = _curve(section, q, value, units[q], start.get(q, 0.0))
        if section.rise is not None and not any(word and not rise for word, rise in map(word_of, given.values())):
            words = ", ".join(map(repr, WORDS))
            raise BadInput(f"motion.rise is for {words} without a rise of their own; nothing moves so: leave it out")
        t = table.pop("t", np.zeros(1))
        for q, values in table.items():
            self.curves[q] = _spline(section, q, t, values, units[q])
        if not self.curves:
            raise BadInput(f"[motion] drives nothing; give one of {', '.join(units)}, or a file with such columns")
        self.t_end = self._end(section, float(t[-1]) or None, units)

    def _end(self, section: MotionSettings, last: float | None, units: Mapping[str, str]) -> float:
        if section.t_end is not None:
            if last is not None and not section.periodic and section.t_end > last:
                raise BadInput(
                    f"motion.t_end = {section.t_end:g} s is after the last row of {section.file}, {last:g} s; "
                    "shorten it, or say periodic = true"
                )
            return float(section.t_end)
        if ends := [end for end in (last, section.duration) if end is not None]:
            return float(max(ends))
        speeds = [abs(float(self.curves[q](np.zeros(1))[1][0])) for q in self.curves if units[q] == "rad"]
        if not max(speeds, default=0.0) > 0:
            raise BadInput("motion.t_end is missing; give it in s")
        return 2 * math.pi / max(speeds)

    def law(self, names: tuple[str, ...], t: Second[Array]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Places, speeds and accelerations of driven coordinates, each shape (names, k) [rad or m, by time]."""
        rows = [self.curves[q](np.asarray(t, dtype=float)) for q in names]
        places, speeds, accelerations = (np.array([row[k] for row in rows]) for k in range(3))
        return places, speeds, accelerations


def _curve(section: MotionSettings, q: str, value: object, unit: str, start: float) -> Curve:
    word, own = word_of(value)
    if not word and (not isinstance(value, str) or value[:1].isdigit() or value[:1] in "+-."):
        speed = parse(value, f"{unit}/s", f"motion.{q}")
        return lambda t: (start + speed * t, speed + 0 * t, 0 * t)
    if not word:
        raise BadInput(
            f"motion.{q} = {value!r} is neither a speed, as '300 rpm', nor a word, as 'cycloid' or 'cycloid 30 deg'; "
            f"{suggest(str(value).split()[0] if str(value).split() else '', list(WORDS))}"
        )
    given = own or section.rise
    if given is None or section.duration is None:
        raise BadInput(f"motion.{q} = {value!r} needs motion.rise, in {unit}, and motion.duration, in s")
    rise, duration, share = parse(given, unit, f"motion.{q if own else 'rise'}"), section.duration, rise_of(word)

    def curve(t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        x = np.clip(t / duration, 0.0, 1.0)
        s, ds, dds = share(x)
        moves = (t >= 0) & (t <= duration)
        return start + rise * s, rise * ds * moves / duration, rise * dds * moves / duration**2

    return curve


def _table(file: str, units: Mapping[str, str]) -> dict[str, np.ndarray]:
    """Columns of a file in SI: `t`, and those of its coordinates."""
    columns, lines = columns_of(file, {"t": "s", **units}, "is no time t and no coordinate")
    if "t" not in columns or len(columns) < 2:
        raise BadInput(f"{file}: a motion has the columns t [s] and one for each coordinate that it drives")
    bad = np.flatnonzero(np.diff(columns["t"]) <= 0)
    if bad.size or len(lines) < 7:
        at = lines[int(bad[0]) + 1] if bad.size else lines[-1]
        why = "t must rise row by row" if bad.size else "a spline of degree 5 takes at least 7 rows"
        raise BadInput(f"{file}, line {at}: {why}; mend the file")
    columns["t"] = columns["t"] - columns["t"][0]
    return columns


def _spline(section: MotionSettings, q: str, t: np.ndarray, values: np.ndarray, unit: str) -> Curve:
    """A spline of degree 5 through the points; where it repeats, an angle may go on by whole turns."""
    period, turned = float(t[-1]), 0.0
    if section.periodic:
        size = float(np.abs(values - values.mean()).max())
        turned = 2 * math.pi * round((values[-1] - values[0]) / (2 * math.pi)) if unit == "rad" else 0.0
        if abs(values[-1] - values[0] - turned) > 1e-6 * max(size, 1e-9):
            raise BadInput(
                f"{section.file}: {q} does not repeat: {values[0]:g} {unit}, at the end {values[-1]:g} {unit}; "
                "let the last row repeat the first, or leave periodic away"
            )
        values = np.append((values - turned * t / period)[:-1], values[0])
    spline = scipy.interpolate.make_interp_spline(t, values, k=5, bc_type="periodic" if section.periodic else None)
    slopes = [spline.derivative(k) for k in (1, 2)]
    rate = turned / period

    def curve(at: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        x = np.remainder(at, period) if section.periodic else at
        return spline(x) + rate * at, slopes[0](x) + rate, slopes[1](x)

    return curve


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
    followed = driven.path(one, lambda at: motion.law(one.driven, at), t, pose | rates, values)
    table = {"t": t, **dict(zip((*names, *velocities(mechanism)), (*followed.q, *followed.u), strict=True))}
    table |= dict(zip((f"{q}dd" for q in names), followed.a, strict=True)) | driven.outputs(one, followed, values)
    borne = {n: v for n, v in table.items() if n.startswith(("R_", "M_"))}
    table |= {name: values for name, values in with_resultants(borne).items() if name not in table}
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


def view(motion: DrivenForces) -> View:
    """What of a motion is worth seeing: places and forces of what is driven."""
    table, units = motion.columns, motion.columns.units
    largest = {n: float(np.abs(table[n]).max()) for n in table if n.startswith("driving_")}
    cards = [Card(name=n.replace("_", " "), value=quantity_text(most, units[n], 4), about="largest")
             for n, most in largest.items()]  # fmt: skip

    def draw() -> "Figure":
        names = [*motion.one.driven, *largest]
        figure, axes = panels(9.0, 1.4 * len(names) + 0.6, len(names), 1, "Driven places and forces", sharex=True)
        for axis, name in zip(axes, names, strict=True):
            factor, unit = axis_unit(units[name], table[name])
            axis.plot(table["t"], table[name] * factor, color=BLUE)
            axis.set_ylabel(f"{name.replace('_', ' ')} [{unit}]")
        axes[-1].set_xlabel("time [s]")
        return figure

    see = "What each drive does, and the torque or force that it takes."
    pictures = (Picture(name="driving", see=see, draw=draw),)
    return View(title=f"Forces of {motion.name}", cards=tuple(cards), pictures=pictures, columns=lambda: table)


def numbers(motion: DrivenForces, case: str) -> DrivenNumbers:
    """The same in numbers: largest and smallest of every column, work of every drive."""
    table, units = motion.columns, motion.columns.units
    powers = {q: table[f"power_{q}"] for q in motion.one.driven}
    curves = {q: scipy.interpolate.CubicSpline(table["t"], power) for q, power in powers.items()}
    largest = max(float(np.abs(p).max()) for p in powers.values())
    shown = [n for n in table if n not in ("t", "power_residual")]
    ends = ({n: float(f(table[n])) for n in shown} for f in (np.max, np.min))
    high, low = (Columns(end, {n: units[n] for n in end}) for end in ends)
    residual = table.get("power_residual")
    return DrivenNumbers(
        case=case, mechanism=motion.name, driven=list(motion.one.driven), free=list(motion.one.free),
        t_end=float(table["t"][-1]), max=high, min=low,
        work={q: float(curve.integrate(0.0, table["t"][-1])) for q, curve in curves.items()},
        power_residual=None if residual is None or not largest > 0 else float(np.abs(residual).max()) / largest,
    )  # fmt: skip


def write(moved: DrivenForces, summary: Json, folder: Path, about: str, scenes: Sequence[Json]) -> list[Path]:
    """Write table, summary and pictures of a motion, and a page in which the machine moves, of its scenes."""
    files = [
        write_quantities(folder / "forces.csv", moved.columns, moved.columns.units),
        write_text(folder / "summary.json", to_json(summary) + "\n"),
    ]
    files += [write_text(folder / f"{one.name}.svg", svg(one.draw())) for one in view(moved).pictures]
    if scenes:
        files.append(write_text(folder / "mechanism.html", turning_page(scenes, about)))
    return files

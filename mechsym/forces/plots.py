"""Pictures of forces: chain over the turn, polar diagrams, orders, friction, comparison. All return a figure."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mechsym.forces.balance import BalancedEngine, amplitudes
from mechsym.forces.loads import Harmonics, polar, radial, tangential
from mechsym.forces.result import ComparedFriction, ComparedMechanism, Forces
from mechsym.forces.textbook import IndicatedPressure
from mechsym.mechanisms.roles import resultants
from mechsym.quantities.display import SMALLEST, quantity_text
from mechsym.quantities.units import NORMAL_95, Radian
from mechsym.style import (
    BLUE,
    INK,
    QUIET,
    SERIES,
    axis_unit,
    clear_places,
    distinct,
    heading,
    legend,
    over_angle,
    panels,
    same_path,
    to_scale,
    unit_words,
    write_picture,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_MOST_CURVES = len(SERIES)  # each has a colour of its own
_LOOKS = ("-", ":", "--", "-.", ":", "--")  # of curves that stand for one thing
_BAND = 360  # points of the edge of a band: more cannot be told apart
_SEEN = 1e-3  # of the largest bar: a lower one cannot be seen
_MOST_JOINTS = 4  # a panel of more would be a tangle
_NOUGHT = 1.0  # a shaking force [N] or moment [N*m] below it is round-off of what is balanced


def chain(forces: Forces) -> "Figure":
    """Piston, crank pin, guides (or teeth) and torque over the cycle; rods as two masses broken, beside the exact."""
    table = forces.columns
    phi = np.radians(table["phi_deg"])
    teeth: dict[str, np.ndarray] = {n: table[n] for n in ("tooth_force", "tooth_force_radial") if n in table}
    rods = {name: rod for name, (rod, _) in lumped(forces).items()}
    exact, name = _borne_most(forces)
    acts: dict[str, dict[str, np.ndarray]] = {"N": {}, "N*m": {}}
    for of, values in forces.turn.inputs.items():
        acts.setdefault(forces.columns.units[of], {})[of] = values
    outside = {"N": "gas force" if forces.turn.gas is not None else "force from outside", "N*m": "torque from outside"}
    rows: list[tuple[str, str, Mapping[str, np.ndarray]]] = [
        *((outside.get(unit, "from outside"), unit, curves) for unit, curves in acts.items()),
        (name, "N", exact | rods),
        ("teeth" if teeth else "side force", "N", teeth or forces.loads.guides),
    ]
    acting = [row for row in rows if any(np.any(values) for values in row[2].values())]
    count = len(acting) + 1
    figure, axes = panels(9, 2.25 * count, count, 1, "Forces and torque over the crank angle", sharex=True)
    angle = over_angle(axes[-1], float(phi[-1] + phi[1]))
    for axis, row in zip(axes, acting, strict=False):
        _curves(axis, phi * angle, *row)
    factor, unit = axis_unit("N*m", forces.turn.torque)
    axes[-1].plot(phi * angle, forces.turn.torque * factor, color=SERIES[0])
    axes[-1].axhline(forces.turn.torque.mean() * factor, color=QUIET, lw=1, ls="--", label="mean")
    axes[-1].set_ylabel(f"torque [{unit}]")
    legend(axes[-1])
    return figure


def _borne_most(result: Forces) -> tuple[dict[str, np.ndarray], str]:
    """Forces on the first crank pin; of a mechanism without one the largest joint forces; and what they are."""
    if pins := result.loads.pins:
        return {"radial, outwards": radial(pins[0]), "tangential": tangential(pins[0])}, _label(pins[0].name)
    table = result.columns
    of_joints = {name: parts for name, parts in resultants(result.turn.reactions).items() if name in table}
    hidden = {name for parts in of_joints.values() for name in parts}
    forces = [
        (n, table[n]) for n in (*of_joints, *result.turn.reactions) if n not in hidden and table.units.get(n) == "N"
    ]
    largest = sorted(forces, key=lambda one: -float(np.abs(one[1]).max()))[:_MOST_JOINTS]
    return dict(largest), "joint forces" if len(forces) <= _MOST_JOINTS else f"largest {_MOST_JOINTS} joint forces"


def lumped(forces: Forces) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Crank pin forces of the rod as two masses, each beside the exact one, where they differ."""
    if not forces.chains:
        return {}
    table, pin, names = forces.columns, forces.loads.pins[0], ("two_mass", "terskih")
    rods = {f"radial, {_label(n)}": (-table[f"{n}_Z"], radial(pin)) for n in names if f"{n}_Z" in table}
    rods |= {f"tangential, {_label(n)}": (table[f"{n}_T"], tangential(pin)) for n in names if f"{n}_T" in table}
    size = max((float(np.abs(exact).max()) for _, exact in rods.values()), default=0.0)
    return {name: pair for name, pair in rods.items() if np.abs(pair[0] - pair[1]).max() > 1e-6 * size}


def as_throw(name: str) -> str:
    """Name of what a throw leans on the bearings beside it, which outputs call its main bearing."""
    return name.replace("main_bearing", "throw")


def polar_diagrams(forces: Forces) -> "Figure":
    """Load on each crank pin as its crank sees it, and on each main bearing as the frame sees it.

    Returns figure: one panel for the pins, one for the bearings, as many curves as there are colours.
    """
    # where the bearings have places of their own, what a throw leans on is shared by two of them
    bearings = "throws" if forces.journals else "main bearings"
    figure, axes = panels(9, 5.2, 1, 2, f"Polar diagrams of crank pins and {bearings}")
    curves = polar(forces.loads)
    of_pins = {p.name for p in forces.loads.pins}
    labels = ("radial, outwards", "tangential"), ("along x", "along y")
    for axis, is_pin, (x, y) in zip(axes, (True, False), labels, strict=True):
        own = {as_throw(n) if forces.journals else n: v for n, v in curves.items()}
        stacked = {_label(n): np.concatenate(v) for n, v in own.items() if (n in of_pins) == is_pin}
        chosen, left_out = _first(distinct(stacked, same=same_path))
        factor, unit = axis_unit("N", *(v for both in chosen.values() for v in both))
        for (name, both), color in zip(chosen.items(), SERIES, strict=False):
            across, up = np.split(both, 2)
            axis.plot(_closed(across) * factor, _closed(up) * factor, color=color, lw=1.2, label=_short(name))
            _mark_angles(axis, forces.turn.phi, across * factor, up * factor, color, named=len(chosen) == 1)
        turns = round(forces.turn.period / (2 * np.pi))
        marks = f"\nnumbers: crank angle [deg], {turns} turn{'s' * (turns > 1)}" if len(chosen) == 1 else ""
        axis.plot(0, 0, "+", color=INK)
        axis.set(xlabel=f"{x} [{unit}]{marks}", ylabel=f"{y} [{unit}]")
        axis.locator_params(axis="x", nbins=4)  # numbers of newtons are long
        heading(axis, ("crank pins, in the crank" if is_pin else f"{bearings}, in the frame") + left_out)
        legend(axis)
    to_scale(figure, axes)
    return figure


def journal_loads(forces: Forces) -> "Figure":
    """Load of the shaft on its main bearings, seen from the block and from the shaft."""
    oiled = bool(forces.orbits)
    figure, axes = panels(9, 4.2 if oiled else 5.2, 1, 3 if oiled else 2, "Loads of the main bearings at their places")
    turning = {f"{one.z}{one.sense}": np.exp(-1j * one.sense * forces.turn.phi) for one in forces.journals}
    loads = {f"{one.z}{one.sense}": one.x + 1j * one.y for one in forces.journals}
    names = {f"{one.z}{one.sense}": f"z = {quantity_text(one.z, 'm', 3)}" for one in forces.journals}
    chosen, left_out = _first(loads)
    factor, unit = axis_unit("N", *(abs(load) for load in loads.values()))
    for axis, seen, frame in zip(axes, ({}, turning), ("in the block", "in the shaft"), strict=False):
        for (key, load), color in zip(chosen.items(), SERIES, strict=False):
            curve = _closed(load * seen.get(key, 1.0)) * factor
            axis.plot(curve.real, curve.imag, color=color, lw=1.2, label=names[key])
        axis.plot(0, 0, "+", color=INK)
        axis.set(xlabel=f"along x [{unit}]", ylabel=f"along y [{unit}]")
        axis.locator_params(axis="x", nbins=4)
        heading(axis, frame + left_out)
    if oiled:
        _orbits(axes[2], forces)
    legend(axes[0])
    to_scale(figure, axes)
    return figure


def _orbits(axis: "Axes", forces: Forces) -> None:
    """Where each journal is in the clearance of its bearing."""
    edge = np.exp(2j * np.pi * np.arange(181) / 180)
    axis.plot(edge.real, edge.imag, color=INK, lw=0.8)
    chosen, left_out = _first({str(k): _closed(orbit.eccentricity) for k, orbit in enumerate(forces.orbits)})
    for curve, color in zip(chosen.values(), SERIES, strict=False):
        axis.plot(curve.real, curve.imag, color=color, lw=1.2)
    axis.set(xlabel="along x, of the clearance [-]", ylabel="along y, of the clearance [-]")
    heading(axis, "journal in its clearance" + left_out)


def _short(name: str) -> str:
    """One name of many, where all are equal: `crank pin 1 = crank pin 2 = ..` says too much."""
    names = name.split(" = ")
    return name if len(names) < 3 else f"{names[0]} and {len(names) - 1} others alike"


def _mark_angles(axis: "Axes", phi: np.ndarray, x: np.ndarray, y: np.ndarray, color: str, named: bool) -> None:
    """Dots every 30 degrees of the crank, numbers every 60 where there is room; over two turns every 60 and 120."""
    every = len(phi) // 12
    axis.plot(x[::every], y[::every], ".", color=color, ms=4)
    if not named:
        return
    marked = range(0, len(phi), 2 * every)
    # a panel is some 3.5 inches wide and high, a number 0.3 by 0.16
    side = 1.1 * max(float(np.ptp(x)), float(np.ptp(y)), 1e-12) / 3.5
    for k in clear_places([(x[i], y[i]) for i in marked], (0.3 * side, 0.16 * side)):
        i = marked[k]
        text = f"{round(np.degrees(phi[i]))}"
        axis.annotate(text, (x[i], y[i]), (3, 3), textcoords="offset points", fontsize=7, color=INK)


def orders(result: Forces) -> "Figure":
    """Orders of the torque, and of the shaking force and moments."""
    shaken = {} if result.shaking is None else result.shaking.orders
    forces = {n: o for n, o in shaken.items() if n.startswith("force")}
    moments = {n: o for n, o in shaken.items() if n.startswith(("rocking", "moment"))}
    acting, notes = [], []
    for orders, si, name in ((forces, "N", "force"), (moments, "N*m", "rocking moment")):
        if orders and max(values.max() for values in _lowest(orders)[1].values()) >= _NOUGHT:
            acting.append((orders, si, name))
        else:
            notes.append(f"no {name} on the frame: below 1 {unit_words(si)}")
    what = "".join(f", the shaking {name}" for *_, name in acting)
    figure, (left, *others) = panels(9, 3.8, 1, 1 + len(acting), f"Orders of the torque{what}")
    torque = result.torque_orders
    swings = np.where(torque.amplitude > SMALLEST * np.abs(torque.amplitude).max(), torque.amplitude, 0.0)[1:]
    factor, unit = axis_unit("N*m", swings)
    left.bar(torque.order[1:], swings * factor, width=0.7 * torque.order[1], color=SERIES[0])
    if not swings.any():
        notes.append("the torque does not swing")
    left.set(xlabel="\n".join(["order, by turn [-]", *notes]), ylabel=f"torque amplitude [{unit}]")
    for axis, (orders, si, name) in zip(others, acting, strict=True):
        _order_bars(axis, orders, si, f"{name} on the frame")
    return figure


def _lowest(orders: Mapping[str, Harmonics]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Orders up to the sixth, whole ones and those between that act, and the amplitudes of each quantity at them."""
    order = next(iter(orders.values())).order
    low = (order > 0) & (order <= 6)
    bars = {name: one.amplitude[low] for name, one in orders.items()}
    largest = np.max(list(bars.values()), axis=0)
    shown = np.isclose(order[low] % 1, 0) | (largest > _SEEN * largest.max())
    return order[low][shown], {name: values[shown] for name, values in bars.items()}


def _order_bars(axis: "Axes", orders: dict[str, Harmonics], si: str, name: str) -> None:
    places, bars = _lowest(orders)
    factor, unit = axis_unit(si, *bars.values())
    largest = max(values.max() for values in bars.values())
    shown = distinct({_label(n): values for n, values in bars.items() if values.max() > _SEEN * largest})
    apart = float(np.diff(places).min())
    for i, (label, values) in enumerate(shown.items()):
        place = places + 0.8 * apart * ((i + 0.5) / len(shown) - 0.5)
        axis.bar(place, values * factor, width=0.7 * apart / len(shown), color=SERIES[i], label=label)
    axis.set(xlabel="order, by turn [-]", ylabel=f"{name} [{unit}]")
    legend(axis)


def balance_orders(one: BalancedEngine) -> "Figure":
    """What acts on the frame by order, before and after; what does not act is said."""
    both = {
        (name, unit): [amplitudes(getattr(shaken, name), one.turn) for shaken in (one.before, one.after)]
        for name, unit in (("force", "N"), ("couple", "N*m"))
    }
    acting = {of: pair for of, pair in both.items() if max(max(one.values()) for one in pair) >= _NOUGHT}
    still = "\n".join(
        f"no {name} on the frame: below 1 {unit_words(unit)}" for name, unit in both if (name, unit) not in acting
    )
    figure, axes = panels(9, 3.8, 1, len(acting) or 1, "What acts on the frame by order")
    for axis, ((name, unit), pair) in zip(axes, acting.items(), strict=False):
        factor, shown = axis_unit(unit, *(np.array(list(values.values())) for values in pair))
        for values, label, color, beside in zip(pair, ("before", "after"), SERIES, (-0.2, 0.2), strict=False):
            shown_orders = [order for order in values if order <= 8]
            height = np.array([values[order] for order in shown_orders])
            axis.bar(np.array(shown_orders) + beside, height * factor, width=0.38, color=color, label=label)
        axis.set(xlabel=f"order, by turn [-]\n{still}".rstrip(), ylabel=f"{name} [{shown}]")
        axis.set_xticks(range(1, 9))
        legend(axis)
    if not acting:
        axes[0].set_axis_off()
        axes[0].text(0.5, 0.5, still, ha="center", va="center", transform=axes[0].transAxes)
    return figure


def friction(forces: Forces) -> "Figure":
    """Friction power over the cycle by place."""
    assert forces.losses is not None
    figure, (axis,) = panels(9, 4, title="Friction power over the crank angle by place")
    names = [n for n, v in forces.losses.curves.items() if np.abs(v).max() > 0]
    values = [forces.losses.curves[n] for n in names]
    factor, unit = axis_unit("W", np.sum(values, axis=0) if values else 0.0)
    labels = [f"{_label(n)}: mean {forces.losses.places[n] * factor:.3g} {unit}" for n in names]
    phi = np.radians(forces.columns["phi_deg"])
    angle = over_angle(axis, float(phi[-1] + phi[1]))
    some = slice(None, None, max(1, len(phi) // _BAND))
    axis.stackplot(phi[some] * angle, [v[some] * factor for v in values], labels=labels, colors=SERIES, lw=0)
    axis.set_ylabel(f"friction power [{unit}]")
    legend(axis)
    return figure


def brake_bar(forces: Forces) -> "Figure":
    """One bar of the net indicated power: what reaches the shaft, and the parts of friction."""
    lost = forces.losses
    assert lost is not None and lost.mechanical_efficiency is not None
    figure, (axis,) = panels(9, 2.1, title="Net indicated power: brake power and the parts of friction")
    parts = {name: value for name, value in lost.places.items() if value > 0}
    brake = lost.indicated_power - sum(parts.values())
    factor, unit = axis_unit("W", lost.indicated_power)
    start = 0.0
    for color, (name, value) in zip((INK, *SERIES), {"brake": brake, **parts}.items(), strict=False):
        share = 100 * value / lost.indicated_power
        axis.barh(0, value * factor, 0.6, left=start * factor, color=color, label=f"{_label(name)} {share:.3g} %")
        start += value
    axis.set_yticks([])
    axis.set(xlabel=f"net indicated power [{unit}]", xlim=(0, lost.indicated_power * factor))
    legend(axis)
    return figure


def comparison(rows: Sequence[ComparedMechanism]) -> "Figure":
    """Loads and friction of the compared mechanisms."""
    height = 0.55 * len(rows) + 2.4
    figure, (left, right) = panels(9, height, 1, 2, "Loads and friction of the compared mechanisms", sharey=True)
    place = np.arange(len(rows))[::-1]
    loads = (("side_force_max", "guide"), ("crank_pin_max", "crank pin"), ("tooth_force_max", "teeth"))
    factor, unit = axis_unit("N", *([getattr(row, key) or 0.0 for row in rows] for key, _ in loads))
    for i, (key, label) in enumerate(loads):
        width = [(getattr(row, key) or 0.0) * factor for row in rows]
        left.barh(place + 0.25 * (1 - i), width, 0.23, color=SERIES[i], label=label)
    left.set(xlabel=f"largest force [{unit}]")
    left.set_yticks(place, [_label(row.mechanism) for row in rows], fontsize=8)
    legend(left, width=2.6)
    _friction_bars(right, place, [row.friction for row in rows if row.friction is not None])
    return figure


def _friction_bars(axis: "Axes", place: np.ndarray, rows: Sequence[ComparedFriction]) -> None:
    if not rows:
        axis.set_axis_off()
        return
    names = ("guides", "piston_pins", "crank_pins", "main_bearings", "teeth", "rings")
    widths = {name: np.array([row.friction_places.get(name, 0.0) for row in rows]) for name in names}
    end = np.sum(list(widths.values()), axis=0)
    factor, unit = axis_unit("W", end)
    start = np.zeros(len(rows))
    for i, (name, width) in enumerate(widths.items()):
        if width.any():
            axis.barh(place, width * factor, 0.6, left=start, color=SERIES[i], label=_label(name))
        start = start + width * factor
    for y, x, row in zip(place, start, rows, strict=True):
        efficiency = row.mechanical_efficiency
        axis.text(x, y, "" if efficiency is None else f" {100 * efficiency:.1f} %", va="center", fontsize=8)
    axis.set(xlabel=f"friction per piston [{unit}], and what it leaves", xlim=(0, 1.25 * (start.max() or 1.0)))
    legend(axis, width=2.6)


def _curves(axis: "Axes", angle: np.ndarray, name: str, si: str, curves: Mapping[str, np.ndarray]) -> None:
    """Forces, or what is of another unit, over an angle; those that lie on each other are named once.

    `a, as two masses` has the colour of `a`, and is broken.
    """
    factor, unit = axis_unit(si, *curves.values())
    shown, left_out = _first(distinct({_label(n): v for n, v in curves.items()}))
    kinds = list(dict.fromkeys(label.partition(",")[0] for label in shown))
    drawn: list[str] = []
    for label, values in shown.items():
        kind = label.partition(",")[0]
        look = _LOOKS[drawn.count(kind)]
        axis.plot(angle, values * factor, ls=look, color=SERIES[kinds.index(kind)], lw=1.4, label=_short(label))
        drawn.append(kind)
    axis.set_ylabel(f"{name} [{unit}]")
    if left_out:
        heading(axis, left_out.removeprefix(", "))
    if len(curves) > 1:
        legend(axis)


def _first(curves: Mapping[str, np.ndarray]) -> tuple[dict[str, np.ndarray], str]:
    """As many curves as there are colours, and words that say how many there are where these are not all."""
    left_out = f", the first {_MOST_CURVES} of {len(curves)}" if len(curves) > _MOST_CURVES else ""
    return dict(list(curves.items())[:_MOST_CURVES]), left_out


def _closed(values: np.ndarray) -> np.ndarray:
    return np.append(values, values[0])


_SAID = {
    "two_mass": "rod as two masses", "terskih": "rod as two masses, after Terskikh", "force_x": "force along x",
    "force_y": "force along y", "force_z": "force along z", "moment_x": "moment about x", "moment_y": "moment about y",
    "rocking_x": "rocking about x", "rocking_y": "rocking about y",
}  # fmt: skip


def _label(name: str) -> str:
    return _SAID.get(name) or name.replace("_", " ")


def pressure_picture(path: Path, indicated: IndicatedPressure, period: Radian) -> Path:
    """Absolute pressure over a period with its 95 % interval; gaps at the dead centres stay empty."""
    figure, axes = panels(8, 4, 1, 1, "Pressure that the torque tells, and its 95 % interval")
    axis = axes[0]
    p, half = (np.where(indicated.clear, v, np.nan) for v in (indicated.p, NORMAL_95 * indicated.error))
    (factor, unit), angle = axis_unit("Pa", indicated.p[indicated.clear]), over_angle(axis, period)
    phi = indicated.phi * angle
    axis.fill_between(phi, (p - half) * factor, (p + half) * factor, color=BLUE, alpha=0.25, linewidth=0, label="95 %")
    axis.plot(phi, p * factor, color=BLUE, label="pressure")
    axis.set_ylabel(f"absolute pressure [{unit}]")
    legend(axis)
    return write_picture(path, figure)

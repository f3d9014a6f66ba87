"""Pictures of forces: chain over the turn, polar diagrams, orders, friction, comparison. All return a figure."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mechsym.forces.loads import polar, radial, tangential
from mechsym.forces.result import Forces
from mechsym.style import (
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
    unit_words,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MOST_CURVES = 6
_SEEN = 1e-3  # of the largest bar: a lower one cannot be seen
_NOUGHT = 1.0  # a shaking force [N] or moment [N*m] below it is round-off of what is balanced


def chain(found: Forces) -> "Figure":
    """Piston, crank pin, guides (or teeth) and torque over the cycle; the two-mass rod dotted beside the exact forces.

    Returns
    -------
    figure : Figure
        Four panels over the crank angle
    """
    figure, axes = panels(9, 9, 4, 1, "Forces and torque over the crank angle", sharex=True)
    table, pin = found.columns, found.loads.pins[0]
    phi = np.radians(table["phi_deg"])
    angle = over_angle(axes[3], float(phi[-1] + phi[1]))
    teeth: dict[str, np.ndarray] = {n: table[n] for n in ("tooth_force", "tooth_force_radial") if n in table}
    _curves(axes[0], phi * angle, found.turn.inputs or {"no gas force": np.zeros_like(phi)}, "gas force")
    exact, rods = {"radial, outwards": radial(pin), "tangential": tangential(pin)}, lumped(found)
    _curves(axes[1], phi * angle, exact | rods, _label(pin.name), dotted=tuple(rods))
    _curves(axes[2], phi * angle, teeth or found.loads.guides, "teeth" if teeth else "side force")
    factor, unit = axis_unit("N*m", found.turn.torque)
    axes[3].plot(phi * angle, found.turn.torque * factor, color=SERIES[0])
    axes[3].axhline(found.turn.torque.mean() * factor, color=QUIET, lw=1, ls="--", label="mean")
    axes[3].set_ylabel(f"torque [{unit}]")
    legend(axes[3])
    return figure


def lumped(found: Forces) -> dict[str, np.ndarray]:
    """Crank pin forces of the rod as two masses, where the case has that chain and they are others than the exact."""
    table, pin, names = found.columns, found.loads.pins[0], ("two_mass", "terskih")
    rods = {f"radial, {_label(n)}": (-table[f"{n}_Z"], radial(pin)) for n in names if f"{n}_Z" in table}
    rods |= {f"tangential, {_label(n)}": (table[f"{n}_T"], tangential(pin)) for n in names if f"{n}_T" in table}
    size = max((float(np.abs(exact).max()) for _, exact in rods.values()), default=0.0)
    return {name: rod for name, (rod, exact) in rods.items() if np.abs(rod - exact).max() > 1e-6 * size}


def polar_diagrams(found: Forces) -> "Figure":
    """Load on each crank pin as its crank sees it, and on each main bearing as the frame sees it.

    Returns
    -------
    figure : Figure
        One panel for the pins, one for the bearings, at most six curves each
    """
    figure, axes = panels(9, 5.2, 1, 2, "Polar diagrams of crank pins and main bearings")
    curves = polar(found.turn, found.loads)
    of_pins = {p.name for p in found.loads.pins}
    labels = ("radial, outwards", "tangential"), ("along x", "along y")
    for axis, is_pin, (x, y) in zip(axes, (True, False), labels, strict=True):
        stacked = {_label(n): np.concatenate(v) for n, v in curves.items() if (n in of_pins) == is_pin}
        chosen = {n: np.split(v, 2) for n, v in list(distinct(stacked, same=same_path).items())[:_MOST_CURVES]}
        factor, unit = axis_unit("N", *(v for both in chosen.values() for v in both))
        for (name, (across, up)), color in zip(chosen.items(), SERIES, strict=False):
            axis.plot(_closed(across) * factor, _closed(up) * factor, color=color, lw=1.2, label=_short(name))
            _mark_angles(axis, found.turn.phi, across * factor, up * factor, color, named=len(chosen) == 1)
        turns = round(found.turn.period / (2 * np.pi))
        told = f"\nnumbers: crank angle [deg], {turns} turn{'s' * (turns > 1)}" if len(chosen) == 1 else ""
        axis.plot(0, 0, "+", color=INK)
        axis.set(xlabel=f"{x} [{unit}]{told}", ylabel=f"{y} [{unit}]")
        axis.locator_params(axis="x", nbins=4)  # numbers of newtons are long
        axis.set_aspect("equal", adjustable="datalim")
        heading(axis, "crank pins, in the crank" if is_pin else "main bearings, in the frame")
        legend(axis)
    return figure


def _short(name: str) -> str:
    """One name of many, where all are equal: `crank pin 1 = crank pin 2 = ..` says too much."""
    names = name.split(" = ")
    return name if len(names) < 3 else f"{names[0]} and {len(names) - 1} others alike"


def _mark_angles(axis: Any, phi: np.ndarray, x: np.ndarray, y: np.ndarray, color: str, named: bool) -> None:
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


def orders(found: Forces) -> "Figure":
    """Orders of the torque, and of the shaking force and moments."""
    shown = {n: o for n, o in found.shaking.orders.items() if n != "roll"}
    moments = {n: o for n, o in shown.items() if n.startswith("rocking")}
    forces = {n: o for n, o in shown.items() if n not in moments}
    acting = [(orders, si, name) for orders, si, name in ((forces, "N", "force"), (moments, "N*m", "moment"))
              if orders and max(_whole(o).max(initial=0.0) for o in orders.values()) >= _NOUGHT]  # fmt: skip
    what = "".join(f", the shaking {name}" for *_, name in acting)
    figure, (left, *others) = panels(9, 3.8, 1, 1 + len(acting), f"Orders of the torque{what}")
    torque = found.torque_orders
    factor, unit = axis_unit("N*m", torque.amplitude[1:])
    left.bar(torque.order[1:], torque.amplitude[1:] * factor, width=0.35, color=SERIES[0])
    told = [
        f"no {name} shakes the frame: below 1 {unit_words(si)}"
        for orders, si, name in ((forces, "N", "force"), (moments, "N*m", "moment"))
        if all(name != shaking for *_, shaking in acting)
    ]
    left.set(xlabel="\n".join(["order [-]", *told]), ylabel=f"torque amplitude [{unit}]")
    for axis, (orders, si, name) in zip(others, acting, strict=True):
        _order_bars(axis, orders, si, f"{name} on the frame")
    return figure


def _whole(found: Any) -> np.ndarray:
    """Amplitudes of the first six whole orders."""
    return np.asarray(found.amplitude)[np.isclose(found.order % 1, 0) & (found.order > 0) & (found.order <= 6)]


def _order_bars(axis: Any, orders: dict[str, Any], si: str, name: str) -> None:
    factor, unit = axis_unit(si, *map(_whole, orders.values()))
    largest = max(_whole(o).max() for o in orders.values())
    acting = {_label(n): _whole(o) for n, o in orders.items() if _whole(o).max() > _SEEN * largest}
    shown = distinct(acting)
    for i, (label, values) in enumerate(shown.items()):
        place = np.arange(1, len(values) + 1) + 0.8 * ((i + 0.5) / len(shown) - 0.5)
        axis.bar(place, values * factor, width=0.7 / len(shown), color=SERIES[i], label=label)
    axis.set(xlabel="order [-]", ylabel=f"{name} [{unit}]")
    legend(axis)


def friction(found: Forces) -> "Figure":
    """Friction power over the cycle by place."""
    assert found.losses is not None
    figure, (axis,) = panels(9, 4, title="Friction power over the crank angle by place")
    names = [n for n, v in found.losses.curves.items() if np.abs(v).max() > 0]
    values = [found.losses.curves[n] for n in names]
    factor, unit = axis_unit("W", np.sum(values, axis=0) if values else 0.0)
    labels = [f"{_label(n)}: mean {found.losses.places[n] * factor:.3g} {unit}" for n in names]
    phi = np.radians(found.columns["phi_deg"])
    angle = over_angle(axis, float(phi[-1] + phi[1]))
    axis.stackplot(phi * angle, [v * factor for v in values], labels=labels, colors=SERIES, lw=0)
    axis.set_ylabel(f"friction power [{unit}]")
    legend(axis)
    return figure


def comparison(rows: Sequence[dict[str, Any]]) -> "Figure":
    """Loads and friction of the compared mechanisms."""
    height = 0.55 * len(rows) + 2.4
    figure, (left, right) = panels(9, height, 1, 2, "Loads and friction of the compared mechanisms", sharey=True)
    place = np.arange(len(rows))[::-1]
    loads = (("side_force_max", "guide"), ("crank_pin_max", "crank pin"), ("tooth_force_max", "teeth"))
    factor, unit = axis_unit("N", *([row[key] or 0.0 for row in rows] for key, _ in loads))
    for i, (key, label) in enumerate(loads):
        width = [(row[key] or 0.0) * factor for row in rows]
        left.barh(place + 0.25 * (1 - i), width, 0.23, color=SERIES[i], label=label)
    left.set(xlabel=f"largest force [{unit}]")
    left.set_yticks(place, [_label(row["mechanism"]) for row in rows], fontsize=8)
    legend(left, width=2.6)
    _friction_bars(right, place, rows)
    return figure


def _friction_bars(axis: Any, place: np.ndarray, rows: Sequence[dict[str, Any]]) -> None:
    if "friction_places" not in rows[0]:
        axis.set_axis_off()
        return
    names = ("guides", "piston_pins", "crank_pins", "main_bearings", "teeth", "rings")
    widths = {name: np.array([row["friction_places"].get(name, 0.0) for row in rows]) for name in names}
    end = np.sum(list(widths.values()), axis=0)
    factor, unit = axis_unit("W", end)
    start = np.zeros(len(rows))
    for i, (name, width) in enumerate(widths.items()):
        if width.any():
            axis.barh(place, width * factor, 0.6, left=start, color=SERIES[i], label=_label(name))
        start = start + width * factor
    for y, x, row in zip(place, start, rows, strict=True):
        efficiency = row["mechanical_efficiency"]
        axis.text(x, y, "" if efficiency is None else f" {100 * efficiency:.1f} %", va="center", fontsize=8)
    axis.set(xlabel=f"friction per piston [{unit}], mechanical efficiency", xlim=(0, 1.25 * (start.max() or 1.0)))
    legend(axis, width=2.6)


def _curves(
    axis: Any, angle: np.ndarray, curves: Mapping[str, np.ndarray], name: str, dotted: tuple[str, ...] = ()
) -> None:
    """Forces [N] over an angle in the unit of the axis; those that lie on each other are named once."""
    factor, unit = axis_unit("N", *curves.values())
    shown = distinct({_label(n): v for n, v in curves.items()})
    for (label, values), color in zip(list(shown.items())[:_MOST_CURVES], SERIES, strict=False):
        line = ":" if label.split(" = ")[0] in dotted else "-"
        axis.plot(angle, values * factor, line, color=color, lw=1.4, label=_short(label))
    axis.set_ylabel(f"{name} [{unit}]")
    if len(curves) > 1:
        legend(axis)


def _closed(values: np.ndarray) -> np.ndarray:
    return np.append(values, values[0])


def _label(name: str) -> str:
    return name.replace("_", " ")

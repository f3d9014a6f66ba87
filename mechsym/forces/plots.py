"""Pictures of forces: chain over the turn, polar diagrams, orders, friction, comparison. All return a figure."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from mechsym.forces.loads import polar, radial, tangential
from mechsym.forces.result import Forces
from mechsym.style import INK, QUIET, bare

_SERIES = ("#2f6690", "#c8553d", "#3a7d44", "#8d6a9f", "#b08900", "#5b6570")
_MOST_CURVES = 6


def chain(found: Forces) -> Figure:
    """Piston, crank pin, guides (or teeth) and torque over the cycle; the two-mass rod dotted beside the exact forces.

    Returns
    -------
    figure : Figure
        Four panels over the crank angle
    """
    figure = Figure(figsize=(9, 7.6), layout="constrained")
    axes = figure.subplots(4, 1, sharex=True)
    phi, table, pin = found.columns["phi_deg"], found.columns, found.loads.pins[0]
    gas = found.turn.inputs
    _curves(axes[0], phi, {_label(n): v for n, v in gas.items()} or {"no gas force": np.zeros_like(phi)})
    _curves(axes[1], phi, {"radial, outwards": radial(pin), "tangential": tangential(pin)})
    if "two_mass_T" in table:
        for name, color in (("two_mass", INK), ("terskih", _SERIES[4])):
            axes[1].plot(phi, -table[f"{name}_Z"] / 1e3, ":", color=color, lw=1.2, label=f"{_label(name)} rod")
            axes[1].plot(phi, table[f"{name}_T"] / 1e3, ":", color=color, lw=1.2)
    axes[1].legend(fontsize=7, ncols=4, frameon=False)
    teeth = {n: table[n] for n in ("tooth_force", "tooth_force_radial") if n in table}
    _curves(axes[2], phi, {_label(n): v for n, v in (teeth or found.loads.guides).items()})
    scale, unit = (1e3, "kN m") if np.abs(found.turn.torque).max() > 1e4 else (1.0, "N m")
    axes[3].plot(phi, found.turn.torque / scale, color=_SERIES[0])
    axes[3].axhline(found.turn.torque.mean() / scale, color=QUIET, lw=1, ls="--", label="mean")
    axes[3].legend(fontsize=7, frameon=False)
    names = (
        "gas force [kN]",
        f"{_label(pin.name)} [kN]",
        f"{'teeth' if teeth else 'side force'} [kN]",
        f"torque [{unit}]",
    )
    for axis, name in zip(axes, names, strict=True):
        axis.set_ylabel(name)
        bare(axis)
    axes[3].set(xlabel="crank angle [deg]", xlim=(0, phi[-1] + phi[1]))
    axes[3].set_xticks(np.arange(0, phi[-1] + phi[1] + 1, 90))
    return figure


def polar_diagrams(found: Forces) -> Figure:
    """Load on each crank pin as its crank sees it, and on each main bearing as the frame sees it.

    Returns
    -------
    figure : Figure
        One panel for the pins, one for the bearings, at most six curves each
    """
    figure = Figure(figsize=(9, 4.6), layout="constrained")
    pins, bearings = figure.subplots(1, 2)
    curves = polar(found.turn, found.loads)
    of_pins = {p.name for p in found.loads.pins}
    labels = ("radial, outwards [kN]", "tangential [kN]"), ("along x [kN]", "along y [kN]")
    for axis, is_pin, (x, y) in zip((pins, bearings), (True, False), labels, strict=True):
        chosen = [(n, v) for n, v in curves.items() if (n in of_pins) == is_pin][:_MOST_CURVES]
        for (name, (across, up)), color in zip(chosen, _SERIES, strict=False):
            axis.plot(_closed(across) / 1e3, _closed(up) / 1e3, color=color, lw=1.2, label=_label(name))
            _mark_angles(axis, found.turn.phi, across / 1e3, up / 1e3, color, named=len(chosen) == 1)
        axis.plot(0, 0, "+", color=INK)
        axis.set(xlabel=x, ylabel=y)
        axis.set_aspect("equal", adjustable="datalim")
        axis.set_title("crank pins, in the crank" if is_pin else "main bearings, in the frame", fontsize=10)
        if len(chosen) > 1:
            axis.legend(fontsize=7, frameon=False)
        bare(axis)
    return figure


def _mark_angles(axis: Any, phi: np.ndarray, x: np.ndarray, y: np.ndarray, color: str, named: bool) -> None:
    """Dots every 30 degrees of the crank, numbers every 60; over two turns every 60 and 120."""
    turns = round((phi[-1] + phi[1]) / (2 * np.pi))
    every = len(phi) // 12
    axis.plot(x[::every], y[::every], ".", color=color, ms=4)
    if not named:
        return
    for i in range(0, len(phi), 2 * every):
        text = f"{round(np.degrees(phi[i]))}"
        axis.annotate(text, (x[i], y[i]), (3, 3), textcoords="offset points", fontsize=7, color=INK)
    axis.annotate(f"numbers: crank angle [deg], {turns} turn{'s' * (turns > 1)}", (0.02, 0.02), fontsize=7,
                  xycoords="axes fraction", color=QUIET)  # fmt: skip


def orders(found: Forces) -> Figure:
    """Orders of the torque, and of the shaking force and moments."""
    figure = Figure(figsize=(9, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    torque = found.torque_orders
    scale, unit = (1e3, "kN m") if torque.amplitude[1:].max() > 1e4 else (1.0, "N m")
    left.bar(torque.order[1:], torque.amplitude[1:] / scale, width=0.35, color=_SERIES[0])
    left.set(xlabel="order", ylabel=f"torque amplitude [{unit}]")
    shown = {n: o for n, o in found.shaking.orders.items() if n != "roll"}
    for i, (name, values) in enumerate(shown.items()):
        whole = np.isclose(values.order % 1, 0) & (values.order > 0) & (values.order <= 6)
        place = values.order[whole] + 0.8 * ((i + 0.5) / len(shown) - 0.5)
        unit = "N m" if name.startswith("rocking") else "N"
        label = f"{_label(name)} [{unit}]"
        right.bar(place, values.amplitude[whole], width=0.7 / len(shown), color=_SERIES[i], label=label)
    right.set(xlabel="order", ylabel="amplitude on the frame [N or N m]")
    if right.get_ylim()[1] < 1:  # round-off of what is balanced is no picture
        right.set_ylim(0, 1)
        right.text(0.5, 0.5, "balanced: below 1 N and 1 N m", transform=right.transAxes, ha="center", color=QUIET)
    right.legend(fontsize=7, frameon=False)
    for axis in (left, right):
        bare(axis)
    return figure


def friction(found: Forces) -> Figure:
    """Friction power over the cycle by place."""
    assert found.losses is not None
    figure = Figure(figsize=(9, 3.4), layout="constrained")
    axis = figure.add_subplot()
    names = [n for n, v in found.losses.curves.items() if np.abs(v).max() > 0]
    values = [found.losses.curves[n] for n in names]
    labels = [f"{_label(n)}: mean {found.losses.places[n]:.4g} W" for n in names]
    phi = found.columns["phi_deg"]
    axis.stackplot(phi, values, labels=labels, colors=_SERIES, lw=0)
    axis.set(xlabel="crank angle [deg]", ylabel="friction power [W]", xlim=(0, phi[-1] + phi[1]))
    axis.set_xticks(np.arange(0, phi[-1] + phi[1] + 1, 90))
    axis.legend(fontsize=7, frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    bare(axis)
    return figure


def comparison(rows: Sequence[dict[str, Any]]) -> Figure:
    """Loads and friction of the compared mechanisms."""
    figure = Figure(figsize=(9, 0.55 * len(rows) + 2.2), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    place = np.arange(len(rows))[::-1]
    loads = (("side_force_max", "guide"), ("crank_pin_max", "crank pin"), ("tooth_force_max", "teeth"))
    for i, (key, label) in enumerate(loads):
        width = [(row[key] or 0.0) / 1e3 for row in rows]
        left.barh(place + 0.25 * (1 - i), width, 0.23, color=_SERIES[i], label=label)
    left.set(xlabel="largest force [kN]")
    left.set_yticks(place, [row["mechanism"] for row in rows], fontsize=8)
    left.legend(fontsize=7, frameon=False)
    _friction_bars(right, place, rows)
    for axis in (left, right):
        bare(axis)
    return figure


def _friction_bars(axis: Any, place: np.ndarray, rows: Sequence[dict[str, Any]]) -> None:
    if "friction_places" not in rows[0]:
        axis.set_axis_off()
        return
    start = np.zeros(len(rows))
    for i, name in enumerate(("guides", "piston_pins", "crank_pins", "main_bearings", "teeth", "rings")):
        width = np.array([row["friction_places"].get(name, 0.0) for row in rows])
        axis.barh(place, width, 0.6, left=start, color=_SERIES[i], label=_label(name))
        start += width
    for y, end, row in zip(place, start, rows, strict=True):
        efficiency = row["mechanical_efficiency"]
        axis.text(end, y, "" if efficiency is None else f" {100 * efficiency:.1f} %", va="center", fontsize=8)
    axis.set(xlabel="friction per piston [W], mechanical efficiency", xlim=(0, 1.18 * start.max()))
    axis.legend(fontsize=7, frameon=False)


def _curves(axis: Any, phi: np.ndarray, curves: dict[str, np.ndarray]) -> None:
    for (name, values), color in zip(list(curves.items())[:_MOST_CURVES], _SERIES, strict=False):
        axis.plot(phi, values / 1e3, color=color, lw=1.4, label=name)
    axis.legend(fontsize=7, ncols=3, frameon=False)


def _closed(values: np.ndarray) -> np.ndarray:
    return np.append(values, values[0])


def _label(name: str) -> str:
    return name.replace("_", " ")

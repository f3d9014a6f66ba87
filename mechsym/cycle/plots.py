"""Pictures of engine cycles: the closed period, a cycle with its gas exchange, a Stirling turn, figures over speeds."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mechsym.cycle.breathing.flow import Breathing, valve_lift
from mechsym.files import Json
from mechsym.quantities import display
from mechsym.style import (
    BLUE,
    GREEN,
    INK,
    RED,
    SERIES,
    axis_unit,
    legend,
    over_angle,
    panels,
    unit_words,
    write_picture,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MAP = (("torque_avg", "mean torque", "N*m"), ("power_kw", "power", "kW"), ("sfc_g_kwh", "consumption", "g/(kW*h)"),
        ("p_max_mpa", "peak pressure", "MPa"))  # fmt: skip
_LOOKS = (("-", BLUE), ("--", RED), (":", GREEN))


def cycle_picture(path: Path, curves: Mapping[str, np.ndarray]) -> Path:
    """Pressure over volume and angle, and the torque of one piston. curves: see `cycle.curves`, shape (k,)."""
    figure, axes = panels(12, 3.6, 1, 3, "Pressure over volume and crank angle, and torque of one piston")
    phi, p, v, torque = np.radians(curves["phi_deg"]), curves["p_pa"], curves["v_m3"], curves["torque_nm"]
    (factor, unit), (room, room_unit) = axis_unit("Pa", p), axis_unit("m^3", v)
    axes[0].loglog(v * room, p * factor, color=BLUE)
    axes[0].set(xlabel=f"volume [{room_unit}]", ylabel=f"pressure [{unit}]")
    both_logarithmic(axes[0])
    for axis, values, si, label in (
        (axes[1], p, "Pa", "pressure"),
        (axes[2], torque, "N*m", "torque of one piston"),
    ):
        factor, unit = axis_unit(si, values)
        angle = over_angle(axis, np.pi, "crank angle from firing TDC", start=-np.pi)
        axis.plot(phi * angle, values * factor, color=BLUE)
        axis.set_ylabel(f"{label} [{unit}]")
    return write_picture(path, figure)


def both_logarithmic(axis: "Axes") -> None:
    """Few and plain numbers on two logarithmic axes."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    for one in (axis.xaxis, axis.yaxis):
        low, high = one.get_view_interval()
        one.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 1000 * low else (1,)))
        one.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        one.set_minor_formatter(NullFormatter())


def performance_picture(path: Path, engines: Mapping[str, Json]) -> Path:
    """Torque, power, consumption, peak pressure, energy shares over the speeds. engines: name to `cycle.columns`."""
    figure, axes = panels(12, 7.2, 2, 3, "Torque, power, consumption, peak pressure and shares of energy over speed")
    (turning, turning_unit), runs = axis_unit("rpm"), tuple(zip(_LOOKS, engines.items(), strict=False))
    for axis, (key, label, unit) in zip(axes, _MAP, strict=False):
        factor, shown = axis_unit(unit, *(figures[key] for figures in engines.values()))
        for (line, color), (name, figures) in runs:
            speed, values = (np.asarray(figures[n], dtype=float) for n in ("speed_rpm", key))
            axis.plot(speed * turning, values * factor, line, color=color, label=name)
        axis.set_ylabel(f"{label} [{shown}]")
        if key == "sfc_g_kwh" and _known(engines, key):
            low, high = _without_start(engines, key)
            axis.set_ylim(low * factor, high * factor)
    for (line, color), (name, figures) in runs:
        speed = np.asarray(figures["speed_rpm"]) * turning
        for shade, (share, values) in zip(SERIES, figures["fractions"].items(), strict=False):
            axes[4].plot(speed, values, line, color=shade, label=f"{share} {name}".strip())
        axes[5].plot(speed, figures["efficiency"], line, color=color, label=name)
    for axis, label in ((axes[4], "share of the fuel's energy"), (axes[5], "efficiency")):
        axis.set_ylabel(f"{label} [-]")
    if not _known(engines, "efficiency"):  # an algebraic cycle knows no fuel
        for axis in axes[[k for k, (key, *_) in enumerate(_MAP) if key == "sfc_g_kwh"] + [4, 5]]:
            axis.text(0.5, 0.5, "the cycle knows no fuel", ha="center", transform=axis.transAxes)
            axis.set(yticks=[], xlim=axes[0].get_xlim())
    for axis in axes:
        axis.set_xlabel(f"speed [{turning_unit}]")
    for axis in axes if len(engines) > 1 else axes[4:5] if _known(engines, "efficiency") else ():
        legend(axis)
    return write_picture(path, figure)


def pareto_picture(
    path: Path,
    columns: Mapping[str, Sequence[float] | np.ndarray],
    objective: str,
    against: str,
    units: Mapping[str, str],
) -> Path:
    """Front of two figures, and the design along it. columns: figures and variables, point by point [SI]."""
    variables = [name for name in columns if name not in (objective, against)]
    names = [objective, *variables]
    figure, axes = panels(3.2 * len(names), 3.2, 1, len(names), f"Front of {objective} against {against}")
    across, values = display.heading(against, columns[against], unit=units.get(against))
    for axis, name in zip(axes, names, strict=True):
        up, shown = display.heading(name, columns[name], unit=units.get(name))
        axis.plot(values, shown, "o-", color=BLUE, markersize=4)
        axis.set(xlabel=unit_words(across), ylabel=unit_words(up))
    return write_picture(path, figure)


def _known(engines: Mapping[str, Json], key: str) -> bool:
    return any(np.isfinite(np.asarray(figures[key], dtype=float)).any() for figures in engines.values())


def _without_start(engines: Mapping[str, Json], key: str) -> tuple[float, float]:
    # at a few rpm all heat goes into the walls and the consumption leaves the picture
    values = np.concatenate([figures[key] for figures in engines.values()])
    low = float(np.nanmin(values))
    return 0.98 * low, min(float(np.nanmax(values)), 1.4 * low)


def breathing_picture(path: Path, curves: Mapping[str, np.ndarray], breathing: Breathing) -> Path:
    """Pressure over volume, and pressures and valve lifts over the angle. curves: see `breathing.engine.curves`."""
    figure, axes = panels(12, 3.9, 1, 3, "Both loops, pressures of the three volumes, and lift of the valves")
    phi, p, v = np.radians(curves["phi_deg"]), curves["p_pa"], curves["v_m3"]
    (factor, unit), (room, room_unit), (angle, angle_unit) = (
        axis_unit(si, values) for si, values in (("Pa", p), ("m^3", v), ("rad", phi))
    )
    axes[0].loglog(_closed(v) * room, _closed(p) * factor, color=BLUE)
    both_logarithmic(axes[0])
    axes[0].set(xlabel=f"volume [{room_unit}]", ylabel=f"absolute pressure [{unit}]")
    for name, key, color in (
        ("cylinder", "p_pa", BLUE), ("plenum", "p_plenum_pa", GREEN), ("manifold", "p_manifold_pa", RED)
    ):  # fmt: skip
        axes[1].plot(phi * angle, curves[key] * factor, color=color, label=name)
    axes[1].set_ylim(0, 2 * max(curves["p_plenum_pa"].max(), curves["p_manifold_pa"].max()) * factor)
    axes[1].set_ylabel(f"absolute pressure [{unit}]")
    for name, color in (("exhaust", RED), ("inlet", GREEN)):
        ends = tuple(getattr(breathing, f"{name}_{event}") for event in ("opens", "closes", "lift"))
        lift = np.array([float(valve_lift(float(at), *ends)) for at in phi])
        factor, unit = axis_unit("m", lift)
        axes[2].plot(phi * angle, lift * factor, color=color, label=name)
    axes[2].set_ylabel(f"lift of the valve [{unit}]")
    for axis in axes[1:]:
        axis.set_xlabel(f"crank angle from firing TDC [{angle_unit}]")
        if angle_unit == "deg":
            axis.set_xticks(range(-180, 541, 180))
        legend(axis)
    return write_picture(path, figure)


def _closed(values: np.ndarray) -> np.ndarray:
    return np.append(values, values[0])


def stirling_picture(path: Path, curves: Mapping[str, np.ndarray]) -> Path:
    """Both p-V diagrams and the temperatures of the working spaces.

    curves: mapping of str to ndarray, shape (n,), `phi_deg`, `p_pa`, `v_e_m3`, `v_c_m3`, `t_e_k`, `t_c_k`.
    """
    figure, axes = panels(11, 3.8, 1, 3, "Pressure over the volumes, and temperatures over the shaft angle")
    hot, cold, p = (_closed(curves[key]) for key in ("v_e_m3", "v_c_m3", "p_pa"))
    (room, room_unit), (factor, unit) = axis_unit("m^3", hot + cold), axis_unit("Pa", p)
    angle = over_angle(axes[2], 2 * np.pi, "shaft angle")
    axes[1].plot((hot + cold) * room, p * factor, color=INK)
    for name, volume, kind, color in (("expansion", hot, "t_e_k", RED), ("compression", cold, "t_c_k", BLUE)):
        axes[0].plot(volume * room, p * factor, color=color, label=name)
        axes[2].plot(np.radians(curves["phi_deg"]) * angle, curves[kind], color=color, label=name)
    for axis, of in ((axes[0], "the space"), (axes[1], "both spaces")):
        axis.set(xlabel=f"volume of {of} [{room_unit}]", ylabel=f"pressure [{unit}]")
    axes[2].set_ylabel("temperature [K]")
    for axis in axes:
        legend(axis)
    return write_picture(path, figure)

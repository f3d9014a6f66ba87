"""Picture of a cycle with its gas exchange: both loops, the pressures of the three volumes, the lift of the valves."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from mechsym.cycle.breathing.flow import valve_lift
from mechsym.cycle.breathing.records import Breathing
from mechsym.cycle.plots import both_logarithmic
from mechsym.style import BLUE, GREEN, RED, axis_unit, legend, panels, write_picture


def breathing_picture(path: Path, curves: Mapping[str, np.ndarray], breathing: Breathing) -> Path:
    """Pressure over volume, and pressures and valve lifts over the angle.

    Parameters
    ----------
    curves : mapping of str to ndarray, shape (n,)
        See `breathing.engine.curves`
    """
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

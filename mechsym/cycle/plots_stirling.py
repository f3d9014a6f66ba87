"""Picture of a turn of a Stirling engine: pressure over both volumes, temperatures over the angle."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from mechsym.style import BLUE, INK, RED, axis_unit, legend, over_angle, panels, write_picture


def stirling_picture(path: Path, curves: Mapping[str, Any]) -> Path:
    """Both p-V diagrams and the temperatures of the working spaces.

    Parameters
    ----------
    curves : mapping of str to ndarray, shape (n,)
        `phi_deg`, `p_pa`, `v_e_m3`, `v_c_m3`, `t_e_k`, `t_c_k`
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


def _closed(values: Any) -> np.ndarray:
    return np.append(values, values[0])

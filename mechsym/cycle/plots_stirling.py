"""Picture of a turn of a Stirling engine: pressure over both volumes, temperatures over the angle."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot as plt

from mechsym.style import write_picture


def stirling_picture(path: Path, curves: Mapping[str, Any]) -> Path:
    """Both p-V diagrams and the temperatures of the working spaces.

    Parameters
    ----------
    curves : mapping of str to ndarray, shape (n,)
        `phi_deg`, `p_pa`, `v_e_m3`, `v_c_m3`, `t_e_k`, `t_c_k`
    """
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.4), layout="constrained")
    hot, cold, p = (_closed(curves[key]) for key in ("v_e_m3", "v_c_m3", "p_pa"))
    for name, volume, color in (("expansion", hot, "tab:red"), ("compression", cold, "tab:blue")):
        axes[0].plot(volume * 1e6, p / 1e5, color=color, label=name)
    axes[1].plot((hot + cold) * 1e6, p / 1e5, color="black")
    for name, kind, color in (("expansion", "t_e_k", "tab:red"), ("compression", "t_c_k", "tab:blue")):
        axes[2].plot(curves["phi_deg"], curves[kind], color=color, label=name)
    _named(axes[0], "volume of the space [cm3]", "pressure [bar]")
    _named(axes[1], "volume of both spaces [cm3]", "pressure [bar]")
    _named(axes[2], "shaft angle [deg]", "temperature [K]")
    axes[0].legend(fontsize=8)
    axes[2].legend(fontsize=8)
    written = write_picture(path, figure)
    plt.close(figure)
    return written


def _closed(values: Any) -> np.ndarray:
    return np.append(values, values[0])


def _named(axis: Any, x: str, y: str) -> None:
    axis.set_xlabel(x)
    axis.set_ylabel(y)
    axis.grid(alpha=0.3)

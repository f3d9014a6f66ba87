"""Picture of a cycle with its gas exchange: both loops, the pressures of the three volumes, the lift of the valves."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot as plt

from mechsym.cycle.breathing.flow import valve_lift
from mechsym.cycle.breathing.records import Breathing
from mechsym.style import write_picture


def breathing_picture(path: Path, curves: Mapping[str, np.ndarray], breathing: Breathing) -> Path:
    """Pressure over volume, and pressures and valve lifts over the angle.

    Parameters
    ----------
    curves : mapping of str to ndarray, shape (n,)
        See `breathing.engine.curves`
    """
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.6), layout="constrained")
    phi, p = curves["phi_deg"], curves["p_pa"] / 1e5
    axes[0].loglog(_closed(curves["v_m3"]) * 1e6, _closed(p), color="tab:blue")
    _named(axes[0], "volume [cm$^3$]", "absolute pressure [bar]")
    for name, key, color in (
        ("cylinder", "p_pa", "tab:blue"), ("plenum", "p_plenum_pa", "tab:green"), ("manifold", "p_manifold_pa",
                                                                                    "tab:red")
    ):  # fmt: skip
        axes[1].plot(phi, curves[key] / 1e5, color=color, label=name)
    axes[1].set_ylim(0, 2 * max(curves["p_plenum_pa"].max(), curves["p_manifold_pa"].max()) / 1e5)
    _named(axes[1], "crank angle from firing TDC [deg]", "absolute pressure [bar]")
    for name, color in (("exhaust", "tab:red"), ("inlet", "tab:green")):
        ends = (getattr(breathing, f"{name}_{event}") for event in ("opens", "closes", "lift"))
        lift = [float(valve_lift(math.radians(angle), *ends_)) for ends_ in [tuple(ends)] for angle in phi]
        axes[2].plot(phi, np.asarray(lift) * 1e3, color=color, label=name)
    _named(axes[2], "crank angle from firing TDC [deg]", "lift of the valve [mm]")
    for axis in axes[1:]:
        axis.set_xticks(range(-180, 541, 180))
        axis.legend(fontsize=8)
    written = write_picture(path, figure)
    plt.close(figure)
    return written


def _closed(values: np.ndarray) -> np.ndarray:
    return np.append(values, values[0])


def _named(axis: Any, x: str, y: str) -> None:
    axis.set_xlabel(x)
    axis.set_ylabel(y)
    axis.grid(alpha=0.3)

"""Pictures of engine cycles: the closed period at one speed, and figures over the speeds."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from mechsym.style import write_picture

_MAP = (("torque_avg", "mean torque [N m]"), ("power_kw", "power [kW]"), ("sfc_g_kwh", "consumption [g/kWh]"),
        ("p_max_mpa", "peak pressure [MPa]"))  # fmt: skip


def cycle_picture(path: Path, curves: Mapping[str, np.ndarray]) -> Path:
    """Pressure over volume and angle, and the torque of one piston.

    Parameters
    ----------
    curves : mapping of str to ndarray, shape (k,)
        See `cycle.curves`
    """
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.6), constrained_layout=True)
    phi, p = curves["phi_deg"], curves["p_pa"] / 1e6
    axes[0].loglog(curves["v_m3"] * 1e6, p)
    _label(axes[0], "volume [cm$^3$]", "pressure [MPa]")
    for axis in (axes[0].xaxis, axes[0].yaxis):
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())
    axes[1].plot(phi, p)
    _label(axes[1], "crank angle from firing TDC [deg]", "pressure [MPa]")
    axes[2].plot(phi, curves["torque_nm"])
    _label(axes[2], "crank angle from firing TDC [deg]", "torque of one piston [N m]")
    for axis in axes[1:]:
        axis.set_xticks(range(-180, 181, 60))
    return _save(figure, path)


def performance_picture(path: Path, engines: Mapping[str, Mapping[str, Any]]) -> Path:
    """Torque, power, consumption, peak pressure and energy shares over the speeds.

    Parameters
    ----------
    engines : mapping of str to mapping
        Name of each engine to its `cycle.columns`
    """
    figure, axes = plt.subplots(2, 3, figsize=(12, 6.4), constrained_layout=True)
    for style, (name, found) in zip(("-", "--", ":"), engines.items(), strict=False):
        speed = found["speed_rpm"]
        for axis, (key, label) in zip(axes.flat, _MAP, strict=False):
            axis.plot(speed, found[key], style, color="tab:blue" if style == "-" else "tab:red", label=name)
            _label(axis, "speed [rpm]", label)
        for color, (share, values) in zip(("C0", "C1", "C2", "C3"), found["fractions"].items(), strict=True):
            axes[1, 1].plot(speed, values, style, color=color, label=f"{share} {name}".strip())
        axes[1, 2].plot(speed, found["efficiency"], style, color="tab:blue" if style == "-" else "tab:red", label=name)
    axes[0, 2].set_ylim(*_without_start(engines, "sfc_g_kwh"))
    _label(axes[1, 1], "speed [rpm]", "share of the fuel's energy [-]")
    _label(axes[1, 2], "speed [rpm]", "efficiency [-]")
    axes[1, 1].legend(fontsize=7, ncols=len(engines), loc="upper right", bbox_to_anchor=(1, 0.9))
    if len(engines) > 1:
        axes[0, 0].legend(fontsize=8)
    return _save(figure, path)


def pareto_picture(path: Path, columns: Mapping[str, Any], objective: str, against: str) -> Path:
    """Front of two figures, and the design along it.

    Parameters
    ----------
    columns : mapping of str to sequence
        Both figures and the design variables, point by point
    """
    variables = [name for name in columns if name not in (objective, against)]
    figure, axes = plt.subplots(1, 1 + len(variables), figsize=(3.2 * (1 + len(variables)), 3.2), layout="constrained")
    for axis, name in zip(np.atleast_1d(axes), [objective, *variables], strict=True):
        axis.plot(columns[against], columns[name], "o-", markersize=4)
        _label(axis, against, name)
    return _save(figure, path)


def _without_start(engines: Mapping[str, Mapping[str, Any]], key: str) -> tuple[float, float]:
    # at a few rpm all heat goes into the walls and the consumption leaves the picture
    values = np.concatenate([found[key] for found in engines.values()])
    low = float(np.nanmin(values))
    return 0.98 * low, min(float(np.nanmax(values)), 1.4 * low)


def _label(axis: Any, x: str, y: str) -> None:
    axis.set_xlabel(x)
    axis.set_ylabel(y)
    axis.grid(alpha=0.3)


def _save(figure: Figure, path: Path) -> Path:
    written = write_picture(path, figure)
    plt.close(figure)
    return written

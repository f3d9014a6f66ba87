"""Picture of a pressure that a torque tells: the curve with its interval, broken where nothing is told."""

from pathlib import Path

import numpy as np

from mechsym.forces.indicated import NORMAL_95, IndicatedPressure
from mechsym.style import BLUE, axis_unit, legend, over_angle, panels, write_picture


def pressure_picture(path: Path, found: IndicatedPressure, period: float) -> Path:
    """Absolute pressure over the angle with its 95 % interval; gaps at the dead centres stay empty.

    Parameters
    ----------
    period : float
        Of the cycle [rad]
    """
    figure, axes = panels(8, 4, 1, 1, "Pressure that the torque tells, and its 95 % interval")
    axis = axes[0]
    p, half = (np.where(found.told, v, np.nan) for v in (found.p, NORMAL_95 * found.error))
    (factor, unit), angle = axis_unit("Pa", found.p[found.told]), over_angle(axis, period)
    phi = found.phi * angle
    axis.fill_between(phi, (p - half) * factor, (p + half) * factor, color=BLUE, alpha=0.25, linewidth=0, label="95 %")
    axis.plot(phi, p * factor, color=BLUE, label="pressure")
    axis.set_ylabel(f"absolute pressure [{unit}]")
    legend(axis)
    return write_picture(path, figure)

"""From measured cycles to the smooth periodic pressure that drives a mechanism.

    cycles (k, n) --mean--> one cycle --periodic smoothing spline--> Pressure

The spline leaves out as much as the noise of the mean cycle; both are reported, beside the scatter of the cycles.
"""

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
import scipy

from mechsym.cycle.chamber import Chamber
from mechsym.cycle.measured.checks import diagram_doubts
from mechsym.cycle.measured.diagram import Diagram
from mechsym.cycle.measured.measure import diagram_facts, measured_cycles
from mechsym.cycle.measured.signal import smooth
from mechsym.cycle.pressure import Pieces, Pressure, mean_indicated_pressure, peak, periodic
from mechsym.cycle.source import CylinderGas

_CLOSE = 1e-9  # [rad]


def diagram_pressure(diagram: Diagram, cylinder: Chamber) -> Pressure:
    """Pressure of a measured diagram. Returns pressure: mean cycle, smooth and periodic: no kinks."""
    measured = measured_cycles(diagram, cylinder)
    mean = measured.cycles.mean(axis=0)
    spline = smooth(measured.phi, mean, measured.period, diagram.smoothing)
    absolute = periodic(spline, measured.period, start=float(measured.phi[0]))
    p_max, phi_p_max = peak(absolute, measured.period, ())
    residual = float(np.sqrt(np.mean((absolute(measured.phi) - mean) ** 2)))
    return Pressure(
        kind="diagram",
        period=measured.period,
        kinks=(),
        absolute=absolute,
        p_max=p_max,
        phi_p_max=phi_p_max,
        mean_indicated=mean_indicated_pressure(absolute, measured.period, (), cylinder),
        formulas=_pieces(spline, float(measured.phi[0]), measured.period),
        phases={"compression line from": diagram.fit_from, "compression line to": diagram.fit_to},
        facts=diagram_facts(diagram, cylinder, measured, residual),
        doubts=tuple(
            f"{d.quantity} {d.value:.4g}, usual {d.usual}: {d.why}"
            for d in diagram_doubts(diagram, cylinder, measured, phi_p_max)
        ),
    )


def _pieces(spline: Any, start: float, period: float) -> Pieces:
    """The polynomials that a spline is made of over a period, from knot to knot."""
    poly = spline if isinstance(spline, scipy.interpolate.PPoly) else scipy.interpolate.PPoly.from_spline(spline)

    def cubic(low: float, c: list[float]) -> Callable[[Any], Any]:
        return lambda phi: functools.reduce(lambda value, of_power: value * (phi - low) + of_power, c)

    pieces = zip(poly.x[:-1].tolist(), poly.x[1:].tolist(), poly.c.T.tolist(), strict=True)
    within = start - _CLOSE, start + period + _CLOSE  # a periodic spline has knots beyond its ends
    return tuple((a, b, cubic(a, c)) for a, b, c in pieces if b - a > _CLOSE and a >= within[0] and b <= within[1])


class DiagramGas(CylinderGas):
    """Gas of a measured diagram, at the speed at which it was taken."""

    def pressure(self, room: Chamber, omega: float) -> tuple[Pressure, dict[str, float]]:
        """Pressure at any speed [rad/s]; of the fuel a diagram tells nothing."""
        return diagram_pressure(self.cycle, room), {}

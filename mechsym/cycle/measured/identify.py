r"""A measured diagram taken apart by the cycle model itself: what combustion, charge and dead centre made it?

Least squares between the measured trace and the model's, over any values of the engine (`cycle.ignition`,
`cycle.duration`, `cycle.wiebe_m`, ..) and over two faults of the measurement:

    p_measured(phi) = p_model(phi - tdc) + offset

`tdc` is the true dead centre on the measured scale of angles. The model knows the heat that goes into the walls, so
the dead centre does not have to pay for it, as it does where the compression line is taken for a polytrope.
"""

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np

from mechsym.cycle.closed.model import ClosedEngine, closed_period
from mechsym.cycle.closed.run import run
from mechsym.cycle.measured.fits import Fit, least_squares_fit
from mechsym.errors import BadInput

FAULTS = ("tdc", "offset")
_STEP = 1e-5


def identify(
    engine: ClosedEngine, omega: float, phi: np.ndarray, p: np.ndarray, start: Mapping[str, float],
    scale: Mapping[str, float],
) -> Fit:  # fmt: skip
    """Values of the engine, and faults of the measurement, that explain a diagram best.

    Parameters
    ----------
    engine : ClosedEngine
        The engine; what is not named stays as it is
    omega : float
        Crank speed [rad/s]
    phi : ndarray, shape (n,)
        Ascending measured crank angles within the closed period, from the assumed firing TDC [rad]
    p : ndarray, shape (n,)
        Measured pressure [Pa]
    start : mapping of str to float
        Names of a design, `tdc` [rad], `offset` [Pa], with values to begin from
    scale : mapping of str to float
        How far each of them may plausibly be off; they stay within twenty times that [-]

    Returns
    -------
    fit : Fit
        In the order of `start`; SI units, rms [Pa]
    """
    names = tuple(start)
    margin = 20 * scale.get("tdc", 0.0)
    low, high = engine.cycle.inlet_closes, engine.cycle.exhaust_opens
    if phi[0] < low - margin or phi[-1] > high + margin:
        raise BadInput(
            f"angles from {np.degrees(phi[0]):.1f} to {np.degrees(phi[-1]):.1f} deg leave the closed period from "
            f"{np.degrees(low):.1f} to {np.degrees(high):.1f} deg; cut the diagram"
        )
    origin, size = (np.array([values[n] for n in names]) for values in (start, scale))
    traces = partial(_traces, partial(closed_period, engine), omega, phi, names)

    def residuals(x: np.ndarray) -> np.ndarray:
        return traces((origin + size * x)[:, None])[0] - p

    def jacobian(x: np.ndarray) -> np.ndarray:
        # all columns in one run: the points of a map are as good as the corners of a difference scheme
        moved = (origin + size * x)[:, None] + _STEP * np.hstack([np.diag(size), -np.diag(size)])
        values = traces(moved)
        return (values[: len(names)] - values[len(names) :]).T / (2 * _STEP)

    box = (np.full(len(names), -20.0), np.full(len(names), 20.0))
    fit = least_squares_fit(residuals, names, np.zeros(len(names)), box, jacobian)
    values = origin + size * np.array(fit.values)
    spread = size * np.array(fit.confidence)
    return Fit(
        names=names,
        values=tuple(float(v) for v in values),
        confidence=tuple(float(s) for s in spread),
        rms=fit.rms,
    )


def _traces(build: Any, omega: float, phi: np.ndarray, names: tuple[str, ...], columns: np.ndarray) -> np.ndarray:
    values = dict(zip(names, columns, strict=True))
    zero = np.zeros(columns.shape[1])
    tdc, offset = (values.pop(name, zero) for name in FAULTS)
    result = run(build, {"omega": omega + zero, **values})
    return np.array([
        _at(result.phi[k], result.p[k], result.dp_dphi[k], phi - tdc[k]) + offset[k] for k in range(tdc.size)
    ])  # fmt: skip


def _at(nodes: np.ndarray, p: np.ndarray, slope: np.ndarray, phi: np.ndarray) -> np.ndarray:
    k = np.clip(np.searchsorted(nodes, phi, side="right") - 1, 0, nodes.size - 2)
    h = np.maximum(nodes[k + 1] - nodes[k], 1e-12)
    u = (phi - nodes[k]) / h
    rise, d0, d1 = p[k + 1] - p[k], slope[k] * h, slope[k + 1] * h
    return p[k] + u * rise + u * (1 - u) * ((1 - u) * (d0 - rise) - u * (d1 - rise))

"""Efficiency of a compressor out of its map, points of corrected flow and pressure ratio between which it is linear."""

from collections.abc import Sequence

import numpy as np
import scipy

from mechsym.errors import BadInput

_T, _P = 288.15, 101325.0  # state that a map's flow is corrected to [K, Pa]


def corrected_flow(flow: np.ndarray, p: float, T: float) -> np.ndarray:
    r"""Flow through a compressor as its map counts it.

    .. math:: \dot m_{corr} = \dot m\,\frac{\sqrt{T/288.15\,\mathrm{K}}}{p/101325\,\mathrm{Pa}}

    Parameters
    ----------
    flow : ndarray
        Mass flow [kg/s]
    p, T : float
        State before the compressor [Pa, K]

    Returns
    -------
    flow : ndarray
        Corrected flow, shape of `flow` [kg/s]

    Notes
    -----
    Source: similarity of Mach numbers; SAE J1826. Valid: the gas of the map, Reynolds number without effect.

    Examples
    --------
    >>> round(float(corrected_flow(np.array(0.1), 101325.0, 288.15)), 3)
    0.1
    """
    return flow * np.sqrt(T / _T) / (p / _P)


def map_efficiency(points: Sequence[Sequence[float]], flow: np.ndarray, ratio: float) -> np.ndarray:
    """Isentropic efficiency at a pressure ratio.

    Parameters
    ----------
    points : sequence of three sequences
        Corrected flows [kg/s], pressure ratios and efficiencies [-] of the map's points
    flow : ndarray, shape (n,)
        Corrected flow [kg/s]
    ratio : float
        Pressure ratio [-]

    Returns
    -------
    efficiency : ndarray, shape (n,)
        Isentropic efficiency [-]

    Raises
    ------
    BadInput
        A point outside the map: surge on its left, choke on its right

    Notes
    -----
    Source: planes through each three neighbouring points of the map (Delaunay), flow and ratio by their largest. Valid
    between the points that the maker measured.

    Examples
    --------
    >>> points = ([0.1, 0.3, 0.1, 0.3], [1.0, 1.0, 3.0, 3.0], [0.6, 0.7, 0.6, 0.7])
    >>> round(float(map_efficiency(points, np.array([0.2]), 2.0)[0]), 9)
    0.65
    """
    flows, ratios, values = (np.asarray(p, float) for p in points)
    scale = np.array([flows.max(), ratios.max()])
    surface = scipy.interpolate.LinearNDInterpolator(np.column_stack([flows, ratios]) / scale, values)
    found = np.asarray(surface(np.column_stack([flow, np.full(len(flow), ratio)]) / scale))
    if np.isnan(found).any():
        out = float(flow[int(np.argmax(np.isnan(found)))])
        raise BadInput(
            f"boost.map_flow: the engine asks for {out:.4g} kg/s at a pressure ratio of {ratio:.3g}, outside the map "
            f"(flows {flows.min():.4g} to {flows.max():.4g} kg/s, ratios {ratios.min():.3g} to {ratios.max():.3g}): "
            "surge or choke; change boost.pressure, boost.cylinders or the compressor"
        )
    return found

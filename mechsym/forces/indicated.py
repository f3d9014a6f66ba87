r"""Cylinder pressure out of the torque that was measured on the shaft: the force chain taken backwards.

At constant speed the derived equations are straight lines in the pressure, at every angle of their own:

.. math::
    M(\varphi) = M_0(\varphi) + (p - p_\mathrm{back})\,h(\varphi), \qquad
    M_0 = -\tfrac12 I'(\varphi)\,\omega^2 - V'(\varphi), \qquad h = A\,x'(\varphi)

At a dead centre x' = 0: no torque tells of the pressure, and none is told there.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.arrays import along
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities import quantity, record

NORMAL_95 = 1.959963984540054  # half width of the 95 % interval of a normal distribution, in standard deviations [-]
_DEAD = 1e-6  # of the largest lever: below it the round-off of the torque is all that is left


@record
class CrankTorque:
    """The torque of a shaft at constant speed, as it was measured."""

    phi: np.ndarray  #: shape (n,): Crank angles, ascending [rad]
    torque: np.ndarray  #: shape (n,): On the load, positive driving it [N*m]
    omega: float = quantity("rad/s", about="speed of the shaft")
    noise: float = quantity("N*m", about="standard deviation of each torque")
    with_inertia: bool = True  #: Whether the moving masses and weights are in the torque


@record
class IndicatedPressure:
    """Absolute pressure in the cylinder where the torque tells it."""

    phi: np.ndarray  #: shape (n,): Crank angles [rad]
    p: np.ndarray  #: shape (n,): Absolute pressure; finite and without meaning where not told [Pa]
    error: np.ndarray  #: shape (n,): Its standard deviation [Pa]
    told: np.ndarray  #: shape (n,): Whether the torque tells the pressure there [-]
    gas: np.ndarray  #: shape (n,): Torque of the gas [N*m]
    lever: np.ndarray  #: shape (n,): Torque by pressure h [N*m/Pa]
    limit: float  #: Widest half of a 95 % interval that counts as told [Pa]


def shaft_lines(
    mechanism: Mechanism, areas: Mapping[str, float], phi: np.ndarray, omega: float, held: Mapping[str, float]
) -> tuple[np.ndarray, np.ndarray]:
    r"""Torque on the load without gas, and how much of it a pressure adds.

    .. math:: M_0 = Q(0) - b, \qquad h = Q(A) - Q(0)

    with generalised force Q and bias b of the derived equations at constant speed.

    Parameters
    ----------
    mechanism : Mechanism
        Reduced to the angle of its shaft, as `crank_drive` builds it
    areas : mapping of str to float
        By input the force that one pascal gives it, with its sign [m^2]
    phi : ndarray, shape (n,)
        Crank angles [rad]
    omega : float
        Speed of the shaft [rad/s]
    held : mapping of str to float
        Inputs that do not change [N] or [N*m]

    Returns
    -------
    idle, lever : ndarray, shape (n,)
        M_0 [N*m] and h [N*m/Pa]

    Notes
    -----
    Source: derived here, from the equations of the mechanism. Valid at constant speed.

    Examples
    --------
    A crank of 1 m, massless but for its rotor, and a long rod: at 90 degrees each newton on the piston is one newton
    metre.

    >>> from mechsym.mechanisms import bind
    >>> letters = dict(r1=0.5, r2=0.5, l1=5e4, l2=5e4, m1=0, m2=0, m3=0, m4=0, m5=0, I01=1, IC2=0, g=0, axis_tilt=0)
    >>> idle, lever = shaft_lines(bind("crosshead", letters), {"F": 1.0}, np.array([np.pi / 2]), 10.0,
    ...                           {"M_r": 0.0, "M_h": 0.0})
    >>> round(float(lever[0]), 4)
    1.0
    """
    (q,) = mechanism.coordinates
    letters: dict[str, Any] = {q: phi, f"{q}d": np.full_like(phi, omega), **held}
    dynamics = mechanism.functions["dynamics"]

    def torque(push: Mapping[str, Any]) -> tuple[np.ndarray, np.ndarray]:
        found = list(along(dynamics, letters | dict(push)).values())
        return found[2].ravel() + 0 * phi, found[1].ravel() + 0 * phi

    none, bias = torque({})
    lever, _ = torque({name: held.get(name, 0.0) + area for name, area in areas.items()})
    return none - bias, lever - none


def pressure_from_torque(
    measured: CrankTorque, idle: np.ndarray, lever: np.ndarray, p_back: float
) -> IndicatedPressure:
    r"""Pressure out of a measured torque, with the uncertainty that the noise of the torque gives it.

    .. math:: p = p_\mathrm{back} + \frac{M - M_0}{h}, \qquad \sigma_p = \frac{\sigma_M}{|h|}

    Told is what has a 95 % interval of a half width below the pressure that the largest gas torque shows at the largest
    lever: :math:`1.96\,\sigma_p < \max|M - M_0| / \max|h|`. The gap about a dead centre grows with the noise.

    Parameters
    ----------
    idle, lever : ndarray, shape (n,)
        M_0 [N*m] and h [N*m/Pa], as `shaft_lines` gives them
    p_back : float
        Absolute pressure on the other side of the piston [Pa]

    Returns
    -------
    found : IndicatedPressure
        At every angle of the torque [Pa]

    Raises
    ------
    BadInput
        The noise is as large as the torque

    Notes
    -----
    Source: derived here. Valid for independent normal noise of the torque; friction in the torque counts as gas, an
    error of the angle or of the masses is not in the interval.

    Examples
    --------
    >>> one = CrankTorque(phi=np.array([1.0]), torque=np.array([30.0]), omega=100.0, noise=1.0)
    >>> found = pressure_from_torque(one, np.array([10.0]), np.array([1e-4]), 1e5)
    >>> round(float(found.p[0])), round(float(found.error[0]))
    (300000, 10000)
    """
    gas = measured.torque - (idle if measured.with_inertia else 0.0)
    size = np.abs(lever)
    limit = float(np.abs(gas).max() / size.max())
    turning = size > _DEAD * size.max()
    safe = np.where(turning, lever, size.max())
    error = measured.noise / np.abs(safe)
    told = turning & (NORMAL_95 * error < limit)
    if not told.any():
        raise BadInput(
            f"noise = {measured.noise:g} N*m hides the torque of the gas, at most {np.abs(gas).max():g} N*m; "
            f"below {np.abs(gas).max() / NORMAL_95:.4g} N*m it tells a pressure: average more cycles"
        )
    return IndicatedPressure(
        phi=measured.phi, p=p_back + gas / safe, error=error, told=told, gas=gas, lever=lever, limit=limit
    )  # fmt: skip


def work(measured: CrankTorque, found: IndicatedPressure, period: float) -> tuple[float, float]:
    r"""Work of the gas over a cycle, which needs no pressure and knows no gap, with its standard deviation.

    .. math:: W = \oint (M - M_0)\,d\varphi \approx \sum_i w_i (M - M_0)_i, \qquad
        \sigma_W = \sigma_M \sqrt{\sum_i w_i^2}

    Parameters
    ----------
    period : float
        2 pi or 4 pi, over which the rows go [rad]

    Returns
    -------
    work, error : float
        W and its standard deviation [J]

    Notes
    -----
    Source: trapezoidal rule over a period. Valid for rows that resolve the torque.

    Examples
    --------
    >>> phi = np.arange(4) * np.pi / 2
    >>> one = CrankTorque(phi=phi, torque=np.array([1.0, 3.0, 1.0, 3.0]), omega=1.0, noise=0.1)
    >>> found = pressure_from_torque(one, np.zeros(4), np.ones(4), 0.0)
    >>> [round(v, 3) for v in work(one, found, 2 * np.pi)]
    [12.566, 0.314]
    """
    around = np.concatenate([[found.phi[-1] - period], found.phi, [found.phi[0] + period]])
    weights = (around[2:] - around[:-2]) / 2
    return float(weights @ found.gas), float(measured.noise * np.sqrt(weights @ weights))


def scatter(torque: np.ndarray) -> float:
    r"""Standard deviation of the noise that a smooth curve shows by itself.

    .. math:: \sigma \approx 1.4826\,\mathrm{median}|\Delta^3 M| / \sqrt{20}

    Parameters
    ----------
    torque : ndarray, shape (n,)
        Rows one after the other [N*m]

    Returns
    -------
    sigma : float
        Standard deviation [N*m]

    Notes
    -----
    Source: third differences of independent noise have 20 times its variance. Valid for steps that are even and small.

    Examples
    --------
    >>> scatter(np.arange(9.0) ** 2)
    0.0
    """
    return float(1.4826 * np.median(np.abs(np.diff(torque, 3))) / np.sqrt(20.0))


def gaps(found: IndicatedPressure) -> list[tuple[float, float]]:
    """Angles where nothing is told [rad].

    Returns
    -------
    gaps : list of (float, float)
        First and last row without a pressure, one pair a gap [rad]
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[True], found.told, [True]]).astype(int)))
    return [(float(found.phi[a]), float(found.phi[b - 1])) for a, b in zip(edges[::2], edges[1::2], strict=True)]

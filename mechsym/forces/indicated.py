r"""Cylinder pressure out of the torque that was measured on the shaft: the force chain taken backwards.

At constant speed the derived equations are straight lines in the pressure, at every angle of their own:

.. math::
    M(\varphi) = M_0(\varphi) + (p - p_\mathrm{back})\,h(\varphi), \qquad
    M_0 = -\tfrac12 I'(\varphi)\,\omega^2 - V'(\varphi), \qquad h = A\,x'(\varphi)

At a dead centre x' = 0: no torque tells of the pressure, and none is told there.
"""

from collections.abc import Mapping
from typing import Annotated

import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.arrays import along
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Area, Array, Joule, NewtonMetre, Pascal, Radian, RadPerSecond, Scalar

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
    mechanism: Mechanism, areas: Mapping[str, Area], phi: Radian[Array], omega: RadPerSecond, held: Mapping[str, float]
) -> tuple[NewtonMetre[Array], Annotated[Array, "N*m/Pa"]]:
    r"""Torque on the load without gas, and how much of it a pressure adds.

    .. math:: M_0 = Q(0) - b, \qquad h = Q(A) - Q(0)

    with generalised force Q and bias b of the derived equations at constant speed. mechanism: reduced to the angle of
    its shaft, as `crank_drive` builds it; areas: by input the force that one pascal gives it, with its sign; held:
    inputs that do not change [N] or [N*m]. Source: derived here, from the equations of the mechanism. Valid at constant
    speed. A crank of 1 m, massless but for its rotor, and a long rod: at 90 degrees each newton on the piston is one
    newton metre.

    >>> from mechsym.mechanisms import bind
    >>> letters = dict(r1=0.5, r2=0.5, l1=5e4, l2=5e4, m1=0, m2=0, m3=0, m4=0, m5=0, I01=1, IC2=0, g=0, axis_tilt=0)
    >>> idle, lever = shaft_lines(bind("crosshead", letters), {"F": 1.0}, np.array([np.pi / 2]), 10.0,
    ...                           {"M_r": 0.0, "M_h": 0.0})
    >>> round(float(lever[0]), 4)
    1.0
    """
    (q,) = mechanism.coordinates
    letters: dict[str, Scalar] = {q: phi, f"{q}d": np.full_like(phi, omega), **held}
    dynamics = mechanism.functions["dynamics"]

    def torque(push: Mapping[str, Scalar]) -> tuple[np.ndarray, np.ndarray]:
        _, bias, force = along(dynamics, letters | dict(push)).values()
        return force.ravel() + 0 * phi, bias.ravel() + 0 * phi

    none, bias = torque({})
    lever, _ = torque({name: held.get(name, 0.0) + area for name, area in areas.items()})
    return none - bias, lever - none


def pressure_from_torque(
    measured: CrankTorque, idle: NewtonMetre[Array], lever: Annotated[Array, "N*m/Pa"], p_back: Pascal
) -> IndicatedPressure:
    r"""Pressure out of a measured torque, with the uncertainty that the noise of the torque gives it.

    .. math:: p = p_\mathrm{back} + \frac{M - M_0}{h}, \qquad \sigma_p = \frac{\sigma_M}{|h|}

    Told is what has a 95 % interval of a half width below the pressure that the largest gas torque shows at the largest
    lever: :math:`1.96\,\sigma_p < \max|M - M_0| / \max|h|`. The gap about a dead centre grows with the noise. idle,
    lever: M_0 and h, as `shaft_lines` gives them; p_back: absolute pressure on the other side of the piston. Returns
    pressure: at every angle of the torque [Pa]. Raises BadInput: the noise is as large as the torque.
    Source: derived here. Valid for independent normal noise of the torque; friction in the torque counts as gas, an
    error of the angle or of the masses is not in the interval.

    >>> one = CrankTorque(phi=np.array([1.0]), torque=np.array([30.0]), omega=100.0, noise=1.0)
    >>> indicated = pressure_from_torque(one, np.array([10.0]), np.array([1e-4]), 1e5)
    >>> round(float(indicated.p[0])), round(float(indicated.error[0]))
    (300000, 10000)
    """
    gas = measured.torque - (idle if measured.with_inertia else 0.0)
    size = np.abs(lever)
    limit = float(np.abs(gas).max() / size.max())
    turning = size > _DEAD * size.max()
    safe = np.where(turning, lever, size.max())
    error = measured.noise / np.abs(safe)
    clear = turning & (NORMAL_95 * error < limit)
    if not clear.any():
        raise BadInput(
            f"noise = {measured.noise:g} N*m hides the torque of the gas, at most {np.abs(gas).max():g} N*m; "
            f"below {np.abs(gas).max() / NORMAL_95:.4g} N*m it tells a pressure: average more cycles"
        )
    p = p_back + gas / safe
    return IndicatedPressure(phi=measured.phi, p=p, error=error, told=clear, gas=gas, lever=lever, limit=limit)


def work(measured: CrankTorque, pressure: IndicatedPressure, period: Radian) -> tuple[Joule, Joule]:
    r"""Work of the gas over a cycle, which needs no pressure and knows no gap, with its standard deviation.

    .. math:: W = \oint (M - M_0)\,d\varphi \approx \sum_i w_i (M - M_0)_i, \qquad
        \sigma_W = \sigma_M \sqrt{\sum_i w_i^2}

    period: 2 pi or 4 pi, over which the rows go.
    Source: trapezoidal rule over a period. Valid for rows that resolve the torque.

    >>> phi = np.arange(4) * np.pi / 2
    >>> one = CrankTorque(phi=phi, torque=np.array([1.0, 3.0, 1.0, 3.0]), omega=1.0, noise=0.1)
    >>> indicated = pressure_from_torque(one, np.zeros(4), np.ones(4), 0.0)
    >>> [round(v, 3) for v in work(one, indicated, 2 * np.pi)]
    [12.566, 0.314]
    """
    around = np.concatenate([[pressure.phi[-1] - period], pressure.phi, [pressure.phi[0] + period]])
    weights = (around[2:] - around[:-2]) / 2
    return float(weights @ pressure.gas), float(measured.noise * np.sqrt(weights @ weights))


def scatter(torque: NewtonMetre[Array]) -> NewtonMetre:
    r"""Standard deviation of the noise that a smooth curve shows by itself.

    .. math:: \sigma \approx 1.4826\,\mathrm{median}|\Delta^3 M| / \sqrt{20}

    torque: rows one after the other.
    Source: third differences of independent noise have 20 times its variance. Valid for steps that are even and small.

    >>> scatter(np.arange(9.0) ** 2)
    0.0
    """
    return float(1.4826 * np.median(np.abs(np.diff(torque, 3))) / np.sqrt(20.0))


def gaps(pressure: IndicatedPressure) -> list[tuple[Radian, Radian]]:
    """Angles where nothing is told [rad]. Returns gaps: first and last row without a pressure, one pair a gap."""
    edges = np.flatnonzero(np.diff(np.concatenate([[True], pressure.told, [True]]).astype(int)))
    return [(float(pressure.phi[a]), float(pressure.phi[b - 1])) for a, b in zip(edges[::2], edges[1::2], strict=True)]

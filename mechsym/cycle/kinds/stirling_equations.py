r"""Equations of the adiabatic Stirling cycle: five spaces in a row that share one pressure.

    [expansion V_e, T_e]--[heater V_h, T_h]--[regenerator V_r]--[cooler V_k, T_k]--[compression V_c, T_c]

The three exchangers keep their temperature, the two working spaces do not: what flows into one has the temperature of
its exchanger, what leaves it has its own. With j for e and c, T* the temperature of what passes the border of space j,
Q_j the heat through its wall (0 in the adiabatic cycle) and a dash for d/dphi:

.. math:: R T^*_j m_j' = p V_j' + V_j p'/\gamma - \tfrac{\gamma-1}{\gamma} Q_j', \qquad
          R (m_e' + m_c') + p' (V_h/T_h + V_r/T_r + V_k/T_k) = 0

The sign of m_j' decides T*_j, so a turn is cut where a flow turns round; between two cuts all is smooth. A space that
gives gas away keeps its entropy: with theta = T p^{-(gamma-1)/gamma} as a state nothing is divided by a volume, which
may shrink to nothing.

Source: I. Urieli, D. M. Berchowitz, Stirling Cycle Engine Analysis, Adam Hilger 1984, chapter 4. p is absolute.
"""

from collections.abc import Callable
from typing import Annotated

import casadi as ca
import numpy as np

from mechsym.quantities import record
from mechsym.quantities.units import Array, Kelvin, Radian, Scalar

STATES = ("p", "m_e", "m_c", "theta_e", "theta_c", "Q_h", "Q_r", "Q_k", "Q_e", "Q_c", "W_e", "W_c", "p_mean")
TALLIES = STATES[5:]


@record
class FiveSpaces:
    """The gas and its spaces; attributes are numbers or CasADi expressions."""

    #: shaft angle [rad] to the volumes of the expansion and of the compression space, clearance included [m^3]
    volumes: Callable[[Scalar], tuple[Scalar, Scalar]]
    #: volumes of heater, regenerator and cooler [m^3]
    V_h: Scalar
    V_r: Scalar
    V_k: Scalar
    #: temperatures of the gas in heater and cooler [K]
    T_h: Scalar
    T_k: Scalar
    #: ratio of the heat capacities [-] and gas constant [J/(kg*K)]
    gamma: Scalar
    R: Scalar
    #: absolute pressure, mean over a turn [Pa]
    mean_pressure: Scalar
    #: heat conductance between gas and wall by angular speed, of each working space [J/(K*rad)]
    film_e: Scalar = 0.0
    film_c: Scalar = 0.0


def evaluated(volumes: Callable[[Scalar], tuple[Scalar, Scalar]], phi: Radian[Array]) -> tuple[np.ndarray, np.ndarray]:
    """Both volumes and their slopes, each of shape (2, n) [m^3, m^3/rad]."""
    angle = ca.SX.sym("phi")
    both = ca.vertcat(*volumes(angle))
    found = ca.Function("volumes", [angle], [both, ca.jacobian(both, angle)])(phi.reshape(1, -1))
    return np.asarray(found[0]), np.asarray(found[1])


def regenerator_temperature(T_h: Kelvin[Scalar], T_k: Kelvin[Scalar]) -> Kelvin[Scalar]:
    r"""Mean temperature of a regenerator with a straight profile, as the mass of its gas asks for it.

    .. math:: T_r = \frac{T_h - T_k}{\ln(T_h/T_k)}

    T_h, T_k: temperatures at its ends, not equal. Returns T_r: harmonic mean over the length.
    Source: Urieli and Berchowitz (1984), section 3.2. Valid: T linear along the regenerator, T_h > T_k.

    >>> round(float(regenerator_temperature(900.0, 330.0)), 2)
    568.12
    """
    return (T_h - T_k) / ca.log(T_h / T_k)


def exchanger_capacity(spaces: FiveSpaces) -> Annotated[Scalar, "m^3/K"]:
    """Mass of gas in the exchangers by pressure, times the gas constant.

    .. math:: K = V_h/T_h + V_r/T_r + V_k/T_k

    spaces: volumes [m^3] of heater, regenerator and cooler, temperatures [K] of heater and cooler. Returns K: sum over
    the three.
    Source: ideal gas at one pressure. Valid: exchangers without film resistance, T_h > T_k.

    >>> case = FiveSpaces(volumes=None, V_h=1e-4, V_r=0.0, V_k=1e-4, T_h=1000.0, T_k=500.0, gamma=1.4, R=287.0,
    ...                   mean_pressure=5e5)
    >>> round(float(exchanger_capacity(case)) * 1e7, 6)
    3.0
    """
    s = spaces
    return s.V_h / s.T_h + s.V_r / regenerator_temperature(s.T_h, s.T_k) + s.V_k / s.T_k


@record
class _Side:
    """One working space at one angle: volume, its slope, wall, what passes its border, heat through its wall."""

    volume: Scalar  #: [m^3]
    slope: Scalar  #: [m^3/rad]
    wall: Scalar  #: [K]
    passing: Scalar  #: [K]
    heat: Scalar  #: [J/rad]
    dtheta: Scalar  #: slope of T p^-kappa [K/(Pa^kappa*rad)]


def rates(
    spaces: FiveSpaces, inward: tuple[bool, bool], phi: Radian[Scalar], y: Scalar
) -> tuple[ca.SX, Annotated[Scalar, "J/rad"]]:
    r"""Slopes of all states while the flows keep their directions.

    .. math:: p' = -\frac{\sum_j (p V_j' - \kappa Q_j')/T^*_j}{K + \sum_j V_j/(\gamma T^*_j)}, \qquad
              \kappa = \frac{\gamma - 1}{\gamma}

    inward: whether gas flows into the expansion space, and into the compression space. Returns slopes: CasADi column,
    shape (13,), slopes of y [unit of the state/rad]; inflow: R T*_j m_j' of both spaces, whose sign is the flow's,
    shape (2,).

    Parameters
    ----------
    y : CasADi column, shape (13,)
        `STATES`: p [Pa], m_e, m_c [kg], theta_e, theta_c [K/Pa^kappa], then heats and works since the start [J] and
        the integral of p over the angle by a turn [Pa]

    Notes
    -----
    Source: Urieli and Berchowitz (1984), table 4.1, extended by the heat through the walls of the working spaces.
    Valid: ideal gas, one pressure, no leakage.

    Examples
    --------
    >>> case = FiveSpaces(volumes=lambda a: (2e-4 + 1e-4 * a, 2e-4), V_h=1e-4, V_r=1e-4, V_k=1e-4, T_h=900.0,
    ...                   T_k=300.0, gamma=1.4, R=287.0, mean_pressure=5e5)
    >>> phi, y = ca.SX.sym("phi"), ca.SX([5e5, 4e-4, 1e-3, 22.4, 7.06] + 8 * [0.0])
    >>> inflow = ca.Function("inflow", [phi], [rates(case, (True, False), phi, y)[1]])(0.0)
    >>> [round(float(v), 3) for v in ca.vertsplit(inflow)]
    [43.714, -6.286]
    """
    s, kappa = spaces, (spaces.gamma - 1) / spaces.gamma
    p, sides = y[0], [_side(s, j, inward[j], phi, y) for j in (0, 1)]
    push = [p * side.slope - kappa * side.heat for side in sides]
    capacity = exchanger_capacity(s) + sum(side.volume / (s.gamma * side.passing) for side in sides)
    dp = -sum(f / side.passing for f, side in zip(push, sides, strict=True)) / capacity
    inflow = [f + side.volume * dp / s.gamma for f, side in zip(push, sides, strict=True)]
    dm = [f / (s.R * side.passing) for f, side in zip(inflow, sides, strict=True)]
    heats = _heats(s, dp, dm, sides)
    works = [p * side.slope for side in sides]
    slopes = [dp, *dm, *(side.dtheta for side in sides), *heats, *works, p / (2 * ca.pi)]
    return ca.vertcat(*slopes), ca.vertcat(*inflow)


def _side(s: FiveSpaces, j: int, inward: bool, phi: Scalar, y: Scalar) -> _Side:
    kappa, p, wall = (s.gamma - 1) / s.gamma, y[0], (s.T_h, s.T_k)[j]
    volume, film = s.volumes(phi)[j], (s.film_e, s.film_c)[j]
    kept = y[3 + j] * p**kappa
    if isinstance(film, float) and film == 0:  # without a film nothing is divided by a volume that may be nothing
        own, heat, dtheta = kept, 0.0, 0.0
    else:
        own = p * volume / (s.R * y[1 + j]) if inward else kept
        heat = film * (wall - own)
        dtheta = 0.0 if inward else kappa * heat * y[3 + j] / (p * volume)
    return _Side(
        volume=volume, slope=ca.jacobian(volume, phi), wall=wall, passing=wall if inward else own, heat=heat,
        dtheta=dtheta,
    )  # fmt: skip


def _heats(s: FiveSpaces, dp: Scalar, dm: list[Scalar], sides: list[_Side]) -> list[Scalar]:
    # first law of each exchanger; its gas has constant temperature, so its energy follows the pressure alone
    cp = s.gamma * s.R / (s.gamma - 1)
    heater, cooler = (cp * (side.passing - side.wall) * flow for side, flow in zip(sides, dm, strict=True))
    hot, cold = dm[0] + s.V_h * dp / (s.R * s.T_h), dm[1] + s.V_k * dp / (s.R * s.T_k)
    regenerator = s.V_r * dp / (s.gamma - 1) + cp * (s.T_h * hot + s.T_k * cold)
    return [heater - s.V_h * dp, regenerator, cooler - s.V_k * dp, *(side.heat for side in sides)]

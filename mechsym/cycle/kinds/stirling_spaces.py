r"""What a Stirling engine is made of: its gas, its spaces, and which piston sweeps which of them.

    alpha     V_e = A x_1       V_c = A x_2                    two cylinders, the hot piston first
    beta      V_e = A x_1       V_c = (A - A_r)(x_2 - x_1)     displacer 1 and piston 2 in one bore
    gamma     V_e = A x_1       V_c = A_p x_2 - (A - A_r) x_1  displacer and piston in bores of their own
    rhombic   V_e = -A x_1      V_c = (A - A_r)(x_2 + x_1)     beta, the displacer's yoke beyond the crankshaft

each plus what makes its smallest volume the clearance. x_i is the travel of piston i away from its own head, A_r the
area of the displacer's rod. A rhombic drive is a crank train with two cylinders on one throw, the displacer's axis
turned by half a turn, their offsets mirrored.

Equations of the adiabatic Stirling cycle: five spaces in a row that share one pressure.

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

import math
from collections.abc import Callable
from typing import Annotated

import casadi as ca
import numpy as np

from mechsym.cycle.chamber import piston_area
from mechsym.errors import BadInput
from mechsym.quantities import choice, quantity, record
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
    mean_pressure: Scalar  #: absolute pressure, mean over a turn [Pa]
    #: heat conductance between gas and wall by angular speed, of each working space [J/(K*rad)]
    film_e: Scalar = 0.0
    film_c: Scalar = 0.0


def evaluated(volumes: Callable[[Scalar], tuple[Scalar, Scalar]], phi: Radian[Array]) -> tuple[np.ndarray, np.ndarray]:
    """Both volumes and their slopes, each of shape (2, n) [m^3, m^3/rad]."""
    angle = ca.SX.sym("phi")
    both = ca.vertcat(*volumes(angle))
    values = ca.Function("volumes", [angle], [both, ca.jacobian(both, angle)])(phi.reshape(1, -1))
    return np.asarray(values[0]), np.asarray(values[1])


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
    the three. Source: ideal gas at one pressure. Valid: exchangers without film resistance, T_h > T_k.

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

    y: `STATES`: p [Pa], m_e, m_c [kg], theta_e, theta_c [K/Pa^kappa], then heats and works since the start [J] and the
    integral of p over the angle by a turn [Pa], shape (13,).
    Source: Urieli and Berchowitz (1984), table 4.1, extended by the heat through the walls of the working spaces.
    Valid: ideal gas, one pressure, no leakage.

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
    # first law of each exchanger; its gas has constant temperature, so its energy follows the pressure alone
    cp = s.gamma * s.R / (s.gamma - 1)
    heater, cooler = (cp * (side.passing - side.wall) * flow for side, flow in zip(sides, dm, strict=True))
    hot, cold = dm[0] + s.V_h * dp / (s.R * s.T_h), dm[1] + s.V_k * dp / (s.R * s.T_k)
    regenerator = s.V_r * dp / (s.gamma - 1) + cp * (s.T_h * hot + s.T_k * cold)
    heats = [heater - s.V_h * dp, regenerator, cooler - s.V_k * dp, *(side.heat for side in sides)]
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


_POINTS = 2880


@record
class WorkingGas:
    """An ideal gas of constant heat capacities, viscosity after Sutherland."""

    R: float  #: gas constant [J/(kg*K)]
    #: ratio of the heat capacities, and Prandtl number [-]
    gamma: float
    Pr: float
    #: viscosity at 273 K [Pa*s], and constant of Sutherland [K]
    mu_0: float
    sutherland: float

    @property
    def cp(self) -> float:
        """Heat capacity at constant pressure [J/(kg*K)]."""
        return self.gamma * self.R / (self.gamma - 1)


ARRANGEMENTS = ("alpha", "beta", "gamma", "rhombic")
# Urieli and Berchowitz (1984), appendix A; gamma of helium is that of a monatomic gas
GASES = {
    "air": WorkingGas(R=287.0, gamma=1.4, Pr=0.71, mu_0=17.08e-6, sutherland=112.0),
    "helium": WorkingGas(R=2077.0, gamma=5 / 3, Pr=0.71, mu_0=18.85e-6, sutherland=80.0),
    "hydrogen": WorkingGas(R=4124.0, gamma=1.4, Pr=0.71, mu_0=8.35e-6, sutherland=84.4),
}


@record
class StirlingCylinders:
    """What the kinds of Stirling cycle have in common in `[cycle]`."""

    arrangement: str = choice(*ARRANGEMENTS, default="alpha", about="which piston sweeps which space")
    gas: str = choice(*GASES, default="air", about="working gas")
    bore: float = quantity("m", above=0, about="bore of the cylinders")
    piston_bore: float | None = quantity(
        "m", default=None, above=0, about="bore of the piston of gamma, else `bore`", only=("arrangement", "gamma")
    )
    rod_diameter: float = quantity("m", default=0.0, low=0, about="rod of the displacer through the piston")
    dead_hot: float = quantity("m^3", low=0, about="heater and clearance of the expansion space")
    dead_cold: float = quantity("m^3", low=0, about="cooler and clearance of the compression space")
    dead_regenerator: float = quantity("m^3", above=0, about="volume of the regenerator")
    clearance_share_hot: float = quantity("-", default=0.5, low=0, high=1, about="share of dead_hot in the cylinder")
    clearance_share_cold: float = quantity("-", default=0.5, low=0, high=1, about="share of dead_cold in the cylinder")
    T_e: float = quantity("K", above=0, about="temperature of the hot side")
    T_c: float = quantity("K", above=0, about="temperature of the cold side")
    mean_pressure: float = quantity("Pa", above=0, about="absolute mean pressure")
    p_back: float = quantity("Pa", low=0, about="absolute pressure behind the pistons")

    def __post_init__(self) -> None:
        if self.T_e <= self.T_c:
            raise BadInput(f"T_e = {self.T_e:g} K must be above T_c = {self.T_c:g} K; else the machine is a heat pump")
        if self.rod_diameter >= self.bore:
            raise BadInput(f"rod_diameter = {self.rod_diameter:g} m must be below bore = {self.bore:g} m")


Travel = Callable[[Scalar], Scalar]
Volumes = Callable[[Scalar], tuple[Scalar, Scalar]]


def areas(cycle: StirlingCylinders) -> np.ndarray:
    """Slopes of the two volumes by the two travels, rows e and c, shape (2, 2) [m^2]; the columns' sums push."""
    whole, rod = piston_area(cycle.bore), piston_area(cycle.rod_diameter)
    ring, piston = whole - rod, piston_area(cycle.piston_bore or cycle.bore)
    table = {
        "alpha": [[whole, 0.0], [0.0, whole]],
        "beta": [[whole, 0.0], [-ring, ring]],
        "gamma": [[whole, 0.0], [-ring, piston]],
        "rhombic": [[-whole, 0.0], [ring, ring]],
    }
    return np.array(table[cycle.arrangement])


def swept(cycle: StirlingCylinders, travels: tuple[Travel, Travel]) -> Volumes:
    """Volumes of the two working spaces, clearance included, of travels that take CasADi expressions.

    Angle [rad] to volumes of expansion and compression space [m^3]; travels [m] of piston 1 and 2.
    """
    rows = areas(cycle).tolist()
    clearances = (cycle.dead_hot * cycle.clearance_share_hot, cycle.dead_cold * cycle.clearance_share_cold)

    def free(phi: Scalar) -> list[Scalar]:
        x, y = (travel(phi) for travel in travels)
        return [row[0] * x + row[1] * y for row in rows]

    base = [c - low for c, low in zip(clearances, _smallest(free), strict=True)]

    def volumes(phi: Scalar) -> tuple[Scalar, Scalar]:
        hot, cold = free(phi)
        return hot + base[0], cold + base[1]

    return volumes


def _smallest(free: Callable[[Scalar], list[Scalar]]) -> list[float]:
    # the least of a smooth periodic curve: the best of many points, then three steps of Newton
    angle = ca.SX.sym("phi")
    smallest = []
    for volume in free(angle):
        slope = ca.gradient(volume, angle)
        curve = ca.Function("curve", [angle], [volume, slope, ca.gradient(slope, angle)])
        phi = np.arange(_POINTS) * 2 * math.pi / _POINTS
        at = float(phi[int(np.argmin(np.asarray(curve(phi.reshape(1, -1))[0])))])
        for _ in range(3):
            _, first, second = (float(part) for part in curve(at))
            at -= first / second if second > 0 else 0.0
        smallest.append(float(curve(at)[0]))
    return smallest


def five_spaces(
    cycle: StirlingCylinders, volumes: Callable[[Scalar], tuple[Scalar, Scalar]], T_h: Scalar = None, T_k: Scalar = None
) -> FiveSpaces:
    """The spaces of a cycle; temperatures of the gas in the exchangers as in the cycle where none are given [K]."""
    gas = GASES[cycle.gas]
    return FiveSpaces(
        volumes=volumes,
        V_h=cycle.dead_hot * (1 - cycle.clearance_share_hot),
        V_r=cycle.dead_regenerator,
        V_k=cycle.dead_cold * (1 - cycle.clearance_share_cold),
        T_h=cycle.T_e if T_h is None else T_h,
        T_k=cycle.T_c if T_k is None else T_k,
        gamma=gas.gamma,
        R=gas.R,
        mean_pressure=cycle.mean_pressure,
    )

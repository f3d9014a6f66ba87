"""What a Stirling engine is made of: its gas, its spaces, and which piston sweeps which of them.

    alpha     V_e = A x_1       V_c = A x_2                    two cylinders, the hot piston first
    beta      V_e = A x_1       V_c = (A - A_r)(x_2 - x_1)     displacer 1 and piston 2 in one bore
    gamma     V_e = A x_1       V_c = A_p x_2 - (A - A_r) x_1  displacer and piston in bores of their own
    rhombic   V_e = -A x_1      V_c = (A - A_r)(x_2 + x_1)     beta, the displacer's yoke beyond the crankshaft

each plus what makes its smallest volume the clearance. x_i is the travel of piston i away from its own head, A_r the
area of the displacer's rod. A rhombic drive is a crank train with two cylinders on one throw, the displacer's axis
turned by half a turn, their offsets mirrored.
"""

import math
from collections.abc import Callable

import casadi as ca
import numpy as np

from mechsym.cycle.chamber import piston_area
from mechsym.cycle.kinds.stirling_equations import FiveSpaces
from mechsym.errors import BadInput
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.units import Scalar

_POINTS = 2880


@record
class WorkingGas:
    """An ideal gas of constant heat capacities, viscosity after Sutherland."""

    #: gas constant [J/(kg*K)]
    R: float
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
    found = []
    for volume in free(angle):
        slope = ca.gradient(volume, angle)
        curve = ca.Function("curve", [angle], [volume, slope, ca.gradient(slope, angle)])
        phi = np.arange(_POINTS) * 2 * math.pi / _POINTS
        at = float(phi[int(np.argmin(np.asarray(curve(phi.reshape(1, -1))[0])))])
        for _ in range(3):
            _, first, second = (float(part) for part in curve(at))
            at -= first / second if second > 0 else 0.0
        found.append(float(curve(at)[0]))
    return found


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

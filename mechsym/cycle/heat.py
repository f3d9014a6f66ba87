r"""Heat transfer from the cylinder gas to its walls, by name: Annand, Woschni, Hohenberg, or none.

Each law is a record of its coefficients; `heat_flux` gives the flux in W/m^2. The formulas use nothing but
arithmetic, so numbers, arrays and CasADi expressions all pass through.
"""

from typing import Annotated, NamedTuple

import casadi as ca

from mechsym.cycle.mixture import conductivity, viscosity
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Kelvin, Pascal, Scalar


class GasAtWall(NamedTuple):
    """The gas as a heat-transfer law sees it.

    p [Pa], t [K], v [m^3], gas_constant [J/(kg K)], bore [m], piston_speed (mean) [m/s], and swirl, Woschni's
    velocity by combustion divided by its coefficient: V_d T_r (p - p_motored)/(p_r V_r) [K], 0 before ignition.
    """

    p: Scalar
    t: Scalar
    v: Scalar
    gas_constant: Scalar
    bore: Scalar
    piston_speed: Scalar
    swirl: Scalar = 0.0


@record
class Annand:
    """Section `[heat_transfer]`, `law = "annand"`: Nu = a Re^b and radiation."""

    wall_temperature: float = quantity("K", above=0, about="mean wall temperature")
    #: Factor of the Nusselt number, 0.49 for four-stroke, 0.26 for two-stroke engines [-]
    a: float = quantity("-", default=0.49, low=0, about="factor of the Nusselt number")
    exponent: float = quantity("-", default=0.7, above=0, below=1.5, about="exponent of the Reynolds number")
    #: Factor of T^4 - T_w^4; 4.25e-9 for spark ignition, of order 3e-8 for compression ignition [W/(m^2*K^4)]
    radiation: float = quantity("W/m^2/K^4", default=4.25e-9, low=0, about="radiation factor")


@record
class Woschni:
    """Section `[heat_transfer]`, `law = "woschni"`."""

    wall_temperature: float = quantity("K", above=0, about="mean wall temperature")
    #: Gas velocity over mean piston speed while the valves are closed [-]
    c1: float = quantity("-", default=2.28, low=0, about="gas velocity over mean piston speed")
    c2: float = quantity("m/s/K", default=3.24e-3, low=0, about="gas velocity by combustion")


@record
class Hohenberg:
    """Section `[heat_transfer]`, `law = "hohenberg"`."""

    wall_temperature: float = quantity("K", above=0, about="mean wall temperature")
    c1: float = quantity("-", default=130.0, low=0, about="factor, pressure in bar")
    c2: float = quantity("m/s", default=1.4, low=0, about="velocity added to the mean piston speed")


@record
class Adiabatic:
    """Section `[heat_transfer]`, `law = "none"`: no heat is lost."""


Law = Annand | Woschni | Hohenberg | Adiabatic


def heat_flux(law: Law, state: GasAtWall) -> Annotated[Scalar, "W/m^2"]:
    r"""Heat flux from the gas to the walls.

    .. math::
        \text{Annand:}\quad & q = \frac{k}{B} a Re^{b}(T - T_w) + C_r (T^4 - T_w^4), \quad
            Re = \frac{p}{R T}\frac{\bar S_p B}{\mu} \\
        \text{Woschni:}\quad & q = 3.26\,B^{-0.2} p_{kPa}^{0.8} T^{-0.55} w^{0.8} (T - T_w), \quad
            w = C_1 \bar S_p + C_2 \frac{V_d T_r}{p_r V_r}(p - p_0) \\
        \text{Hohenberg:}\quad & q = C_1 V^{-0.06} p_{bar}^{0.8} T^{-0.4} (\bar S_p + C_2)^{0.8} (T - T_w)

    Returns flux: positive from the gas to the walls. Sources: Annand (1963) as printed in Nunes (2017), eqs. (2.30) to
    (2.37); Woschni (1967) after Heywood (1988), eqs. (12.19) and (12.20); Hohenberg (1979).
    """
    match law:
        case Annand():
            return _annand(law, state)
        case Woschni():
            w = law.c1 * state.piston_speed + law.c2 * state.swirl
            factor = 3.26 * state.bore**-0.2 * (state.p / 1e3) ** 0.8 * state.t**-0.55 * w**0.8
            return factor * (state.t - law.wall_temperature)
        case Hohenberg():
            speed = (state.piston_speed + law.c2) ** 0.8
            factor = law.c1 * state.v**-0.06 * (state.p / 1e5) ** 0.8 * state.t**-0.4 * speed
            return factor * (state.t - law.wall_temperature)
        case Adiabatic():
            return 0.0 * state.t
    raise TypeError(f"no heat-transfer law for {type(law).__name__}")


def motored_swirl(
    law: Law, p: Pascal[Scalar], p_motored: Pascal[Scalar], scale: Annotated[Scalar, "K/Pa"]
) -> Kelvin[Scalar]:
    """Woschni's combustion term, zero where the pressure is below the motored pressure and for the other laws.

    p, p_motored: pressure, and pressure of the motored cycle at the same volume; scale: V_d T_r/(p_r V_r) of the
    reference state. Returns swirl: entry of `GasAtWall`.
    """
    return scale * ca.fmax(p - p_motored, 0.0) if isinstance(law, Woschni) else 0.0


def _annand(law: Annand, state: GasAtWall) -> Scalar:
    density = state.p / (state.gas_constant * state.t)
    reynolds = density * state.piston_speed * state.bore / viscosity(state.t)
    convection = conductivity(state.t) / state.bore * law.a * reynolds**law.exponent
    # (T^4 - Tw^4)/(T - Tw) times (T - Tw): written without the quotient, which is 0/0 at the wall's temperature
    radiation = law.radiation * (state.t**4 - law.wall_temperature**4)
    return convection * (state.t - law.wall_temperature) + radiation

r"""The closed period of a cycle as a differential equation in the crank angle, one zone, first law closed.

    m c_v dT/dphi = dQ_R/dphi - dQ_L/dphi - p dV/dphi + (e_f - u) dm/dphi - m (du/dX) dX/dphi,    p = m R T/V

Q_R is the heat released (Wiebe), Q_L the heat lost to the walls, dm the fuel that turns into gas, which brings the
specific internal energy e_f along. The closed period falls into three phases with smooth equations: before, during
and after combustion; `phases` integrates them.

Every attribute of `Closed` may be a number or a CasADi expression of the design.
"""

from collections.abc import Callable, Mapping
from typing import Annotated, Any, NamedTuple

import casadi as ca

from mechsym.cycle.chamber import Chamber, volume, volume_and_slope, wall_area
from mechsym.cycle.heat import (
    MOTORED_EXPONENT,
    ConstantGamma,
    GasAtWall,
    Law,
    NasaMixture,
    heat_flux,
    motored_swirl,
    properties,
)
from mechsym.cycle.wiebe import ddouble_wiebe_dy, double_wiebe
from mechsym.quantities import record
from mechsym.quantities.units import Kelvin, Pascal, Radian, Scalar

PHASES = ("before", "during", "after")
# energies in J (exchange_work: of the ideal gas exchange), masses in kg, angles in rad, omega in rad/s, m^3, m
SCALARS = ("heat_released", "fuel_heat", "latent_heat", "fuel_energy", "energy_start", "energy_end", "exchange_work",
           "mass", "fuel", "omega", "closes", "starts", "ends", "opens", "displacement", "stroke")  # fmt: skip


@record
class Closed:
    """Everything that the closed period needs; attributes are numbers or CasADi expressions."""

    #: Volume, gas properties and heat transfer
    chamber: Chamber
    gas: ConstantGamma | NasaMixture
    law: Law
    omega: Scalar  #: Crank speed [rad/s]
    #: Inlet closing, start and duration of combustion, exhaust opening [rad]
    closes: Scalar
    starts: Scalar
    duration: Scalar
    opens: Scalar
    #: State when the inlet closes [Pa], [K], [kg]
    pressure: Scalar
    temperature: Scalar
    mass: Scalar
    fuel: Scalar  #: Mass of fuel [kg]
    #: Heat that combustion releases when the Wiebe function has reached 1, heating value of the fuel, and latent heat
    #: charged to the gas [J]
    heat: Scalar
    fuel_heat: Scalar
    latent_heat: Scalar
    fuel_energy: Scalar  #: Internal energy that fuel brings along when it turns into gas [J/kg]
    #: `vaporised`: evenly before ignition; `injected`: as it burns; `premixed`: in the charge from the start
    fuel_entry: str
    wiebe: tuple[Scalar, ...]  #: a_p, m_p, a_d, m_d, b of the double Wiebe function; b = 0 leaves the first alone [-]
    blowdown: Any = None  #: Exhaust valve (`blowdown.Blowdown`); without one the pressure is that of the intake at once


Build = Callable[[Mapping[str, Scalar]], Closed]  # design, numbers or symbols, to the closed period


class Contents(NamedTuple):
    """Burnt share, mass [kg] and their slopes in phi at one crank angle."""

    burnt: Scalar
    burnt_slope: Scalar
    mass: Scalar
    mass_slope: Scalar


def contents(closed: Closed, phase: str, phi: Radian[Scalar]) -> Contents:
    """What the chamber holds at a crank angle.

    phi: crank angle from firing top dead centre. Returns contents: burnt [-], burnt_slope [1/rad], mass [kg],
    mass_slope [kg/rad].
    """
    y = {"before": 0.0, "during": (phi - closed.starts) / closed.duration, "after": 1.0}[phase]
    burnt = 0.0 if phase == "before" else double_wiebe(y, *closed.wiebe)
    slope = ddouble_wiebe_dy(y, *closed.wiebe) / closed.duration if phase == "during" else 0.0
    match closed.fuel_entry:
        case "injected":
            return Contents(burnt, slope, closed.mass + closed.fuel * burnt, closed.fuel * slope)
        case "vaporised" if phase == "before":
            rate = closed.fuel / (closed.starts - closed.closes)
            return Contents(burnt, slope, closed.mass + rate * (phi - closed.closes), rate)
        case "vaporised":
            return Contents(burnt, slope, closed.mass + closed.fuel, 0.0)
    return Contents(burnt, slope, closed.mass, 0.0)


def pressure(closed: Closed, phase: str, phi: Radian[Scalar], t: Kelvin[Scalar]) -> Pascal[Scalar]:
    """Pressure of the gas. phi: crank angle from firing top dead centre. Returns p: absolute pressure."""
    now = contents(closed, phase, phi)
    return now.mass * properties(closed.gas, t, now.burnt).gas_constant * t / volume(closed.chamber, phi)


def rates(
    closed: Closed, phase: str, phi: Radian[Scalar], t: Kelvin[Scalar]
) -> tuple[Annotated[Scalar, "K/rad"], Annotated[Scalar, "J/rad"], Annotated[Scalar, "J/rad"]]:
    """Slopes of temperature, work and heat loss with the crank angle.

    phi: crank angle from firing top dead centre. Returns dw_dphi: work p dV; dq_dphi: heat to the walls.
    """
    v, dv = volume_and_slope(closed.chamber, phi)
    now = contents(closed, phase, phi)
    gas = properties(closed.gas, t, now.burnt)
    p = now.mass * gas.gas_constant * t / v
    chamber = closed.chamber
    swirl: Scalar = 0.0
    if phase != "before":
        v_ref = volume(chamber, closed.closes)
        motored = closed.pressure * (v_ref / v) ** MOTORED_EXPONENT
        scale = chamber.displacement * closed.temperature / (closed.pressure * v_ref)
        swirl = motored_swirl(closed.law, p, motored, scale)
    speed = chamber.stroke * closed.omega / ca.pi
    state = GasAtWall(p, t, v, gas.gas_constant, chamber.bore, speed, swirl)
    loss = heat_flux(closed.law, state) * wall_area(chamber, v) / closed.omega
    released = closed.heat * now.burnt_slope
    brought = (closed.fuel_energy - gas.energy) * now.mass_slope
    gain = released - loss - p * dv + brought - now.mass * gas.energy_slope * now.burnt_slope
    return gain / (now.mass * gas.heat_capacity), p * dv, loss


def scalars(closed: Closed, t_end: Kelvin[Scalar]) -> tuple[Scalar, ...]:
    """Values of the closed period in order and units of `SCALARS` [-]. t_end: temperature when the exhaust opens."""
    first, last = contents(closed, "before", closed.closes), contents(closed, "after", closed.opens)
    v_closes, v_opens = (volume(closed.chamber, angle) for angle in (closed.closes, closed.opens))
    values = {
        "heat_released": closed.heat * last.burnt,
        "fuel_heat": closed.fuel_heat,
        "latent_heat": closed.latent_heat,
        "fuel_energy": closed.fuel_energy * (last.mass - first.mass),
        "energy_start": first.mass * properties(closed.gas, closed.temperature, first.burnt).energy,
        "energy_end": last.mass * properties(closed.gas, t_end, last.burnt).energy,
        "exchange_work": closed.pressure * (v_closes - v_opens),
        "mass": closed.mass,
        "fuel": closed.fuel,
        "omega": closed.omega,
        "closes": closed.closes,
        "starts": closed.starts,
        "ends": closed.starts + closed.duration,
        "opens": closed.opens,
        "displacement": closed.chamber.displacement,
        "stroke": closed.chamber.stroke,
    }
    return tuple(values[name] for name in SCALARS)

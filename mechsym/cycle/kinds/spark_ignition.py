r"""The data of a four-stroke spark-ignition cycle with ideal gas exchange: charge, fuel, timing.

Crank angles count from firing top dead centre, so that the thesis's 180, 360 and 540 degrees are -180, 0 and 180.
Start and duration of combustion are straight lines over the speed (Nunes 2017, eqs. (3.1) and (3.2)).

Ideal air-standard cycles: what the cycle models come to when combustion is instant and nothing is lost.

p |  2'--3          Seiliger (dual): heat at constant volume 2-2', then at constant pressure 2'-3
  |  |    \         Otto: only 2-2'     Diesel: only 2-3
  |  2     \        compression 1-2 and expansion 3-4 isentropic, heat rejected at constant volume 4-1
  |   `-._  4
  |       `-1
  +----------- V
"""

from typing import Annotated, NamedTuple

import numpy as np

from mechsym.cycle.chamber import Chamber, volume
from mechsym.cycle.heat import ConstantGamma, NasaMixture, properties
from mechsym.errors import BadInput
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.units import Pure, Radian, RadPerSecond, Scalar


@record
class SparkIgnition:
    """Section `[cycle]`, `kind = "spark-ignition"`."""

    #: `converged`: the differential equation in crank angle; `nunes2017_printed`: the thesis's one-degree march
    method: str = choice(
        "converged",
        "nunes2017_printed",
        default="converged",
        about="solved until it converges, or by the source's steps as printed",
    )
    intake_pressure: float = quantity("Pa", above=0, about="absolute pressure when the inlet closes")
    intake_temperature: float = quantity("K", above=0, about="temperature when the inlet closes")
    #: Ends of the closed period, from firing top dead centre [rad]
    inlet_closes: float = quantity("rad", default=-np.pi, low=-np.pi, below=0, about="from firing TDC")
    exhaust_opens: float = quantity("rad", default=np.pi, above=0, high=np.pi, about="from firing TDC")
    ignition: float = quantity("rad", about="start of combustion at standstill, from firing TDC")
    ignition_slope: float = quantity("s", default=0.0, about="change of the start with speed")
    duration: float = quantity("rad", above=0, about="duration of combustion at standstill")
    duration_slope: float = quantity("s", default=0.0, about="change of the duration with speed")
    #: X = 1 - exp(-a y^(m + 1)) [-]
    wiebe_a: float = quantity("-", default=5.0, above=0, about="completeness factor")
    wiebe_m: float = quantity("-", default=2.0, above=-1, about="form factor")
    air_fuel_ratio: float = quantity("-", above=0, about="air over fuel by mass")
    stoichiometric_ratio: float = quantity("-", above=0, about="stoichiometric air over fuel by mass")
    #: Lower heating value of the fuel [J/kg]
    heating_value: float = quantity("J/kg", above=0, about="lower heating value")
    #: Factor of the fit over the relative air-fuel ratio [-]
    combustion_efficiency_max: float = quantity(
        "-", default=0.9, above=0, high=1, about="largest share of fuel that burns"
    )
    #: `latent_heat`: each kilogram of vapour costs its latent heat and arrives without internal energy (the thesis);
    #: `liquid_energy`: it arrives with the internal energy of the liquid at intake temperature; `none`: the charge is
    #: vapour from the start
    vaporisation: str = choice(
        "latent_heat",
        "liquid_energy",
        "none",
        default="liquid_energy",
        about="where the fuel takes its heat of evaporation from",
    )
    octane: float = quantity("-", default=95.0, low=60, high=130, about="octane number of the fuel, for knock")
    latent_heat: float = quantity(
        "J/kg",
        default=0.0,
        low=0,
        about="latent heat of vaporisation",
        only=("vaporisation", "latent_heat", "liquid_energy"),
    )

    def __post_init__(self) -> None:
        relative = self.air_fuel_ratio / self.stoichiometric_ratio
        if not 0.75 <= relative <= 1.2:
            raise BadInput(f"air_fuel_ratio = {self.air_fuel_ratio:g} is {relative:.3f} of stoichiometric_ratio; the "
                           "fit of the combustion efficiency (eq. 2.56) holds from 0.75 to 1.2")  # fmt: skip
        if relative > 1 and self.vaporisation != "none":
            raise BadInput(f"air_fuel_ratio = {self.air_fuel_ratio:g} is leaner than stoichiometric_ratio = "
                           f"{self.stoichiometric_ratio:g}, where the vaporisation model does not hold (section 2.3.5 "
                           'of the thesis); set vaporisation = "none" or lower air_fuel_ratio')  # fmt: skip


class Charge(NamedTuple):
    """What is in the chamber: gas (when the inlet closes) and fuel [kg], heat that combustion may release [J]."""

    gas: Scalar
    fuel: Scalar
    heat: Scalar


def combustion_efficiency(cycle: SparkIgnition) -> Pure[Scalar]:
    r"""Share of the heating value that combustion can release.

    .. math:: \eta_c = \eta_{c,max}(-1.6082 + 4.6509\lambda - 2.0764\lambda^2)

    cycle: its values may be CasADi expressions. Returns eta_c: combustion efficiency.
    Source: Blair (1999) as printed in Nunes (2017), eq. (2.56), for a relative air-fuel ratio of 0.75 to 1.2.
    """
    lam = cycle.air_fuel_ratio / cycle.stoichiometric_ratio
    return cycle.combustion_efficiency_max * (-1.6082 + 4.6509 * lam - 2.0764 * lam**2)


def charge(chamber: Chamber, cycle: SparkIgnition, gas_constant: Annotated[Scalar, "J/(kg*K)"]) -> Charge:
    r"""Masses in the chamber and the heat that combustion may release.

    .. math:: m = \frac{p_0 V(\varphi_{ivc})}{R T_0}, \quad
        m_f = \frac{p_0 (V(\varphi_{ivc}) - V_c)}{R T_0\, AFR}, \quad Q = \eta_c m_f Q_{HV}

    cycle: its values may be CasADi expressions. gas_constant: of the charge. Returns charge: gas [kg], fuel [kg], heat
    [J]. The clearance holds air at intake state too, but only the swept part is fuelled: Nunes (2017), eqs. (2.4),
    (2.5).
    """
    density = cycle.intake_pressure / (gas_constant * cycle.intake_temperature)
    v_closed = volume(chamber, cycle.inlet_closes)
    fuel = density * (v_closed - chamber.clearance) / cycle.air_fuel_ratio
    return Charge(density * v_closed, fuel, combustion_efficiency(cycle) * fuel * cycle.heating_value)


def latent_heat(cycle: SparkIgnition) -> Annotated[Scalar, "J/kg"]:
    """Latent heat that the cycle charges for a kilogram of fuel; 0 for a charge that is vapour from the start."""
    return 0.0 if cycle.vaporisation == "none" else cycle.latent_heat


def vapour_energy(cycle: SparkIgnition, gas: ConstantGamma | NasaMixture) -> Annotated[Scalar, "J/kg"]:
    """Internal energy that a kilogram of fuel brings along when it turns into vapour.

    cycle: its values may be CasADi expressions. gas: gas model, whose zero of energy counts. Returns energy: specific
    internal energy, latent heat taken off. The thesis charges the latent heat but lets the vapour arrive with zero
    energy at 0 K: erratum E4.
    """
    if cycle.vaporisation == "liquid_energy":
        return properties(gas, cycle.intake_temperature, 0.0).energy - cycle.latent_heat
    return -latent_heat(cycle)


def timing(cycle: SparkIgnition, omega: RadPerSecond[Scalar]) -> tuple[Radian[Scalar], Radian[Scalar]]:
    """Start and duration of combustion at a speed.

    cycle: its values may be CasADi expressions. Returns start: from firing top dead centre.
    """
    return cycle.ignition + cycle.ignition_slope * omega, cycle.duration + cycle.duration_slope * omega


def otto_efficiency(compression_ratio: Pure[Scalar], gamma: Pure[Scalar]) -> Pure[Scalar]:
    r"""Efficiency of the Otto cycle.

    .. math:: \eta = 1 - CR^{1-\gamma}

    compression_ratio: largest over smallest volume; gamma: ratio of heat capacities. Source: Nunes (2017), eq. (2.3).
    """
    return 1 - compression_ratio ** (1 - gamma)

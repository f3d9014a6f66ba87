"""Records of a four-stroke cylinder that breathes: valves, charge, fuel, walls, surroundings; a cycle found."""

import math

import numpy as np

from mechsym.cycle.heat import Adiabatic, Law
from mechsym.quantities import quantity, record

PERIOD = 4 * math.pi


@record
class Breathing:
    """Section `[breathing]`: valves, plenum and manifold of a four-stroke cylinder."""

    inlet_diameter: float = quantity("m", above=0, about="inner diameter of the inlet valve's seat")
    inlet_lift: float = quantity("m", above=0, about="largest lift of the inlet valve")
    inlet_opens: float = quantity(
        "rad", default=math.radians(345), above=math.pi, below=5 * math.pi / 2, about="from firing TDC"
    )
    inlet_closes: float = quantity(
        "rad", default=math.radians(590), above=5 * math.pi / 2, below=PERIOD, about="from firing TDC"
    )
    exhaust_diameter: float = quantity("m", above=0, about="inner diameter of the exhaust valve's seat")
    exhaust_lift: float = quantity("m", above=0, about="largest lift of the exhaust valve")
    exhaust_opens: float = quantity(
        "rad", default=math.radians(130), above=0, below=3 * math.pi / 2, about="from firing TDC"
    )
    exhaust_closes: float = quantity(
        "rad", default=math.radians(375), above=3 * math.pi / 2, below=3 * math.pi, about="from firing TDC"
    )
    valves: float = quantity("-", default=1.0, low=1, high=4, about="valves of each kind")
    discharge: float = quantity("-", default=0.7, above=0, high=1, about="discharge coefficient of valves and throats")
    throttle_diameter: float = quantity("m", above=0, about="throat between the surroundings and the plenum")
    plenum_volume: float = quantity("m^3", above=0, about="volume between throttle and inlet valve")
    tailpipe_diameter: float = quantity("m", above=0, about="throat between the manifold and the surroundings")
    manifold_volume: float = quantity("m^3", above=0, about="volume behind the exhaust valve")
    altitude: float = quantity("m", default=0.0, low=-500, high=11000, about="height above the sea (ISA)")
    inlet_pressure: float | None = quantity(
        "Pa", default=None, above=0, about="absolute, before the throttle; else the atmosphere's or the turbocharger's"
    )
    inlet_temperature: float | None = quantity(
        "K", default=None, above=0, about="before the throttle; else the atmosphere's or the turbocharger's"
    )
    exhaust_pressure: float | None = quantity(
        "Pa", default=None, above=0, about="absolute, behind the tail pipe; else the atmosphere's or the turbocharger's"
    )


@record
class FreshCharge:
    """The gas and how it burns: Wiebe's function with the factor a and the exponent m + 1."""

    gamma: float = quantity("-", default=1.4, above=1, below=2, about="ratio of the heat capacities")
    R: float = quantity("J/(kg*K)", default=287.0, above=0, about="gas constant")
    #: Heat released by each kilogram of fresh charge that is trapped [J/kg]
    heat: float = quantity("J/kg", low=0, about="heat of a kilogram of fresh charge")
    #: Start [rad] from firing top dead centre, and duration of combustion [rad]
    ignition: float = quantity("rad", about="start of combustion")
    duration: float = quantity("rad", above=0, about="duration of combustion")
    a: float = quantity("-", default=5.0, above=0, about="completeness factor")
    m: float = quantity("-", default=2.0, low=0, about="form factor")


@record
class HeatSink:
    """What the heat of the gas goes into."""

    law: Law = Adiabatic()
    #: Bore and stroke of one piston [m], swept volume of the cylinder [m^3]
    bore: float = 1.0
    stroke: float = 1.0
    displacement: float = 1.0


@record
class Surroundings:
    """State before the throttle and behind the tail pipe, one value or one for each speed."""

    #: Absolute pressure [Pa] and temperature [K] before the throttle
    p_in: np.ndarray | float = 101325.0
    T_in: np.ndarray | float = 288.15
    p_out: np.ndarray | float = 101325.0  #: Absolute pressure behind the tail pipe [Pa]


@record
class Breath:
    """A periodic cycle; curves run from the closing of the inlet over 4 pi."""

    omega: float  #: Crank speed [rad/s]
    phi: np.ndarray  #: Crank angle from firing top dead centre [rad]
    #: Absolute pressures of plenum, cylinder, manifold [Pa], temperature in the cylinder [K], volume of it [m^3]
    pressures: dict[str, np.ndarray]
    temperature: np.ndarray
    room: np.ndarray
    trapped: float  #: Mass of gas when the inlet closes [kg]
    residual: float  #: Its burnt share [-]
    drawn: float  #: Fresh gas that comes in at the throttle, less what is blown back there [kg]
    volumetric_efficiency: float  #: Fresh gas drawn by the mass of the swept volume at inlet conditions [-]
    trapping_efficiency: float  #: Fresh gas in the cylinder when the inlet closes by that drawn; the rest is lost [-]
    T_exhaust: float  #: Mean temperature of the gas that leaves, by energy [K]
    #: Works of the gas on the piston over the cycle, and over the two strokes of gas exchange [J]
    work: float
    pumping: float
    #: Heat released, and heat that goes into the walls [J]
    heat: float
    wall_heat: float
    closure: float  #: Largest change of a state from cycle to cycle, by its size [-]
    #: What the balances of mass and energy leave over, by what is trapped and by the energy in the cylinder [-]
    mass_residual: float
    energy_residual: float


@record
class GasExchange:
    """Section `[cycle]`, `kind = "gas-exchange"`; `[breathing]` has the valves, `[boost]` perhaps a turbocharger."""

    air_fuel_ratio: float = quantity("-", above=1, about="air over fuel by mass, mixed before the throttle")
    heating_value: float = quantity("J/kg", above=0, about="lower heating value")
    combustion_efficiency: float = quantity("-", default=0.95, above=0, high=1, about="share that combustion releases")
    #: Angles from firing top dead centre [rad]
    ignition: float = quantity("rad", above=-math.pi / 2, below=math.pi / 4, about="start of combustion")
    duration: float = quantity("rad", above=0, below=math.pi, about="duration of combustion")
    #: X = (1 - exp(-a y^(m + 1)))/(1 - exp(-a)) [-]
    wiebe_a: float = quantity("-", default=5.0, above=0, about="completeness factor")
    wiebe_m: float = quantity("-", default=2.0, low=0, about="form factor")
    octane: float = quantity("-", default=95.0, low=60, high=130, about="octane number of the fuel, for knock")
    gamma: float = quantity("-", default=1.32, above=1, below=2, about="ratio of the heat capacities, fresh and burnt")
    gas_constant: float = quantity("J/(kg*K)", default=287.0, above=0, about="of fresh and burnt gas")


def charge(cycle: GasExchange) -> FreshCharge:
    """The mixture of air and fuel that the cylinder draws in."""
    heat = cycle.combustion_efficiency * cycle.heating_value / (1 + cycle.air_fuel_ratio)
    return FreshCharge(
        gamma=cycle.gamma, R=cycle.gas_constant, heat=heat, ignition=cycle.ignition, duration=cycle.duration,
        a=cycle.wiebe_a, m=cycle.wiebe_m,
    )  # fmt: skip

"""The data of a four-stroke cycle whose gas exchange is followed: fuel, burning, gas."""

import math

from mechsym.cycle.breathing.records import FreshCharge
from mechsym.quantities import quantity, record


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

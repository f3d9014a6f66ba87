"""A gas that the package does not have, and whose pressure follows the speed: one file, and one row in the registry."""

import math

import numpy as np

from mechsym.cycle.chamber import Chamber
from mechsym.cycle.kinds import Kind
from mechsym.cycle.pressure import Pressure, pressure_over
from mechsym.cycle.source import CylinderGas
from mechsym.quantities import quantity, record


@record
class Pulse:
    """Section `[cycle]`, `kind = "pulse"`: a line in the angle's sine, throttled in proportion to the speed."""

    bore: float = quantity("m", above=0, about="diameter of the piston")
    compression_ratio: float = quantity("-", above=1, about="largest by smallest volume")
    p_mean: float = quantity("Pa", above=0, about="absolute mean pressure")
    swing: float = quantity("Pa", above=0, about="amplitude at standstill")
    throttled: float = quantity("Pa*s/rad", low=0, about="amplitude lost with speed")
    p_back: float = quantity("Pa", default=101325.0, low=0, about="absolute pressure behind the piston")


class PulseGas(CylinderGas):
    """Its gas: all that a kind has to say."""

    def pressure(self, room: Chamber, omega: float) -> tuple[Pressure, dict[str, float]]:
        """Pressure at a speed [rad/s]; no fuel burns."""
        cycle = self.cycle
        amplitude = cycle.swing - cycle.throttled * omega
        return pressure_over("pulse", lambda phi: cycle.p_mean + amplitude * np.sin(phi), math.tau, (), room), {}


ROW = Kind(cycle="pulsed_gas:Pulse", gas="pulsed_gas:PulseGas", fired=False)

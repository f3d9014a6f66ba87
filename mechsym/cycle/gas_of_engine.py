"""The gas of an engine with a closed cycle, on one piston."""

import math

import numpy as np

from mechsym.cycle.chamber import chamber
from mechsym.cycle.closed.model import ClosedEngine
from mechsym.cycle.engine import curves
from mechsym.cycle.gas import Gas
from mechsym.cycle.pressure import periodic, pressure_over

_STEP = math.radians(0.25)  # of the tabulated cycle


def gas_of_engine(engine: ClosedEngine, omega: float) -> Gas:
    """Gas of an engine at one speed.

    Parameters
    ----------
    omega : float
        Crank speed [rad/s]
    """
    found, room, charge = curves(engine, omega, _STEP), chamber(engine.chamber, engine.motion), engine.cycle
    phi = np.radians(found["phi_deg"])

    def closed_or_open(angle: np.ndarray) -> np.ndarray:
        return np.interp(angle, phi, found["p_pa"], left=charge.intake_pressure, right=charge.intake_pressure)

    facts = ("gas exchange takes place at intake pressure: assumed, the cycle models the closed period only",)
    absolute = periodic(closed_or_open, 4 * math.pi, -2 * math.pi)
    pressure = pressure_over(
        "spark-ignition", absolute, 4 * math.pi, (), room, t_max=float(found["t_k"].max()), facts=facts
    )
    return Gas(pressure=pressure, chamber=room)

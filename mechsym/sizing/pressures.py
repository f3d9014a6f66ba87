"""What the cycle asks of the parts: pressure over the period at every speed, and heat through a piston head."""

from functools import partial

import numpy as np

from mechsym.cycle.chamber import chamber
from mechsym.cycle.closed.model import ClosedEngine, closed_period
from mechsym.cycle.closed.run import dense, run
from mechsym.cycle.engine import over_speeds
from mechsym.quantities import record
from mechsym.quantities.units import Array, Pure, RadPerSecond
from mechsym.sizing.loads import over_period
from mechsym.sizing.rules.piston import head_heat, tdc_gap

_STEPS = 720  # angles over a period of 4 pi; divisible by 4 for the teeth's returns


@record
class Pressures:
    """Pressure over the period at every speed, and the chamber that it acts in."""

    #: shape (k,), (n,): Crank speeds [rad/s], crank angles from firing top dead centre [rad]
    omega: np.ndarray
    theta: np.ndarray
    net: np.ndarray  #: shape (k, n): Gas force on a piston, the pressure behind it taken off [N]
    dp_max: np.ndarray  #: shape (k,): Largest pressure above the surroundings [Pa]
    #: Bore, stroke of one piston, distance of the heads [m], heat through a head [W]
    bore: float
    stroke: float
    gap: float
    head_heat: float


def pressures_over(engine: ClosedEngine, omega: RadPerSecond[Array], heat_share: Pure) -> Pressures:
    """The cycle at every speed, gas exchange at the surroundings' pressure.

    omega: crank speeds, shape (k,); heat_share: share of the fuel's heat that goes through the two heads.
    """
    theta = np.arange(_STEPS) * 4 * np.pi / _STEPS
    phi, closed, _ = dense(run(partial(closed_period, engine), {"omega": omega}))
    around, room = engine.cycle.intake_pressure, chamber(engine.chamber, engine.motion)
    p = over_period(theta, phi, closed, around)
    top = over_speeds(engine, omega.max(keepdims=True))
    fuel = float(top.sfc[0] * top.power[0])  # in one cylinder, for the heads of both its pistons
    return Pressures(
        omega=omega,
        theta=theta,
        net=(p - engine.chamber.back_pressure) * float(room.area),
        dp_max=p.max(axis=1) - around,
        bore=float(room.bore),
        stroke=float(room.stroke),
        gap=tdc_gap(float(room.clearance), float(room.area)),
        head_heat=head_heat(fuel / 2, engine.cycle.heating_value, heat_share),
    )

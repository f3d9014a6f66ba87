r"""Reciprocating compressor: the p-V cycle of a cylinder whose valves open by the pressure across them.

    p |  3____2           1-2 compression  p V^n_c from the suction pressure at bottom dead centre
      |  |     \          2-3 delivery     at the delivery pressure up to top dead centre
      |   \      \        3-4 expansion    p V^n_e of the gas left in the clearance
      |    4_______1      4-1 suction      at the suction pressure
      +-------------- V

The gas takes work: the mean indicated pressure is negative, and so is the mean torque of the gas on the shaft.
"""

import math

import numpy as np

from mechsym.cycle.chamber import Chamber, volume
from mechsym.cycle.pressure import Pieces, Pressure, pressure_over
from mechsym.cycle.source import CylinderGas
from mechsym.errors import BadInput
from mechsym.periodic.roots import root
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Array, Pascal, Radian, Scalar

_TURN = 2 * math.pi


@record
class CompressorCycle:
    """Section `[cycle]` of kind `compressor`."""

    bore: float = quantity("m", above=0, about="cylinder bore")
    compression_ratio: float = quantity("-", above=1, high=1000, about="largest over smallest volume, the clearance")
    p_suction: float = quantity("Pa", above=0, about="absolute pressure in the cylinder while it draws in")
    p_delivery: float = quantity("Pa", above=0, about="absolute pressure in the cylinder while it delivers")
    n_c: float = quantity("-", low=1, high=1.8, about="index of compression")
    n_e: float = quantity("-", low=1, high=1.8, about="index of expansion of the gas left in the clearance")
    p_back: float = quantity("Pa", default=101325.0, low=0, about="absolute pressure behind the piston")

    def __post_init__(self) -> None:
        if self.p_delivery <= self.p_suction:
            raise BadInput(
                f"p_delivery = {self.p_delivery / 1e5:g} bar must be above p_suction = {self.p_suction / 1e5:g} bar"
            )
        largest = self.compression_ratio ** min(self.n_c, self.n_e)
        if self.p_delivery / self.p_suction >= largest:
            raise BadInput(
                f"p_delivery/p_suction = {self.p_delivery / self.p_suction:g}, but the clearance allows less than "
                f"compression_ratio^n = {largest:.4g}: nothing is delivered; raise the ratio or lower p_delivery"
            )


def absolute_pressure(cycle: CompressorCycle, room: Chamber, phi: Radian[Scalar]) -> Pascal[Array]:
    r"""Pressure in the cylinder.

    .. math:: p = \min(p_s (V_1/V)^{n_c}, p_d) \text{ on the way in}, \quad p = \max(p_d (V_3/V)^{n_e}, p_s)
              \text{ on the way out}

    phi: crank angles after top dead centre, in [0, 2 pi). Returns p: absolute. Valid: valves without inertia and
    losses, heat by the indices only.
    """
    V = np.asarray(volume(room, phi))
    full = room.clearance + room.displacement
    inward = np.minimum(cycle.p_suction * (full / V) ** cycle.n_c, cycle.p_delivery)
    outward = np.maximum(cycle.p_delivery * (room.clearance / V) ** cycle.n_e, cycle.p_suction)
    return np.where(np.asarray(phi) < room.motion.bottom, outward, inward)


def valves(cycle: CompressorCycle, room: Chamber) -> dict[str, float]:
    """Crank angles after top dead centre at which a valve opens or closes [rad]."""
    ratio, bottom = cycle.p_delivery / cycle.p_suction, room.motion.bottom
    full = room.clearance + room.displacement

    def reached(wanted: float, low: float, high: float) -> float:
        return root(lambda phi: float(volume(room, phi)) / wanted - 1, low, high, xtol=1e-15)

    return {
        "delivery valve closes": 0.0,
        "suction valve opens": reached(room.clearance * ratio ** (1 / cycle.n_e), 0.0, bottom),
        "suction valve closes": bottom,
        "delivery valve opens": reached(full * ratio ** (-1 / cycle.n_c), bottom, _TURN),
    }


def formulas(cycle: CompressorCycle, room: Chamber, at: list[float]) -> Pieces:
    """The same from valve to valve, whose angles are `at` [rad], for a CasADi symbol too."""
    full = room.clearance + room.displacement
    laws = (
        lambda phi: cycle.p_delivery * (room.clearance / volume(room, phi)) ** cycle.n_e,
        lambda phi: cycle.p_suction + 0 * phi,
        lambda phi: cycle.p_suction * (full / volume(room, phi)) ** cycle.n_c,
        lambda phi: cycle.p_delivery + 0 * phi,
    )
    return tuple(zip(at, [*at[1:], _TURN], laws, strict=True))


def compressor_pressure(cycle: CompressorCycle, room: Chamber) -> Pressure:
    """Pressure of a compressor's cylinder, by formulas in every phase."""
    phases = valves(cycle, room)
    drawn = (
        room.clearance + room.displacement - float(volume(room, phases["suction valve opens"]))
    ) / room.displacement
    return pressure_over(
        "compressor", lambda phi: absolute_pressure(cycle, room, np.remainder(phi, _TURN)), _TURN,
        tuple(sorted(phases.values())), room, phases=phases, formulas=formulas(cycle, room, list(phases.values())),
        facts=(f"of the swept volume {drawn:.3f} is drawn in each turn; the clearance takes the rest",),
    )  # fmt: skip


class CompressorGas(CylinderGas):
    """Gas of a compressor; its cycle does not know the speed."""

    def pressure(self, room: Chamber, omega: float) -> tuple[Pressure, dict[str, float]]:
        """Pressure at a speed [rad/s], and no fuel."""
        return compressor_pressure(self.cycle, room), {}

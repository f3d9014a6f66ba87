r"""Slopes of masses and energies of plenum, cylinder and manifold over the crank angle.

.. math:: m_i' = \sum \dot m/\omega, \qquad E_i' = \sum \dot m\,c_p T_{up}/\omega - p V_i' + Q_i', \qquad
          p_i = (\gamma - 1) E_i/V_i

The gas is ideal with constant heat capacities; burnt gas is told from fresh by its mass alone.
"""

import math
from collections.abc import Callable

import casadi as ca

from mechsym.cycle.breathing.flow import curtain_area, orifice_flow, valve_lift
from mechsym.cycle.breathing.records import PERIOD, Breathing, FreshCharge, HeatSink
from mechsym.cycle.chamber import piston_area
from mechsym.cycle.heat import Adiabatic, GasAtWall, heat_flux, motored_swirl
from mechsym.quantities import record
from mechsym.quantities.units import Scalar

VOLUMES = ("plenum", "cylinder", "manifold")
# mass [kg], internal energy [J] and burnt mass [kg] of each volume, then what has crossed the borders [kg, J]
STATES = (*(f"{q}_{v}" for v in VOLUMES for q in ("m", "E", "b")),
          "work", "pumping", "m_in", "b_in", "H_in", "m_out", "H_out", "heat", "wall_heat")  # fmt: skip
# speed [rad/s], fresh mass [kg] and state [Pa, K] when the inlet closes, state of the surroundings [Pa, K, Pa]
GIVEN = ("omega", "fresh", "p_closed", "T_closed", "p_in", "T_in", "p_out")
_MOTORED_EXPONENT = 1.35  # polytropic exponent of the motored cycle in Woschni's term


@record
class Cylinder:
    """A cylinder that breathes."""

    breathing: Breathing
    charge: FreshCharge
    volume: Callable[[Scalar], Scalar]  #: Crank angle, number or symbol [rad], to the volume of the cylinder [m^3]
    walls: HeatSink = HeatSink()

    # a cylinder is itself: its volume is a function
    __hash__ = object.__hash__


def rate(cylinder: Cylinder) -> ca.Function:
    """Slope of the states over s, which runs from 0 to 1 over a cycle that begins where the inlet closes."""
    s, y, z = ca.SX.sym("s"), ca.SX.sym("y", len(STATES)), ca.SX.sym("z", len(GIVEN))
    angle = ca.SX.sym("phi")
    slope = ca.Function("slope", [angle, y, z], [_slopes(cylinder, angle, y, dict(zip(GIVEN, ca.vertsplit(z),
                                                                                     strict=True)))])  # fmt: skip
    here = cylinder.breathing.inlet_closes + PERIOD * s
    return ca.Function("rate", [s, y, z], [slope(here, y, z) * PERIOD], list("syz"), ["ds"])


def _slopes(cylinder: Cylinder, phi: Scalar, y: Scalar, z: dict[str, ca.SX]) -> Scalar:
    b, c, room = cylinder.breathing, cylinder.charge, cylinder.volume(phi)
    cv, size = c.R / (c.gamma - 1), (b.plenum_volume, room, b.manifold_volume)
    inside = [((c.gamma - 1) * y[3 * i + 1] / size[i], y[3 * i + 1] / (y[3 * i] * cv)) for i in range(3)]
    flows, heats, shares = _exchanged(cylinder, phi, y, inside, z)
    release, work = z["fresh"] * _burning(c, phi), inside[1][0] * ca.jacobian(room, phi)
    lost = _to_walls(cylinder, phi, inside[1], room, z)
    rows = [[flows[i] - flows[i + 1], heats[i] - heats[i + 1], shares[i] - shares[i + 1]] for i in range(3)]
    rows[1][1] += c.heat * release - work - lost
    rows[1][2] += release
    # the two strokes about the dead centre of exchange
    exchange = ca.if_else(ca.fabs(phi - 6 * math.pi) < math.pi, work, 0.0)
    last = [work, exchange, flows[0], shares[0], heats[0], flows[3], heats[3], c.heat * release, lost]
    return ca.vertcat(*(value for row in rows for value in row), *last)


def _exchanged(
    cylinder: Cylinder, phi: Scalar, y: Scalar, inside: list[tuple[ca.SX, ca.SX]], z: dict[str, ca.SX]
) -> tuple[list[ca.SX], list[ca.SX], list[ca.SX]]:
    """Mass [kg/rad], energy [J/rad] and burnt mass [kg/rad] through the four throats, positive towards the exhaust."""
    c = cylinder.charge
    cp = c.gamma * c.R / (c.gamma - 1)
    burnt = [0.0, *(y[3 * i + 2] / y[3 * i] for i in range(3)), y[8] / y[6]]
    states = [(z["p_in"], z["T_in"]), *inside, (z["p_out"], z["T_in"])]
    flows, heats, shares = [], [], []
    for i, area in enumerate(_areas(cylinder.breathing, phi)):
        flow = orifice_flow(area, states[i], states[i + 1], c.gamma, c.R) / z["omega"]
        from_first = flow >= 0
        flows.append(flow)
        heats.append(flow * cp * ca.if_else(from_first, states[i][1], states[i + 1][1]))
        shares.append(flow * ca.if_else(from_first, burnt[i], burnt[i + 1]))
    return flows, heats, shares


def _to_walls(cylinder: Cylinder, phi: Scalar, inside: tuple[ca.SX, ca.SX], room: ca.SX, z: dict[str, ca.SX]) -> Scalar:
    """Heat from the gas to the walls [J/rad]; Woschni's term of combustion counts while the valves are closed."""
    walls, opens = cylinder.walls, cylinder.breathing.exhaust_opens
    if isinstance(walls.law, Adiabatic):
        return 0.0
    closed = cylinder.volume(cylinder.breathing.inlet_closes)
    scale = walls.displacement * z["T_closed"] / (z["p_closed"] * closed)
    motored = z["p_closed"] * (closed / room) ** _MOTORED_EXPONENT
    burning = ca.logic_and(phi > PERIOD + cylinder.charge.ignition, phi < PERIOD + opens)
    swirl = ca.if_else(burning, motored_swirl(walls.law, inside[0], motored, scale), 0.0)
    state = GasAtWall(
        p=inside[0], t=inside[1], v=room, gas_constant=cylinder.charge.R, bore=walls.bore,
        piston_speed=walls.stroke * z["omega"] / math.pi, swirl=swirl,
    )  # fmt: skip
    area = 2 * piston_area(walls.bore) + 4 * room / walls.bore  # `chamber.wall_area` without a chamber
    return heat_flux(walls.law, state) * area / z["omega"]


def _areas(b: Breathing, phi: Scalar) -> list[Scalar]:
    def valve(opens: float, closes: float, lift: float, diameter: float) -> Scalar:
        return b.valves * curtain_area(valve_lift(phi, opens, closes, lift), diameter, b.discharge)

    def throat(diameter: float) -> float:
        return b.discharge * math.pi / 4 * diameter**2

    return [
        throat(b.throttle_diameter),
        valve(b.inlet_opens, b.inlet_closes, b.inlet_lift, b.inlet_diameter),
        valve(b.exhaust_opens, b.exhaust_closes, b.exhaust_lift, b.exhaust_diameter),
        throat(b.tailpipe_diameter),
    ]


def _burning(c: FreshCharge, phi: Scalar) -> Scalar:
    # the turn begins where the inlet closes, so its firing dead centre is at 4 pi
    y = ca.fmin(ca.fmax((phi - PERIOD - c.ignition) / c.duration, 0.0), 1.0)
    slope = c.a * (c.m + 1) * y**c.m * ca.exp(-c.a * y ** (c.m + 1)) / c.duration
    inside = ca.logic_and(y > 0, y < 1)
    # the share that Wiebe's function leaves at its end burns along with the rest
    return ca.if_else(inside, slope / (1 - math.exp(-c.a)), 0.0)

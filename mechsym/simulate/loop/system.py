r"""Gas in every cylinder and motion of the shaft as one differential equation in time.

    cylinder k: T_k, work, heat  --F_k = (p_k - p_b) A-->  mechanism q, u  <--M-- load(u)
         ^                                                     |
         +------------- phi_k = q_i - firing_k ----------------+

A cylinder is in one of four phases: before, during, after combustion, and open (ideal gas exchange at intake
pressure). Phase, start and duration of combustion are held between events, so that each piece is smooth; they are
decided when the inlet closes, from the speed that the crank has just then.
"""

import dataclasses

import casadi as ca

from mechsym.cycle.chamber import Motion, travel
from mechsym.cycle.closed.equations import PHASES, pressure, rates
from mechsym.cycle.closed.model import ClosedEngine, closed_period
from mechsym.machine.loads import ConstantLoad, PropellerLoad, load_torque
from mechsym.mechanisms.record import Mechanism, acceleration_function
from mechsym.quantities import record
from mechsym.quantities.units import Scalar
from mechsym.simulate.equations import power

OPEN = len(PHASES)  # number of the fourth phase
PER_CYLINDER = ("t", "work", "wall_heat")
WORKS = ("work_gas", "work_load", "dissipation")  # the last entries of the state


@record
class LoopCylinder:
    """Where a cylinder sits on the mechanism."""

    input: str  #: The mechanism's input that its piston force acts on
    coordinate: str  #: Coordinate that is the angle of its crank
    firing: float  #: Value of that coordinate at the cylinder's firing top dead centre, within 4 pi [rad]
    area: float | None = None  #: Of the working face; None takes the area of the bore [m^2]
    motion: Motion | None = None  #: Of its piston, where that is not the engine's
    sense: float = 1.0  #: 1 where the input counts away from the head, -1 where it counts towards it [-]


@record
class Loop:
    """An engine whose cylinders act on a mechanism against a load."""

    engine: ClosedEngine
    mechanism: Mechanism
    cylinders: tuple[LoopCylinder, ...]
    load: ConstantLoad | PropellerLoad
    #: Input that takes the load torque, and the coordinate whose speed decides it
    load_input: str
    load_coordinate: str


def engine_at(loop: Loop, k: int) -> ClosedEngine:
    """The engine as a cylinder sees it: with the motion of its own piston."""
    motion = loop.cylinders[k].motion
    return loop.engine if motion is None else dataclasses.replace(loop.engine, motion=motion)


def right_side(loop: Loop) -> ca.Function:
    """The differential equation of a loop.

    Returns function: (y, held) -> dy/dt and the pressures of the cylinders [Pa]. y: coordinates, velocities, then for
    each cylinder temperature [K], work and heat to the walls since the inlet closed [J], then work of the pistons, of
    the load and what dampers take [J]. held, for each cylinder: phase, start [rad], duration [rad], and the angle of
    its last firing dead centre [rad].
    """
    q_names, n = loop.mechanism.coordinates, len(loop.mechanism.coordinates)
    count = len(loop.cylinders)
    y, held = ca.SX.sym("y", 2 * n + 3 * count + len(WORKS)), ca.SX.sym("held", 4 * count)
    q, u = y[:n], y[n : 2 * n]
    inputs: dict[str, ca.SX] = {name: ca.SX(0) for name in loop.mechanism.inputs}
    slopes, pressures, piston_power = [], [], 0
    for k, cylinder in enumerate(loop.cylinders):
        i = q_names.index(cylinder.coordinate)
        phi, t = q[i] - held[4 * k + 3], y[2 * n + 3 * k]
        p, per_angle = _gas(engine_at(loop, k), u[i], phi, t, held[4 * k : 4 * k + 3])
        slopes += [slope * u[i] for slope in per_angle]
        pressures.append(p)
        room = closed_period(engine_at(loop, k), {"omega": u[i]}).chamber
        force = (p - room.back_pressure) * (room.area if cylinder.area is None else cylinder.area)
        inputs[cylinder.input] += cylinder.sense * force
        piston_power += force * travel(room.motion, phi)[1] * u[i]
    braking = load_torque(loop.load, u[q_names.index(loop.load_coordinate)])
    inputs[loop.load_input] += braking
    speeds, loss = power(loop.mechanism, ca.vertsplit(q), ca.vertsplit(u))
    arguments = [*ca.vertsplit(q), *ca.vertsplit(u), *(inputs[name] for name in loop.mechanism.inputs)]
    acceleration = acceleration_function(loop.mechanism).call(arguments)[0]
    rate = ca.vertcat(u, acceleration, *slopes, piston_power, braking * speeds[loop.load_input], loss)
    return ca.Function("loop", [y, held], [rate, ca.vertcat(*pressures)])


def _gas(engine: ClosedEngine, omega: Scalar, phi: Scalar, t: Scalar, held: ca.SX) -> tuple[Scalar, tuple[Scalar, ...]]:
    closed = closed_period(engine, {"omega": omega})
    closed = dataclasses.replace(closed, starts=held[1], duration=held[2])
    p: Scalar = engine.cycle.intake_pressure
    slopes: tuple[Scalar, ...] = (0.0, 0.0, 0.0)
    for number, phase in enumerate(PHASES):
        here = held[0] == number
        p = ca.if_else(here, pressure(closed, phase, phi, t), p)
        there = rates(closed, phase, phi, t)
        slopes = tuple(ca.if_else(here, a, b) for a, b in zip(there, slopes, strict=True))
    return p, slopes

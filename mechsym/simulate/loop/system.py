r"""Gas in every cylinder and motion of the shaft as one differential equation in time.

    cylinder k: T_k, work, heat  --F_k = (p_k - p_b) A-->  mechanism q, u  <--M-- load(u)
         ^                                                     |
         +------------- phi_k = q_i - firing_k ----------------+

A cylinder is in one of four phases: before, during, after combustion, and open (ideal gas exchange at intake
pressure). Phase, start and duration of combustion are held between events, so that each piece is smooth; they are
decided when the inlet closes, from the speed that the crank has just then.
"""

import dataclasses
from collections.abc import Mapping
from typing import NamedTuple

import casadi as ca

from mechsym.cycle.chamber import Motion, travel
from mechsym.cycle.closed.equations import PHASES, pressure, rates
from mechsym.cycle.closed.model import ClosedEngine, closed_period
from mechsym.cycle.knock import end_gas_temperature, ignition_delay
from mechsym.machine.loads import ConstantLoad, PropellerLoad, load_torque
from mechsym.mechanisms.record import Mechanism, acceleration_function, velocities
from mechsym.quantities import record
from mechsym.quantities.units import Scalar
from mechsym.simulate.equations import System, power

OPEN = len(PHASES)  # number of the fourth phase
PER_CYLINDER = ("t", "work", "wall_heat", "knock")
HELD = ("phase", "start", "duration", "dead_centre", "p_0", "T_0", "kappa")
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


@record
class LoopEquations:
    """The differential equation of a loop, and what of its state is of interest beside the state itself."""

    #: y: coordinates, velocities, `PER_CYLINDER` of each cylinder (temperature [K], then since the inlet closed work
    #: and heat to the walls [J], and Livengood and Wu's integral [-]), then work of the pistons, of the load and what
    #: dampers take [J]; w: `HELD` of each cylinder (phase, start and duration of combustion and the angle of its last
    #: firing dead centre [rad], state of the gas when combustion started [Pa], [K], [-])
    system: System
    pressures: ca.Function  #: (y, w) to the pressures of the cylinders [Pa]

    def first_of(self, k: int) -> int:
        """Where the entries of a cylinder, number from 0, begin in the state."""
        return 2 * self.system.size + len(PER_CYLINDER) * k


def equations(loop: Loop) -> LoopEquations:
    """The differential equation of a loop in time."""
    q_names, n = loop.mechanism.coordinates, len(loop.mechanism.coordinates)
    own = tuple(f"{name}_{k}" for k in range(1, len(loop.cylinders) + 1) for name in PER_CYLINDER)
    columns = (*q_names, *velocities(loop.mechanism), *own, *WORKS)
    time, y, w = ca.SX.sym("t"), ca.SX.sym("y", len(columns)), ca.SX.sym("w", len(HELD) * len(loop.cylinders))
    q, u = y[:n], y[n : 2 * n]
    inputs: dict[str, ca.SX] = {name: ca.SX(0) for name in loop.mechanism.inputs}
    slopes, pressures, piston_power = [], [], 0
    for k, cylinder in enumerate(loop.cylinders):
        i = q_names.index(cylinder.coordinate)
        held = dict(zip(HELD, ca.vertsplit(w[len(HELD) * k : len(HELD) * (k + 1)]), strict=True))
        phi, t = q[i] - held["dead_centre"], y[2 * n + len(PER_CYLINDER) * k]
        gas = _gas(engine_at(loop, k), u[i], phi, t, held)
        slopes += [*(slope * u[i] for slope in gas.per_angle), gas.knocking]
        pressures.append(gas.p)
        room = closed_period(engine_at(loop, k), {"omega": u[i]}).chamber
        force = (gas.p - room.back_pressure) * (room.area if cylinder.area is None else cylinder.area)
        inputs[cylinder.input] += cylinder.sense * force
        piston_power += force * travel(room.motion, phi)[1] * u[i]
    braking = load_torque(loop.load, u[q_names.index(loop.load_coordinate)])
    inputs[loop.load_input] += braking
    speeds, loss = power(loop.mechanism, ca.vertsplit(q), ca.vertsplit(u))
    arguments = [*ca.vertsplit(q), *ca.vertsplit(u), *(inputs[name] for name in loop.mechanism.inputs)]
    acceleration = acceleration_function(loop.mechanism).call(arguments)[0]
    rate = ca.vertcat(u, acceleration, *slopes, piston_power, braking * speeds[loop.load_input], loss)
    per_cylinder = ("K", "J", "J", "-") * len(loop.cylinders)
    system = System(
        function=ca.Function("loop", [time, y, w], [rate], ["t", "y", "w"], ["ydot"]),
        columns=columns,
        units=(*loop.mechanism.state_units, *per_cylinder, *("J",) * len(WORKS)),
        values=(),
        size=n,
        audited=True,
    )
    return LoopEquations(system=system, pressures=ca.Function("pressures", [y, w], [ca.vertcat(*pressures)]))


class _Gas(NamedTuple):
    p: Scalar  #: Absolute pressure [Pa]
    per_angle: tuple[Scalar, ...]  #: Slopes of temperature [K/rad], work and heat to the walls [J/rad]
    knocking: Scalar  #: Rate of Livengood and Wu's integral [1/s]


def _gas(engine: ClosedEngine, omega: Scalar, phi: Scalar, t: Scalar, held: Mapping[str, Scalar]) -> _Gas:
    closed = closed_period(engine, {"omega": omega})
    closed = dataclasses.replace(closed, starts=held["start"], duration=held["duration"])
    p: Scalar = engine.cycle.intake_pressure
    slopes: tuple[Scalar, ...] = (0.0, 0.0, 0.0)
    for number, phase in enumerate(PHASES):
        here = held["phase"] == number
        p = ca.if_else(here, pressure(closed, phase, phi, t), p)
        there = rates(closed, phase, phi, t)
        slopes = tuple(ca.if_else(here, a, b) for a, b in zip(there, slopes, strict=True))
    # until the flame comes the end gas is all gas, then what the flame compresses
    unburnt = ca.if_else(held["phase"] == 0, t, end_gas_temperature(p, held["p_0"], held["T_0"], held["kappa"]))
    waits = held["phase"] <= PHASES.index("during")
    return _Gas(p, slopes, ca.if_else(waits, 1 / ignition_delay(p, unburnt, engine.cycle.octane), 0.0))

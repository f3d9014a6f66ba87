"""A machine set up once, run over time or over the angle.

    machine.Machine (mechanism, gas, forces over the angle, load law)
        -> reduced(machine)   angle domain: steady motion, ripple, flywheels (angle.py, steady.py)
        -> problem(machine)   time domain: adaptive run with energy audit and events (run.py)

This is where torques computed elsewhere come in: a hinge is one `AngleForce` on the input M_h.
"""

from collections.abc import Callable

import numpy as np

from mechsym.errors import BadInput
from mechsym.machine.loads import Load, PropellerLoad, TableLoad, load_torque, propeller_torque, reference
from mechsym.machine.record import AngleForce, Machine, acting, kinks_of, period_of
from mechsym.mechanisms.record import evaluate, velocities
from mechsym.mechanisms.shaft import is_damped
from mechsym.quantities import record
from mechsym.quantities.units import Pure, Radian, RadPerSecond, Scalar
from mechsym.simulate.angle import ReducedMachine
from mechsym.simulate.problem import FormulaForce, Kinks, Part, Periodic, Problem, Stop


def reduced(machine: Machine) -> ReducedMachine:
    """The machine over the angle of its crank."""
    (q,) = machine.mechanism.coordinates
    if is_damped(machine.mechanism):
        raise BadInput(f"{machine.mechanism.name} has dampers; its torque is no function of the angle alone")

    def inertia(phi: np.ndarray) -> np.ndarray:
        return evaluate(machine.mechanism, "dynamics", **{q: phi})["mass_matrix"]

    def torque(phi: np.ndarray) -> np.ndarray:
        inputs: dict[str, np.ndarray] = {}
        for force in acting(machine):
            inputs[force.input] = inputs.get(force.input, np.zeros(len(phi))) + force.value(phi)
        return evaluate(machine.mechanism, "dynamics", **{q: phi}, **inputs)["generalized_force"]

    return ReducedMachine(
        inertia=inertia, torque=torque, load=machine.load, period=period_of(machine), kinks=kinks_of(machine)
    )


def problem(machine: Machine, speed: RadPerSecond, turns: Pure, phi_start: Radian = 0.0, points: int = 360) -> Problem:
    """The machine over time, started at a speed; it ends after some turns or when the shaft stops.

    speed: speed at the start; turns: turns to run; points: results per turn at the starting speed. Returns problem: to
    be handed to `simulate`; its event is `stall`.
    """
    turn_time = 2 * np.pi / speed
    parts = [Part(name=f.name, input=f.input, role=f.role, value=at_angle(machine, f)) for f in acting(machine)]
    angles = kinks_of(machine)
    kinks = (Kinks(coordinate=machine.mechanism.coordinates[0], angles=angles, period=period_of(machine)),)
    return Problem(
        mechanism=machine.mechanism,
        parts=(*parts, Part(name="load", input=machine.load_input, role="load", value=load_value(machine.load))),
        q0=(phi_start,),
        u0=(speed,),
        # a shaft so slow that it takes ten times as long has stopped for every purpose
        t_end=10 * turns * turn_time,
        turns=turns,
        kinks=kinks if angles else (),
        stops=(Stop(name="stall", of=velocities(machine.mechanism)[0], direction="falling"),),
        output=turn_time / points,
    )


def at_angle(machine: Machine, force: AngleForce) -> Periodic:
    """A force over the angle as the value of a part."""
    return Periodic(
        coordinate=machine.mechanism.coordinates[0],
        value=force.value,
        period=period_of(machine),
        kinks=kinks_of(machine),
        point=force.point,
    )


@record
class _Propeller:
    """The formula of a propeller on the speed of a coordinate."""

    index: int

    def __call__(self, t: Scalar, q: Scalar, u: Scalar, torque: Scalar, speed: Scalar) -> Scalar:
        return propeller_torque(u[self.index], torque, speed)


def _constant(t: Scalar, q: Scalar, u: Scalar, torque: Scalar) -> Scalar:
    return torque


def load_value(load: Load, index: int = 0) -> FormulaForce | Callable[[float, list[float], list[float]], float]:
    """A load law as the value of a part.

    index: coordinate whose speed it follows; -1 for the last. Returns value: a formula where the law has one; a table
    is a plain callable.
    """
    match load:
        case TableLoad():
            return lambda t, q, u: float(load_torque(load, u[index]))
        case PropellerLoad():
            return FormulaForce(function=_Propeller(index=index), numbers=reference(load))
    return FormulaForce(function=_constant, numbers=(load_torque(load, 0.0),))

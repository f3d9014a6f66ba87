"""An engine with one coordinate, set up once, run over time or over the angle.

    mechanism + forces over the crank angle (gas, hinge) + load law
        -> machine(engine)   angle domain: steady motion, ripple, flywheels (machine.py, steady.py)
        -> problem(engine)   time domain: adaptive run with energy audit and events (run.py)

This is where torques computed elsewhere come in: a hinge is one `AngleForce` on the input M_h.
"""

from collections.abc import Callable

import casadi as ca
import numpy as np

from mechsym.errors import BadInput
from mechsym.machine.loads import Load, TableLoad, load_torque
from mechsym.mechanisms.record import Mechanism, velocities
from mechsym.quantities import choice, quantity, record
from mechsym.simulate.angle import Machine
from mechsym.simulate.problem import Formula, Kinks, Part, Periodic, Problem, Stop


@record
class AngleForce:
    """A force or torque that depends on the crank angle only."""

    name: str
    input: str  #: The mechanism's input it acts on
    #: `drive` counts as work in, `store` (a spring) does not
    role: str = choice("drive", "store", default="drive", about="side of the energy balance")
    value: Callable[[np.ndarray], np.ndarray]  #: phi, ndarray (n,), to values (n,) in the unit of the input
    #: The same for one float, where there is a fast way; without it a polynomial is fitted to round-off
    point: Callable[[float], float] | None = None


@record
class Engine:
    """Mechanism, forces and load of an engine with one coordinate."""

    mechanism: Mechanism  #: One coordinate, no dampers; a flywheel belongs into its parameters
    forces: tuple[AngleForce, ...]
    load: Load
    load_input: str = "M_r"  #: Input that takes the load torque, positive against the motion
    period: float = quantity("rad", default=2 * np.pi, above=0, about="period of the forces")
    kinks: tuple[float, ...] = ()  #: Where a force is not smooth, in [0, period) [rad]

    def __post_init__(self) -> None:
        if len(self.mechanism.coordinates) != 1:
            raise BadInput(
                f"{self.mechanism.name} has {len(self.mechanism.coordinates)} coordinates; an engine has one"
            )
        for name in (self.load_input, *(f.input for f in self.forces)):
            if name not in self.mechanism.inputs:
                known = ", ".join(self.mechanism.inputs)
                raise BadInput(f"{self.mechanism.name} has no input {name!r}; its inputs are {known}")


def machine(engine: Engine) -> Machine:
    """The engine over the angle."""
    dynamics = engine.mechanism.functions["dynamics"]
    if _depends_on_speed(engine.mechanism):
        raise BadInput(f"{engine.mechanism.name} has dampers; its torque is no function of the angle alone")

    def inertia(phi: np.ndarray) -> np.ndarray:
        return _over(dynamics, phi, {})[0]

    def torque(phi: np.ndarray) -> np.ndarray:
        inputs: dict[str, np.ndarray] = {}
        for force in engine.forces:
            inputs[force.input] = inputs.get(force.input, np.zeros(len(phi))) + force.value(phi)
        return _over(dynamics, phi, inputs)[2]

    return Machine(inertia=inertia, torque=torque, load=engine.load, period=engine.period, kinks=engine.kinks)


def _depends_on_speed(mechanism: Mechanism) -> bool:
    dynamics = mechanism.functions["dynamics"]
    symbols = [ca.SX.sym(dynamics.name_in(i)) for i in range(dynamics.n_in())]
    return bool(ca.depends_on(dynamics(*symbols)[2], symbols[1]))


def _over(dynamics: ca.Function, phi: np.ndarray, inputs: dict[str, np.ndarray]) -> list[np.ndarray]:
    rows = [phi[None, :], np.zeros((1, len(phi)))]
    rows += [
        np.reshape(inputs.get(dynamics.name_in(i), np.zeros(len(phi))), (1, -1)) for i in range(2, dynamics.n_in())
    ]
    return [np.broadcast_to(np.asarray(v).ravel(), phi.shape) for v in dynamics(*rows)]


def problem(engine: Engine, speed: float, turns: float, phi_start: float = 0.0, points: int = 360) -> Problem:
    """The engine over time, started at a speed; it ends after some turns or when the shaft stops.

    Parameters
    ----------
    speed : float
        Speed at the start [rad/s]
    turns : float
        Turns to run [-]
    phi_start : float
        Crank angle at the start [rad]
    points : int
        Results per turn at the starting speed

    Returns
    -------
    problem : Problem
        To be handed to `simulate`; its event is `stall`
    """
    turn_time = 2 * np.pi / speed
    parts = [Part(name=f.name, input=f.input, role=f.role, value=_at_angle(engine, f)) for f in engine.forces]
    kinks = (Kinks(coordinate=engine.mechanism.coordinates[0], angles=engine.kinks, period=engine.period),)
    return Problem(
        mechanism=engine.mechanism,
        parts=(*parts, Part(name="load", input=engine.load_input, role="load", value=load_value(engine.load))),
        q0=(phi_start,),
        u0=(speed,),
        # a shaft so slow that it takes ten times as long has stopped for every purpose
        t_end=10 * turns * turn_time,
        turns=turns,
        kinks=kinks if engine.kinks else (),
        stops=(Stop(name="stall", of=velocities(engine.mechanism)[0], direction="falling"),),
        output=turn_time / points,
    )


def _at_angle(engine: Engine, force: AngleForce) -> Periodic:
    return Periodic(
        coordinate=engine.mechanism.coordinates[0],
        value=force.value,
        period=engine.period,
        kinks=engine.kinks,
        point=force.point,
    )


def load_value(load: Load, index: int = 0) -> Formula | Callable[[float, list[float], list[float]], float]:
    """A load law as the value of a part.

    Parameters
    ----------
    index : int
        Coordinate whose speed it follows; -1 for the last

    Returns
    -------
    value : Formula or callable
        A formula where the law has one; a table is a plain callable
    """
    if isinstance(load, TableLoad):
        return lambda t, q, u: float(load_torque(load, u[index]))
    return Formula(function=lambda t, q, u: load_torque(load, u[index]))

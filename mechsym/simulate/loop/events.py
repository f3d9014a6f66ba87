"""What happens to a cylinder of a loop at its events: inlet closes, ignition, end of combustion, exhaust opens."""

import dataclasses
from functools import partial

import casadi as ca
import numpy as np

from mechsym.cycle.closed.equations import SCALARS, scalars
from mechsym.cycle.closed.model import closed_period
from mechsym.cycle.closed.run import dense, run
from mechsym.cycle.kinds.spark_ignition import timing
from mechsym.quantities import record
from mechsym.simulate.loop.system import OPEN, PER_CYLINDER, WORKS, Loop, engine_at

CYCLE = 4 * np.pi


@record
class CylinderCycle:
    """One closed period of one cylinder."""

    cylinder: int
    time: float  #: When the exhaust opened [s]
    speed: float  #: Crank speed when the inlet closed [rad/s]
    #: Of the gas over the closed period, and lost to the walls [J]
    work: float
    wall_heat: float
    residual: float  #: First law over the closed period, by the heat released [-]
    knock: float = 0.0  #: Livengood and Wu's integral, 1 where the end gas ignites by itself [-]


@record
class GasState:
    """Where one cylinder is in its cycle."""

    phase: int  #: 0 before, 1 during, 2 after combustion, 3 open
    #: Of combustion, decided when the inlet closed [rad]
    start: float
    duration: float
    #: Angle of its crank at the firing dead centre that its angles count from; of an open cylinder the next one [rad]
    dead_centre: float
    speed: float  #: Of its crank when the inlet closed [rad/s]
    whole: bool  #: Whether the run has seen the inlet close


def first_state(loop: Loop, omega: float, angle: float = 0.0) -> tuple[list[GasState], np.ndarray]:
    """Cylinders as they stand at an angle in steady running, and the state of the equations.

    Parameters
    ----------
    omega : float
        Speed of every coordinate [rad/s]
    angle : float
        Value of every coordinate [rad]

    Returns
    -------
    y : ndarray, shape (n,)
        State, see `right_side`, in its mixed units [-]
    """
    start, duration = (float(a) for a in timing(loop.engine.cycle, omega))
    gases, temperatures = [], []
    for k, cylinder in enumerate(loop.cylinders):
        if k == 0 or cylinder.motion is not None:
            angles, _, steady = dense(run(partial(closed_period, engine_at(loop, k)), {"omega": omega}), parts=32)
        phi = (angle - cylinder.firing + CYCLE / 2) % CYCLE - CYCLE / 2
        ends = (loop.engine.cycle.inlet_closes, start, start + duration, loop.engine.cycle.exhaust_opens)
        passed = int(np.searchsorted(ends, phi, side="right"))  # 0: before the inlet closes, 4: the exhaust is open
        gases.append(
            GasState(
                phase=(passed - 1) % (OPEN + 1),
                start=start,
                duration=duration,
                speed=omega,
                whole=False,
                dead_centre=angle - phi + (CYCLE if passed > OPEN else 0.0),
            )  # fmt: skip
        )
        temperatures.append(float(np.interp(phi, angles[0], steady[0])))
    n = len(loop.mechanism.coordinates)
    cylinders = [value for t in temperatures for value in (t, 0.0, 0.0)]
    return gases, np.array([*[angle] * n, *[omega] * n, *cylinders, *[0.0] * len(WORKS)])


def gap(loop: Loop, gas: GasState, k: int, y: np.ndarray) -> float:
    """How far a cylinder is past its next event.

    Parameters
    ----------
    k : int
        Number of the cylinder, from 0
    y : ndarray, shape (n,)
        State, in its mixed units [-]

    Returns
    -------
    gap : float
        Negative before the event [rad]
    """
    cycle = loop.engine.cycle
    targets = (gas.start, gas.start + gas.duration, cycle.exhaust_opens, cycle.inlet_closes)
    return float(y[_angle(loop, k)]) - gas.dead_centre - targets[gas.phase]


def ledger(loop: Loop) -> list[ca.Function]:
    """Energies of a closed period, for its audit.

    Returns
    -------
    functions : list of casadi.Function
        Of each cylinder (speed when the inlet closed [rad/s], temperature when the exhaust opens [K]) -> the entries of
        `closed.SCALARS`
    """
    omega, t = ca.SX.sym("omega"), ca.SX.sym("t")
    found = []
    for k, cylinder in enumerate(loop.cylinders):
        if k == 0 or cylinder.motion is not None:
            values = scalars(closed_period(engine_at(loop, k), {"omega": omega}), t)
            book = ca.Function("ledger", [omega, t], [ca.vertcat(*values)])
        found.append(book)
    return found


def pass_event(
    loop: Loop, books: list[ca.Function], gas: GasState, k: int, now: tuple[float, np.ndarray]
) -> tuple[GasState, np.ndarray, CylinderCycle | None]:
    """Bring a cylinder into its next phase.

    Parameters
    ----------
    k : int
        Number of the cylinder, from 0
    now : tuple
        Time [s] and state

    Returns
    -------
    y : ndarray, shape (n,)
        State; a cylinder whose inlet closes starts afresh, in its mixed units [-]
    cycle : CylinderCycle or None
        The closed period that has ended
    """
    t, y = now
    if gas.phase < OPEN - 1:
        return dataclasses.replace(gas, phase=gas.phase + 1), y, None
    own = 2 * len(loop.mechanism.coordinates) + len(PER_CYLINDER) * k
    if gas.phase == OPEN:
        speed = float(y[_angle(loop, k) + len(loop.mechanism.coordinates)])
        start, duration = (float(a) for a in timing(loop.engine.cycle, speed))
        y = y.copy()
        y[own : own + len(PER_CYLINDER)] = loop.engine.cycle.intake_temperature, 0.0, 0.0
        centre = gas.dead_centre
        return GasState(phase=0, start=start, duration=duration, dead_centre=centre, speed=speed, whole=True), y, None
    then = dataclasses.replace(gas, phase=OPEN, dead_centre=gas.dead_centre + CYCLE)
    return then, y, _closed(books[k], gas, k, t, y[own : own + len(PER_CYLINDER)]) if gas.whole else None


def _closed(books: ca.Function, gas: GasState, k: int, t: float, own: np.ndarray) -> CylinderCycle:
    temperature, work, wall_heat = (float(v) for v in own)
    found = dict(zip(SCALARS, np.asarray(books(gas.speed, temperature)).ravel(), strict=True))
    gain = found["energy_end"] - found["energy_start"] + work + wall_heat
    residual = (gain - found["heat_released"] - found["fuel_energy"]) / found["heat_released"]
    return CylinderCycle(
        cylinder=k, time=t, speed=gas.speed, work=work + float(found["exchange_work"]), wall_heat=wall_heat,
        residual=float(residual),
    )  # fmt: skip


def _angle(loop: Loop, k: int) -> int:
    return loop.mechanism.coordinates.index(loop.cylinders[k].coordinate)

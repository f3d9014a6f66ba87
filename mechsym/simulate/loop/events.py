"""What happens to a cylinder of a loop at its events: inlet closes, ignition, end of combustion, exhaust opens."""

import dataclasses
from functools import partial

import casadi as ca
import numpy as np

from mechsym.cycle.closed.equations import SCALARS, scalars
from mechsym.cycle.closed.model import closed_period
from mechsym.cycle.closed.run import dense, run
from mechsym.cycle.kinds.spark_ignition import timing
from mechsym.cycle.knock import kappa
from mechsym.native.runs import Level
from mechsym.quantities import record
from mechsym.quantities.units import Array, Kelvin, Pascal, Pure, Radian, RadPerSecond, Second
from mechsym.simulate.loop.system import OPEN, PER_CYLINDER, WORKS, Loop, LoopEquations, engine_at

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
    knock: float  #: Livengood and Wu's integral, 1 where the end gas ignites by itself [-]


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
    #: When combustion started, absolute [Pa], [K]
    p_0: Pascal = 1.0
    T_0: Kelvin = 1.0
    kappa: Pure = 0.0  #: Gas constant by heat capacity of the unburnt gas then [-]

    @property
    def held(self) -> list[float]:
        """In the order and the mixed units of `HELD` [-]."""
        return [self.phase, self.start, self.duration, self.dead_centre, self.p_0, self.T_0, self.kappa]


def first_state(loop: Loop, omega: RadPerSecond, angle: Radian = 0.0) -> tuple[list[GasState], np.ndarray]:
    """Cylinders as they stand at an angle in steady running, and the state of the equations.

    omega: speed of every coordinate; angle: value of every coordinate. Returns y: state, see `LoopEquations`, in its
    mixed units [-].
    """
    start, duration = (float(a) for a in timing(loop.engine.cycle, omega))
    gases, temperatures = [], []
    for k, cylinder in enumerate(loop.cylinders):
        if k == 0 or cylinder.motion is not None:
            angles, _, steady = dense(run(partial(closed_period, engine_at(loop, k)), {"omega": omega}), parts=32)
        phi = (angle - cylinder.firing + CYCLE / 2) % CYCLE - CYCLE / 2
        ends = (loop.engine.cycle.inlet_closes, start, start + duration, loop.engine.cycle.exhaust_opens)
        passed = int(np.searchsorted(ends, phi, side="right"))  # 0: before the inlet closes, 4: the exhaust is open
        centre = angle - phi + (CYCLE if passed > OPEN else 0.0)
        phase = (passed - 1) % (OPEN + 1)
        gases.append(
            GasState(phase=phase, start=start, duration=duration, dead_centre=centre, speed=omega, whole=False)
        )
        temperatures.append(float(np.interp(phi, angles[0], steady[0])))
    n = len(loop.mechanism.coordinates)
    cylinders = [value for t in temperatures for value in (t, 0.0, 0.0, 0.0)]
    return gases, np.array([*[angle] * n, *[omega] * n, *cylinders, *[0.0] * len(WORKS)])


def ahead(loop: Loop, gas: GasState, k: int) -> Level:
    """The crank angle at which the next event of cylinder k, from 0, comes."""
    cycle = loop.engine.cycle
    targets = (gas.start, gas.start + gas.duration, cycle.exhaust_opens, cycle.inlet_closes)
    return Level(state=_angle(loop, k), level=gas.dead_centre + targets[gas.phase], direction=1)


def ledger(loop: Loop) -> list[ca.Function]:
    """Energies of a closed period, for its audit.

    Returns functions: of each cylinder (speed when the inlet closed [rad/s], temperature when the exhaust opens [K]) ->
    the entries of `closed.SCALARS`.
    """
    omega, t = ca.SX.sym("omega"), ca.SX.sym("t")
    books = []
    for k, cylinder in enumerate(loop.cylinders):
        if k == 0 or cylinder.motion is not None:
            values = scalars(closed_period(engine_at(loop, k), {"omega": omega}), t)
            book = ca.Function("ledger", [omega, t], [ca.vertcat(*values)])
        books.append(book)
    return books


def pass_event(
    loop: Loop,
    model: LoopEquations,
    books: list[ca.Function],
    gas: GasState,
    k: int,
    now: tuple[Second, Pure[Array], Pascal],
) -> tuple[GasState, np.ndarray, CylinderCycle | None]:
    """Bring a cylinder into its next phase.

    k: number of the cylinder, from 0; now: time, state and pressure of the cylinder. Returns y: state; a cylinder whose
    inlet closes starts afresh, in its mixed units [-]. cycle: the closed period that has ended.
    """
    t, y, p = now
    own = model.first_of(k)
    if gas.phase == 0:
        T = float(y[own])
        slope = float(kappa(loop.engine.gas, T))
        return dataclasses.replace(gas, phase=1, p_0=p, T_0=T, kappa=slope), y, None
    if gas.phase < OPEN - 1:
        return dataclasses.replace(gas, phase=gas.phase + 1), y, None
    if gas.phase == OPEN:
        speed = float(y[_angle(loop, k) + model.system.size])
        start, duration = (float(a) for a in timing(loop.engine.cycle, speed))
        y = y.copy()
        y[own : own + len(PER_CYLINDER)] = loop.engine.cycle.intake_temperature, 0.0, 0.0, 0.0
        centre = gas.dead_centre
        return GasState(phase=0, start=start, duration=duration, dead_centre=centre, speed=speed, whole=True), y, None
    then = dataclasses.replace(gas, phase=OPEN, dead_centre=gas.dead_centre + CYCLE)
    if not gas.whole:
        return then, y, None
    temperature, work, wall_heat, knock = (float(v) for v in y[own : own + len(PER_CYLINDER)])
    book = dict(zip(SCALARS, np.asarray(books[k](gas.speed, temperature)).ravel(), strict=True))
    gain = book["energy_end"] - book["energy_start"] + work + wall_heat
    residual = float((gain - book["heat_released"] - book["fuel_energy"]) / book["heat_released"])
    cycle = CylinderCycle(
        cylinder=k, time=t, speed=gas.speed, work=work + float(book["exchange_work"]), wall_heat=wall_heat,
        residual=residual, knock=knock,
    )  # fmt: skip
    return then, y, cycle


def _angle(loop: Loop, k: int) -> int:
    return loop.mechanism.coordinates.index(loop.cylinders[k].coordinate)

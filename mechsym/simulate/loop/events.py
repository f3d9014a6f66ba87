"""What happens to a cylinder of a loop at its events: inlet closes, ignition, end of combustion, exhaust opens.

Between them the end gas waits for the flame: `EndGas` keeps Livengood and Wu's integral of each cylinder.
"""

import dataclasses
from functools import partial
from typing import Any

import casadi as ca
import numpy as np

from mechsym.cycle.closed.equations import SCALARS, scalars
from mechsym.cycle.closed.model import closed_period
from mechsym.cycle.closed.run import dense, run
from mechsym.cycle.kinds.spark_ignition import timing
from mechsym.cycle.knock import end_gas_temperature, ignition_delay, kappa
from mechsym.quantities import record
from mechsym.quantities.units import Array, Pascal, Pure, Radian, RadPerSecond, Second
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


def first_state(loop: Loop, omega: RadPerSecond, angle: Radian = 0.0) -> tuple[list[GasState], np.ndarray]:
    """Cylinders as they stand at an angle in steady running, and the state of the equations.

    omega: speed of every coordinate; angle: value of every coordinate. Returns y: state, see `right_side`, in its mixed
    units [-].
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
    cylinders = [value for t in temperatures for value in (t, 0.0, 0.0)]
    return gases, np.array([*[angle] * n, *[omega] * n, *cylinders, *[0.0] * len(WORKS)])


def gap(loop: Loop, gas: GasState, k: int, y: Pure[Array]) -> Radian:
    """How far cylinder k, from 0, is past its next event; negative before it. y: state, in its mixed units."""
    cycle = loop.engine.cycle
    targets = (gas.start, gas.start + gas.duration, cycle.exhaust_opens, cycle.inlet_closes)
    return float(y[_angle(loop, k)]) - gas.dead_centre - targets[gas.phase]


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
    loop: Loop, books: list[ca.Function], gas: GasState, k: int, now: tuple[Second, Second[Array]]
) -> tuple[GasState, np.ndarray, CylinderCycle | None]:
    """Bring a cylinder into its next phase.

    k: number of the cylinder, from 0; now: time and state. Returns y: state; a cylinder whose inlet closes starts
    afresh, in its mixed units [-]. cycle: the closed period that has ended.
    """
    t, y = now
    if gas.phase < OPEN - 1:
        return dataclasses.replace(gas, phase=gas.phase + 1), y, None
    own = first_of(loop, k)
    if gas.phase == OPEN:
        speed = float(y[_angle(loop, k) + len(loop.mechanism.coordinates)])
        start, duration = (float(a) for a in timing(loop.engine.cycle, speed))
        y = y.copy()
        y[own : own + len(PER_CYLINDER)] = loop.engine.cycle.intake_temperature, 0.0, 0.0
        centre = gas.dead_centre
        return GasState(phase=0, start=start, duration=duration, dead_centre=centre, speed=speed, whole=True), y, None
    then = dataclasses.replace(gas, phase=OPEN, dead_centre=gas.dead_centre + CYCLE)
    if not gas.whole:
        return then, y, None
    temperature, work, wall_heat = (float(v) for v in y[own : own + len(PER_CYLINDER)])
    book = dict(zip(SCALARS, np.asarray(books[k](gas.speed, temperature)).ravel(), strict=True))
    gain = book["energy_end"] - book["energy_start"] + work + wall_heat
    residual = float((gain - book["heat_released"] - book["fuel_energy"]) / book["heat_released"])
    work += float(book["exchange_work"])
    return (
        then,
        y,
        CylinderCycle(cylinder=k, time=t, speed=gas.speed, work=work, wall_heat=wall_heat, residual=residual),
    )


def _angle(loop: Loop, k: int) -> int:
    return loop.mechanism.coordinates.index(loop.cylinders[k].coordinate)


def first_of(loop: Loop, k: int) -> int:
    """Where the entries of a cylinder, number from 0, begin in the state."""
    return 2 * len(loop.mechanism.coordinates) + len(PER_CYLINDER) * k


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_BURNING = 1  # phase


class EndGas:
    """The integrals of all cylinders: `share` is 1 where the end gas ignites by itself [-]."""

    def __init__(self, loop: Loop) -> None:
        self.loop = loop
        self.share = [0.0] * len(loop.cylinders)
        self._start = [(1.0, 1.0, 0.0)] * len(loop.cylinders)  # p [Pa], T [K] and R/cp [-] when combustion starts

    def follow(self, piece: Any, function: ca.Function, held: Radian[Array], gases: list[GasState]) -> None:
        """Add what a smooth piece of the run brings to the cylinders that are closed and not burnt out.

        held: as for `right_side`, shape (4 * cylinders,).
        """
        waiting = [k for k, gas in enumerate(gases) if gas.whole and gas.phase <= _BURNING]
        if not waiting:
            return
        edges = piece.t
        half = np.diff(edges) / 2
        times = ((edges[:-1] + half)[:, None] + half[:, None] * _NODES).ravel()
        states = piece.sol(times)
        p = np.asarray(function.map(len(times))(states, np.repeat(held[:, None], len(times), axis=1))[1])
        weights = (half[:, None] * _WEIGHTS).ravel()
        for k in waiting:
            p_0, T_0, slope = self._start[k]
            T = (
                states[first_of(self.loop, k)]
                if gases[k].phase < _BURNING
                else end_gas_temperature(p[k], p_0, T_0, slope)
            )
            self.share[k] += float(np.sum(weights / ignition_delay(p[k], T, self.loop.engine.cycle.octane)))

    def event(self, k: int, was: GasState, now: GasState, y: Pure[Array], p: Pascal) -> None:
        """What the integral of a cylinder starts from in its next phase.

        k: number of the cylinder, from 0; y: state, in its mixed units.
        """
        if now.phase == 0:
            self.share[k] = 0.0
        elif was.phase == 0:
            T = float(y[first_of(self.loop, k)])
            self._start[k] = (p, T, float(kappa(self.loop.engine.gas, T)))

"""Running a loop: one smooth piece after another, from valve or combustion event to event, with its audits.

`simulate_loop` makes a run as any other of it: labelled columns, energy audit, the run at a tighter tolerance beside
it; `summary` and `series` are what the command line tells of a loop that runs by itself.
"""

import time
from collections.abc import Callable
from dataclasses import field, replace

import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.record import velocities
from mechsym.native.runs import Level
from mechsym.page import Shown
from mechsym.quantities import RPM, record, results
from mechsym.quantities.results import Columns, part, quantity
from mechsym.quantities.units import Pure, Radian, RadPerSecond, Second
from mechsym.simulate.audit import energies, energy_audit
from mechsym.simulate.integrate import phase_integrator
from mechsym.simulate.loop.events import CYCLE, CylinderCycle, ahead, first_state, ledger, pass_event
from mechsym.simulate.loop.system import WORKS, Loop, equations
from mechsym.simulate.phase import Leg, Phase
from mechsym.simulate.result import Event, Result
from mechsym.simulate.run import tighter, trusted
from mechsym.simulate.settings import DEFAULT, FALLBACK, NATIVE, Settings
from mechsym.simulate.speed import last_period, speeds

_ROLES = {"gas": "drive", "load": "load"}
_LOOPS = (*NATIVE, FALLBACK)  # what knows events
_LOOKS = 2881  # at two turns: every quarter of a degree
_PASSED = 1e-9  # events closer than this are one [rad]
_STALL = 0.05  # of the first speed: a shaft as slow as that has stopped


@record
class LoopResult(Shown):
    """What the loop did."""

    #: `done`, `stalled` or `failed`, and why
    status: str
    reason: str
    end: str  #: `turns`, `t_end`, `stall` or `failure`
    t: np.ndarray  #: shape (n,): Time [s]
    #: shape (n, coordinates): Coordinates [rad] and velocities [rad/s]
    q: np.ndarray
    u: np.ndarray
    p: np.ndarray  #: shape (n, cylinders): Pressures [Pa]
    cycles: tuple[CylinderCycle, ...]
    works: np.ndarray  #: shape (n, 3): Work of the pistons and of the load, and what dampers took, since the start [J]
    energy: np.ndarray  #: shape (2, n): Kinetic and potential energy [J]
    energy_residual: float  #: (work of pistons and load - taken by dampers - change of energy)/work of the pistons [-]
    steps: int
    #: Ascending times [s] to states (m, n): coordinates, velocities, and more
    dense: Callable[[np.ndarray], np.ndarray] = field(repr=False, compare=False)


@record
class _Ended:
    status: str
    reason: str
    end: str


def run_loop(
    loop: Loop,
    omega: RadPerSecond,
    cycles: Pure,
    points: int = 360,
    tolerance: Pure = 1e-9,
    angle: Radian = 0.0,
    t_end: Second = np.inf,
    backend: str = DEFAULT,
) -> LoopResult:
    """Run a loop over a number of engine cycles.

    omega: speed of every coordinate at the start; cycles: engine cycles of two turns to run; tolerance: relative and
    absolute tolerance of a step; angle: value of every coordinate at the start; t_end: time at which the run ends if
    that comes first. Returns result: motion, pressures, cycle by cycle work, audits.
    """
    model, books, advance = equations(loop), ledger(loop), phase_integrator(backend)
    gases, y = first_state(loop, omega, angle)
    start, n, grid, last = y, model.system.size, 2 * np.pi / omega / points, angle + cycles * CYCLE
    levels = (Level(state=0, level=last, direction=1), Level(state=n, level=_STALL * omega, direction=-1))
    phases: list[Phase] = []
    samples: list[np.ndarray] = []
    done: list[CylinderCycle] = []
    t, step, steps, ended = 0.0, None, 0, _Ended(status="done", reason=f"{cycles:g} cycles", end="turns")
    while y[0] < last - _PASSED:
        held, until = np.array([v for gas in gases for v in gas.held]), min(t + 3 * CYCLE / omega, t_end)
        events = [ahead(loop, gas, k) for k, gas in enumerate(gases)]
        times = np.arange(np.floor(t / grid) + 1, np.ceil(until / grid)) * grid
        phase = Phase(
            system=model.system, t_start=t, t_end=until, y=y, w=held, surfaces=(*events, *levels), times=times,
            tolerance=tolerance, first_step=step,
        )  # fmt: skip
        with np.errstate(invalid="ignore", over="ignore"):  # a try may reach where no gas is; the step is shortened
            leg = advance(phase)
        steps += leg.steps
        if leg.failure or leg.met is None and leg.t < t_end:
            ended = _Ended(status="failed", reason=leg.failure or f"no event up to t = {leg.t:.4g} s", end="failure")
            break
        phases.append(phase)
        samples.append(leg.samples)
        t, y, step = leg.t, leg.y, leg.step
        if leg.met == len(events) + 1:
            why = f"the shaft fell to {_STALL:g} of its first speed at t = {t:.4g} s"
            ended = _Ended(status="stalled", reason=why, end="stall")
            break
        if t >= t_end:
            ended = _Ended(status="done", reason=f"{t_end:g} s", end="t_end")
            break
        p = np.asarray(model.pressures(y, held)).ravel()
        for k, (gas, event) in enumerate(zip(gases, events, strict=True)):
            if y[event.state] - event.level > -_PASSED:
                gases[k], y, cycle = pass_event(loop, model, books, gas, k, (t, y, float(p[k])))
                done += [cycle] if cycle else []
    grids = [np.zeros(1), *(p.times[: len(rows)] for p, rows in zip(phases, samples, strict=True)), np.array([t])]
    states = np.vstack([start, *samples, y])
    w = np.repeat([p.w for p in (phases[:1] or [phase]) + phases + [phase]], list(map(len, grids)), axis=0)
    p = np.asarray(model.pressures.map(len(states))(states.T, w.T)).T
    q, u, works = states[:, :n], states[:, n : 2 * n], states[:, -len(WORKS) :]
    energy = np.array(energies(loop.mechanism, q.T, u.T))
    gas_work, load_work, loss = works[-1]
    change = float(np.diff(energy.sum(axis=0)[[0, -1]])[0])
    return LoopResult(
        status=ended.status, reason=ended.reason, end=ended.end, t=np.concatenate(grids), q=q, u=u, p=p,
        cycles=tuple(done), works=works, energy=energy,
        energy_residual=float((gas_work + load_work - loss - change) / abs(gas_work)), steps=steps,
        dense=lambda wanted: _dense(phases, advance, wanted),
    )  # fmt: skip


def _dense(phases: list[Phase], advance: Callable[[Phase], Leg], t: np.ndarray) -> np.ndarray:
    """States at times, each phase run again; where two meet, by the later."""
    starts = np.array([phase.t_start for phase in phases])
    of, states = np.maximum(np.searchsorted(starts, t, side="right") - 1, 0), []
    for k in np.unique(of):
        wanted = t[of == k]
        after = wanted[wanted > phases[k].t_start]
        leg = advance(replace(phases[k], times=after))
        states += [*[phases[k].y] * (len(wanted) - len(after)), *leg.samples]
    return np.array(states).T


def simulate_loop(
    loop: Loop, omega: RadPerSecond, turns: Pure, settings: Settings, angle: Radian = 0.0, t_end: Second = np.inf
) -> Result:
    """Run a loop and say how far the result can be trusted.

    omega: speed of every coordinate at the start; turns: turns of the first coordinate to run; angle: value of every
    coordinate at the start; t_end: time at which the run ends if that comes first. Returns result: columns of the
    motion, works, energies, and pressures `p_1`, `p_2`, . Raises BadInput: Another backend than the one that takes gas
    in the loop.
    """
    if settings.backend not in _LOOPS:
        raise BadInput(f"backend {settings.backend!r} does not take gas in the loop; use {' or '.join(_LOOPS)}")

    def once(asked: Settings) -> Result:
        begin = time.perf_counter()
        run = run_loop(
            loop, omega, turns / 2, tolerance=asked.tolerance, angle=angle, t_end=t_end, backend=asked.backend
        )
        return _as_any_run(loop, run, time.perf_counter() - begin)

    result = once(settings)
    if result.status == "failed" or settings.check == "none":
        return result
    return trusted(loop.mechanism, result, once(tighter(settings)), once, settings)


def _as_any_run(loop: Loop, run: LoopResult, wall_s: float) -> Result:
    names = (*loop.mechanism.coordinates, *velocities(loop.mechanism))
    n = len(loop.mechanism.coordinates)
    columns = dict(zip(names, np.hstack([run.q, run.u]).T, strict=True))
    units = dict(zip(names, ("rad",) * n + ("rad/s",) * n, strict=True))
    balance = dict(zip((*WORKS, "kinetic_energy", "potential_energy"), [*run.works.T, *run.energy], strict=True))
    pressures = {f"p_{k}": p for k, p in enumerate(run.p.T, 1)}
    failed = run.end == "failure"
    state = {name: float(columns[name][-1]) for name in names}
    return Result(
        status="failed" if failed else "unchecked",
        reason=run.reason if failed else "the tolerance was not checked",
        t=run.t,
        columns=columns | balance | pressures,
        units=units | dict.fromkeys(balance, "J") | dict.fromkeys(pressures, "Pa"),
        end=run.end,
        event=Event(name="stall", t=float(run.t[-1]), state=state) if run.end == "stall" else None,
        energy=energy_audit(_ROLES, columns | balance),
        tolerance_difference=None,
        steps=run.steps,
        wall_s=wall_s,
        dense=None if failed else lambda t: dict(zip(names, run.dense(t), strict=False)),
    )


@results.result
class LoopCycleNumbers:
    """One cycle of a cylinder in motion."""

    cylinder: int = quantity("-")  #: From 1
    t_s: float = quantity("s")  #: When it ended
    speed_rpm: float = quantity("rpm")  #: Mean speed of the crank in it
    work: float = quantity("J")  #: Work of the gas
    wall_heat: float = quantity("J")  #: Heat to the walls
    energy_residual: float = quantity("-")  #: What the first law leaves open
    knock: float = quantity("-")  #: Integral of the ignition delay; from 1 on it knocks


@results.result
class LoopNumbers:
    """What a run of cycle and mechanism together did; speeds of the loaded shaft over the last two turns."""

    status: str = part()
    reason: str = part()
    t_end: float = quantity("s")  #: When it ended
    speed_mean_rpm: float = quantity("rpm")  #: Mean speed
    speed_min_rpm: float = quantity("rpm")  #: Least speed
    speed_max_rpm: float = quantity("rpm")  #: Largest speed
    speed_ripple: float | None = quantity("-")  #: (max - min) / mean; None where it does not turn
    p_max_mpa: float = quantity("MPa")  #: Largest pressure in any cylinder, absolute
    cycles: tuple[LoopCycleNumbers, ...] = part()
    energy_residual: float = quantity("-")  #: Of the whole run


def summary(loop: Loop, result: LoopResult) -> LoopNumbers:
    """What a loop did, in numbers."""
    k, n = loop.mechanism.coordinates.index(loop.load_coordinate), len(loop.mechanism.coordinates)
    since = last_period(result.t, result.q[:, k], result.u[:, k], CYCLE)

    def motion(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        states = result.dense(t)
        return states[[k]], states[[n + k]]

    (shaft,) = speeds(motion, np.linspace(since, result.t[-1], _LOOKS))
    rows = []
    for c in result.cycles:
        rows.append(
            LoopCycleNumbers(
                cylinder=c.cylinder + 1, t_s=c.time, speed_rpm=c.speed / RPM, work=c.work, wall_heat=c.wall_heat,
                energy_residual=c.residual, knock=c.knock,
            )
        )  # fmt: skip
    return LoopNumbers(
        status=result.status, reason=result.reason, t_end=float(result.t[-1]), speed_mean_rpm=shaft.mean / RPM,
        speed_min_rpm=shaft.min / RPM, speed_max_rpm=shaft.max / RPM, speed_ripple=shaft.ripple,
        p_max_mpa=float(result.p.max()) / 1e6, cycles=tuple(rows), energy_residual=result.energy_residual,
    )  # fmt: skip


def series(loop: Loop, result: LoopResult) -> Columns:
    """Time series of a loop: `t`, coordinates, velocities, pressures `p_1`, `p_2`, .."""
    columns = {"t": (result.t, "s")}
    for k, name in enumerate(loop.mechanism.coordinates):
        columns |= {name: (result.q[:, k], "rad"), f"{name}d": (result.u[:, k], "rad/s")}
    columns |= {f"p_{k + 1}": (result.p[:, k], "Pa") for k in range(result.p.shape[1])}
    return Columns({n: v for n, (v, _) in columns.items()}, {n: unit for n, (_, unit) in columns.items()})

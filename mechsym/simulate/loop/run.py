"""Running a loop: one smooth piece after another, from valve or combustion event to event, with its audits."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import scipy

from mechsym.page import Shown
from mechsym.quantities import record
from mechsym.simulate.audit import energies
from mechsym.simulate.loop.events import CYCLE, CylinderCycle, first_state, gap, ledger, pass_event
from mechsym.simulate.loop.knocking import EndGas
from mechsym.simulate.loop.system import WORKS, Loop, right_side

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


@record
class LoopRun:
    """Where a run starts, where it ends, and how exactly it is done."""

    omega: float  #: Speed of every coordinate at the start [rad/s]
    angle: float  #: Value of every coordinate there [rad]
    cycles: float  #: Engine cycles of two turns to run [-]
    t_end: float  #: Time at which it ends if that comes first [s]
    tolerance: float  #: Relative tolerance of the integration [-]


def run_loop(
    loop: Loop, omega: float, cycles: float, points: int = 360, tolerance: float = 1e-9, angle: float = 0.0,
    t_end: float = np.inf,
) -> LoopResult:  # fmt: skip
    """Run a loop over a number of engine cycles.

    Parameters
    ----------
    omega : float
        Speed of every coordinate at the start [rad/s]
    cycles : float
        Engine cycles of two turns to run [-]
    tolerance : float
        Relative tolerance of the integration [-]
    angle : float
        Value of every coordinate at the start [rad]
    t_end : float
        Time at which the run ends if that comes first [s]

    Returns
    -------
    result : LoopResult
        Motion, pressures, cycle by cycle work, audits
    """
    function, books = right_side(loop), ledger(loop)
    asked = LoopRun(omega=omega, angle=angle, cycles=cycles, t_end=t_end, tolerance=tolerance)
    gases, y = first_state(loop, omega, angle)
    t, grid, steps = 0.0, 2 * np.pi / omega / points, 0
    samples: list[tuple[float, np.ndarray, np.ndarray]] = []
    done: list[CylinderCycle] = []
    end_gas = EndGas(loop)
    verdict = ("done", f"{cycles:g} cycles", "turns")
    while y[0] - angle < cycles * CYCLE - _PASSED:
        held = np.concatenate([(g.phase, g.start, g.duration, g.dead_centre) for g in gases])
        piece = _advance(loop, function, held, (t, y), (gases, asked))
        if not piece.success or piece.t[-1] < t_end and not any(found.size for found in piece.t_events):
            verdict = ("failed", piece.message, "failure")
            break
        for s in np.arange(np.ceil(t / grid), np.ceil(piece.t[-1] / grid)) * grid:
            z = piece.sol(s)
            samples.append((s, z, np.asarray(function(z, held)[1]).ravel()))
        end_gas.follow(piece, function, held, gases)
        t, y, steps = float(piece.t[-1]), piece.y[:, -1].copy(), steps + piece.t.size - 1
        if piece.t_events[-1].size:
            why = f"the shaft fell to {_STALL:g} of its first speed at t = {t:.4g} s"
            verdict = ("stalled", why, "stall")
            break
        if t >= t_end:
            verdict = ("done", f"{t_end:g} s", "t_end")
            break
        for k, gas in enumerate(gases):
            if gap(loop, gas, k, y) > -_PASSED:
                gases[k], after, cycle = pass_event(loop, books, gas, k, (t, y))
                end_gas.event(k, gas, gases[k], y, float(function(y, held)[1][k]))
                y, done = after, done + ([replace(cycle, knock=end_gas.share[k])] if cycle else [])
    samples.append((t, y, np.asarray(function(y, held)[1]).ravel()))
    return _result(loop, verdict, samples, done, steps)


def _advance(loop: Loop, function: Any, held: np.ndarray, now: Any, limits: Any) -> Any:
    gases, asked = limits
    (t, y), omega = now, asked.omega
    n, last = len(loop.mechanism.coordinates), asked.angle + asked.cycles * CYCLE
    events: list[Any] = [lambda s, z, k=k, g=g: gap(loop, g, k, z) for k, g in enumerate(gases)]
    events += [lambda s, z: z[0] - last, lambda s, z: _STALL * omega - z[n]]
    for event in events:
        event.terminal, event.direction = True, 1.0
    size = np.array([*[1.0] * n, *[omega] * n, *[300.0, 100.0, 100.0] * len(gases), *[100.0] * len(WORKS)])
    with np.errstate(invalid="ignore", over="ignore"):  # a trial may reach where no gas is; then the step is shortened
        return scipy.integrate.solve_ivp(
            _fast(function, held), (t, min(t + 3 * CYCLE / omega, asked.t_end)), y, method="DOP853", events=events,
            rtol=asked.tolerance, atol=1e-3 * asked.tolerance * size, dense_output=True,
        )  # fmt: skip


def _fast(function: Any, held: np.ndarray) -> Callable[[float, np.ndarray], np.ndarray]:
    buffer: Any
    buffer, call = function.buffer()
    y_now, held_now, out = np.zeros(function.size1_in(0)), np.array(held, float), np.zeros(function.size1_out(0))
    buffer.set_arg(0, y_now.data)
    buffer.set_arg(1, held_now.data)
    buffer.set_res(0, out.data)

    # the default argument keeps the buffer alive as long as the function; without it casadi reads freed memory
    def f(t: float, y: np.ndarray, _alive: Any = buffer) -> np.ndarray:
        y_now[:] = y
        call()
        return out.copy()

    return f


def _result(
    loop: Loop, verdict: tuple[str, str, str], samples: Any, done: list[CylinderCycle], steps: int
) -> LoopResult:
    n = len(loop.mechanism.coordinates)
    t, states, p = (np.array(column) for column in zip(*samples, strict=True))
    q, u, works = states[:, :n], states[:, n : 2 * n], states[:, -len(WORKS) :]
    found = energies(loop.mechanism, q.T, u.T)
    assert found is not None  # a mechanism with pistons has energies
    energy = np.array(found)
    gas, load, loss = works[-1]
    change = float(np.diff(energy.sum(axis=0)[[0, -1]])[0])
    return LoopResult(
        status=verdict[0], reason=verdict[1], end=verdict[2], t=t, q=q, u=u, p=p, cycles=tuple(done), works=works,
        energy=energy, energy_residual=float((gas + load - loss - change) / abs(gas)), steps=steps,
    )  # fmt: skip

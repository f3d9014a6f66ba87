"""Running a loop: one smooth piece after another, from valve or combustion event to event, with its audits."""

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from mechsym.quantities import record
from mechsym.simulate.loop.events import CYCLE, CylinderCycle, first_state, gap, ledger, pass_event
from mechsym.simulate.loop.system import Loop, right_side

_PASSED = 1e-9  # events closer than this are one [rad]
_STALL = 0.05  # of the first speed: a shaft as slow as that has stopped


@record
class LoopResult:
    """What the loop did."""

    #: `done`, `stalled` or `failed`, and why
    status: str
    reason: str
    t: np.ndarray  #: shape (n,): Time [s]
    #: shape (n, coordinates): Coordinates [rad] and velocities [rad/s]
    q: np.ndarray
    u: np.ndarray
    p: np.ndarray  #: shape (n, cylinders): Pressures [Pa]
    cycles: tuple[CylinderCycle, ...]
    energy_residual: float  #: (work of all forces - change of kinetic energy)/work of the pistons [-]


def run_loop(loop: Loop, omega: float, cycles: float, points: int = 360, tolerance: float = 1e-9) -> LoopResult:
    """Run a loop over a number of engine cycles.

    Parameters
    ----------
    omega : float
        Speed of every coordinate at the start, all angles 0 [rad/s]
    cycles : float
        Engine cycles of two turns to run [-]
    tolerance : float
        Relative tolerance of the integration [-]

    Returns
    -------
    result : LoopResult
        Motion, pressures, cycle by cycle work, audits
    """
    function, books = right_side(loop), ledger(loop)
    gases, y = first_state(loop, omega)
    t, grid = 0.0, 2 * np.pi / omega / points
    samples: list[tuple[float, np.ndarray, np.ndarray]] = []
    done: list[CylinderCycle] = []
    status, reason = "done", f"{cycles:g} cycles"
    while y[0] < cycles * CYCLE - _PASSED:
        held = np.concatenate([(g.phase, g.start, g.duration, g.dead_centre) for g in gases])
        piece = _advance(loop, function, held, (t, y), (gases, omega, cycles, tolerance))
        if not piece.success or not any(found.size for found in piece.t_events):
            status, reason = "failed", piece.message
            break
        for s in np.arange(np.ceil(t / grid), np.ceil(piece.t[-1] / grid)) * grid:
            z = piece.sol(s)
            samples.append((s, z, np.asarray(function(z, held)[1]).ravel()))
        t, y = float(piece.t[-1]), piece.y[:, -1].copy()
        if piece.t_events[-1].size:
            status, reason = "stalled", f"the shaft fell to {_STALL:g} of its first speed at t = {t:.4g} s"
            break
        for k, gas in enumerate(gases):
            if gap(loop, gas, k, y) > -_PASSED:
                gases[k], y, cycle = pass_event(loop, books, gas, k, (t, y))
                done += [cycle] if cycle else []
    return _result(loop, omega, (status, reason), samples, done, y)


def _advance(loop: Loop, function: Any, held: np.ndarray, now: Any, limits: Any) -> Any:
    gases, omega, cycles, tolerance = limits
    t, y = now
    n, last = len(loop.mechanism.coordinates), cycles * CYCLE
    events: list[Any] = [lambda s, z, k=k, g=g: gap(loop, g, k, z) for k, g in enumerate(gases)]
    events += [lambda s, z: z[0] - last, lambda s, z: _STALL * omega - z[n]]
    for event in events:
        event.terminal, event.direction = True, 1.0
    size = np.array([*[1.0] * n, *[omega] * n, *[300.0, 100.0, 100.0] * len(gases), 100.0, 100.0])
    return solve_ivp(
        _fast(function, held), (t, t + 3 * CYCLE / omega), y, method="DOP853", events=events, rtol=tolerance,
        atol=1e-3 * tolerance * size, dense_output=True,
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
    loop: Loop, omega: float, verdict: tuple[str, str], samples: Any, done: list[CylinderCycle], y: np.ndarray
) -> LoopResult:
    n = len(loop.mechanism.coordinates)
    energy = loop.mechanism.functions["energy"]
    end, start = (float(energy.call([*state])[0]) for state in (y[: 2 * n], np.array([*[0.0] * n, *[omega] * n])))
    t, states, p = (np.array(column) for column in zip(*samples, strict=True))
    return LoopResult(
        status=verdict[0], reason=verdict[1], t=t, q=states[:, :n], u=states[:, n : 2 * n], p=p, cycles=tuple(done),
        energy_residual=float((y[-2] - end + start) / abs(y[-1])),
    )  # fmt: skip

"""A loop run as any other: labelled columns, energy audit, and the run at a tighter tolerance beside it."""

import time

import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.record import velocities
from mechsym.simulate.audit import energy_audit
from mechsym.simulate.backends import FALLBACK
from mechsym.simulate.loop.run import LoopResult, run_loop
from mechsym.simulate.loop.system import WORKS, Loop
from mechsym.simulate.result import Event, Result
from mechsym.simulate.run import checked, tighter
from mechsym.simulate.settings import Settings

_ROLES = {"gas": "drive", "load": "load"}
_LOOPS = ("auto", FALLBACK)  # the names under which this integrator goes


def simulate_loop(
    loop: Loop, omega: float, turns: float, settings: Settings, angle: float = 0.0, t_end: float = np.inf
) -> Result:
    """Run a loop and say how far the result can be trusted.

    Parameters
    ----------
    omega : float
        Speed of every coordinate at the start [rad/s]
    turns : float
        Turns of the first coordinate to run [-]
    angle : float
        Value of every coordinate at the start [rad]
    t_end : float
        Time at which the run ends if that comes first [s]

    Returns
    -------
    result : Result
        Columns of the motion, works, energies, and pressures `p_1`, `p_2`, ..

    Raises
    ------
    BadInput
        Another backend than the one that takes gas in the loop
    """
    if settings.backend not in _LOOPS:
        raise BadInput(f"backend {settings.backend!r} does not take gas in the loop; use {' or '.join(_LOOPS)}")

    def once(asked: Settings) -> Result:
        begin = time.perf_counter()
        found = run_loop(loop, omega, turns / 2, tolerance=asked.tolerance, angle=angle, t_end=t_end)
        return _result(loop, found, time.perf_counter() - begin)

    result = once(settings)
    if result.status == "failed" or settings.check == "none":
        return result
    return checked(loop.mechanism, result, once(tighter(settings)), settings)


def _result(loop: Loop, found: LoopResult, wall_s: float) -> Result:
    names = (*loop.mechanism.coordinates, *velocities(loop.mechanism))
    n = len(loop.mechanism.coordinates)
    columns = dict(zip(names, np.hstack([found.q, found.u]).T, strict=True))
    units = dict(zip(names, ("rad",) * n + ("rad/s",) * n, strict=True))
    balance = dict(zip((*WORKS, "kinetic_energy", "potential_energy"), [*found.works.T, *found.energy], strict=True))
    pressures = {f"p_{k}": p for k, p in enumerate(found.p.T, 1)}
    failed, stalled = found.end == "failure", found.end == "stall"
    state = {name: float(columns[name][-1]) for name in names}
    return Result(
        status="failed" if failed else "unchecked",
        reason=found.reason if failed else "the tolerance was not checked",
        t=found.t,
        columns=columns | balance | pressures,
        units=units | dict.fromkeys(balance, "J") | dict.fromkeys(pressures, "Pa"),
        end=found.end,
        event=Event(name="stall", t=float(found.t[-1]), state=state) if stalled else None,
        energy=energy_audit(_ROLES, columns | balance),
        tolerance_difference=None,
        steps=found.steps,
        wall_s=wall_s,
    )

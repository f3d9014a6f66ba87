"""Run a problem: integrate it, audit the energy, check the tolerance, and refuse what could not end."""

import math
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities.units import Array, Second
from mechsym.simulate import constrained
from mechsym.simulate import events as event_runs
from mechsym.simulate.audit import energies, energies_beside, energy_audit, speed_difference, verdict
from mechsym.simulate.between import between
from mechsym.simulate.equations import System, system
from mechsym.simulate.integrate import integrate
from mechsym.simulate.phase import Raw
from mechsym.simulate.problem import Problem, Steps, times_of
from mechsym.simulate.result import Event, Happened, Result
from mechsym.simulate.settings import Settings

TRIAL = 20_000  # steps that a run is tried with
_OFF = 2.0  # a forecast may be off by so much; within it the run has its chance
_STUCK = 5.0  # exponent of a run that hardly comes on any more
_NEAR = np.concatenate([[0.0], np.geomspace(1e-14, 1e-3, 34)])  # how far off a pose is looked for [rad] or [m]
POLE, _AT_POLE = "pole", 1e-8  # least eigenvalue of a mass matrix whose diagonal is scaled to 1
_TIGHTEST = 3e-14  # below that a double-precision step cannot be controlled


def simulate(problem: Problem, settings: Settings | None = None) -> Result:
    """Integrate a problem and say how far the result can be trusted.

    settings: tolerance 1e-10 with check unless given. Returns result: series, energy audit, convergence; a failure is a
    status with a reason.

    Raises BadInput: the backend cannot take this problem, or its first steps show that it would not end within those
    allowed.
    """
    settings = settings or Settings()
    result = _once(problem, shorter(settings))
    if result.end == "failure" and settings.max_steps > TRIAL:
        refuse_endless(problem, _once(problem, shorter(settings, TRIAL // 2)), result, settings)
        result = _once(problem, settings)
    if result.status == "failed" or settings.check == "none":
        return result
    return trusted(problem.mechanism, result, _once(problem, tighter(settings)), partial(_once, problem), settings)


def _once(problem: Problem, settings: Settings) -> Result:
    begin = time.perf_counter()
    equations, raw, happened = _raw(problem, settings)
    return replace(result_of(problem, equations, raw, settings, time.perf_counter() - begin), happened=happened)


def _raw(problem: Problem, settings: Settings, equations: System | None = None) -> tuple[System, Raw, Happened]:
    """A run before it is audited, its equations, which may be known, and what it tells."""
    if problem.unilateral:
        return event_runs.integrate(problem, settings, wanted_times(problem), ends_of(problem))
    if problem.mechanism.dependents:
        return constrained.integrate(problem, settings, wanted_times(problem), ends_of(problem))
    equations = equations or system(problem)
    return equations, integrate(problem, equations, settings, wanted_times(problem), ends_of(problem)), Happened()


def tighter(settings: Settings) -> Settings:
    """Settings of the run that checks another.

    settings: of the run to be checked. Returns settings: a hundredth of the tolerance, without a check of its own.
    """
    return replace(settings, tolerance=max(settings.tolerance / 100, _TIGHTEST), check="none")


def trusted(
    mechanism: Mechanism, result: Result, check: Result, once: Callable[[Settings], Result], settings: Settings
) -> Result:
    """A result with the verdict of its check, or the check where a still tighter run agrees with that.

    Where a force has kinks, as a table has, steps of a high order are less exact than they know; the energy, which is
    summed up by the same steps, does not show it.

    result, check: the run, and the run at the tighter tolerance; once: runs it with other settings.
    """
    closer = tighter(settings)
    seen = checked(mechanism, result, check, settings)
    if seen.status != "chaotic" or closer.tolerance <= _TIGHTEST:
        return seen
    finer = checked(mechanism, check, once(tighter(closer)), closer)
    if finer.status != "converged":
        return seen
    why = f"{finer.reason}, at the tolerance {closer.tolerance:g}: {settings.tolerance:g} was not enough"
    return replace(finer, reason=why, tolerance=closer.tolerance)


def checked(mechanism: Mechanism, result: Result, check: Result, settings: Settings) -> Result:
    """A result with the verdict of its check.

    result, check: the run, and the run at the tighter tolerance.
    """
    if check.status == "failed":
        return replace(result, status="not converged", reason=f"the run at the tighter tolerance {check.reason}")
    if check.end != result.end:
        why = f"ends by {result.end!r}, at the tighter tolerance by {check.end!r}; use a smaller tolerance"
        return replace(result, status="not converged", reason=why)
    here: np.ndarray | slice = slice(None)
    t, there = result.t, here
    if not np.array_equal(result.t, check.t):  # the times that both share, and where they stand in each
        t, here, there = np.intersect1d(result.t, check.t, return_indices=True)
    speeds = [f"{q}d" for q in mechanism.coordinates if q not in mechanism.dependents]  # the others follow them
    difference = speed_difference(
        {v: result.columns[v][here] for v in speeds}, {v: check.columns[v][there] for v in speeds}
    )
    residuals = (result.energy.residual, check.energy.residual)
    status, reason = verdict(t, difference, settings.difference_allowed, residuals)
    return replace(result, status=status, reason=reason, tolerance_difference=float(np.max(difference)))


def wanted_times(problem: Problem) -> Second[Array]:
    """Times at which results are wanted.

    problem: with a spacing or a list of times. Returns times: after the start, ascending.
    """
    if not isinstance(problem.output, (int, float)):
        return times_of(problem.output)
    count = int(np.floor((problem.t_end - problem.t_start) / problem.output * (1 + 1e-12)))
    return np.minimum(problem.t_start + problem.output * np.arange(1, count + 1), problem.t_end)


def ends_of(problem: Problem) -> list[Second]:
    """Ends of the stretches of time in which nothing jumps.

    Returns ends: ascending; the last is the end of the run.
    """
    jumps = [t for p in problem.parts if isinstance(p.value, Steps) for t in p.value.times]
    inside = sorted(t for t in {*problem.breaks, *jumps} if problem.t_start < t < problem.t_end)
    return [*inside, problem.t_end]


def result_of(problem: Problem, equations: System, raw: Raw, settings: Settings, wall_s: Second) -> Result:
    """A finished run as a result, with its energy audited.

    wall_s: time it took.
    """
    n, whole = equations.size, ended(problem.mechanism, raw)
    raw = posed(problem.mechanism, whole)
    columns = dict(zip(equations.columns, raw.y.T, strict=True))
    units = dict(zip(equations.columns, equations.units, strict=True))
    shared = equations.shared or problem.mechanism
    known = energies(shared, raw.y[:, :n].T, raw.y[:, n : 2 * n].T, equations.letters)
    if known is not None:
        columns |= dict(zip(("kinetic_energy", "potential_energy"), known, strict=True))
        units |= {"kinetic_energy": "J", "potential_energy": "J"}
        if beside := energies_beside(problem, columns):
            columns |= beside
            units |= dict.fromkeys(beside, "J")
    heats = tuple(s.name for s in problem.states if s.role == "heat")
    met = raw.end in {constrained.LOCKED, POLE, *(s.name for s in problem.stops)}
    state = dict(zip(equations.columns[: 2 * n], whole.y[-1].tolist(), strict=False))
    return Result(
        status="failed" if raw.failure else "unchecked",
        reason=raw.failure or "the tolerance was not checked",
        t=raw.t,
        columns=columns,
        units=units,
        end=raw.end,
        event=Event(name=raw.end, t=float(whole.t[-1]), state=state) if met else None,
        energy=energy_audit({p.name: p.role for p in problem.parts}, columns, heats),
        tolerance_difference=None,
        steps=raw.steps,
        wall_s=wall_s,
        dense=None if raw.failure else _dense(problem, equations, raw, settings),
    )


def ended(mechanism: Mechanism, raw: Raw) -> Raw:
    """A run as it is, or with the event that it failed at: `locked` where a loop opens beyond, `pole` of angles."""
    if not raw.failure or "dynamics" not in mechanism.functions or mechanism.dependents:
        return raw
    whole = np.isfinite(raw.y).all(axis=1)
    if not whole.any():
        return raw
    last, n = int(np.flatnonzero(whole)[-1]), len(mechanism.coordinates)
    q, u = np.split(raw.y[last, : 2 * n], 2)
    locked, pole = opens(mechanism, q, u), at_pole(mechanism, q)
    if not locked and not pole:
        return raw
    locked = locked or "sides" in mechanism.functions  # at a dead point of a closed form the masses come to a pole too
    end = constrained.LOCKED if locked else POLE
    return replace(raw, t=raw.t[: last + 1], y=raw.y[: last + 1], end=end, failure="")


def posed(mechanism: Mechanism, raw: Raw) -> Raw:
    """A run without a last state that lies on the pose where the loop opens, where no energy is known."""
    if raw.end != constrained.LOCKED or mechanism.dependents or len(raw.t) < 2 or "energy" not in mechanism.functions:
        return raw
    n = len(mechanism.coordinates)
    energy = mechanism.functions["energy"].call(list(raw.y[-1, : 2 * n]))
    return raw if np.isfinite([float(e) for e in energy]).all() else replace(raw, t=raw.t[:-1], y=raw.y[:-1])


def at_pole(mechanism: Mechanism, q: np.ndarray) -> bool:
    """Whether rates of coordinates differ in nothing that has mass, as those of three angles with two axes alike.

    q: coordinates [rad or m].
    """
    dynamics, n = mechanism.functions["dynamics"], len(q)
    mass = np.asarray(dynamics.call([*q, *[0.0] * (dynamics.n_in() - n)])[0])
    if n < 2 or not np.isfinite(mass).all() or not (size := np.sqrt(np.diag(mass))).all():
        return False
    return bool(np.linalg.eigvalsh(mass / np.outer(size, size))[0] < _AT_POLE)


def opens(mechanism: Mechanism, q: np.ndarray, u: np.ndarray) -> bool:
    """Whether a loop opens at a pose or a thousandth beside it, on the way of the motion or back.

    q, u: coordinates and velocities [rad, rad/s].
    """
    dynamics = mechanism.functions["dynamics"]
    rest = [0.0] * (dynamics.n_in() - 2 * len(q) if dynamics.n_in() >= 2 * len(q) else 0)
    way = np.where(u == 0, 1.0, np.sign(u))

    def closed(step: float) -> bool:
        return bool(np.isfinite(np.asarray(dynamics.call([*(q + step * way), *u, *rest])[0])).all())

    return not all(closed(sign * step) for step in _NEAR for sign in (1.0, -1.0))


def _dense(
    problem: Problem, equations: System, raw: Raw, settings: Settings
) -> Callable[[np.ndarray], dict[str, np.ndarray]]:
    """A run between its samples: within steps that are kept, else taken up again at the sample before."""
    n, names = equations.size, equations.columns[: 2 * equations.size]
    kept = [raw.last]

    def at(times: np.ndarray) -> dict[str, np.ndarray]:
        for steps in kept:
            if steps is not None and steps.hold(times):
                return dict(zip(names, steps.at(times), strict=True))
        i = max(int(np.searchsorted(raw.t, times[0], side="right")) - 1, 0)
        y, after = raw.y[i], times[times > raw.t[i]]
        inner = zip(problem.states, y[len(y) - len(problem.states) :], strict=True)
        again = replace(
            problem,
            q0=tuple(y[:n]),
            u0=tuple(y[n : 2 * n]),
            states=tuple(replace(s, start=float(v)) for s, v in inner),
            t_start=float(raw.t[i]),
            t_end=float(times[-1]),
            turns=None,
            stops=(),
            output=tuple(after),
        )
        _, run, _ = _raw(again, settings, equations)
        if run.failure:  # no work done yet, and more power than its tolerance bears
            return dict(between(raw.t, dict(zip(names, raw.y.T, strict=False)))(times))
        kept[1:] = [run.last]
        return dict(zip(names, run.y[0 if times[0] == raw.t[i] else 1 :].T, strict=False))

    return at


def shorter(settings: Settings, steps: int = TRIAL) -> Settings:
    """The same settings with few steps allowed."""
    return replace(settings, max_steps=min(steps, settings.max_steps))


def refuse_endless(problem: Problem, first: Result, tried: Result, settings: Settings) -> None:
    r"""Refuse a run whose first steps show that it would not end within those allowed.

    .. math:: N(s) = N_1 (s/s_1)^p, \qquad p = \ln 2/\ln(s_1/s_{1/2})

    s is the share of the run, by time or by turns, that N steps come to: s_1 those of the trial, s_1/2 half of them. A
    shaft that a torque speeds up for ever has p = 2. Where the second half hardly comes on (p above 5) the run is stiff
    or singular, which no forecast tells, and it is run to the end that it meets.

    first, tried: the run with half of `TRIAL` steps, and with all of them.

    Raises BadInput: the forecast is more than twice what is allowed, with how far the run may go.
    """
    by_time, by_turns = _shares(problem, tried)
    half, whole = max(_shares(problem, first)), max(by_time, by_turns)
    if not 0 < half < whole or math.log(2) > _STUCK * math.log(whole / half):
        return
    exponent = math.log(2) / math.log(whole / half)
    steps = TRIAL / whole**exponent
    if steps > _OFF * settings.max_steps:
        reach = whole * (settings.max_steps / TRIAL) ** (1 / exponent)
        asked, most = f"t_end = {problem.t_end:g} s", f"{reach * problem.t_end:.2g} s"
        if problem.turns is not None and by_turns >= by_time:
            asked, most = f"turns = {problem.turns:g}", f"{reach * problem.turns:.2g} turns"
        raise BadInput(
            f"{asked} asks for about {steps:.2g} steps of the integrator; allowed are {settings.max_steps}; give at "
            f"most about {most}, or a larger tolerance"
        )


def _shares(problem: Problem, result: Result) -> tuple[float, float]:
    """How much of a run has been done, by time and by turns."""
    by_time = float((result.t[-1] - problem.t_start) / (problem.t_end - problem.t_start))
    if problem.turns is None:
        return by_time, 0.0
    angle = result.columns[problem.mechanism.coordinates[0]]
    return by_time, float((angle[-1] - problem.q0[0]) / (2 * math.pi * problem.turns))

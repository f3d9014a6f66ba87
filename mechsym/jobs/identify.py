"""Case and trace -> parameters: inertia, stiffness, damping and friction out of measured speeds."""

import dataclasses
from collections.abc import Mapping, Sequence

import casadi as ca
import numpy as np

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.cases.needs import require
from mechsym.cases.owned import letter_of
from mechsym.cases.settings import guesses
from mechsym.errors import BadInput, suggest
from mechsym.jobs.machine import constants, drive_on
from mechsym.mechanisms import parameters_class
from mechsym.mechanisms.loops import with_letters
from mechsym.mechanisms.record import Mechanism, bind, velocities
from mechsym.mechanisms.shaft import with_inertia
from mechsym.optimise.fit import TracedMotion
from mechsym.optimise.identify import Identified
from mechsym.optimise.identify import identify as solve
from mechsym.optimise.trace import Trace, read_trace
from mechsym.simulate.settings import StepTorque

# forces or torques on the first coordinate against its motion: constant, and proportional to its speed
FRICTION = {"friction.constant": "N*m", "friction.viscous": "N*m*s/rad"}
_SLIDING = {"friction.constant": "N", "friction.viscous": "N*s/m"}
_LOSSES = ("N*m", "N", "N*m*s/rad", "N*s/rad", "N*s/m")  # units of friction and dampers
_UNTOLD = {"cycle": "the gas", "torque": "the torque", "load": "the load"}  # sections whose push follows the motion


def identify(case: Case, file: str, free: Sequence[str]) -> Identified:
    """Find parameters of a case in a measured run.

    case: with `[parameters]`, which give what is not looked for; `[drive]` and constants of `[inputs]` act where the
    trace has no column for them. free: names among the parameters, and those of `FRICTION`. Raises BadInput: unknown
    names, a push that was not measured, a trace that cannot be trusted or does not tell.
    """
    require(case, "identify")
    known = mechanisms.listing(case.mechanism)
    held = known.get("dependents", ())
    speeds = {f"{q}d": f"{unit}/s" for q, unit in known["coordinates"].items() if q not in held}
    trace = read_trace(file, speeds, known["inputs"])
    for section in _UNTOLD:
        if section in case.sections and not trace.inputs:
            wanted = " or ".join(f"{name} [{unit}]" for name, unit in known["inputs"].items())
            raise BadInput(
                f"{case.file}: [{section}] acts, and the trace has no column of {_UNTOLD[section]}; measure {wanted}, "
                f"or take a case without [{section}]"
            )
    return solve(_model(case, trace, tuple(free)), trace)


def _model(case: Case, trace: Trace, free: tuple[str, ...]) -> TracedMotion:
    known, units = _parameters(case)
    turning = tuple(unit == "rad" for unit in mechanisms.listing(case.mechanism)["coordinates"].values())
    units |= FRICTION if turning[0] else _SLIDING
    free = tuple(letter_of(name, units) for name in free)
    for name in free:
        if name not in units or free.count(name) > 1:
            raise BadInput(f"--free {name}: name each parameter once; {suggest(name, list(units))}")
    symbols = {name: ca.SX.sym(name) for name in known if name in free}
    mechanism = bind(case.mechanism, {**known, **symbols})
    if mechanism.dependents:
        held = {name: guesses(case).get(name, guess) for name, guess in mechanism.dependents.items()}
        near = dataclasses.replace(bind(case.mechanism, known), dependents=held)
        mechanism = with_letters(mechanism, near, list(symbols.values()))
        turning = turning[:1]
    if "flywheel" in case.sections:
        mechanism = with_inertia(mechanism, case.need("flywheel").inertia)
    start = np.array([known.get(name, 0.0) for name in free])
    angle = getattr(case.sections.get("simulation"), "phi_start", 0.0)
    pose = {q: angle for q in mechanism.coordinates} | guesses(case)
    drive, (rate, energy) = case.sections.get("drive"), _functions(mechanism, symbols, free)
    return TracedMotion(
        rate=rate, energy=energy,
        lossy=any(units[name] in _LOSSES for name in free), velocities=velocities(mechanism), turning=turning,
        inputs=mechanism.inputs, names=free, units=tuple(units[name] for name in free), start=start,
        size=_sizes(mechanism, symbols, trace, free, start), low=_least(case, free),
        known=lambda t: _inputs(case, mechanism, trace, t), pose=np.array([pose[q] for q in mechanism.coordinates]),
        breaks=() if drive is None else (drive.time,),
    )  # fmt: skip


def _parameters(case: Case) -> tuple[dict[str, float], dict[str, str]]:
    record = case.need("parameters")
    values = dataclasses.asdict(record)
    lists = [name for name, value in values.items() if not isinstance(value, (int, float))]
    if lists:
        raise BadInput(f"{case.file}: {lists[0]} has several values; identify takes mechanisms with one value a letter")
    units = {f.name: f.metadata.get("unit", "-") for f in dataclasses.fields(record)}
    return {name: float(value) for name, value in values.items()}, units


def _sizes(
    mechanism: Mechanism, symbols: dict[str, ca.SX], trace: Trace, free: tuple[str, ...], start: np.ndarray
) -> np.ndarray:
    """Sizes of what is looked for; of what starts at 0 by the push that the trace tells."""
    dynamics = mechanism.functions["dynamics"]
    values = dict(zip(free, start.tolist(), strict=True))
    turn = [[values.get(name, angle) for name in dynamics.name_in()] for angle in np.arange(0.3, 2 * np.pi, 0.4)]
    inertias = (float(np.asarray(dynamics.call(at)[0])[0, 0]) for at in turn)
    inertia = next((value for value in inertias if np.isfinite(value)), 1.0)
    speed = next(iter(trace.speeds.values()))
    push = inertia * float(np.ptp(speed)) / float(np.ptp(trace.t))
    # of what starts at 0: a push, or a push by the speed
    usual = [push if name == "friction.constant" else push / float(np.abs(speed).max()) for name in free]
    return np.where(start != 0, np.abs(start), usual)


def _least(case: Case, free: tuple[str, ...]) -> np.ndarray:
    known = dataclasses.fields(parameters_class(case.mechanism))
    fields: dict[str, Mapping[str, float | None]] = {f.name: f.metadata for f in known}

    def least(name: str) -> float:
        bounds = [v for v in (fields.get(name, {}).get("above"), fields.get(name, {}).get("low")) if v is not None]
        return max(bounds, default=-np.inf)

    return np.array([least(name) for name in free])


def _functions(
    mechanism: Mechanism, symbols: dict[str, ca.SX], free: tuple[str, ...]
) -> tuple[ca.Function, ca.Function]:
    """Rate of the state, and energy with the power that acts, of state, inputs and what is looked for."""
    n, dynamics = len(mechanism.coordinates), mechanism.functions["dynamics"]
    x, w, theta = ca.SX.sym("x", 2 * n), ca.SX.sym("w", len(mechanism.inputs)), ca.SX.sym("theta", len(free))
    values = dict(zip(free, ca.vertsplit(theta), strict=True))
    mass, bias, force = dynamics(*ca.vertsplit(x), *ca.vertsplit(w), *(values[name] for name in symbols))
    lost = values.get("friction.constant", 0.0) * ca.sign(x[n]) + values.get("friction.viscous", 0.0) * x[n]
    push = force - bias - ca.vertcat(lost, ca.SX.zeros(n - 1))
    rates = ca.vertcat(x[n:], ca.solve(mass, push) if n > 1 else push / mass)
    energy = [ca.bilin(mass, x[n:], x[n:]) / 2, ca.dot(x[n:], force)]
    return ca.Function("rate", [x, w, theta], [rates]), ca.Function("energy", [x, w, theta], energy)


def _inputs(case: Case, mechanism: Mechanism, trace: Trace, t: np.ndarray) -> np.ndarray:
    """What acts at times t [s] on each input, shape (m, n): measured, of the drive, constant, or nothing [SI]."""
    acting = {name: np.full(len(t), value) for name, value in constants(case).items()}
    if "drive" in case.sections:
        drive: StepTorque = case.need("drive")
        on = drive_on(case, mechanism)
        acting[on.input] = np.where(t >= drive.time, on.value, 0.0)
    acting |= {name: np.interp(t, trace.t, values) for name, values in trace.inputs.items()}
    return np.array([acting.get(name, np.zeros(len(t))) for name in mechanism.inputs]).reshape(-1, len(t))

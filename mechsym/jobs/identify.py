"""Case and trace -> parameters: inertia, stiffness, damping and friction out of measured speeds."""

import dataclasses
from collections.abc import Sequence
from typing import Any

import casadi as ca
import numpy as np

from mechsym.cases import Case
from mechsym.errors import BadInput, suggest
from mechsym.mechanisms import parameters_class
from mechsym.mechanisms.record import Mechanism, bind, generated, velocities
from mechsym.optimise.fit import TracedMotion
from mechsym.optimise.identify import Identified
from mechsym.optimise.identify import identify as solve
from mechsym.optimise.trace import Trace, read_trace
from mechsym.simulate.settings import StepTorque

# torques on the first coordinate against its motion: constant, and proportional to its speed
FRICTION = {"friction.constant": "N*m", "friction.viscous": "N*m*s/rad"}
_FORCES = ("F", "G")  # first letters of inputs that are forces; the others are torques


def identify(case: Case, file: str, free: Sequence[str]) -> Identified:
    """Find parameters of a case in a measured run.

    Parameters
    ----------
    case : Case
        With `[parameters]`, which give what is not looked for; `[drive]` acts where the trace has no column for it
    free : sequence of str
        Names among the parameters, and those of `FRICTION`

    Raises
    ------
    BadInput
        Unknown names, gas whose force was not measured, a trace that cannot be trusted or does not tell
    """
    module = generated(case.mechanism)
    inputs = {name: "N" if name.startswith(_FORCES) else "N*m" for name in module.INPUTS}
    trace = read_trace(file, velocities(module), inputs)
    if "cycle" in case.sections and not trace.inputs:
        wanted = " or ".join(f"{name} [{unit}]" for name, unit in inputs.items())
        raise BadInput(
            f"{case.file}: [cycle] turns the shaft, and the trace has no column of its force; measure {wanted}, or "
            "take a case without [cycle]"
        )
    return solve(_model(case, trace, tuple(free)), trace)


def _model(case: Case, trace: Trace, free: tuple[str, ...]) -> TracedMotion:
    known, units = _parameters(case)
    names = [*known, *FRICTION]
    for name in free:
        if name not in names or free.count(name) > 1:
            raise BadInput(f"--free {name}: name each parameter once; {suggest(name, names)}")
    symbols = {name: ca.SX.sym(name) for name in known if name in free}
    mechanism = bind(case.mechanism, {**known, **symbols})
    if "constraints" in mechanism.functions:
        raise BadInput(f"{case.file}: {mechanism.name} has loops that its coordinates close; identify takes mechanisms "
                       "without them")  # fmt: skip
    start = np.array([known.get(name, 0.0) for name in free])
    size, low = _sizes(case, trace, free, start)
    simulation, drive = case.sections.get("simulation"), case.sections.get("drive")
    return TracedMotion(
        rate=_rate(mechanism, symbols, free), velocities=velocities(mechanism), inputs=mechanism.inputs, names=free,
        units=tuple(FRICTION.get(name) or units[name] for name in free), start=start, size=size, low=low,
        known=lambda t: _inputs(mechanism, drive, trace, t), angle=getattr(simulation, "phi_start", 0.0),
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


def _sizes(case: Case, trace: Trace, free: tuple[str, ...], start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sizes of what is looked for and its least values; of what starts at 0 by the torque that the trace tells."""
    mass = bind(case.mechanism, _parameters(case)[0]).functions["dynamics"]
    here = np.asarray(mass(*[0.3] * mass.n_in())[0])
    speed = next(iter(trace.speeds.values()))
    torque = float(here[0, 0]) * float(np.ptp(speed)) / float(np.ptp(trace.t))
    size = np.array([abs(s) or (torque if n == "friction.constant" else torque / float(np.abs(speed).max()))
                     for n, s in zip(free, start, strict=True)])  # fmt: skip
    fields: dict[str, Any] = {f.name: f.metadata for f in dataclasses.fields(parameters_class(case.mechanism))}

    def least(name: str) -> float:
        bounds = [v for v in (fields.get(name, {}).get("above"), fields.get(name, {}).get("low")) if v is not None]
        return max(bounds, default=-np.inf)

    return size, np.array([least(name) for name in free])


def _rate(mechanism: Mechanism, symbols: dict[str, ca.SX], free: tuple[str, ...]) -> ca.Function:
    n, dynamics = len(mechanism.coordinates), mechanism.functions["dynamics"]
    x, w, theta = ca.SX.sym("x", 2 * n), ca.SX.sym("w", len(mechanism.inputs)), ca.SX.sym("theta", len(free))
    values = dict(zip(free, ca.vertsplit(theta), strict=True))
    mass, bias, force = dynamics(*ca.vertsplit(x), *ca.vertsplit(w), *(values[name] for name in symbols))
    lost = values.get("friction.constant", 0.0) * ca.sign(x[n]) + values.get("friction.viscous", 0.0) * x[n]
    push = force - bias - ca.vertcat(lost, ca.SX.zeros(n - 1))
    rates = ca.vertcat(x[n:], ca.solve(mass, push) if n > 1 else push / mass)
    return ca.Function("rate", [x, w, theta], [rates])


def _inputs(mechanism: Mechanism, drive: StepTorque | None, trace: Trace, t: np.ndarray) -> np.ndarray:
    found = np.zeros((len(mechanism.inputs), len(t)))
    for row, name in enumerate(mechanism.inputs):
        if name in trace.inputs:
            found[row] = np.interp(t, trace.t, trace.inputs[name])
        elif drive is not None and name == (drive.input or "M"):
            found[row] = np.where(t >= drive.time, drive.torque, 0.0)
    return found

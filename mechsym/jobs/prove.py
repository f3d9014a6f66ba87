"""`mechsym prove`: a mechanism, or the limits of guides -> rounding of their code; a case -> its motion enclosed."""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import TypeAlias

import casadi as ca
import numpy as np

from mechsym import budget, cases
from mechsym.cases import Case
from mechsym.cases.needs import require
from mechsym.cases.numbers import usual
from mechsym.errors import BadInput
from mechsym.hinge.balance import balance
from mechsym.hinge.kernel import design_kernel
from mechsym.hinge.torque import torque
from mechsym.jobs.machine import machine
from mechsym.jobs.problem import problem_of
from mechsym.machine.record import acting, shaft_torque
from mechsym.mechanisms.own import is_file
from mechsym.mechanisms.record import bind, evaluate, generated, listing, velocities
from mechsym.proof.balls import outward
from mechsym.proof.enclosure import EnclosureMethod
from mechsym.proof.motion import MOST, Passed, digits, enclose, method_for, task_of
from mechsym.proof.outputs import Subject, of_guides, of_mechanism, widened
from mechsym.quantities.results import Columns, part, quantity, result
from mechsym.simulate import Settings, simulate
from mechsym.simulate.problem import Problem, Steps

_SHARE = 0.01  # of a parameter's value, to both sides
GUIDES = "hinge"  #: What stands for the limits of guides among the names of mechanisms
_FASTER = 1.1  # highest speed by that of operation
_TURN = np.arange(1440) * 4 * np.pi / 1440
Ranges = dict[str, tuple[float, float]]
#: Speeds of a shaft [rad/s], its acceleration at most [rad/s^2], forces on a piston [N], torque at most [N*m]
Extremes: TypeAlias = tuple[tuple[float, float], float, tuple[float, float], float]


def usual_case(mechanism: str) -> str:
    """The case whose numbers a mechanism is proven for, the last that has them all. Raises BadInput: there is none."""
    if is_file(mechanism) and (beside := usual(mechanism)):
        return beside
    for name in reversed([] if is_file(mechanism) else cases.names()):
        case = cases.load(name)
        wanted = ("spring",) if mechanism == GUIDES else listing(mechanism)["parameters"]
        there = case.sections if mechanism == GUIDES else vars(case.sections.get("parameters", object))
        if all(there.get(letter) is not None for letter in wanted):
            return name
    raise BadInput(f"{mechanism} has no case of its own; name one with --case")


def subjects_of(name: str, case: Case, given: Mapping[str, tuple[float, float]]) -> tuple[tuple[Subject, ...], str]:
    """The functions of a mechanism, or of the limits of guides, over the ranges of a case; and these ranges in words.

    given: ranges of letters of a mechanism in place of the case's [SI].
    """
    around = f"of {case.name} +-{100 * _SHARE:g} %"
    if name == GUIDES:
        choices = case.need("guide")
        wanted = balance(torque(machine(case)), choices.balance)
        sections = case.need("spring"), choices, case.need("rollers"), case.need("limits")
        kernel = design_kernel(wanted, *sections, ("guide.rho0",))
        return of_guides(kernel, _SHARE), f"numbers {around}, its torque around the turn"
    ranges = ranges_of(name, case)
    if unknown := sorted(set(given) - set(ranges)):
        raise BadInput(f"--range {unknown[0]}: {name} has no such letter; letters are {', '.join(ranges)}")
    own = "".join(f", {letter} = {low:g}..{high:g}" for letter, (low, high) in given.items())
    words = f"parameters {around}, a full turn of each angle, speeds and inputs within its extremes{own}"
    return of_mechanism(name, ranges | dict(given)), words


def ranges_of(mechanism: str, case: Case) -> Ranges:
    """Ranges of all letters of a mechanism [SI]: parameters at the case's values and 1 % to both sides."""
    known, module = listing(mechanism), generated(mechanism)
    values = {}
    for letter in module.PARAMETERS:
        value = getattr(case.need("parameters"), letter, None)
        if isinstance(value, tuple):  # of several throws the first
            value = value[0] if value else None
        if value is None:
            raise BadInput(f"{case.file}: no value for {letter}; name a case of this mechanism with --case")
        values[letter] = float(value)
    speed, acceleration, force, torque = extremes_of(case)
    length = 2 * max((abs(v) for letter, v in values.items() if known["parameters"][letter] == "m"), default=1.0)
    ranges: Ranges = {letter: widened(v, _SHARE) for letter, v in values.items()}
    for q, unit in known["coordinates"].items():
        by, far = (1.0, np.pi) if unit == "rad" else (length, length)
        ranges[q] = (-far, far)
        ranges[f"{q}d"] = (by * speed[0], by * speed[1])
        ranges[f"{q}dd"] = (-by * acceleration, by * acceleration)
    for name, unit in known["inputs"].items():
        ranges[name] = force if unit == "N" else (-torque, torque)
    return ranges


def extremes_of(case: Case) -> Extremes:
    """Speeds, forces and torques that a case reaches: over a turn, or in its run where it has no speed of operation."""
    if "operation" not in case.sections:
        # the extremes of a run in time: what the shaft is driven by is all that acts on it
        problem = problem_of(case)
        result = simulate(problem, Settings(check="none"))
        speeds = np.array([result.columns[name] for name in velocities(problem.mechanism)])
        values = [v for part in problem.parts if isinstance(part.value, Steps) for v in part.value.values]
        acceleration = float(np.abs(np.diff(speeds) / np.diff(result.t)).max())
        force = min(0.0, *values), max(0.0, *values)
        return (float(speeds.min()), float(speeds.max())), acceleration, force, max(0.0, *np.abs(values).tolist())
    engine = machine(case)
    torque = float(np.abs(shaft_torque(engine, "drive", _TURN)).max())
    forces = np.concatenate([np.zeros(1), *(f.value(_TURN) for f in acting(engine))])
    (q,) = engine.mechanism.coordinates
    inertia = float(evaluate(engine.mechanism, "dynamics", **{q: _TURN})["mass_matrix"].min())
    return (0.0, _FASTER * engine.omega), torque / inertia, (float(forces.min()), float(forces.max())), torque


@result
class ProvenMotion:
    """A motion enclosed: where every solution of the case's equations is, second by second."""

    subject: str = part()
    t: tuple[float, ...] = quantity("s")  #: Ends of the seconds
    lower: Columns = part()  #: No state is below at these times; doubles, half-widths are apart
    upper: Columns = part()  #: Nor above
    half_width: Columns = part()  #: Of each state around its midpoint
    least: Columns = part()  #: No state was below during the second before
    largest: Columns = part()  #: Nor above
    mean_least: Columns = part()  #: Mean of each velocity over the second before: not below
    mean_largest: Columns = part()  #: Nor above
    steps: int = quantity("-")  #: Of the enclosure
    bits: int = quantity("-")  #: Of its midpoints
    digits: float = quantity("-")  #: That were forecast to be needed
    statement: str = part()
    trusted: tuple[str, ...] = part()


_EACH = 4.5  # of a processor for a second of a start-up, whose steps grow with its speed [s]
_WIDTH = 1e-9  # that is asked for at the end, in the norm [-]
_TRUSTED = (
    "python-flint's balls",
    "the tape: it is the equations that the package derived, read once",
    "the parameters are the decimals that the case prints, each one number and no measured value with an error",
)


def motion_of(
    case: Case, t_end: float | None = None, out: Path | None = None, window: tuple[float, float] | None = None,
    progress: Callable[[int], object] = lambda _: None,
) -> ProvenMotion:  # fmt: skip
    """The motion of a case enclosed.

    t_end: in place of the case's [s]; out: folder in which the proof is kept, and goes on from; window: times that the
    statement is about [s]. Raises BadInput: it cannot be enclosed; the message names the force, or the digits that it
    would need.
    """
    require(case, "prove")
    problem = problem_of(case)
    symbols = {name: ca.SX.sym(name) for name in problem.mechanism.parameters}
    open_ = bind(case.mechanism, symbols)
    values = {name: float(v) for name, v in problem.mechanism.parameters.items()}
    # refuse a run whose mechanism is more than its declaration: a flywheel, the torque of a hinge
    plain = bind(case.mechanism, values)
    if plain.inputs != problem.mechanism.inputs:
        raise BadInput(f"{case.file}: [drive] or [spring] adds an input to {plain.name}; it cannot be enclosed with it")
    at = [0.3 + 0.1 * k for k in range(plain.functions["dynamics"].n_in())]
    pairs = zip(*(m.functions["dynamics"].call(at) for m in (plain, problem.mechanism)), strict=True)
    if any(np.abs(np.asarray(a - b)).max() > 0 for a, b in pairs):
        raise BadInput(f"{case.file}: a section adds inertia to {plain.name}; put it into the parameters to enclose it")
    task = task_of(problem, open_, values)
    until = t_end or problem.t_end
    needed = digits(task, until, _WIDTH)
    if needed > MOST:
        raise BadInput(
            f"{case.file}: to {until:g} s an enclosure of {_WIDTH:g} needs more than {MOST:g} digits: neighbours come "
            "apart too fast; give a shorter --t-end"
        )
    method = method_for(needed)
    budget.require(f"the motion over {until:g} s", _EACH * until, 0.0, "give a shorter --t-end")
    passed = enclose(task, method, Fraction(repr(float(until))), out, progress)
    states = (*problem.mechanism.coordinates, *velocities(problem.mechanism))
    return _told(case, problem, states, passed, (method, needed), window)


def _told(
    case: Case, problem: Problem, states: tuple[str, ...], passed: Sequence[Passed], by: tuple[EnclosureMethod, float],
    window: tuple[float, float] | None,
) -> ProvenMotion:  # fmt: skip
    units = dict(zip(states, problem.mechanism.state_units, strict=True))
    n = len(states) // 2
    ends = np.array([[(float(b.lower()), float(b.upper())) for b in p.at.balls] for p in passed])
    times, starts = np.array([float(p.at.t) for p in passed]), np.array([[q, q] for q in problem.q0])
    # over a second the mean of a velocity is the change of its coordinate by its length, doubles a hair outwards
    begins = np.array([problem.t_start, *times[:-1]])
    moved = ends[:, :n] - np.concatenate([starts[None], ends[:-1, :n]])[:, :, ::-1]
    means = moved / (times - begins)[:, None, None] + [-1e-11, 1e-11]

    def columns(values: np.ndarray, names: Sequence[str] = states) -> Columns:
        return Columns({k: tuple(v) for k, v in zip(names, np.transpose(values).tolist(), strict=True)}, units)

    low, high = np.array([p.low for p in passed]), np.array([p.high for p in passed])
    speeds = tuple(f"{q}d" for q in states[:n])
    inside = (
        times > problem.t_start if window is None else (times >= window[0] + 1 - 1e-9) & (times <= window[1] + 1e-9)
    )
    if not inside.any():
        raise BadInput(f"--window {window}: no whole second lies in it; they end at {times[0]:g} to {times[-1]:g} s")
    mean = means[inside, 0, 0].min(), means[inside, 0, 1].max()
    of_all = low[inside, n].min(), high[inside, n].max()
    startup = case.sections.get("startup")
    claim, since = getattr(startup, "claim_speed", None), getattr(startup, "claim_time", None) or 0.0
    never = claim is not None and times[inside][-1] >= since and not mean[0] <= claim <= mean[1]

    def between(low: float, high: float) -> str:
        return f"[{outward(low, 6, False)}, {outward(high, 6)}]"

    statement = (
        f"with the decimals of {case.name} every solution has {speeds[0]} within {between(*of_all)} "
        f"{units[speeds[0]]} from {begins[inside][0]:g} to {times[inside][-1]:g} s, its mean over each second in "
        f"{between(*mean)}{f': never in steady motion at {claim:g}' if never else ''}; at "
        f"{times[-1]:g} s the state is known to +-{outward(max(passed[-1].at.half_widths[:n]), 2)} in its coordinates"
    )
    return ProvenMotion(
        subject=case.name, t=tuple(times.tolist()), lower=columns(ends[:, :, 0]), upper=columns(ends[:, :, 1]),
        half_width=columns(np.array([p.at.half_widths for p in passed])), least=columns(low), largest=columns(high),
        mean_least=columns(means[:, :, 0], speeds), mean_largest=columns(means[:, :, 1], speeds),
        steps=passed[-1].steps, bits=by[0].bits, digits=by[1], statement=statement, trusted=_TRUSTED,
    )  # fmt: skip

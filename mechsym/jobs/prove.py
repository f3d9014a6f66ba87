"""`mechsym prove`: a mechanism, or the limits of guides -> what their machine code can lose to rounding."""

from collections.abc import Callable, Mapping

import numpy as np

from mechsym.cases import Case
from mechsym.cases.numbers import usual
from mechsym.errors import BadInput
from mechsym.hinge.balance import balance
from mechsym.hinge.kernel import design_kernel
from mechsym.hinge.torque import torque
from mechsym.jobs.machine import machine
from mechsym.jobs.problem import problem_of
from mechsym.machine.record import acting, shaft_torque
from mechsym.mechanisms.record import evaluate, generated, listing, velocities
from mechsym.proof.outputs import ProvenRounding, of_guides, of_mechanism, rounding, units_of, widened
from mechsym.quantities import record
from mechsym.simulate import Settings, simulate
from mechsym.simulate.problem import Steps

_SHARE = 0.01  # of a parameter's value, to both sides
_SHARE_OF_GUIDES = 0.001  # beyond it balls do not see that the kernel's Newton steps come to an end
GUIDES = "hinge"  #: What stands for the limits of guides among the names of mechanisms
_FASTER = 1.1  # highest speed by that of operation
#: Cases that give numbers to mechanisms that have none of their own
_OF_OTHERS = {GUIDES: "zotov-89", "crank_throw": "opposed-pistons", "crankshaft_flywheel_printed": "chmielewski", 
              "rodless_constraints": "balandin", "crosshead": "zotov-89"}  # fmt: skip
_TURN = np.arange(1440) * 4 * np.pi / 1440

Ranges = dict[str, tuple[float, float]]


@record
class Extremes:
    """What a machine reaches in operation."""

    speed: tuple[float, float]  #: [rad/s]
    acceleration: float  #: Of the shaft [rad/s^2]
    force: tuple[float, float]  #: On a piston [N]
    torque: float  #: On the shaft [N*m]


def usual_case(mechanism: str) -> str:
    """The case whose numbers a mechanism is proven for.

    Raises BadInput: there is none.
    """
    found = _OF_OTHERS.get(mechanism) or usual(mechanism)
    if not found:
        raise BadInput(f"{mechanism} has no case of its own; name one with --case")
    return found


def of_mechanism_at(
    mechanism: str,
    case: Case,
    given: Mapping[str, tuple[float, float]],
    samples: int,
    progress: Callable[[int], object] = lambda _: None,
) -> ProvenRounding:
    """The rounding of a mechanism's functions over the ranges of a case.

    given: ranges of letters in place of the case's [SI].
    """
    ranges = ranges_of(mechanism, case)
    if unknown := sorted(set(given) - set(ranges)):
        raise BadInput(f"--range {unknown[0]}: {mechanism} has no such letter; letters are {', '.join(ranges)}")
    words = (
        f"parameters of {case.name} +-{100 * _SHARE:g} %, a full turn of each angle, speeds and inputs within its "
        f"extremes{''.join(f', {k} = {low:g}..{high:g}' for k, (low, high) in given.items())}"
    )
    subjects = of_mechanism(mechanism, ranges | dict(given))
    return rounding(mechanism, subjects, units_of(mechanism), samples, words, progress)


def of_guides_at(case: Case, samples: int, progress: Callable[[int], object] = lambda _: None) -> ProvenRounding:
    """The rounding of the limits of guides of a case, as maps of guides compute them."""
    choices = case.need("guide")
    wanted = balance(torque(machine(case)), choices.balance)
    sections = case.need("spring"), choices, case.need("rollers"), case.need("limits")
    kernel = design_kernel(wanted, *sections, ("guide.rho0",))
    words = f"numbers of {case.name} +-{100 * _SHARE_OF_GUIDES:g} %, its torque around the turn"
    return rounding(GUIDES, of_guides(kernel, _SHARE_OF_GUIDES), {}, samples, words, progress)


def ranges_of(mechanism: str, case: Case) -> Ranges:
    """Ranges of all letters of a mechanism [SI]: parameters at the case's values and 1 % to both sides."""
    known, module = listing(mechanism), generated(mechanism)
    values = {letter: _number(case, letter) for letter in module.PARAMETERS}
    extremes = extremes_of(case)
    length = 2 * max((abs(v) for letter, v in values.items() if known["parameters"][letter] == "m"), default=1.0)
    ranges: Ranges = {letter: widened(v, _SHARE) for letter, v in values.items()}
    for q, unit in known["coordinates"].items():
        by = 1.0 if unit == "rad" else length
        ranges[q] = (-np.pi, np.pi) if unit == "rad" else (-length, length)
        ranges[f"{q}d"] = (by * extremes.speed[0], by * extremes.speed[1])
        ranges[f"{q}dd"] = (-by * extremes.acceleration, by * extremes.acceleration)
    for name, unit in known["inputs"].items():
        ranges[name] = extremes.force if unit == "N" else (-extremes.torque, extremes.torque)
    return ranges


def _number(case: Case, letter: str) -> float:
    value = getattr(case.need("parameters"), letter, None)
    if isinstance(value, tuple):  # of several throws the first
        value = value[0] if value else None
    if value is None:
        raise BadInput(f"{case.file}: no value for {letter}; name a case of this mechanism with --case")
    return float(value)


def extremes_of(case: Case) -> Extremes:
    """Speeds, forces and torques that a case reaches: over a turn, or in its run where it has no speed of operation."""
    if "operation" not in case.sections:
        return _of_run(case)
    engine = machine(case)
    torque = float(np.abs(shaft_torque(engine, "drive", _TURN)).max())
    forces = np.concatenate([np.zeros(1), *(f.value(_TURN) for f in acting(engine))])
    (q,) = engine.mechanism.coordinates
    inertia = float(evaluate(engine.mechanism, "dynamics", **{q: _TURN})["mass_matrix"].min())
    return Extremes(
        speed=(0.0, _FASTER * engine.omega),
        acceleration=torque / inertia,
        force=(float(forces.min()), float(forces.max())),
        torque=torque,
    )


def _of_run(case: Case) -> Extremes:
    """The extremes of a run in time: what the shaft is driven by is all that acts on it."""
    problem = problem_of(case)
    result = simulate(problem, Settings(check="none"))
    speeds = np.array([result.columns[name] for name in velocities(problem.mechanism)])
    values = [v for part in problem.parts if isinstance(part.value, Steps) for v in part.value.values]
    return Extremes(
        speed=(float(speeds.min()), float(speeds.max())),
        acceleration=float(np.abs(np.diff(speeds) / np.diff(result.t)).max()),
        force=(min(0.0, *values), max(0.0, *values)),
        torque=max(0.0, *np.abs(values).tolist()),
    )

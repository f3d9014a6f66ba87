"""Many runs of a case over ranges of its values, or over samples of them.

What runs is what the case is for: a driven machine is simulated (all points side by side, see `simulate.many`), an
engine with a spring gets its hinge designed, an engine without one runs its cycle. A point that cannot be computed is
a gap with a reason, not the end of the sweep. `sweep_data` makes one labelled data set of it.
"""

import dataclasses
import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from mechsym import cases
from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.sweep_axes import Axis, override, points

Progress = Callable[[int], Any]
Outcome = dict[str, Any] | BadInput
ANALYSES = ("simulate", "hinge", "cycle")


@dataclasses.dataclass(frozen=True, kw_only=True)
class Sweep:
    """What came out at every point.

    Parameters
    ----------
    case, analysis : str
        What ran
    axes : tuple of Axis
        What it ran over
    dims : mapping of str to int
        Dimensions in order
    points : tuple of tuple
        Values of the axes at each point, the last axis fastest
    outcomes : tuple of dict or BadInput
        Nested results of each point, or why there are none
    """

    case: str
    analysis: str
    axes: tuple[Axis, ...]
    dims: Mapping[str, int]
    points: tuple[tuple[Any, ...], ...]
    outcomes: tuple[Outcome, ...]


@dataclasses.dataclass(frozen=True, kw_only=True)
class Plan:
    """What is to be swept.

    Parameters
    ----------
    case : str
        Name of a built-in case or path of a file
    axes : tuple of Axis
        What to run over
    overrides : mapping of str to str
        Values that hold at all points
    analysis : str or None
        `simulate`, `hinge` or `cycle`; None takes what the case is for
    samples : int or None
        Number of samples instead of a grid
    seed : int
        Of the samples
    """

    case: str
    axes: tuple[Axis, ...]
    overrides: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    analysis: str | None = None
    samples: int | None = None
    seed: int = 0

    def __post_init__(self) -> None:
        if self.analysis not in (None, *ANALYSES):
            raise BadInput(f"analysis = {self.analysis!r} is not an option; options are {', '.join(ANALYSES)}")


def sweep(plan: Plan, progress: Progress = lambda done: None) -> Sweep:
    """Run a case at every point.

    Parameters
    ----------
    plan : Plan
        What to run
    progress : callable
        Called with the number of points that were done

    Returns
    -------
    sweep : Sweep
        Outcomes of all points

    Raises
    ------
    BadInput
        The case itself is bad, an axis is, or no point can be loaded
    """
    dims, values = points(plan.axes, plan.samples, plan.seed)
    base = cases.load(plan.case, plan.overrides)
    analysis = plan.analysis or _meant(base)
    outcomes: list[Any] = [_loaded(plan, v) for v in values]
    runnable = [i for i, c in enumerate(outcomes) if isinstance(c, Case)]
    if not runnable:
        # a mistake in a key or a unit spoils every point: that is bad input, not a gap
        raise outcomes[0]
    progress(len(values) - len(runnable))
    run = {"simulate": _simulated, "hinge": _hinged, "cycle": _cycled}[analysis]
    for i, outcome in zip(runnable, run([outcomes[i] for i in runnable], progress), strict=True):
        outcomes[i] = outcome
    return Sweep(
        case=base.name, analysis=analysis, axes=plan.axes, dims=dims, points=tuple(values), outcomes=tuple(outcomes)
    )


def _loaded(plan: Plan, values: tuple[Any, ...]) -> Case | BadInput:
    here = {a.key: override(a, v) for a, v in zip(plan.axes, values, strict=True)}
    try:
        return cases.load(plan.case, {**plan.overrides, **here})
    except BadInput as error:
        return error


def _meant(case: Case) -> str:
    if "drive" in case.sections:
        return "simulate"
    if {"spring", "guide"} <= set(case.sections):
        return "hinge"
    if "cycle" in case.sections:
        return "cycle"
    raise BadInput(f"{case.file}: has neither [drive] nor [cycle]; nothing to run at the points of a sweep")


def _simulated(found: Sequence[Case], progress: Progress) -> list[Outcome]:
    from mechsym.runs import problem_of, settings_of, window_of
    from mechsym.simulate import simulate_many
    from mechsym.simulate.summary import summary

    problems = _threaded(found, lambda case: {"problem": problem_of(case)}, lambda done: None)
    outcomes: dict[int, Outcome] = {i: p for i, p in enumerate(problems) if isinstance(p, BadInput)}
    progress(len(outcomes))
    groups: dict[Any, list[int]] = {}
    for i in (i for i in range(len(found)) if i not in outcomes):
        groups.setdefault(settings_of(found[i]), []).append(i)
    for settings, members in groups.items():
        chosen = [problems[i]["problem"] for i in members]  # type: ignore[index]
        for i, problem, result in zip(members, chosen, simulate_many(chosen, settings), strict=True):
            outcomes[i] = summary(result, problem.mechanism.coordinates, window_of(found[i], problem))
        progress(len(members))
    return [outcomes[i] for i in range(len(found))]


def _hinged(found: Sequence[Case], progress: Progress) -> list[Outcome]:
    from mechsym.design import design
    from mechsym.summary import summary

    return _threaded(found, lambda case: summary(design(case)), progress)


def _cycled(found: Sequence[Case], progress: Progress) -> list[Outcome]:
    from mechsym.cycle import columns, engine, over_speeds
    from mechsym.engine.spark_ignition import SparkIgnition
    from mechsym.forces.gas import one_cylinder
    from mechsym.two_stroke_cycle import two_stroke_columns

    def one(case: Case) -> dict[str, Any]:
        omega = np.array([case.need("operation").speed])
        if isinstance(case.need("cycle"), SparkIgnition):
            return columns(over_speeds(engine(one_cylinder(case)), omega))
        return two_stroke_columns(case, omega)

    return _threaded(found, one, progress)


def _threaded(found: Sequence[Case], one: Callable[[Case], dict[str, Any]], progress: Progress) -> list[Outcome]:
    def guarded(case: Case) -> Outcome:
        try:
            return one(case)
        except BadInput as error:
            return error

    outcomes = []
    with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        for outcome in pool.map(guarded, found):
            outcomes.append(outcome)
            progress(1)
    return outcomes

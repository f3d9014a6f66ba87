"""How the points of a sweep are computed: a driven machine is simulated, an engine gets its hinge or runs its cycle."""

import functools
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from mechsym.cases import Case
from mechsym.cases.facts import facts_of
from mechsym.cases.needs import meant, require
from mechsym.mechanisms.shaft import elastic
from mechsym.quantities import record
from mechsym.sweep import cycles, guides, hinges, outcomes
from mechsym.sweep.axes import Value
from mechsym.sweep.outcomes import ARITHMETIC, Gap, Outcome, guarded, known

if TYPE_CHECKING:
    from mechsym.simulate.problem import Problem
    from mechsym.simulate.result import Result, RunNumbers
    from mechsym.simulate.settings import Settings

ANALYSES = ("simulate", "hinge", "guides", "cycle", "forces", "size", "codesign")
_SCIPY = ("scipy.interpolate", "scipy.optimize")
#: What the points of an analysis read of the program; workers begin with it
READS = {
    "simulate": (
        "mechsym.jobs.run",
        "mechsym.jobs.problem",
        "mechsym.simulate.many",
        "mechsym.torsion.twist",
        *_SCIPY,
    ),
    "hinge": ("mechsym.hinge.side_by_side", "mechsym.hinge.summary", "mechsym.jobs.hinge", *_SCIPY),
    "guides": ("mechsym.hinge.kernel", "mechsym.hinge.limits", "mechsym.jobs.machine", *_SCIPY),
    "cycle": ("mechsym.cycle.closed.run", "mechsym.jobs.cycle", *_SCIPY),
    "forces": ("mechsym.forces.summary", "mechsym.jobs.forces", *_SCIPY),
    "size": ("mechsym.jobs.size", *_SCIPY),
    "codesign": ("mechsym.codesign.result", "mechsym.jobs.codesign", *_SCIPY),
}
# what one point takes, roughly [s]
_SINGLES = {"forces": (outcomes.forces, 0.5), "size": (outcomes.size, 2.0), "codesign": (outcomes.codesign, 10.0)}
# verdicts on a run whose numbers cannot be trusted
_BAD = ("failed", "not converged", "chaotic")
_LANES = 16  # runs that the compiled integrator takes side by side


@record
class Route:
    """How points are computed."""

    analysis: str
    run: Callable[[Sequence[Case]], list[Outcome]]  #: Cases to outcomes, in the same order
    together: int  #: Most cases in one call; an interrupt loses one call
    seconds: float  #: What one takes, roughly [s]
    #: In place of `run`, where cases need not be read one by one: case, overrides and values of the axes to outcomes,
    #: each of numbers by dotted names already
    at: Callable[[str, Mapping[str, object], Sequence[Mapping[str, Value]]], list[Outcome]] | None = None


def route(case: Case, analysis: str | None, show: tuple[str, ...] = ()) -> Route:
    """The fastest safe way to compute points like a case.

    analysis: a name of `ANALYSES`; None takes what the case is for. show: results that are wanted; others need not be
    computed. Returns route: function, and the size of its calls.
    """
    if analysis is None:
        require(case, "sweep")
        analysis = meant(facts_of(case.mechanism, case.sections))
    if analysis == "simulate":
        # one block of lanes: what runs beside a point is the same on any machine
        return Route(analysis=analysis, run=_simulated, together=_LANES, seconds=0.03)
    if analysis == "hinge":
        return _hinges(show)
    if analysis == "guides":
        run = _each(lambda case: {})
        return Route(analysis=analysis, run=run, together=guides.BLOCK, seconds=0.0001, at=guides.guides)
    if analysis in _SINGLES:
        single, seconds = _SINGLES[analysis]
        return Route(analysis=analysis, run=_each(single), together=1, seconds=seconds)
    if cycles.mapped(case):
        return Route(analysis=analysis, run=_maps, together=cycles.BLOCK, seconds=0.002)
    return Route(analysis=analysis, run=_each(cycles.single), together=1, seconds=0.01)


def _hinges(show: tuple[str, ...]) -> Route:
    if show:
        hinges.check_keys(show)
        if hinges.runs(show):
            return Route(analysis="hinge", run=_each(hinges.designed(show)), together=1, seconds=0.5)
    return Route(analysis="hinge", run=lambda found: hinges.judged(found, show), together=hinges.BLOCK, seconds=0.002)


def _each(one: Callable[[Case], object]) -> Callable[[Sequence[Case]], list[Outcome]]:
    return lambda found: [guarded(one, case) for case in found]


def _maps(found: Sequence[Case]) -> list[Outcome]:
    results: dict[int, Outcome] = {}
    for members in cycles.families(found):
        results |= dict(zip(members, _bisected([found[i] for i in members]), strict=True))
    return [results[i] for i in range(len(found))]


def _bisected(family: list[Case]) -> list[Outcome]:
    """A map refuses all of its points where one is impossible: halves find out which."""
    try:
        return list(cycles.map_of(family))
    except ARITHMETIC as error:
        if len(family) == 1:
            return [known(error)]
    middle = len(family) // 2
    return _bisected(family[:middle]) + _bisected(family[middle:])


def _simulated(found: Sequence[Case]) -> list[Outcome]:
    from mechsym.cases.settings import settings_of
    from mechsym.jobs.problem import problem_of
    from mechsym.jobs.run import in_loop
    from mechsym.simulate import simulate, simulate_many
    from mechsym.simulate.constrained import LOCKED

    looped = [i for i, case in enumerate(found) if in_loop(case)]
    problems = {i: guarded(problem_of, case) for i, case in enumerate(found) if i not in looped}
    results: dict[int, Outcome] = {i: p for i, p in problems.items() if isinstance(p, Gap)}
    results |= {i: guarded(_by_itself, found[i]) for i in looped}
    groups: dict[Settings, list[int]] = {}
    for i in (i for i in problems if i not in results):
        groups.setdefault(settings_of(found[i]), []).append(i)
    for settings, members in groups.items():
        own = [problems[i] for i in members]
        try:
            runs = simulate_many(own, settings)
        except ARITHMETIC:  # one of them upset the others
            runs = [guarded(functools.partial(simulate, settings=settings), problem) for problem in own]
        for i, result in zip(members, runs, strict=True):
            if isinstance(result, Gap):
                results[i] = result
                continue
            ends = "sides" in problems[i].mechanism.functions and (result.end == LOCKED or result.status in _BAD)
            results[i] = guarded(_by_itself, found[i]) if ends else _verdict(found[i], problems[i], result)
    return [results[i] for i in range(len(found))]


def _by_itself(case: Case) -> Outcome:
    """One point whose gas is integrated with the motion, or that passes a dead point of its closed forms."""
    from mechsym.cases.settings import settings_of
    from mechsym.jobs.run import run_of

    return _told(case, *run_of(case, settings_of(case))[:2])


def _verdict(case: Case, problem: "Problem", result: "Result") -> Outcome:
    from mechsym.jobs.problem import window_of
    from mechsym.simulate.problem import period_of
    from mechsym.simulate.result import summary

    coordinates = problem.mechanism.coordinates
    return _told(case, result, summary(result, coordinates, window_of(case, problem), period_of(problem)))


def _told(case: Case, result: "Result", numbers: "RunNumbers") -> Outcome:
    if result.status in _BAD:
        return Gap(reason=f"{result.status}: {result.reason}")
    return outcomes.swept(elastic(case.mechanism, case.need("parameters")), result, numbers)

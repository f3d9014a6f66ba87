"""How the points of a sweep are computed: a driven machine is simulated, an engine gets its hinge or runs its cycle."""

import dataclasses
import functools
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechsym.cases import Case
from mechsym.cases.facts import facts_of
from mechsym.cases.needs import meant, require
from mechsym.cycle.columns import UNITS
from mechsym.cycle.kinds import kind_of
from mechsym.files import Json
from mechsym.mechanisms.shaft import elastic
from mechsym.quantities import record
from mechsym.quantities.records import Record
from mechsym.quantities.results import Columns
from mechsym.quantities.units import Scalar
from mechsym.sweep import hinges, outcomes
from mechsym.sweep.axes import Value
from mechsym.sweep.outcomes import ARITHMETIC, Gap, Outcome, guarded, known

if TYPE_CHECKING:
    from mechsym.simulate.problem import Problem
    from mechsym.simulate.result import Result, RunNumbers
    from mechsym.simulate.settings import Settings

_CYCLES = 500  # cycles in one map: enough to hide the making of its function, few enough for the progress to move
_SECTIONS = ("parameters", "chamber", "cycle", "gas", "heat_transfer", "friction_pressure")


def single(case: Case) -> Columns:
    """Figures of one cycle of the engine, each with one value."""
    from mechsym.jobs.cycle import cycle

    return _of_the_engine(cycle(case))


def _of_the_engine(result: Mapping[str, object]) -> Columns:
    inner = ("cylinders", "each", "per_cylinder", "pistons")
    return Columns({name: values for name, values in result.items() if name not in inner}, UNITS)


def families(cases: Sequence[Case]) -> list[list[int]]:
    """Cases that one map may hold: all but numbers of the engine and the speed are equal."""
    families: dict[object, list[int]] = {}
    for i, case in enumerate(cases):
        from mechsym.cycle.friction import MechanismFriction

        friction, cycle = case.sections.get("friction_pressure"), case.need("cycle")
        # the law is fitted around the speed of operation, so another speed is another engine
        fitted = case.need("operation").speed if isinstance(friction, MechanismFriction) else None
        records = [case.sections.get(name) for name in _SECTIONS]
        if fitted is not None:
            records += [case.sections.get("friction"), case.sections.get("rings")]
        alone = fitted is not None or getattr(cycle, "method", None) == "nunes2017_printed"
        families.setdefault(
            (case.mechanism, fitted, tuple(_text(record, numbers=alone) for record in records)), []
        ).append(i)
    return list(families.values())


def _text(record: Record | None, numbers: bool) -> str:
    """A record without the numbers that a map may vary, as a text to compare."""
    if record is None:
        return ""
    values = {f.name: getattr(record, f.name) for f in dataclasses.fields(record)}
    return repr((type(record), {k: v for k, v in values.items() if numbers or not isinstance(v, float)}))


def map_of(family: Sequence[Case]) -> list[Outcome]:
    """Figures of one family, each with the steps that it would take alone.

    Returns figures: as `mechsym.jobs.cycle` of the engine, each with one value; a gap where there is no cycle.
    """
    from mechsym.cycle.closed.model import closed_period
    from mechsym.cycle.closed.run import steps_needed
    from mechsym.cycle.engine import columns, over_design
    from mechsym.jobs.cycle import engine, of_engine
    from mechsym.jobs.gas import one_cylinder

    seen = [one_cylinder(case) for case in family]
    design = {"omega": np.array([case.need("operation").speed for case in seen])} | _varied(seen)
    machine = engine(seen[0])
    steps, reasons = np.ones(design["omega"].size, dtype=int), dict[int, str]()
    if machine.cycle.method != "nunes2017_printed":
        steps, reasons = steps_needed(functools.partial(closed_period, machine), design)
    outcomes: dict[int, Outcome] = {i: Gap(reason=reason, of_input=True) for i, reason in reasons.items()}
    for group in (np.flatnonzero(steps == count) for count in set(steps[steps > 0])):
        figures = columns(over_design(machine, {name: values[group] for name, values in design.items()}))
        for k, i in enumerate(group.tolist()):
            outcomes[i] = _of_the_engine(of_engine(family[i], _at(figures, k), design["omega"][[i]]))
    return [outcomes[i] for i in range(len(family))]


def _varied(seen: Sequence[Case]) -> dict[str, np.ndarray]:
    """Numbers of the engine that are not the same in all cases."""
    varied = {}
    for section in _SECTIONS:
        first = seen[0].sections.get(section)
        for field in dataclasses.fields(first) if first is not None else ():
            values = [getattr(case.sections[section], field.name) for case in seen]
            if isinstance(values[0], float) and len(set(values)) > 1:
                varied[f"{section}.{field.name}"] = np.array(values)
    return varied


def _at(columns: Mapping[str, Scalar], index: int) -> Json:
    return {
        name: _at(values, index) if isinstance(values, Mapping) else float(values[index])
        for name, values in columns.items()
    }


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
    at: Callable[[str, Mapping[str, object], Sequence[Mapping[str, Value]]], outcomes.Outcomes] | None = None


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
        if show:
            hinges.check_keys(show)
            if hinges.runs(show):
                return Route(analysis="hinge", run=_each(hinges.designed(show)), together=1, seconds=0.5)
        return Route(
            analysis="hinge", run=lambda loaded: hinges.judged(loaded, show), together=hinges.BLOCK, seconds=0.002
        )
    if analysis == "guides":
        run = _each(lambda case: {})
        return Route(analysis=analysis, run=run, together=hinges.MANY, seconds=0.0001, at=hinges.guides)
    if analysis in _SINGLES:
        one, seconds = _SINGLES[analysis]
        return Route(analysis=analysis, run=_each(one), together=1, seconds=seconds)
    if kind_of(case.need("cycle")).closed:
        return Route(analysis=analysis, run=_maps, together=_CYCLES, seconds=0.002)
    return Route(analysis=analysis, run=_each(single), together=1, seconds=0.01)


def _each(one: Callable[[Case], object]) -> Callable[[Sequence[Case]], list[Outcome]]:
    return lambda loaded: [guarded(one, case) for case in loaded]


def _maps(cases: Sequence[Case]) -> list[Outcome]:
    results: dict[int, Outcome] = {}
    for members in families(cases):
        results |= dict(zip(members, _bisected([cases[i] for i in members]), strict=True))
    return [results[i] for i in range(len(cases))]


def _bisected(family: list[Case]) -> list[Outcome]:
    """A map refuses all of its points where one is impossible: halves find out which."""
    try:
        return list(map_of(family))
    except ARITHMETIC as error:
        if len(family) == 1:
            return [known(error)]
    middle = len(family) // 2
    return _bisected(family[:middle]) + _bisected(family[middle:])


def _simulated(cases: Sequence[Case]) -> list[Outcome]:
    from mechsym.cases.settings import settings_of
    from mechsym.jobs.problem import problem_of
    from mechsym.jobs.run import in_loop
    from mechsym.simulate import simulate, simulate_many
    from mechsym.simulate.constrained import LOCKED

    looped = [i for i, case in enumerate(cases) if in_loop(case)]
    one = functools.partial(problem_of, kept={})
    problems = {i: guarded(one, case) for i, case in enumerate(cases) if i not in looped}
    results: dict[int, Outcome] = {i: p for i, p in problems.items() if isinstance(p, Gap)}
    results |= {i: guarded(_by_itself, cases[i]) for i in looped}
    groups: dict[Settings, list[int]] = {}
    for i in (i for i in problems if i not in results):
        groups.setdefault(settings_of(cases[i]), []).append(i)
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
            results[i] = guarded(_by_itself, cases[i]) if ends else _verdict(cases[i], problems[i], result)
    return [results[i] for i in range(len(cases))]


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
    from mechsym.jobs.run import outputs_of

    if result.status in _BAD:
        return Gap(reason=f"{result.status}: {result.reason}")
    shaft = elastic(case.mechanism, case.need("parameters"))
    return outcomes.swept(shaft, result, numbers, outputs_of(case, result)[1])

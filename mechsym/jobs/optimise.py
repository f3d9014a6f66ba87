"""Case -> optimum: the design problem of `[optimise]`, solved once, and against a second aim where one is named."""

import dataclasses
import itertools
from collections.abc import Mapping
from typing import Any

from mechsym.cases import Case, load
from mechsym.cycle.kinds import kind_of
from mechsym.jobs.cycle import engine
from mechsym.jobs.optimise_figures import programme
from mechsym.optimise.problem import Optimise, design_units, figure_units, problem
from mechsym.optimise.search import search
from mechsym.optimise.solver import Optimum, pareto, solve
from mechsym.page import Shown
from mechsym.quantities import record


@record
class Optimised(Shown):
    """The best design, and the front against the second aim."""

    best: Optimum
    front: tuple[Optimum, ...] = ()  #: Empty where no second aim is named; its first point is the best design
    #: Words of the best design, and what each combination gives: words, status, objective, variables
    chosen: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    choices: tuple[dict[str, Any], ...] = ()
    units: Mapping[str, str] = dataclasses.field(default_factory=dict)  #: SI units of variables and figures


_LIMITS = {"peak_pressure": "p_max", "peak_temperature": "t_max", "knock": "knock"}


def _asked(case: Case) -> dict[str, Any]:
    """Limits of `[gas_limits]`, as `[optimise.constraints]` would name them."""
    limits = case.sections.get("gas_limits")
    known = {figure: getattr(limits, key, None) for key, figure in _LIMITS.items()}
    return {figure: {"high": value} for figure, value in known.items() if value is not None}


def optimise(case: Case) -> Optimised:
    """Best design of a case under its limits.

    Parameters
    ----------
    case : Case
        With `[optimise]` and a cycle; of spark ignition it is solved with exact derivatives, of other kinds one design
        at a time

    Returns
    -------
    found : Optimised
        Status, variables, active limits and multipliers
    """
    section: Optimise = case.need("optimise")
    if not section.choices:
        return _one(case)
    tried = []
    for words in itertools.product(*section.choices.values()):
        chosen = dict(zip(section.choices, words, strict=True))
        tried.append((chosen, _one(load(case.path, {**case.overrides, **chosen}))))
    sign = 1.0 if section.goal == "maximise" else -1.0
    chosen, best = max(tried, key=lambda pair: (pair[1].best.status == "optimal", sign * pair[1].best.objective))
    rows = tuple(
        {**words, "status": found.best.status, "objective": found.best.objective, "variables": found.best.variables}
        for words, found in tried
    )
    return dataclasses.replace(best, chosen=chosen, choices=rows)


def _one(case: Case) -> Optimised:
    if kind_of(case.need("cycle")).given != "engine":
        return _by_figures(case)
    machine = engine(case)
    section: Optimise = case.need("optimise")
    section = dataclasses.replace(section, constraints=_asked(case) | section.constraints)
    units = figure_units(machine) | design_units(machine)
    task = problem(machine, case.need("operation").speed, section)
    if not section.against:
        return Optimised(best=solve(task), units=units)
    front = pareto(task, section.against, section.against_goal, int(section.points))
    return Optimised(best=front[0], front=tuple(front), units=units)


def _by_figures(case: Case) -> Optimised:
    section: Optimise = case.need("optimise")
    task = programme(case, section, _asked(case))
    units = {**task.units, **{v.name: v.unit for v in task.variables}}
    if not section.against:
        return Optimised(best=search(task), units=units)
    front = pareto(task, section.against, section.against_goal, int(section.points), search)
    return Optimised(best=front[0], front=tuple(front), units=units)

"""Case -> optimum: the design problem of `[optimise]`, solved once, and against a second aim where one is named."""

import dataclasses
import itertools
import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from mechsym import budget
from mechsym.cases import Case, load, locate
from mechsym.cases.needs import require
from mechsym.cycle.columns import UNITS
from mechsym.cycle.kinds import kind_of
from mechsym.errors import BadInput, suggest
from mechsym.files import Json
from mechsym.jobs.cycle import cycle, engine
from mechsym.mechanisms import roles_of
from mechsym.optimise.search import FigureProgramme, search
from mechsym.optimise.solver import (
    SIGN,
    Limit,
    Optimise,
    Optimised,
    Optimum,
    ParetoPoint,
    Task,
    TriedWords,
    limit_of,
    pareto,
    problem,
    solve,
)
from mechsym.quantities.display import without_unit
from mechsym.quantities.results import Columns

_SECONDS = 5.0  # that the best design takes by its gradient, of a processor: measured 1 to 2 s [s]
# SI unit and size of what the columns of `mechsym cycle` are in
_SI = {
    "g/(kW*h)": ("kg/J", 1 / 3.6e9),
    "kg/h": ("kg/s", 1 / 3600),
    "deg": ("rad", math.pi / 180),
    "kW": ("W", 1e3),
    "MPa": ("Pa", 1e6),
    "kPa": ("Pa", 1e3),
}
_NO_FIGURES = ("speed_rpm", "cylinders", "each", "energy_residual", "mass_residual")


def programme(case: Case, section: Optimise, asked: Mapping[str, Json]) -> FigureProgramme:
    """The design problem of a case.

    case: with `[cycle]` of any kind that `mechsym cycle` computes. section: variables are dotted names of the case's
    numbers; of a list the number of the value comes behind it, from 1. asked: mapping of str to dict, limits of the
    case besides; those on figures that this cycle has not are none. Raises BadInput: a name is none, or a limit leaves
    no room.
    """
    variables = tuple(_variable(case, name, spec) for name, spec in section.variables.items())
    names = [v.name for v in variables]
    start = np.array([_value(case, name) for name in names])
    units = {name: unit for name, (_, unit) in _figures(case).items()}
    section.require(units)
    limits = {name: limit for name, limit in asked.items() if name in units} | section.constraints

    def at(values: np.ndarray) -> dict[str, float]:
        settings = _settings(case, dict(zip(names, values.tolist(), strict=True)))
        return figures(load(case.path, {**case.overrides, **settings}))

    return FigureProgramme(
        figures=at, start=start, noise=kind_of(case.need("cycle")).noise, units=units, objective=section.objective,
        sign=SIGN[section.goal], variables=variables,
        constraints=tuple(limit_of("constraints", n, spec, units) for n, spec in limits.items()),
    )  # fmt: skip


def figures(case: Case) -> dict[str, float]:
    """Figures of a case at its speed, under their plain names [SI]."""
    return {name: value for name, (value, _) in _figures(case).items()}


def _figures(case: Case) -> dict[str, tuple[float, str]]:
    """Figures with their SI units; of two columns of one name the first."""
    quantities: dict[str, tuple[float, str]] = {}
    for column, values in cycle(case).items():
        if isinstance(values, Mapping) or column in _NO_FIGURES or np.ndim(values) != 1:
            continue
        unit, size = _SI.get(UNITS[column], (UNITS[column], 1.0))
        value = float(values[0]) * size
        if math.isfinite(value):
            quantities.setdefault(without_unit(column, UNITS[column]), (value, unit))
    return quantities


def _settings(case: Case, values: Mapping[str, float]) -> dict[str, float | list[float]]:
    """Overrides of a case; numbers of one list come together."""
    chosen: Json = {}
    for name, value in values.items():
        key, number = _split(name)
        if number is None:
            chosen[key] = value
        else:
            chosen.setdefault(key, list(_written(case, key)))[number] = value
    return chosen


def _split(name: str) -> tuple[str, int | None]:
    """Dotted key of a section's value, and the place of the number in it where one is named."""
    stem, _, end = name.rpartition(".")
    return (stem, int(end) - 1) if end.isdigit() and "." in stem else (name, None)


def _written(case: Case, key: str) -> Any:
    section, _, field = key.partition(".")
    return getattr(case.need(section), field, None)


def _value(case: Case, name: str) -> float:
    key, number = _split(name)
    value = _written(case, key)
    if number is not None:
        if not isinstance(value, tuple) or not 0 <= number < len(value):
            raise BadInput(f"optimise.variables.{name}: {key} has no value of number {number + 1}; write them as a "
                           "list, numbers go from 1")  # fmt: skip
        value = value[number]
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        what = "has several values; add .1, .2 and so on" if isinstance(value, tuple) else "is no number of this case"
        raise BadInput(f"optimise.variables.{name} {what}")
    return float(value)


def _variable(case: Case, name: str, spec: object) -> Limit:
    key, _ = _split(name)
    section, dot, _ = key.partition(".")
    if not dot or section not in case.sections:
        raise BadInput(f"optimise.variables.{name} is not known; {suggest(section, list(case.sections))}")
    unit = locate(case.path, key, case.overrides, "optimise.variables").unit or "-"
    return limit_of("variables", name, spec, {name: unit})


_LIMITS = {"peak_pressure": "p_max", "peak_temperature": "t_max", "knock": "knock"}


def _asked(case: Case) -> Json:
    """Limits of `[gas_limits]`, as `[optimise.constraints]` would name them."""
    limits = case.sections.get("gas_limits")
    known = {figure: getattr(limits, key, None) for key, figure in _LIMITS.items()}
    return {figure: {"high": value} for figure, value in known.items() if value is not None}


def optimise(case: Case) -> Optimised:
    """Best design of a case under its limits.

    case: with `[optimise]` and a cycle; spark ignition on pistons of a declaration is solved with exact derivatives,
    what else there is one design at a time. Returns optimum: status, variables, active limits and multipliers.
    """
    require(case, "optimise")
    section: Optimise = case.need("optimise")
    solves = math.prod(map(len, section.choices.values())) * (section.points + 1 if section.against else 1)
    what = f"finding {solves:g} best design{'s' * (solves > 1)}"
    budget.require(what, _SECONDS * solves, 0.0, "give fewer words or [optimise] points")
    if not section.choices:
        return _one(case)
    tried = []
    for words in itertools.product(*section.choices.values()):
        chosen = dict(zip(section.choices, words, strict=True))
        tried.append((chosen, _one(load(case.path, {**case.overrides, **chosen}))))
    sign = SIGN[section.goal]
    chosen, best = max(tried, key=lambda pair: (pair[1].best.status == "optimal", sign * pair[1].best.objective))
    rows = []
    for taken, done in tried:
        one = done.best
        rows.append(
            TriedWords(words=taken, status=one.status, objective=one.objective, variables=one.variables, unit=one.unit)
        )
    return dataclasses.replace(best, chosen=chosen, choices=tuple(rows))


def _one(case: Case) -> Optimised:
    section: Optimise = case.need("optimise")
    # derivatives are those of one piston's gas; the figures of faces, or of throws, are compared design by design
    if kind_of(case.need("cycle")).closed and roles_of(case.mechanism).pistons:
        limits = dataclasses.replace(section, constraints=_asked(case) | section.constraints)
        return _solved(problem(engine(case), case.need("operation").speed, limits), section, solve)
    return _solved(programme(case, section, _asked(case)), section, search)


def _solved(task: Task, section: Optimise, one: Callable[[Task], Optimum]) -> Optimised:
    if not section.against:
        return Optimised(best=one(task), goal=section.goal, objective_name=section.objective)
    front = pareto(task, section.against, section.against_goal, int(section.points), one)
    aims = (section.objective, section.against)
    points = []
    for p in front:
        shown = Columns({n: p.figures[n] for n in aims}, p.figures.units)
        points.append(ParetoPoint(status=p.status, figures=shown, variables=p.variables))
    return Optimised(
        best=front[0], goal=section.goal, objective_name=section.objective, front=tuple(front), pareto=tuple(points)
    )

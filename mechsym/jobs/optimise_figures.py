"""Case -> design problem of a cycle that is solved one design at a time: Stirling, gas exchange, two-stroke."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from mechsym.cases import Case, load, locate
from mechsym.cycle.kinds import kind_of
from mechsym.errors import BadInput, suggest
from mechsym.jobs.cycle import cycle
from mechsym.optimise.problem import Limit, Optimise, limit_of
from mechsym.optimise.search import FigureProgramme

# ends of the columns of `mechsym cycle`: SI unit and size
_UNITS = {
    "_g_kwh": ("kg/J", 1 / 3.6e9), "_kg_h": ("kg/s", 1 / 3600), "_deg": ("rad", math.pi / 180), "_kw": ("W", 1e3),
    "_mpa": ("Pa", 1e6), "_kpa": ("Pa", 1e3), "_kg": ("kg", 1.0), "_j": ("J", 1.0), "_k": ("K", 1.0),
}  # fmt: skip
_PLAIN = {"torque_avg": "N*m", "torque_max": "N*m", "brake_torque": "N*m", "force_max": "N"}
_JUMPS = 2e-4  # of the figures of gas exchange, as a timing passes one of its half degrees [-]
_NO_FIGURES = ("speed_rpm", "cylinders", "each", "energy_residual", "mass_residual")


def programme(case: Case, section: Optimise, asked: Mapping[str, Any]) -> FigureProgramme:
    """The design problem of a case.

    Parameters
    ----------
    case : Case
        With `[cycle]` of any kind that `mechsym cycle` computes
    section : Optimise
        Variables are dotted names of the case's numbers; of a list the number of the value comes behind it, from 1
    asked : mapping of str to dict
        Limits of the case besides; those on figures that this cycle has not are none

    Raises
    ------
    BadInput
        A name is none, or a limit leaves no room
    """
    variables = tuple(_variable(case, name, spec) for name, spec in section.variables.items())
    names = [v.name for v in variables]
    start = np.array([_value(case, name) for name in names])
    units = _units(case)
    for key, name in (("objective", section.objective), ("against", section.against or section.objective)):
        if name not in units:
            raise BadInput(f"optimise.{key} = {name!r} is not a figure; figures are {', '.join(units)}")
    limits = {name: limit for name, limit in asked.items() if name in units} | section.constraints
    return FigureProgramme(
        figures=lambda values: _at(case, dict(zip(names, values.tolist(), strict=True))),
        start=start,
        noise=_JUMPS if kind_of(case.need("cycle")).given == "breathing" else 0.0,
        units=units,
        objective=section.objective,
        sign=1.0 if section.goal == "maximise" else -1.0,
        variables=variables,
        constraints=tuple(limit_of("constraints", n, spec, units) for n, spec in limits.items()),
    )


def figures(case: Case) -> dict[str, float]:
    """Figures of a case at its speed, under their plain names [SI]."""
    return {name: value for name, (value, _) in _figures(case).items()}


def _figures(case: Case) -> dict[str, tuple[float, str]]:
    """Figures with their SI units; of two columns of one name the first."""
    found: dict[str, tuple[float, str]] = {}
    for column, values in cycle(case).items():
        if isinstance(values, Mapping) or column in _NO_FIGURES or np.ndim(values) != 1:
            continue
        end = next((end for end in _UNITS if column.endswith(end)), "")
        unit, size = _UNITS.get(end, (_PLAIN.get(column, "-"), 1.0))
        value = float(values[0]) * size
        if math.isfinite(value):
            found.setdefault(column.removesuffix(end), (value, unit))
    return found


def _units(case: Case) -> dict[str, str]:
    return {name: unit for name, (_, unit) in _figures(case).items()}


def _at(case: Case, values: Mapping[str, float]) -> dict[str, float]:
    return figures(load(case.path, {**case.overrides, **_settings(case, values)}))


def _settings(case: Case, values: Mapping[str, float]) -> dict[str, Any]:
    """Overrides of a case; numbers of one list come together."""
    found: dict[str, Any] = {}
    for name, value in values.items():
        key, number = _split(name)
        if number is None:
            found[key] = value
        else:
            found.setdefault(key, list(_written(case, key)))[number] = value
    return found


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


def _variable(case: Case, name: str, spec: Any) -> Limit:
    key, _ = _split(name)
    section, dot, _ = key.partition(".")
    if not dot or section not in case.sections:
        raise BadInput(f"optimise.variables.{name} is not known; {suggest(section, list(case.sections))}")
    unit = locate(case.path, key, case.overrides, "optimise.variables").unit or "-"
    return limit_of("variables", name, spec, {name: unit})

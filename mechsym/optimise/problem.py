"""A design problem: what `[optimise]` of a case says, checked against the engine and turned into numbers.

    maximise (or minimise) J(z)   subject to   low <= z <= high,  low_i <= g_i(z) <= high_i

z are values of the engine (`cycle.ignition`, `chamber.compression_ratio`, `parameters.e`, ..), J and g_i figures of
its cycle at one speed (`efficiency`, `p_max`, `tooth_force`, ..).
"""

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np

from mechsym import mechanisms
from mechsym.cycle.closed.differentiable import PEAK_UNITS, SCALAR_UNITS
from mechsym.cycle.closed.model import ClosedEngine, design_names
from mechsym.errors import BadInput
from mechsym.quantities import choice, parse, quantity, record
from mechsym.quantities.units import RadPerSecond


@record
class Optimise:
    """Section `[optimise]` of a case."""

    objective: str = "efficiency"  #: Figure to make large or small
    goal: str = choice("maximise", "minimise", default="maximise", about="what is best of the objective")
    #: Dotted name of an engine's value to `{low = .., high = ..}`
    variables: dict[str, Any] = dataclasses.field(default_factory=dict)
    #: Figure to `{low = ..}`, `{high = ..}`, both, or `{equal = ..}`
    constraints: dict[str, Any] = dataclasses.field(default_factory=dict)
    #: Dotted name of a word of the case to the list of words that are tried, for example "cycle.gas"
    choices: dict[str, Any] = dataclasses.field(default_factory=dict)
    against: str = ""  #: Second figure of a Pareto front, empty for none
    against_goal: str = choice("maximise", "minimise", default="minimise", about="what is best of `against`")
    points: float = quantity("-", default=9, low=3, high=101, about="points of the front")

    def __post_init__(self) -> None:
        for name in ("variables", "constraints", "choices"):
            if not isinstance(getattr(self, name), dict):
                raise BadInput(f"{name} = {getattr(self, name)!r} is no table; write [optimise.{name}] in a case file")
        for name, words in self.choices.items():
            if not isinstance(words, (list, tuple)) or not words or len(set(map(str, words))) < len(words):
                raise BadInput(
                    f'choices."{name}" = {words!r} is no list of different words; write for example '
                    '"cycle.gas" = ["air", "helium"]'
                )
        if not self.variables:
            raise BadInput(
                "variables is empty; name at least one, for example "
                '"cycle.ignition" = { low = "-40 deg", high = "0 deg" }'
            )


@record
class Limit:
    """Bounds of a variable or a figure."""

    #: Dotted name of a variable or name of a figure, and its SI unit
    name: str
    unit: str
    #: Bounds, an infinite one is none [unit]
    low: float
    high: float


@record
class DesignTask:
    """What a search seeks, and what must hold."""

    objective: str  #: Figure to make large or small
    sign: float  #: 1 to maximise, -1 to minimise [-]
    units: Mapping[str, str] = dataclasses.field(default_factory=dict)  #: SI units of the figures
    #: What may change, and what must hold
    variables: tuple[Limit, ...]
    constraints: tuple[Limit, ...]


@record
class Programme(DesignTask):
    """A design problem with numbers."""

    engine: ClosedEngine
    omega: float  #: Crank speed [rad/s]


def problem(engine: ClosedEngine, omega: RadPerSecond, section: Optimise) -> Programme:
    """Check a section against the engine and turn its texts into numbers."""
    units = design_units(engine)
    figures = figure_units(engine)
    for key, name in (("objective", section.objective), ("against", section.against or section.objective)):
        if name not in figures:
            raise BadInput(f"optimise.{key} = {name!r} is not a figure; figures are {', '.join(figures)}")
    for name, spec in section.constraints.items():
        peak = name in figures and name not in SCALAR_UNITS
        if peak and np.isfinite(limit_of("constraints", name, spec, figures).low):
            raise BadInput(
                f"optimise.constraints.{name}: a peak over the cycle can only be bounded from above; give high alone"
            )
    return Programme(
        engine=engine,
        omega=omega,
        units=figures,
        objective=section.objective,
        sign=1.0 if section.goal == "maximise" else -1.0,
        variables=tuple(limit_of("variables", name, spec, units) for name, spec in section.variables.items()),
        constraints=tuple(limit_of("constraints", name, spec, figures) for name, spec in section.constraints.items()),
    )


def figure_units(engine: ClosedEngine) -> dict[str, str]:
    """Figures that may be an objective or a constraint."""
    loads = engine.motion.loads.name_out() if engine.motion.loads is not None else []
    return SCALAR_UNITS | PEAK_UNITS | dict.fromkeys(loads, "N")


def design_units(engine: ClosedEngine) -> dict[str, str]:
    """Units of the values that a design may hold."""
    records = {s: getattr(engine, s) for s in ("chamber", "cycle", "gas", "heat_transfer", "friction_pressure")}
    units = {
        f"{section}.{f.name}": f.metadata["unit"]
        for section, record in records.items()
        for f in dataclasses.fields(record)
        if "unit" in f.metadata
    }
    fields = dataclasses.fields(mechanisms.parameters_class(engine.motion.name))
    units |= {f"parameters.{f.name}": f.metadata["unit"] for f in fields if "unit" in f.metadata}
    return {name: units.get(name, "rad/s") for name in design_names(engine)}


def limit_of(table: str, name: str, spec: object, units: dict[str, str]) -> Limit:
    """Bounds of a variable or figure out of what a case says; `table` is `variables` or `constraints`."""
    key = f"optimise.{table}.{name}"
    if name not in units:
        raise BadInput(f"{key} is not known; names are {', '.join(units)}")
    allowed = {"low", "high"} if table == "variables" else {"low", "high", "equal"}
    if not isinstance(spec, dict) or not spec or set(spec) - allowed:
        raise BadInput(f"{key} = {spec!r} is no limit; write {{ {', '.join(f'{a} = ..' for a in sorted(allowed))} }}")
    sides = {side: parse(value, units[name], f"{key}.{side}") for side, value in spec.items()}
    low, high = (sides.get("equal", sides.get(side, end)) for side, end in (("low", -np.inf), ("high", np.inf)))
    if not low <= high or (table == "variables" and not (np.isfinite([low, high]).all() and low < high)):
        raise BadInput(f"{key} = {spec!r} leaves no room; low must be below high, and a variable needs both")
    return Limit(name=name, unit=units[name], low=low, high=high)

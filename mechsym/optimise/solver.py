r"""A design problem: what `[optimise]` of a case says, checked against the engine and turned into numbers.

    maximise (or minimise) J(z)   subject to   low <= z <= high,  low_i <= g_i(z) <= high_i

z are values of the engine (`cycle.ignition`, `chamber.compression_ratio`, `parameters.e`, ..), J and g_i figures of
its cycle at one speed (`efficiency`, `p_max`, `tooth_force`, ..).

The design problem as a nonlinear programme for IPOPT, with exact first and second derivatives.

Variables run from 0 to 1 over their range, figures are divided by the size of their limit. A limit on a peak is a
limit on every value along the cycle; a peak as objective is the smallest bound that all values obey. The multiplier of
a limit, turned back into SI, is what it costs: the change of the objective by the change of the limit.
"""

import dataclasses
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

import casadi as ca
import numpy as np

from mechsym import mechanisms
from mechsym.cycle.closed.model import ClosedEngine, at_design, design_names
from mechsym.cycle.closed.performance import PEAK_UNITS, SCALAR_UNITS, design_function
from mechsym.errors import BadInput
from mechsym.optimise.solvers import Solved, ipopt
from mechsym.page import Shown
from mechsym.quantities import choice, parse, quantity, record
from mechsym.quantities.display import quantity_text
from mechsym.quantities.results import Columns, part, result
from mechsym.quantities.units import RadPerSecond

SIGN = {"maximise": 1.0, "minimise": -1.0}  #: Of what is made large, by the goal [-]


@record
class Optimise:
    """Section `[optimise]` of a case."""

    objective: str = "efficiency"  #: Figure to make large or small
    goal: str = choice(*SIGN, default="maximise", about="what is best of the objective")
    #: Dotted name of an engine's value to `{low = .., high = ..}`
    variables: dict[str, Any] = dataclasses.field(default_factory=dict)
    #: Figure to `{low = ..}`, `{high = ..}`, both, or `{equal = ..}`
    constraints: dict[str, Any] = dataclasses.field(default_factory=dict)
    #: Dotted name of a word of the case to the list of words that are tried, for example "cycle.gas"
    choices: dict[str, Any] = dataclasses.field(default_factory=dict)
    against: str = ""  #: Second figure of a Pareto front, empty for none
    against_goal: str = choice(*SIGN, default="minimise", about="what is best of `against`")
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

    def require(self, figures: Collection[str]) -> None:
        """Refuse an objective, or a second one, that is none of the figures at hand."""
        for key, name in (("objective", self.objective), ("against", self.against or self.objective)):
            if name not in figures:
                raise BadInput(f"optimise.{key} = {name!r} is not a figure; figures are {', '.join(figures)}")


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
    section.require(figures)
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
        sign=SIGN[section.goal],
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


_ACTIVE = 1e-6  # a limit counts as met this closely, in units of its own size or range
_OPTIONS: dict[str, Any] = {
    "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-10, "max_iter": 300},
    "print_time": False,
}
_MARGIN = 0.01  # the start keeps off the bounds of the variables


@result
class ActiveLimit:
    """A limit that stops a design from being better."""

    name: str = part()
    side: str = part()  #: `low`, `high` or `equal`
    limit: float = quantity("@unit")  #: Where it is
    unit: str = part()
    multiplier: float = quantity("@per")  #: Change of the objective by that of the limit
    meaning: str = part()
    per: str  # unit of the multiplier


@result
class Optimum:
    """What the solver found."""

    status: str = part()  #: `optimal`, `infeasible` or `not converged`
    reason: str = part()  #: The solver's own words, and what they mean
    variables: Columns = part()  #: The design
    objective: float = quantity("@unit")  #: Figure that is as large or small as can be
    figures: Columns = part()  #: All figures at the design; of peaks the largest value at the ends of the steps
    #: Change of the objective by that of a bound of each variable and figure, 0 where it is not active
    multipliers: Columns = part()
    active: tuple[ActiveLimit, ...] = part()
    iterations: int = quantity("-")  #: Of the solver
    unit: str  # of the objective


Task = TypeVar("Task", bound=DesignTask)


class _Block(NamedTuple):
    """One limit in the programme: expression and bounds divided by `scale`."""

    limit: Limit
    scale: float
    expression: ca.MX


def solve(task: Programme) -> Optimum:
    """Solve a design problem; the last design tried where none is feasible, with status and reason."""
    low, high = _bounds(task.variables)
    figures = _function(task)
    z = ca.MX.sym("z", low.size)
    values = dict(zip(figures.name_out(), figures.call([low + z * (high - low)]), strict=True))
    blocks = [_block(limit, values[limit.name]) for limit in task.constraints]
    size = abs(_largest(figures, _nominal(task))[task.objective]) or 1.0
    free, goal, rows = z, -task.sign * values[task.objective] / size, [b.expression for b in blocks]
    if task.objective not in SCALAR_UNITS:
        goal = ca.MX.sym("peak")
        free, rows = ca.vertcat(z, goal), [*rows, values[task.objective] / size - goal]
    programme = {"x": free, "f": goal, "g": ca.vertcat(*rows)}
    solver = ca.nlpsol("design", "ipopt", programme, _OPTIONS)
    bounds = _programme_bounds(blocks, rows, low.size, free.numel())
    return _optimum(task, figures, ipopt(solver, {"x0": _start(task, free.numel()), **bounds}), blocks, size)


def pareto(
    task: DesignTask, against: str, goal: str, points: int, one: Callable[[Any], Optimum] | None = None
) -> list[Optimum]:
    """Best values of the objective for given values of a second figure.

    one: what solves the task, `solve` where it is left out. Returns front: from the optimum of the objective alone to
    that of the second figure alone; figures tell both values.
    """
    best: Callable[[Any], Optimum] = one or solve
    sign = SIGN[goal]
    ends = [best(task), best(dataclasses.replace(task, objective=against, sign=sign))]
    if any(end.status != "optimal" for end in ends):
        return ends
    front = [ends[0]]
    for value in np.linspace(ends[0].figures[against], ends[1].figures[against], points)[1:]:
        low, high = (float(value), np.inf) if sign > 0 else (-np.inf, float(value))
        limit = Limit(name=against, unit=task.units[against], low=low, high=high)
        front.append(best(dataclasses.replace(task, constraints=(*task.constraints, limit))))
    return front


def _bounds(limits: Sequence[Limit]) -> tuple[np.ndarray, np.ndarray]:
    return np.array([v.low for v in limits]), np.array([v.high for v in limits])


def _function(task: Programme) -> ca.Function:
    names = [v.name for v in task.variables]
    z = ca.MX.sym("z", len(names))
    if "omega" in names:
        return design_function(task.engine, names)
    whole = design_function(task.engine, ["omega", *names])
    return ca.Function("figures", [z], whole.call([ca.vertcat(task.omega, z)]), ["design"], whole.name_out())


def _block(limit: Limit, expression: ca.MX) -> _Block:
    finite = [abs(b) for b in (limit.low, limit.high) if np.isfinite(b) and b != 0]
    scale = max(finite, default=1.0)
    return _Block(limit, scale, expression / scale)


def _start(task: Programme, count: int) -> np.ndarray:
    low, high = _bounds(task.variables)
    inside = np.clip((_nominal(task) - low) / (high - low), _MARGIN, 1 - _MARGIN)
    return np.concatenate([inside, np.ones(count - inside.size)])


def _nominal(task: Programme) -> np.ndarray:
    return np.array([task.omega if v.name == "omega" else _value(task.engine, v.name) for v in task.variables])


def _value(engine: ClosedEngine, name: str) -> float:
    section, _, key = name.partition(".")
    here = at_design(engine, {})
    return here.motion.parameters[key] if section == "parameters" else getattr(getattr(here, section), key)


def _largest(figures: ca.Function, design: np.ndarray) -> dict[str, float]:
    values = figures.call([design])
    return {name: float(ca.mmax(v)) for name, v in zip(figures.name_out(), values, strict=True)}


def _programme_bounds(
    blocks: Sequence[_Block], rows: Sequence[ca.MX], variables: int, count: int
) -> dict[str, ca.DM | list[float]]:
    peak = count - variables  # 1 when a peak is minimised: one more unknown, one more group of rows
    ends = [(b.limit.low / b.scale, b.limit.high / b.scale) for b in blocks] + [(-np.inf, 0.0)] * peak
    low, high = ([ca.repmat(e[k], r.numel(), 1) for e, r in zip(ends, rows, strict=True)] for k in (0, 1))
    return {
        "lbx": [0.0] * variables + [-np.inf] * peak, "ubx": [1.0] * variables + [np.inf] * peak,
        "lbg": ca.vertcat(*low), "ubg": ca.vertcat(*high),
    }  # fmt: skip


def _optimum(task: Programme, figures: ca.Function, solved: Solved, blocks: Sequence[_Block], size: float) -> Optimum:
    (low, high), solution = _bounds(task.variables), solved.values
    share = np.asarray(solution["x"]).ravel()[: low.size]
    design = np.clip(low + share * (high - low), low, high)  # IPOPT relaxes bounds by 1e-8
    values = _largest(figures, design)
    # IPOPT minimises -sign J/size, or the peak itself; its multipliers are -d(minimum)/d(bound)
    factor = size * (task.sign if task.objective in SCALAR_UNITS else -1.0)
    lam_x = factor * np.asarray(solution["lam_x"]).ravel()[: low.size] / (high - low)
    lam_g, costs, at = factor * np.asarray(solution["lam_g"]).ravel(), {}, 0
    for block in blocks:
        n = block.expression.numel()
        costs[block.limit.name] = float(lam_g[at : at + n].sum() / block.scale)
        at += n
    multipliers = {v.name: float(m) for v, m in zip(task.variables, lam_x, strict=True)} | costs
    variables = {v.name: float(d) for v, d in zip(task.variables, design, strict=True)}
    limits = [(v, variables[v.name], v.high - v.low) for v in task.variables]
    limits += [(b.limit, values[b.limit.name], b.scale) for b in blocks]
    return optimum_of(task, solved.status, solved.reason, variables, values, limits, multipliers, solved.iterations)


def optimum_of(
    task: DesignTask, status: str, reason: str, variables: Mapping[str, float], figures: Mapping[str, float],
    limits: Sequence[tuple[Limit, float, float]], multipliers: Mapping[str, float], iterations: int,
) -> Optimum:  # fmt: skip
    """The end of a search.

    variables, figures: the design and what it gives [SI]; limits: each limit with the value there and its range or size
    [unit of the limit]; multipliers: change of the objective by that of each limit [SI].
    """
    units, known = {v.name: v.unit for v in task.variables}, {**dict.fromkeys(figures, "-"), **task.units}
    unit = known[task.objective]
    per = {n: _per(unit, u) for n, u in {**known, **units}.items()}
    rows = (_active(task.objective, per, *limit, multipliers) for limit in limits)
    active = tuple(row for row in rows if row is not None)
    met = {row.name for row in active}
    return Optimum(
        status=status, reason=reason, variables=Columns(variables, units), objective=figures[task.objective],
        figures=Columns(figures, known),
        multipliers=Columns({n: m if n in met else 0.0 for n, m in multipliers.items()}, per),
        active=active, iterations=iterations, unit=unit,
    )  # fmt: skip


def _per(unit: str, other: str) -> str:
    """Unit of a change of one by that of another."""
    return unit if other == "-" else f"{'1' if unit == '-' else unit}/({other})"


def _active(
    objective: str, per: Mapping[str, str], limit: Limit, value: float, scale: float, costs: Mapping[str, float]
) -> ActiveLimit | None:
    """What an active limit costs, in words too; None where it is not met."""
    for side, bound in (("low", limit.low), ("high", limit.high)):
        if abs(value - bound) < _ACTIVE * scale:
            cost, step = costs[limit.name], abs(bound) / 100 or scale / 100
            meaning = (
                f"{quantity_text(step, limit.unit, 4)} more there (1 %) would change {objective} by {cost * step:+.4g}"
            )
            name = "equal" if limit.low == limit.high else side
            return ActiveLimit(
                name=limit.name, side=name, limit=bound, unit=limit.unit, multiplier=cost, meaning=meaning,
                per=per[limit.name],
            )  # fmt: skip
    return None


@result
class ParetoPoint:
    """A best design for a given value of the second figure."""

    status: str = part()
    figures: Columns = part(inline=True)  #: Objective and second figure
    variables: Columns = part()  #: The design


@result
class TriedWords:
    """What one combination of words gives."""

    words: Mapping[str, str] = part(inline=True)
    status: str = part()
    objective: float = quantity("@unit")  #: Figure that is as large or small as can be
    variables: Columns = part()  #: The design
    unit: str  # of the objective


@result
class Optimised(Shown):
    """The best design, and the front against the second aim."""

    best: Optimum = part(inline=True)
    goal: str = part()
    objective_name: str = part()
    #: Best designs for values of the second aim, the best of all first
    pareto: tuple[ParetoPoint, ...] = part(default=(), optional=True)
    chosen: Mapping[str, str] | None = part(default=None, optional=True)  #: Words of the best design
    choices: tuple[TriedWords, ...] = part(default=(), optional=True)  #: What each combination of words gives
    front: tuple[Optimum, ...] = ()  # of `pareto`

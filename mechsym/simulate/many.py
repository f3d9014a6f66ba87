"""Many runs at once: problems with the same equations go side by side through the lanes of the processor.

Start-up maps, trials and sweeps differ in parameters, start, torques and times, not in the form of the equations. Runs
of one form share one compiled file and are integrated in lanes and on all cores; what cannot be compiled runs one by
one, so the results do not depend on the route beyond the tolerance.

    x = f(q, u, a b, ..)     a and b differ: w ends with the product a b, worked out once for each run

Where only parameters of the mechanism differ, their equations are built once; what only parameters are in is taken out
of the rates, so that such a family costs as little in each step as a single run.
"""

import functools
import time
from collections.abc import Sequence
from dataclasses import replace

import casadi as ca
import numpy as np

from mechsym.mechanisms.record import Mechanism, MechanismForm, form_of
from mechsym.native.compiler import NoCompiler
from mechsym.native.integrate import integrate
from mechsym.native.runs import Breaks, Level, Runs, Table
from mechsym.quantities.units import Scalar
from mechsym.simulate.equations import System, outer_values, system
from mechsym.simulate.integrate import raw, runs, unsuited
from mechsym.simulate.phase import Raw
from mechsym.simulate.problem import FormulaForce, Part, Periodic, Problem, Steps
from mechsym.simulate.result import Result
from mechsym.simulate.run import ends_of, result_of, simulate, tighter, trusted, wanted_times
from mechsym.simulate.settings import NATIVE, Settings


def simulate_many(problems: Sequence[Problem], settings: Settings | None = None) -> list[Result]:
    """Integrate problems in order, side by side where possible; `wall_s` is the share of each in its group's time."""
    settings = settings or Settings()
    results: dict[int, Result] = {}
    for group in _groups(problems, settings):
        try:
            together = _together([problems[i] for i in group], settings) if len(group) > 1 else []
        except NoCompiler:
            together = []
        results |= dict(zip(group, together or [simulate(problems[i], settings) for i in group], strict=True))
    return [results[i] for i in range(len(problems))]


def _groups(problems: Sequence[Problem], settings: Settings) -> list[list[int]]:
    """Problems that may share a call: same names everywhere, same jumps, stops and kinks in number."""
    families: dict[object, list[int]] = {}
    for i, p in enumerate(problems):
        alone = settings.backend not in NATIVE or bool(p.unilateral) or bool(unsuited(p))
        form = (
            p.mechanism.coordinates,
            tuple((q.name, q.input, type(q.value)) for q in p.parts),
            tuple((s.of, s.direction) for s in p.stops),
            p.turns is None,
            (len(p.curves), len(p.states), p.inertia is None),
            p.t_start,
            len(ends_of(p)),
            tuple((k.coordinate, k.period, len(k.angles)) for k in p.kinks),
        )
        families.setdefault((i,) if alone else form, []).append(i)
    return list(families.values())


def _together(problems: list[Problem], settings: Settings) -> list[Result]:
    equations = systems(problems)
    begin = time.perf_counter()
    raws = _raws(problems, equations, settings)
    wall = (time.perf_counter() - begin) / len(problems)
    results = [result_of(p, s, r, settings, wall) for p, s, r in zip(problems, equations, raws, strict=True)]
    if settings.check == "none":
        return results
    checks = _raws(problems, equations, tighter(settings))
    return [
        r
        if r.status == "failed"
        else trusted(p.mechanism, r, result_of(p, s, c, settings, 0.0), functools.partial(simulate, p), settings)
        for p, s, r, c in zip(problems, equations, results, checks, strict=True)
    ]


def _raws(problems: list[Problem], equations: list[System], settings: Settings) -> list[Raw]:
    times = [wanted_times(p) for p in problems]
    single = [runs(p, s, settings, t, ends_of(p)) for p, s, t in zip(problems, equations, times, strict=True)]
    outcome = integrate(_joined(single, [s.function for s in equations]))
    rows = zip(problems, equations, times, single, strict=True)
    return [raw(p, s, t, outcome, i, np.asarray(r.start)) for i, (p, s, t, r) in enumerate(rows)]


def _joined(single: list[Runs], functions: list[ca.Function]) -> Runs:
    first, most = single[0], max(len(r.times) for r in single)
    times = [np.pad(r.times, (0, most - len(r.times)), constant_values=np.inf) for r in single]
    return replace(
        first,
        rhs=functions[0] if all(f is functions[0] for f in functions) else functions,
        start=np.array([r.start for r in single]),
        until=np.array([r.until for r in single]),
        held=np.array([r.held for r in single]),
        times=np.array(times),
        tables=tuple(
            Table(held=t.held, state=t.state, polynomials=tuple(r.tables[i].polynomials[0] for r in single))
            for i, t in enumerate(first.tables)
        ),
        surfaces=tuple(
            Level(state=s.state, level=np.array([r.surfaces[i].level for r in single]), direction=s.direction)
            for i, s in enumerate(first.surfaces)
        ),
        kinks=tuple(
            Breaks(state=k.state, angles=np.array([r.kinks[i].angles for r in single]), period=k.period)
            for i, k in enumerate(first.kinks)
        ),
    )


def systems(problems: Sequence[Problem]) -> list[System]:
    """The equations of problems of one form, with one function for all of them where they differ in numbers only."""
    first, mechanisms = problems[0], [p.mechanism for p in problems]
    same, forms = all(m is mechanisms[0] for m in mechanisms), {form_of(m) for m in mechanisms}
    if len(problems) == 1 or len({_formulas(p) for p in problems}) > 1 or not all(_numbers(p) for p in problems):
        return [system(p) for p in problems]
    if same and len({_written(p) for p in problems}) == 1:
        whole = system(first)
        return [replace(whole, values=outer_values(p)) for p in problems]
    if not same and (None in forms or len(forms) > 1):
        return [system(p) for p in problems]
    return _with_letters(problems, None if same else forms.pop())


def _numbers(problem: Problem) -> bool:
    """Whether its equations hold nothing but its mechanism, the values of its inputs and formulas with numbers."""
    beside = problem.curves or problem.states or problem.inertia or problem.mechanism.dependents
    return not beside and all(isinstance(p.value, Steps | Periodic | FormulaForce) for p in problem.parts)


def _formulas(problem: Problem) -> tuple[object, ...]:
    return tuple(p.value.function for p in problem.parts if isinstance(p.value, FormulaForce))


def _written(problem: Problem) -> tuple[Scalar, ...]:
    """Numbers of all formulas, one after the other."""
    return tuple(n for p in problem.parts if isinstance(p.value, FormulaForce) for n in p.value.numbers)


def _with_letters(problems: Sequence[Problem], form: MechanismForm | None) -> list[System]:
    """Equations over what differs: parameters of mechanisms of one form (None: it is the same), numbers of formulas."""
    first, values = problems[0], [p.mechanism.parameters for p in problems]
    varying = tuple(n for n in values[0] if form is not None and len({v[n] for v in values}) > 1)
    fixed = tuple((n, v) for n, v in values[0].items() if n not in varying)
    shared, letters = (first.mechanism, ()) if form is None else _open(form, fixed, varying)
    numbers = tuple(ca.SX.sym("number") for _ in _written(first))
    whole = system(replace(first, mechanism=shared, parts=_rewritten(first, numbers)), letters, numbers)
    function, formulas = _taken_out(whole.function, len(varying) + len(numbers))
    rows = [[v[n] for n in varying] for v in values]
    table = np.array([[*row, *_written(p)] for row, p in zip(rows, problems, strict=True)])
    taken = np.asarray(formulas(ca.DM(table.T))).T
    return [
        replace(whole, function=function, values=outer_values(p), fixed=tuple(f), shared=shared, letters=tuple(row))
        for p, f, row in zip(problems, taken.tolist(), rows, strict=True)
    ]


def _rewritten(problem: Problem, numbers: Sequence[ca.SX]) -> tuple[Part, ...]:
    """Its parts with others in place of the numbers of formulas."""
    left, parts = iter(numbers), []
    for part in problem.parts:
        if isinstance(part.value, FormulaForce):
            own = tuple(next(left) for _ in part.value.numbers)
            part = replace(part, value=replace(part.value, numbers=own))
        parts.append(part)
    return tuple(parts)


@functools.lru_cache(maxsize=16)
def _open(
    form: MechanismForm, fixed: tuple[tuple[str, Scalar], ...], varying: tuple[str, ...]
) -> tuple[Mechanism, tuple[ca.SX, ...]]:
    """The mechanism of a family, and the parameters that it leaves open."""
    symbols = {n: ca.SX.sym(n) for n in varying}
    return form.bound({**dict(fixed), **symbols}), tuple(symbols.values())


def _taken_out(rates: ca.Function, count: int) -> tuple[ca.Function, ca.Function]:
    """Rates over (t, y, w and values), and these values as a function of the last `count` entries of the old w."""
    t, y, w = (ca.SX.sym(rates.name_in(i), *rates.size_in(i)) for i in range(3))
    rest, letters = w[: w.numel() - count], w[w.numel() - count :]
    ydot, symbols, formulas = ca.extract_parametric(rates(t, y, w), letters)
    # a letter that stands by itself is taken as it is
    bare = [x for x in ca.vertsplit(letters) if ca.depends_on(ydot, x)]
    function = ca.Function(rates.name(), [t, y, ca.vertcat(rest, *symbols, *bare)], [ydot], ["t", "y", "w"], ["ydot"])
    return function, ca.Function("values", [letters], [ca.vertcat(*formulas, *bare)])

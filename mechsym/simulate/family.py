"""Problems that differ in numbers only: their equations are built once, what differs is a value of each run.

    x = f(q, u, a b, ..)     a and b differ: w ends with the product a b, worked out once for each run

What only parameters are in is taken out of the rates, so that a family costs as little in each step as a single run.
"""

import functools
from collections.abc import Sequence
from dataclasses import replace
from types import ModuleType
from typing import Any

import casadi as ca
import numpy as np

from mechsym.mechanisms.record import BoundFunctions, Mechanism, bind_module
from mechsym.simulate.equations import System, outer_values, system
from mechsym.simulate.problem import Periodic, Problem, Steps


def systems(problems: Sequence[Problem]) -> list[System]:
    """The equations of problems of one form, with one function for all of them where they differ in numbers only."""
    mechanisms = [p.mechanism for p in problems]
    if not all(_numbers(p) for p in problems) or len(problems) == 1:
        return [system(p) for p in problems]
    if all(m is mechanisms[0] for m in mechanisms):
        first = system(problems[0])
        return [replace(first, values=outer_values(p)) for p in problems]
    modules = {_module(m) for m in mechanisms}
    if len(modules) > 1 or None in modules:
        return [system(p) for p in problems]
    return _with_letters(problems)


def _numbers(problem: Problem) -> bool:
    """Whether its equations hold nothing but its mechanism and the values of its inputs."""
    beside = problem.curves or problem.states or problem.inertia or problem.mechanism.dependents
    return not beside and all(isinstance(p.value, Steps | Periodic) for p in problem.parts)


def _module(mechanism: Mechanism) -> ModuleType | None:
    return mechanism.functions.module if isinstance(mechanism.functions, BoundFunctions) else None


def _with_letters(problems: Sequence[Problem]) -> list[System]:
    values = [p.mechanism.parameters for p in problems]
    varying = tuple(n for n in values[0] if len({v[n] for v in values}) > 1)
    same = tuple((n, v) for n, v in values[0].items() if n not in varying)
    module = _module(problems[0].mechanism)
    assert module is not None
    shared, letters = _open(module, same, varying)
    first = system(replace(problems[0], mechanism=shared), letters)
    function, formulas = _taken_out(first.function, len(varying))
    table = np.array([[v[n] for n in varying] for v in values])
    fixed = np.asarray(formulas(ca.DM(table.T))).T
    return [
        replace(first, function=function, values=outer_values(p), fixed=tuple(f), shared=shared, letters=tuple(row))
        for p, f, row in zip(problems, fixed.tolist(), table.tolist(), strict=True)
    ]


@functools.lru_cache(maxsize=16)
def _open(module: ModuleType, same: tuple[tuple[str, float], ...], varying: tuple[str, ...]) -> tuple[Mechanism, Any]:
    """The mechanism of a family, and the parameters that it leaves open."""
    symbols = {n: ca.SX.sym(n) for n in module.PARAMETERS if n in varying}
    return bind_module(module, {**dict(same), **symbols}), tuple(symbols.values())


def _taken_out(rates: ca.Function, count: int) -> tuple[ca.Function, ca.Function]:
    """Rates over (t, y, w and values), and these values as a function of the last `count` entries of the old w."""
    t, y, w = (ca.SX.sym(rates.name_in(i), *rates.size_in(i)) for i in range(3))
    rest, letters = w[: w.numel() - count], w[w.numel() - count :]
    found, symbols, formulas = ca.extract_parametric(rates(t, y, w), letters)
    # a letter that stands by itself is taken as it is
    bare = [x for x in ca.vertsplit(letters) if ca.depends_on(found, x)]
    function = ca.Function(rates.name(), [t, y, ca.vertcat(rest, *symbols, *bare)], [found], ["t", "y", "w"], ["ydot"])
    return function, ca.Function("values", [letters], [ca.vertcat(*formulas, *bare)])

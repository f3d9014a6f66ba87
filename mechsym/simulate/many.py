"""Many runs at once: problems with the same equations go side by side through the lanes of the processor.

Start-up maps, trials and sweeps differ in parameters, start, torques and times, not in the form of the equations. Runs
of one form share one compiled file and are integrated in lanes and on all cores; what cannot be compiled runs one by
one, so the results do not depend on the route beyond the tolerance.
"""

import time
from collections.abc import Sequence
from dataclasses import replace

import casadi as ca
import numpy as np

from mechsym.native.compiler import NoCompiler
from mechsym.native.integrate import integrate
from mechsym.native.runs import Breaks, Level, Runs, Table
from mechsym.simulate import native_backend
from mechsym.simulate.backends import NATIVE
from mechsym.simulate.equations import System
from mechsym.simulate.family import systems
from mechsym.simulate.phase import Raw
from mechsym.simulate.problem import Problem
from mechsym.simulate.result import Result
from mechsym.simulate.run import checked, ends_of, result_of, simulate, tighter, wanted_times
from mechsym.simulate.settings import Settings


def simulate_many(problems: Sequence[Problem], settings: Settings | None = None) -> list[Result]:
    """Integrate problems, side by side where that is possible.

    Returns
    -------
    results : list of Result
        In the same order; `wall_s` is the share of each in the time of its group
    """
    settings = settings or Settings()
    results: dict[int, Result] = {}
    for group in _groups(problems, settings):
        try:
            found = _together([problems[i] for i in group], settings) if len(group) > 1 else []
        except NoCompiler:
            found = []
        results |= dict(zip(group, found or [simulate(problems[i], settings) for i in group], strict=True))
    return [results[i] for i in range(len(problems))]


def _groups(problems: Sequence[Problem], settings: Settings) -> list[list[int]]:
    """Problems that may share a call: same names everywhere, same jumps, stops and kinks in number."""
    families: dict[object, list[int]] = {}
    for i, p in enumerate(problems):
        alone = settings.backend not in NATIVE or bool(native_backend.unsuited(p))
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
    results = [result_of(p, s, r, wall) for p, s, r in zip(problems, equations, raws, strict=True)]
    if settings.check == "none":
        return results
    checks = _raws(problems, equations, tighter(settings))
    return [
        r if r.status == "failed" else checked(p.mechanism, r, result_of(p, s, c, 0.0), settings)
        for p, s, r, c in zip(problems, equations, results, checks, strict=True)
    ]


def _raws(problems: list[Problem], equations: list[System], settings: Settings) -> list[Raw]:
    times = [wanted_times(p) for p in problems]
    single = [
        native_backend.runs(p, s, settings, t, ends_of(p)) for p, s, t in zip(problems, equations, times, strict=True)
    ]
    outcome = integrate(_joined(single, [s.function for s in equations]))
    parts = zip(problems, equations, times, range(len(problems)), strict=True)
    return [native_backend.raw(p, s, t, outcome, i) for p, s, t, i in parts]


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

"""Times of routes that take turns, and the processor's share of them."""

import dataclasses
import statistics
import time
from collections.abc import Callable, Sequence

_WANTED_S = 0.02  # a sample shorter than this is repeated until it is as long


@dataclasses.dataclass(frozen=True, kw_only=True)
class Route:
    """One way to compute a problem.

    Parameters
    ----------
    name : str
        Name in the table
    call : callable
        Does the work once
    size : int
        Points, runs or calls of that work
    error : float or None
        Largest difference to the reference [-]
    rounds : int
        Samples to take; slow routes need fewer
    """

    name: str
    call: Callable[[], object]
    size: int = 1
    error: float | None = None
    rounds: int = 9


@dataclasses.dataclass(frozen=True, kw_only=True)
class Row:
    """A measured route.

    Parameters
    ----------
    problem, case, route : str
        What was computed, and how
    median_s, best_s : float
        Processor time of one point, run or call [s]
    error : float or None
        Largest difference to the reference [-]
    """

    problem: str
    case: str
    route: str
    median_s: float
    best_s: float
    error: float | None


def take_turns(problem: str, case: str, routes: Sequence[Route]) -> list[Row]:
    """Measure routes in turn.

    Parameters
    ----------
    problem, case : str
        For the rows
    routes : sequence of Route
        Ready to run; each has run once before

    Returns
    -------
    rows : list of Row
        In the same order
    """
    repeats = [_repeats(r) for r in routes]
    samples: list[list[float]] = [[] for _ in routes]
    for turn in range(max(r.rounds for r in routes)):
        for route, repeat, taken in zip(routes, repeats, samples, strict=True):
            if turn < route.rounds:
                taken.append(_sample(route.call, repeat) / route.size)
    return [
        Row(problem=problem, case=case, route=r.name, median_s=statistics.median(s), best_s=min(s), error=r.error)
        for r, s in zip(routes, samples, strict=True)
    ]


def _repeats(route: Route) -> int:
    once = _sample(route.call, 1)
    return max(1, round(_WANTED_S / max(once, 1e-7))) if once < _WANTED_S else 1


def _sample(call: Callable[[], object], repeat: int) -> float:
    begin = time.process_time()
    for _ in range(repeat):
        call()
    return (time.process_time() - begin) / repeat

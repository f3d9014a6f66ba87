"""Times of routes that take turns, the processor's share of them, and ratios of pairs with their interval."""

import dataclasses
import math
import os
import resource
import statistics
import time
from collections.abc import Callable, Sequence

_PAUSE_S = 0.03
_WANTED_S = 0.02  # a sample shorter than this is repeated until it is as long
PAIRS = 5 if os.environ.get("QUICK") else 30  # samples of a route that says nothing else; its interval needs them


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
    rounds: int = PAIRS


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
    samples : tuple of float
        All that were taken, in the order of the rounds [s]
    """

    problem: str
    case: str
    route: str
    median_s: float
    best_s: float
    error: float | None
    samples: tuple[float, ...] = ()


@dataclasses.dataclass(frozen=True, kw_only=True)
class Ratio:
    """Median of the ratios of pairs, each measured one right after the other.

    Parameters
    ----------
    median : float
        Of the pairs [-]
    low, high : float or None
        Ends of what holds the true median at least 19 times in 20; None where there are too few pairs [-]
    """

    median: float
    low: float | None = None
    high: float | None = None


def ratio(ours: Row, theirs: Row) -> Ratio:
    r"""Ratio of two routes that took turns.

    .. math:: P(x_{(k+1)} < m < x_{(n-k)}) = 1 - 2 \sum_{i=0}^{k} \binom{n}{i} 2^{-n}

    m is the median of the ratio, x its n samples in order: no distribution is assumed.

    Parameters
    ----------
    ours, theirs : Row
        Of one `take_turns`

    Returns
    -------
    ratio : Ratio
        Of the rounds that both took
    """
    pairs = sorted(a / b for a, b in zip(ours.samples, theirs.samples, strict=False))
    n, outside, k = len(pairs), 0.0, -1
    if not n:
        return Ratio(median=ours.median_s / theirs.median_s)
    while 2 * (outside + math.comb(n, k + 1) / 2**n) <= 0.05:
        k += 1
        outside += math.comb(n, k) / 2**n
    ends = {} if k < 0 else {"low": pairs[k], "high": pairs[n - 1 - k]}
    return Ratio(median=statistics.median(pairs), **ends)


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
        # another one begins each time, so that none always follows the same
        for i in (j % len(routes) for j in range(turn, turn + len(routes))):
            if turn < routes[i].rounds:
                samples[i].append(_sample(routes[i].call, repeats[i]) / routes[i].size)
    return [
        Row(
            problem=problem,
            case=case,
            route=r.name,
            median_s=statistics.median(s),
            best_s=min(s),
            error=r.error,
            samples=tuple(s),
        )
        for r, s in zip(routes, samples, strict=True)
    ]


def _repeats(route: Route) -> int:
    once = _sample(route.call, 1)
    return max(1, round(_WANTED_S / max(once, 1e-7))) if once < _WANTED_S else 1


def _sample(call: Callable[[], object], repeat: int) -> float:
    # threads that another route left waiting may spin for a while, and would be counted here
    time.sleep(_PAUSE_S)
    begin = _processor_time()
    for _ in range(repeat):
        call()
    return (_processor_time() - begin) / repeat


def _processor_time() -> float:
    # with that of the compiler, which runs as a child
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime

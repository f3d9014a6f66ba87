"""What ends a phase: stops, the wanted number of turns, and the kinks on both sides of a coordinate.

       low                    high          Between two kinks the forces are smooth. The surfaces lie one digit
--------|----- phase ----------|------- q   beyond the kinks, so a phase that ends at one leaves its state in the
       <|                      |>           next interval, and callables are never asked beyond either kink.
"""

import numpy as np

from mechsym.quantities import record
from mechsym.simulate.phase import Span, Surface
from mechsym.simulate.problem import Kinks, Problem

_DIRECTION = {"falling": -1, "rising": 1, "either": 0}
_MARGIN = 8  # digits that a callable may lose when it takes an angle modulo the period


@record
class Watch:
    """Surfaces around a state."""

    surfaces: tuple[Surface, ...]
    ends: tuple[str, ...]  #: Name of the end that each means; empty for a kink, behind which the run goes on
    spans: tuple[Span, ...]  #: Interval between kinks for each coordinate that has some


def watch(problem: Problem, columns: tuple[str, ...], y: np.ndarray) -> Watch:
    """What to watch for from a state on.

    Parameters
    ----------
    y : ndarray, shape (m,)
        State [SI, by column]

    Returns
    -------
    watch : Watch
        Surfaces, their meanings, and the intervals between kinks
    """
    always = ends_watched(problem, columns)
    surfaces, ends, spans = list(always.surfaces), list(always.ends), []
    for kinks in (k for k in problem.kinks if k.angles):
        state = columns.index(kinks.coordinate)
        low, high = _between(kinks, float(y[state]))
        surfaces.append(Surface(state=state, level=float(np.nextafter(high, np.inf)), direction=1))
        surfaces.append(Surface(state=state, level=float(np.nextafter(low, -np.inf)), direction=-1))
        margin = _MARGIN * float(np.spacing(max(abs(low), abs(high))))
        spans.append(Span(state=state, low=low + margin, high=high - margin))
        ends += ["", ""]
    return Watch(surfaces=tuple(surfaces), ends=tuple(ends), spans=tuple(spans))


def ends_watched(problem: Problem, columns: tuple[str, ...]) -> Watch:
    """What ends a run wherever it stands: stops, and the wanted number of turns."""
    surfaces = [
        Surface(state=columns.index(s.of), level=s.level, direction=_DIRECTION[s.direction]) for s in problem.stops
    ]
    ends = [s.name for s in problem.stops]
    if problem.turns is not None:
        surfaces.append(Surface(state=0, level=problem.q0[0] + 2 * np.pi * problem.turns, direction=1))
        ends.append("turns")
    return Watch(surfaces=tuple(surfaces), ends=tuple(ends), spans=())


def _between(kinks: Kinks, angle: float) -> tuple[float, float]:
    """The kinks on both sides of an angle; one that lies on a kink is at the low side."""
    turn = np.floor(angle / kinks.period)
    once = np.array(sorted({a % kinks.period for a in kinks.angles}))
    levels = np.concatenate([once + kinks.period * (turn + k) for k in (-1, 0, 1, 2)])
    above = int(np.searchsorted(levels, angle, side="right"))
    return float(levels[above - 1]), float(levels[above])

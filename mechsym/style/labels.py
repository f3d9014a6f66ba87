"""Labels that keep clear of each other, and curves that are equal named once."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from mechsym.style.palette import GREY, QUIET

MOST_SWINGS = 160  # of a curve that is still seen as a line


def spread(wanted: Sequence[float], gap: float, low: float = -np.inf, high: float = np.inf) -> np.ndarray:
    """Places near the wanted ones that keep a distance, in any one unit.

    Parameters
    ----------
    wanted : sequence of float, shape (n,)
        Where the labels belong [-]
    gap : float
        Distance that neighbours keep; less where there is no room [-]
    low, high : float
        Where the room ends [-]

    Returns
    -------
    places : ndarray, shape (n,)
        In the order of `wanted`, with the least sum of squares to it where the room has no end [-]

    Examples
    --------
    >>> spread([1.0, 1.1, 5.0], 1.0).tolist()
    [0.55, 1.55, 5.0]
    """
    order = np.argsort(wanted, kind="stable")
    gap = min(gap, (high - low) / max(len(order) - 1, 1))
    steps = gap * np.arange(len(order))
    # without the gaps the places only have to rise: pool neighbours that fall
    pools: list[list[float]] = []
    for value in np.asarray(wanted, dtype=float)[order] - steps:
        pools.append([float(value)])
        while len(pools) > 1 and np.mean(pools[-2]) >= np.mean(pools[-1]):
            last = pools.pop()
            pools[-1] += last
    risen = np.concatenate([np.full(len(pool), np.mean(pool)) for pool in pools]) if pools else np.empty(0)
    places = np.empty(len(order))
    places[order] = np.clip(risen, low, high - (steps[-1] if len(steps) else 0.0)) + steps
    return places


def events(axis: Any, marks: Mapping[str, float], width: float) -> None:
    """Upright names above a panel, each with a line at its place.

    Parameters
    ----------
    marks : mapping of str to float
        Name to place, in the unit of the panel's axis [-]
    width : float
        About how wide the panel is [inch]
    """
    low, high = axis.get_xlim()
    gap = 0.15 * (high - low) / width  # of letters of 8 points
    places = spread(list(marks.values()), gap, low + gap / 2, high - gap / 2)
    above = axis.get_xaxis_transform()
    for (name, at), place in zip(marks.items(), places, strict=True):
        axis.axvline(at, color=GREY, linewidth=0.7, linestyle=":")
        axis.plot([at, place], [1.0, 1.06], transform=above, color=GREY, linewidth=0.7, clip_on=False)
        axis.text(place, 1.08, name, rotation=90, ha="center", va="bottom", fontsize=8, color=QUIET, transform=above)
    axis.set_xlim(low, high)


def envelope(axis: Any, t: np.ndarray, y: np.ndarray, color: str, label: str | None = None) -> None:
    """A curve over time; one that swings more often than can be seen as the band that it fills.

    Parameters
    ----------
    t, y : ndarray, shape (n,)
        Time and values, in the units of the panel [-]
    """
    swings = np.abs(np.diff(y)).sum() / (np.ptp(y) or 1.0)  # through all of its range, so that ripples do not count
    if swings <= MOST_SWINGS:
        axis.plot(t, y, color=color, linewidth=0.9, label=label)
        return
    # as many stretches as can be told apart, and a swing in each of them
    edges = np.unique(np.searchsorted(t, np.linspace(t[0], t[-1], min(300, int(swings) // 4), endpoint=False)))
    low, high = (f.reduceat(y, edges) for f in (np.minimum, np.maximum))
    axis.fill_between(t[edges], low, high, color=color, alpha=0.55, linewidth=0.6, label=label)


def same_curve(one: np.ndarray, other: np.ndarray, size: float) -> bool:
    """Whether two curves over the same values are equal but for round-off, beside the largest of all, `size` [unit]."""
    return bool(one.shape == other.shape and np.abs(other - one).max(initial=0.0) <= 1e-6 * size)


def same_path(one: np.ndarray, other: np.ndarray, size: float) -> bool:
    """Whether two closed paths lie on each other, wherever each begins.

    Parameters
    ----------
    one, other : ndarray, shape (2 n,)
        Values across, then values up [unit]
    size : float
        Largest value of all paths [unit]

    Examples
    --------
    >>> t = np.linspace(0, 2 * np.pi, 100)
    >>> circles = [np.concatenate([r * np.cos(t + s), r * np.sin(t + s)]) for r, s in ((1, 0), (1, 2), (1.1, 0))]
    >>> same_path(circles[0], circles[1], 1.1), same_path(circles[0], circles[2], 1.1)
    (True, False)
    """
    first, second = (np.reshape(path, (2, -1)).T for path in (one, other))
    return max(_away(first, second), _away(second, first)) <= 2e-3 * size


def _away(points: np.ndarray, path: np.ndarray) -> float:
    """How far some of the points lie from the closed polygon of a path at most [unit]."""
    start, step = path, np.roll(path, -1, axis=0) - path
    seen = points[:: max(1, len(points) // 90), None]
    long = np.maximum((step**2).sum(axis=1), 1e-300)
    along = np.clip(((seen - start) * step).sum(axis=2) / long, 0.0, 1.0)
    return float(np.linalg.norm(seen - start - along[..., None] * step, axis=2).min(axis=1).max())


def distinct(
    curves: Mapping[str, np.ndarray],
    joint: str = " = ",
    same: Callable[[np.ndarray, np.ndarray, float], bool] = same_curve,
) -> dict[str, np.ndarray]:
    """Curves by name, those that lie on each other once, under all their names.

    Parameters
    ----------
    curves : mapping of str to ndarray, shape (n,)
        Of one unit [unit]
    same : callable
        Tells of two curves, and of the largest value of all, whether they lie on each other

    Examples
    --------
    >>> list(distinct({"N1": np.ones(3), "N2": np.ones(3), "N3": np.zeros(3)}))
    ['N1 = N2', 'N3']
    """
    size = max((float(np.abs(values).max(initial=0.0)) for values in curves.values()), default=0.0)
    found: list[tuple[list[str], np.ndarray]] = []
    for name, values in curves.items():
        for names, other in found:
            if same(other, values, size):
                names.append(name)
                break
        else:
            found.append(([name], values))
    return {joint.join(names): values for names, values in found}


def clear_places(points: Sequence[tuple[float, float]], size: tuple[float, float]) -> list[int]:
    """Which of many labels to write so that none covers another: the first always, each later one where it is free.

    Parameters
    ----------
    points : sequence of (float, float)
        Where the labels begin, in any one unit [-]
    size : (float, float)
        How wide and high a label is, in that unit [-]

    Examples
    --------
    >>> clear_places([(0.0, 0.0), (0.5, 0.0), (2.0, 0.0)], (1.0, 1.0))
    [0, 2]
    """
    kept: list[int] = []
    for i, (x, y) in enumerate(points):
        if all(abs(x - points[k][0]) >= size[0] or abs(y - points[k][1]) >= size[1] for k in kept):
            kept.append(i)
    return kept

"""A run between its samples: the polynomial of degree five through three neighbours and their rates."""

from collections.abc import Callable, Mapping

import numpy as np

from mechsym.quantities.units import Array, Second

#: ascending times (n,) [s] to coordinates and velocities by name, each (n,)
Between = Callable[[np.ndarray], Mapping[str, np.ndarray]]


def between(t: Second[Array], columns: Mapping[str, np.ndarray]) -> Between:
    """Coordinates and velocities between three or more samples of a motion without blows.

    columns: coordinates and, with a `d` behind the name, velocities, each (n,) [rad, rad/s] or [m, m/s]. Returns a
    function of ascending times [s] to the same. Error of a sine of omega over steps h: 2.1e-4 (omega h)^6 of its
    amplitude or less.
    """
    names = [name for name in columns if f"{name}d" in columns]
    q, u = (np.array([columns[name + ending] for name in names]) for ending in ("", "d"))
    middle = (t[:-1] + t[1:]) / 2

    def at(times: np.ndarray) -> dict[str, np.ndarray]:
        i = np.clip(np.searchsorted(middle, times), 1, len(t) - 2)
        nodes = [t[i + k] - t[i] for k in (-1, -1, 0, 0, 1, 1)]
        # Newton's divided differences, each node twice, from the sample in the middle on
        row = [q[:, i + k] - q[:, i] for k in (-1, -1, 0, 0, 1, 1)]
        terms = [row[0]]
        for order in range(1, 6):
            row = [(b - a) / (nodes[j + order] - nodes[j]) if order > 1 or j % 2 else u[:, i + j // 2 - 1]
                      for j, (a, b) in enumerate(zip(row, row[1:], strict=False))]  # fmt: skip
            terms.append(row[0])
        x, value, rate = times - t[i], terms[5], np.zeros_like(terms[5])
        for term, node in zip(terms[4::-1], nodes[4::-1], strict=True):
            rate = value + (x - node) * rate
            value = term + (x - node) * value
        value = value + q[:, i]
        return dict(zip(names, value, strict=True)) | {f"{n}d": v for n, v in zip(names, rate, strict=True)}

    return at

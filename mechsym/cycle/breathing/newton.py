r"""The cycle that repeats, by Newton, where volumes are so large that following cycle after cycle takes too long.

.. math:: F(x) = g(x) - x = 0, \qquad x \leftarrow x - (g' - 1)^{-1} F

g takes the state over one cycle; its slopes come from cycles of neighbours that run side by side. A cycle whose
neighbours run away from it, so that |eigenvalue of g'| > 1, is none that an engine shows, and none is returned.
"""

from collections.abc import Callable

import numpy as np

from mechsym.quantities.units import Pure

_ROUNDS, _BESIDE, _WORTH = 12, 1e-6, 0.5


def repeating(
    cycle: Callable[[np.ndarray, np.ndarray], np.ndarray], state: np.ndarray, sizes: list[int], settled: Pure
) -> np.ndarray | None:
    """States that repeat, lane by lane, or None where Newton finds none or none that is stable [kg, J].

    cycle: states, shape (n, k), and the lane of each, shape (k,), to the states one cycle later; state: where to start
    [kg, J], shape (n, lanes); sizes: for each state the one by which it is measured; settled: relative change over a
    cycle that is none.
    """
    n, lanes = state.shape
    lane = np.tile(np.arange(lanes), n + 1)
    for _ in range(_ROUNDS):
        scale = np.abs(state[sizes])
        steps = np.eye(n)[:, :, None] * (_BESIDE * scale)[:, None, :]  # state, neighbour, lane
        tried = np.concatenate([state[:, None], state[:, None] + steps], axis=1).reshape(n, -1)
        gain = (cycle(tried, lane) - tried).reshape(n, n + 1, lanes)
        if not np.isfinite(gain).all():
            return None
        rest = gain[:, 0] / scale
        slopes = (gain[:, 1:] - gain[:, :1]) / scale[:, None, :] / _BESIDE
        if np.abs(rest).max() < settled:
            stable = all(np.abs(np.linalg.eigvals(slopes[:, :, k] + np.eye(n))).max() < 1 for k in range(lanes))
            return state if stable else None
        try:
            move = np.stack([np.linalg.solve(slopes[:, :, k], -rest[:, k]) for k in range(lanes)], axis=1)
        except np.linalg.LinAlgError:  # a state that no longer answers, as in a plenum of next to nothing
            return None
        # no mass or energy may fall, or rise, by more than its half at once
        share = np.minimum(1.0, _WORTH / np.maximum(np.abs(move).max(axis=0), 1e-300))
        state = state + share * move * scale
    return None

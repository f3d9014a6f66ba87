r"""The gas in a turn without combustion: the compression line both ways, which never does work.

.. math:: p(\varphi) \to \min[p(\varphi), p(-\varphi)] \quad \text{on the stroke behind firing dead centre}

What expands is what was compressed: n_e = n_c, no fuel. A polytropic expansion with its own n_e < n_c would give work
from nothing (0.4 to 1.5 bar in the built-in cycle); heat loss would take some, and makes a lost combustion worse.
"""

from collections.abc import Callable, Sequence

import numpy as np

from mechsym.quantities.units import Radian


def unfired(force: Callable[[np.ndarray], np.ndarray], period: Radian) -> Callable[[np.ndarray], np.ndarray]:
    """Force on the piston [N] over the crank angle in a turn without combustion, from that with it.

    force: angle from firing dead centre [rad] to net force on the piston, which grows with the pressure [N]; period: of
    the cycle.
    """

    def without(phi: np.ndarray) -> np.ndarray:
        angle = np.asarray(phi, dtype=float) % period
        burning = angle < np.pi
        return np.where(burning, np.minimum(force(angle), force(-angle)), force(angle))

    return without


def unfired_kinks(kinks: Sequence[float], period: float) -> tuple[float, ...]:
    """Angles [rad] where that force is not smooth: the kinks, their mirrors behind firing, dead centres."""
    mirrored = [(-k) % period for k in kinks]
    behind = [m for m in mirrored if m <= np.pi + 1e-12]
    return tuple(sorted({round(float(k % period), 12) for k in (*kinks, *behind, 0.0, np.pi)}))

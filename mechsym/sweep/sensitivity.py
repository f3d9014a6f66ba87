"""Which value matters how much: Sobol indices of every result, out of samples in Saltelli's order."""

from collections.abc import Sequence

import numpy as np

from mechsym.quantities import results
from mechsym.quantities.results import part, quantity
from mechsym.quantities.units import Array, Pure
from mechsym.sweep.axes import Axis
from mechsym.sweep.data import main_results
from mechsym.sweep.run import Sweep

_AGAIN = 1000  # resamplings of the confidence
_SHARE = (2.5, 97.5)  # percentiles of an interval that holds the truth 19 times in 20


@results.result
class SobolIndex:
    """How much of a result's variance one value brings."""

    result: str = part()
    key: str = part()
    first: float = quantity("-")  #: By itself, the others averaged
    first_low: float = quantity("-")  #: Lower end of its 95 % interval
    first_high: float = quantity("-")  #: Upper end of its 95 % interval
    total: float = quantity("-")  #: With all that it does together with others
    total_low: float = quantity("-")  #: Lower end of its 95 % interval
    total_high: float = quantity("-")  #: Upper end of its 95 % interval
    left_out: int = quantity("-")  #: Base samples that a gap takes away


def indices(result: Sweep) -> list[SobolIndex]:
    """Sobol indices of the main results, or of those that are shown, with their confidence.

    Returns rows: one for each result that varies and each axis; none where fewer than two base samples are whole.
    """
    count, d = result.sobol, len(result.axes)
    found = []
    for name, values in main_results(result).items():
        blocks = values.reshape(d + 2, count)
        whole = np.isfinite(blocks).all(axis=0)
        if whole.sum() > 1 and np.ptp(blocks[:, whole]) > 1e-12 * np.abs(blocks[:, whole]).max():
            found += _of_one(name, result.axes, blocks[:, whole], int(count - whole.sum()))
    return found


def _of_one(name: str, axes: Sequence[Axis], blocks: np.ndarray, left_out: int) -> list[SobolIndex]:
    here = estimates(blocks)
    rng = np.random.default_rng(0)
    rows = rng.integers(blocks.shape[1], size=(_AGAIN, blocks.shape[1]))
    again = estimates(blocks[:, rows])
    (low_1, high_1), (low_t, high_t) = (np.nanpercentile(a, _SHARE, axis=-1) for a in again)
    return [
        SobolIndex(
            result=name, key=axis.key, first=float(here[0][i]), first_low=float(low_1[i]),
            first_high=float(high_1[i]), total=float(here[1][i]), total_low=float(low_t[i]),
            total_high=float(high_t[i]), left_out=left_out,
        )
        for i, axis in enumerate(axes)
    ]  # fmt: skip


def estimates(blocks: np.ndarray) -> tuple[Pure[Array], Pure[Array]]:
    r"""First-order and total indices out of samples A, B, and A with one column of B after the other.

    .. math:: S_i = \frac{\overline{f_B (f_{AB_i} - f_A)}}{V}, \quad T_i = \frac{\overline{(f_A - f_{AB_i})^2}}{2 V}

    Returns first, total: indices, shape (d, ..).

    Parameters
    ----------
    blocks : ndarray, shape (d + 2, .., n)
        Results of A, B, AB_1 .. AB_d [unit of the result]

    Notes
    -----
    Source: Saltelli et al., Computer Physics Communications 181 (2010), table 2, (b) and (f), the latter of Jansen.
    Valid: independent values. V is the variance of A and B together.

    Examples
    --------
    >>> a, b = np.array([1.0, 2.0, 3.0, 4.0]), np.array([2.0, 4.0, 1.0, 3.0])
    >>> [s.round(3).tolist() for s in estimates(np.array([a, b, b]))]  # one value: it is all of the variance
    [[1.0], [1.0]]
    """
    a, b, both = blocks[0], blocks[1], np.concatenate([blocks[0], blocks[1]], axis=-1)
    mean, variance = both.mean(axis=-1, keepdims=True), both.var(axis=-1)
    change = blocks[2:] - a
    with np.errstate(invalid="ignore", divide="ignore"):
        return ((b - mean) * change).mean(axis=-1) / variance, (change**2).mean(axis=-1) / 2 / variance

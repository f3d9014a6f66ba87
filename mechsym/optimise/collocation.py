r"""A run in time as the unknowns of one sparse system: direct collocation with the emitted equations of motion.

.. math:: \sum_{j=0}^{d} C_{jk}\,x_{ij} = h_i\,f(x_{ik}, w_{ik}, \theta), \qquad
          x_{i+1,0} = \sum_j D_j\,x_{ij}

On each interval the state is a polynomial of degree d through its start and d Legendre points, which solves the
equations at those points; order 2 d at the ends of the intervals.
"""

from typing import NamedTuple

import casadi as ca
import numpy as np
import scipy.sparse as sp
from scipy.interpolate import BarycentricInterpolator

DEGREE = 5


class Intervals(NamedTuple):
    """Intervals, and the linear maps from the states to what is asked of them."""

    edges: np.ndarray  # shape (N + 1,) [s]
    nodes: np.ndarray  # times of the collocation points, shape (N d,) [s]
    slopes: sp.csc_matrix  # states (N (d + 1),) to h times their rates at the nodes
    inner: sp.csc_matrix  # states to those at the nodes
    gaps: sp.csc_matrix  # states to what an interval's end misses its follower's start by, (N - 1,)
    samples: sp.csc_matrix  # states to those at the samples
    lengths: np.ndarray  # of the interval of each node, shape (N d,) [s]


def grid(t: np.ndarray, breaks: tuple[float, ...], longest: float) -> Intervals:
    """Intervals over samples.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Times of the samples [s]
    breaks : tuple of float
        Times at which the equations change [s]
    longest : float
        Length of an interval at most [s]
    """
    inside = sorted({float(t[0]), float(t[-1]), *(b for b in breaks if t[0] < b < t[-1])})
    parts = [
        np.linspace(a, b, max(2, int(np.ceil((b - a) / longest)) + 1)) for a, b in zip(inside, inside[1:], strict=False)
    ]
    edges = np.unique(np.concatenate(parts))
    count, h = len(edges) - 1, np.diff(edges)
    tau = np.append(0.0, ca.collocation_points(DEGREE, "legendre"))
    c, d, _ = (np.asarray(m) for m in ca.collocation_coeff(tau[1:].tolist()))
    each, inner = sp.identity(count), np.vstack([np.zeros(DEGREE), np.eye(DEGREE)])
    start = np.eye(DEGREE + 1)[:, :1]
    ends = sp.kron(each, d.reshape(-1, 1), "csc")
    starts = sp.kron(each, start, "csc")
    return Intervals(
        edges=edges, nodes=(edges[:-1, None] + h[:, None] * tau[1:]).ravel(), slopes=sp.kron(each, c, "csc"),
        inner=sp.kron(each, inner, "csc"), gaps=sp.csc_matrix(ends[:, :-1] - starts[:, 1:]),
        samples=_samples(t, edges, tau), lengths=np.repeat(h, DEGREE),
    )  # fmt: skip


def _samples(t: np.ndarray, edges: np.ndarray, tau: np.ndarray) -> sp.csc_matrix:
    interval = np.clip(np.searchsorted(edges, t, side="right") - 1, 0, len(edges) - 2)
    place = (t - edges[interval]) / np.diff(edges)[interval]
    basis = np.atleast_2d(BarycentricInterpolator(tau, np.eye(len(tau)))(place))
    rows = (interval[:, None] * len(tau) + np.arange(len(tau))).ravel()
    columns = np.repeat(np.arange(len(t)), len(tau))
    return sp.csc_matrix((basis.ravel(), (rows, columns)), shape=((len(edges) - 1) * len(tau), len(t)))

r"""How many springs pay? The swing that the best r shapes leave of the wanted works, whatever the guide.

.. math:: D_r = \min_{S, c} \max_k \frac{1}{\omega_k^2} \mathrm{ptp}\Bigl(W_k - \sum_{j=1}^{r} c_{kj} S_j\Bigr)

r springs are r shapes of work S_j(phi) with a pressure each, c_kj. Weak ripple needs a total inertia of about D_r over
ripple: an estimate. What is proven, with the terms of rollers and outside pressure, stands in `certificate`.

Machines of several cylinders on one shaft: their works add up, and most of what a hinge would take cancels.

.. math:: W_N(\varphi) = \sum_i W(\varphi + \varphi_i)

One hinge on the shaft then works on what is left. A spread of the cylinders' pressures brings back the order one, which
a guide with one shape cannot take where it changes from day to day.
"""

import dataclasses
from collections.abc import Sequence
from typing import Any

import casadi as ca
import numpy as np
import scipy

from mechsym import periodic
from mechsym.codesign.points import Function, Point, bare_flywheel, sample
from mechsym.optimise.solvers import ipopt
from mechsym.quantities import record
from mechsym.quantities.results import quantity, result
from mechsym.quantities.units import Inertia, Pure

_ANGLES = 180
MOST = 3  # springs that are asked about
_PAYS = 0.5  # one spring more pays if it leaves less than this share of the swing
_OPTIONS: dict[str, Any] = {
    "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-9, "mu_strategy": "adaptive", "max_iter": 500},
    "print_time": False,
}


@record
class Shapes:
    """The best r shapes of work for all points."""

    springs: int
    swing: float = quantity("kg*m^2", about="D_r")
    shapes: np.ndarray  #: shape (r, n), S_j in units of the wanted work by omega^2 [kg*m^2]
    shares: np.ndarray  #: shape (k, r), c_kj / omega_k^2 [-]
    status: str  #: of the solver; where it failed the singular vectors stand


@record
class Bound:
    """What the best shapes leave, for 1, 2 and 3 springs."""

    phi: np.ndarray  #: shape (n,) [rad]
    wanted: np.ndarray  #: shape (k, n), W_k / omega_k^2 about their means [kg*m^2]
    singular_values: np.ndarray  #: shape (k,), by the first [-]
    bare: float = quantity("kg*m^2", about="swing without a spring")
    best: tuple[Shapes, ...]
    pays: int  #: springs up to which each one more at least halves the swing

    @property
    def swing(self) -> tuple[float, ...]:
        """D_1, D_2, .. [kg*m^2]."""
        return tuple(b.swing for b in self.best)


def rank(points: Sequence[Point], springs: int = MOST) -> Bound:
    r"""What guides with up to some springs leave of the works of all points at the least.

    .. math:: D_r = \min_{S, c} \max_k \mathrm{ptp}(W_k - c_k S) / \omega_k^2

    Returns bound: D_r [kg*m^2], singular values [-], shapes, and how many springs pay. Bilinear: IPOPT starts from the
    singular vectors; the freedom of mixing shapes is taken away by holding them at r angles. Alternating linear
    programmes get stuck (20.66 for 17.21 in the built-in family from 75 to 142 rpm).
    """
    samples = sample(points, round(_ANGLES * points[0].period / (2 * np.pi)))
    work = samples.work / samples.omega[:, None] ** 2
    wanted = np.asarray(work - (work @ samples.weights)[:, None])
    bare = float(np.ptp(wanted, axis=1).max())
    sizes = np.linalg.svd(wanted, compute_uv=False)
    best: list[Shapes] = []
    for r in range(1, min(springs, MOST) + 1):
        shapes = _none_left(wanted, r) if r >= len(points) else _best(wanted, r)
        if best and shapes.swing > best[-1].swing:
            shapes = dataclasses.replace(best[-1], springs=r)  # a shape that is not used does no harm
        best.append(shapes)
    swings = [b.swing for b in best]
    count, before = 0, bare
    for swing in swings:
        if swing > _PAYS * before or before <= 1e-9 * bare:
            break
        count, before = count + 1, swing
    return Bound(
        phi=samples.phi, wanted=wanted, singular_values=sizes / sizes[0], bare=bare, best=tuple(best), pays=count
    )


def flywheel_estimate(points: Sequence[Point], bound: Bound, ripple: Pure, rollers: Inertia = 0.0) -> Inertia:
    r"""Flywheel that weak ripple needs beside one guide, about.

    .. math:: J \approx D_1 / \delta - \overline{I + I_h}

    points: the engine's own inertia is that of the first of them; ripple: allowed (max - min) / mean of the speed;
    rollers: mean inertia of the rollers, I_h. Returns inertia: not below 0.
    """
    own = float(np.mean(points[0].inertia(np.linspace(0, points[0].period, 361)[:-1])))
    return max(0.0, bound.swing[0] / ripple - own - rollers)


def _none_left(wanted: np.ndarray, r: int) -> Shapes:
    """As many springs as points: each point has a guide of its own."""
    k = len(wanted)
    shapes = np.vstack([wanted, np.zeros((r - k, wanted.shape[1]))])
    return Shapes(springs=r, swing=0.0, shapes=shapes, shares=np.eye(k, r), status="exact")


def _best(wanted: np.ndarray, r: int) -> Shapes:
    size = float(np.ptp(wanted, axis=1).max())
    w = wanted / size
    k, n = w.shape
    u, s, v = np.linalg.svd(w, full_matrices=False)
    shares0, shapes0 = u[:, :r] * s[:r] / np.sqrt(n), v[:r] * np.sqrt(n)
    shapes, shares, low, D = ca.SX.sym("S", r, n), ca.SX.sym("c", k, r), ca.SX.sym("low", k), ca.SX.sym("D")
    left = ca.DM(w) - shares @ shapes - ca.repmat(low, 1, n)
    x = ca.veccat(shapes, shares, low, D)
    left0 = w - shares0 @ shapes0
    x0 = np.concatenate([shapes0.T.ravel(), shares0.T.ravel(), left0.min(1), [np.ptp(left0, axis=1).max()]])
    held = np.full(x0.size, False)
    angles = scipy.linalg.qr(shapes0, pivoting=True)[2][:r]
    held[[i + r * j for j in angles for i in range(r)]] = True
    problem = {"x": x, "f": D, "g": ca.veccat(left, left - D)}
    zero, far = np.zeros(k * n), np.full(k * n, np.inf)
    solver = ca.nlpsol("rank", "ipopt", problem, _OPTIONS)
    given = {
        "x0": x0, "lbx": np.where(held, x0, -np.inf), "ubx": np.where(held, x0, np.inf),
        "lbg": np.concatenate([zero, -far]), "ubg": np.concatenate([far, zero]),
    }  # fmt: skip
    solved = ipopt(solver, given, nearly=True)
    end = np.asarray(solved.values["x"]).ravel() if solved.status == "optimal" else x0
    shapes_, shares_ = end[: r * n].reshape(n, r).T, end[r * n : r * n + k * r].reshape(r, k).T
    # the swing that these very shapes leave, whatever the solver says
    swing = size * float(np.ptp(w - shares_ @ shapes_, axis=1).max())
    status = solved.status if solved.status == "optimal" else solved.reason
    return Shapes(springs=r, swing=swing, shapes=size * shapes_, shares=shares_, status=status)


@result
class Count:
    """What one number of cylinders needs."""

    cylinders: int = quantity("-")  #: How many stand on one shaft
    flywheel_inertia_bare: float = quantity("kg*m^2")  #: Flywheel without a hinge
    flywheel_inertia_estimate: float = quantity("kg*m^2")  #: Estimate of that beside one spring, from D_1
    swing: float  #: D_1 [kg*m^2]


def even_firing(count: int, period: float) -> tuple[float, ...]:
    """Crank angles [rad] of the cylinders of an evenly firing machine; `period` [rad] is that of one cylinder."""
    return tuple(i * period / count for i in range(count))


def together(point: Point, angles: Sequence[float], factors: Sequence[Pure] | None = None) -> Point:
    """A point of a machine whose cylinders fire at some angles [rad]. factors: gas work of each by the point's."""
    shares = list(factors) if factors is not None else [1.0] * len(angles)
    half = point.omega**2 / 2

    def work(phi: np.ndarray) -> np.ndarray:
        # a share of the gas alone: the masses of all cylinders are the same
        inert = [half * point.inertia(phi + a) for a in angles]
        gas = [point.work(phi + a) - i for a, i in zip(angles, inert, strict=True)]
        return np.asarray(sum(i + s * g for i, s, g in zip(inert, shares, gas, strict=True)))

    kinks = tuple(sorted({round(float((k - a) % point.period), 12) for k in point.kinks for a in angles}))
    misfire = None if point.misfire is None else _one_missing(point, angles)
    return dataclasses.replace(
        point,
        load_torque=point.load_torque * sum(shares),
        work=periodic.fit(work, kinks, point.period, 1e-11),
        inertia=periodic.fit(_sum(point.inertia, angles), kinks, point.period, 1e-11),
        torque=_sum(point.torque, angles, shares),
        misfire=misfire,
        kinks=kinks,
        misfire_kinks=tuple(sorted({*kinks, *point.misfire_kinks})),
    )


def counts(points: Sequence[Point], ripple: float, most: int = 12, added: float = 0.0) -> list[Count]:
    """Flywheels of 1 to `most` evenly firing cylinders for a ripple [-], bare, and with a hinge that adds [kg*m^2]."""
    rows = []
    for n in range(1, most + 1):
        merged = tuple(together(p, even_firing(n, p.period)) for p in points)
        bound = rank(merged, 1)
        rows.append(Count(cylinders=n, flywheel_inertia_bare=bare_flywheel(merged, ripple), swing=bound.swing[0],
                          flywheel_inertia_estimate=flywheel_estimate(merged, bound, ripple, added)))  # fmt: skip
    return rows


def _sum(function: Function, angles: Sequence[float], shares: Sequence[float] | None = None) -> Function:
    factors = shares or [1.0] * len(angles)

    def summed(phi: np.ndarray) -> np.ndarray:
        return np.asarray(sum(f * function(np.asarray(phi) + a) for a, f in zip(angles, factors, strict=True)))

    return summed


def _one_missing(point: Point, angles: Sequence[float]) -> Function:
    """Torque of a turn in which the first cylinder does not fire [N*m]."""
    others = _sum(point.torque, angles[1:]) if len(angles) > 1 else None

    def torque(phi: np.ndarray) -> np.ndarray:
        first = point.misfire(np.asarray(phi) + angles[0])  # type: ignore[misc]
        return np.asarray(first if others is None else first + others(phi))

    return torque

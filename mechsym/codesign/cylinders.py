r"""Machines of several cylinders on one shaft: their works add up, and most of what a hinge would take cancels.

.. math:: W_N(\varphi) = \sum_i W(\varphi + \varphi_i)

One hinge on the shaft then works on what is left. A spread of the cylinders' pressures brings back the order one, which
a guide with one shape cannot take where it changes from day to day.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np

from mechsym import periodic
from mechsym.codesign.points import Function, Point, bare_flywheel
from mechsym.codesign.rank import flywheel_estimate, rank
from mechsym.quantities.results import quantity, result
from mechsym.quantities.units import Pure


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
    """A point of a machine whose cylinders fire at some crank angles [rad].

    factors: gas work of each cylinder by that of the point, for a spread of their pressures.
    """
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
        made = tuple(together(p, even_firing(n, p.period)) for p in points)
        bound = rank(made, 1)
        rows.append(Count(cylinders=n, flywheel_inertia_bare=bare_flywheel(made, ripple), swing=bound.swing[0],
                          flywheel_inertia_estimate=flywheel_estimate(made, bound, ripple, added)))  # fmt: skip
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

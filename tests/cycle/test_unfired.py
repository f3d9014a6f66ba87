"""A turn without combustion goes back along its compression line and never does work."""

import numpy as np
import pytest
from scipy.integrate import quad

from mechsym.cycle.gas import unfired, unfired_kinks

TURN = 2 * np.pi
RATIO = 12.0


def volume(phi):
    return 1 + (RATIO - 1) * (1 - np.cos(phi)) / 2  # of a short crank, by the clearance


def fired(period):
    """Polytropic compression; twice the pressure behind dead centre; in a third and fourth stroke none at all."""

    def force(phi):
        angle = np.asarray(phi, dtype=float) % period
        compressed = 1e3 * volume(angle) ** -1.35
        return np.where(angle < np.pi, 2 * compressed, np.where(angle >= period - np.pi, compressed, 7.0))

    return force


@pytest.mark.parametrize("period", [TURN, 2 * TURN])
def test_compression_line_both_ways(period, rng):
    without = unfired(fired(period), period)
    behind = rng.uniform(1e-6, np.pi - 1e-6, 200)
    assert without(behind) == pytest.approx(1e3 * volume(behind) ** -1.35, rel=1e-12)
    assert without(behind) == pytest.approx(without(-behind), rel=1e-12)
    assert without(behind + 3 * period) == pytest.approx(without(behind), rel=1e-9)
    work = quad(lambda phi: float(without(phi)) * np.sin(phi), -np.pi, np.pi, points=[0.0], epsrel=1e-10)[0]
    assert abs(work) < 1e-7


def test_other_strokes_stay_as_they_are(rng):
    force = fired(2 * TURN)
    other = rng.uniform(np.pi + 1e-6, 2 * TURN - 1e-6, 200)
    assert np.array_equal(unfired(force, 2 * TURN)(other), force(other))


def test_what_expands_below_the_compression_line_is_not_lifted():
    def leaking(phi):
        return np.where(np.asarray(phi) % TURN < np.pi, 1.0, 2.0)

    assert unfired(leaking, TURN)(np.array([0.5, 2.0, 4.0])) == pytest.approx([1.0, 1.0, 2.0])


def test_kinks_are_mirrored_behind_firing_only():
    assert unfired_kinks((0.3, 5.0, 6.0), TURN) == pytest.approx((0.0, TURN - 6.0, 0.3, TURN - 5.0, np.pi, 5.0, 6.0))
    # -9.0 is 3.57 of 4 pi, in the stroke behind the next dead centre
    assert unfired_kinks((9.0, 10.0), 2 * TURN) == pytest.approx((0.0, 2 * TURN - 10.0, np.pi, 9.0, 10.0))
    assert unfired_kinks((np.pi,), TURN) == pytest.approx((0.0, np.pi))
    assert unfired_kinks((), 2 * TURN) == pytest.approx((0.0, np.pi))

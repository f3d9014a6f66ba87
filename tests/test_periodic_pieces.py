"""Pieces, roots and lowest points against scipy, which takes the same steps: differences are those of a compiler."""

import pickle

import numpy as np
import pytest
import scipy
from hypothesis import given, settings
from hypothesis import strategies as st

from mechsym.periodic.pieces import Pieces
from mechsym.periodic.search import lowest, root

_SHAPES = st.tuples(st.integers(1, 11), st.integers(1, 30)) | st.tuples(
    st.integers(1, 5), st.integers(1, 5), st.just(3)
)


def equal(found, expected):
    assert found.shape == expected.shape
    np.testing.assert_allclose(found, expected, rtol=1e-13, atol=1e-13 * np.abs(np.nan_to_num(expected)).max())


@settings(max_examples=12)
@given(_SHAPES, st.sampled_from([True, False, "periodic"]), st.integers(0, 2**32 - 1))
def test_pieces_are_those_of_scipy(shape, extrapolate, seed):
    random = np.random.default_rng(seed)
    x = np.cumsum(random.uniform(0.01, 1, shape[1] + 1))
    own = Pieces(random.standard_normal(shape), x, extrapolate)
    other = scipy.interpolate.PPoly(own.c, x, extrapolate)
    at = np.append(random.uniform(x[0] - 3, x[-1] + 3, 20), x)
    for phi in (at, at[:, None], float(at[0]), 1):
        equal(own(phi), other(phi))
    for order in (1, 12):
        equal(own.derivative(order).c, other.derivative(order).c)
        equal(own(at, order), other.derivative(order)(at))
    equal(own.antiderivative().c, other.antiderivative().c)
    assert own.antiderivative().extrapolate == other.antiderivative().extrapolate


def test_pieces_ask_scipy_for_the_rest():
    own = Pieces([[1.0, 1.0], [-0.5, 0.5]], [0.0, 1.0, 2.0])
    assert own.roots(extrapolate=False) == pytest.approx([0.5])
    assert pickle.loads(pickle.dumps(own))(1.5) == own(1.5) == 1.0
    assert not hasattr(own, "curvature")


@pytest.mark.parametrize("x", [[0.0, 1.0], [0.0, 2.0, 1.0]])
def test_pieces_without_rising_breaks_are_refused(x):
    with pytest.raises(ValueError, match="do not fit"):
        Pieces([[1.0, 2.0]], x)


_ENDS = st.tuples(st.floats(-3, 3), st.floats(0.01, 3)).map(lambda pair: (pair[0], pair[0] + pair[1]))
_ROWS = st.lists(st.floats(-5, 5), min_size=2, max_size=6)


def wave(rows):
    return lambda x: float(np.polyval(rows, x) + np.sin(3 * x))


@settings(max_examples=25)
@given(_ROWS, _ENDS, st.floats(-14, -3))
def test_lowest_takes_the_steps_of_scipy(rows, ends, digits):
    function, tol = wave(rows), 10.0**digits
    other = scipy.optimize.minimize_scalar(function, bounds=ends, method="bounded", options={"xatol": tol}).x
    found = lowest(function, *ends, xatol=tol)
    assert found == pytest.approx(other, abs=tol) and abs(function(found) - function(other)) <= 1e-9


@settings(max_examples=25)
@given(_ROWS, _ENDS, st.floats(-14, -3))
def test_a_root_takes_the_steps_of_scipy(rows, ends, digits):
    function, tol, steps = wave(rows), 10.0**digits, ([], [])
    counted = [lambda x, seen=seen: (seen.append(x), function(x))[1] for seen in steps]
    if function(ends[0]) * function(ends[1]) >= 0:
        return
    other = scipy.optimize.brentq(counted[0], *ends, xtol=tol)
    assert root(counted[1], *ends, xtol=tol) == pytest.approx(other, rel=1e-15, abs=tol)
    assert len(steps[1]) <= len(steps[0]) + 2


def test_a_root_at_an_end_and_none_at_all():
    assert root(lambda x: x - 1, 1.0, 2.0) == 1.0 and root(lambda x: x - 2, 1.0, 2.0) == 2.0
    with pytest.raises(ValueError, match="of one sign"):
        root(lambda x: x, 1.0, 2.0)
    with pytest.raises(ValueError, match="not a number"):
        root(lambda x: np.nan, 1.0, 2.0)
    with pytest.raises(RuntimeError, match="100 steps"):
        root(lambda x: -1.0 if x < np.pi else 1.0, -1e300, 1e308, xtol=1e-300)

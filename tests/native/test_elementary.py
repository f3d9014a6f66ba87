"""The branch-free elementary functions against 60 digits: the bounds that c/elementary.h states."""

import ctypes
import shutil

import mpmath
import numpy as np
import pytest

from mechsym.native import cache
from mechsym.native.source import header

pytestmark = pytest.mark.skipif(not any(map(shutil.which, ("gcc", "clang", "cc"))), reason="no C compiler")

NAMES = ("sin", "cos", "tan", "exp", "log", "asin")
HALF_TURNS = np.pi / 2 * np.arange(1, 3000)
TINY = 10 ** np.linspace(-300, 0, 500)


def _source() -> str:
    head = "void test_{0}(long n, const double *x, const double *z, double *y)"
    loop = head + "\n{{ MS_LANES for (long i = 0; i < n; i++) {1} }}\n"
    bodies = {name: f"y[i] = ms_{name}(x[i]);" for name in ("tan", "exp", "log", "asin")}
    bodies["hypot"] = "y[i] = ms_hypot(x[i], z[i]);"
    bodies["pow"] = "y[i] = ms_pow(x[i], z[i]);"
    bodies["pow_broken"] = "y[i] = ms_pow_broken(x[i], z[i]);"
    bodies["sin"] = "{ double s, c; ms_sincos(x[i], &s, &c); y[i] = s; }"
    bodies["cos"] = "{ double s, c; ms_sincos(x[i], &s, &c); y[i] = c; }"
    loops = "".join('__attribute__((visibility("default"))) ' + loop.format(n, b) for n, b in bodies.items())
    return header("elementary.h") + loops


def _call(mode: str, name: str, x: np.ndarray, z: np.ndarray | None = None) -> np.ndarray:
    x = np.ascontiguousarray(x, dtype=float)
    z = np.ascontiguousarray(x if z is None else z, dtype=float)
    y = np.empty_like(x)
    cache.load(_source(), mode)[f"test_{name}"](
        ctypes.c_long(x.size), *(ctypes.c_void_p(a.ctypes.data) for a in (x, z, y))
    )
    return y


def _ulps(found: np.ndarray, wanted: list) -> float:
    with mpmath.workdps(60):
        return max(
            abs(float((mpmath.mpf(a) - b) / mpmath.mpf(float(np.spacing(abs(float(b)))))))
            for a, b in zip(found.tolist(), wanted, strict=True)
        )


def _exact(name: str, *x: np.ndarray) -> list:
    with mpmath.workdps(60):
        function = getattr(mpmath, {"pow": "power"}.get(name, name))
        return [function(*map(mpmath.mpf, values)) for values in zip(*(a.tolist() for a in x), strict=True)]


def _random(low: float, high: float) -> np.ndarray:
    return np.random.default_rng(11).uniform(low, high, 2000)


CASES = [
    ("sin", _random(-4, 4), 2.0), ("sin", _random(-1e8, 1e8), 2.0), ("sin", HALF_TURNS, 2.0), ("sin", TINY, 1.0),
    ("cos", _random(-4, 4), 2.0), ("cos", _random(-1e8, 1e8), 2.0), ("cos", HALF_TURNS, 2.0),
    ("tan", _random(-4, 4), 3.0),
    ("exp", _random(-1, 1), 1.5), ("exp", _random(-700, 709), 1.5), ("exp", TINY, 1.0),
    ("log", _random(0.5, 2), 1.5), ("log", 10 ** _random(-300, 300), 1.0), ("log", 1 + 1e-6 * _random(-1, 1), 1.0),
    ("asin", _random(-1, 1), 3.0), ("asin", 1 - 10 ** _random(-16, -1), 1.5), ("asin", TINY, 1.5),
]  # fmt: skip


@pytest.mark.parametrize("mode", ["strict", "fast"])
@pytest.mark.parametrize(("name", "x", "bound"), CASES)
def test_error_in_units_of_the_last_place(mode, name, x, bound):
    assert _ulps(_call(mode, name, x), _exact(name, x)) <= bound


@pytest.mark.parametrize("mode", ["strict", "fast"])
@pytest.mark.parametrize(("reach", "bound"), [(3, 1.5), (30, 1.5), (690, 16.0)])
def test_error_of_powers(mode, reach, bound):
    x = 10 ** _random(-2, 2)
    y = reach * np.random.default_rng(5).uniform(-1, 1, x.size) / np.abs(np.log(x))
    y = np.clip(y, -600, 600)
    assert _ulps(_call(mode, "pow", x, y), _exact("pow", x, y)) <= bound


@pytest.mark.parametrize("mode", ["strict", "fast"])
def test_absolute_error_of_sine_for_huge_angles(mode):
    x = _random(-1e10, 1e10)
    wanted = np.array([float(v) for v in _exact("sin", x)])
    assert np.max(np.abs(_call(mode, "sin", x) - wanted)) < 3e-16


EDGES = np.array([0.0, -0.0, np.inf, -np.inf, np.nan, 1, -1, 2, -2, 5e-324, 1e-310, 0.5, -0.5, 3, -3, 1e308])


@pytest.mark.parametrize("mode", ["strict", "fast"])
@pytest.mark.parametrize(("name", "same"), [("exp", np.exp), ("log", np.log), ("asin", np.arcsin)])
def test_edges(mode, name, same):
    with np.errstate(all="ignore"):
        np.testing.assert_allclose(_call(mode, name, EDGES), same(EDGES), rtol=1e-15)


@pytest.mark.parametrize("mode", ["strict", "fast"])
def test_edges_of_powers(mode):
    x, y = (a.ravel() for a in np.meshgrid(EDGES, EDGES[np.isfinite(EDGES)]))
    # minus infinity to a broken power is +inf or 0 in C and not a number here; so is what is no number to the power 0
    kept = ~(np.isneginf(x) & (y != np.round(y))) & ~(np.isnan(x) & (y == 0))
    with np.errstate(all="ignore"):
        np.testing.assert_allclose(_call(mode, "pow", x, y)[kept], np.power(x, y)[kept], rtol=1e-14)


def test_a_broken_power_is_the_power_to_the_last_digit():
    x, y = (a.ravel() for a in np.meshgrid(np.concatenate([EDGES, 10 ** _random(-300, 300)]), [1.3, -0.7, 0.25, 90.1]))
    np.testing.assert_array_equal(_call("strict", "pow_broken", x, y), _call("strict", "pow", x, y))


@pytest.mark.parametrize("mode", ["strict", "fast"])
def test_hypot(mode):
    x, y = _random(-3, 3), np.random.default_rng(7).uniform(-3, 3, 2000)
    assert _ulps(_call(mode, "hypot", x, y), _exact("hypot", x, y)) <= 2.0
    x, y = (a.ravel() for a in np.meshgrid(EDGES, EDGES[~np.isnan(EDGES)]))
    kept = ~(np.isnan(x) & np.isinf(y))
    np.testing.assert_allclose(_call(mode, "hypot", x, y)[kept], np.hypot(x, y)[kept], rtol=1e-15)

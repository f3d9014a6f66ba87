"""Equal Runge-Kutta steps in lanes: order, agreement with CasADi's fold, incomplete blocks, no compiler."""

import shutil

import casadi as ca
import numpy as np
import pytest

from mechsym.cycle.closed import run
from mechsym.native.march import folder

s, y, z = ca.SX.sym("s"), ca.SX.sym("y", 2), ca.SX.sym("z", 2)
# y0 = exp(z0 sin s), and a quadrature beside it
RATE = ca.Function("rate", [s, y, z], [ca.vertcat(z[0] * ca.cos(s) * y[0], z[1] * y[0] * ca.exp(-s))])


@pytest.fixture(params=["strict", "fast", "numpy"])
def fold(request, monkeypatch, tmp_path):
    if request.param == "numpy":
        monkeypatch.delenv("CC", raising=False)
        monkeypatch.setenv("PATH", str(tmp_path))
        return folder(RATE, run.METHOD)
    if not any(map(shutil.which, ("gcc", "clang", "cc"))):
        pytest.skip("no C compiler")
    return folder(RATE, run.METHOD, request.param)


@pytest.mark.parametrize("count", [1, 15, 16, 37])
def test_the_same_as_the_fold_of_casadi(fold, count):
    rng = np.random.default_rng(count)
    start, held = rng.uniform(0.5, 1.5, (2, count)), rng.uniform(-2, 2, (2, count))
    found = fold(start, held, 7)
    one = run.fold(RATE, 7)
    wanted = np.stack([np.asarray(one(start[:, i], held[:, i])).T for i in range(count)], axis=2)
    assert found.shape == (7, 2, count)
    np.testing.assert_allclose(found, wanted, rtol=1e-13, atol=1e-15)


def test_order(fold):
    start, held = np.array([[1.0], [0.0]]), np.array([[6.0], [0.0]])
    errors = [abs(fold(start, held, n)[-1, 0, 0] - np.exp(6 * np.sin(1.0))) for n in (8, 16)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(8, abs=0.7)


def test_arrays_of_the_caller_are_left_alone(fold):
    start, held = np.ones((2, 3)), np.ones((2, 3))
    fold(start, held, 3)
    assert (start == 1).all() and (held == 1).all()

"""Emitted functions against CasADi's interpreter: generated mechanisms, Jacobians, every operator, every route."""

import shutil
import sys

import casadi as ca
import numpy as np
import pytest
from native.models import MECHANISMS, agree, functions, interpreted, mechanism, states

from mechsym import native
from mechsym.errors import BadInput
from mechsym.native import cache

NAMES = [
    (name, f)
    for name in ("crosshead", "crankshaft_flywheel")
    for f in (*mechanism(name).functions, "acceleration", "jacobian")
]
BOUND = {"strict": 1e-12, "fast": 1e-10}
needs_compiler = pytest.mark.skipif(not any(map(shutil.which, ("gcc", "clang", "cc"))), reason="no C compiler")


@pytest.fixture
def no_compiler(monkeypatch, tmp_path):
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))


@needs_compiler
@pytest.mark.parametrize("mode", ["strict", "fast"])
@pytest.mark.parametrize("name", MECHANISMS)
def test_batches_of_every_function_agree_with_the_interpreter(name, mode):
    made = native.compiled_all({f.name(): f for f in functions(name).values()}, mode)
    assert len(made) >= 4
    for f in functions(name).values():
        x = states(f, 600)
        assert made[f.name()].route == "C"
        assert agree(made[f.name()].batch(*x), interpreted(f, x)) < BOUND[mode], f.name()


@needs_compiler
@pytest.mark.parametrize(("name", "function"), NAMES)
def test_scalar_equals_batch_bit_for_bit_in_strict_mode(name, function):
    f = functions(name)[function]
    x = states(f, 40)
    made = native.compiled(f, "strict")
    rows = np.array([np.atleast_1d(made.scalar(*row)) for row in np.array(x).T])
    np.testing.assert_array_equal(rows.T, made.batch(*x))


@pytest.mark.parametrize(("name", "function"), NAMES)
def test_route_without_compiler_agrees(name, function, no_compiler):
    f = functions(name)[function]
    x = states(f, 300)
    made = native.compiled(f)
    assert made.route == "numpy"
    assert "install gcc or clang" in made.reason
    assert agree(made.batch(*x), interpreted(f, x)) < 1e-12
    point = [float(c[7]) for c in x]
    np.testing.assert_allclose(np.atleast_1d(made.scalar(*point)), made.batch(*point)[:, 0], rtol=1e-12, atol=1e-9)


UNARY = ["sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "asinh", "atanh",
         "floor", "ceil", "fabs", "sign", "erf", "log1p", "expm1"]  # fmt: skip
BINARY = ["fmin", "fmax", "atan2", "fmod", "hypot", "copysign"]


def every_operator() -> ca.Function:
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    outputs = [getattr(ca, op)(x) for op in UNARY] + [getattr(ca, op)(x, y) for op in BINARY]
    outputs += [x**y, x**2, x**3, x**0.5, x**-1, x**1.25, 1 / x, x / y, -x, 2 * x, ca.acosh(1 + x)]
    outputs += [ca.if_else(x < y, x, y), ca.if_else(x <= 0.5, 1, 2), ca.logic_and(x > 0.2, y > 0.2)]
    outputs += [ca.logic_or(x > 0.2, y > 0.2), ca.logic_not(x - x), x == y, x != y]
    return ca.Function("every", [x, y], outputs)


@pytest.mark.parametrize("route", ["strict", "fast", "numpy"])
def test_every_operator(route, request):
    if route == "numpy":
        request.getfixturevalue("no_compiler")
    f = every_operator()
    rng = np.random.default_rng(3)
    x = [rng.uniform(0.05, 0.95, 200), rng.uniform(0.05, 2.0, 200)]
    x[1][:5] = x[0][:5]
    made = native.compiled(f, route if route != "numpy" else "strict")
    np.testing.assert_allclose(made.batch(*x), interpreted(f, x), rtol=1e-13)
    np.testing.assert_allclose(made.scalar(0.3, 0.7), made.batch(0.3, 0.7)[:, 0], rtol=1e-15)


@pytest.mark.parametrize("route", ["C", "numpy"])
def test_vectors_matrices_and_sparse_outputs_go_by_columns(route, request):
    if route == "numpy":
        request.getfixturevalue("no_compiler")
    y = ca.SX.sym("y", 2)
    matrix = ca.SX(2, 2)
    matrix[1, 0], matrix[1, 1] = y[0] * y[1], ca.sin(y[1])
    made = native.compiled(ca.Function("f", [y], [matrix, 3 * y[0]], ["y"], ["matrix", "triple"]))
    assert made.inputs == ("y[0]", "y[1]")
    assert made.outputs == ("matrix[0]", "matrix[1]", "matrix[2]", "matrix[3]", "triple")
    wanted = (0.0, 1.0, 0.0, np.sin(0.5), 6.0)
    assert made.scalar(2.0, 0.5) == pytest.approx(wanted, rel=1e-15)
    np.testing.assert_allclose(made.batch([2.0, 2.0], 0.5).T, [wanted, wanted], rtol=1e-15)


@needs_compiler
def test_columns_that_are_not_plain_give_what_plain_ones_give():
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    made = native.compiled(ca.Function("sum", [x, y], [x + 2 * y, x]))
    plain = np.linspace(0.0, 1.0, 6)
    wanted = np.array([3 * plain, plain])
    backwards = np.ascontiguousarray(plain[::-1])[::-1]
    odd = [plain.tolist(), plain.astype(">f8"), plain.astype(np.float32).astype(object), backwards, plain.reshape(2, 3)]
    for column in odd:
        np.testing.assert_allclose(made.batch(column, plain), wanted, rtol=1e-6)
        np.testing.assert_allclose(made.batch(plain, column), wanted, rtol=1e-6)
    whole = np.arange(6)  # as long as doubles, and none
    np.testing.assert_array_equal(made.batch(whole, plain), [whole + 2 * plain, whole])
    for number in (np.float64(0.5), 0.5, np.array(0.5), np.array([0.5]), [0.5]):
        np.testing.assert_array_equal(made.batch(plain, number), [plain + 1.0, plain])
    read_only = plain.copy()
    read_only.flags.writeable = False
    np.testing.assert_array_equal(made.batch(read_only, read_only), wanted)
    np.testing.assert_array_equal(made.batch(1, True), [[3.0], [1.0]])
    assert made.batch(1.0, 2.0).shape == (2, 1)
    wrong = (np.empty((2, 6), dtype=np.float32), np.empty((2, 6), dtype=np.int64))
    for target in (read_only.reshape(2, 3), *wrong, np.empty((6, 2)), np.empty(12)):
        with pytest.raises((BadInput, ValueError)):
            made.batch(plain, plain, out=target)
    with pytest.raises((TypeError, ValueError)):
        made.batch(plain, "two")


@needs_compiler
def test_buffers_are_let_go_of():
    x = ca.SX.sym("x")
    made, column, out = native.compiled(ca.Function("twice", [x], [2 * x])), np.ones(3), np.empty((1, 3))
    before = sys.getrefcount(column), sys.getrefcount(out)
    for _ in range(5):
        made.batch(column)
        made.batch(column, out=out)
        with pytest.raises(BadInput):
            made.batch(column, column)
        with pytest.raises(BadInput):
            made.batch(column, out=out.T)
    assert (sys.getrefcount(column), sys.getrefcount(out)) == before


def test_numbers_and_arrays_mix_and_lengths_are_checked():
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    made = native.compiled(ca.Function("f", [x, y], [x * y]))
    many = np.arange(1000.0)
    np.testing.assert_array_equal(made.batch(many, 3), 3 * many[None])
    np.testing.assert_array_equal(made.batch(many[::2], [2.0]), 2 * many[None, ::2])
    own = np.empty((1, 1000))
    assert made.batch(many, 3, out=own) is own
    assert own[0, 7] == 21.0
    with pytest.raises(BadInput, match=r"shape \(1, 1000\)"):
        made.batch(many, 3, out=own[:, ::2])
    with pytest.raises(BadInput, match="lengths 3, 4"):
        made.batch(np.ones(3), np.ones(4))
    with pytest.raises(BadInput, match="takes 2"):
        made.batch(1.0)
    with pytest.raises(TypeError, match="takes 2 numbers, not 3"):
        made.scalar(1.0, 2.0, 3.0)
    with pytest.raises(TypeError):
        made.scalar(1.0, "two")


def test_a_function_that_cannot_be_expanded_is_refused():
    x = ca.MX.sym("x", 2)
    table = ca.interpolant("table", "bspline", [[0.0, 1.0, 2.0, 3.0, 4.0]], [0.0, 1.0, 4.0, 9.0, 16.0])
    with pytest.raises(BadInput, match="build it from SX"):
        native.compiled(ca.Function("f", [x], [table(x[0])]))


@needs_compiler
def test_values_of_parameters_share_one_compiled_file(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    x = ca.SX.sym("x")

    def scaled(a: float) -> ca.Function:
        return ca.Function("scaled_for_this_test", [x], [ca.sin(a * x) / (1.7 * a)])

    for a in (0.3, 0.7, 123.4):
        assert native.compiled(scaled(a)).scalar(2.0) == pytest.approx(np.sin(2 * a) / (1.7 * a), rel=1e-14)
    assert len([p for p in cache.contents() if p.suffix == ".so"]) == 1


@needs_compiler
def test_loading_leaves_subnormal_numbers_alone():
    # objects linked with -ffast-math switch them off for the whole process
    native.compiled(functions("crosshead")["acceleration"])
    assert np.array([5e-324]) / 1 * 1 > 0
    assert np.float64(2.3e-308) / 4 > 0

"""Compiled functions inside CasADi: values, derivatives, and an optimisation with IPOPT."""

import shutil

import casadi as ca
import numpy as np
import pytest
from native.models import functions

from benchmarks.nlp import nlpsol
from mechsym.native import cache
from mechsym.native.evaluate import external

needs_compiler = pytest.mark.skipif(not any(map(shutil.which, ("gcc", "clang", "cc"))), reason="no C compiler")


def node() -> ca.Function:
    """Defect of a midpoint step of the crosshead engine, with a sparse second output."""
    acceleration = functions("crosshead")["acceleration"]
    a, b, u, h = (ca.SX.sym(n, k) for n, k in (("a", 2), ("b", 2), ("u", 1), ("h", 1)))
    m = (a + b) / 2
    slope = ca.vertcat(m[1], acceleration(m[0], m[1], 1e4 * ca.cos(m[0]), 2e3, u))
    sparse = ca.SX(2, 2)
    sparse[1, 0] = u**2 * h
    return ca.Function("node", [a, b, u, h], [b - a - h * slope, sparse], ["a", "b", "u", "h"], ["defect", "cost"])


POINT = [ca.DM([0.3, 9.0]), ca.DM([0.35, 9.1]), ca.DM(800.0), ca.DM(0.005)]


@needs_compiler
@pytest.mark.parametrize("mode", ["strict", "fast"])
def test_values_and_sparsity(mode):
    f, compiled = node(), external(node(), mode)
    assert compiled.is_a("External")
    for found, wanted in zip(compiled.call(POINT), f.call(POINT), strict=True):
        assert found.sparsity() == wanted.sparsity()
        np.testing.assert_allclose(found.full(), wanted.full(), rtol=1e-11)


@needs_compiler
def test_first_and_second_derivatives_are_compiled_and_exact():
    f, compiled = node(), external(node())
    x = [ca.MX.sym(f.name_in(i), f.size1_in(i)) for i in range(4)]
    every = ca.vertcat(*x)

    def derivatives(g: ca.Function) -> ca.Function:
        value = ca.sum1(g(*x)[0] ** 2) + g(*x)[1][1, 0]
        return ca.Function("d", x, [ca.hessian(value, every)[0], ca.jacobian(g(*x)[0], every)])

    for found, wanted in zip(derivatives(compiled).call(POINT), derivatives(f).call(POINT), strict=True):
        np.testing.assert_allclose(found.full(), wanted.full(), rtol=1e-9, atol=1e-9)


@needs_compiler
def test_optimum_is_the_interpreted_one():
    def solve(g: ca.Function) -> np.ndarray:
        x, u = ca.MX.sym("x", 2, 21), ca.MX.sym("u", 1, 20)
        defects, costs = g.map(20)(x[:, :-1], x[:, 1:], u, 0.01)
        constraints = ca.vertcat(ca.vec(defects), x[:, 0] - ca.DM([0.1, 9.0]), x[1, -1] - 9.0)
        problem = {"x": ca.vertcat(ca.vec(x), ca.vec(u)), "f": ca.sum2(ca.sum1(costs)) * 1e-6, "g": constraints}
        options = {"ipopt.print_level": 0, "print_time": False, "ipopt.sb": "yes"}
        guess = np.concatenate([np.tile([0.1, 9.0], 21), np.zeros(20)])
        return ca.nlpsol("solver", "ipopt", problem, options)(x0=guess, lbg=0, ubg=0)["x"].full().ravel()

    np.testing.assert_allclose(solve(external(node())), solve(node()), rtol=1e-6, atol=1e-6)


@pytest.mark.slow
@needs_compiler
@pytest.mark.parametrize("kind", ["MX", "SX"])
def test_whole_problem_compiled(kind):
    symbol = ca.MX.sym if kind == "MX" else ca.SX.sym
    x, u, p = symbol("x", 2, 41), symbol("u", 1, 40), symbol("p")
    steps = [node()(x[:, k], x[:, k + 1], u[k] - p, 0.01) for k in range(40)]
    constraints = ca.vertcat(*(s[0] for s in steps), x[:, 0] - ca.DM([0.1, 9.0]), x[1, -1] - 9.0)
    problem = {"x": ca.vertcat(ca.vec(x), ca.vec(u)), "p": p, "f": ca.sumsqr(u) * 1e-6, "g": constraints}
    options = {"ipopt.print_level": 0, "print_time": False, "ipopt.sb": "yes"}
    guess = np.concatenate([np.tile([0.1, 9.0], 41), np.zeros(40)])
    compiled = nlpsol("solver", problem, options)
    interpreted = ca.nlpsol("solver", "ipopt", problem, options)
    assert compiled.get_function("nlp_hess_l").is_a("External")
    for load in (0.0, 100.0):
        found, wanted = (s(x0=guess, p=load, lbg=0, ubg=0) for s in (compiled, interpreted))
        np.testing.assert_allclose(found["x"].full(), wanted["x"].full(), rtol=1e-5, atol=1e-5)
        np.testing.assert_allclose(found["lam_p"].full(), wanted["lam_p"].full(), rtol=1e-4, atol=1e-9)


def test_without_a_compiler_the_problem_is_interpreted(monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    x = ca.SX.sym("x")
    solver = nlpsol(
        "solver", {"x": x, "f": (x - 3) ** 2}, {"ipopt.print_level": 0, "print_time": False, "ipopt.sb": "yes"}
    )
    assert float(solver(x0=0)["x"]) == pytest.approx(3)


def test_without_a_compiler_the_function_itself_comes_back(monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    f = node()
    assert external(f) is f


@needs_compiler
def test_file_is_in_the_cache(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    external(node())
    assert {p.suffix for p in cache.contents()} == {".c", ".so"}

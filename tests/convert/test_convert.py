"""sympy to CasADi: every kind of node against lambdify, and the equations of sympy's own mechanics tests."""

import math

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import LagrangesMethod, Particle, Point, ReferenceFrame, dynamicsymbols

from mechsym import convert
from mechsym.derive import Mechanism, UnsupportedNode, casadi_text, output, to_casadi, velocity
from mechsym.errors import BadInput

x, y, z = sp.symbols("x y z", real=True)
NODES = [
    x + y - z / 3, x * y**3 / z, x**-2, sp.sqrt(x) / sp.sqrt(y), x ** sp.Rational(2, 3), x**y, sp.exp(x - y),
    sp.log(x * y), sp.sin(x) * sp.cos(y), sp.tan(x), sp.asin(x / 4), sp.acos(y / 4), sp.atan(z), sp.atan2(y - 1, x -
    1), sp.sinh(x), sp.cosh(y), sp.tanh(z), sp.asinh(x), sp.atanh(y / 4), sp.Abs(x - y), sp.sign(y - x), sp.floor(3
    * x) + sp.ceiling(2 * y), sp.Max(x, y, z) - sp.Min(x, y), sp.Mod(-x, y), sp.erf(x), sp.sec(x) + sp.csc(y) +
    sp.cot(z), sp.Piecewise((x, x > y), (y**2, sp.And(y > z, x > 0)), (z, True)), sp.Heaviside(x - y) + sp.pi *
    sp.E,
]  # fmt: skip


@pytest.mark.parametrize("expression", NODES, ids=str)
def test_every_node_is_that_of_lambdify(expression):
    converted, wanted = (
        convert.casadi(expression, inputs=(x, y, z)),
        sp.lambdify((x, y, z), expression, ["scipy", "numpy"]),
    )
    for values in np.random.default_rng(3).uniform(0.2, 2.5, (20, 3)):
        assert float(converted(*values)) == pytest.approx(float(wanted(*values)), rel=1e-12, abs=1e-12)


def test_the_matrix_of_all_nodes_keeps_its_shape_and_shares_parts():
    matrix = sp.Matrix(7, 4, NODES)
    converted = convert.casadi(matrix, inputs=(x, y, z))
    assert converted.size_out(0) == (7, 4)
    wanted = sp.lambdify((x, y, z), matrix, ["scipy", "numpy"])(0.7, 1.1, 1.9)
    np.testing.assert_allclose(np.asarray(converted(0.7, 1.1, 1.9)), np.asarray(wanted, dtype=float), rtol=1e-12)
    long = sp.sin(x) ** 2 + sp.sqrt(sp.sin(x) ** 2 + 1)
    assert convert.casadi(long).n_instructions() < 10


def test_branches_that_do_not_hold_do_not_poison_the_result():
    root = convert.casadi(sp.Piecewise((sp.sqrt(x), x > 0), (0, True)))
    assert float(root(-1.0)) == 0.0


def double_pendulum():
    q1, q2 = dynamicsymbols("q1 q2")
    l, m, g = sp.symbols("l m g")
    N = ReferenceFrame("N")
    O, A, B = Point("O"), Point("A"), Point("B")
    A.set_vel(N, l * q1.diff() * (sp.cos(q1) * N.x + sp.sin(q1) * N.y))
    B.set_vel(N, A.vel(N) + l * q2.diff() * (sp.cos(q2) * N.x + sp.sin(q2) * N.y))
    O.set_vel(N, 0)
    T = sum(Particle(n, p, m).kinetic_energy(N) for n, p in (("a", A), ("b", B)))
    L = T + m * g * l * (2 * sp.cos(q1) + sp.cos(q2))
    return LagrangesMethod(L, [q1, q2]), (q1, q2, q1.diff(), q2.diff()), (l, m, g)


def test_lagranges_method_has_the_accelerations_of_the_double_pendulum():
    method, state, parameters = double_pendulum()
    converted = convert.casadi(method, inputs=(*state, *parameters))
    assert converted.name_in() == ["q1", "q2", "q1d", "q2d", "l", "m", "g"]
    a, b, u, v, l, m, g = values = (0.3, -0.8, 1.2, 0.4, 0.7, 1.1, 9.81)
    mass, forcing = (np.asarray(o) for o in converted(*values))
    d = math.cos(a - b)
    M = np.array([[2 * l, l * d], [l * d, l]])
    s = math.sin(a - b)
    right = np.array([-l * s * v**2 - 2 * g * math.sin(a), l * s * u**2 - g * math.sin(b)])
    np.testing.assert_allclose(np.linalg.solve(mass, forcing).ravel(), [u, v, *np.linalg.solve(M, right)], rtol=1e-12)


class Caught(Exception):
    pass


def method_of(module, test, monkeypatch):
    """The first KanesMethod of one of sympy's own tests, with its equations."""

    class Catching(module.KanesMethod):
        def kanes_equations(self, *args, **kwargs):
            super().kanes_equations(*args, **kwargs)
            raise Caught(self)

    monkeypatch.setattr(module, "KanesMethod", Catching)
    with pytest.raises(Caught) as caught:
        getattr(test, "__wrapped__", test)()
    return caught.value.args[0]


def assert_as_lambdify(method, seed, tolerance=1e-12):
    rates = method.kindiffdict()
    wanted = [method.mass_matrix_full.subs(rates), method.forcing_full.subs(rates)]
    letters = sorted(set.union(*(m.free_symbols for m in wanted)) - {sp.Symbol("t")}, key=str)
    state = sorted(set.union(*(m.atoms(sp.core.function.AppliedUndef) for m in wanted)), key=str)
    letters = [s for s in letters if s != dynamicsymbols._t]
    converted = convert.casadi(method, inputs=(*state, *letters))
    values = np.random.default_rng(seed).uniform(0.2, 0.9, len(state) + len(letters))
    for found, matrix in zip(converted(*values), wanted, strict=True):
        exact = np.asarray(sp.lambdify((*state, *letters), matrix, cse=True)(*values), dtype=float)
        assert np.abs(np.asarray(found) - exact).max() <= tolerance * np.abs(exact).max()


def test_the_rolling_disc_of_sympy(monkeypatch):
    from sympy.physics.mechanics.tests import test_kane as sympys

    assert_as_lambdify(method_of(sympys, sympys.test_rolling_disc, monkeypatch), 1)


@pytest.mark.slow
@pytest.mark.heavy
def test_the_bicycle_of_sympy(monkeypatch):
    from sympy.physics.mechanics.tests import test_kane3 as sympys

    assert_as_lambdify(method_of(sympys, sympys.test_bicycle, monkeypatch), 2)


@pytest.mark.parametrize(
    ("source", "inputs", "message"),
    [
        (x + y, (x,), "the letter y is not among the inputs"),
        (sp.gamma(x), (x,), "gamma .* has no CasADi counterpart"),
        (sp.Piecewise((x, x > 0)), (x,), "end it with"),
        (x + sp.Symbol("x_", real=True), (), "would both be called 'x'"),
        ("3 +", (), "no expression of sympy"),
        (x + sp.zoo, (x,), "undefined number"),
    ],
)
def test_what_cannot_be_converted_is_refused_by_name(source, inputs, message):
    with pytest.raises(BadInput, match=message):
        convert.casadi(source, inputs)


class Text(str):
    pass


# run by sympy's own reading, it would leave a mark
RUNS = "__import__('pathlib').Path('{}').touch()"
HIDDEN = [
    lambda text: text, Text, np.str_, lambda text: text.encode(), lambda text: [text], lambda text: ((text,),),
    lambda text: {text: text}, lambda text: np.array([text]), lambda text: np.array([text], dtype=object),
]  # fmt: skip


@pytest.mark.parametrize("hide", HIDDEN)
def test_a_text_is_not_read_which_sympy_would_run(hide, tmp_path):
    mark = tmp_path / "ran"
    bad = hide(RUNS.format(mark))
    m = Mechanism("wheel", about="Turns.")
    phi = m.coordinates("phi")
    calls = {
        "convert": lambda: convert.casadi(bad),
        "convert inputs": lambda: convert.casadi(x, (bad,)),
        "text": lambda: casadi_text(bad),
        "values": lambda: to_casadi(bad, {}),
        "let": lambda: m.let("x", bad, "m"),
        "force": lambda: m.force(bad, along=phi),
        "torque": lambda: m.torque(phi, along=bad),
        "link": lambda: m.link("rod", turns=bad, mass=1),
        "body": lambda: m.body("rod", mass=bad),
        "spring": lambda: m.spring(bad, stretch=phi),
        "output": lambda: output(m, bad),
        "velocity": lambda: velocity(m, bad),
    }
    for name, call in calls.items():
        with pytest.raises((BadInput, UnsupportedNode)):
            call()
        assert not mark.exists(), name


def test_letters_get_names_that_casadi_takes():
    phi, alpha = dynamicsymbols("φ"), sp.Symbol(r"\alpha_{1}")
    f = convert.casadi(phi.diff() * alpha + phi, inputs=(phi, phi.diff(), alpha))
    assert f.name_in() == ["phi", "phid", "alpha_1"]
    assert float(f(1, 2, 3)) == 7

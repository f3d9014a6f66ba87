"""The sympy -> CasADi converter, node by node: text, value on floats, value on symbols."""

import casadi as ca
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from mechsym.derive import UnsupportedNode, casadi_text, to_casadi

x, y, z = sp.symbols("x y z", real=True)
HALF, THIRD = sp.Rational(1, 2), sp.Rational(1, 3)

NODES = [
    x + y * z, x - y, -x, -x * y, x - (y - z), x * (y + z), THIRD * x - 2 * y,
    x / y, x / (y * z), -x / (y + z), 1 / x, (x / y) ** z, (1 / x) ** y,
    x**2, x**-2, (x + y) ** -2, sp.sqrt(x), 1 / sp.sqrt(x), y / sp.sqrt(x + 1), x ** (3 * HALF), x**y, x ** (-y),
    HALF**x, (x**y) ** z, sp.sqrt(2) * x, 1 / (x * sp.sqrt(y)), sp.pi * x, sp.exp(1) * x,
    sp.sin(x), sp.cos(x), sp.tan(x), sp.asin(x / 4), sp.acos(x / 4), sp.atan(x), sp.atan2(y, x), sp.sinh(x),
    sp.cosh(x), sp.tanh(x), sp.exp(-x), sp.log(x), sp.Abs(x - y), sp.sign(x - y), sp.floor(3 * x + THIRD),
    sp.ceiling(3 * x + THIRD), sp.erf(x),
    sp.Max(x, y, z), sp.Min(x, y, 0), sp.Mod(x, y), sp.Mod(-x - 1, y + 1), 3 * sp.Mod(x, 1) + 2 * sp.Mod(-y, 2),
    sp.Piecewise((x, x > y), (y, x < z), (z, True)),
    sp.Piecewise((x, sp.And(x > y, x > z)), (y, sp.Or(x >= z, y <= z)), (z, True)),
    sp.Piecewise((x, sp.Not(sp.And(x > y, y > z))), (y, True)),
    sp.Piecewise((x, sp.Eq(sp.floor(x + THIRD), 1)), (y, sp.Ne(sp.floor(y + THIRD), 0)), (z, True)),
]  # fmt: skip
POINTS = [(0.3, 1.7, 0.9), (1.4, 0.2, 0.6), (1.0, 1.0, 2.5), (2.2, 1.9, 0.1)]


@pytest.mark.parametrize("node", NODES, ids=[str(n) for n in NODES])
def test_node_has_the_same_value_as_in_sympy(node):
    letters = [ca.SX.sym(n) for n in "xyz"]
    function = ca.Function("f", letters, [to_casadi(node, dict(zip("xyz", letters, strict=True)))])
    for point in POINTS:
        exact = float(node.evalf(30, subs=dict(zip((x, y, z), map(sp.Float, point), strict=True))))
        assert float(to_casadi(node, dict(zip("xyz", point, strict=True)))) == pytest.approx(
            exact, rel=1e-14, abs=1e-14
        )
        assert float(function(*point)) == pytest.approx(exact, rel=1e-14, abs=1e-14)


def test_matrix_keeps_its_shape():
    matrix = sp.Matrix([[x, 0, y], [z, 1, x * y]])
    value = to_casadi(matrix, {"x": ca.SX.sym("x"), "y": ca.SX.sym("y"), "z": 2.0})
    assert value.shape == (2, 3)
    assert casadi_text(matrix) == "ca.vertcat(ca.horzcat(x, 0, y), ca.horzcat(z, 1, x * y))"


@pytest.mark.parametrize(
    ("expression", "name"),
    [
        (sp.gamma(x), "gamma"),
        (sp.Function("hull")(x), "hull"),
        (sp.besselj(0, x), "besselj"),
        (sp.Derivative(sp.Function("f")(x), x), "f"),
        (sp.Integral(sp.sin(x) / x, x), "Integral"),
        (sp.Float("0.1") * x, "Float"),
        (sp.I * x, "ImaginaryUnit"),
        (sp.oo, "Infinity"),
        (sp.Xor(x > 0, y > 0), "Xor"),
    ],
)
def test_what_has_no_counterpart_is_refused_by_name(expression, name):
    with pytest.raises(UnsupportedNode, match=name):
        casadi_text(expression)


def test_piecewise_without_a_default_is_refused():
    with pytest.raises(UnsupportedNode, match="True"):
        casadi_text(sp.Piecewise((x, x > 0)))


@pytest.mark.parametrize("name", ["lambda", "m 1", "1x"])
def test_letters_that_are_no_identifiers_are_refused(name):
    with pytest.raises(UnsupportedNode, match="identifier"):
        casadi_text(sp.Symbol(name) + 1)


def test_a_letter_without_a_value_is_named():
    with pytest.raises(UnsupportedNode, match="no value for y"):
        to_casadi(x + y, {"x": 1.0})


def test_text_does_not_depend_on_the_order_of_construction():
    assert casadi_text(x * y + z + x**2) == casadi_text(x**2 + z + y * x)


_leaf = st.sampled_from([x, y, z, sp.Integer(2), THIRD, sp.pi])
_tree = st.recursive(
    _leaf,
    lambda t: st.one_of(
        st.tuples(t, t).map(lambda p: p[0] + p[1]),
        st.tuples(t, t).map(lambda p: p[0] - 2 * p[1]),
        st.tuples(t, t).map(lambda p: p[0] * p[1]),
        st.tuples(t, t).map(lambda p: p[0] / (1 + p[1] ** 2)),
        t.map(sp.sin),
        t.map(lambda e: sp.sqrt(1 + e**2)),
        st.tuples(t, t).map(lambda p: sp.Max(p[0], p[1])),
    ),
    max_leaves=8,
)


@given(_tree)
def test_random_expressions_keep_their_value(expression):
    point = {"x": 0.37, "y": 1.21, "z": 0.83}
    exact = float(expression.subs({x: sp.Rational("0.37"), y: sp.Rational("1.21"), z: sp.Rational("0.83")}).evalf(30))
    assert float(to_casadi(expression, point)) == pytest.approx(exact, rel=1e-12, abs=1e-12)

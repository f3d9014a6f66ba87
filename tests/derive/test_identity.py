"""Zero or not: the certificate proves identities, proves nothing false, and proves every derived mechanism."""

import random

import pytest
import sympy

from mechsym.derive import derive
from mechsym.derive.build import declared, scripts
from mechsym.derive.identity import random_state, vanishes, vanishes_at_random_points
from mechsym.derive.textbook import proved

x, y, n = sympy.symbols("x y n", positive=True)
a, b, lam = sympy.symbols("a b lam", real=True)
ROOT = sympy.sqrt(1 - lam**2 * sympy.sin(a) ** 2)


@pytest.mark.parametrize(
    "expression",
    [
        sympy.sin(a) ** 2 + sympy.cos(a) ** 2 - 1,
        sympy.sin(2 * a) - 2 * sympy.sin(a) * sympy.cos(a),
        sympy.cos(a) - 1 + 2 * sympy.sin(a / 2) ** 2,
        sympy.tan(a) * sympy.cos(a) - sympy.sin(a),
        sympy.sqrt(x**2 - x**2 * y**2) - x * sympy.sqrt(1 - y**2),
        1 / sympy.sqrt(1 + x) - sympy.sqrt(1 + x) / (1 + x),
        sympy.sqrt(4 * x + 8) - 2 * sympy.sqrt(x + 2),
        x ** (1 - n) * x**n - x,
        sympy.cos(sympy.asin(y / (1 + y))) - sympy.sqrt(1 - (y / (1 + y)) ** 2),
        ROOT**3 / (1 - lam**2 * sympy.sin(a) ** 2) - ROOT,
        sympy.sqrt(1 - (lam / b) ** 2) ** 3 - (1 - (lam / b) ** 2) * sympy.sqrt((b**2 - lam**2) / b**2),
    ],
)
def test_certificate_proves_identities(expression):
    assert vanishes(expression)


@pytest.mark.parametrize(
    "expression",
    [
        sympy.sqrt(sympy.cos(a) ** 2) - sympy.cos(a),
        sympy.sin(a),
        sympy.sqrt(x) - x,
        (x + 1) ** 40 - 1,
        ROOT - sympy.sqrt(1 - lam**2 * sympy.cos(a) ** 2),
        sympy.sqrt(b**2) - b,
        sympy.sqrt(1 / b**2) * b - 1,
    ],
)
def test_certificate_proves_nothing_false(expression):
    assert not vanishes(expression)


def test_digits_refute_what_floats_cannot_tell_from_zero():
    states = [random_state([x, y], random.Random(1)) for _ in range(3)]
    assert vanishes_at_random_points((x + y) ** 2 - x**2 - 2 * x * y - y**2, x, states)
    assert not vanishes_at_random_points(x * sympy.Rational(1, 10**30), x, states)


@pytest.mark.slow
@pytest.mark.parametrize("name", [n for n in scripts() if not n.endswith("_printed")])
def test_every_derivation_is_proved_for_all_states(name):
    assert proved(derive(declared(name)))

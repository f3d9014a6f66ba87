"""Generated functions against the derived expressions at 30 digits, and emitted derivatives against CasADi's."""

import re

import casadi as ca
import numpy as np
import pytest
import sympy as sp

from mechsym.derive import derive
from mechsym.derive.build import declared, scripts
from mechsym.derive.emit import groups
from mechsym.derive.tape import derivative_name
from mechsym.mechanisms.record import (generated)


def admissible(names, rng):
    # rods longer than cranks: letters that start with l get 2 more
    return {n: float(rng.uniform(0.1, 1.0)) + (2.0 if n[0] == "l" else 0.0) for n in names}


@pytest.mark.slow
@pytest.mark.parametrize("name", scripts())
def test_generated_functions_equal_the_derivation(name, rng):
    equations = derive(declared(name))
    held = dict.fromkeys(equations.mechanism.joint_list, 0)
    module = generated(name)
    for group in groups(equations):
        arguments, outputs = module.FUNCTIONS[group.name]
        values = admissible(arguments, rng)
        computed = dict(zip(outputs, getattr(module, group.name)(**values), strict=True))
        exact = {sp.Symbol(k, real=True): sp.Rational(v) for k, v in values.items()}
        for output, expression in group.outputs.items():
            wanted = float(equations.mechanism.tape.flat(expression).xreplace(held).evalf(30, subs=exact))
            assert float(computed[output]) == pytest.approx(wanted, rel=1e-11, abs=1e-13), (group.name, output)


@pytest.mark.parametrize("name", scripts())
def test_emitted_derivatives_are_the_automatic_ones(name, rng):
    module = generated(name)
    arguments, outputs = module.FUNCTIONS["kinematics"]
    symbols = {n: ca.SX.sym(n) for n in arguments}
    values = dict(zip(outputs, map(ca.SX, module.kinematics(**symbols)), strict=True))
    point = admissible(arguments, rng)
    checked = set()
    for q in module.COORDINATES:
        first = {o: derivative_name(o, [q]) for o in outputs}
        second = {derivative_name(o, [q]): derivative_name(o, [q, q]) for o in outputs}
        for low, high in [*first.items(), *second.items()]:
            if low in values and high in values:
                automatic = ca.gradient(values[low], symbols[q])
                difference = ca.Function("d", list(symbols.values()), [automatic - values[high], values[high]])
                error, size = (float(v) for v in difference(*(point[n] for n in arguments)))
                assert abs(error) <= 1e-12 * (1 + abs(size)), (low, high)
                checked.add(high)
    assert checked == {o for o in outputs if re.match(r"d2?[A-Za-z]\w*_d", o)}


@pytest.mark.parametrize("name", scripts())
def test_floats_rows_and_symbols_give_the_same(name, rng):
    module = generated(name)
    arguments, outputs = module.FUNCTIONS["dynamics"]
    symbols = [ca.SX.sym(n) for n in arguments]
    results = [ca.SX(v) for v in module.dynamics(*symbols)]
    function = ca.Function("f", symbols, results)
    rows = {n: rng.uniform(0.1, 0.9, 5) + (2.0 if n[0] == "l" else 0.0) for n in arguments}
    batch = function.call([ca.DM(rows[n]).T for n in arguments])
    for i in range(5):
        single = module.dynamics(*(float(rows[n][i]) for n in arguments))
        assert np.allclose([float(v) for v in single], [float(b[i]) if b.numel() > 1 else float(b) for b in batch], rtol=1e-14)

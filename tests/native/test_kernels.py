"""Reading the tape, rolling equal throws, sharing reciprocals."""

import collections
import json
import math
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from native.models import MECHANISMS, agree, chain, functions, interpreted

from mechsym import native
from mechsym.native import source
from mechsym.native.evaluate import numpy_function
from mechsym.native.kernels import constant_table, kernels, split
from mechsym.native.tape import cheaper, factored, read

# a change of the derivations or of CasADi that makes generated functions dearer must be seen
BASELINE = Path(__file__).parent / "operation-counts.json"


def operation_counts(tape):
    """How often each operator occurs; a sine and a cosine of one angle count as one `sincos`."""
    operators = [(op, args) for op, args in tape.nodes if op not in ("input", "constant")]
    counts = collections.Counter(op for op, _ in operators if op not in ("sin", "cos"))
    if angles := {args[0] for op, args in operators if op in ("sin", "cos")}:
        counts["sincos"] = len(angles)
    return {**counts, "total": counts.total()}


def test_operation_counts_do_not_grow(request):
    found = {
        f"{name}.{key}": {mode: operation_counts(source.program(f, mode).tape)["total"] for mode in ("strict", "fast")}
        for name in MECHANISMS
        for key, f in functions(name).items()
    }
    if request.config.getoption("--update"):
        lines = [f"  {json.dumps(name)}: {json.dumps(counts)}" for name, counts in found.items()]
        BASELINE.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
    stored = json.loads(BASELINE.read_text(encoding="utf-8"))
    changed = {name: (stored.get(name), counts) for name, counts in found.items() if counts != stored.get(name)}
    assert found.keys() == stored.keys()
    assert not changed, f"stored and found: {changed}; if this is wanted: pytest --update"


def test_equal_instructions_are_merged_and_dead_ones_dropped():
    x = ca.SX.sym("x")
    tape = read(ca.Function("f", [x], [ca.sin(x) * x + ca.sin(x) * x]))
    assert operation_counts(tape) == {"mul": 1, "sincos": 1, "twice": 1, "total": 3} or operation_counts(tape) == {
        "add": 1, "mul": 1, "sincos": 1, "total": 3,
    }  # fmt: skip


@pytest.mark.parametrize("throws", [2, 3, 6, 12])
def test_throws_become_instances_of_few_kernels(throws):
    f = chain(throws)
    found = kernels(read(f))
    assert len(found) <= 4
    assert sorted(o for k in found for row in k.outputs for o in row) == list(range(throws + 1))
    x = np.random.default_rng(2).uniform(-3, 3, (f.size1_in(0) + f.size1_in(1) + f.size1_in(2), 300))
    made = native.compiled(f, "strict")
    grouped = [x[: throws + 1], x[throws + 1 : 2 * throws + 2], x[2 * throws + 2 :]]
    wanted = np.asarray(f.map(300)(*grouped))
    assert agree(made.batch(*x), wanted) < 1e-12
    np.testing.assert_array_equal([made.scalar(*column) for column in x[:, :20].T], made.batch(*x[:, :20]).T)


def test_text_grows_only_by_places_with_the_number_of_throws():
    sizes = {n: len(source.evaluation([source.program(chain(n))])) for n in (4, 12, 24)}
    assert sizes[12] < 1.1 * sizes[4]
    assert sizes[24] < 1.2 * sizes[4]


def test_functions_that_share_nothing_costly_stay_one_kernel_when_small():
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    found = kernels(read(ca.Function("f", [x, y], [ca.sin(x), ca.sin(y)])))
    assert len(found) == 1
    assert len(found[0].inputs) == 1


def test_constants_are_data():
    x = ca.SX.sym("x")

    def made(a: float) -> tuple:
        return kernels(read(ca.Function("f", [x], [a * ca.sin(x) + 0.5])))

    assert made(3.7)[0].nodes == made(4.9)[0].nodes
    assert constant_table(made(3.7)).tolist() == [3.7]


def test_division_rules():
    x, y, z = (ca.SX.sym(n) for n in "xyz")
    root = ca.sqrt(z)
    f = ca.Function("f", [x, y, z], [x / z, y / root, x / 3, 1 / root, y / ca.sin(x)])
    tape = cheaper(read(f))
    counts = operation_counts(tape)
    assert counts["div"] == 1
    assert counts["inv"] == 1
    assert counts["sqrt"] == 1
    made = native.compiled(f, "fast").batch(*(v := np.random.default_rng(0).uniform(0.5, 2, (3, 100))))
    np.testing.assert_allclose(made, interpreted(f, list(v)), rtol=1e-15 * 8)


def test_common_factors_are_taken_out_of_sums():
    a, b, c, w = (ca.SX.sym(n) for n in "abcw")
    shared = b * c
    bias = a * b * w**2 + 3.7 * c * w**2 - 5.3 * a * c * w**2
    f = ca.Function("f", [a, b, c, w], [bias, shared + shared * a, shared])
    tape = factored(read(f))
    assert operation_counts(tape)["mul"] + operation_counts(tape).get("sq", 0) <= 8
    x = list(np.random.default_rng(4).uniform(-2, 2, (4, 200)))
    assert agree(native.compiled(f, "fast").batch(*x), interpreted(f, x)) < 1e-12


def test_sums_over_groups_are_a_second_stage():
    x = ca.SX.sym("x", 40)
    parts = [ca.sqrt(2 + ca.sin(x[i]) * ca.cos(x[i + 1])) for i in range(39)]
    chained = [a + b for a, b in zip(parts, parts[1:], strict=False)]
    tape = read(ca.Function("f", [x], [ca.vertcat(*chained), sum(parts)]))
    assert len(kernels(tape)) == 1 and len(kernels(tape)[0].inputs) == 1
    first, second = split(tape)
    assert len(first.results) == 39
    assert [len(k.inputs) for k in kernels(first)] == [39]
    assert not set(operation_counts(second)) - {"add", "total"}
    v = np.random.default_rng(1).uniform(-1, 1, 40)
    values = numpy_values(second, [*v, *numpy_values(first, list(v))])
    np.testing.assert_allclose(values, numpy_values(tape, list(v)), rtol=1e-14)


def numpy_values(tape, x):
    y = np.empty((len(tape.results), 1))
    numpy_function(tape)([np.array([value]) for value in x], y)
    return y[:, 0].tolist()


def test_a_program_without_sums_has_one_stage():
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    assert split(read(ca.Function("f", [x, y], [ca.sin(x), ca.cos(y) * y]))) is None


def test_broken_powers_become_exponentials():
    x = ca.SX.sym("x")
    f = ca.Function("f", [x], [x**0.7, x**1.25, x**0.5, x**3])
    counts = operation_counts(cheaper(read(f)))
    assert (counts["exp"], counts["log"], counts["sqrt"]) == (2, 1, 1)
    values = np.array([0.0, 1e-300, 0.3, 1.0, 7.0, 1e200])
    np.testing.assert_allclose(native.compiled(f).batch(values)[:2], [values**0.7, values**1.25], rtol=2e-13)


def test_division_by_zero_constant_is_infinite():
    x = ca.SX.sym("x")
    made = native.compiled(ca.Function("f", [x], [x / ca.SX(0)]), "fast")
    assert made.scalar(2.0) == math.inf

"""One function along angles: scalars, vectors and matrices, with the points as the last axis."""

import casadi as ca
import numpy as np
import pytest

from mechsym import cases, mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms import evaluate, state
from mechsym.native import evaluate as native


@pytest.mark.parametrize("name", ["zotov-89", "chmielewski", "alpha-stirling", "nunes-hypocycloid"])
def test_points_agree_with_single_states(name, rng):
    case = cases.load(name)
    mechanism = mechanisms.build(case.mechanism, case.need("parameters"))
    q, u = mechanism.coordinates, tuple(f"{c}d" for c in mechanism.coordinates)
    letters = {n: rng.uniform(-1, 1, 5) for n in (*q, *u)}
    found = evaluate(mechanism, "dynamics", **letters)
    for i in range(5):
        one = state(mechanism, {n: float(v[i]) for n, v in letters.items()})
        n = len(q)
        assert found["mass_matrix"].reshape(n, n, 5)[..., i] == pytest.approx(np.array(one.mass_matrix), rel=1e-14)
        for vector in ("bias", "generalized_force"):
            wanted = np.array(getattr(one, vector))
            assert found[vector].reshape(n, 5)[:, i] == pytest.approx(wanted, rel=1e-12, abs=1e-9)
    energies = evaluate(mechanism, "energy", **letters)
    assert {v.shape for v in energies.values()} == {(5,)}


@pytest.mark.parametrize("name", ["zotov-89", "chmielewski", "alpha-stirling", "nunes-hypocycloid", "balandin"])
def test_many_points_agree_with_few(name, rng):
    # numpy's sine beside the one of the C library
    case = cases.load(name)
    mechanism = mechanisms.build(case.mechanism, case.need("parameters"))
    for group, function in mechanism.functions.items():
        letters = {n: rng.uniform(-1, 1, 150) for n in function.name_in()[: max(1, function.n_in() - 1)]}
        found, last = evaluate(mechanism, group, **letters), slice(100, 150)
        few = evaluate(mechanism, group, **{n: v[last] for n, v in letters.items()})
        assert native.arrays(function) is not None and native.arrays(function) is native.arrays(function)
        for output, values in few.items():
            assert found[output].shape == (*values.shape[:-1], 150)
            size = np.abs(values).max(initial=0.0)
            assert found[output][..., last] == pytest.approx(values, rel=1e-14, abs=4e-15 * size), (group, output)


def test_what_numpy_cannot_do_is_left_to_casadi():
    x = ca.SX.sym("x")
    inner = ca.Function("inner", [x], [ca.sin(x)], {"never_inline": True})
    assert native.arrays(ca.Function("outer", [x], inner.call([x]))) is None
    long = x
    for _ in range(native._LONGEST):
        long = long * x + 1
    assert native.arrays(ca.Function("long", [x], [long])) is None


def test_unknown_groups_and_letters_are_refused():
    case = cases.load("zotov-89")
    mechanism = mechanisms.build(case.mechanism, case.need("parameters"))
    with pytest.raises(BadInput, match="has no 'speed'; it has kinematics"):
        evaluate(mechanism, "speed", phi=1.0)
    with pytest.raises(BadInput, match="takes no psi; it takes phi"):
        evaluate(mechanism, "kinematics", psi=1.0)

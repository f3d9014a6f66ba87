"""One function along angles: scalars, vectors and matrices, with the points as the last axis."""

import numpy as np
import pytest

from mechsym import cases, mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms import evaluate, state


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
        assert found["mass_matrix"].reshape(n, n, 5)[..., i] == pytest.approx(np.array(one["mass_matrix"]), rel=1e-14)
        for vector in ("bias", "generalized_force"):
            assert found[vector].reshape(n, 5)[:, i] == pytest.approx(np.array(one[vector]), rel=1e-12, abs=1e-9)
    energies = evaluate(mechanism, "energy", **letters)
    assert {v.shape for v in energies.values()} == {(5,)}


def test_unknown_groups_and_letters_are_refused():
    case = cases.load("zotov-89")
    mechanism = mechanisms.build(case.mechanism, case.need("parameters"))
    with pytest.raises(BadInput, match="has no 'speed'; it has kinematics"):
        evaluate(mechanism, "speed", phi=1.0)
    with pytest.raises(BadInput, match="takes no psi; it takes phi"):
        evaluate(mechanism, "kinematics", psi=1.0)

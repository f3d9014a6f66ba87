"""Links and joints: every closed form obeys Newton and Euler link by link, and closes."""

import linkages
import numpy as np
import pytest
from newton_euler import Oracle

from mechsym.derive import derive
from mechsym.derive.autodiff import disagreement
from mechsym.derive.emit import module_text
from mechsym.mechanisms import loops
from mechsym.mechanisms.own import _module
from mechsym.mechanisms.record import bind_module
from mechsym.mechanisms.state import state

STATES = [{"phi": 0.4, "phid": 5.0, "phidd": -3.0}, {"phi": 2.1, "phid": -7.0, "phidd": 11.0}]


def runtime(equations):
    from pathlib import Path

    module = _module(Path("linkage.py"), module_text(equations, "linkage.py", "0" * 16))
    return bind_module(module, linkages.VALUES)


def reactions_at(mechanism, given):
    f = mechanism.functions["reactions"]
    return {n: float(v) for n, v in zip(f.name_out(), f.call([given.get(n, 0.0) for n in f.name_in()]), strict=True)}


def assert_newton_and_euler(equations, mechanism, given, torque):
    oracle = Oracle(equations, linkages.VALUES | given)
    found, size = oracle.residuals(reactions_at(mechanism, given), torque)
    for name, left in found.items():
        assert np.abs(left).max() < 1e-9 * size, (name, left, size)


@pytest.mark.slow
@pytest.mark.parametrize("given", STATES, ids=["forward", "backward"])
@pytest.mark.parametrize("flip", [False, True], ids=["as named", "flipped"])
@pytest.mark.parametrize("name", linkages.ALL)
def test_closed_forms_obey_newton_and_euler(name, flip, given):
    equations = derive(linkages.ALL[name](flip=flip))
    assert not equations.mechanism.dependent_list
    mechanism = runtime(equations)
    s = state(mechanism, given)
    torque = s["mass_matrix"][0][0] * given["phidd"] + s["bias"][0] - s["generalized_force"][0]
    assert_newton_and_euler(equations, mechanism, given, torque)
    states, wrong = disagreement(equations)
    assert wrong < 1e-10


@pytest.mark.slow
@pytest.mark.parametrize("flip", [False, True], ids=["as named", "flipped"])
@pytest.mark.parametrize("name", linkages.ALL)
def test_closing_by_constraint_gives_the_same_motion_and_reactions(name, flip):
    closed, held = (derive(linkages.ALL[name](by, flip)) for by in (False, True))
    assert len(held.mechanism.dependent_list) == len(held.mechanism.constraints) > 0
    one, other = runtime(closed), runtime(held)
    given = STATES[0]
    s = state(one, given)
    guesses = dict(other.dependents) | near(closed, held, given)
    q = loops.close(other, {"phi": given["phi"]}, guesses)
    assert q is not None
    u, a = rates(other, q, given)
    all_given = given | dict(zip(other.coordinates, q, strict=True))
    all_given |= {f"{n}d": v for n, v in zip(other.coordinates, u, strict=True)}
    all_given |= {f"{n}dd": v for n, v in zip(other.coordinates, a, strict=True)}
    found, wanted = reactions_at(other, all_given), reactions_at(one, given)
    size = max(abs(v) for v in wanted.values())
    assert {n for n in found if not n.startswith("driving")} == set(wanted)
    for reaction, value in wanted.items():
        assert found[reaction] == pytest.approx(value, abs=1e-9 * size), reaction
    needed = s["mass_matrix"][0][0] * given["phidd"] + s["bias"][0] - s["generalized_force"][0]
    assert found["driving_phi"] == pytest.approx(needed, rel=1e-9)
    assert_newton_and_euler(held, other, all_given, needed)


def near(closed, held, given):
    """Where the dependent coordinates are in the closed form, as guesses."""
    oracle = Oracle(closed, linkages.VALUES | given)
    links = {k.name: k for k in closed.mechanism.links}
    found = {}
    for letter in held.mechanism.dependent_list:
        kind, _, name = letter.name.partition("_")
        if kind == "theta":
            found[letter.name] = oracle.value(links[name].turns) + 0.02
        else:
            found[letter.name] = 0.3
    return found


def rates(mechanism, q, given):
    zero = [0.0] * len(q)
    constraints = mechanism.functions["constraints"]
    _, jacobian, _ = (np.asarray(v) for v in constraints.call([*q, *zero]))
    u = np.append(given["phid"], -np.linalg.solve(jacobian[:, 1:], jacobian[:, 0] * given["phid"]))
    gamma = np.asarray(constraints.call([*q, *u])[2]).ravel()
    return u, np.append(given["phidd"], -np.linalg.solve(jacobian[:, 1:], jacobian[:, 0] * given["phidd"] + gamma))


@pytest.mark.parametrize("inside", [False, True], ids=["sun", "ring"])
def test_gears_on_a_carrier_obey_newton_and_euler(inside):
    equations = derive(linkages.gears(inside))
    assert not equations.mechanism.dependent_list
    mechanism = runtime(equations)
    s = state(mechanism, STATES[0])
    torque = s["mass_matrix"][0][0] * STATES[0]["phidd"] + s["bias"][0] - s["generalized_force"][0]
    assert_newton_and_euler(equations, mechanism, STATES[0], torque)

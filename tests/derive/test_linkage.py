"""Links and joints: every closed form obeys Newton and Euler link by link, and closes."""

import casadi as ca
import linkages
import numpy as np
import pytest
from newton_euler import Oracle

from mechsym.cycle.motion import top_of
from mechsym.derive import Mechanism, derive
from mechsym.derive.emit import module_text
from mechsym.derive.textbook import disagreement
from mechsym.errors import BadInput
from mechsym.mechanisms import loops
from mechsym.mechanisms.own import _module
from mechsym.mechanisms.record import bind_module
from mechsym.mechanisms.state import state

STATES = [{"phi": 0.4, "phid": 5.0, "phidd": -3.0}, {"phi": 2.1, "phid": -7.0, "phidd": 11.0}]


def runtime(equations, values=linkages.VALUES):
    from pathlib import Path

    module = _module(Path("linkage.py"), module_text(equations, "linkage.py", "0" * 16))
    return bind_module(module, values)


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
    torque = s.mass_matrix[0][0] * given["phidd"] + s.bias[0] - s.generalized_force[0]
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
    needed = s.mass_matrix[0][0] * given["phidd"] + s.bias[0] - s.generalized_force[0]
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
    torque = s.mass_matrix[0][0] * STATES[0]["phidd"] + s.bias[0] - s.generalized_force[0]
    assert_newton_and_euler(equations, mechanism, STATES[0], torque)


def planetary():
    """The sun drives planets in a fixed ring: the carrier's angle has no dyad and is held by a constraint."""
    m = Mechanism("planetary")
    phi = m.coordinates("phi")
    rs, rp = m.parameters("rs rp", "m", above=0)
    m_p = m.parameters("m_p", "kg", low=0)
    I_s, I_p, I_c = m.parameters("I_s I_p I_c", "kg*m^2", above=0)
    M, M_r = m.inputs("M M_r", "N*m")
    sun, carrier = m.link("sun", turns=phi, inertia=I_s), m.link("carrier", inertia=I_c)
    planet = m.link("planet", mass=m_p, inertia=I_p)
    m.pin("O", m.frame, sun)
    m.pin("C", m.frame, carrier)
    m.pin("P", carrier.at(rs + rp), planet)
    m.gear("S", sun.at(), planet.at(), radii=(rs, rp))
    m.gear("R", m.frame.at(), planet.at(), radii=(rs + 2 * rp, rp), inside=True)
    m.torque(M, along=phi)
    m.torque(-M_r, along=carrier.angle)
    return m


@pytest.mark.slow
def test_a_planetary_train_has_the_ratio_and_the_inertia_of_the_textbook():
    equations = derive(planetary())
    states, wrong = disagreement(equations)
    assert states > 0 and wrong < 1e-12  # equal to the derivatives of T - V
    v = {"rs": 0.03, "rp": 0.02, "m_p": 0.4, "I_s": 1e-3, "I_p": 2e-4, "I_c": 4e-3}
    mechanism = runtime(equations, v)
    k, spin = v["rs"] / (2 * (v["rs"] + v["rp"])), -v["rs"] / (2 * v["rp"])
    single = loops.reduced(mechanism)[0]
    for phi in (0.3, 3.0, 40.0):  # turns of the carrier included: no jump of an arc tangent
        at = single.functions["dynamics"](phi=phi, phid=2.0, M=5.0, M_r=3.0)
        inertia = v["I_s"] + k**2 * (v["I_c"] + v["m_p"] * (v["rs"] + v["rp"]) ** 2) + spin**2 * v["I_p"]
        assert float(at["mass_matrix"]) == pytest.approx(inertia, rel=1e-10)
        assert float(at["bias"]) == pytest.approx(0, abs=1e-10)
        assert float(at["generalized_force"]) == pytest.approx(5 - 3 * k, rel=1e-10)


def test_wheels_that_no_link_carries_are_refused():
    m = Mechanism("loose")
    phi, x = m.coordinates("phi"), m.coordinates("x", "m")
    r = m.parameters("r", "m", above=0)
    one = m.link("one", turns=phi, inertia=m.parameters("I", "kg*m^2", above=0))
    m.pin("O", m.frame, one)
    two = m.link("two", mass=m.parameters("m", "kg", above=0))
    m.pin("P", m.frame.at(x, 2 * r), two)
    with pytest.raises(BadInput, match=r"test_linkage.py:\d+: no link carries the wheels of the gear 'T'"):
        m.gear("T", one.at(), two.at(), radii=(r, r))


def test_an_open_loop_is_told_with_its_angle():
    opened = linkages.VALUES | {"b": 0.05, "c": 0.02}  # rod and rocker do not reach each other
    with pytest.raises(BadInput, match="rrr: the loop is open at phi = 2.1: links too short there"):
        state(runtime(derive(linkages.rrr()), opened), STATES[1])
    phi = ca.SX.sym("phi")
    travel = ca.Function("travel", [phi], [ca.sqrt(ca.cos(phi) + 0.5), phi])
    with pytest.raises(BadInput, match="the loop opens at a crank angle of 120.5 deg"):
        top_of(travel)


def shared(order):
    """A four-bar whose rod carries, at its end C, a bar besides the rocker; the bar slides in the frame.

    `order` says who is pinned to whom: at C each to the rod, or each to the bar; or a plate between crank and rod.
    """
    m, crank, (a, b, c, d, e), (one, two) = linkages.start("shared")
    rod, rocker = linkages.link(m, "rod", one, (b / 2, e)), linkages.link(m, "rocker", two, (c / 3, -e))
    bar, block = linkages.link(m, "bar", one, (b / 3, 0)), linkages.link(m, "block", two, (0, 0))
    if order != "plate":
        m.pin("B", crank.at(a), rod)
        m.pin("D", m.frame.at(d, e), rocker)
        m.slider("G", m.frame.line(0, e), block)
        if order == "row":  # rod and rocker meet in the bar's end
            m.pin("H", bar.at(b), block)
            m.pin("E", bar, rod.at(b))
            m.pin("C", bar, rocker.at(c), branch=1)
        else:
            m.pin("E", rod.at(b), bar)
            m.pin("C", rod.at(b), rocker.at(c), branch=1)
            m.pin("H", bar.at(b), block)
        return m
    # the rod is pinned to the crank at one point of a plate, which is pinned to both there
    plate = linkages.link(m, "plate", two, (e / 2, e / 3))
    m.pin("P", crank.at(a), plate.at(e, e / 2))
    m.pin("B", plate.at(e, e / 2), rod)
    m.pin("D", m.frame.at(d, e), rocker)
    m.pin("C", rod.at(b), rocker.at(c), branch=1)
    m.slider("G", m.frame.line(0, e), block)
    m.pin("E", rod.at(b), bar)
    m.pin("H", bar.at(b), block)
    m.slot("S", m.frame.line(0, e / 4), plate.at(c))
    return m


@pytest.mark.parametrize("order", ["star", "row", "plate"])
def test_pins_at_one_point_obey_newton_and_euler(order):
    equations = derive(shared(order))
    assert not equations.mechanism.dependent_list
    mechanism, given = runtime(equations), STATES[0]
    s = state(mechanism, given)
    torque = s.mass_matrix[0][0] * given["phidd"] + s.bias[0] - s.generalized_force[0]
    assert_newton_and_euler(equations, mechanism, given, torque)
    oracle, joints = Oracle(equations, linkages.VALUES | given), equations.mechanism.link_joints
    for joint in joints:  # they meet, though three share a point
        if joint.kind == "pin":
            assert oracle.pair(joint.first.xy) == pytest.approx(oracle.pair(joint.second.xy), abs=1e-12)
    assert disagreement(equations)[1] < 1e-10


def test_a_link_pinned_at_one_point_alone_is_refused():
    m, crank, (a, b, c, d, e), (one, two) = linkages.start("free")
    rod, rocker = linkages.link(m, "rod", one, (b / 2, e)), linkages.link(m, "rocker", two, (c / 3, -e))
    m.pin("B", crank.at(a), rod)
    m.pin("D", m.frame.at(d, e), rocker)
    m.pin("C", rod.at(0), rocker.at(c))
    with pytest.raises(BadInput, match=r"linkages.py:\d+: all joints of the link 'rod' are pins at its point \(0, 0\)"):
        derive(m)


def test_a_guess_that_a_closed_form_leaves_without_use_is_refused():
    m, crank, (a, b, c, d, e), _ = linkages.start("guessed")
    rod, rocker = m.link("rod", guess=0.5), m.link("rocker")
    m.pin("B", crank.at(a), rod)
    m.pin("D", m.frame.at(d, e), rocker)
    with pytest.raises(
        BadInput, match=r"py:\d+: the link 'rod' closes in closed form at the joint 'C'.* branch=1 or -1"
    ):
        m.pin("C", rod.at(b), rocker.at(c))

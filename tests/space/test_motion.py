"""Runs of mechanisms in space: closed forms, balances of energy and momentum, closed loops, planar ones in space."""

from pathlib import Path

import numpy as np
import pytest
from spatial_machines import FILE, NUMBERS
from sympy.physics import mechanics

from mechsym.derive import Mechanism, derive
from mechsym.derive.emit import module_text
from mechsym.derive.methods import declaration_of
from mechsym.derive.textbook import disagreement
from mechsym.mechanisms import own
from mechsym.mechanisms.loops import followed
from mechsym.mechanisms.own import _module
from mechsym.mechanisms.record import acceleration_function, bind, bind_module
from mechsym.simulate import Problem, Settings, simulate

GYROSCOPE = str(Path(__file__).parents[2] / "examples/space/gyroscope.py")
WHEEL = {"mass": 0.8, "l": 0.07, "A": 0.0011, "C": 0.0019, "g": 9.81}


def run(mechanism, q0, u0, tolerance=1e-12, **how):
    problem = Problem(mechanism=mechanism, parts=(), q0=tuple(q0), u0=tuple(u0), **how)
    return simulate(problem, Settings(tolerance=tolerance))


def closure(mechanism, result):
    q = [result.columns[n][None, :] for n in mechanism.coordinates]
    return np.abs(np.asarray(mechanism.functions["constraints"](*q, *([0] * len(q)))[0])).max()


def energies(mechanism, result):
    letters = [result.columns[n][None, :] for n in (*mechanism.coordinates, *(f"{q}d" for q in mechanism.coordinates))]
    return np.asarray(mechanism.functions["energy"](*letters)).reshape(2, -1)


def steady(theta, spin, sign=1):
    """Precession of a top on its tip about the pivot: A W^2 cos th - C w3 W + m g l = 0."""
    A = WHEEL["A"] + WHEEL["mass"] * WHEEL["l"] ** 2
    torque, C, c = WHEEL["mass"] * WHEEL["g"] * WHEEL["l"], WHEEL["C"], np.cos(theta)
    # w3 = spin + W cos th, so (A - C) W^2 cos th - C spin W + m g l = 0
    a, b = (A - C) * c, -C * spin
    W = (-b - sign * np.sqrt(b * b - 4 * a * torque)) / (2 * a)
    w3 = spin + W * c
    assert A * W * W * c - C * w3 * W + torque == pytest.approx(0, abs=1e-12)
    return W, w3, A


def test_a_top_precesses_steadily_and_nutates():
    mechanism = bind(f"{GYROSCOPE}:gyroscope", WHEEL)
    theta, spin = 0.9, 300.0
    W, w3, A = steady(theta, spin)
    found = run(mechanism, (0, theta, 0), (W, 0, spin), t_end=0.5, output=0.01)
    assert np.abs(found.columns["theta"] - theta).max() < 1e-11
    np.testing.assert_allclose(found.columns["psid"], W, rtol=1e-10)
    # small nutations about it keep the momenta of precession and spin
    accelerate, dynamics = acceleration_function(mechanism), mechanism.functions["dynamics"]
    p = np.asarray(dynamics(0, theta, 0, W, 0, spin)[0]) @ [W, 0, spin]

    def lean(th):
        M = np.asarray(dynamics(0, th, 0, 0, 0, 0)[0])
        psid, phid = np.linalg.solve(M[np.ix_([0, 2], [0, 2])], p[[0, 2]])
        return float(accelerate(0, th, 0, psid, 0, phid)[1])

    slope = (lean(theta + 1e-4) - lean(theta - 1e-4)) / 2e-4
    wanted = (W * np.sin(theta)) ** 2 + (WHEEL["C"] * w3 / A - 2 * W * np.cos(theta)) ** 2
    assert -slope == pytest.approx(wanted, rel=1e-6)


def test_a_quaternion_is_the_same_top():
    """Precession with spin through all attitudes: the dependent component changes, norm, energy and momentum stay."""
    theta, spin = 1.2, 250.0
    W, _, _ = steady(theta, spin)
    by_angles = run(bind(f"{GYROSCOPE}:gyroscope", WHEEL), (0, theta, 0), (W, 0, spin), t_end=0.5, output=0.05)
    free = bind(f"{GYROSCOPE}:top", WHEEL)
    c, s = np.cos(theta / 2), np.sin(theta / 2)
    e = np.array([c, s, 0, 0])
    w = np.array([0, W * np.sin(theta), W * np.cos(theta) + spin])  # in axes of the wheel
    ed = 0.5 * np.array([-e[1:] @ w, *(e[0] * w + np.cross(e[1:], w))])
    found = run(free, e, ed, t_end=0.5, output=0.05)
    assert closure(free, found) < 1e-14
    total = energies(free, found).sum(axis=0)
    assert np.ptp(total) < 1e-10 * abs(total[0])
    q = np.array([found.columns[f"e{k}_O"] for k in range(4)])
    assert 1 - 2 * (q[1] ** 2 + q[2] ** 2) == pytest.approx(np.cos(by_angles.columns["theta"]), abs=1e-9)
    x = 2 * (q[1] * q[3] + q[0] * q[2])
    assert x == pytest.approx(np.sin(by_angles.columns["psi"]) * np.sin(by_angles.columns["theta"]), abs=1e-8)


def test_a_tumbling_body_keeps_energy_and_momentum():
    values = {"mass": 2.0, "I1": 1.0, "I2": 2.0, "I3": 2.7}
    mechanism = bind(f"{GYROSCOPE}:tumbling", values)
    w0 = np.array([0.2, 6.0, 0.3])  # about the middle axis: it turns over
    found = run(mechanism, (0, 0, 0, 1, 0, 0, 0), (1, 2, 3, 0, *(w0 / 2)), t_end=5.0, output=0.05)
    kinetic = energies(mechanism, found)[0]
    assert np.ptp(kinetic) < 1e-10 * kinetic[0]
    e, ed = (np.array([found.columns[f"e{k}_P{d}"] for k in range(4)]) for d in ("", "d"))
    w = 2 * (e[0] * ed[1:] - ed[0] * e[1:] - np.cross(e[1:].T, ed[1:].T).T)
    assert w[1].min() < -5.5
    spin = np.diag([values[f"I{k}"] for k in (1, 2, 3)]) @ w
    v, a = e[1:], e[0]
    out = spin + 2 * np.cross(v.T, (np.cross(v.T, spin.T).T + a * spin).T).T
    assert np.abs(out - out[:, :1]).max() < 1e-10 * np.abs(out).max()
    assert found.columns["z_P"][-1] == pytest.approx(15.0, rel=1e-12)


def test_a_screw_falls_as_its_lead_says():
    p = {"mass": 3.0, "I": 0.004, "lead": 0.02, "g": 9.81}
    mechanism = bind(f"{GYROSCOPE}:screw", p)
    k = p["lead"] / (2 * np.pi)
    wanted = -p["mass"] * p["g"] * k / (p["I"] + p["mass"] * k * k)
    assert float(acceleration_function(mechanism)(0.3, 1.0)) == pytest.approx(wanted, rel=1e-14)


def test_hookes_joint_turns_as_its_formula_says():
    beta = 0.6
    mechanism = bind(f"{FILE}:hooke", {"beta": beta, "I1": 0.03, "I2": 0.05})
    for phi in np.linspace(0.1, 3.0, 13):
        turned = followed(mechanism, {"phi": phi}, mechanism.dependents)[1]
        assert turned == pytest.approx(np.arctan2(np.sin(phi), np.cos(phi) * np.cos(beta)), abs=1e-13)
        J = np.asarray(mechanism.functions["constraints"](phi, turned, 0, 0)[1])
        ratio = np.cos(beta) / (1 - np.sin(beta) ** 2 * np.cos(phi) ** 2)
        assert -J[0, 0] / J[0, 1] == pytest.approx(ratio, rel=1e-13)


@pytest.mark.slow
@pytest.mark.parametrize(
    "name, speed", [("rssr", 30.0), ("rssp", 30.0), ("hooke", 12.0), ("wobble", 40.0), ("pump", 40.0)]
)
def test_twenty_turns_keep_the_energy_and_the_loops(name, speed):
    letters = own.load(f"{FILE}:{name}").listing["parameters"]
    mechanism = bind(f"{FILE}:{name}", {k: NUMBERS[name][1].get(k, 9.81) for k in letters})
    q0 = [mechanism.dependents.get(q, 0.0) for q in mechanism.coordinates]
    u0 = [speed, *[0.0] * (len(q0) - 1)]
    found = run(mechanism, q0, u0, turns=20, t_end=100.0, output=0.02)
    assert found.end == "turns" or found.columns["phi"][-1] == pytest.approx(40 * np.pi)
    total = energies(mechanism, found).sum(axis=0)
    assert np.ptp(total) < 1e-10 * np.abs(total).max()
    assert closure(mechanism, found) < 1e-12


def four_bar(space):
    m = Mechanism("four_bar", space=space)
    phi = m.coordinates("phi")
    a, b, c, d = m.parameters("a b c d", "m", above=0)
    mass, inertia = m.parameters("mass", "kg"), m.parameters("I", "kg*m^2")
    crank = m.link("crank", turns=phi, inertia=4 * inertia, mass=mass, centre=(a / 3, a / 5))
    rod = m.link("rod", mass=mass, centre=(b / 2, 0), inertia=inertia)
    rocker = m.link("rocker", mass=mass, centre=(c / 2, 0), inertia=inertia)
    m.pose(phi=0.3, rod=0.6, rocker=1.6)
    m.pin("A", m.frame, crank)
    m.pin("B", crank.at(a), rod)
    m.pin("D", m.frame.at(d), rocker)
    m.pin("C", rod.at(b), rocker.at(c))
    m.weight(0, -m.parameters("g", "m/s^2"))
    m.torque(m.inputs("M", "N*m"), along=phi)
    equations = derive(m)
    assert disagreement(equations)[1] < 1e-12
    module = _module(Path("four_bar.py"), module_text(equations, "four_bar.py", "0" * 16))
    values = {"a": 0.1, "b": 0.3, "c": 0.25, "d": 0.32, "mass": 0.8, "I": 0.01, "g": 9.81}
    return m, bind_module(module, values)


def test_a_planar_mechanism_is_the_same_in_space():
    (_, plane), (said, space) = four_bar(2), four_bar(3)
    assert said.redundant[0].startswith("3 of 5 conditions are redundant: the joints A, B, D, C ")
    assert set(said.undetermined) == {f"{k}_{j}" for k in ("R_z", "M_x", "M_y") for j in "ABCD"}
    for phi in (0.3, 1.4, 4.0):
        at = followed(space, {"phi": phi}, space.dependents)
        u = 9.0 * np.array([1.0, *np.linalg.lstsq(*_split(space, at), rcond=None)[0]])
        a = _accelerations(space, at, u, 2.0)
        one = float(acceleration_function(plane)(phi, 9.0, 2.0))
        assert a[0] == pytest.approx(one, rel=1e-13)
        reactions = space.functions["reactions"](*at, *u, *a, 2.0)
        found = dict(zip(space.functions["reactions"].name_out(), map(float, reactions), strict=True))
        borne = plane.functions["reactions"]
        wanted = dict(zip(borne.name_out(), map(float, borne(phi, 9.0, one, 2.0)), strict=True))
        names = [f"R_{axis}_{joint}" for axis in "xy" for joint in "ABCD"]
        largest = max(abs(wanted[name]) for name in names)
        for name in names:
            assert found[name] == pytest.approx(wanted[name], abs=1e-13 * largest)


def _split(mechanism, at):
    J = np.asarray(mechanism.functions["constraints"](*at, *[0] * len(at))[1])
    return J[:, 1:], -J[:, 0]


def _accelerations(mechanism, q, u, M):
    mass, bias, force = (np.asarray(x) for x in mechanism.functions["dynamics"](*q, *u, M))
    _, J, gamma = (np.asarray(x) for x in mechanism.functions["constraints"](*q, *u))
    k = len(J)
    whole = np.block([[mass, J.T], [J, np.zeros((k, k))]])
    return np.linalg.solve(whole, np.concatenate([force - bias, -gamma]).ravel())[: len(q)]


def top():
    """A top on a ball joint whose turn is three angles."""
    m = Mechanism("top", space=3)
    angles = m.coordinates("a b c")
    body = m.link("body", mass="0.8 kg", centre=(0, 0, "0.3 m"), inertia=("0.02 kg*m^2", "0.02 kg*m^2", "0.01 kg*m^2"))
    m.spherical("S", m.frame.at(0, 0, 0), body.at(0, 0, 0), sequence="zxz", turns=angles)
    m.weight(0, 0, "-9.81 m/s^2")
    return m


def bound(m):
    module = _module(Path("top.py"), module_text(derive(m), "top.py", "0" * 16))
    return bind_module(module, {p: m.ranges[p]["default"] for p in module.PARAMETERS})


@pytest.mark.parametrize("spin", [1e-9, 1e-6])
def test_angles_at_their_pole_end_a_run_with_an_event(spin):
    found = run(bound(top()), (0.0, np.pi - 1.0, 0.0), (spin, 0.0, 0.0), t_end=3.0)
    assert (found.end, found.event.name) == ("pole", "pole")
    assert np.sin(found.event.state["b"]) == pytest.approx(0, abs=1e-3)
    assert abs(found.energy.residual) < 1e-4


def test_away_from_their_pole_they_do_not():
    assert run(bound(top()), (0.0, np.pi - 1.0, 0.0), (0.5, 0.0, 0.0), t_end=1.0).end == "t_end"


def kane():
    """The same top by Kane's equations of sympy, with the rates about its own axes as speeds."""
    angles, speeds = mechanics.dynamicsymbols("a b c"), mechanics.dynamicsymbols("u1 u2 u3")
    N = mechanics.ReferenceFrame("N")
    B = N.orientnew("B", "Body", angles, "313")
    w = B.ang_vel_in(N)
    kinematic = [w.dot(axis) - u for axis, u in zip((B.x, B.y, B.z), speeds, strict=True)]
    B.set_ang_vel(N, sum((u * axis for axis, u in zip((B.x, B.y, B.z), speeds, strict=True)), 0 * N.x))
    O = mechanics.Point("O")
    O.set_vel(N, 0)
    G = O.locatenew("G", 0.3 * B.z)
    G.v2pt_theory(O, N, B)
    body = mechanics.RigidBody("top", G, B, 0.8, (mechanics.inertia(B, 0.02, 0.02, 0.01), G))
    method = mechanics.KanesMethod(N, angles, speeds, kinematic)
    method.kanes_equations([body], [(G, -0.8 * 9.81 * N.z)])
    return method


def test_a_model_of_kane_in_space_moves_as_the_declared_one():
    declared, converted = (acceleration_function(bound(m)) for m in (top(), declaration_of("top", kane(), {})))
    for state in np.random.default_rng(4).uniform(0.3, 1.2, (10, 6)):
        assert np.asarray(converted(*state)).ravel() == pytest.approx(np.asarray(declared(*state)).ravel(), rel=1e-12)

"""Stops, contacts and friction in runs: times of events, energies and motion by closed forms and by other ways."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import scipy
from unilateral import press

from mechsym import mechanisms
from mechsym.derive import derive
from mechsym.errors import BadInput
from mechsym.mechanisms.record import bind
from mechsym.mechanisms.roles import StopRole
from mechsym.simulate import Settings, blows, simulate
from mechsym.simulate.laws import Numbers
from mechsym.simulate.plots import met
from mechsym.simulate.problem import FormulaForce, Part, Problem, Steps

FILE = Path(__file__).parents[1] / "unilateral.py"
G = 9.81


def run(which, parameters, q0, u0, t_end, parts=(), settings=None):
    name = f"{FILE}:{which}"
    roles = mechanisms.roles_of(name)
    mechanism = bind(name, parameters)
    problem = Problem(
        mechanism=mechanism, parts=parts, q0=q0, u0=u0, t_end=t_end, unilateral=(*roles.stops, *roles.frictions)
    )
    return simulate(problem, settings)


def times(result, kind):
    return np.array([e.t for e in result.happened.events if e.kind == kind])


@pytest.mark.parametrize("e, backend", [(0.5, "auto"), (0.8, "auto"), (0.5, "scipy-dop853"), (0.0, "auto")])
def test_a_bouncing_ball_meets_the_ground_when_it_must(e, backend):
    height, mass = 1.0, 2.0
    t0 = np.sqrt(2 * height / G)
    end = t0 * (1 + e) / (1 - e)
    result = run("ball", {"m1": mass, "e": e, "g": G}, (height,), (0.0,), 1.2 * end, settings=Settings(backend=backend))
    hits = times(result, "hit")
    assert result.status == "converged"
    np.testing.assert_allclose(
        hits, [t0 * (1 + 2 * sum(e**j for j in range(1, n + 1))) for n in range(len(hits))], rtol=0, atol=1e-9
    )
    assert len(hits) > (10 if e else 0)
    if e:
        assert times(result, "rest") == pytest.approx([end], abs=1e-9)
    lost = [one.lost for one in result.happened.events]
    assert lost[0] == pytest.approx((1 - e**2) * mass * G * height, rel=1e-12)
    assert sum(lost) == pytest.approx(mass * G * height, rel=1e-12)
    assert abs(result.energy.residual) < 1e-12
    assert np.all(np.abs(result.columns["y"][result.t > end + 1e-6]) < 1e-12)
    assert np.all(result.columns["y"] > -1e-12)


def test_a_ball_without_losses_goes_on_for_ever():
    result = run("ball", {"m1": 1.0, "e": 1.0, "g": G}, (1.0,), (0.0,), 10.0)
    t0 = np.sqrt(2 / G)
    np.testing.assert_allclose(times(result, "hit"), t0 * np.arange(1, 22, 2), rtol=0, atol=1e-9)
    assert result.columns["dissipation"][-1] == pytest.approx(0, abs=1e-12)


def test_a_cushion_gives_back_the_work_of_hunt_and_crossley():
    """Without damping half a period of contact; with it the speeds before and behind hold
    c (v0 + v1) = ln((1 + c v0)/(1 - c v1)), from m v dv/d = k d (1 + c v) dd."""
    m1, k, v0 = 2.0, 5e4, 1.5
    free = run("cushion", {"m1": m1, "k": k, "c": 0.0}, (0.1,), (-v0,), 0.5)
    touch, release = times(free, "touch"), times(free, "release")
    assert touch == pytest.approx([0.1 / v0], abs=1e-9)
    assert release - touch == pytest.approx([np.pi * np.sqrt(m1 / k)], abs=1e-9)
    c = 0.2
    damped = run("cushion", {"m1": m1, "k": k, "c": c}, (0.1,), (-v0,), 0.5)
    v1 = damped.columns["yd"][-1]
    assert c * (v0 + v1) == pytest.approx(np.log((1 + c * v0) / (1 - c * v1)), rel=1e-9)
    assert damped.columns["dissipation"][-1] == pytest.approx(m1 * (v0**2 - v1**2) / 2, rel=1e-9)


def test_a_block_on_a_belt_sticks_and_slips():
    p = {"m1": 1.3, "k": 50.0, "mu_s": 0.4, "mu_k": 0.25, "N": 20.0, "v": 0.1}
    result = run("belt", p, (0.0,), (p["v"],), 12.0)
    D, w = (p["mu_s"] - p["mu_k"]) * p["N"] / p["k"], np.sqrt(p["k"] / p["m1"])
    spans = [(a.kind, b.t - a.t) for a, b in pairwise(result.happened.events)]
    assert len(spans) > 10
    wanted = {"slip": 2 / w * (np.pi - np.arctan(w * D / p["v"])), "stick": 2 * D / p["v"]}
    for kind, span in spans:
        assert span == pytest.approx(wanted[kind], abs=1e-9)
    assert result.happened.events[0].t == pytest.approx(p["mu_s"] * p["N"] / p["k"] / p["v"], abs=1e-9)
    assert abs(result.energy.residual) < 1e-10


ROCK = {"m1": 5.0, "b": 1.2 * np.sin(0.2), "h": 1.2 * np.cos(0.2), "g": G, "mu": 0.9}


def rocking(th0, t_end):
    b, h = ROCK["b"], ROCK["h"]
    start = b * (np.cos(th0) - 1) - h * np.sin(th0), b * np.sin(th0) + h * np.cos(th0), th0
    return run("block", ROCK, start, (0.0, 0.0, 0.0), t_end)


def test_a_block_rocks_from_corner_to_corner():
    """Quarter period by the energy's own integral; the blow leaves 1 - 1.5 sin^2 al of the speed."""
    al, R, th0 = 0.2, 1.2, 0.1
    p = np.sqrt(3 * G / (4 * R))
    result = rocking(th0, 1.2)
    (hit,) = (e for e in result.happened.events if e.kind == "hit")
    top = np.cos(al - th0)

    def slowness(s):  # th = th0 - s^2 takes the root at the start away
        return (
            2 * s / np.sqrt(2 * p**2 * (top - np.cos(al - th0 + s**2))) if s else 2 / p / np.sqrt(2 * np.sin(al - th0))
        )

    quarter = scipy.integrate.quad(slowness, 0, np.sqrt(th0), epsabs=1e-13, epsrel=1e-13)[0]
    assert hit.t == pytest.approx(quarter, abs=1e-9)
    fallen = ROCK["m1"] * G * R * (top - np.cos(al))
    assert np.sqrt(1 - hit.lost / fallen) == pytest.approx(1 - 1.5 * np.sin(al) ** 2, abs=1e-9)
    assert abs(result.energy.residual) < 1e-10


def test_the_quarter_period_of_slight_rocking_is_the_linear_one():
    """The linear law leaves out terms of the third order in the angles: with angles a tenth as large, a hundredth."""
    off = []
    for al in (0.02, 0.002):
        R, th0 = 1.2, al / 2
        p = np.sqrt(3 * G / (4 * R))
        ROCK.update(b=R * np.sin(al), h=R * np.cos(al))
        try:
            hit = rocking(th0, 0.6).happened.events[0]
        finally:
            ROCK.update(b=R * np.sin(0.2), h=R * np.cos(0.2))
        off.append(hit.t * p / np.arccosh(1 / (1 - th0 / al)) - 1)
    assert abs(off[1]) < 1e-5
    assert off[0] / off[1] == pytest.approx(100, rel=0.02)


def press_numbers(mu):
    listing = mechanisms.listing(f"{FILE}:press")
    return {name: listing["ranges"].get(name, {}).get("default", mu) for name in listing["parameters"]}


def own_acceleration(mechanism, roles, p, q, u, acting):
    """Acceleration of the press by an own fixed point: friction -> motion -> reactions -> friction."""
    dynamics, reactions = mechanism.functions["dynamics"], mechanism.functions["reactions"]
    inputs = dict.fromkeys(mechanism.inputs, 0.0) | acting
    base = float(dynamics(q, u, *inputs.values())[2])
    slides = {r.name: float(dynamics(q, u, *(inputs | {r.force: 1.0}).values())[2]) - base for r in roles}
    for _ in range(60):
        mass, bias, force = (float(v) for v in dynamics(q, u, *inputs.values()))
        a = (force - bias) / mass
        borne = dict(zip(reactions.name_out(), map(float, reactions(q, u, a, *inputs.values())), strict=True))
        for r in roles:
            normal = np.hypot(*[borne[one] for one in r.reactions]) if len(r.reactions) == 2 else borne[r.reactions[0]]
            inputs[r.force] = -np.sign(slides[r.name] * u) * p["mu"] * abs(normal) * (p[r.radius] if r.radius else 1)
    return a


@pytest.mark.slow
def test_a_toggle_press_with_friction_in_every_joint_moves_as_by_an_own_fixed_point():
    p = press_numbers(0.1)
    name, acting = f"{FILE}:press", {"M": 40.0, "F": -100.0}
    parts = tuple(Part(name=n, input=n, value=Steps(values=(v,))) for n, v in acting.items())
    result = run("press", p, (1.57,), (0.0,), 0.12, parts)
    assert result.status == "converged"
    assert len(times(result, "turn")) == 2  # joints turn back one by one at dead points
    mechanism, roles = bind(name, p), mechanisms.roles_of(name).frictions

    def rates(t, y):
        return y[1], own_acceleration(mechanism, roles, p, *y, acting)

    before = times(result, "turn")[0]
    start = 1e-3  # at rest the sign of the speed says nothing
    y0 = run("press", p, (1.57,), (0.0,), start, parts).columns
    at = scipy.integrate.solve_ivp(
        rates, (start, before - 1e-3), (y0["phi"][-1], y0["phid"][-1]), rtol=1e-11, atol=1e-11, method="DOP853"
    )
    ended = run("press", p, (1.57,), (0.0,), before - 1e-3, parts).columns
    assert at.y[:, -1] == pytest.approx([ended["phi"][-1], ended["phid"][-1]], abs=1e-8)
    assert abs(result.energy.residual) < 1e-10
    assert 0 < result.happened.contraction < 1


@pytest.mark.slow
@pytest.mark.heavy
def test_a_press_stays_while_its_friction_holds_and_one_that_locks_itself_is_refused():
    p = press_numbers(0.1)

    def driven(rate, mu, t_end=1.0):
        pull = Part(name="M", input="M", value=FormulaForce(function=lambda t, q, u: rate * t))
        return run("press", p | {"mu": mu}, (1.57,), (0.0,), t_end, (pull,))

    result = driven(1.0, 0.3, 0.5)
    assert {e.kind for e in result.happened.events} <= {"slip"}
    assert np.all(result.columns["phid"][result.t < (times(result, "slip") or [1.0])[0]] == 0)
    with pytest.raises(BadInput, match="locks itself"):
        driven(100.0, 20.0)


def test_blows_at_once_take_half_of_each_impulse_times_the_speed_that_is_lost():
    """lost = 1/2 sum L_i (1 - e_i) |v_i|, with impulses and energies worked out anew from the velocities."""
    random, blown = np.random.default_rng(3), 0
    for _ in range(40):
        root, W, u = random.normal(size=(3, 3)), random.normal(size=(3, 2)), random.normal(size=3)
        mass, e = root @ root.T + np.eye(3), random.uniform(0, 1, 2)
        v = W.T @ u
        if (v >= 0).any():
            continue
        roles = [StopRole(name=n, gap=n, force=n, restitution=str(k)) for n, k in zip("ab", e, strict=True)]
        elements = tuple(Numbers(role=r, sizes={"restitution": k}) for r, k in zip(roles, e, strict=True))
        blow = blows.solve(elements, {0, 1}, v, mass, W, np.linalg.solve(mass, W))
        after = u + blow.change
        impulses = np.linalg.lstsq(np.linalg.solve(mass, W), blow.change, rcond=None)[0]
        assert blow.lost == pytest.approx((u @ mass @ u - after @ mass @ after) / 2, rel=1e-9)
        pressed = impulses > 1e-9
        np.testing.assert_allclose((W.T @ after)[pressed], -(e * v)[pressed], atol=1e-9)
        if pressed.all():
            assert blow.lost == pytest.approx(np.sum(impulses * (1 - e) * -v) / 2, rel=1e-9)
            blown += 1
    assert blown > 3


def test_a_run_with_events_shows_them():
    result = run("ball", {"m1": 1.0, "e": 0.5, "g": G}, (1.0,), (0.0,), 2.0)
    figure = met(result)
    assert [t.get_text() for t in figure.axes[-1].get_yticklabels()] == ["stop y"]
    hits = next(line for line in figure.axes[-1].lines if line.get_label() == "hit")
    np.testing.assert_allclose(hits.get_xdata(), times(result, "hit"))


@pytest.mark.parametrize(
    "which, numbers, start, words",
    [
        ("ball", {"m1": 1.0, "e": 2.0, "g": G}, 1.0, "restitution = 2 of stop_y"),
        ("ball", {"m1": 1.0, "e": -0.5, "g": G}, 1.0, "is outside 0 to 1"),
        ("ball", {"m1": 1.0, "e": 0.5, "g": G}, -1.0, "is passed at the start"),
        ("belt", {"m1": 1.0, "k": 1.0, "N": 1.0, "mu_s": 0.1, "mu_k": 0.3, "v": 1.0}, 0.0, "sticks less than"),
        ("belt", {"m1": 1.0, "k": 1.0, "N": -1.0, "mu_s": 0.3, "mu_k": 0.1, "v": 1.0}, 0.0, "normal = -1"),
    ],
)
def test_bad_numbers_are_refused_in_one_line(which, numbers, start, words):
    with pytest.raises(BadInput, match=words) as refused:
        run(which, numbers, (start,), (0.0,), 1.0)
    assert "\n" not in str(refused.value)


def test_every_joint_of_the_press_rubs():
    assert len(derive(press()).mechanism.roles["friction"]) == 7

"""A harmonic cam past its jump speed: when its follower leaves and lands, by closed forms of its free swing."""

from pathlib import Path

import numpy as np
import pytest
import scipy

from mechsym import cases, jobs, mechanisms
from mechsym.forces.summary import cams as cams_of
from mechsym.forces.turn import crank_drive, turn
from mechsym.mechanisms.record import bind
from mechsym.simulate import Settings, simulate
from mechsym.simulate.problem import Problem

FILE = Path(__file__).parents[1] / "cams.py"
P = {"m1": 0.1, "k": 2e4, "F0": 100.0, "e": 5e-3, "cam_base": 0.03, "cam_rise": np.pi, "cam_fall": np.pi}
JUMP = np.sqrt((2 * P["k"] * P["e"] + P["F0"]) / (P["m1"] * P["e"]))


def run(omega, t_end, settings=None):
    name = f"{FILE}:harmonic_free"
    mechanism = bind(name, P | {"I": 1e12})  # what the follower does to its speed is below round-off
    problem = Problem(
        mechanism=mechanism, parts=(), q0=(0.0, 0.0), u0=(omega, 0.0), t_end=t_end,
        unilateral=mechanisms.roles_of(name).stops,
    )  # fmt: skip
    return simulate(problem, settings or Settings(check="none"))


def test_the_jump_speed_of_a_harmonic_cam_is_that_of_its_closed_form():
    name = f"{FILE}:harmonic"
    parameters = mechanisms.parameters_class(name)(**P, I=0.01)
    (told,) = cams_of(turn(crank_drive(name, parameters), None, 0.5 * JUMP))
    assert told.jump_speed_rpm == pytest.approx(JUMP * 30 / np.pi, rel=1e-9)
    assert told.force_min > 0 and not told.undercut
    (over,) = cams_of(turn(crank_drive(name, parameters), None, 1.1 * JUMP))
    assert over.force_min == pytest.approx(
        P["F0"] + 2 * P["k"] * P["e"] - P["m1"] * P["e"] * (1.1 * JUMP) ** 2, rel=1e-9
    )


def test_below_the_jump_speed_the_follower_stays_and_above_it_leaves():
    assert run((1 - 1e-9) * JUMP, 0.02).happened.events == ()
    assert run((1 + 1e-7) * JUMP, 0.02).happened.events[0].kind == "release"


@pytest.mark.parametrize("share", [1.05, 1.3])
def test_a_flight_begins_and_ends_when_it_must(share):
    """It leaves where m y'' + k y + F0 = 0 on the cam, swings freely, and lands where it meets the cam again."""
    m1, k, F0, e = (P[n] for n in ("m1", "k", "F0", "e"))
    omega, w = share * JUMP, np.sqrt(k / m1)
    t0 = np.arccos(-(k * e + F0) / (m1 * e * omega**2 - k * e)) / omega
    y0, v0 = e * (1 - np.cos(omega * t0)) + F0 / k, e * omega * np.sin(omega * t0)

    def gap(t):
        return y0 * np.cos(w * (t - t0)) + v0 / w * np.sin(w * (t - t0)) - F0 / k - e * (1 - np.cos(omega * t))

    times = np.linspace(t0 + 1e-4 / omega, t0 + 20 / omega, 20000)
    at = np.flatnonzero(gap(times) < 0)[0]
    landing = scipy.optimize.brentq(gap, times[at - 1], times[at], xtol=1e-15)
    result = run(omega, landing + 1e-4)
    leaves, lands = result.happened.events[:2]
    assert (leaves.kind, lands.kind) == ("release", "hit")
    assert leaves.t == pytest.approx(t0, abs=1e-9)
    assert lands.t == pytest.approx(landing, abs=1e-9)
    slope = -y0 * w * np.sin(w * (landing - t0)) + v0 * np.cos(w * (landing - t0)) - e * omega * np.sin(omega * landing)
    assert lands.lost == pytest.approx(m1 * slope**2 / 2, rel=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize(("share", "told"), [(0.95, False), (1.05, True)])
def test_a_run_tells_where_a_held_follower_would_leave(tmp_path, share, told):
    letters = "\n".join(f"{name} = {value!r}" for name, value in (P | {"I": 1e3}).items())
    speed = f"[simulation]\nt_end = 0.02\nspeed_start = {float(share * JUMP)!r}\n"
    case = tmp_path / "cam.toml"
    case.write_text(f'mechanism = "{FILE}:harmonic"\n[parameters]\n{letters}\n{speed}')
    lines = jobs.run(cases.load(str(case)), check="none").findings
    assert any("would lift off" in line for line in lines) == told

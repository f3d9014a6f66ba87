"""What a run of a user's own mechanism is doubted for at its start, by closed forms."""

import math
from pathlib import Path

import numpy as np
import pytest

from mechsym import cases
from mechsym.cases import load
from mechsym.cases.at_start import of_start
from mechsym.cases.links import PLACES
from mechsym.cases.outcomes import of_own
from mechsym.jobs.machine import mechanism_of
from mechsym.jobs.run import run

OWN = Path(__file__).parents[1] / "plausible" / "own"


def doubts(machine, set_=None, **start):
    """Value of each doubt of a run that stays as it starts, but for that."""
    case = cases.load(str(OWN / f"{machine}.toml"), set_)
    mechanism = mechanism_of(case)
    names = [*mechanism.coordinates, *(f"{q}d" for q in mechanism.coordinates)]
    columns = {name: np.full(2, start.get(name, 0.0)) for name in names}
    return {d.code: d.value for d in of_start(case, mechanism, columns) if d.code != "still_run"}


@pytest.mark.parametrize(
    ("machine", "moves", "way"),
    [("bell", {"psi": 2e-4}, 2e-4), ("bell", {"theta": 5e-5, "psi": 8e-5}, 8e-5), ("crane", {"s": 4e-4}, 4e-4 / 6)],
)
def test_a_run_in_which_nothing_moves_is_told(machine, moves, way):
    """Radians, and metres by the rope of the crane, the longest letter."""
    case = cases.load(str(OWN / f"{machine}.toml"), {"parameters.p": "6 m"} if machine == "crane" else None)
    mechanism = mechanism_of(case)
    names = [*mechanism.coordinates, *(f"{q}d" for q in mechanism.coordinates)]
    columns = {name: np.array([0.3, 0.3 + moves.get(name, 0.0)]) for name in names}
    told = {d.code: d.value for d in of_start(case, mechanism, columns)}
    assert told.get("still_run") == (pytest.approx(way) if way < 1e-4 else None)


def test_an_unbalance_says_nothing_of_the_size_of_its_rotor():
    """The fan's rotor goes round its own axis; wheels of a mass that rolls on are held against it."""
    assert not doubts("absorber", {"parameters.e": "0.05 mm"}, phid=155.0).keys() & {"turning_share", "link_inertia"}
    assert doubts("wagon", {"parameters.R": "0.5 mm"})["turning_share"] > 5000


def test_a_place_that_has_no_value_at_nought_hides_nothing(tmp_path):
    """A rotor whose place is a quotient of coordinates."""
    text = (OWN / "absorber.py").read_text()
    (tmp_path / "fan.py").write_text(text.replace("e * sin(phi))", "e * sin(phi) * y**2 / (y**2 + z**2))"))
    (tmp_path / "fan.toml").write_text((OWN / "absorber.toml").read_text().replace("./absorber.py", "./fan.py"))
    assert "turning_share" in doubts(str(tmp_path / "fan"), {"parameters.e": "0.05 mm"}, y=0.01)


@pytest.mark.parametrize(("share", "told"), [(9.9, False), (10.1, True)])
def test_a_damper_by_the_swing_of_what_hangs(share, told):
    """The bell alone, its clapper fast: omega^2 = m g s / (I + m s^2), delta = b / (2 (I + m s^2))."""
    light = {"parameters.m_k": "1e-9 kg", "parameters.I_k": "1e-9 kg*m^2"}
    inertia = 120 + 900 * 0.38**2
    b = 2 * inertia * math.sqrt(900 * 9.81 * 0.38 / inertia) * share
    assert ("damping_share" in doubts("bell", {**light, "parameters.b": f"{b!r} N*m*s/rad"})) == told


def test_a_mass_on_a_spring_that_is_let_go_far_out_jolts():
    """The tub, 38 kg with 1.5 kg of laundry below its axis, 2 m sideways on 100 kN/m: k x / m beside its drum."""
    stiff = {"parameters.k": "100 kN/m", "drive.torque": 0}
    far = doubts("washer", stiff, x=2.0, phi=math.pi / 2)
    # the laundry turns with the drum: of the push along x it takes its share through m e^2 / (I + m e^2)
    m, k, e, drum = 1.5, 1e5, 0.2, 0.9
    mass = 38.0 + m - (m * e) ** 2 / (drum + m * e**2)
    assert far["start_push"] == pytest.approx(k * 2.0 / mass, rel=1e-9)
    assert "start_push" not in doubts("washer", stiff, x=0.02)


def test_results_are_too_far_apart_for_a_vibration_of_two_masses():
    """Locomotive and wagon on their coupling: omega^2 = k (1/(m_1 + I/R^2) + 1/m_2), hardly damped."""
    omega = math.sqrt(3e6 * (1 / (32e3 + 180 / 0.25) + 1 / 40e3))
    step = 0.3 * math.tau / omega
    free = {"parameters.c": 0, "parameters.d": 0}
    seen = doubts("wagon", {**free, "simulation.output_step": step})
    assert seen["aliasing"] == pytest.approx(0.3, rel=1e-9)
    assert "aliasing" not in doubts("wagon", {**free, "simulation.output_step": step / 2})
    assert "aliasing" not in doubts("wagon", {"parameters.c": "1 MN*s/m", "simulation.output_step": step})


@pytest.mark.parametrize(("damping", "doubted"), [(0.24, True), (0.26, False)])
def test_what_is_damped_within_one_swing_is_no_vibration(damping, doubted):
    """A chain of 9 kN m/rad on 1/(1/I_p + 1/(i^2 (I_w + m R^2))): delta / omega on both sides of 1/4."""
    spread = 1 / 0.06 + 1 / (2.8**2 * (0.22 + 85 * 0.34**2))
    c = 2 * damping * math.sqrt(9e3 * spread / (1 + damping**2)) / spread
    seen = doubts("pedal", {"parameters.c": f"{c!r} N*m*s/rad", "parameters.d": 0, "simulation.output_step": "5 ms"})
    assert ("aliasing" in seen) == doubted


def test_both_ends_of_a_spring_start_together():
    """The belt of the press: psi/i - phi."""
    together = {"phid": 10.0, "psid": 95.0}
    assert not doubts("punch", **together).keys() & {"start_speeds", "spring_wound"}
    assert doubts("punch", phid=10.0, psid=10.0)["start_speeds"] == pytest.approx(1 - 1 / 9.5, rel=1e-6)
    assert "start_speeds" not in doubts("punch", psid=10.0)
    assert doubts("punch", psi=95.0, **together)["spring_wound"] == pytest.approx(10.0)


def test_a_drive_that_cannot_hold_its_shaft_stalls():
    """A gear that dies out under its damper, against one that its motor drives on."""

    def told(damper):
        case = cases.load(str(OWN / "jigsaw.toml"), {"parameters.c": damper})
        return {d.code: d.value for d in run(case, check="none").doubts}

    assert "stall" not in told("3 N*s/m")
    assert 0 <= told("3 kN*s/m")["stall"] < 0.02


def test_a_drive_stalls_from_the_speed_that_a_case_starts_with():
    """A weight that a damper of its shaft holds: M/b by that of `[start]`, but for last swings of the trough."""
    case = cases.load(str(OWN / "conveyor.toml"), {"parameters.b": "20 N*m*s/rad", "simulation.window": "1 s"})
    (share,) = (d.value for d in run(case, check="none").doubts if d.code == "stall")
    assert share == pytest.approx(4 / 20 / (960 * math.pi / 30), rel=1e-2)


def test_a_damper_beside_a_spring_by_what_swings_on_both():
    r"""Engine and tractor on their shaft, 1/m = 1/I_e + i^2/(I_w + m_v R^2): the fast root of m s^2 + c s + k."""
    mass = 1 / (1 / 1.1 + 75**2 / (160 + 5200 * 0.82**2))
    omega, c = math.sqrt(14e3 / mass), 25e3
    fast = (c + math.sqrt(c**2 - 4 * mass * 14e3)) / (2 * mass)
    share = doubts("driveline", {"parameters.c": f"{c!r} N*m*s/rad", "parameters.b": 0})["damping_share"]
    assert share == pytest.approx(fast / (2 * omega), rel=1e-9)
    assert "damping_share" not in doubts("driveline")


def test_what_acts_turns_no_speed_round_between_two_results():
    """The strip on rolls that are far too light, F R / I_r beside what the spindle's damper gives."""
    light = {"parameters.I_r": "6.2 kg*m^2", "simulation.output_step": "1 ms"}
    change = 600e3 * 0.55 / 6.2 * 1e-3
    assert doubts("mill", light, alphad=54.0, thetad=12.0)["start_jolt"] == pytest.approx(change / 12.0)
    assert "start_jolt" not in doubts("mill", light, alphad=4.5 * 50.0, thetad=50.0)
    assert "start_jolt" not in doubts("mill", {"simulation.output_step": "1 ms"}, alphad=54.0, thetad=12.0)


def test_an_inertia_is_held_against_what_its_angle_moves_on():
    """The axle of the locomotive: I / (m R^2)."""
    share = doubts("wagon", {"parameters.R": "0.5 mm"})["turning_share"]
    assert share == pytest.approx(180.0 / (32e3 * 0.0005**2))
    assert not doubts("wagon")


def test_a_wheel_is_held_against_what_its_crank_moves_before_any_run():
    """Of a sewing machine, at the angle where rod and bar weigh most."""
    heavy = load(str(OWN / "sewing.toml"), {"parameters.I_w": "12 kg*m^2", "parameters.I_r": "1e-9 kg*m^2"})
    (share,) = (d.value for d in of_own(heavy, mechanism_of) if d.code == "turning_share")
    phi = np.array([PLACES])
    dynamics = mechanism_of(heavy).functions["dynamics"]
    moved = np.asarray(dynamics(phi, *[0.0] * (dynamics.n_in() - 1))[0]).ravel() - 12.0
    assert share == pytest.approx(12.0 / moved.max(), rel=1e-4)
    assert not of_own(load(str(OWN / "sewing.toml")), mechanism_of)


def test_an_input_is_held_against_all_else_that_acts():
    """A force on the mast beside its spring, F / (k x), and beside nothing."""
    force, at = {"inputs.F": "4 N"}, {"x": 0.06}
    assert doubts("tower", force, **at)["input_share"] == pytest.approx(4.0 / (310e3 * 0.06))
    assert "input_share" not in doubts("tower", {"inputs.F": "400 N"}, **at)
    assert "input_share" not in doubts("tower", force)


def test_a_spring_along_a_distance_is_measured_where_it_has_a_length(tmp_path):
    """sqrt(x^2 + y^2), 3-4-5; at its centre the distance has no slope, and nothing is said."""
    (tmp_path / "bob.py").write_text(
        "from sympy import sqrt\nfrom mechsym.derive import Mechanism, output\n\n\ndef bob():\n"
        '    m = Mechanism("bob", about="A bob on a spring.")\n    x, y = m.coordinates("x y", "m")\n'
        '    m_b, k = m.parameters("m_b", "kg", above=0), m.parameters("k", "N/m", above=0)\n'
        '    m.body("bob", mass=m_b, at=(x, y))\n    m.spring(k, stretch=sqrt(x**2 + y**2))\n'
        "    output(m, x)\n    return m\n"
    )
    (tmp_path / "bob.toml").write_text(
        'mechanism = "./bob.py"\nabout = "."\n[parameters]\nm_b = "1 kg"\nk = "1 N/m"\n[simulation]\nt_end = "1 s"\n'
    )
    far = doubts(str(tmp_path / "bob"), x=30.0, y=40.0, xd=1.0, yd=0.5)
    assert far == {"spring_stretch": pytest.approx(50.0), "start_speeds": pytest.approx((0.6 + 0.8 * 0.5) / 0.6)}
    assert not doubts(str(tmp_path / "bob"), xd=1.0, yd=0.5)

"""The bound on total inertia: against exact motions of machines drawn at random, and against closed forms."""

import dataclasses
import json

import numpy as np
import pytest
import scipy
from codesigns import bound, design, task

from mechsym.cli import main
from mechsym.codesign.certificate import Terms, floor, hidden, proofs, swing_per_inertia
from mechsym.codesign.points import Point
from mechsym.codesign.rank import rank
from mechsym.codesign.task import roller_inertia
from mechsym.errors import BadInput
from mechsym.hinge.balance import constant_load_speed, propeller_load_speed, ripple
from mechsym.hinge.springs.air import AirAbsolute, AirGauge
from mechsym.hinge.springs.face import affine_energy

ANGLES = 720
PA = 101325.0


def wave(draw, phi, period):
    """A smooth function of the angle of swing 1."""
    turn = 2 * np.pi * phi / period
    made = sum((draw.normal() * np.cos(k * turn) + draw.normal() * np.sin(k * turn)) / k**1.5 for k in range(1, 7))
    return made / np.ptp(made)


def guide(draw, phi, period):
    """One guide: energy by pressure [J/Pa], energy that the air outside adds [J], inertia of its rollers [kg*m^2]."""
    H, A, n = draw.uniform(0.4, 1.5), draw.uniform(0.005, 0.06), draw.uniform(1.05, 1.4)
    shape = wave(draw, phi, period)
    z = H * (0.05 + draw.uniform(0.1, 0.6) * (shape - shape.min()))
    slope = (np.roll(z, -1) - np.roll(z, 1)) / (2 * phi[1])
    mass, pa = draw.choice([0.0, draw.uniform(0, 1000)]), draw.choice([0.0, PA])
    law = AirAbsolute(A=A, H=H, n=n, p0=1.0, pa=pa) if pa else AirGauge(A=A, H=H, n=n, p0=1.0)
    stored, by_pressure = affine_energy(law, z)
    rollers = roller_inertia(draw.uniform(0.7, 1.5) - z / 2, -slope / 2, mass, 0.0, 0.1, 2)
    return by_pressure, stored, rollers


@dataclasses.dataclass
class Machine:
    """Points with guides whose springs hold their works nearly, and what is missing beside them."""

    points: list
    phi: np.ndarray
    missing: list  #: at each point [J]
    inertia: np.ndarray  #: of engine and rollers [kg*m^2]
    terms: Terms
    springs: int

    def speeds(self, flywheel):
        """Speed of each point by its own [-]; None where one stops."""
        turning, made = self.inertia + flywheel, []
        for p, w in zip(self.points, self.missing, strict=True):
            propeller = p.law == "propeller"
            u = (
                propeller_load_speed(w, turning, p.omega, p.load_torque, p.period)
                if propeller
                else constant_load_speed(w, turning, p.omega)
            )
            if u is None:
                return None
            made.append(u / p.omega)
        return made


def machine(seed):
    draw = np.random.default_rng(seed)
    period = 2 * np.pi * draw.integers(1, 3)
    phi = np.arange(ANGLES) * period / ANGLES
    springs, count = int(draw.integers(1, 3)), int(draw.integers(2, 6))
    guides = [guide(draw, phi, period) for _ in range(springs)]
    stored, rollers = sum(g[1] for g in guides), sum(g[2] for g in guides)
    law, omegas = str(draw.choice(["propeller", "constant"])), draw.uniform(3, 30, count)
    # of the order of what rollers and air add, so that their terms are tried and something is left
    size = draw.uniform(0.3, 3) * (10 + np.ptp(rollers) + np.ptp(stored) / omegas.min() ** 2)
    torque, own = draw.uniform(0, 2), draw.uniform(20, 200) * (1 + 0.3 * wave(draw, phi, period))
    # opposed from point to point, or of shapes of their own: no pressure takes it away
    rests = [wave(draw, phi, period)] * count if springs == 1 else [wave(draw, phi, period) for _ in range(count)]
    points, missing = [], []
    for k, omega in enumerate(np.sort(omegas)):
        left = size * omega**2 * ((-1) ** k * rests[k] + draw.uniform(0, 0.3) * wave(draw, phi, period))
        held = sum(draw.uniform(1e4, 3e6) * g[0] for g in guides)
        work = left - held - stored - omega**2 * rollers / 2
        points.append(
            Point(
                omega=omega,
                load_torque=torque * size * omega**2,
                law=law,
                period=period,
                work=scipy.interpolate.CubicSpline(np.append(phi, period), np.append(work, work[0])),
                inertia=None,
                torque=None,
            )
        )
        missing.append(left)
    terms = Terms(rollers=float(np.ptp(rollers)), ambient=float(np.ptp(stored)))
    return Machine(points, phi, missing, own + rollers, terms, springs)


def nearness(seed):
    """Bound by what turns in an exact motion, by the mean and by mid-range [-]; at most 1 where it is true."""
    made, draw = machine(seed), np.random.default_rng(1000 + seed)
    wanted = draw.uniform(0.01, 0.15)

    def excess(flywheel):
        speeds = made.speeds(flywheel)
        return (2.0 if speeds is None else max(ripple(u) for u in speeds)) - wanted

    high = 10.0
    while excess(high) > 0:
        high *= 2
    flywheel = 0.0 if excess(0.0) <= 0 else scipy.optimize.brentq(excess, 0.0, high, rtol=1e-12)
    speeds = made.speeds(flywheel)
    middle = max(2 * (u.max() - u.min()) / (u.max() + u.min()) for u in speeds)
    turns = (made.inertia + flywheel).max()
    q = (swing_per_inertia(max(ripple(u) for u in speeds)), swing_per_inertia(middle, "mid-range"))
    found = [proofs(made.points, made.phi[::4], each, made.terms, made.springs)[-1] for each in q]
    return [f.total_inertia / turns for f in found]


@pytest.mark.parametrize("seed", range(3))
def test_no_exact_motion_turns_less_than_the_bound(seed):
    assert max(nearness(seed)) <= 1


@pytest.mark.slow
def test_fifteen_machines_turn_no_less_than_the_bound():
    found = np.array([nearness(seed) for seed in range(3, 18)])
    assert found.max() <= 1
    assert np.count_nonzero(found[:, 0] > 0.3) >= 5  # it is not true for being low


@pytest.mark.slow
@pytest.mark.heavy
def test_two_hundred_machines_turn_no_less_than_the_bound():
    found = np.array([nearness(seed) for seed in range(20, 220)])
    assert found.max() <= 1
    assert found.max() > 0.9


def opposed(amount, rollers=None, law="constant", torque=0.0):
    """Two points of one speed whose works differ by twice a cosine of an amplitude [kg*m^2]."""
    phi = np.arange(ANGLES) * 2 * np.pi / ANGLES
    sides = [lambda x, s=s: 100.0 * s * amount * np.cos(x) for s in (1, -1)]
    return [
        Point(omega=10.0, load_torque=torque, law=law, period=2 * np.pi, work=w, inertia=None, torque=None)
        for w in sides
    ], phi


def test_two_opposed_works_need_half_their_difference():
    points, phi = opposed(5.0)
    (proof,) = proofs(points, phi, 1.0, Terms(), 1)
    # no pressure above 0 takes anything away: ptp(Y_l - c Y_k)/(1 + c) is 10 for every c
    assert proof.total_inertia == pytest.approx(10.0, rel=1e-9) and proof.points == (0, 1)


def test_the_lag_of_a_load_with_the_square_of_the_speed():
    points, phi = opposed(5.0, law="propeller", torque=30.0)
    (proof,) = proofs(points, phi, 0.1, Terms(), 1)
    # extremes half a turn apart: epsilon = pi M / omega^2, the worst there is
    assert proof.total_inertia == pytest.approx(10.0 / 0.1 - np.pi * 30.0 / 100.0, rel=1e-6)


def test_rollers_alone_hold_a_work_and_the_bound_knows_it():
    # Y_k = c_k S - I_h/2 ripples 0 without any flywheel: without the term of I_h the statement is false
    phi = np.arange(ANGLES) * 2 * np.pi / ANGLES
    points = [
        Point(
            omega=10.0,
            load_torque=0.0,
            law="constant",
            period=2 * np.pi,
            inertia=None,
            torque=None,
            work=lambda x, c=c: 100 * (c * np.sin(x) - 20 * np.cos(2 * x)),
        )
        for c in (1.0, 3.0)
    ]
    assert proofs(points, phi, 0.01, Terms(), 1)[0].total_inertia > 100
    assert proofs(points, phi, 0.01, Terms(rollers=80.0), 1)[0].total_inertia == 0


def test_the_pressure_outside_holds_a_work_and_the_bound_knows_it():
    # the same work of V at two speeds: no flywheel is needed, and V omega^-2 differs by the speeds
    phi = np.arange(ANGLES) * 2 * np.pi / ANGLES
    points = [
        Point(
            omega=w,
            load_torque=0.0,
            law="constant",
            period=2 * np.pi,
            inertia=None,
            torque=None,
            work=lambda x, w=w: w**2 * np.sin(x) - 900.0 * np.cos(2 * x),
        )
        for w in (10.0, 30.0)
    ]
    assert proofs(points, phi, 0.01, Terms(), 1)[0].total_inertia > 100
    assert proofs(points, phi, 0.01, Terms(ambient=1800.0), 1)[0].total_inertia == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize(
    ("at", "swings"),
    [((0, 1, 2, 3, 4, 5), (44.79884, 10.08073)), ((1, 2, 3, 4, 5), (17.21396,)), ((2, 3, 4, 5), (10.19631,))],
)
def test_without_rollers_load_and_air_the_proof_is_what_the_best_shapes_leave(at, swings):
    points = [dataclasses.replace(task().points[k], law="constant") for k in at]
    found = proofs(points, bound().phi, 1.0, Terms(), len(swings))
    assert [p.total_inertia for p in found] == pytest.approx(swings, abs=1e-5)
    assert [p.total_inertia for p in found] == pytest.approx(rank(points, len(swings)).swing, rel=1e-7)
    assert all(p.total_inertia <= d for p, d in zip(found, rank(points, len(swings)).swing, strict=True))


def test_ripple_by_the_mean_and_by_mid_range():
    # u from 0.9 to 1.1: mid-range 0.2, (1.1^2 - 0.9^2)/2 = 0.2; both may say more, never less
    assert swing_per_inertia(0.2, "mid-range") >= 0.2 and swing_per_inertia(0.2) >= 0.2
    with pytest.raises(BadInput, match="mean, mid-range"):
        swing_per_inertia(0.2, "median")


@pytest.mark.slow
def test_the_built_in_design_stands_on_its_bound():
    found = floor(design(), bound(), np.array([0.02]))
    assert found.proven and found.proofs[0].points == (0, 5)
    assert 0.6 * found.total_inertia < found.proofs[0].total_inertia < found.total_inertia
    assert found.estimate[0] == pytest.approx(44.80 / 0.02, rel=1e-3)
    assert hidden(design(), None) == () and hidden(design(), design()) == ()
    inside = dataclasses.replace(design(), task=dataclasses.replace(design().task, losses=object()))
    assert not floor(inside, bound(), np.array([0.02])).proven


@pytest.mark.slow
@pytest.mark.heavy
@pytest.mark.parametrize("free", ["spring.A,spring.H,guide.rho0", "rollers.radius,moving_mass,guide.rho0"])
def test_no_hardware_hides_a_flywheel(monkeypatch, capsys, free):
    words = ("zotov-89", "--speeds", "60,75,89,105,120,142", "--ripple", "2%", "--free", free, "--json")
    monkeypatch.setattr("sys.argv", ["mechsym", "codesign", *words])
    with pytest.raises(SystemExit) as stop:
        main()
    numbers = json.loads(capsys.readouterr().out)
    assert not stop.value.code
    assert numbers["total_inertia"] >= numbers["bound"]["total_inertia"][0] > 0
    given = numbers["with_given_hardware"]
    assert numbers["flywheel_inertia"] + numbers["rollers_inertia"] <= sum(
        given[key] for key in ("flywheel_inertia", "rollers_inertia")
    )
    moved = numbers["rollers_inertia"] - given["rollers_inertia"]
    told = [d["value"] for d in numbers["doubts"] if d["code"] == "moved_to_rollers"]
    saved = given["flywheel_inertia"] - numbers["flywheel_inertia"]
    assert told == ([pytest.approx(moved / saved)] if saved > 0 and moved > 0.1 * saved else [])
    reach = [g["rho_max"] + g["roller_radius"] for g in numbers["guides"]]
    assert max(reach) <= 1.005 * 1.5 * 0.9  # rho0 + r of the case, and half of it more

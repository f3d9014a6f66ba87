"""The guide: virtual work returns the torque for every law, arrangement and start; equations (10), (11) and (14)."""

import numpy as np
import pytest
from hinges import HIGHER, LOWER, built_four_stroke, exact_torque, section, whole
from hypothesis import example, given
from hypothesis import strategies as st

from mechsym import periodic
from mechsym.errors import BadInput
from mechsym.hinge import balance, guide
from mechsym.hinge.choices import GuideParameters
from mechsym.hinge.springs.air import AirAbsolute, AirGauge
from mechsym.hinge.springs.coil import Coil
from mechsym.hinge.torque import EngineTorques
from mechsym.hinge.torque import hinge_of as build_hinge

TURN = 2 * np.pi
A, H, P0, N, RHO0 = 0.031, 1.0, 5e6, 1.25, 0.8  # Fig. 5, a and b, dependence 2
SPRINGS = {
    "air_gauge": AirGauge(A=A, H=H, p0=P0, n=N),
    "air_absolute": AirAbsolute(A=A, H=H, p0=P0, n=N),
    "coil": Coil(k=1e6, F0=1e5, H=0.7),
}
RATIOS = {"two_tracks": 1.0, "one_roller": 1.0, "half_speed_pi_periodic": 0.5}
LAW = pytest.mark.parametrize("spring", SPRINGS.values(), ids=SPRINGS)
ARRANGEMENT = pytest.mark.parametrize("arrangement", RATIOS)
START = pytest.mark.parametrize("start", ["as_printed", "placed"])


def cut(spring, name=LOWER, arrangement="two_tracks", start="placed", **changes):
    changes = {"rho0": RHO0, "shaft_ratio": RATIOS[arrangement]} | changes
    return guide.cut(whole(name), spring, GuideParameters(arrangement=arrangement, start=start, **changes))


def peak(part):
    low, _, high, _ = periodic.extremes(part.torque)
    return max(-low, high)


@START
@ARRANGEMENT
@LAW
@pytest.mark.parametrize("name", [LOWER, HIGHER])
def test_virtual_work_returns_the_torque_between_the_knots(name, spring, arrangement, start, rng):
    found = cut(spring, name, arrangement, start, rho0=1.2)
    phi = rng.uniform(-10, 10, 2000)
    wrong = guide.crank_torque(guide.refit(found, spring), phi) - exact_torque(name, phi)
    assert np.max(np.abs(wrong)) < 1e-10 * peak(whole(name))


@START
@ARRANGEMENT
@LAW
def test_energy_of_the_spring_alone_returns_the_torque(spring, arrangement, start, rng):
    """Only the path's values are used, no slope of it: - dU/dphi by a central difference of fourth order."""
    found = cut(spring, arrangement=arrangement, start=start)
    kinks = np.array([0.0, 1.9198621771937625, 2.443460952792061, 4.363323129985824, TURN])
    phi = rng.uniform(0, TURN, 300)
    phi = phi[np.min(np.abs(phi[:, None] - kinks), axis=1) > 0.05]

    def energy(angle):
        z = guide.closing(found, found.rho(found.parameters.shaft_ratio * angle))
        return spring.energy(z)

    h = 1e-3
    slope = (energy(phi - 2 * h) - 8 * energy(phi - h) + 8 * energy(phi + h) - energy(phi + 2 * h)) / (12 * h)
    assert -slope == pytest.approx(whole().torque(phi), abs=2e-8 * peak(whole()))


@ARRANGEMENT
@LAW
def test_path_closes_and_starts_where_it_should(spring, arrangement):
    for start in ("as_printed", "placed"):
        found = cut(spring, arrangement=arrangement, start=start, z_margin=0.01)
        low, _, high, _ = periodic.extremes(found.rho)
        assert found.closure < 1e-13
        if start == "as_printed":
            assert float(found.rho(0.0)) == pytest.approx(RHO0, abs=1e-13)
            assert high > RHO0  # longer than its free height somewhere
        else:
            assert guide.closing(found, high) == pytest.approx(0.01, abs=1e-13)
        assert guide.closing(found, low) > 0.1


def test_10_stored_work_is_the_work_of_the_torque(rng):
    found, phi = cut(SPRINGS["air_gauge"], start="as_printed"), rng.uniform(0, TURN, 500)
    rho = found.rho(phi)
    left = A * P0 * H / (N - 1) - A * P0 * H**N * (H - 2 * RHO0 + 2 * rho) ** (1 - N) / (N - 1)
    assert left == pytest.approx(whole().work(phi), abs=1e-6)


@pytest.mark.parametrize("name", [LOWER, HIGHER])
def test_11_path_in_closed_form(name, rng):
    found, phi = cut(SPRINGS["air_gauge"], name, start="as_printed"), rng.uniform(0, TURN, 500)
    printed = RHO0 - H / 2 + 0.5 * (H ** (1 - N) - (N - 1) * whole(name).work(phi) / (A * H**N * P0)) ** (1 / (1 - N))
    assert found.rho(phi) == pytest.approx(printed, abs=1e-12)


def printed_14(found, phi, p0_new):
    """Equation (14) with p0* = 5 MPa for the guide as it was cut."""
    rho, work, torque = found.rho(phi), whole().work(phi), whole().torque(phi)
    inner = H ** (1 - N) - H**-N * (N - 1) * work / (A * P0)
    right = 0.5 * H**-N * (N - 1) * torque * inner ** (N / (1 - N)) / (A * (1 - N) * P0)
    return -2 * H**N * A * p0_new / (H - 2 * (RHO0 - rho)) ** N * right


def test_14_torque_at_another_pressure_and_its_proportionality(rng):
    spring, phi = SPRINGS["air_gauge"], rng.uniform(0, TURN, 500)
    found = cut(spring, start="as_printed")
    raised = guide.crank_torque(guide.refit(found, AirGauge(A=A, H=H, p0=9.5e6, n=N)), phi)
    assert raised == pytest.approx(printed_14(found, phi, 9.5e6), abs=1e-9 * peak(whole()))
    assert raised == pytest.approx(1.9 * whole().torque(phi), abs=1e-9 * peak(whole()))


def test_14_proportionality_fails_for_absolute_pressure(rng):
    phi = rng.uniform(0, TURN, 500)
    found = cut(SPRINGS["air_absolute"])
    raised = guide.crank_torque(guide.refit(found, AirAbsolute(A=A, H=H, p0=9.5e6, n=N)), phi)
    wrong = np.max(np.abs(raised - 1.9 * whole().torque(phi))) / peak(whole())
    assert 1e-3 < wrong < 0.02


@ARRANGEMENT
@LAW
def test_fast_torque_is_the_vectorised_one(spring, arrangement, rng):
    found = cut(spring, arrangement=arrangement)
    function, phi = guide.torque_function(found), rng.uniform(-50, 50, 200)
    assert [function(float(angle)) for angle in phi] == pytest.approx(
        guide.crank_torque(guide.refit(found, spring), phi), rel=1e-11, abs=1e-9 * peak(whole())
    )


def test_two_opposite_rollers_on_one_plane_track_need_period_pi():
    found = cut(SPRINGS["air_gauge"], arrangement="half_speed_pi_periodic")
    theta = np.linspace(0, TURN, 100)
    assert found.rho(theta) == pytest.approx(found.rho(theta + np.pi), abs=1e-14)
    plain = cut(SPRINGS["air_gauge"])
    assert np.max(np.abs(plain.rho(theta) - plain.rho(theta + np.pi))) > 0.1


@pytest.mark.parametrize(
    ("arrangement", "part", "ratio"),
    [
        ("two_tracks", "whole_cycle", 0.5),
        ("one_roller", "whole_cycle", 0.5),
        ("half_speed_pi_periodic", "whole_cycle", 0.25),
        ("two_tracks", "every_turn", 1.0),
        ("half_speed_pi_periodic", "every_turn", 0.5),
    ],
)
def test_four_stroke_on_its_shaft(arrangement, part, ratio, rng):
    wanted = balance.balance(built_four_stroke(), part)
    spring = AirAbsolute(A=0.002, H=0.3, p0=4e6, n=1.25)
    chosen = GuideParameters(arrangement=arrangement, start="placed", rho0=0.3, shaft_ratio=ratio)
    found, phi = guide.cut(wanted, spring, chosen), rng.uniform(-30, 30, 1000)
    # the track closes after one turn of its own shaft
    assert float(found.rho(0.3)) == pytest.approx(float(found.rho(0.3 + TURN)), abs=1e-14)
    assert guide.crank_torque(guide.refit(found, spring), phi) == pytest.approx(
        wanted.torque(phi), abs=1e-8 * peak(wanted)
    )


@pytest.mark.parametrize(
    ("arrangement", "ratio", "right"),
    [("two_tracks", 0.7, "use 1"), ("two_tracks", 2.0, "use 1"), ("half_speed_pi_periodic", 1.0, "use 0.5")],
)
def test_a_track_that_does_not_close_is_refused_with_the_right_ratio(arrangement, ratio, right):
    with pytest.raises(BadInput, match=right):
        cut(SPRINGS["coil"], arrangement=arrangement, shaft_ratio=ratio)


def test_two_lobes_on_a_half_speed_shaft_close_as_well(rng):
    found, phi = cut(SPRINGS["coil"], shaft_ratio=0.5), rng.uniform(0, 20, 200)
    assert guide.crank_torque(guide.refit(found, SPRINGS["coil"]), phi) == pytest.approx(
        whole().torque(phi), abs=1e-9 * peak(whole())
    )


@pytest.mark.parametrize(
    ("spring", "start", "rho0", "status", "words"),
    [
        (Coil(k=1e5, F0=1e5, H=0.3), "placed", 0.8, "spring_bottoms", "34500 J"),
        (Coil(k=1e6, F0=0.0, H=0.8), "as_printed", 0.8, "spring_pulls", "relax to -200.9"),
        (AirGauge(A=1e-5, H=1.0, p0=1e6, n=1.25), "as_printed", 0.8, "spring_pulls", "place the start"),
        (AirGauge(A=A, H=0.4, p0=3e6, n=N), "placed", 0.12, "crosses_axis", "mm"),
    ],
)
def test_what_cannot_be_cut_says_why_with_numbers(spring, start, rho0, status, words):
    found = cut(spring, start=start, rho0=rho0)
    assert found.status == status
    assert words in found.reason
    assert found.rho is None
    with pytest.raises(BadInput, match="there is no guide"):
        guide.path(found)


def test_a_torque_that_takes_work_has_no_guide():
    poly = periodic.fit(lambda phi: 1e4 + 5e4 * np.sin(phi), (), TURN)
    part = balance.Balance(
        kind="whole_cycle", omega=1.0, period=TURN, torque=poly, work=periodic.antiderivative(poly), rest=poly,
        rest_swing=0.0, ripple_constant_load=0.0, ripple_propeller_load=0.0,
    )  # fmt: skip
    found = guide.cut(part, SPRINGS["coil"], GuideParameters(arrangement="two_tracks", rho0=0.8))
    assert found.status == "takes_work"
    assert "10000 N*m" in found.reason


def test_margin_beyond_the_spring_is_refused():
    with pytest.raises(BadInput, match="z_margin"):
        cut(SPRINGS["coil"], z_margin=0.7)


def test_cases_choose_what_can_be_cut():
    for name in (LOWER, HIGHER):
        assert guide.cut(whole(name), section("spring", name), section("guide", name)).status == "cut"


@given(
    st.lists(st.floats(-1, 1), min_size=3, max_size=3),
    st.floats(1.0, 1.6),
    st.floats(1.2, 6),
    st.sampled_from(["air_gauge", "air_absolute", "coil"]),
    st.sampled_from(list(RATIOS)),
)
@example([0.607421875, 0.75, 0.328125], 1.0, 2.0, "coil", "two_tracks")
@example([-0.5078125, -0.5078125, 0.0], 1.0, 2.0, "coil", "two_tracks")
def test_any_spring_that_holds_the_work_returns_any_torque(harmonics, n, stiffness, kind, arrangement):
    """A random torque with a kink; the spring's size is the work swing times `stiffness`."""

    def torque(phi):
        wave = sum(a * np.sin((k + 1) * phi + k) for k, a in enumerate(harmonics))
        return 100 * (wave + 0.3 * np.mod(phi - 1, TURN) ** 1.8 / 10)

    engine = EngineTorques(
        inertia=np.ones_like, dinertia_dphi=np.zeros_like, gas_torque=torque, gravity_torque=np.zeros_like,
        kinks=(1.0,), period=TURN,
    )  # fmt: skip
    part = balance.balance(build_hinge(engine, 10.0), "whole_cycle")
    low, _, high, _ = periodic.extremes(part.work)
    area = stiffness * (high - low) / (1e6 * 0.2)
    spring = {
        "air_gauge": AirGauge(A=area, H=0.2, p0=1e6, n=n),
        "air_absolute": AirAbsolute(A=area, H=0.2, p0=1e6, n=n),
        "coil": Coil(k=2 * stiffness * (high - low) / 0.2**2, F0=1.0 + stiffness, H=0.2),
    }[kind]
    chosen = GuideParameters(arrangement=arrangement, rho0=0.4, z_margin=1e-3, shaft_ratio=RATIOS[arrangement])
    found = guide.cut(part, spring, chosen)
    assert found.status == "cut"
    phi = np.random.default_rng(3).uniform(0, TURN, 400)
    assert guide.crank_torque(guide.refit(found, spring), phi) == pytest.approx(part.torque(phi), abs=1e-8 * peak(part))
    assert guide.closing(found, periodic.extremes(found.rho)[2]) == pytest.approx(1e-3, abs=1e-12)

"""The contact over a turn and its limits on a track that is known in closed form: rho = a + e cos(theta)."""

import math
from dataclasses import replace

import numpy as np
import pytest

from mechsym import periodic
from mechsym.errors import BadInput
from mechsym.hinge import limits as contacts
from mechsym.hinge.choices import GuideParameters, Limits
from mechsym.hinge.guide import Guide
from mechsym.hinge.limits import judge, undercut_radius
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.springs.air import AirAbsolute
from mechsym.hinge.springs.coil import Coil

a, e, RHO0, OMEGA = 0.6, 0.05, 0.7, 10.0
COIL = Coil(k=1e6, F0=1e5, H=0.5)
AIR = AirAbsolute(A=0.031, H=1.0, p0=5e6, n=1.25)
ROLLERS = RollerParameters(radius=0.1, width=0.08, plane_offset=0.15, friction="rolling", rolling_arm=1e-4)
LIMITS = Limits(
    spring_pressure=10e6, closing_share=0.8, pressure_angle=0.5, profile_radius=0.01, roller_reaction=5e5,
    hertz_stress=2e9,
)  # fmt: skip


def guide(arrangement="two_tracks", ratio=1.0, spring=COIL, **more):
    parameters = GuideParameters(arrangement=arrangement, rho0=RHO0, shaft_ratio=ratio)
    path = periodic.fit(lambda theta: a + e * np.cos(theta), (), 2 * np.pi, 1e-13)
    made = {"status": "cut", "reason": "", "closure": 0.0} | more
    return Guide(parameters=parameters, spring=spring, omega=OMEGA, rho=path, **made)


def outside(theta):
    """Path, tangent and its turning as complex numbers, from the track's point and not from rho."""
    turned = np.exp(1j * theta)
    point = a * turned + e * (turned**2 + 1) / 2
    tangent, bend = 1j * (a * turned + e * turned**2), -(a * turned + 2 * e * turned**2)
    curvature = (tangent.conjugate() * bend).imag / np.abs(tangent) ** 3
    slope = -e * np.sin(theta)
    return np.abs(point), slope, np.abs(tangent), curvature


@pytest.mark.parametrize(
    ("arrangement", "ratio", "c", "planes"),
    [("two_tracks", 1.0, 2, 0.15), ("one_roller", 1.0, 1, 0.0), ("half_speed_pi_periodic", 0.5, 2, 0.0)],
)
@pytest.mark.parametrize("mass", [0.0, 200.0])
def test_contact_of_a_known_track(arrangement, ratio, c, planes, mass):
    theta = np.linspace(0, 2 * np.pi, 37)
    found = contacts.at_angles(guide(arrangement, ratio), replace(ROLLERS, moving_mass=mass), theta)
    rho, slope, speed, curvature = outside(theta)
    force = 1e5 + 1e6 * c * (RHO0 - rho)
    per_kilogram = (OMEGA * ratio) ** 2 * (a + 2 * e * np.cos(theta))
    # the track is smooth, so its force stands along the normal; what it has along the radius balances spring and mass
    normal = (force + mass * per_kilogram) * speed / rho
    relative = 0.1 * (1 + 0.1 * curvature)
    wanted = {
        "theta": theta, "phi": theta / ratio, "rho": rho, "drho": slope, "d2rho": -e * np.cos(theta),
        "z": c * (RHO0 - rho), "force": force, "pressure_angle": np.arcsin(slope / speed), "curvature": curvature,
        "reaction_1": normal, "reaction_2": force if c == 1 else normal,
        "hertz_stress": np.sqrt(normal * 2.06e11 / 1.82 / (np.pi * 0.08 * relative)),
        "tilting_couple": planes * normal, "inertia_force": per_kilogram, "torque": c * force * slope,
        "loss_torque": c * 1e-4 * normal / 0.1 * speed,
    }  # fmt: skip
    assert found.pressure is None
    for name, values in wanted.items():
        size = np.abs(values).max() or 1.0
        assert getattr(found, name) == pytest.approx(values, abs=1e-9 * size), name


def test_a_gas_spring_shows_its_pressure():
    theta = np.array([0.0, 1.0])
    found = contacts.at_angles(guide(spring=AIR), ROLLERS, theta)
    assert found.pressure == pytest.approx(found.force / 0.031)


def test_points_of_pieces_are_dense_and_in_order():
    found = contacts.at_pieces(guide(), ROLLERS)
    assert found.theta[0] == 0 and found.theta[-1] == pytest.approx(2 * np.pi)
    assert found.theta.size >= 65 and np.all(np.diff(found.theta) >= 0)
    assert found.rho == pytest.approx(a + e * np.cos(found.theta), abs=1e-12)
    assert found.d2rho == pytest.approx(-e * np.cos(found.theta), abs=1e-9)


def test_numbers_of_the_verdict():
    found = judge(guide(spring=AIR), replace(ROLLERS, moving_mass=50.0), LIMITS)
    rho, slope, speed, curvature = outside(np.linspace(0, 2 * np.pi, 20001))
    pressure = 5101325 * (1 / 0.7) ** 1.25 - 101325
    force = 0.031 * (5101325 * (1 / (1 - 2 * (RHO0 - rho))) ** 1.25 - 101325)
    normal = (force + 50 * OMEGA**2 * (2 * rho - a)) * speed / rho
    stress = np.sqrt(normal * 2.06e11 / 1.82 / (np.pi * 0.08 * 0.1 * (1 + 0.1 * curvature)))
    assert (found.rho_min, found.rho_max) == pytest.approx((a - e, a + e), abs=1e-12)
    assert (found.z_min, found.z_max) == pytest.approx((0.1, 0.3), abs=1e-12)
    assert found.spring_pressure_max == pytest.approx(pressure)
    assert found.spring_force_max == pytest.approx(0.031 * pressure)
    assert found.pressure_angle_max == pytest.approx(math.asin(e / a), rel=1e-6)
    assert found.curvature_radius_min == pytest.approx(1 / np.abs(curvature).max(), rel=1e-6)
    assert found.undercut_radius is None
    assert found.roller_reaction_max == pytest.approx(normal.max(), rel=1e-6)
    assert found.hertz_stress_max == pytest.approx(stress.max(), rel=1e-6)
    assert found.tilting_couple_max == pytest.approx(0.15 * normal.max(), rel=1e-6)
    assert found.inertia_force_max == pytest.approx(100 * (a + 2 * e), rel=1e-9)
    loss = 2 * 1e-4 / 0.1 * np.mean((normal * speed)[:-1])
    assert found.loss_torque_mean == pytest.approx(loss, rel=1e-4)
    assert found.closure == 0.0


def test_margin_is_the_share_that_is_left_of_each_limit():
    found = judge(guide(spring=AIR), ROLLERS, LIMITS)
    margins = {check.name: check.margin for check in found.checks}
    assert margins == {
        "free_height": None, "spring_force": None, "undercut": None, "closure": 1.0,
        "closing": pytest.approx((0.8 - 0.3) / 0.8), "centre": pytest.approx((0.55 - 0.1) / 0.55),
        "spring_pressure": pytest.approx(1 - found.spring_pressure_max / 10e6),
        "pressure_angle": pytest.approx(1 - math.asin(e / a) / 0.5, rel=1e-6),
        "roller_reaction": pytest.approx(1 - found.roller_reaction_max / 5e5),
        "hertz_stress": pytest.approx(1 - found.hertz_stress_max / 2e9),
        "room": pytest.approx((0.2 - 0.1) / 0.2),
    }  # fmt: skip
    assert all(check.kept for check in found.checks) and found.feasible
    assert found.margin == pytest.approx(min(m for m in margins.values() if m is not None))


def one(name, **changes):
    parts = {"guide": guide(spring=AIR), "rollers": ROLLERS, "limits": LIMITS} | changes
    return next(c for c in judge(parts["guide"], parts["rollers"], parts["limits"]).checks if c.name == name)


def test_a_gap_of_the_path_is_a_billionth_of_its_radius_at_most():
    assert one("closure", guide=guide(closure=0.99e-9 * RHO0)).kept
    assert not one("closure", guide=guide(closure=1.01e-9 * RHO0)).kept
    assert "gap of the path" in one("closure", guide=guide(closure=1e-3)).text


def test_a_spring_that_pulls_or_is_too_long_is_refused():
    # rho0 below the largest rho: at the top the spring is 2 mm longer than its free height
    low = guide(spring=replace(COIL, F0=1.0))
    low = replace(low, parameters=replace(low.parameters, rho0=a + e - 1e-3))
    found = one("free_height", guide=low)
    assert not found.kept and found.margin == pytest.approx(-2e-3 / 0.5) and found.text.startswith("the spring is 2 mm")
    pulls = one("spring_force", guide=low)
    assert not pulls.kept and pulls.margin == -1.0 and "-1.999 kN" in pulls.text
    assert contacts.at_angles(low, ROLLERS, np.zeros(1)).hertz_stress[0] == 0.0
    assert one("free_height").text == "smallest closing 100 mm"
    assert one("spring_force").kept and "177.3 kN" in one("spring_force").text


def test_room_beside_the_gas_column_is_only_asked_of_two_rollers_and_gas():
    names = [c.name for c in judge(guide(), ROLLERS, LIMITS).checks]
    assert "room" not in names and "spring_pressure" not in names
    assert "room" not in [c.name for c in judge(guide("one_roller", spring=AIR), ROLLERS, LIMITS).checks]


def test_a_track_that_bends_inwards():
    # e = 0.5 a: at theta = pi the limacon bends inwards
    inner = replace(guide(), rho=periodic.fit(lambda theta: a + 0.4 * np.cos(theta), (), 2 * np.pi, 1e-13))
    inner = replace(inner, parameters=replace(inner.parameters, rho0=1.2))
    # kappa = (a^2 + 2 e^2 - 3 a e) / (a - e)^3 there
    radius = -((a - 0.4) ** 3) / (a**2 + 2 * 0.4**2 - 3 * a * 0.4)
    found = one("undercut", guide=inner)
    assert found.margin == pytest.approx((radius - 0.1 - 0.01) / radius, rel=1e-6) and found.kept is (radius >= 0.11)
    assert f"inwards with a radius of {radius * 1e3:.4g} mm" in found.text
    assert (
        f"leaves the profile {(radius - 0.1) * 1e3:.4g} mm at a roller radius of 100 mm; at least 10 mm" in found.text
    )
    near = one("undercut", guide=inner, rollers=replace(ROLLERS, radius=radius - 0.009))
    assert not near.kept and "(undercut)" not in near.text and "at least 10 mm" in near.text
    assert one("undercut", guide=inner, rollers=replace(ROLLERS, radius=radius - 0.0101)).kept
    assert "(undercut)" in one("undercut", guide=inner, rollers=replace(ROLLERS, radius=radius + 1e-3)).text


def test_undercut_radius():
    assert undercut_radius(np.array([2.0, -4.0, -0.5])) == 0.25
    assert undercut_radius(np.array([0.0, 1.0])) is None


@pytest.mark.parametrize(
    ("name", "good", "bad"),
    [
        ("spring_pressure", 1e-6, 0.0), ("closing_share", 1.0, 1.01), ("closing_share", 1e-6, 0.0),
        ("pressure_angle", 1.57, math.pi / 2), ("pressure_angle", 1e-6, 0.0), ("profile_radius", 0.0, -1e-9),
        ("roller_reaction", 1e-6, 0.0), ("hertz_stress", 1e-6, 0.0),
    ],
)  # fmt: skip
def test_ranges_of_limits(name, good, bad):
    assert getattr(replace(LIMITS, **{name: good}), name) == good
    with pytest.raises(BadInput, match=name):
        replace(LIMITS, **{name: bad})


def test_loss_is_the_mean_over_the_turn():
    # a circle: N f / r times rho at every angle, for both rollers
    round_one = replace(guide(), rho=periodic.fit(lambda theta: 0 * theta + a, (), 2 * np.pi, 1e-13))
    found = judge(round_one, ROLLERS, LIMITS)
    force = 1e5 + 1e6 * 0.2
    assert found.loss_torque_mean == pytest.approx(2 * force * 1e-4 / 0.1 * a)

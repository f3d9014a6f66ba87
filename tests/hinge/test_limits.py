"""Feasibility: every limit can fail alone, with its number; the twelve guides of Fig. 5."""

import dataclasses

import numpy as np
import pytest
from hinges import HIGHER, LOWER, section, whole

from mechsym.cases import load
from mechsym.errors import BadInput
from mechsym.hinge import guide
from mechsym.hinge import limits as feasibility
from mechsym.hinge.springs.air import AirGauge
from mechsym.hinge.springs.air_thermal import AirThermal
from mechsym.hinge.springs.coil import Coil
from mechsym.papers.zotov2024.rows import family

LIMITS = section("limits")
THERMAL = AirThermal(A=0.031, H=1.0, p0=5e6, tau=1.0)


def verdict(name=LOWER, limits=LIMITS, **changes):
    sections = {key: section(key, name) for key in ("spring", "guide", "rollers")}
    for key, value in changes.items():
        sections[key] = dataclasses.replace(sections[key], **value)
    cut = guide.cut(whole(name), sections["spring"], sections["guide"])
    return feasibility.judge(cut, sections["rollers"], limits)


@pytest.mark.parametrize("name", [LOWER, HIGHER])
def test_built_in_designs_can_be_built(name):
    found = verdict(name)
    assert found.feasible
    assert found.margin > 0.05
    assert "tightest" in found.reason


def test_numbers_of_the_design_are_consistent():
    found, spring = verdict(), section("spring")
    assert found.z_max == pytest.approx(2 * (0.8 - found.rho_min))
    assert found.z_min == pytest.approx(0.01, abs=1e-12)
    assert found.spring_force_max == pytest.approx(spring.A * found.spring_pressure_max)
    assert found.roller_reaction_max >= found.spring_force_max * (1 - 1e-6)
    assert found.tilting_couple_max == pytest.approx(0.15 * found.roller_reaction_max)


def test_limits_that_are_kept_say_by_how_much():
    texts = {check.name: check.text for check in verdict().checks}
    assert texts["closure"] == "the path closes within a billionth of its radius"
    force = 0.031 * ((5e6 + 101325) * 0.99**-1.25 - 101325)  # a closing of 10 mm of 1 m
    assert texts["spring_force"] == f"smallest spring force {force / 1e3:.4g} kN"
    heated = feasibility._checks_of_spring(0.01, THERMAL)
    assert {check.name: check.text for check in heated}["spring_force"] == "the spring pushes"


def test_a_path_that_does_not_close_tells_its_gap():
    assert feasibility._closure_check(2e-9, 1.0).text == "gap of the path 2e-09 of at most 1e-09 m"
    for gap, kept in ((5e-10, True), (3e-9, False)):  # of a billionth of 2 m
        check = feasibility._closure_check(gap, 2.0)
        assert (check.kept, check.margin) == (kept, pytest.approx(1 - gap / 2e-9))


@pytest.mark.parametrize(
    ("name", "limit", "words"),
    [
        ("spring_pressure", 8e6, "spring pressure 8.411 of at most 8 MPa"),
        ("closing_share", 0.3, "closing z/H 0.3361 of at most 0.3"),
        ("pressure_angle", 0.25, "pressure angle 16.05 of at most 14.32 deg"),
        ("roller_reaction", 2e5, "roller reaction 260.8 of at most 200 kN"),
        ("hertz_stress", 8e8, "contact pressure 904.7 of at most 800 MPa"),
    ],
)
def test_each_limit_fails_alone_with_its_number(name, limit, words):
    found = verdict(limits=dataclasses.replace(LIMITS, **{name: limit}))
    assert not found.feasible
    assert found.reason == words
    assert -0.4 < found.margin < 0


def test_a_printed_start_is_longer_than_free_height():
    found = verdict(guide={"start": "as_printed"})
    assert not found.feasible
    assert found.reason.startswith("the spring is 1.3 mm longer than its free height")
    assert found.margin < 0


def test_undercut_names_both_radii():
    found = verdict(HIGHER, spring={"p0": 3e6}, rollers={"radius": 5.2})
    assert found.undercut_radius == pytest.approx(5.165, abs=2e-3)
    assert "(undercut)" in found.reason
    assert found.hertz_stress_max == np.inf
    assert not any(check.name == "hertz_stress" for check in found.checks)


def test_rollers_must_leave_room_for_the_gas():
    assert "roller radius beside the gas column" in verdict(rollers={"radius": 0.31}).reason


def test_no_room_at_all_says_which_length_is_missing():
    found = verdict(guide={"rho0": 0.45})
    assert not found.feasible and "at most -" not in found.reason
    assert "2 rho0 = 0.9 m, it is H = 1 m long" in found.reason and "rho0 must be at least 0.6 m" in found.reason


def test_no_guide_gives_the_reason_and_no_numbers():
    spring = Coil(k=1e5, F0=1e5, H=0.3)
    cut = guide.cut(whole(), spring, section("guide"))
    found = feasibility.judge(cut, section("rollers"), LIMITS)
    assert (found.feasible, found.margin, found.rho_min) == (False, -1.0, None)
    assert "34500 J" in found.reason


def test_another_pressure_in_the_same_guide_is_judged_with_that_pressure():
    spring = dataclasses.replace(section("spring"), p0=12.5e6)
    cut = guide.cut(whole(), section("spring"), section("guide"))
    found = feasibility.judge(guide.refit(cut, spring), section("rollers"), LIMITS)
    assert found.spring_pressure_max == pytest.approx(2.5 * verdict().spring_pressure_max, rel=0.01)
    assert not found.feasible
    assert "roller reaction" in found.reason


def test_a_coil_has_no_pressure():
    spring = Coil(k=1e6, F0=1e5, H=0.5)
    cut = guide.cut(whole(), spring, section("guide"))
    assert feasibility.judge(cut, section("rollers"), LIMITS).spring_pressure_max is None


def test_zero_margin_is_kept_in_spite_of_rounding():
    for p0 in np.linspace(4e6, 9e6, 11):
        assert verdict(guide={"z_margin": 0.0}, spring={"p0": p0}).checks[0].kept


@pytest.fixture(scope="module")
def members():
    found = family(
        (whole(LOWER), whole(HIGHER)), section("spring"), section("guide"), section("rollers"), section("limits")
    )
    return {(m.label, m.start): m for m in found}


def test_fig_5_has_twelve_guides_printed_and_placed(members):
    assert len(members) == 24
    for member in members.values():
        found = member.verdict
        assert found.reason
        assert found.spring_pressure_max > 3e6
        assert 0 < found.pressure_angle_max < np.pi / 2
        assert found.roller_reaction_max >= found.spring_force_max * (1 - 1e-6)


def test_fig_5_printed_springs_are_one_to_seven_millimetres_too_long(members):
    closings = [m.verdict.z_min for (_, start), m in members.items() if start == "as_printed"]
    assert all(-7e-3 < z < -0.5e-3 for z in closings)
    assert not any(m.verdict.feasible for (_, start), m in members.items() if start == "as_printed")


def test_fig_5_which_placed_guides_can_be_built(members):
    """Long springs at 89 rpm all can; at 142 rpm only the highest pressure; of the short springs only one."""
    feasible = sorted(label for (label, start), m in members.items() if start == "placed" and m.verdict.feasible)
    assert feasible == ["a1", "a2", "a3", "b3", "c3"]
    assert "pressure angle" in members["b2", "placed"].verdict.reason
    assert "spring pressure" in members["d1", "placed"].verdict.reason


def test_fig_5_higher_pressure_and_longer_spring_make_the_guide_rounder(members):
    def swing(label):
        found = members[label, "as_printed"].verdict
        return (found.rho_max - found.rho_min) / found.rho_max

    for letter in "abcd":
        assert swing(letter + "1") > swing(letter + "2") > swing(letter + "3")
    assert swing("a2") < swing("c2")
    assert swing("b2") < swing("d2")


def test_fig_5_needs_a_gas_spring():
    with pytest.raises(BadInput, match="coil has no p0"):
        family((whole(), whole()), Coil(k=1e6, F0=1e5, H=0.5), section("guide"), section("rollers"), LIMITS)


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("guide.start", "somewhere", "placed, as_printed"),
        ("guide.arrangement", "one_track", "two_tracks, one_roller, half_speed_pi_periodic"),
        ("spring.law", "rubber", "air_gauge, air_absolute, air_thermal, coil"),
        ("spring.p0", "-3 MPa", "must be >= 1 and <= 1e"),
        ("rollers.radius", "5 kg", "give it in m"),
        ("limits.pressure_angle", "90 deg", "must be > 0 and < 1.5708 rad"),
        ("guide.rho", "0.8 m", "did you mean 'rho0'"),
    ],
)
def test_bad_case_values_name_what_is_allowed(key, value, words):
    with pytest.raises(BadInput, match=words.replace(".", r"\.")):
        load(LOWER, {key: value})


def test_the_paper_s_own_choice_is_available_by_name():
    case = load(LOWER, {"spring.law": "air_gauge", "guide.start": "as_printed"})
    assert case.need("spring") == AirGauge(A=0.031, H=1.0, p0=5e6, n=1.25)
    assert case.need("guide").arrangement == "two_tracks"


def test_highest_point_lies_between_the_points():
    theta = np.linspace(0, 2, 21)
    assert feasibility.highest(theta, np.cos(theta - 1.234)) == pytest.approx(1, abs=1e-5)
    assert feasibility.highest(theta, theta) == 2
    assert feasibility.highest(np.array([0.0, 1, 1, 2]), np.array([0.0, 3, 1, 0])) == 3


def test_closing_is_a_share_of_the_spring_s_height():
    found = verdict(spring={"H": 1.25})
    (closing,) = (check for check in found.checks if check.name == "closing")
    assert closing.text.startswith(f"closing z/H {found.z_max / 1.25:.4g} of")

"""The co-design against the prototype's numbers, against its own bound, and against two other codes."""

import dataclasses

import numpy as np
import pytest
from codesigns import bound, cut, design, front, ready, task, verified

from mechsym.codesign.front import cut_for_one
from mechsym.codesign.points import bare_flywheel, sample
from mechsym.codesign.programme import solve
from mechsym.codesign.rank import flywheel_estimate, rank
from mechsym.codesign.unknowns import middle
from mechsym.codesign.verify import verify


def test_flywheels_of_the_prototype():
    assert design().status == "optimal"
    assert design().flywheel == pytest.approx(2066, rel=1e-2)
    assert design(0.05).flywheel == pytest.approx(687, rel=1e-2)


@pytest.mark.slow
@pytest.mark.heavy
def test_flywheels_without_roller_mass_and_with_two_springs():
    assert design(moving_mass=0.0).flywheel == pytest.approx(2153, rel=1e-2)
    assert design(springs=2).flywheel == pytest.approx(100, abs=5)
    assert np.nanmax(verified(springs=2).steady_ripple) == pytest.approx(0.02, rel=1e-2)


@pytest.mark.slow
def test_three_ways_agree():
    steady, in_time = verified().steady_ripple, verified().time_ripple
    assert steady == pytest.approx(verified().programme_ripple, rel=3e-3)
    assert in_time == pytest.approx(steady, rel=1e-3)
    assert steady[[0, 5]] == pytest.approx([0.02, 0.02], rel=1e-2)  # the ends are active
    assert steady[1:5].max() < 0.0198
    assert np.abs(verified().energy_residual).max() < 1e-5
    assert verified().broken == ()


def test_limits_of_the_case_hold_and_the_reaction_is_active():
    (contact,) = verified().contacts
    assert contact.reaction_max.max() == pytest.approx(600e3, rel=2e-3)
    assert contact.reaction_min.min() > 0
    assert contact.side_force_max[[2, 5]] == pytest.approx([55e3, 143e3], rel=1e-2)
    assert [a.limit for a in design().active] == ["ripple", "roller_reaction"]


def test_multipliers_are_the_change_of_the_flywheel():
    for limit in design().active:
        if limit.limit == "ripple":
            moved, step = dataclasses.replace(task(), ripple=0.0201), 1e-4
        else:
            bounds = dataclasses.replace(task().bounds, roller_reaction=602e3)
            moved, step = dataclasses.replace(task(), bounds=bounds), 2e3
        change = solve(moved, ready(), design()).flywheel - design().flywheel
        assert change == pytest.approx(limit.multiplier * step, rel=0.03)


@pytest.mark.slow
def test_order_of_the_four_machines_and_the_bound():
    bare = bare_flywheel(task().points, 0.02)
    assert design().flywheel < cut().flywheel < bare
    floor = flywheel_estimate(task().points, bound(), 0.02, 100.0)
    assert design().flywheel > 0.97 * floor
    falling = [d.flywheel for d in front()]
    assert all(d.status == "optimal" for d in front()) and falling == sorted(falling, reverse=True)
    assert falling[0] == pytest.approx(design().flywheel, rel=1e-4)


def test_one_point_needs_no_flywheel():
    alone = solve(dataclasses.replace(task(at=(2,)), ripple=0.005))
    assert alone.status == "optimal"
    assert alone.flywheel < 0.01
    # the exact guide of that point: a spline of 60 knots is not exact
    exact = cut_for_one(dataclasses.replace(task(at=(2,), moving_mass=0.0), ripple=1e-4), 0)
    assert exact.flywheel == 0.0
    assert exact.ripple.max() < 1e-4


@pytest.mark.slow
def test_a_narrower_range_needs_less():
    assert solve(task(at=(2, 5))).flywheel < design().flywheel


@pytest.mark.slow
@pytest.mark.parametrize(
    "changes", [{"knots": 40}, *(pytest.param(c, marks=pytest.mark.heavy) for c in ({"knots": 90}, {"angles": 360}))]
)
def test_finer_splines_and_angles_change_nothing(changes):
    assert solve(dataclasses.replace(task(), **changes)).flywheel == pytest.approx(design().flywheel, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_random_starts_find_the_same(seed):
    made, rng = ready(), np.random.default_rng(seed)
    start = made.start * (1 + 0.1 * rng.standard_normal(made.start.size))
    again = solve(task(), dataclasses.replace(made, start=start))
    assert again.flywheel == pytest.approx(design().flywheel, rel=1e-3)


@pytest.mark.slow
def test_an_error_of_pressure_costs_flywheel_and_is_borne():
    asked = dataclasses.replace(task(at=(0, 5)), robust=0.01)
    robust, plain = solve(asked), solve(task(at=(0, 5)))
    assert robust.status == "optimal"
    assert robust.flywheel > plain.flywheel
    from mechsym.codesign import running

    for error in (-0.01, 0.01):
        for k, point in enumerate(asked.points):
            machine = running.running(point, robust.tracks, k, robust.flywheel, [error])
            assert running.steady(machine).speed_ripple < 0.0203


@pytest.mark.slow
def test_impossible_tasks_end_with_a_status():
    for limit, value in (("roller_reaction", 50e3), ("pressure_angle", 0.0175), ("spring_pressure", 1e6)):
        bounds = dataclasses.replace(task().bounds, **{limit: value})
        made = solve(dataclasses.replace(task(at=(0, 5)), bounds=bounds))
        assert made.status in ("optimal", "infeasible", "not converged")
        if made.status == "optimal":  # a flywheel makes up for a hinge that may do nothing
            assert made.flywheel > design().flywheel


@pytest.mark.slow
def test_constant_load_is_held_by_a_governor():
    points = tuple(dataclasses.replace(p, law="constant") for p in task(at=(2, 5)).points)
    made = solve(dataclasses.replace(task(), points=points))
    assert made.status == "optimal"
    from mechsym.codesign import running

    for k, point in enumerate(points):
        found = running.steady(running.running(point, made.tracks, k, made.flywheel))
        assert found.speed_mean == pytest.approx(point.omega, rel=1e-6)
        assert found.speed_ripple == pytest.approx(made.ripple[k], rel=5e-3)


def test_middle_point_is_that_of_the_middle_work():
    assert middle(sample(task().points, 60)) == 2


@pytest.mark.slow
@pytest.mark.heavy
def test_a_third_spring_pays_where_the_rank_says_so():
    few = task(at=(0, 2, 3, 5), ripple=0.002)
    assert rank(few.points).pays == 3
    two, three = solve(dataclasses.replace(few, springs=2)), solve(dataclasses.replace(few, springs=3))
    assert two.status == three.status == "optimal"
    assert two.flywheel > 1000 and three.flywheel < 1
    assert verify(three).steady_ripple.max() < 0.00202

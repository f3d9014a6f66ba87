"""Other machines at the same points: what a fixed work and what the square of the speed can do."""

import dataclasses

import numpy as np
import pytest
from codesigns import design, task

from mechsym.codesign.front import cam_flywheel, gear_flywheel, peers, worth_it


def by_name(points, ripple):
    return {p.name: p for p in peers(points, [ripple])}


def test_a_fixed_spring_is_between_the_bare_engine_and_a_pressure_for_each_point():
    found = by_name(task().points, 0.02)
    assert found["plain flywheel"].flywheel_inertia == pytest.approx(41518, rel=3e-3)
    assert (
        design().flywheel < found["cam with coil springs"].flywheel_inertia < found["plain flywheel"].flywheel_inertia
    )
    assert design().flywheel < found["noncircular gears"].flywheel_inertia
    # weak ripple: D over ripple less the inertia of the engine
    cam = found["cam with coil springs"]
    assert cam.flywheel_inertia == pytest.approx(cam.swing / 0.02 - 115, rel=0.02)


def test_one_point_leaves_nothing_to_either():
    alone = (task().points[2],)
    found = by_name(alone, 1e-3)
    assert found["cam with coil springs"].flywheel_inertia < 0.01 * found["plain flywheel"].flywheel_inertia
    assert found["noncircular gears"].swing < 1e-6 * found["plain flywheel"].swing


def test_gears_follow_the_square_of_the_speed_and_a_fixed_spring_the_same_work():
    one = task().points[2]
    # the same shape by the square of the speed at another speed, and the same work at another speed
    scaled = dataclasses.replace(one, omega=2 * one.omega, load_torque=4 * one.load_torque,
                                 work=type(one.work)(4 * one.work.c, one.work.x, extrapolate="periodic"))  # fmt: skip
    equal = dataclasses.replace(one, omega=2 * one.omega)
    phi = np.arange(360) * np.pi / 180
    gears = gear_flywheel((one, scaled), phi, one.work(phi) / one.omega**2, 0.02)
    assert gears < 0.1 * by_name((one, scaled), 0.02)["plain flywheel"].flywheel_inertia
    cam = cam_flywheel((one, equal), phi, one.work(phi), 0.01)
    assert cam < 0.02 * by_name((one, equal), 0.01)["plain flywheel"].flywheel_inertia


def test_a_hinge_that_saves_little_is_no_design():
    bare = 41519.0
    assert worth_it(design(), bare, 0.3).status == "optimal"
    poor = worth_it(dataclasses.replace(design(), flywheel=36384.0), bare, 0.3)
    assert poor.status == "infeasible"
    assert "leaves 36384 of 41519" in poor.reason and "roller_reaction" in poor.reason
    assert worth_it(poor, bare, 0.0).status == "infeasible"
    assert worth_it(dataclasses.replace(design(), flywheel=36384.0), bare, 0.0).status == "optimal"

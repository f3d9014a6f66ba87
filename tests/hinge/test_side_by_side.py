"""Guides judged side by side: the verdicts of `judge` one by one, whatever stands beside a guide."""

import dataclasses

import numpy as np
import pytest

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.hinge.balance import balance
from mechsym.hinge.guide import cut
from mechsym.hinge.limits import judge
from mechsym.hinge.side_by_side import GuideDesign, verdicts
from mechsym.hinge.torque import torque
from mechsym.jobs.machine import machine

SECTIONS = ("spring", "guide", "rollers", "limits")
COIL = {"spring.law": "coil", "spring.k": "600 kN/m", "spring.F0": "90 kN", "spring.H": "1 m"}
# case, what is set, what differs between designs
CASES = {
    "absolute": ("zotov-89", {}, ("spring.p0", "spring.A", "spring.n", "guide.z_margin", "rollers.radius")),
    "gauge": ("zotov-142", {"spring.law": "air_gauge"}, ("spring.p0", "spring.H", "spring.n", "rollers.width")),
    "coil": ("zotov-89", COIL, ("spring.k", "spring.F0", "guide.rho0", "limits.pressure_angle")),
    "heavy rollers": ("zotov-89", {}, ("spring.p0", "rollers.moving_mass", "rollers.plane_offset")),
    "as printed": ("zotov-89", {"guide.start": "as_printed"}, ("spring.p0", "spring.H")),
    "every turn": ("generator", {"guide.balance": "every_turn", "guide.shaft_ratio": "1"}, ("spring.p0", "guide.rho0")),
}
# not shown by a sweep, and so not computed
LEFT_OUT = ("inertia_force_max", "loss_torque_mean")


def made(name, overrides):
    case = cases.load(name, overrides)
    given = {key: case.need(key) for key in SECTIONS}
    return balance(torque(machine(case)), given["guide"].balance), given


def drawn(given, free, count):
    """Designs around the case; an index of 1 and a preload of 0 among them, where laws have other formulas."""
    rng, found = np.random.default_rng(7), []
    for i in range(count):
        records = dict(given)
        for name in free:
            section, _, field = name.partition(".")
            value = (getattr(given[section], field) or 10.0) * rng.uniform(0.4, 1.6)
            value = {"n": rng.uniform(1, 1.5) if i % 3 else 1.0, "F0": value if i % 3 else 0.0}.get(field, value)
            records[section] = dataclasses.replace(records[section], **{field: value})
        found.append(GuideDesign(**{{"guide": "choices"}.get(k, k): v for k, v in records.items()}))
    return found


@pytest.mark.parametrize(("name", "overrides", "free"), CASES.values(), ids=CASES)
def test_the_verdicts_are_those_of_one_by_one(name, overrides, free):
    wanted, given = made(name, overrides)
    designs, uncut = drawn(given, free, 14), 0
    for design, found in zip(designs, verdicts(wanted, designs), strict=True):
        one = judge(cut(wanted, design.spring, design.choices), design.rollers, design.limits)
        uncut += found is None
        assert (found is None) == (one.rho_min is None)
        if found is None:
            continue
        assert (found.feasible, found.reason) == (one.feasible, one.reason)
        assert [c.name for c in found.checks] == [c.name for c in one.checks]
        np.testing.assert_allclose(found.margin, one.margin, rtol=1e-11, atol=1e-12)
        for field in dataclasses.fields(one):
            known, value = getattr(one, field.name), getattr(found, field.name)
            if field.name in LEFT_OUT:
                assert value is None
            elif isinstance(known, float):
                np.testing.assert_allclose(value, known, rtol=1e-11, atol=1e-12, err_msg=field.name)
            else:
                assert (value is None) == (known is None)
    assert uncut < 10


def test_what_cannot_be_cut_is_left_to_judge():
    wanted, given = made("zotov-89", {})
    fine = drawn(given, (), 1)[0]
    spring, guide = given["spring"], given["guide"]
    bad = [
        dataclasses.replace(fine, choices=dataclasses.replace(guide, z_margin=2 * spring.H)),  # leaves no spring
        dataclasses.replace(fine, choices=dataclasses.replace(guide, rho0=1e-3)),  # crosses the axis
        dataclasses.replace(fine, spring=dataclasses.replace(spring, A=1e-6)),  # closes fully
        dataclasses.replace(
            fine, spring=dataclasses.replace(spring, p0=1e3), choices=dataclasses.replace(guide, start="as_printed")
        ),  # would have to pull
    ]
    found = verdicts(wanted, [fine, *bad])
    assert found[0] is not None and found[1:] == [None] * 4
    open_track = dataclasses.replace(fine, choices=dataclasses.replace(guide, shaft_ratio=0.3))
    with pytest.raises(BadInput, match="does not close"):
        verdicts(wanted, [open_track])


def test_no_order_and_no_neighbour_matters():
    wanted, given = made("zotov-89", {})
    designs = drawn(given, ("spring.p0", "spring.H"), 25)
    there, back = verdicts(wanted, designs), verdicts(wanted, designs[::-1])[::-1]
    for a, b, c in zip(there, back, (verdicts(wanted, [d])[0] for d in designs), strict=True):
        assert a is not None and b is not None and c is not None
        margins = [[x.margin for x in v.checks if x.margin is not None] for v in (a, b, c)]
        np.testing.assert_allclose(margins[:2], [margins[2]] * 2, rtol=1e-11, atol=1e-12)

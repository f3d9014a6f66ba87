"""Similar machines have similar answers: no number of the program has a size of its own."""

import dataclasses

import numpy as np
import pytest
from codesigns import task
from similar import factor, similar

from mechsym.codesign.front import cut_for_one, peers
from mechsym.codesign.programme import solve
from mechsym.codesign.task import CoDesignTask
from mechsym.hinge.summary import HingeNumbers
from mechsym.jobs.flywheel import flywheel
from mechsym.jobs.forces import balance, forces, numbers, reported
from mechsym.jobs.hinge import hinge
from mechsym.jobs.run import run
from mechsym.jobs.size import size
from mechsym.quantities.results import leaves

GIVES = {
    "forces": lambda case: reported(case, forces(case)),
    "balance": lambda case: numbers(case, balance(case)),
    "flywheel": lambda case: flywheel(case, 0.02),
    "hinge": lambda case: HingeNumbers(judged=hinge(case)),
    "simulate": run,
    "size": lambda case: {row.component + row.quantity: row for row in size(case).checked},
}
OF_THEIR_OWN = (
    "terskih",  # the rule for the rod has the speed in rad/s
    "weight.",  # on the ground, where free fall is not similar
    "wall_s", "steps", "residual", "tolerance_difference",
)  # fmt: skip


@pytest.mark.parametrize("s", [0.125, 4.0])
@pytest.mark.parametrize("name", GIVES)
def test_every_number_follows_from_its_unit(name, s):
    # retuned for the other speed of the built-in engine, which is not similar
    own = {leaf.path: leaf for leaf in leaves(GIVES[name](without_other(similar("zotov-89", 1.0))))}
    there = {leaf.path: leaf for leaf in leaves(GIVES[name](without_other(similar("zotov-89", s))))}
    asked = [path for path in own if not any(word in path for word in OF_THEIR_OWN)]
    assert there.keys() == own.keys() and len(asked) > 5
    largest = {}
    for path in asked:
        size_of = np.abs(np.asarray(own[path].value, dtype=float)).max(initial=0.0)
        largest[own[path].unit] = max(largest.get(own[path].unit, 0.0), size_of)
    for path in asked:
        value, unit = np.asarray(own[path].value, dtype=float), own[path].unit
        times = factor(unit, s) if unit not in ("rpm", "deg") else {"rpm": 1 / s, "deg": 1.0}[unit]
        # what is left of a sum is known to a share of what was summed
        assert np.asarray(there[path].value, dtype=float) == pytest.approx(
            times * value, rel=1e-6, abs=1e-9 * times * largest[unit], nan_ok=True
        ), path


def without_other(case):
    return dataclasses.replace(
        case, sections={k: v for k, v in case.sections.items() if k not in ("retune", "codesign")}
    )


def similar_task(s):
    """The task of the built-in co-design at another size."""
    whole, case = task(), similar("zotov-89", s)
    points = [
        dataclasses.replace(
            p, omega=p.omega / s, load_torque=s**3 * p.load_torque,
            work=lambda phi, p=p: s**3 * p.work(phi), inertia=lambda phi, p=p: s**5 * p.inertia(phi),
        )
        for p in whole.points[1:5:3]
    ]  # fmt: skip
    hardware = dataclasses.replace(
        whole.hardware, spring=case.need("spring"), rho0=s * whole.hardware.rho0, radius=s * whole.hardware.radius,
        width=s * whole.hardware.width, z_margin=s * whole.hardware.z_margin,
        moving_mass=s**3 * whole.hardware.moving_mass, roller_inertia=s**5 * whole.hardware.roller_inertia,
    )  # fmt: skip
    return CoDesignTask(points=tuple(points), hardware=hardware, bounds=case.need("limits"), ripple=0.01)


@pytest.mark.parametrize("s", [1 / 16, 4.0])
def test_a_small_engine_has_the_co_design_of_a_large_one(s):
    large, small = solve(similar_task(1.0)), solve(similar_task(s))
    assert (large.status, small.status) == ("optimal", "optimal")
    assert small.flywheel == pytest.approx(s**5 * large.flywheel, rel=1e-4)
    assert small.ripple == pytest.approx(large.ripple, abs=1e-6)
    assert [a.limit for a in small.active] == [a.limit for a in large.active] != []
    for one, other in zip(small.active, large.active, strict=True):
        assert one.multiplier == pytest.approx(factor(other.price, s) * other.multiplier, rel=1e-2)


@pytest.mark.parametrize("s", [1 / 16, 4.0])
def test_other_machines_of_a_small_engine_are_those_of_a_large_one(s):
    large, small = (similar_task(size) for size in (1.0, s))
    assert cut_for_one(small, 0).flywheel == pytest.approx(s**5 * cut_for_one(large, 0).flywheel, rel=1e-5)
    for one, other in zip(peers(small.points, [0.02]), peers(large.points, [0.02]), strict=True):
        assert one.flywheel_inertia == pytest.approx(s**5 * other.flywheel_inertia, rel=1e-5), one.name

"""Margins of many guides at once: those of `judge`, gradients that are those of differences, and the same refusals."""

import dataclasses

import numpy as np
import pytest

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.hinge.balance import balance
from mechsym.hinge.guide import cut
from mechsym.hinge.kernel import design_kernel
from mechsym.hinge.limits import judge
from mechsym.hinge.torque import torque
from mechsym.jobs.machine import machine

# each kernel compiles four functions
pytestmark = pytest.mark.slow

SPRING = ("spring.p0", "spring.A", "spring.H")
COIL = {"spring.law": "coil", "spring.k": "600 kN/m", "spring.F0": "90 kN", "spring.H": "1 m"}
LOW = {"spring.p0": "0.5 bar", "spring.A": "4 m^2", "spring.H": "1.6 m", "guide.rho0": "2.5 m",
       "limits.closing_share": "0.25"}  # fmt: skip
# case, what is set, what is free
CASES = {
    "absolute": ("zotov-89", {}, (*SPRING, "spring.n", "guide.rho0", "guide.z_margin", "rollers.radius")),
    "gauge": ("zotov-142", {"spring.law": "air_gauge"}, (*SPRING, "rollers.width", "limits.closing_share")),
    "coil": ("zotov-89", COIL, ("spring.k", "spring.F0", "guide.rho0", "limits.pressure_angle")),
    # the atmosphere outside is a large part of the force
    "low pressure": ("zotov-89", LOW, (*SPRING, "spring.n")),
    "slow shaft": ("generator", {}, (*SPRING, "guide.rho0", "rollers.width")),
    "every turn": ("generator", {"guide.balance": "every_turn", "guide.shaft_ratio": "1"}, (*SPRING, "guide.rho0")),
}


@pytest.fixture(scope="module", params=CASES.values(), ids=CASES)
def setting(request):
    name, overrides, free = request.param
    case = cases.load(name, overrides)
    given = {key: case.need(key) for key in ("spring", "guide", "rollers", "limits")}
    wanted = balance(torque(machine(case)), given["guide"].balance)
    base = np.array([getattr(given[n.partition(".")[0]], n.partition(".")[2]) for n in free])
    return wanted, given, free, np.where(base > 0, base, 10.0), design_kernel(wanted, *given.values(), free)


def drawn(free, base, count):
    values = base * np.random.default_rng(5).uniform(0.6, 1.5, (count, len(base)))
    for name, low, high in (("spring.n", 1.0, 1.5), ("limits.closing_share", 0.3, 1.0)):
        if name in free:
            values[:, free.index(name)] = np.random.default_rng(6).uniform(low, high, count)
    return values


def judged(wanted, given, free, values):
    records = dict(given)
    for name, value in zip(free, values.tolist(), strict=True):
        section, _, field = name.partition(".")
        records[section] = dataclasses.replace(records[section], **{field: value})
    guide = cut(wanted, records["spring"], records["guide"])
    return guide, judge(guide, records["rollers"], records["limits"])


def compare(setting, count):
    """Largest difference of a margin; how many designs had no guide, and how many were undercut or kept."""
    wanted, given, free, base, kernel = setting
    values, worst, kinds = drawn(free, base, count), 0.0, {"none": 0, "bends": 0, "kept": 0, "failed": 0}
    for row, margins in zip(values, kernel.margins(values), strict=True):
        guide, verdict = judged(wanted, given, free, row)
        if guide.rho is None:
            kinds["none"] += 1
            assert np.all(margins == -1), guide.reason
            continue
        wanted_margins = {c.name: c.margin for c in verdict.checks}
        found = dict(zip(kernel.limits, margins.tolist(), strict=True))
        for name in wanted_margins.keys() - found.keys():  # kept or not, by themselves
            assert name in ("spring_force", "closure")
        for name, margin in found.items():
            known = wanted_margins.get(name)
            assert (known is None) == (not np.isfinite(margin)), (name, known, margin)
            worst = worst if known is None else max(worst, abs(known - margin) / max(1.0, abs(known)))
        kinds["bends"] += wanted_margins["undercut"] is not None
        kinds["kept" if verdict.feasible else "failed"] += 1
    return worst, kinds


def test_margins_are_those_of_judge(setting):
    worst, kinds = compare(setting, 25)
    assert worst < 1e-4 and kinds["kept"] + kinds["failed"] > 5


def test_margins_of_a_thousand_designs(setting):
    worst, kinds = compare(setting, 200)
    assert worst < 1e-4 and kinds["failed"] >= 10


def test_gradients_are_those_of_differences(setting):
    wanted, given, free, base, kernel = setting
    values = drawn(free, base, 40)
    margins, gradients = kernel.margins(values), kernel.gradients(values)
    seen = there = broken = 0
    for k, size in enumerate(base):
        shift = np.zeros(len(base))
        shift[k] = 1e-4 * size
        around = [kernel.margins(values + j * shift) for j in (-2, -1, 1, 2)]
        # where a limit begins to hold there is no derivative
        smooth = np.all([np.isfinite(m) & (m > -1) for m in (*around, margins)], axis=0)
        with np.errstate(invalid="ignore"):
            slope = (around[0] - 8 * around[1] + 8 * around[2] - around[3]) / (12e-4)
            slopes = np.diff([around[0], around[1], margins, around[2], around[3]], axis=0) / 1e-4
            # where another angle, or another point beside it, becomes the highest, the margin has a kink or a step
            # of 1e-8: its own slopes say so, whatever the gradient is
            bends = np.abs(np.diff(slopes, 2, axis=0)).max(axis=0) > 1e-6 * (1 + np.abs(slope))
        there += int(smooth.sum())
        broken += int((smooth & bends).sum())
        smooth &= ~bends
        difference = np.abs(slope - gradients[..., k] * size)[smooth]
        seen += int((np.abs(slope[smooth]) > 1e-6).sum())
        assert difference.max(initial=0.0) < 1e-6
    assert broken < 0.02 * there
    assert seen > 100


def test_nonsense_is_refused():
    case = cases.load("zotov-89")
    given = [case.need(key) for key in ("spring", "guide", "rollers", "limits")]
    wanted = balance(torque(machine(case)), "whole_cycle")
    for free, words in (
        (["spring.q0"], "did you mean 'spring.p0'"),
        (["spring.A"] * 2, "each of it once"),
        ([], "name"),
    ):
        with pytest.raises(BadInput, match=words):
            design_kernel(wanted, *given, free)
    with pytest.raises(BadInput, match=r"shape \(2,\); it must be \(n, 1\): spring.p0"):
        design_kernel(wanted, *given, ["spring.p0"]).margins(np.ones(2))

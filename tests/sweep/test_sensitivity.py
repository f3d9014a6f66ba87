"""Sobol indices against Ishigami's function, whose indices are known, and against scipy's."""

import math

import numpy as np
import pytest
from scipy.stats import sobol_indices

from mechsym.cases.values import Place
from mechsym.errors import BadInput
from mechsym.sweep import Plan, layout, sweep
from mechsym.sweep.axes import Axis, saltelli
from mechsym.sweep.data import estimates, indices
from mechsym.sweep.outcomes import Outcomes
from mechsym.sweep.run import Sweep

A, B = 7.0, 0.1
_V1, _V2, _V13 = (1 + B * math.pi**4 / 5) ** 2 / 2, A**2 / 8, B**2 * math.pi**8 * (1 / 18 - 1 / 50)
FIRST = np.array([_V1, _V2, 0.0]) / (_V1 + _V2 + _V13)
TOTAL = np.array([_V1 + _V13, _V2, _V13]) / (_V1 + _V2 + _V13)


def axes():
    place = Place(section="x", field="x", unit="rad", written="")
    return tuple(
        Axis(key=f"x{i}", place=place, unit="rad", suffix="", kind="even", values=(-math.pi, math.pi)) for i in range(3)
    )


def ishigami(points):
    x = np.array(points).T
    return np.sin(x[0]) + A * np.sin(x[1]) ** 2 + B * x[2] ** 4 * np.sin(x[0])


def result(count, seed, gap=None):
    points = saltelli(axes(), count, seed)
    rows = [{"speed_mean": v} for v in ishigami(points)]
    if gap is not None:
        rows[gap] = {"speed_mean": math.nan}
    return Sweep(
        case="ishigami", analysis="simulate", axes=axes(), dims={"sample": len(points)}, points=tuple(points),
        outcomes=Outcomes.of(rows), sobol=count,
    )  # fmt: skip


def test_indices_of_ishigami():
    rows = indices(result(4096, 1))
    assert [row.first for row in rows] == pytest.approx(FIRST, abs=0.02)
    assert [row.total for row in rows] == pytest.approx(TOTAL, abs=0.02)


def test_estimates_are_those_of_scipy():
    blocks = ishigami(saltelli(axes(), 256, 3)).reshape(5, 256)
    by_scipy = sobol_indices(func={"f_A": blocks[:1], "f_B": blocks[1:2], "f_AB": blocks[2:][:, None, :]}, n=256)
    first, total = estimates(blocks)
    assert first == pytest.approx(by_scipy.first_order.ravel(), abs=1e-12)
    assert total == pytest.approx(by_scipy.total_order.ravel(), abs=1e-12)


def test_intervals_hold_the_truth_as_often_as_they_say():
    rows = [indices(result(128, seed)) for seed in range(40)]
    held = [
        low <= truth <= high
        for found in rows
        for i, row in enumerate(found)
        for truth, low, high in ((FIRST[i], row.first_low, row.first_high), (TOTAL[i], row.total_low, row.total_high))
    ]
    assert np.mean(held) > 0.93


def test_a_gap_takes_its_base_sample_away():
    found, whole = indices(result(1024, 1, gap=5)), indices(result(1024, 1))
    assert {row.left_out for row in found} == {1} and {row.left_out for row in whole} == {0}
    assert [row.total for row in found] == pytest.approx([row.total for row in whole], abs=0.02)


def test_only_one_of_two_values_matters():
    """A spring that a torque step winds up: its stiffness counts, the load that is not there does not."""
    plan = Plan(
        case="nunes-slider-crank", over=("chamber.compression_ratio=9..11", "friction_pressure.A=0..0"), sobol=16
    )
    with pytest.raises(BadInput):  # an empty range is none
        layout(plan)
    plan = Plan(
        case="nunes-slider-crank", over=("chamber.compression_ratio=9..11", "parameters.I01=0.002..0.003"), sobol=16,
        show=("efficiency",),
    )  # fmt: skip
    found = sweep(plan)
    ratio, inertia = indices(found)
    assert len(found.points) == 4 * 16
    assert ratio.total == pytest.approx(1, abs=0.4) and inertia.total == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("more", [{"sobol": 100}, {"sobol": 1}, {"sobol": 64, "samples": 5}])
def test_no_power_of_two_is_refused(more):
    with pytest.raises(BadInput, match="power of two"):
        Plan(case="chmielewski", over=("k1=6000..7000",), **more)

"""Cycle maps of a sweep against cycles one by one."""

import numpy as np
import pytest

from mechsym import cases
from mechsym.cycle.engine import columns as figures
from mechsym.cycle.engine import over_speeds
from mechsym.errors import BadInput
from mechsym.jobs.cycle import engine
from mechsym.sweep import Plan, columns, failures, sweep
from mechsym.sweep import points as maps
from mechsym.sweep.outcomes import flat

ENGINE = "nunes-slider-crank"


def alone(overrides, case=ENGINE):
    found = cases.load(case, overrides)
    return flat(figures(over_speeds(engine(found), np.array([found.need("operation").speed]))))


@pytest.mark.parametrize(
    "over",
    [
        ("speed_rpm=900,3000,8000",),
        ("speed_rpm=900,8000", "cycle.ignition=-30,-5 deg"),
        ("chamber.bore=60,90 mm", "parameters.l2=70,90 mm", "pistons=1,2"),
        pytest.param(
            ("heat_transfer.a=0.1,0.6", "gas.gamma=1.25,1.4", "cycle.inlet_closes=-170,-140 deg"),
            marks=pytest.mark.slow,
        ),
        ("cycle.method=converged,nunes2017_printed", "speed_rpm=900,8000", "cycle.ignition=-20,-10 deg"),
    ],
)
def test_maps_equal_single_cycles(over):
    found = sweep(Plan(case=ENGINE, over=over))
    data = columns(found)
    assert failures(found) == {}
    for i, values in enumerate(found.points):
        units = {a.key: f"{v} {a.suffix}".strip() for a, v in zip(found.axes, values, strict=True)}
        single = alone(units)
        assert single.keys() == data.keys()
        for name, value in single.items():
            assert data[name][i] == pytest.approx(value, rel=1e-10, abs=1e-11, nan_ok=True), name


def test_impossible_points_leave_the_others_as_they_are():
    late = {"cycle.inlet_closes": "-100 deg"}
    over = ("speed_rpm=3000,8000", "cycle.ignition=-200,-110,-60,-20 deg")
    found = sweep(Plan(case=ENGINE, over=over, overrides=late))
    data, reasons = columns(found), failures(found)
    assert list(reasons) == [0, 1, 4, 5]
    assert "possible is at least" in reasons[0]  # of the case, the next one of the cycle
    assert "ignition is before the inlet closes: -11" in reasons[1] and "at 8000 rpm" in reasons[5]
    for i in (2, 3, 6, 7):
        speed, ignition = found.points[i]
        single = alone({**late, "speed_rpm": speed, "cycle.ignition": f"{ignition} deg"})
        assert [data[n][i] for n in ("torque_avg", "p_max_mpa")] == [single["torque_avg"], single["p_max_mpa"]]
    for i in reasons:
        speed, ignition = found.points[i]
        with pytest.raises(BadInput):
            alone({**late, "speed_rpm": speed, "cycle.ignition": f"{ignition} deg"})


def test_a_map_that_is_refused_is_cut_into_halves():
    # the ends of a family may be good values apart and no engine together: then each is tried alone
    found = sweep(Plan(case=ENGINE, over=("cycle.inlet_closes=-170..-20 deg:4", "cycle.exhaust_opens=130,170 deg")))
    single = alone({"cycle.inlet_closes": "-170 deg", "cycle.exhaust_opens": "130 deg"})
    assert columns(found)["torque_avg"][0] == pytest.approx(single["torque_avg"], rel=1e-10)
    assert all("ignition" in reason for reason in failures(found).values())


def test_speeds_are_one_map(monkeypatch):
    calls = []
    original = maps.map_of
    monkeypatch.setattr(maps, "map_of", lambda family: calls.append(len(family)) or original(family))
    sweep(Plan(case=ENGINE, over=("speed_rpm=1000..8000:40",)))
    assert calls == [40]


@pytest.mark.slow
def test_a_law_fitted_around_the_speed_is_fitted_anew():
    over = ("speed_rpm=3000,4000",)
    found = sweep(Plan(case=ENGINE, over=over, overrides={"friction_pressure.law": "mechanism"}))
    for i, speed in enumerate((3000, 4000)):
        single = alone({"friction_pressure.law": "mechanism", "speed_rpm": speed})
        assert columns(found)["friction_mep_kpa"][i] == pytest.approx(single["friction_mep_kpa"], rel=1e-12)

"""Sweeps of cycles and hinges, and of a case of one's own."""

import dataclasses

import numpy as np
import pytest

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.sweep import Gap, Plan, columns, failures, sweep

SHORT = {"simulation.t_end": "3", "simulation.window": "1"}
ENGINE = "nunes-slider-crank"


@pytest.mark.parametrize("case, kind", [("balandin", "map"), ("moroianu", "single"), ("zotov-89", "single")])
def test_every_engine_has_its_cycle(case, kind):
    found = sweep(Plan(case=case, over=("speed_rpm=80,85",), analysis="cycle"))
    power = columns(found)["power_kw"]
    assert failures(found) == {} and power[1] > power[0] > 0
    assert kind == ("map" if "SparkIgnition" in repr(cases.load(case).need("cycle")) else "single")


def test_a_file_of_ones_own(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(cases.text("chmielewski").replace('"100 s"', '"3 s"').replace('"2 s"', '"1 s"'), encoding="utf-8")
    found = sweep(Plan(case=str(file), over=("c1=0,1",)))
    assert (found.case, columns(found)["t_end"].tolist()) == ("mine", [3, 3])


def test_hinges_over_the_spring():
    found = sweep(Plan(case="zotov-89", over=("spring.p0=1,8 MPa",)))
    assert found.analysis == "hinge"
    data = columns(found)
    # an infeasible design is a result with a reason, not a gap
    assert failures(found) == {}
    assert (data["guide.feasible"].tolist(), data["guide.margin"] > 0) == ([0, 1], pytest.approx([False, True]))
    assert all(data["guide.reason"]) and data["guide.reason"][0] != data["guide.reason"][1]
    # a stiffer spring needs less stroke for the same work
    assert data["guide.z_max"][1] < data["guide.z_max"][0]


def test_a_hinge_is_not_run_unless_a_name_asks_for_it(monkeypatch):
    plan = Plan(case="zotov-89", over=("spring.p0=5,8 MPa",))
    usual = columns(sweep(plan))
    for place in ("trials.run", "steady.with_guide", "result.price", "steady.beside_faulty"):
        monkeypatch.setattr(f"mechsym.hinge.{place}", lambda *_, **__: pytest.fail("ran"))
    again = columns(sweep(plan))
    np.testing.assert_equal(again, usual)
    some = columns(sweep(dataclasses.replace(plan, show=("guide.z_max", "speed_rpm"))))
    assert {n: v.tolist() for n, v in some.items()} == {n: usual[n].tolist() for n in ("speed_rpm", "guide.z_max")}
    assert list(columns(sweep(dataclasses.replace(plan, show=("guide",))))) == [n for n in usual if "guide." in n]
    with pytest.raises(pytest.fail.Exception, match="ran"):
        sweep(dataclasses.replace(plan, show=("check.speed_ripple",)))


def test_a_hinge_that_is_shown_is_run():
    found = sweep(Plan(case="zotov-89", over=("spring.p0=8 MPa",), show=("check.speed_ripple",)))
    assert list(columns(found)) == ["check.speed_ripple"] and 0 < columns(found)["check.speed_ripple"][0] < 1e-9


def test_what_a_hinge_has_not_is_refused_before_it_is_designed():
    with pytest.raises(BadInput, match="--show retuned.p0 is no result here; did you mean 'retune'"):
        sweep(Plan(case="zotov-89", over=("spring.p0=5,8 MPa",), show=("retuned.p0",)))


@pytest.mark.slow
def test_hinges_are_those_of_single_designs():
    from mechsym.hinge.summary import HingeNumbers
    from mechsym.jobs import hinge as design
    from mechsym.quantities.results import tell

    show = ("check.speed_ripple", "hinge_torque_max", "flywheel_inertia_saved", "guide", "losses.total", "retune.p0")
    found = sweep(Plan(case="zotov-89", over=("spring.p0=5,8 MPa", "speed_rpm=80,89"), show=show))
    data = columns(found)
    assert np.all(data["check.speed_ripple"] < 1e-6)
    for i, (p0, speed) in enumerate(found.points):
        single = design(cases.load("zotov-89", {"spring.p0": f"{p0} MPa", "speed_rpm": speed}))
        alone = tell(HingeNumbers(judged=single))
        for name in ("hinge_torque_max", "flywheel_inertia_saved"):
            assert data[name][i] == pytest.approx(alone[name], rel=1e-9)
        assert data["guide.margin"][i] == pytest.approx(alone["guide"]["margin"], rel=1e-9)
        assert data["losses.total"][i] == alone["losses"]["total"]
        assert data["retune.p0"][i] == alone["retune"]["p0"]


def test_simulated_hinges_share_their_engine():
    overrides = {"simulation.turns": "3"}
    plan = Plan(case="zotov-89", over=("spring.p0=4,5 MPa", "simulation.hinge=designed,none"), overrides=overrides,
                analysis="simulate")  # fmt: skip
    found = sweep(plan)
    speeds = columns(found)["speed_max"] - columns(found)["speed_min"]
    assert failures(found) == {}
    assert speeds[0] < 1e-6 and speeds[2] < 1e-6 and speeds[1] > 1
    # without hinge the shaft stops, which is an event and no failure
    assert columns(found)["end"].tolist()[0] == "turns" and columns(found)["end"][1] == columns(found)["end"][3]
    assert isinstance(found.outcomes[0], dict) and not isinstance(found.outcomes[1], Gap)

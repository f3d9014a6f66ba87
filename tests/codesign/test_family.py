"""Speeds and loads of a family, and its cycle between two loads, by hand."""

import dataclasses
import math

import pytest

from mechsym import cases
from mechsym.codesign.machines import cycle_at, places, scavenge_pressure
from mechsym.codesign.settings import CoDesignSettings
from mechsym.errors import BadInput

RPM = math.pi / 30


def settings(**changes):
    given = {"speeds": (60 * RPM, 90 * RPM), "full_speed": 120 * RPM, "full_load": 20e5, "scavenge": ""}
    return CoDesignSettings(**given | changes)


def test_loads_go_with_the_square_of_the_speed_on_a_propeller():
    found = places(settings(loads=(1.0, 0.5)))
    assert [p.omega for p in found] == pytest.approx([60 * RPM, 60 * RPM, 90 * RPM, 90 * RPM])
    assert [p.mep for p in found] == pytest.approx([5e5, 2.5e5, 11.25e5, 5.625e5])
    found = places(settings(curve="constant_speed", loads=(0.3, 1.0)))
    assert [p.mep for p in found] == pytest.approx([6e5, 20e5, 6e5, 20e5])


def test_points_of_a_file_have_its_units(tmp_path):
    file = tmp_path / "p.csv"
    file.write_text("speed [rpm], load [bar], weight\n60, 5, 2\n90, 11, 0.5\n")
    found = places(settings(curve=str(file)))
    assert [(p.omega, p.mep, p.weight) for p in found] == [
        (pytest.approx(60 * RPM), pytest.approx(5e5), 2.0), (pytest.approx(90 * RPM), pytest.approx(11e5), 0.5)
    ]  # fmt: skip
    file.write_text("speed [rpm], load [bar]\n60, 5, 2\n")
    with pytest.raises(BadInput, match="line 2: 3 values below 2"):
        places(settings(curve=str(file)))
    file.write_text("speed [rpm], torque [N]\n60, 5\n")
    with pytest.raises(BadInput, match="the headings are"):
        places(settings(curve=str(file)))
    file.write_text("speed [rpm], load [bar]\n" + "60, 5\n" * 101)
    with pytest.raises(BadInput, match="101 points"):
        places(settings(curve=str(file)))


@pytest.mark.parametrize("text, bar", [
    ("p_s = max(1.05, 1.6 + (mep-8)/6) bar", 1.6), ("max(1.05, 1.6 + (mep-8)/6 - 1)", 1.05),
    ("-mep + 2*mep**1.5/4 bar", 8**1.5 / 2 - 8), ("min(mep, 3) bar", 3.0), ("max(mep)", 8.0),
])  # fmt: skip
def test_a_scavenge_pressure_is_what_its_text_says(text, bar):
    assert scavenge_pressure(text, 8e5) == pytest.approx(1e5 * bar, rel=1e-12)


@pytest.mark.parametrize("text, why", [
    ("mep**11", "small powers"), ("mep % 2", "small powers"), ("sin(mep)", "numbers, mep"), ("True", "numbers, mep"),
    ("mep/0", "cannot be read"), ("mep - 8", "must be > 0"), ("mep - 9", "gives -1 bar at mep = 8 bar"),
    ("", "cannot be read"),
])  # fmt: skip
def test_a_scavenge_pressure_that_is_none_is_refused(text, why):
    with pytest.raises(BadInput, match=why):
        scavenge_pressure(text, 8e5)


def test_combustion_is_linear_between_two_loads_and_constant_outside():
    low, high = (cases.load(name).need("cycle") for name in ("zotov-89", "zotov-142"))
    want = settings(scavenge="1.6 + (mep-8)/6")
    half = cycle_at(low, high, want, 14e5)
    assert half.mean_indicated_pressure == 14e5 and half.p_s == pytest.approx(2.6e5)
    for name in ("a_p", "m_p", "a_d", "m_d", "b"):
        assert getattr(half, name) == pytest.approx((getattr(low, name) + getattr(high, name)) / 2, rel=1e-12)
        assert getattr(cycle_at(low, high, want, 17e5), name) == pytest.approx(
            0.25 * getattr(low, name) + 0.75 * getattr(high, name), rel=1e-12
        )
        assert getattr(cycle_at(low, high, want, 5e5), name) == getattr(low, name)
        assert getattr(cycle_at(low, high, want, 25e5), name) == getattr(high, name)
    assert cycle_at(low, None, want, 14e5).a_p == low.a_p
    assert cycle_at(low, low, want, 14e5).a_p == low.a_p
    assert cycle_at(low, high, settings(), 14e5).p_s == low.p_s


def test_a_cycle_of_one_load_has_no_other():
    cycle = cases.load("nunes-hypocycloid").need("cycle")
    assert cycle_at(cycle, None, settings(), 20e5) is cycle
    with pytest.raises(BadInput, match="it has one load"):
        cycle_at(cycle, None, settings(), 19e5)
    assert dataclasses.is_dataclass(cycle)

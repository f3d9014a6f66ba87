"""More load never gives a smaller part; a rule refuses what it was not made for."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mechsym.errors import BadInput
from mechsym.quantities import parse
from mechsym.sizing import loads
from mechsym.sizing.checks import round_up
from mechsym.sizing.rules import bearings, crankshaft, gears, masses, piston, turning_shaft
from mechsym.sizing.rules.gear_geometry import Pair

# part size or stress as a function of one load
GROWING = {
    "head, strength": lambda x: piston.head_thickness_strength(x * 1e6, 0.06, 60e6),
    "head, heat": lambda x: piston.head_thickness_heat(x * 100, 134.0, 75.0),
    "rod": lambda x: piston.rod_diameter(x * 1e3, 50e6),
    "wall": lambda x: piston.wall_thickness(x * 1e6, 0.06, 52.5e6, 0.002),
    "bolts": lambda x: piston.core_diameter(x * 1e6, 0.06, 5, 70e6),
    "thread": lambda x: piston.thread_for(piston.core_diameter(x * 1e6, 0.06, 5, 70e6)),
    "crankpin": lambda x: crankshaft.crankpin_diameter(x * 1e3, 0.043, 450e6),
    "web": lambda x: crankshaft.web_stress(x * 1e3, 0.043, 0.034, 0.015, 0.04),
    "shaft": lambda x: crankshaft.shaft_diameter(x, 800e6),
    "shaft, fatigue": lambda x: turning_shaft.shaft_diameter_goodman((x, x, x, x), 5e8, 2e9, 1.5),
    "gear, bending": lambda x: gears.face_width_bending(x * 1e3, 1e-3, 0.4, 450e6, gears.LoadFactors()),
    "gear, contact": lambda x: gears.face_width_contact(x * 1e3, 0.026, 0.13, 187030, 1.3e9, gears.LoadFactors()),
    "bearing": lambda x: bearings.required_rating(x * 1e3, 1e8, "roller"),
}


@pytest.mark.parametrize("name", GROWING)
@given(low=st.floats(0.01, 10), more=st.floats(0, 10))
def test_more_load_never_gives_a_smaller_part(name, low, more):
    assert GROWING[name](low + more) >= GROWING[name](low)


@given(F=st.floats(100, 1e5), more=st.floats(1, 3), kind=st.sampled_from(["ball", "roller", "drawn-cup"]))
def test_more_load_never_gives_a_longer_life(F, more, kind):
    assert bearings.life_revolutions(2e4, F * more, kind) <= bearings.life_revolutions(2e4, F, kind)


@given(b=st.floats(0.001, 0.05), more=st.floats(0, 0.002))
def test_load_distribution_grows_with_the_face_width(b, more):
    factor = [gears.load_distribution_factor(x, 0.026, 1.1, "precision") for x in (b, b + more)]
    # AGMA's two branches meet at 25 mm with a step of 0.0002
    assert factor[1] >= factor[0] - 3e-4


@given(size=st.floats(1e-4, 0.3), step=st.sampled_from([0.25e-3, 0.5e-3, 1e-3]))
def test_rounding_never_makes_a_part_smaller(size, step):
    made = round_up(size, step)
    assert size - 1e-12 <= made < size + step * (1 + 1e-6)


@given(W=st.lists(st.floats(-1e4, 1e4), min_size=8, max_size=8))
def test_reversal_lies_between_one_sided_and_full(W):
    W = np.array([W])
    found = loads.reversed_tooth_load(W, 4)[0]
    assert np.abs(W).max() <= found + 1e-9 <= np.abs(W).max() / 0.7 + 1e-6


@given(F_max=st.floats(1, 1e5), share=st.floats(0, 1))
def test_reversal_factor_and_equivalent_load_agree(F_max, share):
    W = np.array([[F_max, -share * F_max]])
    factor = 1 / (1 + 3 / 7 * share)  # Y_M of ISO 6336-3, annex B with M = 0.4: 0.7 for load that reverses fully
    assert loads.reversed_tooth_load(W, 2)[0] == pytest.approx(F_max / factor, rel=1e-9)


REFUSED = {
    "negative pressure": lambda: piston.head_thickness_strength(-1.0, 0.06, 60e6),
    "ring outside its range": lambda: piston.ring_radial_thickness(0.06, 1e6, 100e6),
    "thick wall": lambda: piston.hoop_stress(1e6, 0.06, 0.02),
    "bolts beyond the list": lambda: piston.thread_for(0.1),
    "thread not made": lambda: piston.root_diameter(11),
    "load beyond the bearings": lambda: crankshaft.bearing_reaction(1.0, 0.1, 0.086),
    "lever inside the web": lambda: crankshaft.web_stress(1.0, 0.01, 0.034, 0.015, 0.04),
    "soft steel": lambda: turning_shaft.endurance_limit(50e6, 0.02, "ground"),
    "surface not known": lambda: turning_shaft.endurance_limit(1e9, 0.02, "polished"),
    "sharp fillet": lambda: turning_shaft.fillet_factor_bending(1e-5, 0.02, 0.03),
    "no shoulder": lambda: turning_shaft.fillet_factor_torsion(1e-3, 0.02, 0.02),
    "grade": lambda: gears.dynamic_factor(5.0, 13.0),
    "too fast for the grade": lambda: gears.dynamic_factor(60.0, 6.0),
    "wide face": lambda: gears.load_distribution_factor(0.06, 0.026, 1.1, "open"),
    "enclosure": lambda: gears.mesh_alignment_factor(0.03, "closed"),
    "few cycles": lambda: gears.life_factor_bending(10.0),
    "reliability": lambda: gears.reliability_factor(0.99999),
    "thin rim": lambda: gears.rim_factor(1e-3, 2.35e-3),
    "bearing kind by reliability": lambda: bearings.life_revolutions(1e4, 1e3, "ball", 0.999),
    "too many bearings": lambda: bearings.set_rating(1e4, 20, "ball"),
    "short rod": lambda: piston.rod_length(0.05, 0.013, 0.011, 0.014, 0.032),
    "web of circles inside each other": lambda: masses.web_outline(0.05, 0.015, 0.013),
    "half a tooth": lambda: Pair(kind="external", module=1e-3, teeth_1=20.5, teeth_2=40, pressure_angle=0.35),
    "ring smaller than pinion": lambda: Pair(
        kind="internal", module=1e-3, teeth_1=52, teeth_2=26, pressure_angle=0.35
    ),
    "not a number": lambda: piston.rod_diameter(float("nan"), 50e6),
    "wrong unit": lambda: parse("5 MPa", "m", "face"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_input_outside_validity_is_refused(name):
    with pytest.raises(BadInput):
        REFUSED[name]()

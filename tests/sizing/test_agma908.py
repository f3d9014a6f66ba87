"""The tables of AGMA 908 in the source's annex against the formulas of the same standard, and its table 4.8."""

import numpy as np
import pytest

from mechsym.errors import BadInput
from mechsym.papers.nunes2017.chapter4 import GEOMETRY
from mechsym.sizing.rules.gear_bending import bending_geometry_factor, interpolated, table
from mechsym.sizing.rules.gear_geometry import Pair, contact_ratio, pitting_geometry_factor, top_land, undercut_shift

ANGLE = np.radians(25)


def pair(line, kind="external"):
    return Pair(kind=kind, module=1e-3, teeth_1=line["teeth_pinion"], teeth_2=line["teeth_gear"],
                pressure_angle=ANGLE, shift=line["shift_pinion"])  # fmt: skip


LINES = [line for line in table() if line["I"] is not None]


def test_every_legible_pitting_factor_is_the_formula_to_the_printed_digit():
    off = [abs(pitting_geometry_factor(pair(line)) - line["I"]) for line in LINES]
    assert len(off) == 79 and max(off) <= 0.0005


def test_bending_factors_are_the_formula_to_the_printed_digit_or_just_beyond():
    off = np.array([[abs(bending_geometry_factor(pair(line), m) - line[key])
                     for m, key in ((1, "J_pinion"), (2, "J_gear"))] for line in LINES])  # fmt: skip
    assert off.size == 158
    assert np.count_nonzero(off <= 0.005) == 147 and off.max() < 0.007


def test_marked_pairs_are_undercut_or_pointed():
    for line in table():
        if line["reading"] == "undercut":
            assert line["teeth_pinion"] == 12 and undercut_shift(pair(line)) > 0
        elif line["reading"] == "pointed":
            assert top_land(pair(line)) < 0.3


def test_restored_entries_are_few_and_named():
    restored = [line["reading"] for line in LINES if line["reading"] != "clear"]
    assert len(restored) == 10 and all("restored" in text for text in restored)


@pytest.mark.parametrize(("shift", "teeth"), GEOMETRY)
def test_table_4_8(shift, teeth):
    for name, text in zip(("I", "J_pinion", "J_gear"), GEOMETRY[shift, teeth], strict=True):
        assert abs(interpolated(name, shift, teeth, 2 * teeth) - float(text)) < 1e-4


@pytest.mark.parametrize(("shift", "teeth"), [(0.1, (26, 52)), (0.0, (11, 52)), (0.0, (26, 140)), (0.5, (15, 30))])
def test_interpolation_is_refused_outside_the_table(shift, teeth):
    with pytest.raises(BadInput):
        interpolated("I", shift, *teeth)


def test_internal_pair_of_great_ring_is_a_rack_as_the_external_one():
    """With a ring or gear of very many teeth both become the same rack."""
    many = {"module": 1e-3, "teeth_1": 26, "teeth_2": 1e6, "pressure_angle": ANGLE}
    inside, outside = (Pair(kind=kind, **many) for kind in ("internal", "external"))
    assert contact_ratio(inside) == pytest.approx(contact_ratio(outside), rel=1e-4)
    assert pitting_geometry_factor(inside) == pytest.approx(pitting_geometry_factor(outside), rel=1e-4)


def test_contact_stress_of_agma_is_the_hertz_pressure_at_its_point():
    """Z_E and I are nothing but Hertz's line contact of the two flanks (all factors 1)."""
    from mechsym.sizing.rules.gear_geometry import action_line
    from mechsym.sizing.rules.gears import LoadFactors, elastic_coefficient, face_width_contact

    inside = Pair(kind="internal", module=2e-3, teeth_1=26, teeth_2=52, pressure_angle=ANGLE, shift=0.25)
    _, end, pitch = action_line(inside)
    rho_1 = (end - pitch) * inside.module
    rho_2 = rho_1 + 13 * inside.module * np.sin(ANGLE)
    W, b = 5000.0, 0.03
    modulus = 1 / ((1 - 0.3**2) / 200e9 + (1 - 0.28**2) / 210e9)
    hertz = np.sqrt(W / np.cos(ANGLE) * modulus / (np.pi * b) * (1 / rho_1 - 1 / rho_2))
    Z_E = elastic_coefficient(200e9, 0.3, 210e9, 0.28)
    agma = np.sqrt(face_width_contact(W, 52e-3, pitting_geometry_factor(inside), Z_E, 1.0, LoadFactors()) / b)
    assert agma == pytest.approx(hertz, rel=1e-12)

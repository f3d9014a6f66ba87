"""Chapter 4 and section 6.1 of the thesis, number by number."""

import pytest

from mechsym.papers.nunes2017.sizing import rows


@pytest.fixture(scope="module")
def found():
    return {row.item: row.told("") for row in rows()}


def test_all_48_face_widths_to_the_printed_digit(found):
    widths = [row for item, row in found.items() if item.startswith("table 4.1") and "face width" in item]
    assert len(widths) == 48
    assert all(row["verdict"] == "reproduced with the source's slip" for row in widths)
    off = [row["computed"] - float(row["published"]) for row in widths]
    assert sum(abs(x) <= 0.0055 for x in off) == 45
    assert all(0 <= x < 0.01 for x in off if abs(x) > 0.0055)  # three are truncated in print


def test_the_18_geometry_factors(found):
    factors = [row for item, row in found.items() if item.startswith("table 4.8")]
    assert len(factors) == 18 and all(row["verdict"] == "reproduced" for row in factors)


def test_corrected_widths_differ(found):
    widths = [row for item, row in found.items() if "face width, contact" in item]
    assert all(row["corrected"] < 0.5 * row["computed"] for row in widths if "pinion" in row["item"])


def test_what_is_not_reproduced_is_named(found):
    missing = {item for item, row in found.items() if row["verdict"] == "not reproduced"}
    assert len(missing) == 5
    for text in ("output shaft", "0.75 of the flange", "moving mass", "342 ksi", "the chosen pair"):
        assert any(text in item for item in missing), text


@pytest.mark.parametrize(("item", "corrected"), [
    ("distance of the heads at TDC [mm]", 11.56), ("length of the cylinder [mm]", 179.76),
    ("length of the rod [mm]", 83.47), ("diameter of the crankpin [mm]", 23.56), ("stress of the web [MPa]", 186.1),
    ("dynamic rating of two HK 2516 [kN]", 25.89), ("K_m, gear", 1.2537), ("K_v, pinion, 8000 rpm", 1.1438),
])  # fmt: skip
def test_corrections(found, item, corrected):
    assert found[item]["corrected"] == pytest.approx(corrected, rel=5e-4)


def test_mass_of_the_crankshaft_belongs_to_lean_webs(found):
    row = found["mass of the crankshaft [g]"]
    assert abs(row["computed"] - 415.9) < 0.055

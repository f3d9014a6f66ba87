"""Materials and bearings as data: the built-in ones, and those of a user's file."""

import pytest

from mechsym.errors import BadInput
from mechsym.sizing.parts.bearing_design import Choice, choices, mass, seat_diameter
from mechsym.sizing.rules import bearing_data, materials


def test_the_sources_materials_are_there():
    found = materials.load()
    assert {"nitralloy-n", "ferrium-s53", "al-242-t571", "al-319-t6", "al-a390-t6", "maraging-350"} == set(found)
    assert found["al-242-t571"].hot_ultimate == 90e6 and found["al-242-t571"].hot_temperature == 533.15


def test_a_users_material_is_added_and_may_replace(tmp_path):
    file = tmp_path / "more.toml"
    file.write_text('[steel]\nultimate = "900 MPa"\nyoungs_modulus = "210 GPa"\npoisson = 0.3\ndensity = 7850\n')
    found = materials.load(file)
    assert found["steel"].ultimate == 900e6 and "ferrium-s53" in found


@pytest.mark.parametrize("text", [
    "ultimate = 5", "[steel]\nultimate = 900e6", '[steel]\nultimate = "900 mm"', "[steel]\nhardness = 3", "[steel",
    '[steel]\nultimate = -1\nyoungs_modulus = 2e11\npoisson = 0.3\ndensity = 7850',
])  # fmt: skip
def test_bad_materials_name_file_and_key(tmp_path, text):
    file = tmp_path / "bad.toml"
    file.write_text(text)
    with pytest.raises(BadInput, match="bad.toml|steel"):
        materials.load(file)


def test_unknown_and_missing_are_refused():
    found = materials.load()
    with pytest.raises(BadInput, match="did you mean 'ferrium-s53'"):
        materials.get(found, "ferium-s53")
    with pytest.raises(BadInput, match="no conductivity"):
        materials.need(found["nitralloy-n"], "conductivity")


def test_the_sources_bearings_are_there():
    found = bearing_data.catalogue()
    assert (found["6013 M"].C, found["6013 M"].C0, found["6013 M"].mass) == (31900, 25000, 0.44)
    assert found["HN 1516"].limiting == pytest.approx(15000 * 3.141592653589793 / 30)


def test_a_users_bearing_is_added(tmp_path):
    file = tmp_path / "more.csv"
    file.write_text("designation,kind,bore_mm,outside_mm,width_mm,C_N,C0_N,limiting_rpm,mass_kg,source\n"
                    "X 1,ball,10,30,9,5100,2390,30000,0.03,test\n")  # fmt: skip
    assert bearing_data.catalogue(file)["X 1"].bore == pytest.approx(0.010)


@pytest.mark.parametrize("line", ["X,ball,30,10,9,1,1,1,1,t", "X,plain,10,30,9,1,1,1,1,t", "X,ball,10,30,9,-1,1,1,1,t"])
def test_bad_bearings_are_refused(tmp_path, line):
    file = tmp_path / "bad.csv"
    file.write_text(f"designation,kind,bore_mm,outside_mm,width_mm,C_N,C0_N,limiting_rpm,mass_kg,source\n{line}\n")
    with pytest.raises(BadInput, match="bad.csv"):
        bearing_data.catalogue(file)


def test_an_unknown_column_is_refused(tmp_path):
    file = tmp_path / "bad.csv"
    file.write_text("designation,kind,bore_inch\nX,ball,1\n")
    with pytest.raises(BadInput, match="bore_inch"):
        bearing_data.catalogue(file)


def test_without_inner_ring_the_shaft_is_thicker_and_the_bearing_lighter():
    bearing = bearing_data.catalogue()["NJ 202 ECP"]
    with_ring, without = Choice(bearing=bearing), Choice(bearing=bearing, ring_off=True)
    assert seat_diameter(with_ring) == pytest.approx(0.015) and seat_diameter(without) == pytest.approx(0.0193)
    assert 0 < mass(without) < mass(with_ring) == bearing.mass


def test_choices_fit_and_come_by_mass():
    found = choices(bearing_data.catalogue().values(), (0.015, 0.025), 0.035)
    assert found and all(c.bearing.outside <= 0.035 and 0.015 <= seat_diameter(c) <= 0.025 for c in found)
    assert [mass(c) for c in found] == sorted(mass(c) for c in found)

"""Materials and bearings as data: the built-in ones, and those of a user's file."""

import math

import pytest

from mechsym.errors import BadInput
from mechsym.sizing.bearing_design import Choice, choices, mass, seat_diameter
from mechsym.sizing.rules import bearings, materials


def test_the_sources_materials_are_there():
    found = materials.load()
    assert {"nitralloy-n", "ferrium-s53", "al-242-t571", "al-319-t6", "al-a390-t6", "maraging-350"} == set(found)
    assert found["al-242-t571"].hot_ultimate == 90e6 and found["al-242-t571"].hot_temperature == 533.15


# tables 4.1 to 4.5 and chapter 6.1 of Nunes (2017), copied once more: ultimate, yield, shear, fatigue, hot [MPa],
# allowed bending and contact [MPa], E [GPa], Poisson, density [g/cm3], conductivity [W/m/K]
TABLES = {
    "nitralloy-n": (1310, 1240, None, None, None, 454.7125, 1300, 200, 0.3, 6.675, None),
    "ferrium-s53": (1985, 1565, 1250, None, None, None, None, 204, 0.3, 7.98, None),
    "al-242-t571": (220, 207, None, 75, 90, None, None, 71, 0.33, 2.823, 134),
    "al-319-t6": (250, 165, None, 75, None, None, None, 74, 0.33, 2.79, 109),
    "al-a390-t6": (275, 275, None, 105, None, None, None, 81.2, 0.33, 2.73, 134),
    "maraging-350": (2340, None, None, None, None, 702, 2340, 200, 0.3, 8.0, None),
}
FIELDS = ("ultimate", "yield_strength", "ultimate_shear", "fatigue", "hot_ultimate", "gear_bending", "gear_contact",
          "youngs_modulus", "poisson", "density", "conductivity")  # fmt: skip
UNITS = dict.fromkeys(FIELDS, 1e6) | {"youngs_modulus": 1e9, "poisson": 1.0, "density": 1e3, "conductivity": 1.0}


@pytest.mark.parametrize("key", TABLES)
def test_every_datum_of_a_material_is_the_table_s(key):
    found = materials.load()[key]
    for name, value in zip(FIELDS, TABLES[key], strict=True):
        if value is None:
            assert getattr(found, name) is None, name
        else:
            assert getattr(found, name) == pytest.approx(value * UNITS[name], rel=1e-12), name
    assert set(materials.load()) == set(TABLES)


@pytest.mark.parametrize("reliability", [0.90, 0.95, 0.96, 0.97, 0.98, 0.99])
def test_life_factors_are_those_of_iso_281(reliability):
    # ISO 281:2007, table 12: a Weibull distribution of slope 1.5 with a twentieth of the life that all bearings reach
    a_1 = bearings.life_revolutions(10e3, 10e3, "ball", reliability) / 1e6
    assert a_1 == round(0.95 * (math.log(1 / reliability) / math.log(1 / 0.9)) ** (2 / 3) + 0.05, 2)


@pytest.mark.parametrize(("kind", "life", "rating"), [("ball", 3.0, 0.7), ("roller", 10 / 3, 7 / 9),
                                                      ("drawn-cup", 10 / 3, 7 / 9)])  # fmt: skip
def test_exponents_are_those_of_iso_281(kind, life, rating):
    assert bearings.life_revolutions(20e3, 10e3, kind) == pytest.approx(1e6 * 2**life)
    assert bearings.set_rating(1.0, 3, kind) == pytest.approx(3**rating)


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
    found = bearings.catalogue()
    assert (found["6013 M"].C, found["6013 M"].C0, found["6013 M"].mass) == (31900, 25000, 0.44)
    assert found["HN 1516"].limiting == pytest.approx(15000 * 3.141592653589793 / 30)


def test_a_users_bearing_is_added(tmp_path):
    file = tmp_path / "more.csv"
    file.write_text("designation,kind,bore_mm,outside_mm,width_mm,C_N,C0_N,limiting_rpm,mass_kg,source\n"
                    "X 1,ball,10,30,9,5100,2390,30000,0.03,test\n")  # fmt: skip
    assert bearings.catalogue(file)["X 1"].bore == pytest.approx(0.010)


@pytest.mark.parametrize("line", ["X,ball,30,10,9,1,1,1,1,t", "X,plain,10,30,9,1,1,1,1,t", "X,ball,10,30,9,-1,1,1,1,t"])
def test_bad_bearings_are_refused(tmp_path, line):
    file = tmp_path / "bad.csv"
    file.write_text(f"designation,kind,bore_mm,outside_mm,width_mm,C_N,C0_N,limiting_rpm,mass_kg,source\n{line}\n")
    with pytest.raises(BadInput, match="bad.csv"):
        bearings.catalogue(file)


def test_an_unknown_column_is_refused(tmp_path):
    file = tmp_path / "bad.csv"
    file.write_text("designation,kind,bore_inch\nX,ball,1\n")
    with pytest.raises(BadInput, match="bore_inch"):
        bearings.catalogue(file)


def test_without_inner_ring_the_shaft_is_thicker_and_the_bearing_lighter():
    bearing = bearings.catalogue()["NJ 202 ECP"]
    with_ring, without = Choice(bearing=bearing), Choice(bearing=bearing, ring_off=True)
    assert seat_diameter(with_ring) == pytest.approx(0.015) and seat_diameter(without) == pytest.approx(0.0193)
    assert 0 < mass(without) < mass(with_ring) == bearing.mass


def test_choices_fit_and_come_by_mass():
    found = choices(bearings.catalogue().values(), (0.015, 0.025), 0.035)
    assert found and all(c.bearing.outside <= 0.035 and 0.015 <= seat_diameter(c) <= 0.025 for c in found)
    assert [mass(c) for c in found] == sorted(mass(c) for c in found)

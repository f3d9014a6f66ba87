"""Numbers for people: units, digits, no round-off; what the user asks for; typed units."""

import math
from itertools import pairwise

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st
from tables import read_table

from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.files import write_quantities
from mechsym.quantities import parse
from mechsym.quantities.display import choose, column_text, figure, heading, quantity_text, ratio_text, shown_in
from mechsym.quantities.results import Columns


@pytest.fixture(autouse=True)
def usual():
    yield
    choose(None)


@pytest.mark.parametrize(("value", "unit", "text"), [
    (1.65511e7, "Pa", "16.551 MPa"), (0.0129, "m", "12.9 mm"), (9000.0, "N*m", "9 kN*m"), (37.2, "N*m", "37.2 N*m"),
    (math.pi, "rad", "180 deg"), (2 * math.pi, "rad/s", "60 rpm"), (0.5, "-", "0.5"), (None, "N", "-"),
])  # fmt: skip
def test_usual_units(value, unit, text):
    assert quantity_text(value, unit) == text


def test_units_that_are_asked_for():
    choose("bar, lbf, N*m, rad")
    assert quantity_text(1e5, "Pa") == "1 bar" and quantity_text(9000.0, "N*m") == "9000 N*m"
    assert quantity_text(65591.0, "J") == "65.591 kJ"  # an energy is no torque
    assert heading("p_max_mpa", [1.0], asked=True) == ("p_max [bar]", [10.0])
    for wrong in ("mm, inch", "parsec"):
        with pytest.raises(BadInput):
            choose(wrong)


@given(st.floats(1e-4, 1e7, exclude_max=True), st.sampled_from([1, -1]))
def test_figures_keep_their_digits(value, sign):
    text = figure(sign * value)
    assert "e" not in text or abs(float(text)) >= 1e7
    assert float(text) == pytest.approx(sign * value, rel=5e-5)


@pytest.mark.parametrize(("value", "told"), [
    (7.1e-12, "0"), (-2e-16, "0"), (0.0, "0"), (-1.0001e-9, "below 1e-8"), (4.9e-9, "below 1e-8"),
    (9.9e-7, "below 1e-6"),
])  # fmt: skip
def test_round_off_is_no_result(value, told):
    assert ratio_text(value) == told and abs(value) < float(told.removeprefix("below ")) + (told == "0") * 1e-9
    assert ratio_text(1e-6) == "1e-06"


def test_a_column_has_four_digits_or_what_tells_neighbours_apart():
    assert column_text([334.5786, 22.50021, None]) == ["334.6", "22.5", "-"]
    assert column_text([7997.8, 7997.9]) == ["7997.8", "7997.9"]
    assert column_text([100.0, 100.0000001, 2.0]) == ["100", "100", "2"]  # beyond six digits nothing is told
    assert column_text([12345.0, 0.12345, 12, "no"]) == ["12345", "0.1235", "12", "no"]  # what is whole stays whole
    assert column_text([np.float64("nan"), (1, 2)]) == ["-", "1, 2"]


@given(st.lists(st.floats(-1e6, 1e6), max_size=8))
def test_a_column_keeps_what_six_digits_tell(values):
    told = column_text(values)
    assert len(told) == len(values)
    assert [float(text) for text in told] == pytest.approx(values, rel=5.1e-4, abs=1e-300)
    full = [figure(v, 6) for v in values]
    assert all((a != b) <= (told[i] != told[i + 1]) for i, (a, b) in enumerate(pairwise(full)))


def test_a_height_above_the_sea_is_told_in_metres():
    assert quantity_text(3000.0, "m") == "3000 m" and quantity_text(2.5, "m") == "2500 mm"


@pytest.mark.parametrize(("text", "unit", "value"), [
    ("120 psi", "Pa", 120 * 6894.757293168361), ("3 inch", "m", 0.0762), ("1 ft", "m", 0.3048),
    ("1 lbf", "N", 4.4482216152605), ("1 kgf", "N", 9.80665),
    ("1 lbf*ft", "N*m", 1.3558179483314), ("1 hp", "W", 745.69987158227), ("1 PS", "W", 735.49875),
    ("20 degC", "K", 293.15), ("-10 °C", "K", 263.15), ("5 µm", "m", 5e-6), ("5 N·m", "N*m", 5.0),
    ("3 cm²", "m^2", 3e-4),
    ("2 m·s⁻¹", "m/s", 2.0), ("7 kg·m²", "kg*m^2", 7.0),
])  # fmt: skip
def test_units_as_people_type_them(text, unit, value):
    assert parse(text, unit) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(("text", "unit", "message"), [
    ("3 barg", "Pa", "absolute pressure, 1.01325 bar"), ("20 degC", "Pa", "temperatures only"),
    ("20 degC/s", "K/s", "not known"),
])  # fmt: skip
def test_what_is_ambiguous_is_refused_with_advice(text, unit, message):
    with pytest.raises(BadInput, match=message):
        parse(text, unit)


def test_tables_carry_their_units(tmp_path):
    columns = {"phi": np.array([0.0, math.pi]), "torque": np.array([1.0, 2.0]), "speed_rpm": [1.0, 2.0]}
    columns = Columns(columns, {"phi": "rad", "torque": "N*m", "speed_rpm": "rpm"})
    path = write_quantities(tmp_path / "a.csv", columns)
    assert path.read_text().splitlines()[0] == "phi [rad],torque [N*m],speed_rpm"
    choose("deg, kN*m, rad/s")
    found, units = read_table(write_quantities(tmp_path / "b.csv", columns))
    assert units == {"phi": "deg", "torque": "kN*m", "speed": "rad/s"}
    assert found["phi"] == pytest.approx([0, 180]) and found["speed"][0] == pytest.approx(math.pi / 30)


def test_values_in_lists_keep_their_gaps():
    assert shown_in([1e6, None, 2e6], "Pa") == ([1.0, None, 2.0], "MPa")


@pytest.mark.slow
def test_the_table_of_a_hinge_goes_back_in_as_a_diagram(tmp_path):
    run = CliRunner()
    for units in ([], ["--units", "deg, bar"]):
        out = tmp_path / str(len(units))
        assert run.invoke(mechsym, ["hinge", "zotov-89", "--out", str(out), *units]).exit_code == 0
        again = run.invoke(mechsym, ["hinge", "zotov-89", "--diagram", str(out / "hinge.csv"), *units])
        assert again.exit_code == 0 and "can be cut" in again.output


def test_a_life_is_told_in_hours_and_a_stroke_of_time_in_seconds():
    assert quantity_text(720000, "s") == "200 h" and quantity_text(100.0, "s") == "100 s"

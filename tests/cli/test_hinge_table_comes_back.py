"""The table that `hinge --out` writes goes in again as a measured diagram, in SI and in any units."""

import re

import pytest

from mechsym import cases
from mechsym.files import write_quantities
from mechsym.hinge.summary import QUICK, HingeNumbers, hinge_columns
from mechsym.jobs.hinge import hinge
from mechsym.quantities.display import choose
from mechsym.quantities.results import tell

KEYS = ("mep_bar", "load_torque", "hinge_torque_max", "hinge_torque_min")


@pytest.fixture(scope="module")
def designed():
    return hinge(cases.load("zotov-89"))


def read_back(designed, path, units):
    choose(units)
    try:
        write_quantities(path, hinge_columns(designed))
    finally:
        choose(None)
    found = hinge(cases.load("zotov-89"), str(path))
    told = next(fact for fact in found.machine.gas.pressure.facts if "one degree changes the work by" in fact)
    low, high = map(float, re.search(r"95 %: ([\d.]+) to ([\d.]+) deg", told).groups())
    slope = float(re.search(r"by (-?[\d.]+) %", told)[1])
    return tell(HingeNumbers(judged=found), QUICK), abs((high - low) / 2 * slope) / 100


@pytest.mark.slow
def test_the_table_of_a_hinge_is_read_back(designed, tmp_path):
    """As far as the dead centre, which a diagram does not tell, is known: the program says how far."""
    made = tell(HingeNumbers(judged=designed), QUICK)
    found, uncertain = read_back(designed, tmp_path / "hinge.csv", None)
    assert found["p_max_bar"] == pytest.approx(made["p_max_bar"], rel=1e-3)
    assert uncertain < 0.05
    for key in KEYS:
        assert found[key] == pytest.approx(made[key], rel=uncertain), key


@pytest.mark.slow
def test_its_units_change_nothing(designed, tmp_path):
    plain, _ = read_back(designed, tmp_path / "si.csv", None)
    other, _ = read_back(designed, tmp_path / "other.csv", "bar, deg, kN, kN*m")
    assert "pressure [bar]" in (tmp_path / "other.csv").read_text().partition("\n")[0]
    for key in ("p_max_bar", *KEYS):
        assert other[key] == pytest.approx(plain[key], rel=1e-9), key

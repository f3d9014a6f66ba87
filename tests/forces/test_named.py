"""What people read of forces: one word for one thing, the largest where it says largest."""

import numpy as np
import pytest

from mechsym import cases, jobs
from mechsym.cases.new_engine import write_engine
from mechsym.forces.plots import chain, polar_diagrams
from mechsym.forces.shown import borne, named


@pytest.fixture(scope="module")
def eight(tmp_path_factory):
    """A V8, whose main bearings have places along the shaft."""
    folder = tmp_path_factory.mktemp("engine")
    return jobs.forces(cases.load(str(write_engine("v", 0.096, 0.092, 8, folder, gas="closed")[0])))


def test_a_main_bearing_is_one_place_and_not_what_a_throw_leans_on_two(eight):
    rows = {named(row): row for row in borne(eight)}
    assert not any("main bearing" in name for name in rows)
    throw = max(
        (row for name, row in rows.items() if name.startswith("throw") and "load" in name), key=lambda r: r["max"]
    )
    assert throw["max"] == pytest.approx(max(eight.columns[f"main_bearing_{k}_load"].max() for k in (1, 2, 3, 4)))
    assert "beside the throw" in throw["on"]
    card = next(card for card in eight.view.cards if card.name == "main bearing")
    largest = max(float(np.hypot(one.x, one.y).max()) for one in eight.journals)
    assert largest < throw["max"] and card.value == f"{largest / 1e3:.4g} kN"
    pins, throws = polar_diagrams(eight).axes[:2]
    assert throws.get_title("left") == "throws, in the frame" and pins.get_title("left") == "crank pins, in the crank"
    assert all(line.get_label().startswith(("throw", "_")) for line in throws.lines)
    polar = next(p for p in eight.view.pictures if p.name == "polar")
    assert "a throw on its bearings" in polar.see


def test_where_the_bearing_carries_the_whole_throw_it_is_called_so():
    one = jobs.forces(cases.load("zotov-89"))
    assert one.journals == () and any(named(row) == "main bearing load" for row in borne(one))
    assert polar_diagrams(one).axes[1].get_title("left") == "main bearings, in the frame"


def test_curves_for_which_there_is_no_colour_are_counted(eight, tmp_path):
    whole = chain(eight).axes[0]
    assert len(whole.lines) == 8 and whole.get_title("left") == ""
    twelve = jobs.forces(cases.load(str(write_engine("v", 0.096, 0.092, 12, tmp_path, gas="closed")[0])))
    gas = chain(twelve).axes[0]
    assert len(gas.lines) == 8 and gas.get_title("left") == "the first 8 of 12"

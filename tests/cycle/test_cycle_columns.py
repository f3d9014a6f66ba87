"""Every figure that a cycle tells has its unit in one place, whatever kind of cycle it is."""

import pytest

from mechsym import cases
from mechsym.cycle.columns import UNITS
from mechsym.jobs.cycle import cycle
from mechsym.quantities.results import leaves

CASES = ("zotov-89", "nunes-slider-crank", "generator-breathing", "balandin", "opposed-pistons", "alpha-stirling")


@pytest.mark.parametrize("name", CASES)
def test_every_figure_has_a_unit(name):
    told = {leaf.path: leaf.unit for leaf in leaves(cycle(cases.load(name)))}
    assert {path for path, unit in told.items() if not unit or unit.startswith("of")} == set()
    assert {told[f"fractions.{share}"] for share in ("heat", "work", "exhaust", "unburnt")} == {"-"}


@pytest.mark.parametrize("name", ["opposed-pistons", "nunes-slider-crank"])
def test_figures_of_one_cylinder_have_the_units_of_the_engine(name):
    figures = cycle(cases.load(name))
    told = {leaf.path: leaf.unit for leaf in leaves(figures)}
    assert {n: told[f"per_cylinder.{n}"] for n in figures["per_cylinder"]} == {
        n: UNITS[n] for n in figures["per_cylinder"]
    }

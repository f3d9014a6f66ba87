"""Results that show themselves: short repr, cards, figures by name, columns with units."""

import dataclasses

import numpy as np
import pytest

import mechsym
from mechsym import cases
from mechsym.cycle.columns import compare
from mechsym.errors import BadInput
from mechsym.jobs.codesign import codesign, settings_of
from mechsym.jobs.cycle import cycle
from mechsym.jobs.forces import forces
from mechsym.jobs.gas import gas
from mechsym.jobs.hinge import hinge
from mechsym.jobs.machine import machine
from mechsym.jobs.optimise import optimise
from mechsym.jobs.run import loop, run, startup
from mechsym.jobs.size import size
from mechsym.page import Card, Picture, ResultTable, Shown, ShownFigures, View, grid, page, shows
from mechsym.page.template import _environment, typeset
from mechsym.quantities import record
from mechsym.quantities.display import choose
from mechsym.quantities.results import Columns
from mechsym.simulate.loop.run import run_loop

SPEEDS = np.array([400.0, 500.0])
MADE = {
    "cycle": lambda: cycle(cases.load("nunes-slider-crank"), SPEEDS),
    "compare": lambda: compare(*(cycle(cases.load(f"nunes-{n}"), SPEEDS) for n in ("slider-crank", "hypocycloid"))),
    "forces": lambda: forces(cases.load("nunes-hypocycloid")),
    "gas": lambda: gas(cases.load("zotov-89")),
    "run": lambda: run(cases.load("alpha-stirling", {"simulation.turns": "3"}), check="none"),
    "size": lambda: size(cases.load("nunes-hypocycloid")),
    "optimise": lambda: optimise(cases.load("nunes-hypocycloid")),
    "hinge": lambda: hinge(cases.load("zotov-89")),
    "machine": lambda: machine(cases.load("zotov-89")),
    "loop": lambda: run_loop(loop(cases.load("nunes-slider-crank")), 300.0, cycles=1.5),
    "startup": lambda: startup(cases.load("chmielewski", {"simulation.t_end": "4"})),
    "codesign": lambda: codesign(zotov := cases.load("zotov-89"), settings_of(zotov)),
}
SLOW = ("codesign", "forces", "hinge", "loop", "optimise", "run", "size", "startup")


@record
class Spot(Shown):
    """A result of the test's own."""

    force: float  #: [N]


UNITS = {"phi": "rad", "torque_1": "N*m", "speed_rpm": "rpm"}


@shows(Spot)
def spot_view(spot):
    """What of a spot is worth seeing."""
    from mechsym.style import panels

    return View(
        title="A <spot>", cards=(Card(name="force", value=f"{spot.force:g} N*m", mark="yes"),),
        pictures=(Picture(name="nothing", see="Nothing.", draw=lambda: panels(3, 2)[0]),),
        columns=lambda: Columns({"phi": [0.0, np.pi], "torque_1": [1e3, spot.force], "speed_rpm": [1.0, 2.0]}, UNITS),
    )  # fmt: skip


@pytest.mark.parametrize("name", [pytest.param(n, marks=[pytest.mark.slow] * (n in SLOW)) for n in MADE])
def test_every_result_of_a_job_shows_itself(name):
    found = MADE[name]()
    assert len(repr(found)) < 500 and "\n" not in repr(found)
    text = found._repr_html_()
    assert found.view.cards and all(
        card.value and str(typeset(card.name)) in text for card in found.view.cards if "'" not in card.name
    )
    table = found.table()
    assert len(table) and len(repr(table)) < 500 and "<table>" in table._repr_html_()
    for picture in found.view.pictures:
        assert found.plot(picture.name).axes and picture.see.endswith(".")


def test_cards_are_escaped_and_units_set_as_in_books():
    text = Spot(force=2.0)._repr_html_()
    assert "A &lt;spot&gt;" in text and "2 N m" in text and 'class="yes"' in text


def test_a_table_has_units_and_goes_to_xarray_and_pandas():
    table = Spot(force=2.0).table()
    assert list(table) == ["phi [rad]", "torque_1 [N*m]", "speed [rpm]"]
    assert table["torque_1"][1] == 2.0 == table["torque_1 [N*m]"][1]
    with pytest.raises(KeyError):
        table["mass"]
    assert pytest.importorskip("xarray") and table.to_xarray()["torque_1"].attrs == {"units": "N*m"}
    if pytest.importorskip("pandas"):
        assert list(table.to_pandas().columns) == list(table)


def test_sentences_of_a_gas_follow_the_units_that_were_chosen():
    """In one process, as in the workbench: what was computed before with other units is not told again."""
    case = cases.load("moroianu")
    plain = gas(case).pressure.facts
    try:
        choose("bar")
        in_bar = gas(case).pressure.facts
    finally:
        choose(None)
    assert plain != in_bar
    assert all("MPa" not in fact for fact in in_bar)
    assert gas(case).pressure.facts == plain


def test_a_table_is_in_the_units_that_were_chosen():
    try:
        choose("kN*m, deg")
        table = ResultTable(Columns({"phi": [np.pi], "torque": [1e3]}, {"phi": "rad", "torque": "N*m"}))
    finally:
        choose(None)
    assert (table["phi [deg]"], table["torque [kN*m]"]) == (180.0, 1.0)


def test_a_picture_is_found_by_its_name():
    assert Spot(force=1.0).plot().axes
    with pytest.raises(BadInput, match="nothing"):
        Spot(force=1.0).plot("nothin")


def test_figures_by_name_are_a_dictionary_and_short():
    found = ShownFigures(a=np.zeros(3), b=list(range(1000)), c=1.0)
    assert found == {"a": found["a"], "b": found["b"], "c": 1.0}
    assert repr(found) == "ShownFigures(a=array(3,), b=list of 1000, c=1.0)"


def test_a_page_lacks_nothing_in_silence():
    import jinja2

    with pytest.raises(jinja2.UndefinedError):
        page("cards.html", cards=())


def test_a_view_is_a_record():
    assert [f.name for f in dataclasses.fields(View)] == ["title", "cards", "pictures", "columns", "findings"]


def test_a_wide_table_is_stacked_on_a_phone_and_repeats_its_head_in_print():
    both = ("check", "value and limit")
    wide = grid("Limits", [{"check": "closing", "value and limit": "closing z/H 0.4678 of at most 0.9 of it"}], both)
    assert wide.stacked and not grid("Loads", [{"force": 2000.0}], ["force"]).stacked
    template = "{% from 'parts.html' import grid %}{{ grid(table) }}"
    text = _environment().from_string(template).render(table=wide)
    assert '<table class="stack"><thead><tr><th>check</th>' in text
    assert '<td data-name="value and limit">closing z/H 0.4678' in text


def test_a_figure_shows_itself_in_a_notebook():
    drawn = Spot(force=1.0).plot()._repr_svg_()
    assert drawn.startswith("<svg") and "<title id=" in drawn and drawn.rstrip().endswith("</svg>")


def test_a_printed_page_has_its_title_the_version_and_its_number():
    given = '{% extends "base.html" %}{% block title %}Report of <b>{{ name }}</b>{% endblock %}'
    text = _environment().from_string(given).render(name='a "b" & c')
    assert "@top-left { content: \"Report of a 'b' & c\"" in text
    assert f'content: "mechsym {mechsym.__version__}"' in text and "counter(page)" in text

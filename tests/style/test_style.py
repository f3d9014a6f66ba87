"""One palette, labels that keep clear, units on axes, SVG with words and ids of its own."""

import importlib
import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pictures import contrast, faults, ids

from mechsym import style
from mechsym.quantities.display import choose

PANELS = vars(importlib.import_module("mechsym.style.panels"))  # in the room the name is that of a function
READ = {name: PANELS[name] for name in "INK BLUE RED GREEN ORANGE VIOLET TEAL PINK GREY QUIET".split()}
FILLS = "PISTON CYLINDER CRANK GEAR BEARING CARRIER SHAFT WHEEL GAS ROLLER NOTHING PAPER".split()


@pytest.mark.parametrize("name", READ)
def test_what_is_read_stands_out_on_both_papers(name):
    assert contrast(READ[name], style.PAPER) >= 4.5
    assert contrast(style.DARK[READ[name]], style.DARK[style.PAPER]) >= 4.5


@pytest.mark.parametrize("name", FILLS)
def test_letters_stand_out_on_what_is_filled(name):
    fill = PANELS[name]
    assert contrast(style.INK, fill) >= 4.5
    assert contrast(style.DARK[style.INK], style.DARK[fill]) >= 4.5


def test_pages_stand_out(pytestconfig):
    sheet = (pytestconfig.rootpath / "mechsym/templates/page.css").read_text()
    light, dark = re.findall(r":root \{([^}]*)\}", sheet)
    for text, whole in ((light, ""), (dark, light)):
        shades = dict(re.findall(r"--(\w+): (#\w{6})", whole + text))
        for name in ("ink", "quiet", "blue", "green", "red", "amber"):
            assert contrast(shades[name], shades["paper"]) >= 4.5, name
            assert contrast(shades[name], shades["soft"]) >= 4.5, name


def test_notebook_cards_and_simulating_pages_stand_out(pytestconfig):
    cards = (pytestconfig.rootpath / "mechsym/templates/cards.html").read_text()
    # letters have the notebook's own colour, whatever its theme; only the bars of verdicts have one of ours
    assert "prefers-color-scheme" not in cards and not re.findall(r"(?<![-\w])color: (?!inherit)", cards)
    for bar in re.findall(r"border(?:-left|-color): [^;]*?(#\w{6})", cards):
        assert min(contrast(bar, paper) for paper in ("#ffffff", "#111111")) >= 3, bar
    page = (pytestconfig.rootpath / "mechsym/out/web/page.html").read_text()
    for sheet in re.findall(r":root \{([^}]*)\}", page):
        shades = {name: "#" + (c if len(c) == 6 else "".join(2 * d for d in c))
                  for name, c in re.findall(r"--(\w+): #(\w{3,6})", sheet)}  # fmt: skip
        for name in ("ink", "quiet"):
            assert min(contrast(shades[name], shades[back]) for back in ("paper", "soft")) >= 4.5, name
    script = page.partition("<script>")[2]
    assert not re.findall(r"#[0-9a-f]{3,6}\b", script)  # canvases take the palette's colours, which the page carries
    for kind, of in (("light", lambda colour: colour), ("dark", style.DARK.__getitem__)):
        assert min(contrast(of(c), of(style.PAPER)) for c in (*style.SERIES, style.QUIET)) >= 4.5, kind


def test_contrast_of_black_and_white():
    assert contrast("#000000", "#ffffff") == pytest.approx(21)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.01)  # as the guidelines' examples


def simple(title="", name="speed"):
    figure, (axis,) = style.panels(5, 3, title=title)
    axis.plot([0, 1], [1, 2], "o-", color=style.BLUE, label="pressure < 5")
    axis.set(xlabel="time [s]", ylabel=f"{name} [rpm]")
    style.legend(axis)
    return figure


def test_svg_has_words_and_a_colour_for_dark_paper():
    text = style.svg(simple("Speed & more"))
    root = ET.fromstring(text)
    space = "{http://www.w3.org/2000/svg}"
    assert root.find(f"{space}title").text == "Speed & more"
    assert root.find(f"{space}desc").text == "speed [rpm] over time [s]: pressure < 5"
    assert "time [s]" in [t.text for t in root.iter(f"{space}text")]
    assert set(root.get("aria-labelledby").split()) <= {e.get("id") for e in root.iter()}
    assert f'stroke: {style.BLUE}"]{{stroke:{style.DARK[style.BLUE]}' in text
    assert "<metadata" not in text and "DOCTYPE" not in text


def test_equal_data_give_equal_text_and_two_figures_share_no_id():
    assert style.svg(simple()) == style.svg(simple())
    page = style.svg(simple(name="torque")) + style.svg(simple()) + style.svg(simple(), name="again")
    assert not ids(page) and page.count(' id="') >= 9


def test_without_a_title_a_figure_says_what_it_draws():
    assert "<title" in style.svg(simple()) and ">speed [rpm] over time [s]</title>" in style.svg(simple())


@given(st.lists(st.floats(-10, 10), min_size=1, max_size=12), st.floats(0.01, 2))
def test_spread_keeps_the_gap_and_the_order(wanted, gap):
    places = style.spread(wanted, gap)
    order = np.argsort(wanted, kind="stable")
    assert np.all(np.diff(places[order]) >= gap - 1e-9)
    if np.all(np.diff(np.array(wanted)[order]) >= gap):
        assert np.allclose(places, wanted)


@given(st.lists(st.floats(-10, 10), min_size=1, max_size=12), st.floats(0.01, 2))
def test_spread_stays_in_the_room(wanted, gap):
    places = style.spread(wanted, gap, 0.0, 5.0)
    assert places.min() >= -1e-9 and places.max() <= 5 + 1e-9
    assert np.all(np.diff(np.sort(places)) >= min(gap, 5 / max(len(wanted) - 1, 1)) - 1e-9)


def test_events_beside_each_other_can_be_read():
    figure, (axis,) = style.panels(4.4, 4)
    axis.set_xlim(0, 360)
    style.events(axis, {f"event {k}": 100 + 0.5 * k for k in range(8)}, width=3.6)
    assert faults(figure) == []


def test_a_legend_keeps_off_the_heading_and_the_paper():
    figure, axes = style.panels(9, 4, 1, 2)
    for axis in axes:
        for k in range(7):
            axis.plot([0, 1], [0, k], label=f"curve of the number {k}")
        style.heading(axis, "a heading")
        style.legend(axis)
    assert faults(figure) == []


def test_the_overlap_test_can_fail():
    figure, (axis,) = style.panels(4, 3)
    axis.text(0.5, 0.5, "one")
    axis.text(0.52, 0.5, "other")
    axis.text(1.5, 0.5, "far away").set_in_layout(False)
    assert [f for f in faults(figure) if f == "'one' on 'other'"]
    assert [f for f in faults(figure) if f.startswith("'far away' leaves the paper")]


def test_equal_curves_are_named_once():
    y = np.sin(np.linspace(0, 6, 50))
    assert list(style.distinct({"a": y, "b": 2 * y, "c": y * (1 + 1e-9)})) == ["a = c", "b"]


def test_a_long_run_is_no_block():
    t = np.linspace(0, 100, 20001)
    figure, (axis,) = style.panels(5, 3)
    style.envelope(axis, t, np.sin(20 * t), style.BLUE, "fast")
    assert not axis.lines and len(axis.collections) == 1
    low, high = (f(axis.collections[0].get_paths()[0].vertices[:, 1]) for f in (np.min, np.max))
    assert low == pytest.approx(-1, abs=0.01) and high == pytest.approx(1, abs=0.01)
    style.envelope(axis, t, np.sin(0.2 * t), style.RED, "slow")
    assert len(axis.lines) == 1


def test_axes_follow_the_units_that_were_chosen():
    try:
        assert style.axis_unit("Pa", [2e5]) == (1e-6, "MPa")
        choose("bar, rad, N*m, inch")
        assert style.axis_unit("Pa", [2e5]) == (1e-5, "bar")
        assert style.axis_unit("N*m", 5e6) == (1.0, "N m")
        assert style.axis_unit("m", 1.0) == (pytest.approx(1 / 0.0254), "inch")
        figure, (axis,) = style.panels(4, 3)
        assert style.over_angle(axis, 2 * np.pi) == 1.0 and axis.get_xlabel() == "crank angle [rad]"
    finally:
        choose(None)
    assert style.axis_unit("rad", 6.0)[1] == "deg" and style.axis_unit("m^3", 0.5) == (1000.0, "L")


def test_equal_paths_are_named_once_wherever_they_begin():
    t = np.linspace(0, 2 * np.pi, 721)
    path = lambda shift, size: np.concatenate([size * np.cos(t + shift), np.sin(2 * (t + shift))])  # noqa: E731
    found = style.distinct({"a": path(0, 1.0), "b": path(1.3, 1.0), "c": path(0, 1.05)}, same=style.same_path)
    assert list(found) == ["a = b", "c"]

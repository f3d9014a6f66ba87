"""No key where a person reads: tabs of the workbench, reports, pictures; keys to be typed stand as code."""

import json
from pathlib import Path

import pytest
from keys import shown_keys

from mechsym import cases
from mechsym.app.told import told
from mechsym.page.template import page
from mechsym.quantities.display import key_words
from mechsym.report import case_report, html

RECORDED = Path(__file__).parents[1] / "recorded"
TABS = ("simulate", "forces", "cycle", "flywheel", "hinge", "size")


def test_tabs_name_what_they_tell_in_words():
    seen = set()
    for path in sorted(RECORDED.glob("*/*.json")):
        found = json.loads(path.read_text(encoding="utf-8"))
        if path.stem in TABS and found.get("json"):
            seen |= {name for name, _ in told(found["json"], {})}
    assert len(seen) > 300
    assert sorted(name for name in seen if shown_keys(name)) == []


def test_a_key_in_a_sentence_is_set_as_a_symbol_or_as_what_is_typed():
    assert shown_keys("with c_v and balance = whole_cycle, in sweep_1.csv") == ["c_v", "whole_cycle"]
    grid = page("cards.html", title="t", cards=())
    assert shown_keys(grid) == [] and key_words("spring.p0") == "spring, p0"


@pytest.mark.parametrize("name", ["nunes-slider-crank"])
def test_a_report_of_a_cycle_shows_no_key(name):
    assert shown_keys(html([case_report(cases.load(name), ["cycle"])])) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", ["zotov-89", "alpha-stirling", "nunes-hypocycloid"])
def test_a_report_shows_no_key(name):
    text = html([case_report(cases.load(name))])
    assert shown_keys(text) == [] and len(text.encode()) <= 1_200_000

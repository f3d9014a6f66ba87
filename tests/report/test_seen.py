"""A report in a browser: the machine moves on the first screen, nothing is cut on a phone, no picture twice."""

import re
from shutil import which

import pytest

from mechsym import cases
from mechsym.report import case_report, html

playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
CHROMIUM = which("chromium") or which("chromium-browser")
pytestmark = [pytest.mark.slow, pytest.mark.skipif(CHROMIUM is None, reason="no chromium is installed")]


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("seen") / "report.html"
    path.write_text(html([case_report(cases.load("zotov-89"), ["cycle", "hinge"])]), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as running:
        found = running.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield found
        found.close()


@pytest.mark.parametrize("size", [(1400, 900), (375, 812)])
def test_the_machine_moves_on_the_first_screen_and_nothing_is_cut(browser, file, size):
    tab = browser.new_page(viewport={"width": size[0], "height": size[1]})
    tab.goto(file.as_uri())
    drawn = tab.locator(".turning .scene svg")
    for k in range(drawn.count()):
        box = drawn.nth(k).bounding_box()
        assert box["y"] + box["height"] <= size[1] and box["x"] + box["width"] <= size[0]
    piston = tab.locator(".turning path.piston").first
    start = piston.get_attribute("d")
    tab.wait_for_function("at => document.querySelector('.turning path.piston').getAttribute('d') != at", arg=start)
    tab.locator(".turning .play").click()
    held = piston.get_attribute("d")
    tab.wait_for_timeout(200)
    assert piston.get_attribute("d") == held
    assert tab.evaluate("document.documentElement.scrollWidth") <= size[0]
    wide = "[...document.querySelectorAll('svg')].map(s => s.getBoundingClientRect().right)"
    assert max(tab.evaluate(wide)) <= size[0]
    # on a phone a picture of two columns of panels is one below the other, each once
    lefts = "[...document.querySelector('.live').children].map(panel => panel.getBoundingClientRect().left)"
    places = set(tab.evaluate(lefts))
    assert len(places) == 1 if size[0] < 700 else len(places) == 2
    live = "[...document.querySelectorAll('svg[data-panels]')].map(s => JSON.parse(s.dataset.panels).panels.length)"
    panels, drawn = tab.evaluate(live), tab.evaluate("document.querySelectorAll('.live > div').length")
    assert len(panels) > 3 and sum(panels) == drawn
    assert tab.locator("svg[data-panels]:visible").count() == 0
    tab.close()


def test_no_picture_stands_twice(file):
    text = file.read_text(encoding="utf-8")
    drawn = [re.sub(r'id="[^"]*"|#[0-9a-f]{8}-\w+', "", one) for one in re.findall(r"<path d=[^>]{400,}>", text)]
    assert len(drawn) == len(set(drawn))

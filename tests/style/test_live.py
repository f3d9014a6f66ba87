"""Panels that a page brings to life: what it is told of their axes gives back the points that were drawn."""

import json
import re
from html import unescape
from shutil import which

import numpy as np
import pytest

from mechsym.page import page
from mechsym.style import events, legend, panels, svg
from mechsym.style.picture import live_panels

X = np.linspace(0.0, 360.0, 73)
CURVES = {"one": 3.0 * np.sin(np.radians(X)), "two": 0.02 * X}


def drawn():
    figure, (left, right) = panels(9, 3, 1, 2, "Curves and bars")
    for name, y in CURVES.items():
        left.plot(X, y, label=name)
    left.axhline(0.0)
    left.set(xlabel="crank angle [deg]", ylabel="force [kN]", xlim=(0, 360))
    events(left, {"opens": 100.0, "closes": 103.0}, 4.0)
    legend(left)
    right.bar([1, 2], [3, 4])
    return figure


def told(text):
    return json.loads(unescape(re.search(r'data-panels="([^"]*)"', text)[1]))


def test_the_points_come_back_from_the_path_and_the_axes():
    text = svg(drawn())
    panel, bars = told(text)["panels"]
    assert [name for _, name in panel["curves"]] == ["one", "two", ""] and list(bars) == ["crop"]
    assert panel["marks"] == [[100.0, "opens"], [103.0, "closes"]]
    (left, low, right, top), (x0, x1), (y0, y1) = panel["at"], panel["x"], panel["y"]
    for (number, name), y in zip(panel["curves"], CURVES.values(), strict=False):
        path = re.search(rf'data-curve="{number}">\s*<path d="([^"]*)"', text)[1]
        points = np.reshape([float(v) for v in re.findall(r"-?[\d.]+", path)], (-1, 2))
        x = x0 + (points[:, 0] - left) / (right - left) * (x1 - x0)
        read = y0 + (points[:, 1] - low) / (top - low) * (y1 - y0)
        assert np.abs(read - np.interp(x, X, y)).max() < 1e-3 * np.ptp(y), name
        assert x[0] == pytest.approx(0.0, abs=0.01) and x[-1] == pytest.approx(360.0, abs=0.01)


def test_loops_bars_points_and_words_stay_as_they_are_drawn():
    figure, axes = panels(9, 3, 1, 4, "None of them is a curve over a rising value")
    axes[0].plot(np.cos(X), np.sin(X))
    axes[1].bar([1, 2], [3, 4])
    axes[2].plot(X, X, "o")
    axes[3].plot(X, X)
    axes[3].text(10, 10, "here")
    assert "data-panels" not in svg(figure) and live_panels(figure) == {}


@pytest.mark.slow
def test_in_a_browser_the_cursor_reads_the_curve_and_two_zoom_together(tmp_path):
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    chromium = which("chromium") or which("chromium-browser")
    if chromium is None:
        pytest.skip("no chromium is installed")
    body = svg(drawn(), "1") + svg(drawn(), "2")
    file = tmp_path / "live.html"
    file.write_text(f"<!doctype html><style>{page('page.css')}</style><body>{body}{page('live.html')}</body>")
    with playwright.sync_playwright() as running:
        browser = running.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        tab = browser.new_page(viewport={"width": 1400, "height": 900})
        errors = []
        tab.on("pageerror", lambda e: errors.append(str(e)))
        tab.goto(file.as_uri())
        over = tab.locator(".u-over").first
        box = over.bounding_box()
        tab.mouse.move(box["x"] + box["width"] / 4, box["y"] + 20)
        read = tab.evaluate("mechsymPlots.map(({u}) => u.legend.values.map(v => parseFloat(v._)))")
        # an angle of 90 degrees: 3 sin(90 deg) and 0.02 * 90, in both figures
        for values in read:
            assert values[0] == pytest.approx(90, abs=1) and values[1:3] == pytest.approx([3.0, 1.8], abs=0.03)
        tab.mouse.down()
        tab.mouse.move(box["x"] + box["width"] / 2, box["y"] + 40)
        tab.mouse.up()
        tab.wait_for_timeout(100)
        ranges = tab.evaluate("mechsymPlots.map(({u}) => [u.scales.x.min, u.scales.x.max])")
        assert ranges[0] == pytest.approx([90, 180], abs=2) and ranges[1] == pytest.approx(ranges[0])
        assert tab.locator(".picture.drawn").first.is_hidden()
        tab.emulate_media(media="print")
        assert tab.locator(".picture.drawn").first.is_visible() and tab.locator(".live").first.is_hidden()
        tab.emulate_media(media="screen")
        tab.set_viewport_size({"width": 375, "height": 812})
        tab.wait_for_timeout(300)
        assert tab.evaluate("document.documentElement.scrollWidth") <= 375
        assert errors == []
        browser.close()

"""The workbench in a real browser: sliders move the verdict, nothing leaves the machine, two browsers are two."""

import os
import socket
import subprocess
import sys
import time
import urllib.request
from shutil import which

import numpy as np
import pytest

pytest.importorskip("nicegui", reason="the extra app is not installed")
playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
CHROMIUM = which("chromium") or which("chromium-browser")
pytestmark = [pytest.mark.slow, pytest.mark.skipif(CHROMIUM is None, reason="no chromium is installed")]
OUTSIDE = {k: v for k, v in os.environ.items() if not k.startswith("PYTEST")}


@pytest.fixture(scope="module")
def address():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = subprocess.Popen([sys.executable, "-m", "mechsym", "app", "zotov-89", "--port", str(port)],
                              stderr=subprocess.DEVNULL, env=OUTSIDE)  # fmt: skip
    where = f"http://127.0.0.1:{port}/"
    try:
        for _ in range(300):
            try:
                urllib.request.urlopen(where, timeout=5).close()
                break
            except OSError:
                time.sleep(0.2)
        yield where
    finally:
        server.terminate()
        server.wait()


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as running:
        found = running.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield found
        found.close()


@pytest.fixture
def page(browser, address):
    made = browser.new_page(viewport={"width": 1500, "height": 1100})
    made.asked, made.errors = [], []
    made.on("request", lambda request: made.asked.append(request.url))
    made.on("pageerror", lambda error: made.errors.append(str(error)))
    made.goto(address)
    playwright.expect(made.locator("[data-verdict]")).to_contain_text("can be built", timeout=30_000)
    yield made
    made.close()


def outputs(page):
    return page.locator(".nicegui-content").inner_text()


def press(page, key, way="ArrowRight"):
    """Move a slider by a step and wait until something that is shown has changed; the time it took [s]."""
    page.locator(f'.q-slider[data-key="{key}"] [tabindex="0"]').first.focus()
    before, start = page.locator("table").first.inner_text(), time.monotonic()
    page.keyboard.press(way)
    while page.locator("table").first.inner_text() == before:
        assert time.monotonic() - start < 20, f"{key} moved and nothing changed"
        page.wait_for_timeout(4)
    return time.monotonic() - start


def test_sliders_move_the_answer_and_undo_takes_it_back(page):
    first = page.locator("table").first.inner_text()
    for key in ("spring.p0", "spring.A", "operation.speed", "guide.rho0"):
        press(page, key)
    assert "spring.p0=" in page.url and "guide.rho0=" in page.url
    for _ in range(4):
        page.get_by_text("undo").click()
        page.wait_for_timeout(300)
    playwright.expect(page.locator("table").first).to_have_text(
        first.replace("\n", "").replace("\t", ""), timeout=20_000
    )
    assert not page.errors
    assert all(url.startswith(("http://127.0.0.1", "ws://127.0.0.1", "data:", "about:", "blob:")) for url in page.asked)


def test_every_move_is_answered(page, record_property):
    times = [press(page, "spring.p0") for _ in range(20)]
    record_property("p95_ms", float(1e3 * np.quantile(times, 0.95)))  # wanted: 250 on an idle machine
    print(f"p95 of a slider move: {1e3 * np.quantile(times, 0.95):.0f} ms")


def test_two_browsers_do_not_share_state(browser, address, page):
    other = browser.new_page()
    other.goto(address)
    playwright.expect(other.locator("[data-verdict]")).to_contain_text("can be built", timeout=30_000)
    before = other.locator("table").first.inner_text()
    press(page, "spring.p0")
    other.wait_for_timeout(500)
    assert other.locator("table").first.inner_text() == before
    other.close()


def test_what_an_address_may_not_say_is_refused_in_words(browser, address):
    page = browser.new_page()
    page.goto(f"{address}?case=/etc/passwd&mechanism=./own.py")
    playwright.expect(page.get_by_text("not built in")).to_be_visible(timeout=20_000)
    assert "root:" not in page.content()
    page.close()


def test_a_run_of_a_command_is_shown(page):
    page.get_by_role("tab", name="cycle").click()
    page.get_by_role("button", name="run mechsym cycle").click()
    playwright.expect(page.get_by_text("exit status 0")).to_be_visible(timeout=60_000)

"""Every page that a command writes: no key is shown, nothing is wider than a phone, none is too large, no script fails.

Few commands in the slow suite, every command of every case where time does not count.
"""

from shutil import which

import pytest
from click.testing import CliRunner
from keys import shown_keys

from mechsym import cases
from mechsym.cli import mechsym

playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
CHROMIUM = which("chromium") or which("chromium-browser")
pytestmark = [pytest.mark.slow, pytest.mark.skipif(CHROMIUM is None, reason="no chromium is installed")]
SOME = (
    "hinge zotov-89", "forces alpha-stirling", "balance zotov-89", "page opposed-pistons", "reproduce moroianu2017",
    "report alpha-stirling --parts cycle,simulate", "report zotov-89 --parts cycle",
)  # fmt: skip
EVERY = [f"{name} {case}" for case in cases.names() for name in ("report", "forces", "cycle", "balance", "page")]
EVERY += ["codesign zotov-89", "study nunes2017-chapter-6", "hinge zotov-142", "audit zotov2024"]
HEAD = ("hinge", "forces", "page", "report")  # pages on which a machine turns


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as running:
        opened = running.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield opened
        opened.close()


@pytest.mark.parametrize("line", [*SOME, *(pytest.param(one, marks=pytest.mark.heavy) for one in EVERY)])
def test_a_page_is_readable_on_a_phone_and_shows_no_key(browser, tmp_path, line):
    words = line.split()
    out = tmp_path / ("page.html" if words[0] == "page" else "out")
    done = CliRunner().invoke(mechsym, [*words, "--out", str(out)])
    assert done.exit_code in (0, 1, 2), done.output
    files = sorted(tmp_path.rglob("*.html"))
    assert files or done.exit_code == 2 or words[0] == "cycle"
    for file in files:
        text = file.read_text(encoding="utf-8")
        assert shown_keys(text) == [] and len(text.encode()) <= 1_200_000, file.name
        for width, height in ((375, 812), (1400, 900)):
            tab, errors = browser.new_page(viewport={"width": width, "height": height}), []
            tab.on("pageerror", lambda e, errors=errors: errors.append(str(e)))
            tab.goto(file.as_uri())
            assert tab.evaluate("document.documentElement.scrollWidth") <= width, file.name
            drawn = "[0, ...[...document.querySelectorAll('svg, canvas')].map(s => s.getBoundingClientRect().right)]"
            assert tab.evaluate(f"Math.max(...{drawn})") <= width, file.name
            if words[0] in HEAD and tab.locator(".turning").count():
                box = tab.locator(".turning .scene svg").first.bounding_box()
                assert box["y"] + box["height"] <= height, file.name
            assert errors == [], file.name
            tab.close()

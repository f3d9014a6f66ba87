"""Every page that a command writes: no key is shown, nothing is wider than a phone, none is too large, no script fails.

Few commands in the slow suite, every command of every case where time does not count.
"""

import re
from pathlib import Path
from shutil import which

import pytest
from click.testing import CliRunner
from keys import shown_keys

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput

playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
CHROMIUM = which("chromium") or which("chromium-browser")
pytestmark = [pytest.mark.slow, pytest.mark.skipif(CHROMIUM is None, reason="no chromium is installed")]
SOME = (
    "hinge zotov-89", "forces alpha-stirling", "balance zotov-89", "page opposed-pistons", "reproduce moroianu2017",
    "report alpha-stirling --parts cycle,simulate", "report zotov-89 --parts cycle",
)  # fmt: skip
OWN = ("atkinson", "compressor", "scotch-yoke", "swash-plate", "watt-six-bar", "whitworth")
FILES = Path(__file__).parents[2] / "examples" / "mechanisms"
FIRST = [f"page {FILES / name}.toml" for name in OWN] + [f"page {name}" for name in cases.names()]
EVERY = [f"{name} {case}" for case in cases.names() for name in ("report", "forces", "cycle", "balance", "page")]
EVERY += ["codesign zotov-89", "study nunes2017-chapter-6", "hinge zotov-142"]
HEAD = ("hinge", "forces", "page", "report")  # pages on which a machine turns


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as running:
        opened = running.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield opened
        opened.close()


@pytest.mark.parametrize(
    "line",
    [one if re.search("zotov-89|scotch", one) else pytest.param(one, marks=pytest.mark.heavy) for one in FIRST],
)
def test_a_machine_moves_on_the_first_screen_of_a_page_and_of_a_report(browser, tmp_path, line):
    case = line.partition(" ")[2]
    lines = {line: tmp_path / "page.html", f"report {case} --parts forces": tmp_path / "report.html"}
    for one, file in lines.items():
        done = CliRunner().invoke(mechsym, [*one.split(), "--out", str(file)])
        assert done.exit_code in (0, 1, 2), done.output
        for width, height in ((375, 812), (1400, 900)):
            tab = browser.new_page(viewport={"width": width, "height": height})
            tab.goto(file.as_uri())
            scene = tab.locator(".turning .scene svg").first
            box = scene.bounding_box()
            assert box["y"] >= 0 and box["y"] + box["height"] <= height, (one, width)
            poses = []
            for angle in (3, 40):
                tab.locator(".turn .angle").first.evaluate(
                    f"e => {{ e.value = {angle}; e.dispatchEvent(new Event('input')); }}"
                )
                poses.append(scene.inner_html())
            assert poses[0] != poses[1], one
            tab.close()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "cylinders"),
    [("v", 12), *(pytest.param(kind, n, marks=pytest.mark.heavy) for kind, n in (("inline", 6), ("boxer", 12)))],
)
def test_reports_of_many_cylinders_stay_small(tmp_path, kind, cylinders):
    words = ["new", "engine", "many", "--kind", kind, "--cylinders", str(cylinders), "--bore", "86 mm"]
    case, report = tmp_path / "many.toml", tmp_path / "many.html"
    assert CliRunner().invoke(mechsym, [*words, "--stroke", "86 mm", "--out", str(case)]).exit_code == 0
    done = CliRunner().invoke(mechsym, ["report", str(case), "--out", str(report)])
    assert done.exit_code in (0, 1) and len(report.read_bytes()) <= 1_200_000


@pytest.mark.parametrize("line", [*SOME, *(pytest.param(one, marks=pytest.mark.heavy) for one in EVERY)])
def test_a_page_is_readable_on_a_phone_and_shows_no_key(browser, tmp_path, line):
    words = line.split()
    out = tmp_path / ("page.html" if words[0] == "page" else "out")
    done = CliRunner().invoke(mechsym, [*words, "--out", str(out)])
    assert done.exit_code in (0, 1, 2), done.output
    files = sorted(tmp_path.rglob("*.html"))
    assert files or isinstance(done.exception, BadInput) or words[0] == "cycle"
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

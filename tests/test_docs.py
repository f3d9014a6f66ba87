"""The docs site: what it says to type runs, it builds without a warning, and nothing in it comes from elsewhere."""

import importlib
import json
import os
import re
import runpy
import shlex
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

import mechsym as mechsym_package
from mechsym.cli import COMMANDS, mechsym

DOCS = Path(__file__).parent.parent / "docs"


@pytest.fixture
def pages(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    return importlib.import_module("pages")


def test_every_command_has_an_example_that_is_kept(pages):
    assert COMMANDS.keys() == pages.EXAMPLES.keys() >= pages.BEFORE.keys()
    assert all(f"[{name}]({name}.md)" in pages.commands() for name in COMMANDS)
    for name, kept in pages.EXAMPLES.items():
        assert shlex.split(kept)[0] == name or f"mechsym {name}" in equations().recorded(kept), name
        assert f"$ mechsym {name}" in pages.example(name)


def equations():
    return importlib.import_module("equations")


README = (DOCS.parent / "README.md").read_text(encoding="utf-8")


def test_the_product_is_seen_before_any_benchmark():
    pictures = re.findall(r"!\[[^]]+\]\(([^)]+)\)", README)
    assert pictures[-1] == "benchmarks/chart.svg"
    assert {Path(name).name for name in pictures[:-1]} == {"fourbar.svg", "report.png", "hinge.svg", "workbench.png"}
    assert all((DOCS.parent / name).stat().st_size < 150_000 for name in pictures[:-1])
    assert README.index("An elastic hinge is ") < README.index("41,519")


@pytest.mark.slow
def test_the_moving_pictures_are_what_is_drawn_now():
    drawn = runpy.run_path(str(DOCS / "pictures.py"))
    for name in ("hinge", "fourbar"):
        kept = (DOCS / "pictures" / f"{name}.svg").read_text(encoding="utf-8")
        now = drawn[name]()
        assert re.sub(r"[\d.]+", "", now) == re.sub(r"[\d.]+", "", kept)
        numbers = ([float(n) for n in re.findall(r"\d+\.?\d*", text)] for text in (now, kept))
        assert all(abs(a - b) <= 1.0 for a, b in zip(*numbers, strict=True))  # thousandths of its width


def _codesign(*more):
    done = CliRunner().invoke(mechsym, ["codesign", "zotov-89", *more, "--json"], catch_exceptions=False)
    return json.loads(done.stdout)


@pytest.mark.slow
def test_the_numbers_of_the_readme_are_those_of_its_commands():
    ideal, inside = _codesign(), _codesign("--losses", "inside")
    told = README[README.index("What a co-designed hinge is worth") : README.index("```sh")]
    kg = (ideal["flywheel_inertia_bare"], inside["flywheel_inertia"], ideal["flywheel_inertia"], ideal["total_inertia"],
          ideal["bound"]["total_inertia"][0], ideal["bound"]["estimate"][0])  # fmt: skip
    assert [n for n in (f"{value:,.0f}" for value in kg) if n not in told] == []
    assert f"{100 * max(ideal['losses']['speed_ripple']):.1f} %" in told
    share = inside["losses"]["share"]
    assert f"{100 * min(share):.0f} to {100 * max(share):.0f} % of the torque" in told
    assert f"to {min(inside['misfire_speed_share']):.1g} of its mean" in told


def test_every_public_name_is_told_with_its_units(pages):
    python = importlib.import_module("python_pages")
    left = {*mechsym_package.__all__} - {*python.ROOMS}
    assert [n for room in left for n in getattr(importlib.import_module(f"mechsym.{room}"), "__all__", ())] == []
    for room in python.ROOMS:
        text, module = python.room(room), importlib.import_module(f"mechsym.{room}")
        names = [n for n in getattr(module, "__all__", ()) if type(getattr(module, n)).__name__ != "module"]
        assert [name for name in names if f"## {room}.{name}\n" not in text] == [], room
    assert "[rad/s]" in python.room("machine") and "```{math}" in python.room("hinge")


def test_what_the_theory_shows_is_there(pages):
    """Formulas in docstrings, equations of derivations, kept answers: each once, wherever its file stands."""
    shown = [(p.stem, *m) for p in (DOCS / "theory").glob("*.md")
             for m in re.findall(r"^```\{(\w+)\} (.+)$", p.read_text(encoding="utf-8"), re.M)]  # fmt: skip
    assert len({page for page, *_ in shown}) >= 15
    for page, kind, name in shown:
        if kind == "formula":
            assert "math" in equations().placed(name).doc, page
        elif kind == "recorded":
            assert equations().recorded(name), page
    assert sum(kind == "formula" for _, kind, _ in shown) > 80


def test_extras_are_those_of_the_package():
    extras = tomllib.loads((DOCS.parent / "pyproject.toml").read_text(encoding="utf-8"))["project"][
        "optional-dependencies"
    ]
    told = re.findall(r"^\| `(\w+)` \| ", (DOCS / "start.md").read_text(encoding="utf-8").split("## Extras")[1], re.M)
    assert {*told} == {*extras} - {"heyoka", "bench", "all", "check", "dev"}
    assert f"mechsym-{mechsym_package.__version__}-py3" in (DOCS / "start.md").read_text(encoding="utf-8")


def test_every_key_is_told(pages):
    assert r"| N\*m\*s/rad |" in pages.sections()
    assert "| `bore` | m | \\> 0 | **needed** | cylinder bore |" in pages.sections()


@pytest.mark.slow
def test_every_theory_is_told_with_its_letters(pages):
    text = pages.theories()
    assert text.count("\n## ") == len(pages.catalogue.names()) > 30
    assert "`R_b`" in text and "Quantities: `s`" in text


@pytest.mark.slow
def test_messages_have_their_way_out(pages):
    rows = re.findall(r"^\| (.*) \| (.*) \|$", importlib.import_module("python_pages").messages(), re.M)
    assert len(rows) > 300 and sum(bool(way.strip()) for _, way in rows) > 0.6 * len(rows)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The pages of the site, built."""
    for extra in ("sphinx", "furo", "myst_parser"):
        pytest.importorskip(extra)
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-W", "-q", "-b", "html", str(DOCS), str(folder)]
    outside = {k: v for k, v in os.environ.items() if not k.startswith("PYTEST")}  # the workbench asks for it
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=outside)
    assert done.returncode == 0 and not done.stderr, done.stderr
    return folder


@pytest.mark.slow
@pytest.mark.heavy
def test_a_machine_moves_on_the_first_screen_of_the_site_and_no_page_scrolls_sideways(site):
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    if (chromium := shutil.which("chromium") or shutil.which("chromium-browser")) is None:
        pytest.skip("no chromium is installed")
    pages = ["index.html", "start.html", "errata.html", "tasks.html", "tutorials/engine-designer.html"]
    with playwright.sync_playwright() as running:
        browser = running.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        for width, height in ((1400, 900), (375, 812)):
            tab = browser.new_page(viewport={"width": width, "height": height})
            for page in reversed(pages):
                tab.goto((site / page).as_uri())
                assert tab.evaluate("document.documentElement.scrollWidth") <= width, page
            picture = tab.locator("article img").first
            box = picture.bounding_box()
            assert box["y"] >= 0 and box["y"] + box["height"] <= height
            first = picture.screenshot()
            tab.wait_for_timeout(400)
            assert picture.screenshot() != first
            tab.close()
        browser.close()


@pytest.mark.slow
def test_the_site_builds_without_a_warning_and_is_all_local(site):
    for page in site.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        assert not re.findall(r"<(?:script|link|img)[^>]*(?:src|href)=.https?://", text), page.name
        for link in re.findall(r'(?:href|src)="([^"#?:]+)["#?]', text):
            assert (page.parent / link).exists(), f"{page.name}: {link}"


@pytest.mark.slow
def test_a_number_of_a_result_is_found_by_its_word(pages):
    told = dict(re.findall(r"^(\S.*)\n  (.+)$", pages.glossary(), re.M))
    assert "(max - min) / mean of the speed over the last period" in told["speed ripple"]
    assert "`hinge`" in told["speed ripple"] and "Unit `N`" in told["largest roller reaction"]
    assert len({word.lower() for word in told}) == len(told) > 100 and all("_" not in word for word in told)


def test_the_first_page_shows_a_machine_that_moves():
    first = re.search(r"```\{image\} (\S+)", (DOCS / "index.md").read_text(encoding="utf-8"))
    assert "<animate" in (DOCS / first[1]).read_text(encoding="utf-8")


SCRIPTS = sorted((DOCS / "gallery").glob("*.py"))


@pytest.mark.slow
def test_the_gallery_has_scripts_that_are_told(pages):
    gallery = importlib.import_module("gallery")
    drawn = [name for name in pages.every_case() if pages.drawing(pages.cases.load(name)) is not None]
    assert len(SCRIPTS) + len(drawn) >= 30  # pictures, each with the case that made it
    for script in SCRIPTS:
        title, about, command = gallery.told(script.read_text(encoding="utf-8"))
        assert title and about.endswith(".") and shlex.split(command)[0] == "mechsym", script.name
        assert shlex.split(command)[1] in COMMANDS


def test_a_script_becomes_a_notebook(pages):
    gallery = importlib.import_module("gallery")
    text = SCRIPTS[0].read_text(encoding="utf-8")
    made = json.loads(gallery.notebook(text))
    (code,) = [cell for cell in made["cells"] if cell["cell_type"] == "code"]
    assert made["nbformat"] == 4 and "".join(code["source"]) == gallery.code(text) + "\nfigure"
    compile("".join(code["source"]), "notebook", "exec")


@pytest.mark.slow
@pytest.mark.parametrize("script", SCRIPTS, ids=lambda p: p.stem)
def test_every_script_of_the_gallery_runs(script, pages):
    printed, figure = importlib.import_module("gallery").run(script)
    assert figure.startswith("<svg") and "e-1" not in printed


def test_the_errata_are_a_table(pages):
    findings = importlib.import_module("findings")
    text = (DOCS / "errata.md").read_text(encoding="utf-8")
    rows = findings.entries(text)
    assert len(rows) == len(re.findall(r"^### (?!Remarks)", text, re.M)) > 50
    assert {row["source"] for row in rows} == {"zotov2024", "moroianu2017", "chmielewski2015", "prymak", "nunes2017"}
    assert any("l1*lam/(2*(l1 + l2))*sin(2*phi)" in row["text"].splitlines()[-1] for row in rows)
    page = findings.page(text)
    assert page.count("<tr>") == len(rows) + 1 and "<script>" in page and "http" not in page


WALKED = {"start", "engine"}  # tests/test_docs_runs.py runs them whole
PYTHON_BLOCKS = [
    pytest.param(path, block, id=f"{path.stem}-{k}")
    for path in sorted([*DOCS.glob("*.md"), *(DOCS / "theory").glob("*.md")])
    if path.stem not in WALKED
    for k, block in enumerate(re.findall(r"```python\n(.*?)```", path.read_text(encoding="utf-8"), re.S))
]


@pytest.mark.slow
@pytest.mark.parametrize(("path", "block"), PYTHON_BLOCKS)
def test_every_block_of_python_runs(path, block, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    exec(compile(block, path.name, "exec"), {"__name__": "block"})

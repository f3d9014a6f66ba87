"""Pages that a reader walks through: every block runs in an empty folder, and prints what the page shows."""

import importlib
import re
import shlex
from pathlib import Path

import pytest

from mechsym.cli import COMMANDS

DOCS = Path(__file__).parent.parent / "docs"
PAGES = [DOCS / "start.md", DOCS / "engine.md", *sorted((DOCS / "tutorials").glob("*.md"))]
NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?(?![\w])")
MASKED = re.compile(r"[\d.e-]+ s by the clock|(?<=succeeded, )[\d.]+ s")
_RELATIVE, _NOTHING = 2e-3, 1e-7  # what processors and libraries may differ by, and what is round-off


@pytest.fixture
def walks(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    return importlib.import_module("walks")


def agree(now, kept):
    """Whether two texts have the same words, and numbers that differ by their last digits."""
    now, kept = (MASKED.sub("TIME", text) for text in (now, kept))
    words = [" ".join(NUMBER.sub("#", text).split()) for text in (now, kept)]
    numbers = [[float(n) for n in NUMBER.findall(text)] for text in (now, kept)]
    pairs = zip(*numbers, strict=True)
    return words[0] == words[1] and all(abs(a - b) <= max(_RELATIVE * abs(b), _NOTHING) for a, b in pairs)


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_block_of_a_page_runs_and_prints_what_it_shows(page, walks, tmp_path):
    if "fmu" in page.read_text(encoding="utf-8"):
        pytest.importorskip("fmpy")
    said, kept = dict(walks.walked(page, tmp_path.resolve())), walks.kept(page)
    assert said.keys() == kept.keys()
    assert [line for line in said if not agree(said[line], kept[line])] == []


@pytest.mark.slow
def test_every_example_of_a_command_prints_what_its_page_shows(walks):
    pages = importlib.import_module("pages")
    wrong = []
    for line, lines in walks.examples().items():
        if shlex.split(line)[0] not in ("codesign", "optimise", "study", "app"):  # the heavy suite has these
            wrong += [line] * (not agree(walks.answered(lines), pages.printed(line).partition("\n")[2]))
    assert wrong == []


@pytest.mark.slow
@pytest.mark.heavy
def test_examples_that_take_longer_print_what_their_pages_show(walks):
    pages = importlib.import_module("pages")
    heavy = {line: lines for line, lines in walks.examples().items()
             if shlex.split(line)[0] in ("codesign", "optimise", "study")}  # fmt: skip
    assert len(heavy) == 3  # the workbench does not start below pytest; tests/app has its check
    assert [li for li, ls in heavy.items() if not agree(walks.answered(ls), pages.printed(li).partition("\n")[2])] == []


@pytest.mark.slow
@pytest.mark.parametrize("page", ["engine", pytest.param("codesign", marks=pytest.mark.heavy)])
def test_what_the_prose_of_a_page_quotes_is_what_its_commands_print(page, walks):
    kept = walks.quoted(page)
    assert [line for line in kept if not agree(walks.answered((line,)), kept[line])] == []


def test_texts_agree_by_words_and_digits():
    assert agree("ripple 2.001 % at 60 rpm", "ripple 2.0 %  at 60 rpm") and agree("left 1e-12 J", "left 3e-13 J")
    assert not agree("ripple 2.1 % at 60 rpm", "ripple 2.0 % at 60 rpm")
    assert not agree("ripple 2.0 % at 60 Hz", "ripple 2.0 % at 60 rpm")


TASKS = re.findall(
    r"^\| (.+?) \| \[.+?\]\((.+?)\) \| `(.+?)` \|$", (DOCS / "tasks.md").read_text(encoding="utf-8"), re.M
)


def test_tasks_have_their_pages(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    assert len(TASKS) == 25 == len({task for task, *_ in TASKS})
    for task, page, command in TASKS:
        name = re.fullmatch(r"made/commands/(\w+)\.md", page)
        there = name[1] in COMMANDS if name else page == "made/sections.md" or (DOCS / page).is_file()
        assert there and shlex.split(command)[:1] == ["mechsym"] and shlex.split(command)[1] in COMMANDS, task
        if not name and not page.startswith("made/"):
            text = (DOCS / page).read_text(encoding="utf-8")
            assert shlex.split(command)[1] in text or "mechsym" in text, task


@pytest.mark.slow
@pytest.mark.parametrize(("task", "command"), [(task, command) for task, _, command in TASKS])
def test_the_command_of_a_task_answers_it(task, command, walks, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    cases = Path(importlib.import_module("mechsym").__file__).parent / "cases"
    line = command.replace("{cases}", str(cases)).replace("{examples}", str(DOCS.parent / "examples"))
    assert walks.typed(line, tmp_path, (0, 1)).strip()


@pytest.mark.slow
def test_the_notebooks_of_tutorials_are_valid_and_whole(walks):
    import json

    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        cells = json.loads(walks.notebook(text))["cells"]
        code = [cell for cell in cells if cell["cell_type"] == "code"]
        assert len(code) == len(walks.blocks(text)) > 1


def test_every_picture_of_a_page_is_drawn(walks):
    drawn = [
        page.stem for page in PAGES for one in walks.blocks(page.read_text(encoding="utf-8")) if one["how"] == "picture"
    ]
    assert {"engine-designer", "researcher", "teacher"} <= {*drawn}

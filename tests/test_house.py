"""docs/house.md and CONTRIBUTING.md name files, functions, rooms and make targets that exist."""

import ast
import re

import pytest
from test_layers import ORDER, READS_CASES, ROOT, SYMBOLIC

import mechsym

FORM = "`file.py:function`"
PAGES = ("docs/house.md", "CONTRIBUTING.md")
NAMED = re.compile(r"`([\w./]+\.(?:py|md|toml))(?::(\w+))?`|\]\(([\w./]+\.md)\)")


def bound(node):
    """The names that an assignment binds."""
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
    return [n.id for target in targets for n in ast.walk(target) if isinstance(n, ast.Name)]


def names_of(path):
    """What a file of Python defines at its top."""
    for node in ast.parse(path.read_text()).body:
        yield from [node.name] if isinstance(node, (ast.FunctionDef, ast.ClassDef)) else bound(node)


@pytest.fixture(scope="module")
def pages(pytestconfig):
    return {name: (pytestconfig.rootpath / name).read_text() for name in PAGES}


@pytest.mark.parametrize("page", PAGES)
def test_files_and_functions_exist(page, pages, pytestconfig):
    found = [m for m in NAMED.finditer(pages[page]) if "NAME" not in m[0] and m[0] != FORM]
    assert len(found) > 10
    for m in found:
        path = pytestconfig.rootpath / (m[1] or m[3])
        assert path.is_file(), m[0]
        assert m[2] is None or m[2] in names_of(path), m[0]


@pytest.mark.parametrize("page", PAGES)
def test_every_path_is_held(page, pages):
    """No path in the text that the test above does not read."""
    loose = re.sub(NAMED, "", pages[page])
    assert not re.findall(r"[\w/]+\.py\b", loose.replace("/NAME.py", "").replace(FORM, ""))


ANSWERS = re.findall(
    r"^\| (.+?\?) \| `([\w/]+\.py):(\w+)` \| `(.+)` \|$", (ROOT.parent / "docs/house.md").read_text(), re.M
)


def test_the_questions_of_a_reader_are_answered():
    questions = [question for question, *_ in ANSWERS]
    assert len(set(questions)) == len(questions) >= 24


@pytest.mark.parametrize("question, file, name, words", ANSWERS)
def test_the_answer_stands_where_the_page_says(question, file, name, words):
    text = (ROOT.parent / file).read_text()
    for node in ast.parse(text).body:
        if name == getattr(node, "name", None) or name in bound(node):
            assert words in ast.get_source_segment(text, node), question
            return
    pytest.fail(f"{file} has no {name}")


def test_the_order_is_the_one_that_imports_are_checked_against(pages):
    text = pages["docs/house.md"].partition("## What may import what")[2].partition("- The list")[0]
    (block,) = re.findall(r"((?:^    \w[\w |]*\n)+)", text, re.M)
    assert block.replace("|", " ").split() == list(ORDER)


def test_the_picture_has_every_room(pages):
    picture = pages["docs/house.md"].split("```")[1]
    assert {room for room in ORDER if not re.search(rf"\b{room}\b", picture)} == set()


def test_who_reads_cases_and_who_knows_sympy(pages):
    text = " ".join(pages["docs/house.md"].split())
    assert f"is read in {', '.join(READS_CASES[:-1])} and {READS_CASES[-1]} only" in text
    assert f"sympy is imported in {', '.join(SYMBOLIC[:-1])} and {SYMBOLIC[-1]} only" in text


def test_make_targets_exist(pages, pytestconfig):
    targets = re.findall(r"^([\w-]+):", (pytestconfig.rootpath / "Makefile").read_text(), re.M)
    assert set(re.findall(r"make ([\w-]+)", pages["CONTRIBUTING.md"])) <= set(targets)


def test_the_package_names_its_rooms():
    there = {p.stem for p in ROOT.iterdir() if p.stem in ORDER}
    assert set(mechsym.__all__) <= there
    others = {"cli", "app", "budget", "plausible", "transaction", "interrupts"}  # for commands, and for other rooms
    assert there - set(mechsym.__all__) <= others
    assert {name for name in mechsym.__all__ if getattr(mechsym, name).__name__ != f"mechsym.{name}"} == set()
    assert set(dir(mechsym)) == {*mechsym.__all__, "__version__"}

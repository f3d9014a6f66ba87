"""Arrows run down only: one ordered list of rooms, for every import, hidden or not, and every text "module:name"."""

import ast
import functools
import re
import subprocess
import sys
from pathlib import Path

import pytest

import mechsym

ROOT = Path(mechsym.__file__).parent
OUTSIDE = ("generated", "derivations")  # plain functions and declarations: no room
FILES = sorted(p for p in ROOT.rglob("*.py") if not set(OUTSIDE) & set(p.parts))
# each room may import what stands before it; docs/house.md says what is in each
ORDER = (
    "errors quantities budget interrupts transaction files periodic style page plausible "
    "derive convert native mechanisms cycle sizing machine simulate hinge torsion forces optimise proof codesign "
    "cases jobs report sweep audit papers out app cli"
).split()
SYMBOLIC = ("derive", "convert", "audit", "papers")
READS_CASES = ("cases", "jobs", "report", "sweep", "papers", "app", "cli")
PLAIN = {"mechsym.cases.numbers.numbers", "mechsym.cases.numbers.usual"}  # numbers by letter, no case
_TEXT = re.compile(r"mechsym(?:\.\w+)+(?::\w+)")


def room(path):
    return path.relative_to(ROOT).parts[0].removesuffix(".py")


each_room = pytest.mark.parametrize(
    "name, paths", [(r, [p for p in FILES if room(p) == r]) for r in sorted({*map(room, FILES)})]
)


def imported(tree):
    """Full names of modules that a file imports anywhere, or names in a text "module:name"."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (a.name for a in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert not node.level, "imports are absolute, so that they can be followed"
            yield from (f"{node.module}.{a.name}" for a in node.names)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and _TEXT.fullmatch(node.value):
            yield node.value.partition(":")[0]


@functools.cache
def imports(path):
    return frozenset(imported(ast.parse(path.read_text())))


def rooms_above(name, wanted):
    """Rooms of the modules `wanted` that a file of the room `name` may not import; an unknown room is above all."""
    found = {m.split(".")[1] for m in wanted if m.startswith("mechsym.")} - {name, *OUTSIDE}
    below = ORDER[: ORDER.index(name)] if name in ORDER else []
    return sorted(found - set(below) - ({"__version__"} if name == "cli" else set()))


@each_room
def test_arrows_run_down(name, paths):
    if name not in ("__init__", "__main__"):
        assert name in ORDER, f"room {name} is not in the list; where does it stand?"
        for path in paths:
            assert not (found := rooms_above(name, imports(path))), f"{path} imports {found}"


@pytest.mark.parametrize("name", ORDER[:-1])
def test_an_arrow_upwards_is_seen(name):
    above = ORDER[ORDER.index(name) + 1]
    for text in (
        f"from mechsym import {above}",
        f"from mechsym.{above} import x",
        f"import mechsym.{above}",
        f"def f():\n    from mechsym.{above}.y import x",
        f"from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import mechsym.{above}",
        f"x = 'mechsym.{above}.y:Z'",
    ):
        assert rooms_above(name, imported(ast.parse(text))) == [above], text


@each_room
def test_sympy_stays_in_its_rooms(name, paths):
    if name not in SYMBOLIC:
        for path in paths:
            assert not [m for m in imports(path) if m.split(".")[0] in ("sympy", "mpmath")], path


@each_room
def test_only_the_upper_rooms_read_cases(name, paths):
    if name not in (*READS_CASES, "__init__", "__main__"):
        for path in paths:
            assert not {m for m in imports(path) if m.startswith("mechsym.cases")} - PLAIN, path


def modules():
    """Dotted name of every module with the modules it imports, packages included as their parts import them."""
    known = {
        ".".join(("mechsym", *p.relative_to(ROOT).with_suffix("").parts)).removesuffix(".__init__"): p for p in FILES
    }
    arrows = {}
    for name, path in known.items():
        targets = set()
        for wanted in imports(path):
            while wanted not in known and "." in wanted:
                wanted = wanted.rpartition(".")[0]
            targets.add(wanted)
        arrows[name] = {
            t for t in targets if t in known and t not in (name, "mechsym") and not name.startswith(f"{t}.")
        }
    return arrows


def test_no_import_circle():
    """Not even one that is hidden in functions. A package may import its parts, and its parts one another."""
    arrows, finished = modules(), set()

    def visit(name, trail):
        assert name not in trail, " -> ".join([*trail[trail.index(name) :], name])
        if name not in finished:
            for target in sorted(arrows[name]):
                visit(target, [*trail, name])
            finished.add(name)

    for name in arrows:
        visit(name, [])


def test_few_entries_and_unique_names():
    entries = {p.name.removesuffix(".py") for p in ROOT.iterdir() if p.suffix in ("", ".py")}
    assert entries - {"__init__", "__main__", "templates", "py", "__pycache__", *OUTSIDE} <= set(ORDER)
    owners = {}
    for path in FILES:
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, ast.ClassDef):
                owners.setdefault(node.name, []).append(str(path.relative_to(ROOT)))
    twice = {name: files for name, files in owners.items() if len(files) > 1}
    assert not twice, f"one word, one meaning: {twice}"


def test_import_of_the_package_is_light():
    code = (
        "import sys, mechsym; sys.exit(bool({'sympy', 'matplotlib', 'scipy.integrate', 'jinja2'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0

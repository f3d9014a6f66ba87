"""Docstrings say what signatures do not: units and shapes always, never a repetition; and sizes stay readable.

Every float or array that a public function takes or gives, and every such field of a record, has its unit in brackets.
An entry without a unit or shape and of five words or fewer repeats its name and is refused.
"""

import ast
import functools
import re
from pathlib import Path

import pytest

import mechsym

ROOT = Path(mechsym.__file__).parent
FILES = sorted(p for p in ROOT.rglob("*.py") if "generated" not in p.parts and "derivations" not in p.parts)
UNIT = re.compile(r"\[[^\]]+\]")
NUMBER = re.compile(r"\b(float|ndarray)\b")
NAMED = re.compile(r"Mapping|dict|Callable|Sequence\[tuple")  # the unit belongs to each name
KEEPS_TEMPLATE = ("derive",)  # its text is stamped into generated/


def room(path):
    return path.relative_to(ROOT).parts[0].removesuffix(".py")


each_room = pytest.mark.parametrize(
    "paths", [[p for p in FILES if room(p) == r] for r in sorted({*map(room, FILES)})], ids=sorted({*map(room, FILES)})
)


@functools.cache
def parsed(path):
    return ast.parse(path.read_text())


def public_functions(tree):
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            yield node.name, node
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            for inner in node.body:
                if isinstance(inner, ast.FunctionDef) and not inner.name.startswith("_"):
                    yield f"{node.name}.{inner.name}", inner


def is_command(node):
    return any("command" in ast.unparse(d) or "group" in ast.unparse(d) for d in node.decorator_list)


def section(doc, title):
    match = re.search(rf"^{title}\n-+\n(.*?)(?=^\S[^\n]*\n-+\n|\Z)", doc, re.S | re.M)
    return match[1] if match else ""


def arguments(node):
    a = node.args
    named = [*a.posonlyargs, *a.args, *a.kwonlyargs, *([a.vararg] if a.vararg else []), *([a.kwarg] if a.kwarg else [])]
    return {x.arg: ast.unparse(x.annotation) if x.annotation else "" for x in named if x.arg not in ("self", "cls")}


def entries(text):
    """Names, type and description of each entry of a section."""
    found = []
    for line in text.splitlines():
        if line and not line.startswith(" "):
            names, _, kind = line.partition(" : ")
            found.append([[n.strip().lstrip("*") for n in names.split(",")], kind, ""])
        elif found:
            found[-1][2] += line + "\n"
    return found


def is_noise(kind, about):
    return not UNIT.search(about) and "shape" not in kind and len(about.split()) <= 5


def in_words(doc):
    """What stands before the first section."""
    return re.split(r"^\S[^\n]*\n-{3,}\n", doc, flags=re.M)[0]


@each_room
def test_docstrings_say_what_signatures_do_not(paths):
    for path in paths:
        says_what_signatures_do_not(path)


def says_what_signatures_do_not(path):
    tree = parsed(path)
    assert path.name == "__main__.py" or ast.get_docstring(tree), f"{path.name} has no module docstring"
    for name, node in public_functions(tree):
        doc = ast.get_docstring(node)
        assert doc, f"{path}: {name} has no docstring"
        if is_command(node):
            continue
        taken, given = entries(section(doc, "Parameters")), entries(section(doc, "Returns"))
        unknown = {n for names, _, _ in taken for n in names} - set(arguments(node))
        assert not unknown, f"{path}: {name}: the docstring tells of {sorted(unknown)}, the signature does not"
        if path.relative_to(ROOT).parts[0] not in KEEPS_TEMPLATE:
            noise = [names for names, kind, about in taken + given if is_noise(kind, about)]
            assert not noise, f"{path}: {name}: {noise} repeat the signature; say what it does not, or nothing"


@each_room
def test_numbers_carry_a_unit(paths):
    for path in paths:
        carries_units(path)


def carries_units(path):
    for name, node in public_functions(parsed(path)):
        if is_command(node):
            continue
        doc = ast.get_docstring(node) or ""
        told = {n for names, _, about in entries(section(doc, "Parameters")) if UNIT.search(about) for n in names}
        numbers = {n for n, kind in arguments(node).items() if NUMBER.search(kind) and not NAMED.search(kind)}
        silent = set() if UNIT.search(in_words(doc)) else numbers - told
        assert not silent, f"{path}: {name}: {sorted(silent)} without unit in brackets"
        for names, kind, about in entries(section(doc, "Returns")):
            if kind.startswith(("float", "ndarray")):
                assert UNIT.search(about), f"{path}: {name}: {names} without unit in brackets"


def silent_fields(node, lines):
    """Fields of numbers with no unit in their `quantity`, beside them, or in the lines above their group."""
    group = ""
    for field in (f for f in node.body if isinstance(f, ast.AnnAssign)):
        above = lines[field.lineno - 2].strip()
        beside = lines[field.end_lineno - 1].partition("#:")[2]
        group = above if above.startswith("#:") else "" if beside else group
        own = field.value is not None and "quantity(" in ast.unparse(field.value)
        kind = ast.unparse(field.annotation)
        if NUMBER.search(kind) and not NAMED.search(kind):
            block = group
            for line in reversed(lines[: field.lineno - 1]):
                if not line.strip().startswith("#:"):
                    break
                block += line
            if not own and not UNIT.search(block + beside):
                yield field.target.id


@each_room
def test_fields_carry_a_unit(paths):
    for path in paths:
        if room(path) in KEEPS_TEMPLATE:
            return
        lines = path.read_text().splitlines()
        for node in ast.walk(parsed(path)):
            if isinstance(node, ast.ClassDef) and any("record" in ast.unparse(d) for d in node.decorator_list):
                assert not (silent := list(silent_fields(node, lines))), f"{path}: {node.name}: {silent} without unit"


@each_room
def test_sizes_stay_readable(paths):
    for path in paths:
        assert path.read_text().count("\n") <= 300, f"{path} is too long; split it"
        for node in ast.walk(parsed(path)):
            if isinstance(node, ast.FunctionDef):
                body = node.body[1:] if ast.get_docstring(node) else node.body
                assert not body or body[-1].end_lineno - body[0].lineno < 40, f"{path}: {node.name} is too long"

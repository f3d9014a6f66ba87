"""Public functions: every parameter stands in the docstring, nothing else does, and units stand in brackets."""

import ast
import re
from pathlib import Path

import pytest

import mechsym

ROOT = Path(mechsym.__file__).parent
FILES = sorted(p for p in ROOT.rglob("*.py") if "generated" not in p.parts and "derivations" not in p.parts)


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


def documented(text):
    names = []
    for line in re.findall(r"^(\S.*?)(?: : .*)?$", text, re.M):
        names += [n.strip().lstrip("*") for n in line.split(",")]
    return names


def arguments(node):
    a = node.args
    named = [*a.posonlyargs, *a.args, *a.kwonlyargs, *([a.vararg] if a.vararg else []), *([a.kwarg] if a.kwarg else [])]
    return [x.arg for x in named if x.arg not in ("self", "cls")]


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(ROOT)))
def test_docstrings_match_signatures(path):
    tree = ast.parse(path.read_text())
    assert path.name == "__main__.py" or ast.get_docstring(tree), f"{path.name} has no module docstring"
    for name, node in public_functions(tree):
        doc = ast.get_docstring(node)
        assert doc, f"{name} has no docstring"
        if is_command(node):
            continue
        assert sorted(documented(section(doc, "Parameters"))) == sorted(arguments(node)), (
            f"{name}: docstring and signature differ"
        )
        returns = node.returns is not None and ast.unparse(node.returns) != "None"
        assert not returns or section(doc, "Returns") or section(doc, "Yields"), f"{name}: no Returns section"


def entries(text):
    """Name, type and description of each entry of a section."""
    found = []
    for line in text.splitlines():
        if line and not line.startswith(" "):
            name, _, kind = line.partition(" : ")
            found.append([name, kind, ""])
        elif found:
            found[-1][2] += line + "\n"
    return found


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(ROOT)))
def test_numbers_carry_a_unit(path):
    for name, node in public_functions(ast.parse(path.read_text())):
        doc = ast.get_docstring(node) or ""
        for title in ("Parameters", "Returns"):
            for entry, kind, about in entries(section(doc, title)):
                if kind.startswith(("float", "ndarray")):
                    assert re.search(r"\[[^\]]+\]", about), f"{name}: {entry} has no unit in brackets"


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(ROOT)))
def test_sizes_stay_readable(path):
    text = path.read_text()
    assert text.count("\n") <= 300, f"{path.name} is too long; split it"
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef):
            body = node.body[1:] if ast.get_docstring(node) else node.body
            assert not body or body[-1].end_lineno - body[0].lineno < 40, f"{node.name} is too long"

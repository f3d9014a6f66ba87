"""No table of names: a mechanism is known by its declaration, and by its own module where it has more to say."""

import ast
import functools
import re
from pathlib import Path

import mechsym
from mechsym.mechanisms import traits

ROOT = Path(mechsym.__file__).parent
#: Rooms that may name mechanisms: data files, papers, and the theories that formulas of papers are held against
NAMED = ("cases", "papers", "audit", "generated", "derivations")
FILES = [p for p in sorted(ROOT.rglob("*.py")) if p.relative_to(ROOT).parts[0] not in NAMED]


@functools.cache
def written(path):
    return path.read_text()


def holding(words):
    """Files outside the modules of the mechanisms that hold one of the words anywhere, taken apart."""
    own, any_of = own_files(), re.compile("|".join(words))
    return {
        str(p.relative_to(ROOT)): ast.parse(written(p)) for p in FILES if p not in own and any_of.search(written(p))
    }


def texts(tree):
    """Every text of a file that is no docstring."""
    told = set()
    for node in ast.walk(tree):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and ast.get_docstring(node) is not None:
            told.add(id(node.body[0].value))
    return {n.value for n in ast.walk(tree) if isinstance(n, ast.Constant) and id(n) not in told}


def asked(tree):
    """Classes of an `isinstance`, and fields of a `hasattr`."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("isinstance", "hasattr"):
            yield from (n.id for n in ast.walk(node.args[1]) if isinstance(n, ast.Name))
            yield from (n.value for n in ast.walk(node.args[1]) if isinstance(n, ast.Constant))


def own_files():
    """Modules of the built-in mechanisms: each may name what it is and what it is made of."""
    room = ROOT / "mechanisms"
    return {p for name in traits.packaged() for p in (*room.glob(f"{name}*.py"), *room.glob(f"{name}/*.py"))}


def test_no_name_of_a_mechanism_stands_outside_its_module():
    names = set(traits.packaged())
    assert {"crosshead", "crank_train", "rodless"} <= names
    # as a text of its own: in quotes
    quoted = holding([f"[\"']{name}[\"']" for name in names])
    assert {path: found for path, tree in quoted.items() if (found := texts(tree) & names)} == {}


def test_no_class_of_a_mechanism_is_asked_for():
    classes = {t.parameters.__name__ for name in traits.packaged() if (t := traits.traits_of(name))}
    found = {path: set(asked(tree)) & classes for path, tree in holding(classes).items()}
    assert {path: here for path, here in found.items() if here} == {}


def test_a_name_in_a_table_is_seen():
    assert "crosshead" in texts(ast.parse('"""crosshead."""\nX = {"crosshead": 1}'))
    assert "crosshead" not in texts(ast.parse('"""crosshead"""\ndef f():\n    "crosshead"'))
    assert {"A", "b"} <= set(asked(ast.parse("isinstance(x, A | B)\nhasattr(x, 'b')")))

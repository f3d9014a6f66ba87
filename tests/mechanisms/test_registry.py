"""No table of names: a mechanism is known by its declaration, and by its own module where it has more to say."""

import ast
import functools
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import mechsym
from mechsym.mechanisms import own, parameters_class

ROOT = Path(mechsym.__file__).parent
#: Rooms that may name mechanisms: data files, papers, and the theories that formulas of papers are held against
NAMED = ("cases", "papers", "audit", "generated", "derivations")
FILES = [p for p in sorted(ROOT.rglob("*.py")) if p.relative_to(ROOT).parts[0] not in NAMED]


@functools.cache
def written(path):
    return path.read_text()


def holding(words):
    """Files outside the modules of the mechanisms that hold one of the words anywhere, taken apart."""
    modules, any_of = own_files(), re.compile("|".join(words))
    return {
        str(p.relative_to(ROOT)): ast.parse(written(p)) for p in FILES if p not in modules and any_of.search(written(p))
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
    return {p for name in own.packaged() for p in (*room.glob(f"{name}*.py"), *room.glob(f"{name}/*.py"))}


def test_no_name_of_a_mechanism_stands_outside_its_module():
    names = set(own.packaged())
    assert {"crosshead", "crank_train", "rodless"} <= names
    # as a text of its own: in quotes
    quoted = holding([f"[\"']{name}[\"']" for name in names])
    assert {path: found for path, tree in quoted.items() if (found := texts(tree) & names)} == {}


def test_no_class_of_a_mechanism_is_asked_for():
    classes = {parameters_class(name).__name__ for name in own.packaged()}
    found = {path: set(asked(tree)) & classes for path, tree in holding(classes).items()}
    assert {path: here for path, here in found.items() if here} == {}


def test_a_name_in_a_table_is_seen():
    assert "crosshead" in texts(ast.parse('"""crosshead."""\nX = {"crosshead": 1}'))
    assert "crosshead" not in texts(ast.parse('"""crosshead"""\ndef f():\n    "crosshead"'))
    assert {"A", "b"} <= set(asked(ast.parse("isinstance(x, A | B)\nhasattr(x, 'b')")))


ALL = """
import json, sys
from pathlib import Path
from mechsym import cases, mechanisms
from mechsym.jobs.forces import forces, reported, write
from mechsym.quantities.results import tell
assert Path(mechanisms.__file__).is_relative_to(Path.cwd()), mechanisms.__file__
case = cases.load("yoke", {f"friction.{k}": v for k, v in json.loads(sys.argv[1]).items()})
found = forces(case)
told = tell(reported(case, found))
told["drawn"] = sorted(p.name for p in write(case, found, told, Path("out")))
told["known"] = mechanisms.names()
print(json.dumps(told))
"""


@pytest.mark.slow
@pytest.mark.heavy
def test_a_declaration_and_a_case_are_all_that_a_mechanism_takes(pytestconfig, tmp_path):
    """Beside the package's own ones: generated, evaluated, turned with gas, its friction told, drawn."""
    for folder in ("mechsym", "generated", "derivations"):
        skipped = shutil.ignore_patterns("__pycache__")
        shutil.copytree(pytestconfig.rootpath / folder, tmp_path / folder, ignore=skipped)
    given = pytestconfig.rootpath / "examples/mechanisms"
    text = (given / "scotch_yoke.py").read_text().replace("scotch_yoke", "yoke")
    place = '    m.guide("slot", reaction="R_n_S", travel=r * sin(phi))\n    return m'
    text = text.replace("    return m", place).replace("Mechanism, pi", "Mechanism, pi, sin")
    (tmp_path / "derivations/yoke.py").write_text(text)
    case = (given / "scotch-yoke.toml").read_text().replace('"./scotch_yoke.py"', '"yoke"\nsource = "own"')
    (tmp_path / "mechsym/cases/yoke.toml").write_text(case)

    def run(*line):
        here = os.environ | {"PYTHONPATH": str(tmp_path)}
        return subprocess.run([sys.executable, "-P", *line], cwd=tmp_path, env=here, capture_output=True, text=True)

    derived = run("-m", "mechsym", "derive", "yoke")
    assert (derived.returncode, derived.stdout.split()) == (
        0,
        ["written:", "yoke.py", "written:", "equations/yoke.json"],
    )
    again = run("-m", "mechsym", "derive", "yoke", "--check")
    assert again.returncode == 0, again.stdout
    sizes = {"mu_guide": 0.1, "mu_pin": 0.01, "mu_main": 0.01, "radius_piston_pin": 0.1, "radius_crank_pin": 0.1,
             "radius_main": 0.1}  # fmt: skip
    shown = run("-c", ALL, json.dumps(sizes))
    assert shown.returncode == 0, shown.stderr
    told = json.loads(shown.stdout)
    assert {"yoke", "crosshead", "crank_train"} <= set(told["known"])
    assert told["power_residual"] < 1e-9
    assert told["min"]["R_n_S"] < -1e5  # the gas pushes the yoke back on the pin
    assert told["friction"]["places"]["slot"] > 1e3
    assert {"forces.csv", "mechanism.svg", "mechanism.html"} <= set(told["drawn"])

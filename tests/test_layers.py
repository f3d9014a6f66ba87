"""Data flows one way: who may import sympy, and what an import of the package loads."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import mechsym

ROOT = Path(mechsym.__file__).parent
FILES = sorted(p for p in ROOT.rglob("*.py") if "generated" not in p.parts)


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(ROOT)))
def test_sympy_stays_in_its_rooms(path):
    if path.relative_to(ROOT).parts[0] not in ("derive", "audit", "papers", "derivations"):
        modules = [a.name for n in ast.walk(ast.parse(path.read_text())) if isinstance(n, ast.Import) for a in n.names]
        assert not [m for m in modules if m.split(".")[0] in ("sympy", "mpmath")]


def test_import_of_the_package_is_light():
    code = (
        "import sys, mechsym; sys.exit(bool({'sympy', 'matplotlib', 'scipy.integrate', 'jinja2'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0

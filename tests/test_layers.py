"""Data flows one way: which part of the package may import which, and who may import sympy."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import mechsym

ROOT = Path(mechsym.__file__).parent
FILES = sorted(p for p in ROOT.rglob("*.py") if "generated" not in p.parts)
# part: parts that it must not import, because they stand after it in the flow of data
FORBIDDEN = {
    "quantities": {"*"},
    "files": {"*"},
    "mechanism": {"mechanisms", "hinge", "guide", "engine", "simulate", "design", "report", "plots", "cli", "cases"},
    "mechanisms": {"hinge", "guide", "engine", "simulate", "design", "report", "plots", "cli", "cases"},
    "engine": {"mechanism", "mechanisms", "hinge", "guide", "simulate", "design", "report", "plots", "cli", "cases"},
    "sizing": {"mechanisms", "hinge", "guide", "design", "cli"},
    "hinge": {"guide", "simulate", "design", "report", "plots", "cli", "cases"},
    "guide": {"simulate", "design", "report", "plots", "cli", "cases"},
    "simulate": {"design", "report", "plots", "cli", "cases"},
    "derive": {
        "generated",
        "mechanism",
        "mechanisms",
        "hinge",
        "guide",
        "engine",
        "simulate",
        "design",
        "cli",
        "cases",
    },
    "design": {"report", "plots", "cli"},
}
ALLOWED_EVERYWHERE = {"errors"}


def imported(path):
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (a.name for a in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
            yield from (f"{node.module}.{a.name}" for a in node.names if node.module == "mechsym")


def part(path):
    return path.relative_to(ROOT).parts[0].removesuffix(".py")


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(ROOT)))
def test_imports_follow_the_flow_of_data(path):
    forbidden = FORBIDDEN.get(part(path), set())
    found = {m.split(".")[1] for m in imported(path) if m.startswith("mechsym.")} - ALLOWED_EVERYWHERE - {part(path)}
    assert not (found & forbidden or ("*" in forbidden and found)), f"{part(path)} imports {sorted(found)}"


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(ROOT)))
def test_sympy_stays_in_derive_and_audit(path):
    if part(path) not in ("derive", "audit"):
        assert not [m for m in imported(path) if m.split(".")[0] in ("sympy", "mpmath")]


def test_import_of_the_package_is_light():
    code = (
        "import sys, mechsym; sys.exit(bool({'sympy', 'matplotlib', 'scipy.integrate', 'jinja2'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0

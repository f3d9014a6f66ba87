"""Arrows between the drawers of the auditor run one way."""

import ast
from pathlib import Path

import mechsym.audit

ROOT = Path(mechsym.audit.__file__).parent
ORDER = ("read", "theory", "judge", "repair", "verdict", "row", "hosts")


def test_a_drawer_imports_from_those_before_it():
    files = [p for p in ROOT.rglob("*.py") if p.parent != ROOT or p.stem in ORDER]
    assert {p.relative_to(ROOT).parts[0].removesuffix(".py") for p in files} == set(ORDER)
    wrong = []
    for path in files:
        own = ORDER.index(path.relative_to(ROOT).parts[0].removesuffix(".py"))
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("mechsym.audit."):
                other = node.module.split(".")[2]
                if ORDER.index(other) > own:
                    wrong.append(f"{path.relative_to(ROOT)} -> {other}")
    assert not wrong

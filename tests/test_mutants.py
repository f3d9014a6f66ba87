"""`make mutate`: every change gives another text that still compiles; a module without tests is refused."""

import ast
import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[1]))

from fuzz.mutants import ROOT, main, mutant, places  # noqa: E402

TEXT = """def f(x: float = 2.0, /) -> int:
    if x > 0 and x != 3:
        return -x + 4**x
    return 0 if x == 1 else x * 1
"""


def test_changes_of_a_function():
    tree = ast.parse(TEXT)
    found = [mutant(tree, *place)[1].partition(": ")[2] for place in places(tree)]
    assert sorted(found) == sorted([
        "2.0 -> 2.2", "not (x > 0 and x != 3)", "x > 0 and x != 3 -> x > 0 or x != 3", "x > 0 -> x <= 0",
        "x != 3 -> x == 3", "0 -> 1", "3 -> 3.3000000000000003", "-x + 4 ** x -> -x - 4 ** x", "-x -> +x",
        "4 ** x -> 4 * x", "4 -> 4.4", "not (x == 1)", "0 -> 1", "x == 1 -> x != 1", "1 -> 0", "x * 1 -> x / 1",
        "1 -> 0",
    ])  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", ["hinge/springs/air", "hinge/guide", "files/inputs"])
def test_every_mutant_compiles_and_differs(name):
    tree = ast.parse((ROOT / "mechsym" / f"{name}.py").read_text(encoding="utf-8"))
    whole, found = ast.unparse(tree), places(tree)
    assert len(found) > 10
    for place in found:
        text, change = mutant(tree, *place)
        assert text != whole, change
        compile(text, name, "exec")


@pytest.mark.parametrize("arguments", [[], ["mechsym.no.module"], ["mechsym.hinge.springs.air", "--tests", "tests/no"]])
def test_what_is_not_there_is_refused(arguments, capsys):
    assert main(arguments) == 2
    assert capsys.readouterr().err.count("\n") == 1

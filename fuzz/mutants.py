"""python -m fuzz.mutants MODULE [COUNT [SEED]]: how many small mistakes in a module its room's tests notice.

A mutant is a copy of the tree with one change: a sign, an operator, a comparison, a constant, a condition, a result.
The tests are those of the folder in tests/ that has the room's name; others with --tests "PATH PATH..".
"""

import ast
import copy
import importlib
import multiprocessing
import os
import random
import resource
import shutil
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NoReturn

import pytest

ROOT = Path(__file__).parent.parent
# imported once, so that the tests of a mutant start at once
WARM = ("numpy", "scipy.optimize", "scipy.integrate", "scipy.interpolate", "sympy", "casadi", "click")
LIMIT = 300  # time of a processor that the tests may take: a mutant that hangs is noticed [s]
_OPERATORS: dict[type[ast.AST], type[ast.AST]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult, ast.FloorDiv: ast.Div,
    ast.Lt: ast.GtE, ast.GtE: ast.Lt, ast.Gt: ast.LtE, ast.LtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.And: ast.Or, ast.Or: ast.And,
}  # fmt: skip


def places(tree: ast.AST) -> list[tuple[int, str]]:
    """Where a change can be made: number of the node in the order of `ast.walk`, and what is done there."""
    annotations = {id(n) for a in _annotations(tree) for n in ast.walk(a)}
    found = []
    for i, node in enumerate(ast.walk(tree)):
        if id(node) in annotations:
            continue
        if isinstance(node, ast.BinOp | ast.BoolOp) and type(node.op) in _OPERATORS:
            found.append((i, "operator"))
        elif isinstance(node, ast.Compare) and type(node.ops[0]) in _OPERATORS:
            found.append((i, "comparison"))
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            found.append((i, "sign"))
        elif isinstance(node, ast.Constant) and type(node.value) in (int, float):
            found.append((i, "constant"))
        elif isinstance(node, ast.If | ast.IfExp):
            found.append((i, "condition"))
    return found


def _annotations(tree: ast.AST) -> Iterator[ast.AST]:
    for node in ast.walk(tree):
        for name in ("annotation", "returns"):
            if getattr(node, name, None) is not None:
                yield getattr(node, name)


def mutant(tree: ast.Module, place: int, kind: str) -> tuple[str, str]:
    """The text of a module with one change, and the change in words."""
    tree = copy.deepcopy(tree)
    node = list(ast.walk(tree))[place]
    line, before = getattr(node, "lineno", 0), ast.unparse(node)
    if isinstance(node, ast.BinOp | ast.BoolOp):
        node.op = _OPERATORS[type(node.op)]()  # type: ignore[assignment]
    elif isinstance(node, ast.Compare):
        node.ops[0] = _OPERATORS[type(node.ops[0])]()  # type: ignore[call-overload]
    elif isinstance(node, ast.UnaryOp):
        node.op = ast.UAdd()
    elif isinstance(node, ast.Constant):
        node.value = 1 if node.value == 0 else 0 if node.value == 1 else node.value * 1.1  # type: ignore[operator]
    elif isinstance(node, ast.If | ast.IfExp):
        before = ast.unparse(node.test)
        node.test = ast.UnaryOp(op=ast.Not(), operand=node.test)
        return ast.unparse(ast.fix_missing_locations(tree)), f"line {line}: not ({before})"
    return ast.unparse(ast.fix_missing_locations(tree)), f"line {line}: {before} -> {ast.unparse(node)}"


def main(arguments: list[str]) -> int:
    """Run and print the share that is noticed; 2 where the module or its tests are not there or fail unchanged."""
    tests = ""
    if "--tests" in arguments[:-1]:
        at = arguments.index("--tests")
        tests = arguments[at + 1]
        del arguments[at : at + 2]
    name, count, seed = (*arguments, *("", "30", "1")[len(arguments) :])[:3]
    file = ROOT / f"{name.replace('.', '/')}.py"
    tests = tests or _of(name)
    if not file.is_file() or not all((ROOT / path).exists() for path in tests.split()):
        print(f"{name}: no such module, or no {tests}; write for example mechsym.hinge.springs", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as folder:
        return _run(file.relative_to(ROOT), tests, int(count), random.Random(seed), Path(folder) / "tree")


def _of(name: str) -> str:
    """The tests of a module: its own file first, where the most mistakes are noticed soonest, then its room."""
    room = f"tests/{name.split('.')[1] if name.count('.') else ''}"
    own = f"{room}/test_{name.rpartition('.')[2]}.py"
    return f"{own} {room}" if (ROOT / own).is_file() else room


def _run(file: Path, tests: str, count: int, rng: random.Random, copy_of: Path) -> int:
    ignored = shutil.ignore_patterns(".venv", ".git", "__pycache__", ".*_cache", "*.egg-info")
    for module in WARM:
        importlib.import_module(module)
    shutil.copytree(ROOT, copy_of, ignore=ignored, symlinks=True)
    tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
    # written as a mutant is, without comments: a test that reads those would notice every mutant
    (copy_of / file).write_text(ast.unparse(tree), encoding="utf-8")
    if not _passes(copy_of, tests):
        print(f"{tests} fails without any change", file=sys.stderr)
        return 2
    possible = places(tree)
    chosen = rng.sample(possible, min(count, len(possible)))
    killed = 0
    for done, (place, kind) in enumerate(chosen, 1):
        text, change = mutant(tree, place, kind)
        (copy_of / file).write_text(text, encoding="utf-8")
        survives = _passes(copy_of, tests)
        killed += not survives
        # one line for each as it comes, so that nothing is lost where the run is cut
        print(f"{killed} of {done}{' not noticed:' if survives else ''} {file} {change}", flush=True)
    print(f"{file}: {killed} of {len(chosen)} mutants noticed by {tests} ({100 * killed / len(chosen):.0f} %)")
    return 0


def _passes(folder: Path, tests: str) -> bool:
    child = multiprocessing.get_context("fork").Process(target=_test, args=(folder, tests))
    child.start()
    child.join()
    return child.exitcode == 0


def _test(folder: Path, tests: str) -> NoReturn:
    """Run the tests in this process, forked off one that has imported everything but the package."""
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT))
    quiet = os.open(os.devnull, os.O_RDWR)
    for handle in (0, 1, 2):
        os.dup2(quiet, handle)
    os.chdir(folder)
    sys.path.insert(0, str(folder))  # the copy stands before the installed package
    sys.dont_write_bytecode = True
    os.environ |= {"PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
    os._exit(pytest.main(["-x", "-q", "-n", "0", "-m", "not slow", "-p", "no:cacheprovider", *tests.split()]))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

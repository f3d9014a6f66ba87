"""python -m fuzz.mutants NAME [COUNT [SEED]]: how many small mistakes in a module, a room or all the tests notice.

A mutant is a copy of the tree with one change: a sign, an operator, a comparison, a constant, a condition, a result.
NAME is `mechsym.hinge.guide`, `mechsym.hinge` or `mechsym`; of each module COUNT changes are tried (30). The tests are
those of the folder in tests/ that has the room's name; others with --tests "PATH PATH..".

What came out stands in build/mutants, a line each as it comes, and the same command goes on where it stopped: a change
that was noticed is not tried again while its module stays, one that was not is tried again with other tests. With
--moves "PATTERN PATTERN.." (see tests.matrix) it says which printed numbers each change moves that is not noticed.
"""

import argparse
import ast
import copy
import hashlib
import importlib
import json
import multiprocessing
import os
import random
import resource
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NoReturn

import pytest

ROOT = Path(__file__).parent.parent
# imported once, so that the tests of a mutant start at once
WARM = ("numpy", "scipy.optimize", "scipy.integrate", "scipy.interpolate", "sympy", "casadi", "click")
LIMIT = 300  # time of a processor that the tests may take: a mutant that hangs is noticed [s]
Row = dict[str, Any]  # a change, whether it was noticed, and what of
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
    """Run and print the share that is noticed; 2 where the modules or their tests are not there or fail unchanged."""
    parser = argparse.ArgumentParser(prog="python -m fuzz.mutants")
    parser.add_argument("name", nargs="?", default="")
    parser.add_argument("count", nargs="?", type=int, default=30)
    parser.add_argument("seed", nargs="?", default="1")
    parser.add_argument("--tests", default="")
    parser.add_argument("--moves", default="")
    asked = parser.parse_args(arguments)
    modules = [file for file in _modules(asked.name) if places(_tree(file))]
    tests = {file: asked.tests or _of(file) for file in modules}
    missing = {path for paths in tests.values() for path in paths.split() if not (ROOT / path).exists()}
    if not modules or missing:
        print(f"{asked.name}: no such module, or no {' '.join(missing)}; write for example mechsym.hinge.guide or "
              "mechsym.hinge", file=sys.stderr)  # fmt: skip
        return 2
    for module in WARM:
        importlib.import_module(module)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        copy_of = Path(folder) / "tree"
        ignored = shutil.ignore_patterns(".venv", ".git", "__pycache__", ".*_cache", "*.egg-info", "build")
        shutil.copytree(ROOT, copy_of, ignore=ignored, symlinks=True)
        for file in modules:
            tried = _tried(file, tests[file], asked.count, random.Random(asked.seed), copy_of)
            if tried is None:
                return 2
            rows.append((file, tried))
            if asked.moves:
                _tell_moves(file, tried, asked.moves, copy_of)
    for file, tried in rows:
        killed = sum(one["noticed"] for one in tried)
        print(f"{file}: {killed} of {len(tried)} mutants noticed by {tests[file]} ({100 * killed / len(tried):.0f} %)")
        print(*(f"    not noticed: {one['change']}" for one in tried if not one["noticed"]), sep="\n")
    return 0


def _modules(name: str) -> list[Path]:
    if name.partition(".")[0] != "mechsym":
        return []
    base = ROOT / name.replace(".", "/")
    if (file := base.with_suffix(".py")).is_file():
        return [file.relative_to(ROOT)]
    return [path.relative_to(ROOT) for path in sorted(base.rglob("*.py")) if "generated" not in path.parts]


def _tree(file: Path) -> ast.Module:
    return ast.parse((ROOT / file).read_text(encoding="utf-8"))


def _of(file: Path) -> str:
    """The tests of a module: its own file first, where the most mistakes are noticed soonest, then its room."""
    room = f"tests/{file.parts[1]}" if len(file.parts) > 2 else f"tests/test_{file.stem}.py"
    own = f"{room}/test_{file.stem}.py"
    return f"{own} {room}" if (ROOT / own).is_file() else room


def _digest(*files: Path) -> str:
    return hashlib.sha256(b"\0".join(file.read_bytes() for file in files)).hexdigest()[:16]


def _tried(file: Path, tests: str, count: int, rng: random.Random, copy_of: Path) -> list[Row] | None:
    """What the tests say of changes of a module, from its log or by running them; None where they fail unchanged."""
    tree, whole = _tree(file), _digest(ROOT / file)
    of_tests = [path for name in tests.split() for path in sorted((ROOT / name).rglob("*.py")) or [ROOT / name]]
    with_tests, possible = _digest(*of_tests), places(tree)
    chosen = rng.sample(possible, min(count, len(possible)))
    log = ROOT / "build/mutants" / f"{'.'.join(file.with_suffix('').parts)}.jsonl"
    log.parent.mkdir(parents=True, exist_ok=True)
    lines = [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()] if log.exists() else []
    known = {
        row["place"]: row for row in lines if row["module"] == whole and (row["noticed"] or row["tests"] == with_tests)
    }
    if any(place not in known for place, _ in chosen):
        # written as a mutant is, without comments: a test that reads those would notice every mutant
        (copy_of / file).write_text(ast.unparse(tree), encoding="utf-8")
        if not _passes(copy_of, tests):
            print(f"{tests} fails without any change", file=sys.stderr)
            return None
    for done, (place, kind) in enumerate(chosen, 1):
        if place not in known:
            text, change = mutant(tree, place, kind)
            (copy_of / file).write_text(text, encoding="utf-8")
            row = {"place": place, "change": change, "noticed": not _passes(copy_of, tests)}
            known[place] = row | {"module": whole, "tests": with_tests}
            with log.open("a", encoding="utf-8") as lines_of:
                lines_of.write(json.dumps(known[place]) + "\n")
        said = "" if known[place]["noticed"] else " not noticed:"
        print(f"{file} {done} of {len(chosen)}{said} {known[place]['change']}", flush=True)
    shutil.copyfile(ROOT / file, copy_of / file)
    return [known[place] for place, _ in chosen]


def _tell_moves(file: Path, tried: list[Row], patterns: str, copy_of: Path) -> None:
    """Print which recorded numbers each change moves that is not noticed."""
    tree = _tree(file)
    kinds = dict(places(tree))
    for row in tried:
        if not row["noticed"]:
            text, _ = mutant(tree, row["place"], kinds[row["place"]])
            (copy_of / file).write_text(text, encoding="utf-8")
            words = ["-m", "tests.matrix", "--compare", "tests/recorded", "--light", "--jobs", "1", *patterns.split()]
            done = subprocess.run([sys.executable, *words], cwd=copy_of, capture_output=True, text=True, check=False,
                                  env={**os.environ, "PYTHONPATH": str(copy_of)})  # fmt: skip
            print(
                f"{file} {row['change']} moves", done.stdout.strip() or "what ends in no record", sep="\n  ", flush=True
            )
    shutil.copyfile(ROOT / file, copy_of / file)


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

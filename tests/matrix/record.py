"""One command run: exit status, text, JSON, heads and ranges of its tables, names of its files."""

import contextlib
import csv
import hashlib
import io
import json
import math
import re
import shutil
import sys
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from matrix.entries import ROOT, Entry, words

from mechsym import cases
from mechsym.files import to_json

DIGITS = 9  # of a number that is kept
LONG = 12  # numbers of a list that are kept one by one; of a longer one count, ends and extremes
MOST_LINES = 2000  # of a text that is kept
MASK = "masked"
# what differs from run to run: wall times and the run itself, by the name of their key, and in texts; and rounding that
# is seen by samples, which hangs on the processor
MASKED = re.compile(r"^(wall_s|seconds|\w*_seconds|run|version|python|platform|processor|seen|factor)$")
MASKED_TEXT = (
    (re.compile(r"\S*/mechsym/native/derived-[0-9a-f]+-[0-9a-f]+"), "CACHE/derived"),
    (re.compile(r"(?<=# source sha256: )[0-9a-f]+"), "STAMP"),
    (re.compile(r"\b\d+(\.\d+)?(e[-+]\d+)? s\b(?= (of wall|wall|by the clock))"), "TIME s"),
    (re.compile(r"^(wall_s +)[-+.\de]+$"), r"\1TIME"),
    (re.compile(r"^(\w+\.\w+ +\S+ +)\S+( +\S+ +\S+ +)\S+(?= +\w+ = )"), r"\1SEEN\2FACTOR"),
)
COUNTED = (".c", ".h", ".mo", ".jl", ".m", ".py", ".md", ".toml", ".csv", ".txt", ".v")  # files that are lines of text


def record(entry: Entry, folder: Path, twice: bool = False) -> dict[str, Any]:
    """What a command gives in a folder that is prepared: as text with its files, and as JSON.

    twice: run it once more with --json, instead of taking what the run with text would have said.
    """
    typed = words(entry, folder)
    with contextlib.chdir(folder):
        shutil.rmtree("run", ignore_errors=True)
        Path("run").mkdir()
        with data_heard() as heard, sections_read(typed) as read:
            code, out, err = answer(typed)
        said = {"typed": " ".join(["mechsym", *typed]), "exit": code, "text": _lines(out, folder)}
        said |= {"reads": sorted(read())} if entry.case else {}
        said |= {"error": _lines(err, folder)} if err else {}
        files = {path.relative_to("run").as_posix(): path for path in sorted(Path("run").rglob("*")) if path.is_file()}
        said |= {"files": {name: _of_file(path) for name, path in files.items()}} if files else {}
        if code == 2 and not out:  # refused: JSON says nothing else
            return said
        if heard and not twice:
            return said | {"json": _json(heard[-1], folder)}
        shutil.rmtree("run")
        Path("run").mkdir()
        code, out, err = answer([*typed, "--json"])
    return said | {"json": _json(out, folder)} | ({"json_exit": code} if code != said["exit"] else {})


@contextlib.contextmanager
def data_heard() -> Iterator[list[str]]:
    """What a command that prints text would have said as JSON."""
    from mechsym.cli import common

    heard, before = [], common.answered

    def answered(*what: Any) -> Any:
        result = before(*what)
        heard.append(to_json(result[0]))
        return result

    common.answered = answered
    try:
        yield heard
    finally:
        common.answered = before


@contextlib.contextmanager
def sections_read(typed: list[str]) -> Iterator[Callable[[], set[str]]]:
    """The sections that a command has read of the case that it names."""
    loaded: list[Any] = []
    load = cases.load

    def kept(*what: Any) -> Any:
        loaded.append(load(*what))
        return loaded[-1]

    cases.load = kept
    try:
        yield lambda: {section for one in loaded if one.path in typed for section in one.read & one.sections.keys()}
    finally:
        cases.load = load


def _json(text: str, folder: Path) -> Any:
    return rounded(json.loads(text.replace(f"{folder}/", ""))) if text else None


def answer(typed: list[str]) -> tuple[int | str | None, str, str]:
    """Exit status, standard output and standard error of a command in this process."""
    from mechsym.cli import main

    out, err, before, code = io.StringIO(), io.StringIO(), sys.argv, None
    sys.argv = ["mechsym", *typed]
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            main()
    except SystemExit as end:
        code = end.code or 0
    except Exception:  # a traceback is an answer too, of the worst kind
        code = traceback.format_exc().strip().rpartition("\n")[2]
    finally:
        sys.argv = before
    return code, out.getvalue(), err.getvalue()


def rounded(value: Any, key: str = "") -> Any:
    """JSON as it is kept: numbers to nine digits, long lists of them by their figures, what differs always masked."""
    if MASKED.match(key):
        return MASK
    match value:
        case dict():
            return {name: rounded(inner, name) for name, inner in value.items()}
        case float():
            return float(f"{value:.{DIGITS}g}")
        case list() if len(value) > LONG and all(isinstance(v, int | float | None) for v in value):
            return _figures([v for v in value if v is not None], len(value))
        case list() if len(value) > LONG:
            return {
                "count": len(value),
                "some": [rounded(value[i]) for i in np.linspace(0, len(value) - 1, 4).astype(int)],
            }
        case list():
            return [rounded(inner) for inner in value]
        case str():
            return _masked(value)
    return value


def _figures(values: list[float], count: int) -> dict[str, Any]:
    if not values:
        return {"count": count}
    ends = {"first": values[0], "last": values[-1], "min": min(values), "max": max(values)}
    return {"count": count} | {name: float(f"{v:.{DIGITS}g}") for name, v in ends.items()}


def _masked(text: str) -> str:
    for pattern, word in MASKED_TEXT:
        text = pattern.sub(word, text)
    return text


def _lines(text: str, folder: Path) -> list[str]:
    """Lines as they are kept, places of this machine left out; of very many their digest."""
    if text.count("\n") > MOST_LINES:
        return [f"{len(text.splitlines())} lines", hashlib.sha256(text.encode()).hexdigest()]
    return [_masked(line.rstrip()) for line in text.replace(f"{folder}/", "").replace(f"{ROOT}/", "").splitlines()]


def _of_file(path: Path) -> Any:
    """Columns of a table with their ends and extremes, headings of a page; the number of lines of another text."""
    if path.suffix not in (*COUNTED, ".html"):
        return None
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".html":
        return re.findall(r'<h[12](?: class="\w*")?>(.*?)</h[12]>', text)
    if path.suffix != ".csv":
        return len(text.splitlines())
    rows = list(csv.reader(line for line in text.splitlines() if not line.startswith("#")))
    return {head: _column([row[i] for row in rows[1:]]) for i, head in enumerate(rows[0])} if rows else {}


def _column(cells: list[str]) -> dict[str, Any]:
    try:
        numbers = [float(cell) for cell in cells if cell]
    except ValueError:
        return {"count": len(cells)}
    return _figures([v for v in numbers if math.isfinite(v)], len(cells))

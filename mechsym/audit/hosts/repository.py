"""A repository audits itself: every formula of every program against what fits its names, and against itself."""

import hashlib
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import field, replace
from functools import cache
from pathlib import Path

from mechsym.audit.hosts.described import descriptions
from mechsym.audit.hosts.itself import (
    converted_here_and_not_there,
    converted_twice,
    into_degrees,
    one_for_a_letter,
    slope_beside,
    slopes,
)
from mechsym.audit.hosts.neighbours import Neighbours
from mechsym.audit.judge.asked import Asked
from mechsym.audit.judge.lexicon import Lexicon
from mechsym.audit.read.programs.claims import ENDS, Claim, Reading, base, longest, read_program
from mechsym.audit.read.programs.statements import OF
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.tree import Node, letters
from mechsym.audit.row import Row
from mechsym.audit.theory.catalogue import named, shipped_for
from mechsym.errors import BadInput
from mechsym.files.inputs import read_any_text
from mechsym.quantities import record

_LEFT_OUT = {*"node_modules venv __pycache__ build dist third_party site-packages".split()}  # and what a dot begins
_MOST_FILES = 20_000
_MINIFIED = 110  # letters in a line of JavaScript on the average: so many are written by a tool
_BY_ITSELF = (converted_twice, into_degrees, one_for_a_letter)
_FOUND = ("misprint", "derivative", "wrong")


@record
class File:
    """What became of one file."""

    path: str
    why: str = ""  #: It was not read; empty where it was
    scopes: int = 0
    assigned: int = 0
    formulas: int = 0
    matched: int = 0
    judged: int = 0
    rows: Sequence[Row] = field(default_factory=tuple)


def programs(place: Path) -> list[Path]:
    """The files under a folder that are programs; a file itself."""
    if place.is_file():
        return [place]
    if not place.is_dir():
        raise BadInput(f"--code {place}: there is no such file or folder")
    files = []
    for folder, below, names in os.walk(place):
        below[:] = sorted(d for d in below if d not in _LEFT_OUT and not d.startswith("."))
        files += [Path(folder) / n for n in sorted(names) if Path(n).suffix.lower() in ENDS]
    if not files:
        raise BadInput(f"--code {place}: there is no program in it; files that are read end in {', '.join(ENDS)}")
    if len(files) > _MOST_FILES:
        raise BadInput(f"--code {place}: {len(files)} programs, at most {_MOST_FILES} are read; name a folder of it")
    return files


def audited(place: Path, asked: Asked, chosen: Sequence[Path]) -> Iterator[File]:
    """Every chosen program of a folder, read and judged."""
    root = place if place.is_dir() else place.parent
    copies: dict[tuple[str, ...], File] = {}  # a text that stands in several folders is judged once
    for path in chosen:
        shown = path.relative_to(root).as_posix()
        try:
            suffix = path.suffix.lower()
            text = _written(path, suffix)
            own = [Path(asked.theory).stem] if asked.theory else shipped_for(f"{shown} {text}")
            same = (suffix, text, *own)
            if same not in copies:
                vocabularies = [_vocabulary(one, asked.case, asked.theory) for one in own]
                copies[same] = _judged(shown, read_program(text, suffix), vocabularies)
        except BadInput as error:
            yield File(path=shown, why=str(error))
        else:
            file = copies[same]
            yield replace(file, path=shown, rows=[_placed(row, shown) for row in file.rows])


def _written(path: Path, suffix: str) -> str:
    """The text of a file that somebody wrote."""
    text = read_any_text(path, longest(suffix))
    mean = len(text) / (text.count("\n") + 1)
    if suffix == ".js" and mean > _MINIFIED:
        raise BadInput(f"{path}: {mean:.0f} letters a line, so a tool has made it; the text it is made from is read")
    return text


@cache
def _vocabulary(name: str, case: str, file: str) -> Lexicon:
    return Lexicon(named(name, case, file))


def _judged(shown: str, reading: Reading, may_be: Sequence[Lexicon]) -> File:
    matched, judged = set[int](), set[int]()  # claims by identity: the same one may be held against several things
    rows = []
    claims = [c for c in reading.claims if len(letters(c.tree)) > 1]
    words = {base(k) for c in reading.claims for k in (*letters(c.tree), c.name)}
    neighbours = Neighbours(reading.claims, [v for v in may_be if v.touches(words)])
    for claim in reading.claims:
        outcome = neighbours.outcome(claim)
        own = slope_beside(claim, claims) or next(filter(None, (look(claim) for look in _BY_ITSELF)), None)
        if outcome is not None or own is not None:
            matched.add(id(claim))
        if own or (outcome is not None and outcome["verdict"] != ""):
            judged.add(id(claim))
        for row in (outcome, own):
            if row is not None and row["verdict"] in _FOUND:
                rows.append(_of_claim(row, claim))
    beside = (*slopes(reading), *converted_here_and_not_there(reading.claims), *descriptions(reading))
    for claim, row in beside:
        matched.add(id(claim))
        judged.add(id(claim))
        if row["verdict"] in _FOUND:
            rows.append(_of_claim(row, claim))
    return File(
        path=shown,
        scopes=len(reading.names),
        assigned=reading.assigned,
        formulas=len(claims),
        matched=len(matched),
        judged=len(judged),
        rows=_once(rows),
    )


def _once(rows: Sequence[Row]) -> list[Row]:
    """The first of the findings of each formula: one slip is told once."""
    first: dict[tuple[str, str, str], Row] = {}
    for row in rows:
        first.setdefault((row["scope"], row["equation"], row["printed"]), row)
    return list(first.values())


def _of_claim(row: Row, claim: Claim) -> Row:
    printed = f"{base(claim.name).replace(OF, '.')} = {_shown(claim.tree)}"
    return row | {"line": claim.line, "scope": claim.scope, "equation": claim.name, "printed": printed}


def _placed(row: Row, shown: str) -> Row:
    key = "|".join([shown, row["scope"], row["equation"], row["claim"], row["printed"]])
    return row | {"file": shown, "fingerprint": hashlib.sha256(key.encode()).hexdigest()[:24]}


def _shown(tree: Node) -> str:
    return re.sub(r"__[vw]\d+", "", to_python(tree)).replace(OF, ".")

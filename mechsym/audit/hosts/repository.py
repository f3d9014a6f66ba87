"""A repository audits itself: every formula of every program against what fits its names, and against itself."""

import ast
import hashlib
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import field
from functools import cache
from pathlib import Path

from mechsym.audit.hosts.neighbours import Neighbours
from mechsym.audit.hosts.slips import asked_once, renamed_to
from mechsym.audit.judge.asked import Asked
from mechsym.audit.judge.lexicon import ANGLES, Lexicon, safe
from mechsym.audit.judge.nearness import Probes, compared, of_units
from mechsym.audit.read import tree as trees
from mechsym.audit.read.programs.claims import ENDS, Claim, Reading, base, inlined, longest, read_program
from mechsym.audit.read.programs.statements import OF
from mechsym.audit.read.reader import Formula
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.tree import Node, letters
from mechsym.audit.row import Row
from mechsym.audit.theory.catalogue import named, shipped
from mechsym.audit.theory.record import Letter, Theory
from mechsym.audit.theory.tape import TheoryTape, derivative
from mechsym.audit.verdict import PASSED
from mechsym.errors import BadInput
from mechsym.files.inputs import read_any_text
from mechsym.quantities import record

_LEFT_OUT = {*"node_modules venv __pycache__ build dist third_party site-packages".split()}  # and what a dot begins
_MOST_FILES = 20_000


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
    for path in chosen:
        shown = path.relative_to(root).as_posix()
        try:
            suffix = path.suffix.lower()
            reading = read_program(read_any_text(path, longest(suffix)), suffix)
        except BadInput as error:
            yield File(path=shown, why=str(error))
        else:
            yield _judged(shown, reading, asked)


@cache
def _vocabularies(theory: str, case: str) -> tuple[Lexicon, ...]:
    chosen = [named(Path(theory).stem, case, theory)] if theory else [named(one, case) for one in shipped()]
    return tuple(Lexicon(one) for one in chosen)


def _judged(shown: str, reading: Reading, asked: Asked) -> File:
    matched = judged = 0
    rows = []
    claims = [c for c in reading.claims if len(letters(c.tree)) > 1]
    words = {base(k) for c in reading.claims for k in (*letters(c.tree), c.name)}
    vocabularies = [v for v in _vocabularies(asked.theory, asked.case) if v.touches(words)]
    neighbours = Neighbours(reading.claims, vocabularies)
    for claim in reading.claims:
        outcome = neighbours.outcome(claim)
        own = _pair(claim, claims)
        matched += outcome is not None or own is not None
        judged += bool(outcome and outcome["verdict"] != "") or bool(own)
        for row in (outcome, own):
            if row is not None and row["verdict"] in ("misprint", "derivative", "wrong"):
                rows.append(_placed(row, claim, shown))
    for claim, row in _slopes(reading):
        matched, judged = matched + 1, judged + 1
        if row["verdict"] == "derivative":
            rows.append(_placed(row, claim, shown))
    return File(
        path=shown,
        scopes=len(reading.names),
        assigned=reading.assigned,
        formulas=len(claims),
        matched=matched,
        judged=judged,
        rows=list({row["fingerprint"]: row for row in rows}.values()),
    )


def _placed(row: Row, claim: Claim, shown: str) -> Row:
    printed = f"{base(claim.name).replace(OF, '.')} = {_shown(claim.tree)}"
    key = "|".join([shown, claim.scope, claim.name, row["claim"], printed])
    return row | {
        "file": shown,
        "line": claim.line,
        "scope": claim.scope,
        "equation": claim.name,
        "printed": printed,
        "fingerprint": hashlib.sha256(key.encode()).hexdigest()[:24],
    }


def _shown(tree: Node) -> str:
    return re.sub(r"__[vw]\d+", "", to_python(tree)).replace(OF, ".")


_SLOPE = re.compile(
    r"^(?:d_?(?P<of>\w+?)_?d_?(?P<by>\w+)|(?:d_|d|deriv_|grad_)(?P<f>\w+)|(?P<g>\w+?)_?(?:prime|deriv|derivative))$"
)


def _pair(claim: Claim, claims: Sequence[Claim]) -> Row | None:
    """What names like dV_dtheta and dV say: the derivative of V, which stands in the same scope, by an angle."""
    match, names = _SLOPE.match(claim.name), {c.name for c in claims if c.scope == claim.scope}
    of = claim.name[1:].lstrip("_") if claim.name[:1] == "d" else ""
    of = of if of in names else (match["of"] or "") if match else ""
    alike = [c for c in claims if c.scope == claim.scope and c.name == of]
    if len(alike) != 1 or alike[0].case != claim.case:
        return None
    if claim.name in map(base, letters(alike[0].tree)):  # x = x - dx: a step
        return None
    whole, slope = inlined(alike[0].tree, alike[0].values), inlined(claim.tree, claim.values)
    if whole is None or slope is None:
        return None
    wanted = (match["by"],) if match and match["of"] == of else ANGLES
    by = [k for k in letters(whole) if base(k) in wanted]
    if len(by) != 1 or not set(letters(slope)) <= set(letters(whole)):
        return None
    return _derived(whole, slope, by[0], claim.name, of)


def _slopes(reading: Reading) -> Iterator[tuple[Claim, Row]]:
    """Functions of one letter that are called the derivative of another function."""
    for claim in reading.claims:
        match = _SLOPE.match(claim.scope) if claim.name == "return" else None
        of = (match["f"] or match["g"] or "") if match else ""
        if of not in reading.functions or claim.scope not in reading.functions:
            continue
        (parameters, whole), (again, slope) = reading.functions[of], reading.functions[claim.scope]
        if len(parameters) != 1 or len(again) != 1:
            continue
        named_alike = _with_name(slope, again[0], parameters[0])
        if set(letters(named_alike)) <= set(letters(whole)) and parameters[0] in letters(named_alike):
            row = _derived(whole, named_alike, parameters[0], claim.scope, of)
            if row is not None:
                yield claim, row


def _with_name(tree: Node, old: str, new: str) -> Node:
    return trees.substitute(tree, lambda n: renamed_to(n, {old: new}))


def _derived(whole: Node, slope: Node, by: str, called: str, of: str) -> Row | None:
    free = {safe(k): Letter(unit="-", value=1.0) for k in letters(whole) if k != "pi"}
    plain, slope = (
        trees.substitute(t, lambda n: trees.name(safe(n.id)) if isinstance(n, ast.Name) and n.id != "pi" else None)
        for t in (whole, slope)
    )
    letter = safe(by)
    if letter not in free:
        return None
    try:
        rate = derivative(plain, lambda k: trees.number(int(k == letter)))
        theory = Theory(
            name="itself",
            letters=free,
            tape=TheoryTape({"of_itself": plain, "slope": rate}, free, "", declared=True),
            results=("of_itself", "slope"),
            data="the program itself",
        )
        trees.check(slope)
        met = compared(Formula(tree=slope), Probes(theory), "slope")
    except (BadInput, RecursionError):
        return None
    if met is None or of_units(met.ratio):
        return None if met is None else {"verdict": "agrees", "claim": f"derivative of {of}"}
    row, _ = asked_once(to_python(slope), theory, "slope", {}, ())
    if row["verdict"] in (*PASSED, "untestable"):
        return row | {"verdict": "agrees"}
    why = f"{called} is called the derivative of {of} by {base(by)}, and is not; one of the two is wrong"
    return row | {
        "verdict": "derivative",
        "claim": f"the derivative of {of} by {base(by)}",
        "note": f"{why}; {row['note']}",
    }

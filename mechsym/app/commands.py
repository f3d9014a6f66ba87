"""The slow part of the workbench: a command of mechsym in a process of its own; the next run ends the one before."""

import asyncio
import csv
import json
import re
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from mechsym.app.answers import Plotted
from mechsym.app.told import KNOWN, pretty, told
from mechsym.cases import Case
from mechsym.cases.facts import facts_of
from mechsym.cases.needs import COMMANDS, lacking
from mechsym.mechanisms.own import quantity_of
from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.record import listing
from mechsym.page import Finding
from mechsym.quantities import record
from mechsym.quantities.display import heading, key_words, stem_and_unit

_TABS = ("hinge", "simulate", "forces", "cycle", "size", "codesign")
_MOST_ROWS = 400  # more than any command says of a case of ours
_MOST_CURVES = 6
_MOST_POINTS = 600  # of a curve
_ROUNDING = 1e-9  # of the largest value of a unit
_TURNS = 12.0  # about two turns [rad]
#: commands that run again as soon as the sliders rest; the others take long and wait for their button
LIVE = ("simulate", "forces", "cycle")
#: command: its table, the column along which it goes
_TABLES = {"forces": ("forces.csv", "phi"), "cycle": ("cycle.csv", "phi"), "simulate": ("series.csv", "t")}
_PAGES = {"codesign": "report.html"}  # shown below its numbers
_FIRST = ("p", "torque")  # curves that are looked for first
_ALONG = {"phi": "crank angle", "t": "time"}
_HEAD = re.compile(r"^(.*?)(?: \[(.*)\])?$")


@record
class Run:
    """What a command said."""

    status: int  #: 0 done, 1 infeasible, 2 refused, others as documented
    words: str  #: its error or verdict, empty when there is nothing to say
    rows: tuple[tuple[str, str], ...] = ()  #: names and values of its JSON, the lists in short
    curves: tuple[Plotted, ...] = ()  #: of its table, where it has one: the first
    undrawn: int = 0  #: Curves of that table which are not among them
    findings: tuple[Finding, ...] = ()  #: what has to be known first
    page: str = ""  #: that it wrote, with its pictures


def tabs(case: Case) -> tuple[str, ...]:
    """Commands that can run on a case."""
    missing = lacking(facts_of(case.mechanism, case.sections))
    return tuple(name for name in _TABS if not missing[name])


def reads(command: str, case: Case) -> set[str]:
    """The sections of a case that a command reads: only their values can move what it says."""
    return COMMANDS[command].reads(facts_of(case.mechanism, case.sections)) if command in COMMANDS else set()


def against(mechanism: str) -> str:
    """A quantity of a mechanism that a formula may be tried against: the travel of its first piston, as a rule.

    >>> against("crosshead"), against("rodless"), against("crank_train")
    ('crosshead.x', 'rodless.x_a', 'crank_throw.x')
    """
    theory = plan_of(mechanism).theory
    return quantity_of(theory, next(iter(listing(theory)["outputs"])))


def words(command: str, name: str, values: Mapping[str, float]) -> list[str]:
    """The command as typed: the case, and `--set` for each value in SI [unit of its key]."""
    return [command, name, *(w for key, value in values.items() for w in ("--set", f"{key}={value!r}"))]


async def run(line: Sequence[str]) -> Run:
    """Run a command line with --json, and its table where it has one; when it is cancelled its process ends too."""
    table, written = _TABLES.get(line[0]), _PAGES.get(line[0])
    out_of = line[0] in {*_TABLES, *_PAGES}
    with tempfile.TemporaryDirectory() as folder:
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-m", "mechsym", *line, "--json", "--with-units", *(("--out", folder) if out_of else ()),
            stdin=asyncio.subprocess.DEVNULL, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
        )  # fmt: skip
        try:
            out, said = await process.communicate()
        except asyncio.CancelledError:
            process.kill()
            await process.wait()
            raise
        curves = _curves(Path(folder) / table[0], table[1]) if table else ()
        units = _units(Path(folder) / table[0]) if table else {}
        page = Path(folder) / written if written else None
        shown = page.read_text(encoding="utf-8") if page is not None and page.exists() else ""
    answer = run_of(process.returncode or 0, out.decode(), said.decode(), curves[:_MOST_CURVES], units)
    return replace(answer, page=shown, undrawn=max(0, len(curves) - _MOST_CURVES))


def run_of(
    status: int, out: str, said: str, curves: tuple[Plotted, ...] = (), columns: Mapping[str, str] | None = None
) -> Run:
    """What a command said with `--json --with-units`; columns: units of those of its table."""
    try:
        answer = json.loads(out)
    except ValueError:
        return Run(status=status, words=said.strip().splitlines()[-1] if said.strip() else "no answer")
    units = {f"max.{name}": unit for name, unit in (columns or {}).items()} | answer["units"]
    return Run(status=status, words=said.strip(), rows=tuple(told(answer["value"], units)[:_MOST_ROWS]), curves=curves,
               findings=_findings(answer["value"]))  # fmt: skip


def _findings(value: object) -> tuple[Finding, ...]:
    return tuple(Finding(**one) for one in value.get("headline", ())) if isinstance(value, Mapping) else ()


def _units(file: Path) -> dict[str, str]:
    """Units by column of a table."""
    if not file.exists():
        return {}
    with file.open(encoding="utf-8", newline="") as stream:
        return dict(_head(head) for head in next(csv.reader(stream)))


def _curves(file: Path, along: str) -> tuple[Plotted, ...]:
    """The columns of a table that move, each a chart of its own."""
    if not file.exists():
        return ()
    with file.open(encoding="utf-8", newline="") as stream:
        heads, *rows = csv.reader(stream)
    named = [_head(head) for head in heads]
    place = next((i for i, (name, _) in enumerate(named) if name == along), None)
    every = max(1, len(rows) // _MOST_POINTS)
    columns = [_numbers([row[i] for row in rows[::every]]) for i in range(len(heads))]
    if place is None or not columns[place]:
        return ()
    # what only rounds beside the others of its unit is no curve
    sizes = {u: max((max(map(abs, c)) for c, (_, v) in zip(columns, named, strict=True) if c and u == v), default=0.0)
             for _, u in named}  # fmt: skip
    steady = {i for i, c in enumerate(columns) if c and max(c) - min(c) <= _ROUNDING * sizes[named[i][1]]}
    for i in (i for i in steady if named[i][1] == "rad/s"):  # a speed that is held is seen to be
        columns[i] = (sum(columns[i]) / len(columns[i]),) * len(columns[i])
    moving = [i for i, c in enumerate(columns) if i != place and c and (i not in steady or named[i][1] == "rad/s")]
    # an angle that goes on from turn to turn is a straight line; what swings stands before it
    goes_on = {i for i in moving if named[i][1] == "rad" and max(columns[i]) - min(columns[i]) > _TURNS}
    moving.sort(key=lambda i: (named[i][0] not in _FIRST and named[i][1] != "rad/s", i in goes_on))
    x_name, x = _axis(_ALONG[along], named[place][1], columns[place])
    shown = (_axis(*_worded(*named[i]), columns[i]) for i in moving)
    named_y = ((y_name.partition(" [")[0], y_name, y) for y_name, y in shown)
    return tuple(Plotted(name=name, chart=name, x_name=x_name, y_name=y_name, x=x, y=y) for name, y_name, y in named_y)


def _worded(name: str, unit: str) -> tuple[str, str]:
    """The rate of an angle is a speed."""
    if unit != "rad/s" or not name.endswith("d"):
        return name, unit
    return "crank speed" if name == "phid" else f"speed of {name[:-1]}", unit


def _axis(name: str, unit: str, values: tuple[float, ...]) -> tuple[str, tuple[float, ...]]:
    """Name and values of an axis in the unit in which people are shown them [unit]."""
    title, shown = heading(name, list(values), unit=None if unit == "-" else unit)
    stem, bracket, rest = title.partition(" [")
    return pretty(key_words(stem, KNOWN) + bracket + rest), tuple(shown)


def _head(head: str) -> tuple[str, str]:
    """Name and unit of a column, which stands in brackets or ends the name."""
    matched = _HEAD.match(head)
    name, unit = (matched[1], matched[2]) if matched else (head, None)
    stem, carried = stem_and_unit(name)
    return (name, unit) if unit else (stem, carried or "-")


def _numbers(texts: Sequence[str]) -> tuple[float, ...]:
    """A column as numbers, or nothing where it has a gap."""
    try:
        return tuple(map(float, texts))
    except ValueError:
        return ()

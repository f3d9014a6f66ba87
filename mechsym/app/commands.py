"""The slow part of the workbench: a command of mechsym in a process of its own; the next run ends the one before."""

import asyncio
import json
import sys
from collections.abc import Mapping, Sequence
from typing import Any

from mechsym.cases import Case
from mechsym.quantities import record

#: command: sections that a case needs for it
_NEEDS = {
    "hinge": ("spring", "guide", "rollers", "limits"),
    "simulate": ("parameters",),
    "forces": ("cycle", "operation"),
    "cycle": ("cycle",),
    "size": ("sizing",),
    "codesign": ("codesign",),
}
_MOST_ROWS = 60


@record
class Run:
    """What a command said."""

    status: int  #: 0 done, 1 infeasible, 2 refused, others as documented
    words: str  #: its error or verdict, empty when there is nothing to say
    rows: tuple[tuple[str, str], ...] = ()  #: names and values of its JSON, the lists in short


def tabs(case: Case) -> tuple[str, ...]:
    """Commands that the sections of a case allow."""
    return tuple(name for name, sections in _NEEDS.items() if all(s in case.sections for s in sections))


def words(command: str, name: str, values: Mapping[str, float]) -> list[str]:
    """The command as typed: the case, and `--set` for each value in SI [unit of its key]."""
    return [command, name, *(w for key, value in values.items() for w in ("--set", f"{key}={value!r}"))]


async def run(line: Sequence[str]) -> Run:
    """Run a command line with --json; when it is cancelled its process ends too."""
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-m", "mechsym", *line, "--json", stdin=asyncio.subprocess.DEVNULL,
        stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
    )  # fmt: skip
    try:
        out, said = await process.communicate()
    except asyncio.CancelledError:
        process.kill()
        await process.wait()
        raise
    return _read(process.returncode or 0, out.decode(), said.decode())


def _read(status: int, out: str, said: str) -> Run:
    try:
        found = json.loads(out)
    except ValueError:
        return Run(status=status, words=said.strip().splitlines()[-1] if said.strip() else "no answer")
    rows = tuple(_rows("", found))[:_MOST_ROWS]
    return Run(status=status, words=said.strip(), rows=rows)


def _rows(prefix: str, found: Any) -> list[tuple[str, str]]:
    """Numbers and texts by dotted name; of a list its length and ends."""
    if isinstance(found, Mapping):
        return [row for key, value in found.items() for row in _rows(f"{prefix}.{key}" if prefix else str(key), value)]
    if isinstance(found, list):
        if not found:
            return []
        if isinstance(found[0], (Mapping, list)):
            return [row for i, value in enumerate(found[:8]) for row in _rows(f"{prefix}[{i}]", value)]
        shown = found if len(found) <= 6 else [found[0], "..", found[-1]]
        return [(prefix, ", ".join(_text(v) for v in shown))]
    return [(prefix, _text(found))]


def _text(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.5g}"
    return "none" if value is None else str(value)

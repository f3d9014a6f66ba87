"""What is public, one name a line: `python -m tests.public --write` adds what a version adds to tests/public.txt.

python   mechsym.ROOM.NAME     of every `__all__`
command  hinge --out           commands with their options
key      spring.p0             of a case; `spring(law = coil).k` where a word chooses the record
json     hinge guide.rho_min   of `--json`, as `mechsym sections --results` lists it
exit     2                     exit statuses

A name that stands here and is gone fails a test: docs/stability.md says how a name may go.
"""

import importlib
import sys
from pathlib import Path

import click

import mechsym
from mechsym.cases.keys import keys
from mechsym.cli import COMMANDS
from mechsym.cli import mechsym as cli
from mechsym.cli.results import rows

FILE = Path(__file__).parent / "public.txt"
EXITS = (0, 1, 2, 3, 74, 130)


def names():
    """All names that are public now, sorted."""
    yield from sorted(python())
    for command in COMMANDS:
        yield f"command {command}"
        params = cli.get_command(click.Context(cli), command).params
        options = {max(option.opts, key=len) for option in params if option.opts[0].startswith("-")}
        yield from (f"command {command} {option}" for option in sorted(options))
    yield from sorted({f"key {_section(row)}.{row['key']}" for row in keys()})
    yield from sorted({f"json {row['command']} {row['path']}" for row in rows()})
    yield from (f"exit {status}" for status in EXITS)


def python():
    for room in mechsym.__all__:
        module = importlib.import_module(f"mechsym.{room}")
        yield f"python mechsym.{room}"
        yield from (f"python mechsym.{room}.{name}" for name in getattr(module, "__all__", ()))


def _section(row):
    return f"{row['section']}({row['variant']})" if row["variant"] else row["section"]


def listed():
    """The names that a version promised."""
    return FILE.read_text(encoding="utf-8").splitlines()


if __name__ == "__main__":
    found = [*names()]
    gone = sorted({*listed()} - {*found}) if FILE.exists() else []
    print("\n".join(gone) or "nothing is gone")
    if "--write" in sys.argv:
        FILE.write_text("\n".join(found) + "\n", encoding="utf-8")
    sys.exit(bool(gone))

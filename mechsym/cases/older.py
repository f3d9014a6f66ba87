"""Case files of older versions: what was renamed since is read under its new name, and a doubt tells what to change.

A row of `RENAMED` is all that a new name needs; it stays for as long as docs/stability.md promises.
"""

from collections.abc import Mapping
from typing import NamedTuple

from mechsym.files import Json
from mechsym.plausible import Doubt


class Renamed(NamedTuple):
    """The name that a section, or a key as `section.key`, has since a version."""

    name: str
    since: str


#: Old name to the new one; version 1.0 renamed nothing
RENAMED: Mapping[str, Renamed] = {}


def renewed(tables: Json) -> tuple[Json, tuple[Doubt, ...]]:
    """Tables of a case under today's names, and a doubt for each that was renamed; two names at once stay."""
    new, doubts = dict(tables), []
    for old, (name, since) in RENAMED.items():
        section, _, key = old.partition(".")
        target, _, other = name.partition(".")
        if section not in new or (key and not (isinstance(new[section], dict) and key in new[section])):
            continue
        if key and other not in new.get(target, {}):
            new[section] = {k: v for k, v in new[section].items() if k != key}
            new[target] = new.get(target, {}) | {other: tables[section][key]}
        elif not key and target not in new:
            new[target] = new.pop(section)
        else:
            continue
        why = f"it is read as {name}, its name since version {since}; write that"
        doubts.append(Doubt(code="renamed", quantity=f"older name: {old}", value=1.0, usual="0", why=why))
    return new, tuple(doubts)

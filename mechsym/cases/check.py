"""All problems of a case file at once, and what each command still lacks; nothing of the file is executed.

A case that is loaded stops at its first problem; someone who writes one wants to see them all.
"""

import dataclasses
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from mechsym import cases, mechanisms
from mechsym.cases import schema
from mechsym.cases.doubts import acceptances, judged
from mechsym.cases.keys import kind, required
from mechsym.cases.needs import lacking
from mechsym.cases.values import convert, without_unit
from mechsym.errors import BadInput, shown, suggest
from mechsym.mechanisms import own
from mechsym.quantities import allowed, record
from mechsym.quantities.records import check_value

_HEAD = ("mechanism", "source", "about")


@record
class CaseProblem:
    """What is wrong with one key."""

    key: str  #: Dotted; a section alone, or empty for the whole file
    why: str
    allowed: str = ""  #: What may stand there, or the way out


@record
class Checked:
    """What `mechsym check` finds."""

    problems: tuple[CaseProblem, ...]
    commands: Mapping[str, list[str]]  #: What each command lacks; empty where it can run
    skipped: tuple[str, ...] = ()  #: Sections that only the mechanism's own file could judge


def check_file(name: str, trust: bool = False) -> Checked:
    """Check a case.

    Parameters
    ----------
    name : str
        Name of a built-in case or a path to a TOML file
    trust : bool
        Whether a mechanism file that the case names may be run to learn its letters

    Raises
    ------
    BadInput
        There is no such file
    """
    text = cases.text(name)
    try:
        tables = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        return Checked(problems=(CaseProblem(key="", why=f"not valid TOML: {error}"),), commands={})
    head, mechanism = list(_head(tables)), _mechanism(tables, name)
    sections = {k: v for k, v in tables.items() if k not in (*_HEAD, "doubts")}
    untold = mechanism is None or (own.is_file(mechanism) and not trust)
    skipped = tuple(s for s in sections if s in schema.LETTERS) if untold else ()
    found, records = [*head], dict[str, Any]()
    for section, table in sections.items():
        if section not in skipped:
            wrong, made = _section(mechanism or "", section, table)
            found += wrong
            records |= {section: made} if made is not None else {}
    found += _whole(tables.get("doubts", {}), records, mechanism or "")
    commands = lacking(mechanism or "", sections)
    return Checked(problems=tuple(found), commands=commands, skipped=skipped)


def _head(tables: Mapping[str, Any]) -> Iterator[CaseProblem]:
    for key in _HEAD:
        mine = own.is_file(str(tables.get("mechanism"))) and key != "mechanism"
        if key not in tables and not mine:
            yield CaseProblem(
                key=key, why="is missing at the top", allowed=f'write {key} = ".." above the first section'
            )
        elif key in tables and not isinstance(tables[key], str):
            yield CaseProblem(key=key, why=f"{shown(tables[key])} is not a text", allowed=f'write {key} = ".."')
    name = tables.get("mechanism")
    if isinstance(name, str) and not own.is_file(name) and name not in mechanisms.names():
        yield CaseProblem(key="mechanism", why=f"{name!r} is not known", allowed=suggest(name, mechanisms.names()))


def _mechanism(tables: Mapping[str, Any], name: str) -> str | None:
    found = tables.get("mechanism")
    if not isinstance(found, str):
        return None
    if own.is_file(found):
        return own.located(found, Path(name).parent)
    return found if found in mechanisms.names() else None


def _section(mechanism: str, section: str, table: Any) -> tuple[list[CaseProblem], Any]:
    """What is wrong with a section, and its record where nothing is."""
    if section not in schema.sections():
        return [CaseProblem(key=section, why="is no section", allowed=suggest(section, schema.sections()))], None
    if not isinstance(table, dict):
        return [CaseProblem(key=section, why=f"{shown(table)} is no section", allowed=f"[{section}] and keys")], None
    try:
        cls = schema.record(mechanism, section, table)
    except BadInput as error:
        why, _, way = str(error).partition("; ")
        return [CaseProblem(key=f"{section}.{schema.selector(section) or ''}".rstrip("."), why=why, allowed=way)], None
    wrong, values = _values(cls, section, table)
    if wrong:
        return wrong, None
    try:
        return [], cls(**values)
    except BadInput as error:  # what no key alone is to blame for
        return [CaseProblem(key=section, why=str(error))], None


def _values(cls: Any, section: str, table: dict[str, Any]) -> tuple[list[CaseProblem], dict[str, Any]]:
    fields = {f.name: f for f in dataclasses.fields(cls)}
    wrong: list[CaseProblem] = []
    values: dict[str, Any] = {}
    for key, raw in table.items():
        if key == schema.selector(section) and key not in fields:
            continue
        name, value = without_unit(key, raw, fields)
        where = f"{section}.{key}"
        if name not in fields:
            wrong.append(CaseProblem(key=where, why="is not known", allowed=suggest(key, fields)))
            continue
        if name in values:
            wrong.append(
                CaseProblem(key=where, why="is given twice, once with its unit in the key", allowed="keep one")
            )
        try:
            values[name] = convert(fields[name], value, name)
            check_value(fields[name], values[name])
        except BadInput as error:
            wrong.append(CaseProblem(key=where, why=str(error), allowed=takes(fields[name])))
            values.setdefault(name, None)
    missing = [f for n, f in fields.items() if n not in values and required(f)]
    wrong += [CaseProblem(key=f"{section}.{f.name}", why="is missing", allowed=takes(f)) for f in missing]
    return wrong, values


def takes(field: dataclasses.Field) -> str:
    """What a key takes, in words: `number in m, > 0`."""
    meta = field.metadata
    if "options" in meta:
        return ", ".join(str(option) for option in meta["options"])
    unit = meta.get("unit")
    inside = f" in {unit}" if unit and unit != "-" else ""
    bounds = allowed(meta) if unit else ""
    return f"{kind(field)}{inside}" + (f", {bounds}" if bounds else "")


def _whole(doubts: Any, records: Mapping[str, Any], mechanism: str) -> list[CaseProblem]:
    """What is wrong only when keys are seen together: doubts that are no doubts, nonsense."""
    found = []
    try:
        acceptances(doubts)
    except BadInput as error:
        found.append(CaseProblem(key="doubts", why=str(error)))
    try:
        judged(records, mechanism)
    except BadInput as error:
        key, _, why = str(error).partition(" = ")
        found.append(CaseProblem(key=key if why and " " not in key else "", why=str(error)))
    return found

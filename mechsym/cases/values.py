"""Values of a case file: from what TOML holds to what a record's field takes, and overrides by key."""

import dataclasses
import difflib
import functools
import re
from collections.abc import Mapping
from types import NoneType, UnionType
from typing import Any, get_args, get_origin

from mechsym.cases import schema
from mechsym.cases.older import RENAMED
from mechsym.cases.owned import letter_of
from mechsym.errors import BadInput, shown, suggest
from mechsym.files import Json
from mechsym.quantities import parse, record, units
from mechsym.quantities.ranges import values
from mechsym.quantities.records import Field, Record

_LISTED = re.compile(r",|\.\.|:")
_WORDS = {str: "a text", int: "a whole number", bool: "true or false"}


def convert(field: Field, value: object, key: str) -> Any:
    """The value of a field, in SI.

    value: text, number or list of them; key: name of the value, for the message. Returns value: of the field's type; a
    list becomes a tuple.
    """
    kinds = get_args(field.type) if isinstance(field.type, UnionType) else (field.type,)
    lists = [k for k in kinds if get_origin(k) is tuple]
    single = [k for k in kinds if k not in lists and k is not NoneType]
    if isinstance(value, list):
        if not lists:
            raise BadInput(f"{key} = {shown(value)} is a list; give one value")
        return tuple(_single(field, get_args(lists[0])[0], item, key) for item in value)
    if not single and isinstance(value, str) and "unit" in field.metadata and _LISTED.search(value):
        return tuple(values(value, field.metadata["unit"], key))  # as --set and options write lists and ranges
    if not single:
        raise BadInput(f"{key} = {shown(value)} is no list; write for example {key.rpartition('.')[2]} = [1, 2]")
    return _single(field, single[0], value, key)


def _single(field: Field, kind: object, value: object, key: str) -> Any:
    if "unit" in field.metadata:
        number = parse(value, field.metadata["unit"], key)
        if kind is int and number != round(number):
            raise BadInput(f"{key} = {shown(value)} is no whole number")
        return int(number) if kind is int else number
    if kind in _WORDS and type(value) is not kind and "options" not in field.metadata:
        raise BadInput(f"{key} = {shown(value)} is not {_WORDS[kind]}")
    return value


def without_unit(key: str, value: object, fields: Mapping[str, Field]) -> tuple[str, Any]:
    """A key that names its unit, as the key alone and a value with that unit; one with a dot as its letter.

    value: a number, or a list of numbers. Returns key: str, name of a field, or the key as it is.
    """
    key = letter_of(key, fields)
    stem, _, unit = key.rpartition("_")
    if key in fields or unit not in units() or "unit" not in getattr(fields.get(stem), "metadata", ()):
        return key, value
    return stem, [f"{item} {unit}" for item in value] if isinstance(value, list) else f"{value} {unit}"


@record
class Place:
    """Where a key belongs in a case."""

    section: str
    field: str
    unit: str | None  #: SI unit of a number, None for a word
    written: str  #: Unit that the key itself names, as in `speed_rpm`; empty when it names none


def take(taken: dict[tuple[str, str], str], place: Place, said: str) -> None:
    """Note what gives the value of a place, by section and field. Raises BadInput: something else gives it too."""
    key = place.section, place.field
    if key in taken:
        raise BadInput(f"{taken[key]} and {said} give the same value {'.'.join(key)}; keep one")
    taken[key] = said


def place(tables: Json, mechanism: str, key: str, option: str) -> Place:
    """Find the field of a dotted key, or of a bare one that is unique. option: where it was written, for messages."""
    section, name = _divided(tables, mechanism, key, option)
    # a section that is left out has its defaults, unless a key has to choose its record first
    known = section in schema.sections()
    table = tables.get(section, None if schema.selector(section) else {}) if known else None
    if not isinstance(table, dict):
        here = [t for t in tables if t in schema.sections()]
        raise BadInput(f"{option} {key}: no section [{section}] here; {suggest(section, here)}")
    if name == schema.selector(section):
        return Place(section=section, field=name, unit=None, written="")
    fields = {f.name: f for f in dataclasses.fields(schema.record(mechanism, section, table))}
    stem = without_unit(name, 0.0, fields)[0]
    if stem not in fields:
        raise BadInput(f"{option} {key} is not known; {schema.instead(name, fields)}")
    written = "" if stem == name else name.rpartition("_")[2]
    return Place(section=section, field=stem, unit=fields[stem].metadata.get("unit"), written=written)


def override(tables: Json, mechanism: str, key: str, value: object) -> None:
    """Replace one value, by its dotted key or a bare one that is unique. tables: raw values; changed in place."""
    section, name = _divided(tables, mechanism, key, "--set")
    table = tables.setdefault(section, {})
    if not isinstance(table, dict):
        raise BadInput(f"--set {key}: {section!r} is no section; {suggest(section, schema.sections())}")
    before = _keys(mechanism, section, table) if name == schema.selector(section) else set()
    stem, _, unit = name.rpartition("_")
    table.pop(stem if stem in table and name not in table and unit in units() else name, None)
    for other in [k for k in table if k.rpartition("_")[0] == name and k.rpartition("_")[2] in units()]:
        table.pop(other)
    for other in [k for k in table if letter_of(k, {name}) != k]:
        table.pop(other)
    table[name] = value
    # another variant has other keys; those that only the old one knew go with it
    for gone in before - (_keys(mechanism, section, table) if before else set()):
        table.pop(gone, None)


def _divided(tables: Json, mechanism: str, key: str, option: str) -> tuple[str, str]:
    """Section and name of a dotted key, of a bare one that is unique, or of a letter of a link or a joint."""
    section, dot, name = RENAMED.get(key, (key, ""))[0].partition(".")
    if dot and section not in schema.sections() and section not in tables:
        for letters in schema.LETTERS:
            if (letter := letter_of(key, _keys(mechanism, letters, {}))) != key:
                return letters, letter
    if "." in name and section in schema.LETTERS:
        name = letter_of(name, _keys(mechanism, section, {}))
    return (section, name) if dot else (_home(tables, mechanism, key, option), key)


def flat(tables: Json) -> Json:
    """Tables of a case whose letters have no tables of their own: TOML reads `rod.mass = 2` as one of a table rod."""
    new = dict(tables)
    for section in schema.LETTERS:
        if isinstance(table := new.get(section), dict):
            new[section] = {}
            for key, value in table.items():
                inner = value if isinstance(value, dict) else {}
                new[section] |= {f"{key}.{k}": v for k, v in inner.items()} or {key: value}
    return new


def _home(tables: Json, mechanism: str, key: str, option: str) -> str:
    """The only section that has a bare key."""
    sections = {s: t for s, t in tables.items() if isinstance(t, dict)}
    keys = {s: _keys(mechanism, s, t) for s, t in sections.items()}
    stem, _, unit = key.rpartition("_")
    homes = [s for s, names in keys.items() if key in names or (stem in names and unit in units())]
    # a key that the file gives in one section only is meant, although others may know it too
    homes = [s for s in homes if {key, stem} & sections[s].keys()] or homes
    if len(homes) == 1:
        return homes[0]
    if homes:
        raise BadInput(f"{option} {key} is in several sections; write {' or '.join(f'{s}.{key}' for s in homes)}")
    near = difflib.get_close_matches(key, sorted(set().union(*keys.values())), n=3)
    hint = f"did you mean {' or '.join(near)}? " if near else ""
    raise BadInput(f"{option} {key} is not known; {hint}give section.key, sections here are {', '.join(sections)}")


def _keys(mechanism: str, section: str, table: Json) -> set[str]:
    selector = schema.selector(section)
    known = {selector} if selector else set()
    try:
        return known | {f.name for f in dataclasses.fields(schema.record(mechanism, section, table))}
    except (KeyError, BadInput):
        return known | set(table)


@functools.lru_cache(maxsize=256)
def paths(kind: type[Record]) -> tuple[str, ...]:
    """Names of the values that name a file or a case."""
    return tuple(f.name for f in dataclasses.fields(kind) if "to" in f.metadata)

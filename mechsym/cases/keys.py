"""Every section and key that a case may have, read off the records: unit, range, default, meaning."""

import ast
import dataclasses
import functools
import inspect
import textwrap
from collections.abc import Mapping
from typing import Any

from mechsym import mechanisms
from mechsym.cases import schema
from mechsym.cases.needs import commands_of
from mechsym.errors import BadInput, suggest
from mechsym.quantities import load

_BOUNDS = ("above", "below", "low", "high")


def keys(section: str | None = None) -> list[dict[str, Any]]:
    """Rows for people and programs: one for each key of each section and variant.

    Returns
    -------
    rows : list of dict
        Keys `section`, `variant` (such as `law = coil`; empty), `key`, `kind`, `unit`, `above`, `below`, `low`,
        `high`, `options`, `default`, `required`, `about`, `commands`

    Raises
    ------
    BadInput
        No such section
    """
    if section is not None and section not in schema.sections():
        raise BadInput(f"section {section!r} is not known; {suggest(section, schema.sections())}")
    wanted = schema.sections() if section is None else [section]
    return [row for name in wanted for variant, cls in variants(name).items() for row in _rows(name, variant, cls)]


def variants(section: str) -> Mapping[str, Any]:
    """The records that a section may become, by what chooses them: `law = coil`, `mechanism = crosshead`, or nothing.

    Sections of the mechanism's own letters are listed for the built-in mechanisms.
    """
    if section in schema.LETTERS:
        known = [name for name in mechanisms.names() if name != "rodless_constraints"]
        if section != "parameters":  # a train's letters depend on its number of throws
            known.remove("crank_train")
        return {f"mechanism = {name}": schema.record(name, section, {}) for name in known}
    entry = schema.ENTRIES[section]
    if isinstance(entry, tuple):
        return {f"{entry[0]} = {name}": load(record) for name, record in entry[1].items()}
    return {"": load(entry)}


def _rows(section: str, variant: str, cls: Any) -> list[dict[str, Any]]:
    commands = commands_of(section)
    return [
        {"section": section, "variant": variant, "key": field.name, "kind": kind(field),
         "unit": field.metadata.get("unit"), **{name: field.metadata.get(name) for name in _BOUNDS},
         "options": list(field.metadata.get("options", ())) or None, "default": _default(field),
         "required": required(field), "about": meaning(cls, field),
         "commands": commands}
        for field in dataclasses.fields(cls)
    ]  # fmt: skip


def meaning(cls: Any, field: dataclasses.Field) -> str:
    """What a key of a section's record means."""
    return field.metadata.get("about") or comments(cls).get(field.name, "")


def required(field: dataclasses.Field) -> bool:
    """Whether a key has to be given."""
    return field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING


def kind(field: dataclasses.Field) -> str:
    """What a key takes: number, list of numbers, word, text, whole number, true or false, table."""
    text = str(getattr(field.type, "__name__", "") if isinstance(field.type, type) else field.type)
    if "options" in field.metadata:
        return "word"
    many = "tuple[" in text
    if "unit" in field.metadata:
        one = any(isinstance(part, type) for part in getattr(field.type, "__args__", ())) or not many
        return "number or list of numbers" if many and one else "list of numbers" if many else "number"
    if "dict" in text:
        return "table"
    single = "text" if "str" in text else "whole number" if "int" in text else "true or false"
    return f"list: {single}" if many else single


def _default(field: dataclasses.Field) -> Any:
    if field.default is not dataclasses.MISSING:
        return list(field.default) if isinstance(field.default, tuple) else field.default
    return field.default_factory() if field.default_factory is not dataclasses.MISSING else None


@functools.lru_cache(maxsize=256)
def comments(cls: Any) -> Mapping[str, str]:
    """What a `#:` comment says of each field of a record, beside it or above it."""
    try:
        source = textwrap.dedent(inspect.getsource(cls))
    except (OSError, TypeError):  # a record that was made at run time
        return {}
    lines, said, above, beside = source.splitlines(), {}, "", False
    fields = {node.lineno: node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.AnnAssign)}
    for number, line in enumerate(lines, 1):
        text = line.partition("#:")[2].strip()
        if number in fields:
            name = fields[number].target
            said[getattr(name, "id", "")] = text or above
            above = above if not text and above else ""
            beside = False
        elif line.strip().startswith("#:"):
            above, beside = f"{above} {text}" if beside else text, True
    return {name: text for name, text in said.items() if text}

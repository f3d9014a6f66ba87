"""Every section and key that a case may have, read off the records: as rows, and as JSON Schema for editors."""

import dataclasses
from collections.abc import Mapping

from mechsym import mechanisms
from mechsym.cases import schema
from mechsym.cases.needs import commands_of
from mechsym.errors import BadInput, suggest
from mechsym.files import Json
from mechsym.quantities import allowed, load
from mechsym.quantities.records import Field, Record
from mechsym.quantities.results import comments

# bounds of a value, as JSON Schema calls them
_BOUNDS = {"above": "exclusiveMinimum", "below": "exclusiveMaximum", "low": "minimum", "high": "maximum"}
_NUMBER = {"type": "string", "pattern": r"^\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*[^\d\s]*.*$"}


def keys(section: str | None = None) -> list[Json]:
    """Rows for people and programs: one for each key of each section and variant.

    Returns rows: list of dict, keys `section`, `variant` (such as `law = coil`; empty), `key`, `kind`, `unit`, `above`,
    `below`, `low`, `high`, `options`, `default`, `required`, `about`, `commands`. Raises BadInput: no such section.
    """
    if section is not None and section not in schema.sections():
        raise BadInput(f"section {section!r} is not known; {suggest(section, schema.sections())}")
    wanted = schema.sections() if section is None else [section]
    return [row for name in wanted for variant, cls in variants(name).items() for row in _rows(name, variant, cls)]


def variants(section: str) -> Mapping[str, type[Record]]:
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


def _rows(section: str, variant: str, cls: type[Record]) -> list[Json]:
    rows = []
    for field in dataclasses.fields(cls):
        default: object = None
        if field.default is not dataclasses.MISSING:
            default = list(field.default) if isinstance(field.default, tuple) else field.default
        elif field.default_factory is not dataclasses.MISSING:
            default = field.default_factory()
        rows.append({
            "section": section, "variant": variant, "key": field.name, "kind": kind(field),
            "unit": field.metadata.get("unit"), **{name: field.metadata.get(name) for name in _BOUNDS},
            "options": list(field.metadata.get("options", field.metadata.get("words", ()))) or None, "default": default,
            "required": required(field), "about": meaning(cls, field), "commands": commands_of(section),
        })  # fmt: skip
    return rows


def meaning(cls: object, field: Field) -> str:
    """What a key of a section's record means."""
    return field.metadata.get("about") or comments(cls).get(field.name, "")


def required(field: Field) -> bool:
    """Whether a key has to be given."""
    return field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING


def kind(field: Field) -> str:
    """What a key takes: number, list of numbers, word, text, file, case, whole number, true or false, table."""
    text = str(getattr(field.type, "__name__", "") if isinstance(field.type, type) else field.type)
    if "options" in field.metadata:
        return "word"
    if "to" in field.metadata:
        return str(field.metadata["to"])
    many = "tuple[" in text
    if "unit" in field.metadata:
        one = any(isinstance(part, type) for part in getattr(field.type, "__args__", ())) or not many
        return "number or list of numbers" if many and one else "list of numbers" if many else "number"
    if "dict" in text:
        return "table"
    single = "text" if "str" in text else "whole number" if "int" in text else "true or false"
    return f"list: {single}" if many else single


def takes(field: Field) -> str:
    """What a key takes, in words: `number in m, > 0`."""
    meta = field.metadata
    if "options" in meta:
        return ", ".join(str(option) for option in meta["options"])
    unit = meta.get("unit")
    inside = f" in {unit}" if unit and unit != "-" else ""
    bounds = allowed(meta) if unit else ""
    return f"{kind(field)}{inside}" + (f", {bounds}" if bounds else "")


def json_schema() -> Json:
    """The schema, draft 7, of every case that `mechsym check` may find nothing wrong with."""
    sections = {name: _section(name) for name in schema.sections() if name not in schema.LETTERS}
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "mechsym case",
        "type": "object",
        "required": ["mechanism"],
        "properties": {
            "mechanism": {"type": "string", "description": "name of a mechanism, or ./FILE.py"},
            "source": {"type": "string", "description": "where the data come from"},
            "about": {"type": "string", "description": "one line"},
            "doubts": {"type": "object", "description": "accepted doubts by their code: { up_to, why }"},
            **{name: {"type": "object"} for name in schema.LETTERS},
            **sections,
        },
        "allOf": [_of_mechanism(variant) for variant in variants("parameters")],
        "additionalProperties": False,
    }


def _of_mechanism(variant: str) -> Json:
    own = {section: variants(section) for section in schema.LETTERS}
    letters = {section: _record(records[variant], "") for section, records in own.items() if variant in records}
    name = variant.partition(" = ")[2]
    return {"if": {"properties": {"mechanism": {"const": name}}}, "then": {"properties": letters}}


def _section(name: str) -> Json:
    records, selector = variants(name), schema.selector(name)
    if not selector:
        return _record(records[""], "")
    names, choices = [], []
    for variant, cls in records.items():
        names.append(variant.partition(" = ")[2])
        choices.append({"if": {"properties": {selector: {"const": names[-1]}}}, "then": _record(cls, selector)})
    return {"type": "object", "required": [selector], "properties": {selector: {"enum": names}}, "allOf": choices}


def _record(cls: type[Record], selector: str) -> Json:
    properties: Json = {}
    with_unit: Json = {}
    needed: list[Json] = []
    for field in dataclasses.fields(cls):
        alone: Json = {"required": [field.name]}
        properties[field.name] = _field(field, meaning(cls, field))
        if "unit" in field.metadata:
            # a key may name its unit, as speed_rpm does; then the key alone is not there
            pattern = f"^{field.name}_[A-Za-z%]+$"
            with_unit[pattern] = {}
            alone = {"anyOf": [alone, {"not": {"propertyNames": {"not": {"pattern": pattern}}}}]}
        if required(field):
            needed.append(alone)
    if selector:
        properties.setdefault(selector, {})
    known = {"properties": properties, "patternProperties": with_unit, "additionalProperties": False}
    return {"type": "object", **known} | ({"allOf": needed} if needed else {})


def _field(field: Field, about: str) -> Json:
    described, takes_kind = {"description": f"{about} ({takes(field)})".strip()}, kind(field)
    if "options" in field.metadata:
        return described | {"enum": list(field.metadata["options"])}
    if "unit" in field.metadata:
        bounds = {name: field.metadata[k] for k, name in _BOUNDS.items() if field.metadata.get(k) is not None}
        one: Json = {"anyOf": [{"type": "number", **bounds}, _NUMBER]}
        many: Json = {"type": "array", "items": one}
        either = {"anyOf": [*one["anyOf"], many]}
        return described | {"number": one, "list of numbers": many}.get(takes_kind, either)
    simple = dict.fromkeys(("text", "file", "case"), "string")
    simple |= {"whole number": "integer", "true or false": "boolean", "table": "object"}
    if takes_kind.startswith("list: "):
        return described | {"type": "array", "items": {"type": simple[takes_kind.removeprefix("list: ")]}}
    return described | {"type": simple[takes_kind]}

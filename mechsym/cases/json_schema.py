"""JSON Schema of case files, for editors: keys, units in words, ranges, options, as the records declare them."""

import dataclasses
from typing import Any

from mechsym.cases import schema
from mechsym.cases.check import takes
from mechsym.cases.keys import comments, kind, required, variants

_NUMBER = {"type": "string", "pattern": r"^\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*[^\d\s]*.*$"}
_BOUND = {"above": "exclusiveMinimum", "below": "exclusiveMaximum", "low": "minimum", "high": "maximum"}


def json_schema() -> dict[str, Any]:
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
        "allOf": [_of_mechanism(name) for name in _mechanisms()],
        "additionalProperties": False,
    }


def _mechanisms() -> list[str]:
    return [variant.partition(" = ")[2] for variant in variants("parameters")]


def _of_mechanism(name: str) -> dict[str, Any]:
    chosen = f"mechanism = {name}"
    return {
        "if": {"properties": {"mechanism": {"const": name}}},
        "then": {"properties": {s: _record(variants(s)[chosen], "") for s in schema.LETTERS if chosen in variants(s)}},
    }


def _section(name: str) -> dict[str, Any]:
    found, selector = variants(name), schema.selector(name) or ""
    if not selector:
        return _record(found[""], "")
    names = {variant: variant.partition(" = ")[2] for variant in found}
    return {
        "type": "object",
        "required": [selector],
        "properties": {selector: {"enum": list(names.values())}},
        "allOf": [
            {"if": {"properties": {selector: {"const": names[v]}}}, "then": _record(cls, selector)}
            for v, cls in found.items()
        ],
    }


def _record(cls: Any, selector: str) -> dict[str, Any]:
    fields, said = dataclasses.fields(cls), comments(cls)
    one = {f.name: _field(f, f.metadata.get("about") or said.get(f.name, "")) for f in fields}
    with_unit: dict[str, Any] = {f"^{f.name}_[A-Za-z%]+$": {} for f in fields if "unit" in f.metadata}
    needed = [f.name for f in fields if required(f)]
    # a key may name its unit, as speed_rpm does; then the key alone is not there
    given = [_given(name, f"{name}_" if f"^{name}_[A-Za-z%]+$" in with_unit else "") for name in needed]
    return {
        "type": "object",
        "properties": one | ({selector: {}} if selector and selector not in one else {}),
        "patternProperties": with_unit,
        "additionalProperties": False,
        **({"allOf": given} if given else {}),
    }


def _given(name: str, stem: str) -> dict[str, Any]:
    if not stem:
        return {"required": [name]}
    return {"anyOf": [{"required": [name]}, {"not": {"propertyNames": {"not": {"pattern": f"^{stem}[A-Za-z%]+$"}}}}]}


def _field(field: dataclasses.Field, about: str) -> dict[str, Any]:
    told: dict[str, Any] = {"description": f"{about} ({takes(field)})".strip()}
    if "options" in field.metadata:
        return told | {"enum": list(field.metadata["options"])}
    if "unit" in field.metadata:
        bounds = {_BOUND[k]: field.metadata[k] for k in _BOUND if field.metadata.get(k) is not None}
        one: dict[str, Any] = {"anyOf": [{"type": "number", **bounds}, _NUMBER]}
        lists = {"type": "array", "items": one}
        known = kind(field)
        return told | {"number": one, "list of numbers": lists}.get(known, {"anyOf": [*one["anyOf"], lists]})
    simple = {"text": "string", "whole number": "integer", "true or false": "boolean", "table": "object"}
    known = kind(field)
    if known.startswith("list: "):
        return told | {"type": "array", "items": {"type": simple[known.removeprefix("list: ")]}}
    return told | {"type": simple[known]}

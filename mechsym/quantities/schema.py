"""JSON Schema of what results tell, from the fields that the teller reads: numbers with `unit` and `description`."""

import dataclasses
import types
import typing
from collections.abc import Mapping, Sequence
from pathlib import PurePath
from typing import Any

import numpy as np

from mechsym.quantities.results import Columns, Entry, entries_of

Json = dict[str, Any]
# a number that is not finite is told as null
_PLAIN: dict[object, Json] = {
    float: {"type": ["number", "null"]}, int: {"type": "integer"}, bool: {"type": "boolean"}, str: {"type": "string"},
    type(None): {"type": "null"}, np.ndarray: {"type": "array"}, dict: {"type": "object"}, list: {"type": "array"},
    tuple: {"type": "array"},
}  # fmt: skip


def schema(kind: type) -> Json:
    """Schema, draft 7, of the JSON that `tell` makes of a result of a class.

    >>> from mechsym.quantities.results import quantity, result
    >>> @result
    ... class Wheel:
    ...     inertia: float = quantity("kg*m^2", about="about the shaft")
    >>> schema(Wheel)["properties"]["inertia"]
    {'type': ['number', 'null'], 'unit': 'kg*m^2', 'description': 'about the shaft'}
    """
    properties: dict[str, Json] = {}
    required: list[str] = []
    others: list[Json] = []  # names of any kind that stand among them
    for entry in entries_of(kind):
        if entry.inline:
            parts = [one for one in _of(entry.hint).get("anyOf", [_of(entry.hint)]) if one != _PLAIN[type(None)]]
            for part in parts:
                properties |= part.get("properties", {})
                others += [part["additionalProperties"] | _said(entry)] if "additionalProperties" in part else []
            required += parts[0].get("required", []) if len(parts) == 1 and not entry.optional else []
        else:
            properties[entry.name] = _of(entry.hint) | _said(entry)
            required += [] if entry.optional else [entry.name]
    data = {"type": "object", "properties": properties, "required": required}
    return data | ({"additionalProperties": {"anyOf": others}} if others else {})


def _said(entry: Entry) -> Json:
    unit = {"unit": entry.unit.replace("@", "in ")} if entry.unit else {}
    return unit | ({"description": entry.about} if entry.about else {})


def _of(hint: object) -> Json:
    origin, inner = typing.get_origin(hint), typing.get_args(hint)
    if origin is typing.Annotated:
        return _of(inner[0])
    if origin in (typing.Union, types.UnionType):
        return {"anyOf": [_of(one) for one in inner]}
    plain = origin or hint
    if isinstance(plain, type) and issubclass(plain, Columns):  # a number, a curve or a result by name
        return {"type": "object", "additionalProperties": {"not": {"type": "boolean"}}}
    if isinstance(plain, type) and issubclass(plain, Mapping) and inner:
        return {"type": "object", "additionalProperties": _of(inner[1])}
    if plain in _PLAIN and not (inner and plain in (list, tuple)):
        return dict(_PLAIN[plain])
    if isinstance(plain, type) and issubclass(plain, PurePath):
        return {"type": "string"}
    if isinstance(plain, type) and issubclass(plain, Sequence) and inner:
        return {"type": "array", "items": _items(inner)}
    if dataclasses.is_dataclass(hint) and isinstance(hint, type):
        return schema(hint)
    return schema(hint) if isinstance(hint, type) and any(entries_of(hint)) else {}


def _items(inner: Sequence[object]) -> Json:
    kinds = [one for one in inner if one is not ...]
    return _of(kinds[0]) if len(kinds) == 1 else {"anyOf": [_of(one) for one in kinds]}

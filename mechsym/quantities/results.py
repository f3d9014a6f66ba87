"""Results that know their units: what is told of a result is a field or a property that carries its unit.

result      a record whose values are not checked against a range, as those of an input are
quantity    a field that is a number, or a list or mapping of numbers, in one unit (see `records`)
part        a field that is a word, or another result, a list or a mapping of results
computed    the same for a property, computed when it is first asked for
seen        the same of what stands in another record of the result
Columns     numbers or curves by name, each with a unit of its own

Other fields stay behind the result and are not told. One teller serves all readers:

tell        the nested plain mapping that JSON shows
some        columns of some of its names; what the others need is not computed
leaves      each number of a result with its dotted path and its unit; `walk` has the words too
declared    the same of a class, before anything is computed, with its meaning: a `*` stands for names, `[]` for places
units_of    the units of a class or a result by name, for the heads of a table

    @result
    class Check:
        torque: float = quantity("N*m")  #: Mean of the load
        reason: str = part()  #: Why it does not turn

        @computed("rad/s")
        def speed(self) -> float:
            "Mean speed of the shaft."

The meaning is the comment `#:` or the first line of the docstring. A unit `@name` stands in the field of that name.
"""

import ast
import dataclasses
import functools
import inspect
import textwrap
import types
import typing
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np

from mechsym.quantities.records import OPTIONAL, PART, SeenElsewhere
from mechsym.quantities.records import part as part
from mechsym.quantities.records import quantity as quantity
from mechsym.quantities.records import result as result
from mechsym.quantities.records import seen as seen

_INLINE = "inline"  # in place of a unit: the names of the part stand among those of the whole
_ELSEWHERE = "@"  # a unit that stands in another field


T = TypeVar("T")
V = TypeVar("V")


class Leaf(NamedTuple):
    """A number of a result, or a list of numbers."""

    path: str
    value: object
    unit: str


class Declared(NamedTuple):
    """A number that the results of a class tell."""

    path: str
    unit: str
    about: str


class Entry(NamedTuple):
    """One name that a class tells: a number with its unit, or a word or part without."""

    name: str
    hint: object
    unit: str | None
    about: str
    inline: bool
    optional: bool


class computed:
    """A property of a result that is told like a field, computed when it is first asked for.

    unit: unit of its numbers, `-` of a pure number; None of words and of other results. card: as of `quantity`.
    """

    def __init__(self, unit: str | None = None, card: str = "") -> None:
        self.unit, self.card = unit, card

    def __call__(self, function: Callable[[T], V]) -> "_Computed[V]":
        """The property of that function."""
        return _Computed(function, self.unit, self.card)


class _Computed(functools.cached_property[V]):
    def __init__(self, function: Callable[[T], V], unit: str | None, card: str) -> None:
        super().__init__(function)
        self.unit, self.metadata = unit, {"unit": unit, "card": card, "digits": 4}


class Columns(Mapping[str, Any]):
    """Numbers or curves by name, each with its unit.

    values: mapping of str to float or ndarray, in the units of `units` [unit]. units: of each name, `-` of a pure
    number; it may know more names.
    """

    def __init__(self, values: Mapping[str, Any], units: Mapping[str, str]) -> None:
        missing = [name for name in values if name not in units]
        if missing:
            raise KeyError(f"no unit of {', '.join(missing)}")
        self._values, self.units = dict(values), {name: units[name] for name in values}

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def each(self, function: Callable[[Any], Any]) -> "Columns":
        """A number of each column, in its unit."""
        return Columns({name: function(values) for name, values in self.items()}, self.units)


def _listed(kind: type) -> Mapping[str, str | None]:
    """Names that a class tells with their units: fields, then properties; of a class that is no result every field."""
    every = not getattr(kind, "__result__", False)
    names: dict[str, str | None] = {}
    for field in dataclasses.fields(kind) if dataclasses.is_dataclass(kind) else ():
        if every or "unit" in field.metadata or PART in field.metadata:
            names[field.name] = _INLINE if field.metadata.get(PART) == "inline" else field.metadata.get("unit")
    for parent in reversed(kind.__mro__):
        names |= {
            name: value.unit for name, value in vars(parent).items() if isinstance(value, (_Computed, SeenElsewhere))
        }
    return names


_units: Callable[[type], Mapping[str, str | None]] = functools.cache(_listed)


def _left_out(kind: object) -> frozenset[str]:
    """Names of a class that are left out where they are empty."""
    fields = dataclasses.fields(kind) if dataclasses.is_dataclass(kind) else ()
    return frozenset(field.name for field in fields if field.metadata.get(OPTIONAL))


_optional: Callable[[type], frozenset[str]] = functools.cache(_left_out)


def _names(value: object) -> dict[str, str | None]:
    """Names that a result tells with their units; empty of what is no result."""
    kind, names = type(value), {}
    for name, unit in _units(kind).items():
        one = getattr(value, name) if name in _optional(kind) else unit
        if name not in _optional(kind) or not (one is None or (hasattr(one, "__len__") and not len(one))):
            names[name] = unit
    return names


_PLAIN = frozenset({float, int, str, bool, type(None)})  # most values of long lists, looked at first


def tell(value: object, only: Container[str] | None = None) -> Any:
    """A result as nested mappings and lists under the names that it tells; everything else as it is.

    only: collection of str, optional, names that are wanted; what the others need is not computed.

    >>> @result
    ... class Wheel:
    ...     inertia: float = quantity("kg*m^2")
    ...     drawing: object = None
    >>> tell({"wheels": [Wheel(inertia=2.0)]})
    {'wheels': [{'inertia': 2.0}]}
    """
    if type(value) in _PLAIN:
        return value
    if _units(type(value)):
        data: dict[str, object] = {}
        for name, unit in _names(value).items():
            if unit == _INLINE:
                data |= tell(getattr(value, name), only)
            elif only is None or name in only:
                data[name] = tell(getattr(value, name))
        return data
    if isinstance(value, Mapping):
        return {name: tell(inner) for name, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [tell(inner) for inner in value]
    return value


def some(value: object, only: Container[str]) -> Columns:
    """Some of the names that a result tells; what the others need is not computed.

    >>> @result
    ... class Wheel:
    ...     inertia: float = quantity("kg*m^2")
    ...     name: str = part()
    >>> dict(some(Wheel(inertia=2.0, name="front"), ("name",)))
    {'name': 'front'}
    """
    units = _resolved(value)
    return Columns({name: getattr(value, name) for name in units if name in only}, units)


def leaves(value: object) -> Iterator[Leaf]:
    """Numbers of a result, and lists of numbers as one, in the order in which they are told.

    >>> @result
    ... class Wheel:
    ...     inertia: float = quantity("kg*m^2")
    >>> next(leaves(Wheel(inertia=2.0)))
    Leaf(path='inertia', value=2.0, unit='kg*m^2')
    """
    # nothing may stand for a word too
    return (leaf for leaf in walk(value) if _numeric(leaf.value) and (leaf.unit or leaf.value is not None))


def walk(value: object, path: str = "", unit: str = "", units: Mapping[str, str] | None = None) -> Iterator[Leaf]:
    """All that a result tells: numbers, lists of numbers as one, and words, whose unit is empty.

    units: of names below; a mapping that has `units` of its own knows better.
    """
    if _units(type(value)):
        inner = {name: (getattr(value, name), unit) for name, unit in _resolved(value).items()}
    elif isinstance(value, Mapping):
        units = getattr(value, "units", units or {})
        # a part that has no unit of its own has that of the field it stands in
        inner = {name: (one, units.get(name) or unit) for name, one in value.items()}
    elif isinstance(value, (list, tuple)) and not _numeric(value):
        inner = {}
        for i, one in enumerate(value):
            yield from walk(one, f"{path}[{i}]", unit, units)
    else:
        inner = {}
        yield Leaf(path, value, unit)
    for name, (one, own) in inner.items():
        if own == _INLINE:
            yield from walk(one, path, unit, units)
        else:
            yield from walk(one, f"{path}.{name}" if path else str(name), own, units)


def _resolved(value: object) -> dict[str, str]:
    named = {name: unit or "" for name, unit in _names(value).items()}
    return {n: getattr(value, u[1:]) or "-" if u.startswith(_ELSEWHERE) else u for n, u in named.items()}


def _numeric(value: object) -> bool:
    """Whether something is a number, none, or a list of them; yes or no is a word."""
    if isinstance(value, np.ndarray):
        return value.dtype.kind in "if"
    if isinstance(value, (list, tuple)):
        return bool(value) and all(map(_numeric, value))
    return value is None or (isinstance(value, (int, float, np.number)) and not isinstance(value, bool))


def declared(kind: type, path: str = "") -> Iterator[Declared]:
    """Numbers that the results of a class tell.

    >>> @result
    ... class Wheel:
    ...     inertia: float = quantity("kg*m^2", about="about the shaft")
    >>> @result
    ... class Engine:
    ...     wheels: tuple[Wheel, ...] = part()
    >>> next(declared(Engine))
    Declared(path='wheels[].inertia', unit='kg*m^2', about='about the shaft')
    """
    for entry in entries_of(kind):
        inner = path if entry.inline else f"{path}.{entry.name}" if path else entry.name
        yield from _declared_by(entry.hint, inner, entry.unit, entry.about)


def entries_of(kind: type) -> Iterator[Entry]:
    """What a class tells, in the order in which it does."""
    hints = typing.get_type_hints(kind)
    fields = {f.name: f for f in dataclasses.fields(kind)} if dataclasses.is_dataclass(kind) else {}
    for name, unit in _units(kind).items():
        if name in hints:
            # the comment beside a field, in the class that declares it
            said = next((commented[name] for parent in kind.__mro__ if name in (commented := comments(parent))), "")
            about = (fields[name].metadata.get("about") if name in fields else "") or said
            hint = hints[name] if name in fields else typing.get_args(hints[name])[0]
        else:
            function = inspect.getattr_static(kind, name).func
            hint = typing.get_type_hints(function).get("return")
            about = (inspect.getdoc(function) or "").partition("\n")[0].rstrip(".")
        inline = unit == _INLINE
        yield Entry(name, hint, None if inline else unit, about, inline, name in _optional(kind))


def _declared_by(hint: object, path: str, unit: str | None, about: str) -> Iterator[Declared]:
    origin, inner = typing.get_origin(hint), typing.get_args(hint)
    names = f"{path}.*" if path else "*"
    if origin in (typing.Union, types.UnionType):
        seen = {entry for option in inner for entry in _declared_by(option, path, unit, about)}
        yield from sorted(seen)
    elif isinstance(origin, type) and issubclass(origin, Mapping):
        yield from _declared_by(inner[1], names, unit, about)
    elif isinstance(origin, type) and issubclass(origin, Sequence):
        yield from _declared_by(inner[0], path if unit else f"{path}[]", unit, about)
    elif isinstance(hint, type) and issubclass(hint, Columns):
        yield Declared(names, "of its column", about)
    elif isinstance(hint, type) and _units(hint):
        yield from declared(hint, path)
    elif unit is not None and hint is not type(None):
        yield Declared(path, unit.replace(_ELSEWHERE, "in "), about)


def names_of(kind: type) -> tuple[str, ...]:
    """Names that the results of a class tell; what stands inline is not among them."""
    return tuple(name for name, unit in _units(kind).items() if unit != _INLINE)


def on_card(kind: type, name: str) -> Mapping[str, Any]:
    """Word `card`, `unit` and `digits` of a number of a class of results, of a field or computed."""
    fields = (field.metadata for field in dataclasses.fields(kind) if field.name == name)
    return next(fields, None) or inspect.getattr_static(kind, name).metadata


def units_of(value: object) -> dict[str, str]:
    """Units of the names that a class, a result or columns tell; words have none.

    >>> @result
    ... class Wheel:
    ...     inertia: float = quantity("kg*m^2")
    ...     name: str = part()
    >>> units_of(Wheel)
    {'inertia': 'kg*m^2'}
    """
    if isinstance(value, Columns):
        return dict(value.units)
    units = _units(value) if isinstance(value, type) else _resolved(value)
    return {name: unit for name, unit in units.items() if unit and unit != _INLINE}


@functools.lru_cache(maxsize=256)
def comments(cls: type) -> Mapping[str, str]:
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

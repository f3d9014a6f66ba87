"""Records that declare unit and range at each field and check themselves."""

import dataclasses
import functools
import inspect
import math
import operator
from collections.abc import Mapping
from typing import Any, ClassVar, Literal, NoReturn, Protocol, TypeVar, dataclass_transform

from mechsym.errors import BadInput, shown
from mechsym.quantities.units import Scalar


def quantity(
    unit: str,
    *,
    default: Scalar = dataclasses.MISSING,
    above: float | None = None,
    below: float | None = None,
    low: float | None = None,
    high: float | None = None,
    about: str = "",
    only: tuple[str, ...] = (),
    moved: str = "",
    optional: bool = False,
    card: str = "",
    digits: int = 4,
) -> Any:
    """A field of a record that is a number with a unit and a range.

    unit: SI unit, `"-"` for a pure number. default: value when none is given; without it the field must be given
    [unit]. above, below: bounds that the value must not reach [unit]. low, high: bounds that the value may reach
    [unit]. Returns field: dataclasses.Field, to be assigned in the class body.

    moved: key that tells it since; files that still have this one are read, and it is left alone. optional: whether a
    result does not tell it where it is None. card: word that names it on a card of a report, told in so many `digits`.
    only: a choice of the same record and the words with which this value is read; always where it is empty.
    """
    metadata = {"unit": unit, "above": above, "below": below, "low": low, "high": high, "about": about, "only": only}
    if moved:
        metadata["moved"] = moved
    if card:
        metadata |= {"card": card, "digits": digits}
    if optional:
        metadata[OPTIONAL] = True
    return dataclasses.field(default=default, metadata=metadata)


def choice(*options: str, default: object = dataclasses.MISSING, about: str = "") -> Any:
    """A field of a record, to be assigned in the class body, that is one of several names."""
    return dataclasses.field(default=default, metadata={"options": options, "about": about})


def reference(to: str, default: object = dataclasses.MISSING, words: tuple[str, ...] = ()) -> Any:
    """A field of a record, to be assigned in the class body, that names a `file` or a `case`.

    A relative path counts from the working folder or, where nothing is there, from the folder of the case. words: what
    may stand there in place of a name.
    """
    return dataclasses.field(default=default, metadata={"to": to, "words": words})


Field = dataclasses.Field[object]
PART = "part"  #: Metadata of a field that is told and is no number
OPTIONAL = "optional"  #: Metadata of a field that is not told where it is empty


def part(default: object = dataclasses.MISSING, inline: bool = False, optional: bool = False) -> Any:
    """A field of a result that is a word, another result, or a list or mapping of results.

    inline: whether the names of the other result stand among those of this one.
    optional: whether it is left out where it is empty.
    """
    return dataclasses.field(default=default, metadata={PART: "inline" if inline else "part", OPTIONAL: optional})


class SeenElsewhere(functools.cached_property[object]):
    """A property of a result that stands in another record, by its path from here; told like one that is computed."""

    def __init__(self, path: str, unit: str | None, card: str) -> None:
        super().__init__(operator.attrgetter(path))
        self.unit, self.metadata = unit, {"unit": unit, "card": card, "digits": 4}


def seen(path: str, unit: str | None = None, *, card: str = "", init: Literal[False] = False) -> Any:
    """A number of a result, or with no unit a word or part, that stands in another record: `"guide.spring.H"`.

    unit, card: as of `quantity`. init: False, for it is not given.
    """
    return SeenElsewhere(path, unit, card)


def unread(record: "Record") -> dict[str, str]:
    """Values of a record that its choices leave unread, each with that choice and its word."""
    rules = {field.name: field.metadata.get("only", ()) for field in dataclasses.fields(record)}
    chosen = {name: getattr(record, rule[0]) for name, rule in rules.items() if rule}
    return {name: f"{rules[name][0]} is {word}" for name, word in chosen.items() if word not in rules[name][1:]}


def moved(record: "Record") -> dict[str, str]:
    """Values of a record that only older files have, each with the key that tells it since."""
    keys = {field.name: field.metadata.get("moved", "") for field in dataclasses.fields(record)}
    return {name: key for name, key in keys.items() if key}


def allowed(metadata: Mapping[str, float | None]) -> str:
    """The range of a field in words.

    metadata: metadata of a field made by `quantity`. Returns text: for example ``> 0 and <= 1``.

    >>> allowed({"above": 0, "high": 1})
    '> 0 and <= 1'
    """
    words = [("above", ">"), ("low", ">="), ("below", "<"), ("high", "<=")]
    return " and ".join(f"{sign} {metadata[key]:g}" for key, sign in words if metadata.get(key) is not None)


T = TypeVar("T")


class Record(Protocol):
    """Any record: what `dataclasses` take."""

    __dataclass_fields__: ClassVar[dict[str, Field]]

    def __init__(self, **values: object) -> None: ...


_LONGEST, _LONG_VALUE = 400, 60  # characters of a record and of one value where a record is shown


@dataclass_transform(
    frozen_default=True, kw_only_default=True, field_specifiers=(quantity, choice, part, dataclasses.field)
)
def record(cls: type[T]) -> type[T]:
    """A frozen dataclass with keyword arguments whose quantities and choices are checked when it is made.

    A `__post_init__` of the class runs behind that check and may rely on it.

    >>> @record
    ... class Rod:
    ...     length: float = quantity("m", above=0)
    >>> Rod(length=2.0)
    Rod(length=2.0)
    """
    own = cls.__dict__.get("__post_init__")

    def checked(self: Record) -> None:
        check(self)
        if own is not None:
            own(self)

    if any(isinstance(value, dataclasses.Field) and value.metadata for value in vars(cls).values()):
        cls.__post_init__ = checked  # type: ignore[attr-defined]
    return _shaped(cls)


@dataclass_transform(
    frozen_default=True, kw_only_default=True, field_specifiers=(quantity, part, seen, dataclasses.field)
)
def result(cls: type[T]) -> type[T]:
    """A record of what was computed: its quantities have units, no range that they must keep, and are told."""
    cls.__result__ = True  # type: ignore[attr-defined]
    return _shaped(cls)


def _shaped(cls: type[T]) -> type[T]:
    for name, shared in _SHARED.items():
        if vars(cls).get(name) is None:
            setattr(cls, name, shared)
    for name in (name for name, value in vars(cls).items() if isinstance(value, SeenElsewhere)):
        cls.__annotations__[name] = ClassVar[cls.__annotations__[name]]
    return dataclasses.dataclass(init=False, repr=False, eq=False, match_args=False, kw_only=True)(cls)


def _made(self: Record, /, **given: object) -> None:
    for field in dataclasses.fields(self):
        if field.name in given and field.init:
            value = given.pop(field.name)
        elif field.default is not dataclasses.MISSING:
            value = field.default
        elif field.default_factory is not dataclasses.MISSING:
            value = field.default_factory()
        else:
            raise TypeError(f"{type(self).__name__}.__init__() misses the keyword argument {field.name!r}")
        self.__dict__[field.name] = value
    for name in given:
        raise TypeError(f"{type(self).__name__}.__init__() got an unexpected keyword argument {name!r}")
    if hasattr(self, "__post_init__"):
        self.__post_init__()


def _compared(self: Record) -> tuple[object, ...]:
    return tuple(getattr(self, field.name) for field in dataclasses.fields(self) if field.compare)


def _equal(self: Record, other: Record) -> bool:
    return _compared(self) == _compared(other) if other.__class__ is self.__class__ else NotImplemented


def _frozen(self: object, name: str, *_: object) -> NoReturn:
    raise dataclasses.FrozenInstanceError(f"cannot change field {name!r}; dataclasses.replace makes another record")


class _Signature:
    """What `help` and editors show of a record: its fields."""

    def __get__(self, instance: object, cls: type) -> inspect.Signature:
        if instance is not None:
            raise AttributeError("__signature__")
        parameters = []
        for field in (field for field in dataclasses.fields(cls) if field.init):
            default = field.default if field.default_factory is dataclasses.MISSING else ...
            default = inspect.Parameter.empty if default is dataclasses.MISSING else default
            kind = inspect.Parameter.KEYWORD_ONLY
            parameters.append(inspect.Parameter(field.name, kind, default=default, annotation=field.type))
        return inspect.Signature(parameters)


def _in_short(self: Record) -> str:
    """Class and fields on one line; what is long is named by its kind, the end is cut."""
    pairs = ((f.name, getattr(self, f.name)) for f in dataclasses.fields(self) if f.repr)
    text = f"{type(self).__name__}({', '.join(f'{name}={_value_in_short(value)}' for name, value in pairs)})"
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 5]} ...)"


def _value_in_short(value: object) -> str:
    if dataclasses.is_dataclass(value):
        return f"{type(value).__name__}(..)"
    if hasattr(value, "shape"):
        return f"array{value.shape}"
    if callable(value):
        return "function"
    text, kind = repr(value), type(value).__name__
    if len(text) <= _LONG_VALUE:
        return text
    if isinstance(value, str):
        return f"{text[:_LONG_VALUE]}..'"
    return f"{kind} of {len(value)}" if hasattr(value, "__len__") else kind


# `dataclass` would write and compile five functions for each record, which takes longer than all else in an import
_SHARED = {
    "__init__": _made, "__repr__": _in_short, "__eq__": _equal, "__hash__": lambda self: hash(_compared(self)),
    "__setattr__": _frozen,
    "__delattr__": _frozen, "__signature__": _Signature(),
}  # fmt: skip


def check(record: Record) -> None:
    """Refuse a record whose numbers are not finite or out of range, or whose names are not among the options.

    record: dataclass instance, fields made by `quantity` and `choice` are checked; others are left alone. Raises
    BadInput: names the record's class, field, value, unit and what is allowed.
    """
    for field in dataclasses.fields(record):
        check_value(field, getattr(record, field.name))


def check_value(field: Field, value: object) -> None:
    """Refuse a value that a field cannot have, as `check` does for all fields of a record."""
    meta = field.metadata
    if "options" in meta and value not in meta["options"]:
        raise BadInput(f"{field.name} = {shown(value)} is not an option; options are {', '.join(meta['options'])}")
    if "unit" in meta and value is not None:
        for number in value if isinstance(value, tuple) else (value,):
            _check_number(field.name, number, meta)


def _check_number(name: str, value: float, meta: Mapping[str, Any]) -> None:
    unit = "" if meta["unit"] == "-" else f" {meta['unit']}"
    if not math.isfinite(value):
        raise BadInput(f"{name} = {value}{unit} is not finite")
    inside = (
        (meta["above"] is None or value > meta["above"])
        and (meta["below"] is None or value < meta["below"])
        and (meta["low"] is None or value >= meta["low"])
        and (meta["high"] is None or value <= meta["high"])
    )
    if not inside:
        raise BadInput(f"{name} = {value:g}{unit} is out of range; it must be {allowed(meta)}{unit}")

"""Records that declare unit and range at each field and check themselves."""

import dataclasses
import inspect
import math
from typing import Any, NoReturn, TypeVar, dataclass_transform

from mechsym.errors import BadInput, shown


def quantity(
    unit: str,
    *,
    default: Any = dataclasses.MISSING,
    above: float | None = None,
    below: float | None = None,
    low: float | None = None,
    high: float | None = None,
    about: str = "",
) -> Any:
    """A field of a record that is a number with a unit and a range.

    Parameters
    ----------
    unit : str
        SI unit, `"-"` for a pure number
    default : float, optional
        Value when none is given; without it the field must be given [unit]
    above, below : float, optional
        Bounds that the value must not reach [unit]
    low, high : float, optional
        Bounds that the value may reach [unit]

    Returns
    -------
    field : dataclasses.Field
        To be assigned in the class body
    """
    metadata = {"unit": unit, "above": above, "below": below, "low": low, "high": high, "about": about}
    return dataclasses.field(default=default, metadata=metadata)


def choice(*options: str, default: Any = dataclasses.MISSING, about: str = "") -> Any:
    """A field of a record that is one of several names.

    Returns
    -------
    field : dataclasses.Field
        To be assigned in the class body
    """
    return dataclasses.field(default=default, metadata={"options": options, "about": about})


def allowed(metadata: Any) -> str:
    """The range of a field in words.

    Parameters
    ----------
    metadata : mapping
        Metadata of a field made by `quantity`

    Returns
    -------
    text : str
        For example ``> 0 and <= 1``

    Examples
    --------
    >>> allowed({"above": 0, "high": 1})
    '> 0 and <= 1'
    """
    words = [("above", ">"), ("low", ">="), ("below", "<"), ("high", "<=")]
    return " and ".join(f"{sign} {metadata[key]:g}" for key, sign in words if metadata.get(key) is not None)


Record = TypeVar("Record")
_LONGEST, _LONG_VALUE = 400, 60  # characters of a record and of one value where a record is shown


@dataclass_transform(frozen_default=True, kw_only_default=True, field_specifiers=(quantity, choice, dataclasses.field))
def record(cls: type[Record]) -> type[Record]:
    """A frozen dataclass with keyword arguments whose quantities and choices are checked when it is made.

    A `__post_init__` of the class runs behind that check and may rely on it.

    Returns
    -------
    cls : type
        The same class as a record

    Examples
    --------
    >>> @record
    ... class Rod:
    ...     length: float = quantity("m", above=0)
    >>> Rod(length=2.0)
    Rod(length=2.0)
    """
    own = cls.__dict__.get("__post_init__")

    def checked(self: Any) -> None:
        check(self)
        if own is not None:
            own(self)

    if any(isinstance(value, dataclasses.Field) and value.metadata for value in vars(cls).values()):
        cls.__post_init__ = checked  # type: ignore[attr-defined]
    for name, shared in _SHARED.items():
        if vars(cls).get(name) is None:
            setattr(cls, name, shared)
    return dataclasses.dataclass(init=False, repr=False, eq=False, match_args=False, kw_only=True)(cls)


def _made(self: Any, /, **given: Any) -> None:
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


def _compared(self: Any) -> tuple[Any, ...]:
    return tuple(getattr(self, field.name) for field in dataclasses.fields(self) if field.compare)


def _equal(self: Any, other: object) -> bool:
    return _compared(self) == _compared(other) if other.__class__ is self.__class__ else NotImplemented


def _hash(self: Any) -> int:
    return hash(_compared(self))


def _frozen(self: Any, name: str, *_: Any) -> NoReturn:
    raise dataclasses.FrozenInstanceError(f"cannot change field {name!r}; dataclasses.replace makes another record")


class _Signature:
    """What `help` and editors show of a record: its fields."""

    def __get__(self, made: Any, cls: type) -> inspect.Signature:
        if made is not None:
            raise AttributeError("__signature__")
        return inspect.Signature([_parameter(field) for field in dataclasses.fields(cls) if field.init])


def _parameter(field: dataclasses.Field[Any]) -> inspect.Parameter:
    default = field.default if field.default_factory is dataclasses.MISSING else ...
    default = inspect.Parameter.empty if default is dataclasses.MISSING else default
    return inspect.Parameter(field.name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=field.type)


def _in_short(self: Any) -> str:
    """Class and fields on one line; what is long is named by its kind, the end is cut."""
    pairs = ((f.name, getattr(self, f.name)) for f in dataclasses.fields(self) if f.repr)
    text = f"{type(self).__name__}({', '.join(f'{name}={_value_in_short(value)}' for name, value in pairs)})"
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 5]} ...)"


def _value_in_short(value: Any) -> str:
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
    "__init__": _made, "__repr__": _in_short, "__eq__": _equal, "__hash__": _hash, "__setattr__": _frozen,
    "__delattr__": _frozen, "__signature__": _Signature(),
}  # fmt: skip


def check(record: Any) -> None:
    """Refuse a record whose numbers are not finite or out of range, or whose names are not among the options.

    Parameters
    ----------
    record : dataclass instance
        Fields made by `quantity` and `choice` are checked; others are left alone

    Raises
    ------
    BadInput
        Names the record's class, field, value, unit and what is allowed
    """
    for field in dataclasses.fields(record):
        check_value(field, getattr(record, field.name))


def check_value(field: dataclasses.Field[Any], value: Any) -> None:
    """Refuse a value that a field cannot have, as `check` does for all fields of a record."""
    meta = field.metadata
    if "options" in meta and value not in meta["options"]:
        raise BadInput(f"{field.name} = {shown(value)} is not an option; options are {', '.join(meta['options'])}")
    if "unit" in meta and value is not None:
        for number in value if isinstance(value, tuple) else (value,):
            _check_number(field.name, number, meta)


def _check_number(name: str, value: float, meta: Any) -> None:
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

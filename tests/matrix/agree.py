"""What people read of a number beside what the JSON says of it: the unit, and the number within its printed digits."""

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities.units import exponents, scale

_UNIT = r"[kM]?[A-Za-z%]+(?:[*/^]\(?[A-Za-z0-9]+\)?(?:\^\d)?)*"
_VALUE = r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
_TOLD = re.compile(rf"(?<![\w.^*/=-])({_VALUE})(?: to ({_VALUE}))? ({_UNIT})(?![\w*^])")
_HEAD = re.compile(r"(.+) \[(.+)\]")
_SHOWN = 4  # digits of a whole number that certainly count
_OTHER = {"%": ((), 0.01), "Hz": (tuple(exponents("rad/s")), 2 * math.pi)}  # unit: what it measures, factor to SI


def told(text: str) -> Iterator[tuple[str, str]]:
    """Numbers of a text that have a unit, with that unit as it is typed: `0.5 kN*m`."""
    for first, second, unit in _TOLD.findall(typed(text)):
        if _measured(unit) is not None:
            yield from ((number, unit) for number in (first, second) if number)


def typed(text: str) -> str:
    """A text with its units as they are typed: kg*m^2 for kg m²."""
    return re.sub(r"(?<=[Ngma]) (?=[ms]\b)", "*", text.replace("²", "^2").replace("³", "^3"))


def _measured(unit: str) -> tuple[tuple[Any, ...], float] | None:
    """What a unit measures and its factor to SI; None where it is a word."""
    try:
        return _OTHER.get(unit) or (tuple(exponents(unit)), scale(unit))
    except BadInput:
        return None


def by_dimension(numbers: Iterable[tuple[Any, str]]) -> dict[tuple[Any, ...], np.ndarray]:
    """Numbers, or lists of them, with their units: those of each dimension in SI."""
    found: dict[tuple[Any, ...], list[float]] = {}
    for value, unit in numbers:
        kind, factor = ((), 1.0) if unit == "-" else _measured(unit) or ((unit,), 1.0)
        flat = np.ravel(np.array(value, dtype=float))
        found.setdefault(kind, []).extend(factor * flat[np.isfinite(flat)])
    return {kind: np.abs(values) for kind, values in found.items()}


def is_told(number: str, unit: str, known: Mapping[tuple[Any, ...], np.ndarray]) -> bool:
    """Whether a printed number is one of those that are known, in its unit and within its last digit."""
    kind, factor = _measured(unit) or ((), 1.0)
    mantissa, _, exponent = number.lower().partition("e")
    places, whole = len(mantissa.partition(".")[2]), mantissa.strip("-+")
    unsaid = len(whole) - max(len(whole.rstrip("0")), _SHOWN) if "." not in whole else 0  # zeros of 204400
    digit = 10.0 ** (int(exponent or 0) - places + max(unsaid, 0)) * factor
    away = np.abs(known.get(kind, np.empty(0)) - abs(float(number)) * factor)
    return bool((away <= 0.51 * digit + 1e-6 * abs(float(number)) * factor).any())


def head(text: str) -> tuple[str, str]:
    """Name and unit of a heading `rho [m]`; a heading without one has no unit."""
    parts = _HEAD.fullmatch(text)
    return (parts[1], parts[2]) if parts else (text, "")


def texts(value: Any) -> Iterator[str]:
    """All words of a JSON value."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        for inner in value.values():
            yield from texts(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from texts(inner)


def leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Paths of a JSON value, as the workbench writes them, with the numbers there; a list of numbers is one."""
    if isinstance(value, Mapping):
        for name, inner in value.items():
            yield from leaves(inner, f"{path}.{name}" if path else name)
    elif isinstance(value, list) and value and not all(v is None or _number(v) for v in value):
        for i, inner in enumerate(value):
            yield from leaves(inner, f"{path}[{i}]")
    elif _number(value) or (isinstance(value, list) and any(map(_number, value))):
        yield path, value


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)

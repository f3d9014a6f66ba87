"""Two records of a command beside each other: what differs, with its place."""

import math
import re
from collections.abc import Iterator, Mapping
from typing import Any

from mechsym.cli.results import units_by_path

# Other processors and libraries round otherwise; integrators with a tolerance of 1e-10 and searches that end at 1e-8
# carry that to 1e-7 of a result. A change of a formula is larger.
TOLERANCE = 1e-6
# what is left of a balance, of two runs, of a closure: rounding, whose digits say nothing below this
ROUNDING = re.compile(r"residual|difference|closure|energy_left|error|margin_error|deviation")
SMALL = 1e-6
# what is left of a sum is known to this share of the largest number of its unit in the same answer, or of its own list
NOTHING = 1e-7
# lines of a file of text: a number that is nearly 0 may stand there or not
SIZE = 0.01
_SIZE = re.compile(r"^\.files\..*\.(c|h|mo|jl|m|py|md|toml|txt|v)$")
# steps and rounds of a search turn with the last digit of what they search; what a run's energy changes by over whole
# turns is a difference of energies that a sweep does not show
LOOSE = re.compile(
    r"(^|\.)(steps|rounds|iterations|evaluations|runs|rejected|energy\.change)( \[[-J]\])?(\[\d+\])*"
    r"(\.(first|last|min|max))?$"
)
_COLUMN_UNIT = re.compile(r"\[([^\]\d-][^\]]*)\]")
_FIGURE = re.compile(r"\.(first|last|min|max)$|\[\d+\]$")
_NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w])", re.I)


class Scales:
    """The largest number of each unit in an answer; a ratio is held against one."""

    def __init__(self, record: Any = None, command: str = "") -> None:
        table = record.get("json") if isinstance(record, dict) else None
        self._units = units_by_path(table, command) if isinstance(table, dict | list) else {}
        if isinstance(table, dict):  # a sweep tells units of its columns
            self._units |= {f"data.{name}": unit for name, unit in table.get("units", {}).items()}
        self._largest: dict[str, float] = {}
        for path, value in _numbers(record):
            unit = "" if path.endswith(".count") else self._unit(path)
            self._largest[unit] = max(self._largest.get(unit, 0.0), abs(value))

    def of(self, path: str) -> float:
        """What rounding at a path is measured by; 0 of a number alone whose unit is not known."""
        unit = self._unit(path)
        return 1.0 if unit == "-" else self._largest.get(unit, 0.0) if unit else 0.0

    def _unit(self, path: str) -> str:
        if column := _COLUMN_UNIT.search(path):
            return column[1]
        whole = _FIGURE.sub("", path)
        return self._units.get(whole.removeprefix(".json."), "" if whole == path else whole)


def differences(
    old: Any, new: Any, tolerance: float = TOLERANCE, path: str = "", scales: Scales | None = None
) -> Iterator[str]:
    """Each place where two records differ, in one line."""
    scales = scales or Scales()
    if isinstance(old, dict) and isinstance(new, dict):
        for name in old.keys() | new.keys():
            if name not in old or name not in new:
                yield f"{path}.{name}: {'new' if name not in old else 'gone'}"
        for name in (n for n in old if n in new):
            yield from differences(old[name], new[name], tolerance, f"{path}.{name}", scales)
    elif isinstance(old, list) and isinstance(new, list):
        if len(old) != len(new):
            yield f"{path}: {len(old)} entries, now {len(new)}"
        for i, (one, other) in enumerate(zip(old, new, strict=False)):
            yield from differences(one, other, tolerance, f"{path}[{i}]", scales)
    elif _is_number(old) and _is_number(new):
        of_nothing = abs(old - new) <= NOTHING * scales.of(path)
        close = SIZE if _SIZE.search(path) else tolerance
        if not (of_nothing or LOOSE.search(path) or alike(old, new, close, bool(ROUNDING.search(path)))):
            yield f"{path}: {old:.9g}, now {new:.9g} ({_apart(old, new):.1e})"
    elif isinstance(old, str) and isinstance(new, str):
        if not same_text(old, new, tolerance):
            yield f"{path}: {old!r}, now {new!r}"
    elif old != new or type(old) is not type(new):
        yield f"{path}: {old!r}, now {new!r}"


def _numbers(value: Any, path: str = "") -> Iterator[tuple[str, float]]:
    """All numbers of a record with their paths."""
    if _is_number(value):
        yield path, value
    inner = value.items() if isinstance(value, Mapping) else ()
    for name, one in inner:
        yield from _numbers(one, f"{path}.{name}")
    for i, one in enumerate(value if isinstance(value, list) else ()):
        yield from _numbers(one, f"{path}[{i}]")


def alike(old: float, new: float, tolerance: float, of_rounding: bool = False) -> bool:
    """Whether two numbers are the same but for rounding."""
    if max(abs(old), abs(new)) < 1e-12 or (of_rounding and max(abs(old), abs(new)) <= SMALL):
        return True
    return _apart(old, new) <= tolerance


def same_text(old: str, new: str, tolerance: float) -> bool:
    """Whether texts have the same words, and numbers that are one in their last digit apart at most."""
    if ROUNDING.search(old):  # round-off is printed as 0 or as what it is below
        old, new = (text.replace("below 1e", "1e") for text in (old, new))
    if " ".join(_NUMBER.sub("#", old).split()) != " ".join(_NUMBER.sub("#", new).split()):
        return False
    if LOOSE.search(old.partition(" ")[0]):
        return True
    pairs = zip(_NUMBER.findall(old), _NUMBER.findall(new), strict=True)
    of_rounding = bool(ROUNDING.search(old)) or "(below " in old  # a bound of round-off is no result
    return all(
        alike(float(a), float(b), tolerance, of_rounding) or abs(float(a) - float(b)) <= 1.01 * _last_digit(a)
        for a, b in pairs
    )


def _last_digit(number: str) -> float:
    """What one in the last digit of a printed number is; of a whole number nothing, since it counts."""
    mantissa, _, exponent = number.lower().partition("e")
    places = len(mantissa.partition(".")[2])
    return 10.0 ** (int(exponent or 0) - places) if places or exponent else 0.0


def _apart(old: float, new: float) -> float:
    size = max(abs(old), abs(new))
    return abs(old - new) / size if size and math.isfinite(size) else math.inf


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)

"""Lists and ranges as every option takes them: --loads, --dampings, --speeds, --over.

80,89,100              a list
3..8:11                eleven even values, both ends included
500:8000:500           from 500 in steps of 500 up to 8000
1.2..1.3               with samples: evenly distributed
6500+-200              with samples: normally distributed, mean and standard deviation

One unit stands behind the last number (`3..8 MPa:11`, `80,85 rpm`, `50,75,100%`) or behind each.
"""

import math
import re

from mechsym.errors import BadInput, shown
from mechsym.quantities.records import record
from mechsym.quantities.units import parse

MOST = 1_000_000  # values of a range
_NUMBER = r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)"
_ONE = rf"\s*{_NUMBER}\s*([A-Za-z%µμ°][^:,]*?)?\s*"
_EVEN = re.compile(rf"{_ONE}\.\.{_ONE}(?::\s*(\d{{1,18}})\s*)?")
_STEPS = re.compile(rf"{_ONE}:{_ONE}:{_ONE}")
_NORMAL = re.compile(rf"\s*{_NUMBER}\s*\+-{_ONE}")
_ITEM = re.compile(_ONE)


@record
class Range:
    """What a list or a range says."""

    kind: str  #: `grid` (values), `even` (its ends) or `normal` (mean and standard deviation)
    values: tuple[float, ...]  #: As written [unit]
    unit: str  #: Unit that is written; empty when there is none


def read_range(text: str, option: str, unit: str = "-", key: str = "") -> Range:
    """A list or a range as written.

    option, unit, key: where it was written, its unit, and what stands before an equals sign, for messages. Raises
    BadInput: neither of the forms, two units, or more values than allowed.

    >>> read_range("3..8 MPa:3", "--over", "Pa", "p0")
    Range(kind='grid', values=(3.0, 5.5, 8.0), unit='MPa')
    """
    where = f"{option} {shown(f'{key}={text}' if key else text)}"
    kind, numbers, count, units = _written(text, where, f"{key}=" if key else "", "" if unit == "-" else f" {unit}")
    if len(units) > 1:
        raise BadInput(f"{where}: units {' and '.join(sorted(units))}; write all values in one unit")
    if not all(math.isfinite(number) for number in numbers):
        raise BadInput(f"{where}: a value is not finite; allowed are numbers up to 1e20 in SI")
    if kind == "normal" and not numbers[1] > 0:
        raise BadInput(f"{where}: the standard deviation {numbers[1]:g} is out of range; it must be > 0")
    if kind == "steps":
        numbers = _steps(where, *numbers)
    elif count is not None:
        import numpy as np

        _check_count(where, count)
        if count == 1 and numbers[0] != numbers[1]:
            first = f"{numbers[0]:g} {''.join(units)}".strip()
            raise BadInput(f"{where}: one value of a range is its first end alone; write {first}, or more values")
        numbers = tuple(np.linspace(numbers[0], numbers[1], count).tolist())
    whole = kind == "steps" or count is not None
    return Range(kind="grid" if whole else kind, values=numbers, unit="".join(units))


def values(text: str, unit: str, option: str, plain: str = "", key: str = "", most: int = MOST) -> list[float]:
    """The values of a list or a range in SI.

    unit: the SI unit wanted, `"-"` for pure numbers. plain: what a number without a unit is in; SI when left out. most:
    how many there may be where each is a run of its own. Returns values: at least one [unit].

    >>> values("50,75%", "-", "--loads")
    [0.5, 0.75]
    """
    parsed = read_range(text, option, plain or unit, key)
    where = f"{option} {key}".strip()
    if parsed.kind != "grid":
        raise BadInput(f"{where}: {text.strip()} does not say how many; write {text.strip()}:5 or a list")
    _check_count(where, len(parsed.values), most)
    written = parsed.unit or plain
    return [parse(f"{value!r} {written}" if written else value, unit, where) for value in parsed.values]


def _written(text: str, where: str, head: str, unit: str) -> tuple[str, tuple[float, ...], int | None, set[str]]:
    """Kind, numbers, how many, and the units that were written."""
    if m := _EVEN.fullmatch(text):
        return "even", (float(m[1]), float(m[3])), None if m[5] is None else int(m[5]), {m[2], m[4]} - {None}
    if m := _STEPS.fullmatch(text):
        return "steps", (float(m[1]), float(m[3]), float(m[5])), None, {m[2], m[4], m[6]} - {None}
    if m := _NORMAL.fullmatch(text):
        return "normal", (float(m[1]), float(m[2])), None, {m[3]} - {None}
    parts = [m for part in text.split(",") if (m := _ITEM.fullmatch(part))]
    if len(parts) <= text.count(","):
        forms = f"{head}1,2,5{unit}, {head}1..5{unit}:9 (how many) or {head}1:5:0.5{unit}"
        raise BadInput(f"{where} takes numbers, as a list or a range; write for example {forms}")
    return "grid", tuple(float(m[1]) for m in parts), None, {m[2] for m in parts} - {None}


def _steps(where: str, first: float, last: float, step: float) -> tuple[float, ...]:
    if not step > 0 or last < first:
        raise BadInput(f"{where}: a:b:step needs a <= b and a step > 0")
    if step * (1 - 1e-9) > last - first > 0:
        many = f"; for {step:g} values write {first:g}..{last:g}:{step:g}" if step == int(step) else ""
        raise BadInput(f"{where}: the step {step:g} is longer than the range, one value is left{many}")
    # the last digits of a float must not cost the last value
    count = (last - first) / step * (1 + 1e-12) + 1e-9 + 1
    _check_count(where, count)
    return tuple(first + k * step for k in range(int(count)))


def _check_count(where: str, count: float, most: int = MOST) -> None:
    if not 1 <= count < most + 1:
        raise BadInput(f"{where}: {count:.0f} values; allowed are 1 to {most}")

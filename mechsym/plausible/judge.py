"""Numbers by name against the ranges of their kind; what a case accepts is told apart from what is doubted."""

import functools
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from mechsym.errors import BadInput
from mechsym.plausible.ranges import INPUTS, LARGEST, RESULTS, Usual
from mechsym.plausible.together import PROPORTIONS
from mechsym.quantities import record

_USUAL_RATIO = {"scale": 1.0}  # kinds of other rooms that are doubted on both sides of this [-]
_BY_CODE = {kind.code: kind for kind in PROPORTIONS}


@record
class Doubt:
    """A value that is possible and not usual."""

    code: str  #: One word by which a case can accept it
    quantity: str
    value: float  #: In the unit that `quantity` names, else SI [unit]
    usual: str
    why: str


@record
class Acceptance:
    """A doubt that a case accepts up to a value, with its reason."""

    code: str
    up_to: float  #: Farthest value from the usual range that is accepted, in the unit of the quantity [unit]
    why: str


def inputs(values: Mapping[str, float]) -> tuple[Doubt, ...]:
    """Values of a case against hard and usual ranges.

    Parameters
    ----------
    values : mapping of str to float
        By dotted key, `section.field` [SI]

    Returns
    -------
    doubts : tuple of Doubt
        Values that are possible and not usual

    Raises
    ------
    BadInput
        A value that no engine has, with what is possible

    Examples
    --------
    >>> [d.code for d in inputs({"cycle.compression_ratio": 60.0, "cycle.bore": 0.08})]
    ['compression_ratio']
    """
    found = []
    for key, value in values.items():
        for kind in _kinds_of_input(key):
            _refuse(key, value, kind)
            found += [_doubt(key, value, kind)] if not kind.low <= value <= kind.high else []
    return tuple(found)


# the points of a sweep have the same keys
@functools.lru_cache(maxsize=4096)
def _kinds_of_input(key: str) -> tuple[Usual, ...]:
    section, _, name = key.rpartition(".")
    return tuple(kind for kind in INPUTS if name in kind.keys and kind.section in ("", section))


def proportion(code: str, quantity: str, value: float) -> tuple[Doubt, ...]:
    """A number that several values make together, against the range of its kind.

    Parameters
    ----------
    quantity : str
        What it is, with the values that make it, for messages
    value : float
        In the unit of its kind [unit]

    Raises
    ------
    BadInput
        A value that no engine has

    Examples
    --------
    >>> [d.usual for d in proportion("spring_area", "spring area / piston area", 4.0)]
    ['at least 0.01 and at most 3']
    """
    kind = _BY_CODE[code]
    _refuse(quantity, value, kind)
    return () if kind.low <= value <= kind.high else (_doubt(quantity, value, kind),)


def letters(values: Mapping[str, tuple[float, str]]) -> tuple[Doubt, ...]:
    """Letters of any mechanism, whose meaning is not known, against the size of the largest machines.

    Parameters
    ----------
    values : mapping of str to tuple of float and str
        By letter, the value and its SI unit [SI]

    Examples
    --------
    >>> [d.quantity for d in letters({"phid": (1e12, "rad/s"), "phi": (1.0, "rad")})]
    ['phid']
    """
    why = _BY_CODE["magnitude"].why
    return tuple(
        Doubt(code="magnitude", quantity=name, value=value, usual=f"at most {LARGEST[unit]:g} {unit}", why=why)
        for name, (value, unit) in values.items()
        if abs(value) > LARGEST.get(unit, math.inf)
    )


def results(report: Any) -> tuple[Doubt, ...]:
    """Numbers of a report, wherever they stand in it, against the usual ranges of results; `a.b` is a b."""
    worst: dict[tuple[str, str], Doubt] = {}
    for name, value in _numbers(report):
        for kind in _kinds(name):
            if not kind.low <= value <= kind.high:
                known = worst.get((kind.code, name))
                if known is None or abs(value) > abs(known.value):
                    worst[kind.code, name] = _doubt(name, value, kind)
    return tuple(worst.values())


def sifted(
    doubts: Sequence[Doubt], acceptances: Mapping[str, Acceptance]
) -> tuple[tuple[Doubt, ...], tuple[Doubt, ...]]:
    """Doubts that remain, and those that a case accepts."""
    accepted = tuple(d for d in doubts if d.code in acceptances and _within(d, acceptances[d.code]))
    return tuple(d for d in doubts if d not in accepted), accepted


def _within(doubt: Doubt, acceptance: Acceptance) -> bool:
    kind = next((k for k in (*INPUTS, *RESULTS, *PROPORTIONS) if k.code == doubt.code), None)
    low_side = doubt.value < (kind.low if kind is not None else _USUAL_RATIO.get(doubt.code, -math.inf))
    slack = 1e-9 * abs(acceptance.up_to)
    return doubt.value >= acceptance.up_to - slack if low_side else abs(doubt.value) <= abs(acceptance.up_to) + slack


@functools.lru_cache(maxsize=4096)
def _kinds(name: str) -> tuple[Usual, ...]:
    """Usual ranges of a result."""
    last = name.rpartition(".")[2]
    return tuple(kind for kind in RESULTS if last in kind.keys)


def _numbers(report: Any, name: str = "") -> Iterator[tuple[str, float]]:
    """Numbers of which a usual range is known."""
    if isinstance(report, Mapping):
        for key, value in report.items():
            yield from _numbers(value, str(key))
    elif hasattr(report, "tolist"):
        yield from _numbers(report.tolist(), name)
    elif isinstance(report, (list, tuple)):
        # a map has millions, most of them nothing that is looked for
        known = bool(_kinds(name))
        for value in report:
            if known or type(value) is not float:
                yield from _numbers(value, name)
    elif isinstance(report, (int, float)) and not isinstance(report, bool) and math.isfinite(report) and _kinds(name):
        yield name, float(report)


def _refuse(key: str, value: float, kind: Usual) -> None:
    if not kind.lowest <= value <= kind.highest:
        size, unit = (
            (math.radians(1.0), " deg") if kind.unit == "rad" else (1.0, "" if kind.unit == "-" else f" {kind.unit}")
        )
        possible = _ends(kind.lowest / size, kind.highest / size)
        raise BadInput(f"{key} = {value / size:g}{unit}: possible is {possible}{unit} ({kind.why})")


def _doubt(key: str, value: float, kind: Usual) -> Doubt:
    unit = "" if kind.unit == "-" else f" {kind.unit}"
    return Doubt(code=kind.code, quantity=key, value=value, usual=f"{_ends(kind.low, kind.high)}{unit}", why=kind.why)


def _ends(low: float, high: float) -> str:
    return " and ".join([f"at least {low:g}"] * math.isfinite(low) + [f"at most {high:g}"] * math.isfinite(high))

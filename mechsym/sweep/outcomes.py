"""What comes out at a point of a sweep: results by name, or a gap with a reason."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.quantities.results import walk

# results that are words worth keeping
WORDS = ("status", "end", "guide.reason")
# the clock tells nothing of the machine, and an event is told by its parts
_NO_RESULT = ("wall_s", "event")
# what impossible values run into where no record refuses them; anything else is a mistake of the program
ARITHMETIC = (ArithmeticError, ValueError, RuntimeError)


@record
class Gap:
    """Why there is no result at a point."""

    reason: str
    of_input: bool = False  #: Whether the case was refused, not its run


Outcome = Any  # a result, numbers by dotted names, or a Gap


def known(error: Exception) -> Gap:
    """The gap that an error leaves. error: bad input, or an error of arithmetic that only this point met."""
    words = " ".join(str(error).split())
    if isinstance(error, BadInput):
        return Gap(reason=words, of_input=True)
    return Gap(reason=f"{type(error).__name__}: {words}")


def guarded(one: Callable[[Any], Any], case: object) -> Any:
    """What a function of the case, or of what stands for it, gives, or the gap that its error leaves."""
    try:
        return one(case)
    except ARITHMETIC as error:
        return known(error)


def flat(result: object) -> dict[str, float | str]:
    """The numbers of a result by dotted names, `speed_mean [rad/s]` where it knows its units.

    Returns numbers: None becomes not a number; longer lists and most words are left out.
    """
    found: dict[str, float | str] = {}
    for path, value, unit in walk(result):
        name = f"{path} [{unit}]" if unit else path
        if isinstance(value, str):
            found |= {path: value} if path in WORDS else {}
        elif path.rpartition(".")[2] in _NO_RESULT:
            continue
        elif value is None:
            found[name] = math.nan
        elif (numbers := np.asarray(value)).size == 1 and numbers.dtype.kind in "bif":
            found[name] = float(numbers.ravel()[0])
    return found


def kept(row: Mapping[str, float | str], show: Sequence[str]) -> dict[str, float | str]:
    """The results of a point that are shown; all where none is named.

    row: results by dotted name [SI, or as the name says]; show: names, groups (`guide` for `guide.z_max` and its like),
    or `all`. Returns row: in the same order [SI, or as the name says].
    """
    if not show or "all" in show:
        return dict(row)
    return {name: value for name, value in row.items() if any(asked(name, s) for s in show)}


def asked(name: str, show: str) -> bool:
    """Whether a name or group that is shown means a result, whose name may carry its unit."""
    name = name.partition(" [")[0]
    return name == show or name.startswith(f"{show}.")

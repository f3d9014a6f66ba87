"""What every sizing rule shares: refusing input outside its validity, and the record of one check."""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import allowed, record


def require(
    name: str,
    value: Any,
    unit: str,
    *,
    above: float | None = None,
    low: float | None = None,
    below: float | None = None,
    high: float | None = None,
    hint: str = "",
) -> None:
    """Refuse a value outside the validity of a rule.

    Parameters
    ----------
    name : str
        Name of the quantity, for the message
    value : float or ndarray
        Value in SI; every element is checked [unit]
    unit : str
        Its SI unit, `"-"` for a pure number
    above, low, below, high : float, optional
        Bounds; `above` and `below` must not be reached [unit]
    hint : str
        Why the bound is there and what to do instead

    Raises
    ------
    BadInput
        Names the quantity, its worst value, its unit, what is allowed and the hint

    Examples
    --------
    >>> require("face width b", 0.039, "m", above=0, high=1.02)
    """
    # most are single numbers that are right, and a search asks for thousands
    if isinstance(value, float) and _inside(value, above, low, below, high):
        return
    values = np.atleast_1d(np.asarray(value, dtype=float))
    inside = np.isfinite(values)
    for bound, keeps in ((above, np.greater), (low, np.greater_equal), (below, np.less), (high, np.less_equal)):
        if bound is not None:
            inside &= keeps(values, bound)
    if not inside.all():
        shown = "" if unit == "-" else f" {unit}"
        bounds = allowed({"above": above, "low": low, "below": below, "high": high})
        text = f"{name} = {values[~inside][0]:g}{shown} is out of range; it must be {bounds or 'finite'}{shown}"
        raise BadInput(f"{text}; {hint}" if hint else text)


def _inside(value: float, above: float | None, low: float | None, below: float | None, high: float | None) -> bool:
    return (
        math.isfinite(value)
        and (above is None or value > above)
        and (low is None or value >= low)
        and (below is None or value < below)
        and (high is None or value <= high)
    )


@record
class Check:
    """One rule applied to one part."""

    component: str
    quantity: str
    #: The part's value and what it is held against [unit]
    value: float
    limit: float
    unit: str
    safety_factor: float  #: How far the value is on the safe side: 1 at the limit [-]
    wanted: float  #: Safety factor asked for [-]
    #: Name of the rule and where it is printed
    rule: str
    source: str
    note: str = ""  #: Where the worst case is, or what was assumed


def at_most(
    component: str, quantity: str, value: float, limit: float, unit: str, *, wanted: float, rule: str, **more: str
) -> Check:
    """A check of a load, stress or speed that must stay below a limit.

    Parameters
    ----------
    value, limit : float
        Load and what the part stands [unit]
    wanted : float
        Safety factor asked for [-]

    Returns
    -------
    check : Check
        Its factor is limit / value

    Examples
    --------
    >>> at_most("rod", "stress", 50e6, 75e6, "Pa", wanted=1.5, rule="axial stress", source="").safety_factor
    1.5
    """
    factor = float(limit) / float(value) if value > 0 else float("inf")
    return Check(
        component=component, quantity=quantity, value=float(value), limit=float(limit), unit=unit,
        safety_factor=factor, wanted=wanted, rule=rule, source=more.get("source", ""), note=more.get("note", ""),
    )  # fmt: skip


def at_least(
    component: str, quantity: str, value: float, limit: float, unit: str, *, wanted: float, rule: str, **more: str
) -> Check:
    """A check of a size or life that must reach what is needed.

    Parameters
    ----------
    value, limit : float
        What the part has and what it needs [unit]
    wanted : float
        Safety factor asked for [-]

    Returns
    -------
    check : Check
        Its factor is value / limit

    Examples
    --------
    >>> at_least("cylinder", "length", 0.170, 0.1698, "m", wanted=1.0, rule="length", source="").safety_factor > 1
    True
    """
    factor = float(value) / float(limit) if limit > 0 else float("inf")
    return Check(
        component=component, quantity=quantity, value=float(value), limit=float(limit), unit=unit,
        safety_factor=factor, wanted=wanted, rule=rule, source=more.get("source", ""), note=more.get("note", ""),
    )  # fmt: skip


def holds(check: Check) -> bool:
    """Whether a part reaches the wanted factor.

    Returns
    -------
    holds : bool
        True when the factor is at least the wanted one, up to rounding in the last digits of a float
    """
    return check.safety_factor >= check.wanted * (1 - 1e-9)


def unsafe(checks: Iterable[Check]) -> list[Check]:
    """The checks whose factor is below the wanted one."""
    return [check for check in checks if not holds(check)]

"""What every sizing rule shares: refusing input outside its validity, the record of one check, rounding up."""

import math
from collections.abc import Iterable

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import RPM, allowed, record
from mechsym.quantities.units import Array, Metre, Pure, RadPerSecond, Scalar


def require(
    name: str,
    value: Scalar,
    unit: str,
    *,
    above: float | None = None,
    low: float | None = None,
    below: float | None = None,
    high: float | None = None,
    hint: str = "",
) -> None:
    """Refuse a value outside the validity of a rule.

    name: name of the quantity, for the message. value: value in SI; every element is checked [unit]. unit: its SI unit,
    `"-"` for a pure number. above, low, below, high: bounds; `above` and `below` must not be reached [unit]. hint: why
    the bound is there and what to do instead. Raises BadInput: names the quantity, its worst value, its unit, what is
    allowed and the hint.

    >>> require("face width b", 0.039, "m", above=0, high=1.02)
    """
    # most are single numbers that are right, and a search asks for thousands
    if isinstance(value, float) and (
        math.isfinite(value)
        and (above is None or value > above)
        and (low is None or value >= low)
        and (below is None or value < below)
        and (high is None or value <= high)
    ):
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
    component: str, quantity: str, value: float, limit: float, unit: str, *, wanted: Pure, rule: str, **more: str
) -> Check:
    """A check of a load, stress or speed that must stay below a limit.

    value, limit: load and what the part stands [unit]; wanted: safety factor asked for. Returns check: its factor is
    limit / value.

    >>> at_most("rod", "stress", 50e6, 75e6, "Pa", wanted=1.5, rule="axial stress", source="").safety_factor
    1.5
    """
    factor = float(limit) / float(value) if value > 0 else float("inf")
    return Check(
        component=component, quantity=quantity, value=float(value), limit=float(limit), unit=unit,
        safety_factor=factor, wanted=wanted, rule=rule, source=more.get("source", ""), note=more.get("note", ""),
    )  # fmt: skip


def at_least(
    component: str, quantity: str, value: float, limit: float, unit: str, *, wanted: Pure, rule: str, **more: str
) -> Check:
    """A check of a size or life that must reach what is needed.

    value, limit: what the part has and what it needs [unit]; wanted: safety factor asked for. Returns check: its factor
    is value / limit.

    >>> at_least("cylinder", "length", 0.170, 0.1698, "m", wanted=1.0, rule="length", source="").safety_factor > 1
    True
    """
    factor = float(value) / float(limit) if limit > 0 else float("inf")
    return Check(
        component=component, quantity=quantity, value=float(value), limit=float(limit), unit=unit,
        safety_factor=factor, wanted=wanted, rule=rule, source=more.get("source", ""), note=more.get("note", ""),
    )  # fmt: skip


def holds(check: Check) -> bool:
    """Whether a part reaches the wanted factor, up to rounding in the last digits of a float."""
    return check.safety_factor >= check.wanted * (1 - 1e-9)


def weakest(checks: Iterable[Check]) -> Pure:
    """Smallest factor over wanted factor."""
    return min(check.safety_factor / check.wanted for check in checks)


def unsafe(checks: Iterable[Check]) -> list[Check]:
    """The checks whose factor is below the wanted one."""
    return [check for check in checks if not holds(check)]


def round_up(size: Metre, step: Metre = 0.5e-3) -> Metre:
    """The next larger multiple of a step.

    size: size needed; step: step of the sizes made. Returns size: size made, never smaller than needed beyond the last
    digits of a float.

    >>> round_up(0.02629), round_up(0.0265)
    (0.0265, 0.0265)
    """
    return round(math.ceil(size / step - 1e-9) * step, 12)


def at_speed(omega: RadPerSecond[Array], index: int) -> str:
    """The speed at which a check is worst, in words.

    omega: crank speeds, shape (k,).

    >>> import numpy as np
    >>> at_speed(np.array([8000 * np.pi / 30]), 0)
    'worst at 8000 rpm'
    """
    return f"worst at {float(omega[index]) / RPM:.0f} rpm"

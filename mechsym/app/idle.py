"""Sliders that a tab does not offer, because nothing that it shows depends on them, and why."""

from collections.abc import Callable, Mapping
from typing import Any

from mechsym.cases import Case

_GUIDE_TABS = ("hinge", "simulate", "codesign")
_FUEL = "it is for the estimate of fuel in the tab cycle"


def idle(case: Case, tab: str) -> Mapping[str, str]:
    """Keys of a case that move nothing in a tab, each with the reason."""
    found: dict[str, str] = {}
    for section, names, tabs, reason in _RULES:
        data = case.sections.get(section)
        why = None if data is None or (tabs and tab not in tabs) else reason(case, data)
        if why is not None:
            found |= {f"{section}.{name}": why for name in names or vars(data)}
    return found


def _unless(field: str, value: str) -> Callable[[Case, Any], str | None]:
    """A reason while a choice of the same section is another one."""

    def reason(case: Case, data: Any) -> str | None:
        chosen = getattr(data, field, value)
        return None if chosen == value else f"{field} is {chosen}"

    return reason


def _said(words: str) -> Callable[[Case, Any], str | None]:
    return lambda case, data: words


# section, keys (none: all of it), tabs (none: all of them), reason while it holds
_RULES: tuple[tuple[str, tuple[str, ...], tuple[str, ...], Callable[[Case, Any], str | None]], ...] = (
    ("scavenging", (), (), _unless("source", "turbocharger")),
    ("rollers", ("rolling_arm",), (), _unless("friction", "rolling")),
    ("cycle", ("c_v", "lhv"), (*_GUIDE_TABS, "forces"), _said(_FUEL)),
    ("parameters", ("I01", "I0", "I_f"), ("forces", "cycle"), _said("the speed is held")),
)

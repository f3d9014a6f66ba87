"""Sliders that a tab does not offer, because nothing that it shows depends on them, and why."""

from collections.abc import Callable, Mapping
from typing import Any

from mechsym.cases import Case
from mechsym.cycle.kinds.two_stroke import TwoStrokeMarine


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


def _fuel(case: Case, data: Any) -> str | None:
    return "it is for the fuel that the tab hinge tells" if isinstance(data, TwoStrokeMarine) else None


def _no_friction(case: Case, data: Any) -> str | None:
    free = data.friction == "none" and "losses" not in case.sections
    return "the rollers have no friction" if free else None


# section, keys (none: all of it), tabs (none: all of them), reason while it holds
_RULES: tuple[tuple[str, tuple[str, ...], tuple[str, ...], Callable[[Case, Any], str | None]], ...] = (
    ("scavenging", (), (), _unless("source", "turbocharger")),
    ("rollers", ("rolling_arm",), (), _unless("friction", "rolling")),
    ("rollers", (), ("simulate",), _no_friction),
    ("limits", (), ("simulate",), _said("the tab hinge judges them")),
    ("cycle", ("c_v", "lhv"), ("simulate", "forces", "cycle", "codesign"), _fuel),
    ("parameters", ("I01", "I0", "I_f"), ("forces", "cycle"), _said("the speed is held")),
)

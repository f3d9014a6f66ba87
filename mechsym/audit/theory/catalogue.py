"""All theories by name, each with the data of a case."""

import dataclasses
import tomllib
from collections.abc import Callable, Mapping
from functools import cache, partial
from typing import Any

from mechsym import cases
from mechsym.audit.theory import drives, engines, guides, parts, rodless, sliders
from mechsym.audit.theory.record import Theory
from mechsym.derive.build import scripts
from mechsym.errors import BadInput

Build = Callable[[Mapping[str, float], str], Theory]

# theory: (builder, case that its values come from unless another is named)
_THEORIES: dict[str, tuple[Build, str]] = {
    "crosshead": (drives.crosshead, "zotov-89"),
    "crankshaft_flywheel": (drives.crankshaft_flywheel, "chmielewski"),
    "crankshaft_flywheel_truncated": (drives.crankshaft_flywheel_truncated, "chmielewski"),
    "guide": (guides.guide, "zotov-89"),
    "slider_crank": (sliders.slider_crank, "zotov-89"),
    "two_mass_rod": (sliders.two_mass_rod, "zotov-89"),
    "rodless": (rodless.rodless, ""),
    "opposed_slider_crank": (engines.opposed_slider_crank, ""),
    "opposed_hypocycloid": (engines.opposed_hypocycloid, ""),
    "otto": (engines.otto, ""),
    "cylinder": (engines.cylinder, ""),
    "engine_parts": (parts.engine_parts, ""),
}


def names() -> list[str]:
    """Names of all theories: those above, and every other derived mechanism."""
    return sorted({*_THEORIES, *scripts()})


@cache
def theory(name: str, case: str = "") -> Theory:
    """A theory with the data of a case.

    Parameters
    ----------
    case : str
        Name of a built-in case or a path; empty for the source's data
    """
    if name not in names():
        raise BadInput(f"there is no theory {name!r}; there are {', '.join(names())}")
    build, usual = _THEORIES.get(name) or (partial(drives.mechanism, name), _usual_case(name))
    chosen = case or usual
    return build(_values(name, chosen) if chosen else {}, chosen)


def _usual_case(mechanism: str) -> str:
    fitting = (c for c in cases.names() if tomllib.loads(cases.text(c)).get("mechanism") == mechanism)
    return next(fitting, "")


def _values(name: str, case: str) -> dict[str, float]:
    found = cases.load(case)
    if name in scripts() and found.mechanism != name:
        raise BadInput(f"case {case} is of the mechanism {found.mechanism}, not of {name}; name another with --case")
    values = {k: v for k, v in dataclasses.asdict(found.need("parameters")).items() if isinstance(v, float)}
    operation: Any = found.sections.get("operation")
    return values | ({"speed": operation.speed} if operation else {})

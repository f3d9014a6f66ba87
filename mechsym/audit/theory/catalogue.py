"""All theories by name, each with the data of a case."""

from collections.abc import Callable, Mapping
from functools import cache, partial

from mechsym.audit.theory import drives, engines, guides, parts, rodless, sliders
from mechsym.audit.theory.record import Theory
from mechsym.cases.numbers import numbers, usual
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
    build, own = _THEORIES.get(name) or (partial(drives.mechanism, name), usual(name))
    chosen = case or own
    return build(numbers(chosen, name if name in scripts() else "") if chosen else {}, chosen)

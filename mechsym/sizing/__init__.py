"""Component sizing: parts for the loads of a cycle, and the safety factor of every rule. SI units, arrays of loads.

wants.py          what a design must reach: section `[sizing]`      pressures.py   the cycle over the speeds
rules/            one rule a function: gears, bearings, shafts, ..   parts/         one part each: sizes and checks
hypocycloid/,     an engine as a whole: its forces, masses, parts;   loads.py       from forces to gears and bearings
slider_crank/     design.py sizes it to a fixed point                checks.py      a part beside its limit
rows.py           results as rows                                    drawing.py     the section view

A rule refuses input outside its validity with `BadInput`; an unsafe part is not an error but a `Check` whose factor is
below the wanted one. Values that a source chose or printed differently are functions of their own with the suffix
`_printed`. Names are imported on first use: a case reads its section `[sizing]` without loading a cycle.
"""

from typing import Any

from mechsym.quantities import load

_FROM = {
    "Check": "mechsym.sizing.checks:Check",
    "Pressures": "mechsym.sizing.pressures:Pressures",
    "Stock": "mechsym.sizing.hypocycloid.parts:Stock",
    "Wants": "mechsym.sizing.wants:Wants",
    "hypocycloid_forces": "mechsym.sizing.hypocycloid.forces:hypocycloid_forces",
    "pressures_over": "mechsym.sizing.pressures:pressures_over",
    "size_hypocycloid": "mechsym.sizing.hypocycloid.design:size_hypocycloid",
    "size_slider_crank": "mechsym.sizing.slider_crank.design:size_slider_crank",
    "slider_crank_forces": "mechsym.sizing.slider_crank.forces:slider_crank_forces",
    "unsafe": "mechsym.sizing.checks:unsafe",
}
__all__ = [*_FROM]


def __getattr__(name: str) -> Any:
    if name in _FROM:
        return load(_FROM[name])
    raise AttributeError(f"module 'mechsym.sizing' has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__

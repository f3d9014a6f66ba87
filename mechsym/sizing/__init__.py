"""Component sizing: parts for the loads of a cycle, and the safety factor of every rule. SI units, arrays of loads.

wants.py          what a design must reach, and its parts: sections `[sizing]`, `[part_*]`
rules/            one rule a function: gears, bearings, shafts, ..
*_design.py       one part each: sizes and checks; crank_design.py also the cycle over the speeds
loads.py          from forces to gears and bearings
hypocycloid/      an engine as a whole: its forces, masses, checks, and sizes to a fixed point
slider_crank.py   the same for a slider crank; a crosshead drive held against its rules
checks.py         a part beside its limit
rows.py           results as rows, and what of them is worth seeing
drawing.py        the section view

A rule refuses input outside its validity with `BadInput`; an unsafe part is not an error but a `Check` whose factor is
below the wanted one. Values that a source chose or printed differently are functions of their own with the suffix
`_printed`. Names are imported on first use: a case reads its section `[sizing]` without loading a cycle.
"""

from mechsym.quantities import lazily

_NAMES = {
    "Check": "mechsym.sizing.checks:Check",
    "Pressures": "mechsym.sizing.crank_design:Pressures",
    "Stock": "mechsym.sizing.hypocycloid.engine:Stock",
    "Wants": "mechsym.sizing.wants:Wants",
    "hypocycloid_forces": "mechsym.sizing.hypocycloid.engine:hypocycloid_forces",
    "pressures_over": "mechsym.sizing.crank_design:pressures_over",
    "size_hypocycloid": "mechsym.sizing.hypocycloid.checks:size_hypocycloid",
    "size_slider_crank": "mechsym.sizing.slider_crank:size_slider_crank",
    "slider_crank_forces": "mechsym.sizing.slider_crank:slider_crank_forces",
    "unsafe": "mechsym.sizing.checks:unsafe",
}
__all__ = [*_NAMES]
__getattr__ = lazily(__name__, _NAMES)

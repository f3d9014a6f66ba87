"""The tables of AGMA 908-B89 in the source's annex, as data, and the interpolation that the source made in them.

`agma908.csv` holds tables A.2 to A.4 (25 degrees, whole depth 2.350, tool edge radius 0.270, thinning 0.024, load at
the highest point of single tooth contact): I, J of pinion and gear, and how each line could be read. A scan error is
named under `reading` with what the scan shows; the value stands as `gear_bending` and `gear_geometry` give it.
Source: Nunes (2017), annex A.2 to A.4 and table 4.8. AGMA 908 advises against interpolating; the formulas need none.
"""

import csv
from functools import cache
from importlib import resources
from typing import Any

import numpy as np

from mechsym.errors import BadInput
from mechsym.sizing.checks import require


@cache
def table() -> tuple[dict[str, Any], ...]:
    """The lines of the three tables.

    Returns
    -------
    lines : tuple of dict
        Keys `shift_pinion, teeth_pinion, teeth_gear, I, J_pinion, J_gear` (numbers, None where the table marks the
        pair undercut or pointed) and `reading`

    Notes
    -----
    Source: Nunes (2017), annex A.2 to A.4.

    Examples
    --------
    >>> len(table()), sum(line["reading"] == "clear" for line in table())
    (108, 69)
    """
    text = (resources.files("mechsym.sizing.rules") / "agma908.csv").read_text(encoding="utf-8")
    lines = []
    for row in csv.DictReader(text.splitlines()):
        reading = row.pop("reading")
        lines.append({key: float(value) if value else None for key, value in row.items()} | {"reading": reading})
    return tuple(lines)


def interpolated(quantity: str, shift: float, teeth_1: float, teeth_2: float) -> float:
    """A geometry factor by linear interpolation in both tooth numbers, as the source did.

    Parameters
    ----------
    shift : float
        Addendum modification of the pinion: 0, 0.25 or 0.5 [-]
    teeth_1, teeth_2 : float
        Teeth of pinion and gear, inside the table [-]

    Returns
    -------
    value : float
        Geometry factor [-]

    Raises
    ------
    BadInput
        Outside the tables, or next to a pair that they mark undercut or pointed

    Notes
    -----
    Source: Nunes (2017), table 4.8: this gives its 18 values.

    Examples
    --------
    >>> f"{interpolated('J_pinion', 0.0, 26, 52):.4f}"  # table 4.8
    '0.4385'
    """
    values = {(r["teeth_pinion"], r["teeth_gear"]): r[quantity] for r in table() if r["shift_pinion"] == shift}
    if not values:
        raise BadInput(f"shift = {shift:g} has no table; there are 0, 0.25 and 0.5 (gear_bending computes the rest)")
    teeth = sorted({gear for _, gear in values})
    require("teeth", [teeth_1, teeth_2], "-", low=teeth[0], high=teeth[-1], hint="gear_bending computes the rest")
    along = [_linear(teeth_2, teeth, lambda gear, pinion=pinion: values.get((pinion, gear))) for pinion in teeth]
    value = _linear(teeth_1, teeth, lambda pinion: along[teeth.index(pinion)])
    if value is None:
        raise BadInput(f"teeth = {teeth_1:g}/{teeth_2:g}: next to a pair that the table marks undercut or pointed")
    return value


def _linear(at, nodes, value):
    """Linear interpolation that is None where a neighbour it needs is None."""
    right = int(np.clip(np.searchsorted(nodes, at), 1, len(nodes) - 1))
    low, high = nodes[right - 1], nodes[right]
    weight = (at - low) / (high - low)
    needed = [(value(node), share) for node, share in ((low, 1 - weight), (high, weight)) if share > 0]
    if any(v is None for v, _ in needed):
        return None
    return sum(v * share for v, share in needed)

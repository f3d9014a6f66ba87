"""Units for people: text and, on request, tables are shown in these; inside every number is SI.

Without a choice lengths are shown in mm, pressures in MPa, angles in degrees, speeds in rpm; forces, torques, powers
and energies with the prefix that suits their size. `choose("mm, bar, kN, kN*m, rad")` sets what the user wants.
"""

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities.names import stem_and_unit
from mechsym.quantities.units import exponents, scale

_USUAL = {"m": "mm", "Pa": "MPa", "rad": "deg", "rad/s": "rpm", "m^2": "cm^2", "m^3": "cm^3",
          "J/kg": "kJ/kg", "Pa*m/s": "MPa*m/s"}  # fmt: skip
_LADDERS = {unit: (unit, f"k{unit}") for unit in ("N", "N*m", "W", "J", "N*m/rad")}
_STIFF = 1e6  # from there on a spring is told in kN/mm [N/m]
_LONG = 36e3  # a life is told in hours [s]
_FAR = 100.0  # a height above the sea is told in metres [m]
SMALLEST = 1e-9  #: A ratio below it is round-off [-]
_TOLD = 1e-6  # of a ratio below it people want to know no more than that [-]
_LEAST, _MOST = 4, 6  # digits in a table
_chosen: dict[tuple[Any, ...], str] = {}


def heading(name: str, values: Any, asked: bool = False, unit: str | None = None) -> tuple[str, Any]:
    """Name with unit, and the values in that unit, as a table shows them.

    Parameters
    ----------
    values : sequence
        In SI, or in the unit that the name carries [unit]
    asked : bool
        Only in units that the user has named
    unit : str, optional
        SI unit, where the name does not tell it

    Returns
    -------
    heading : str
        Such as `torque [kN*m]`; a name that carries its unit stays as it is where only wishes count
    """
    stem, known = (name, unit) if unit is not None else stem_and_unit(name)
    if not known or all(isinstance(v, str) for v in values):
        return name, values
    changed, found = shown_in(values, known, asked or stem != name)
    if asked and stem != name and found == known:
        return name, values
    return f"{stem} [{found}]", changed


def choose(text: str | None) -> None:
    """Show numbers in these units from now on; None or an empty text goes back to the usual ones.

    Parameters
    ----------
    text : str
        Units divided by commas, each for its kind: `mm, MPa, kN, kN*m, deg, rpm, kW`

    Raises
    ------
    BadInput
        Unknown unit, or two of one kind
    """
    found: dict[tuple[Any, ...], str] = {}
    for unit in filter(None, (part.strip() for part in (text or "").split(","))):
        kind = _kind(unit)
        if kind in found:
            raise BadInput(f"--units {text}: {found[kind]} and {unit} are of one kind; name one")
        found[kind] = unit
    _chosen.clear()
    _chosen.update(found)


def chosen() -> bool:
    """Whether the user has named units."""
    return bool(_chosen)


def unit_for(unit: str, size: float = 1.0, asked: bool = False) -> str:
    """The unit in which a number of an SI unit is shown.

    Parameters
    ----------
    size : float
        How large it is at most; decides between N and kN [unit]
    asked : bool
        Only what the user has named, else SI: as tables for programs want it
    """
    if unit in ("", "-") or "(" in unit:  # g/(kW*h) has no other
        return unit
    own = _chosen.get(_kind(unit))
    if own is not None or asked:
        return own or unit
    if unit in _LADDERS:
        return _LADDERS[unit][abs(size) >= 1e3]
    if unit == "N/m":
        return "kN/mm" if abs(size) >= _STIFF else "N/mm"
    if unit == "s":
        return "h" if abs(size) >= _LONG else "s"
    if unit == "m" and abs(size) >= _FAR:
        return unit
    return _USUAL.get(unit, unit)


def shown_in(values: Any, unit: str, asked: bool = False) -> tuple[Any, str]:
    """Values and their unit as they are shown.

    Parameters
    ----------
    values : float or ndarray
        In SI [unit]
    """
    size = _largest(values)
    wanted = unit_for(unit, size, asked)
    if wanted == unit:
        return values, wanted
    factor = scale(unit) / scale(wanted)
    if isinstance(values, (float, int, np.ndarray)):
        return values * factor, wanted
    return [_times(v, factor) for v in values], wanted


def quantity_text(value: float | None, unit: str, digits: int = 5) -> str:
    """A number with its unit for people.

    Parameters
    ----------
    value : float or None
        In SI [unit]

    Examples
    --------
    >>> quantity_text(1.65511e7, "Pa"), quantity_text(9000.0, "N*m"), quantity_text(0.0129, "m")
    ('16.551 MPa', '9 kN*m', '12.9 mm')
    """
    if value is None or not math.isfinite(value):
        return "-"
    number, found = shown_in(float(value), unit)
    return f"{figure(number, digits)} {found}" if found not in ("", "-") else figure(number, digits)


def figure(value: float | None, digits: int = 5) -> str:
    """A number for people: a few digits, no exponent between 1e-4 and 1e7, no round-off.

    Parameters
    ----------
    value : float or None
        In any unit [-]

    Examples
    --------
    >>> figure(37809.6), figure(1.5e-7), figure(None), figure(0.1 + 0.2)
    ('37810', '1.5e-07', '-', '0.3')
    """
    if value is None or value != value:
        return "-"
    if value == 0 or not math.isfinite(value):
        return "0" if value == 0 else f"{value:g}"
    rounded = float(f"{value:.{digits}g}")
    if 1e-4 <= abs(rounded) < 1e7:
        places = max(0, digits - 1 - math.floor(math.log10(abs(rounded))))
        text = f"{rounded:.{places}f}"
        return text.rstrip("0").rstrip(".") if "." in text else text
    return f"{rounded:.{digits}g}"


def ratio_text(value: float | None, digits: int = 3) -> str:
    """A ratio or residual for people; what is round-off is said to be.

    Parameters
    ----------
    value : float or None
        Pure number [-]

    Examples
    --------
    >>> ratio_text(7.1e-12), ratio_text(-4.9e-9), ratio_text(0.02)
    ('0 (below 1e-9)', '0 (below 1e-8)', '0.02')
    """
    if value is not None and abs(value) < _TOLD:
        power = math.floor(math.log10(max(abs(value), SMALLEST / 2))) + 1
        return f"0 (below 1e{power})"
    return figure(value, digits)


def per_cent(share: float, digits: int = 3) -> str:
    """A share for people.

    Parameters
    ----------
    share : float
        Of the whole [-]

    Examples
    --------
    >>> per_cent(0.2123), per_cent(1.00004)
    ('21.2 %', '100 %')
    """
    return f"{figure(100 * share, digits)} %"


def column_text(values: Sequence[Any], least: int = _LEAST) -> list[str]:
    """Cells of a table's column: four digits, more where neighbours differ in them only; whole numbers as they are.

    Parameters
    ----------
    values : sequence
        Numbers in one unit, or text [unit]
    least : int
        Digits where no more are needed [-]

    Examples
    --------
    >>> column_text([31.02361, None, 194.99431, 12345.0, "yes"])
    ['31.02', '-', '195', '12345', 'yes']
    >>> column_text([100.01, 100.02])
    ['100.01', '100.02']
    """
    numbers = [float(v) for v in values if isinstance(v, (float, np.floating)) and math.isfinite(v)]
    digits = next((d for d in range(least, _MOST) if _parts(numbers, d) == _parts(numbers, _MOST)), _MOST)
    return [_cell(value, digits) for value in values]


def _parts(numbers: list[float], digits: int) -> list[bool]:
    """Whether each number is another than the one before it, as it is printed."""
    told = [figure(v, digits) for v in numbers]
    return [a != b for a, b in pairwise(told)]


def _cell(value: Any, digits: int) -> str:
    if value is None or value != value:
        return "-"
    if not isinstance(value, (float, np.floating)):
        return ", ".join(str(v) for v in value) if isinstance(value, (list, tuple)) else str(value)
    whole = abs(value) < 10**_MOST and float(value).is_integer()
    return figure(float(value), _MOST if whole else digits)


def _times(value: Any, factor: float) -> Any:
    return value * factor if isinstance(value, (int, float)) and not isinstance(value, bool) else value


def _largest(values: Any) -> float:
    numbers: Iterable[Any] = np.ravel(values) if isinstance(values, (int, float, np.ndarray)) else values
    if isinstance(values, list) and set(map(type, values)) <= {float, type(None)}:  # a million go at once
        column = np.array(values, dtype=float)
        return float(np.abs(column).max(initial=0.0, where=np.isfinite(column)))
    found = [abs(float(v)) for v in numbers if isinstance(v, (int, float, np.number)) and math.isfinite(v)]
    return max(found, default=0.0)


def _kind(unit: str) -> tuple[Any, ...]:
    # N m is a torque or an energy, told by how it is written
    return (*exponents(unit), "J" in unit)

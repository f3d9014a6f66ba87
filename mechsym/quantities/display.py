"""Units and words for people: text and, on request, tables are shown in these; inside every number is SI.

Without a choice lengths are shown in mm, pressures in MPa, angles in degrees, speeds in rpm; forces, torques, powers
and energies with the prefix that suits their size. `choose("mm, bar, kN, kN*m, rad")` sets what the user wants.
"""

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities.units import Pure, Scalar, exponents, scale

# heads of tables in files carry these, as p_pa and phi_deg do, and columns of a user's; of results the fields say it
_ENDINGS: Mapping[str, str] = {
    "rpm": "rpm", "bar": "bar", "mpa": "MPa", "kpa": "kPa", "kw": "kW", "deg": "deg", "g_kwh": "g/(kW*h)", "pa": "Pa",
    "k": "K", "m3": "m^3", "n": "N", "nm": "N*m", "kg_s": "kg/s", "j": "J", "w": "W", "kg": "kg", "rad_s": "rad/s",
}  # fmt: skip
_LONGEST_FIRST = "|".join(sorted(_ENDINGS, key=len, reverse=True))
_WITH_UNIT = re.compile(rf"^(?P<stem>.+)_(?P<unit>{_LONGEST_FIRST})(?P<rest>_per_cylinder)?$")
_USUAL = {"m": "mm", "Pa": "MPa", "rad": "deg", "rad/s": "rpm", "m^2": "cm^2", "m^3": "cm^3",
          "J/kg": "kJ/kg", "Pa*m/s": "MPa*m/s"}  # fmt: skip
_LADDERS = {unit: (unit, f"k{unit}") for unit in ("N", "N*m", "W", "J", "N*m/rad")}
_STIFF = 1e6  # from there on a spring is told in kN/mm [N/m]
_LONG = 36e3  # a life is told in hours [s]
_FAR = 100.0  # a height above the sea is told in metres [m]
SMALLEST = 1e-9  #: A ratio below it is round-off [-]
_TOLD = 1e-6  # of a ratio below it people want to know no more than that [-]
_LEAST, _MOST = 4, 6  # digits in a table
_chosen: dict[tuple[int, ...], str] = {}


def heading(name: str, values: Scalar, asked: bool = False, unit: str | None = None) -> tuple[str, Scalar]:
    """Name with unit, and the values in that unit, as a table shows them.

    values: in SI, or in the unit that the name carries [unit]; asked: only in units that the user has named; unit: SI
    unit, where the name does not tell it. Returns heading: str, such as `torque [kN*m]`; a name that carries its unit
    stays as it is where only wishes count.
    """
    stem, known = stem_and_unit(name) if unit is None else (without_unit(name, unit), unit)
    if not known or all(isinstance(v, str) for v in values):
        return name, values
    changed, unit_shown = shown_in(values, known, asked or stem != name)
    if asked and stem != name and unit_shown == known:
        return name, values
    return f"{stem} [{unit_shown}]", changed


def stem_and_unit(name: str) -> tuple[str, str]:
    """A name without the unit that it carries, and that unit; empty where it carries none.

    >>> stem_and_unit("speed_rpm"), stem_and_unit("verdict")
    (('speed', 'rpm'), ('verdict', ''))
    """
    carried = _WITH_UNIT.match(name)
    return (carried["stem"] + (carried["rest"] or ""), _ENDINGS[carried["unit"]]) if carried else (name, "")


def without_unit(name: str, unit: str) -> str:
    """A name without the unit that it ends with.

    >>> without_unit("power_kw", "kW"), without_unit("sfc_g_kwh", "g/(kW*h)"), without_unit("torque", "N*m")
    ('power', 'sfc', 'torque')
    """
    end = "_" + re.sub(r"[*^()]", "", unit.lower()).replace("/", "_")
    head, middle, rest = name.rpartition(end)
    return head + rest if middle and rest in ("", "_per_cylinder") else name


def choose(text: str | None) -> None:
    """Show numbers in these units from now on; None or an empty text goes back to the usual ones.

    text: units divided by commas, each for its kind: `mm, MPa, kN, kN*m, deg, rpm, kW`. Raises BadInput: unknown unit,
    or two of one kind.
    """
    by_kind: dict[tuple[int, ...], str] = {}
    for unit in filter(None, (part.strip() for part in (text or "").split(","))):
        kind = _kind(unit)
        if kind in by_kind:
            raise BadInput(f"--units {text}: {by_kind[kind]} and {unit} are of one kind; name one")
        by_kind[kind] = unit
    _chosen.clear()
    _chosen.update(by_kind)


def chosen() -> tuple[str, ...]:
    """The units that the user has named."""
    return tuple(_chosen.values())


def unit_for(unit: str, size: float = 1.0, asked: bool = False) -> str:
    """The unit in which a number of an SI unit is shown.

    size: how large it is at most; decides between N and kN [unit]. asked: only what the user has named, else SI: as
    tables for programs want it.
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


def shown_in(values: Scalar, unit: str, asked: bool = False) -> tuple[Scalar, str]:
    """Values and their unit as they are shown. values: in SI [unit]. Returns values, unit: in that unit [unit]."""
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

    value: in SI [unit].

    >>> quantity_text(1.65511e7, "Pa"), quantity_text(9000.0, "N*m"), quantity_text(0.0129, "m")
    ('16.551 MPa', '9 kN*m', '12.9 mm')
    """
    if value is None or not math.isfinite(value):
        return "-"
    number, unit_shown = shown_in(float(value), unit)
    return f"{figure(number, digits)} {unit_shown}" if unit_shown not in ("", "-") else figure(number, digits)


def in_si(value: float, unit: str) -> tuple[float, str]:
    """A number in the SI unit of its kind, and that unit, where its name carries another.

    value: in the unit of its name [unit]. Returns number: in that SI unit [unit].

    >>> in_si(0.25, "kW"), in_si(3.0, "-")
    ((250.0, 'W'), (3.0, '-'))
    """
    if unit in ("", "-") or "(" in unit:  # g/(kW*h) has no other
        return value, unit
    base = next((si for si in (*_LADDERS, *_USUAL) if _kind(si) == _kind(unit)), unit)
    return value * scale(unit) / scale(base), base


def figure(value: Pure | None, digits: int = 5) -> str:
    """A number for people: a few digits, no exponent between 1e-4 and 1e7, no round-off.

    value: in any unit.

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


def ratio_text(value: Pure | None, digits: int = 3) -> str:
    """A ratio or residual for people; what is round-off is 0.

    value: pure number.

    >>> ratio_text(7.1e-12), ratio_text(-4.9e-9), ratio_text(0.02)
    ('0', 'below 1e-8', '0.02')
    """
    if value is not None and abs(value) < _TOLD:
        return "0" if abs(value) < SMALLEST else f"below 1e{math.floor(math.log10(abs(value))) + 1}"
    return figure(value, digits)


def without_rounding(rows: Sequence[dict[str, Any]], keys: Sequence[str]) -> list[dict[str, Any]]:
    """Rows of one table with a unit each, where values that are round-off beside the largest of their unit are 0.

    keys: of the values, in the unit that stands under `unit`.
    """
    largest: dict[str, float] = {}
    for row in rows:
        largest[row["unit"]] = max(largest.get(row["unit"], 0.0), *(abs(row[key]) for key in keys))
    return [
        row | {key: row[key] if abs(row[key]) > SMALLEST * largest[row["unit"]] else 0.0 for key in keys}
        for row in rows
    ]


def residual_text(value: Pure | None, digits: int = 3) -> str:
    """What should be 0 and is but for round-off, for people: never 0 itself.

    value: pure number.

    >>> residual_text(7.1e-12), residual_text(0.0), residual_text(-4.9e-9), residual_text(0.02)
    ('below 1e-9', 'below 1e-9', 'below 1e-8', '0.02')
    """
    if value is not None and abs(value) < SMALLEST:
        return f"below 1e{math.floor(math.log10(SMALLEST))}"
    return ratio_text(value, digits)


def per_cent(share: Pure, digits: int = 3) -> str:
    """A share for people.

    share: of the whole.

    >>> per_cent(0.2123), per_cent(1.00004)
    ('21.2 %', '100 %')
    """
    return f"{figure(100 * share, digits)} %"


def column_text(values: Sequence[object], least: int = _LEAST) -> list[str]:
    """Cells of a table's column: four digits, more where neighbours differ in them only; whole numbers as they are.

    values: numbers in one unit, or text [unit]; least: digits where no more are needed.

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
    texts = [figure(v, digits) for v in numbers]
    return [a != b for a, b in pairwise(texts)]


def _cell(value: object, digits: int) -> str:
    if value is None or value != value:
        return "-"
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    if not isinstance(value, (float, np.floating)):
        return ", ".join(str(v) for v in value) if isinstance(value, (list, tuple)) else str(value)
    whole = abs(value) < 10**_MOST and float(value).is_integer()
    return figure(float(value), _MOST if whole else digits)


def _times(value: object, factor: float) -> object:
    return value * factor if isinstance(value, (int, float)) and not isinstance(value, bool) else value


def _largest(values: Scalar) -> float:
    numbers: Iterable[object] = np.ravel(values) if isinstance(values, (int, float, np.ndarray)) else values
    if isinstance(values, list) and set(map(type, values)) <= {float, type(None)}:  # a million go at once
        column = np.array(values, dtype=float)
        return float(np.abs(column).max(initial=0.0, where=np.isfinite(column)))
    sizes = [abs(float(v)) for v in numbers if isinstance(v, (int, float, np.number)) and math.isfinite(v)]
    return max(sizes, default=0.0)


def _kind(unit: str) -> tuple[int, ...]:
    # N m is a torque or an energy, told by how it is written
    return (*exponents(unit), "J" in unit)


_WHOLE: Mapping[str, str] = {
    "p_max": "largest pressure", "p_max_mpa": "largest pressure", "p_max_angle": "angle of the largest pressure",
    "t_end": "end of the run", "wall": "time it took", "steps": "steps of the integrator", "backend": "integrator",
    "energy_residual": "energy left over", "power_residual": "power left over", "facts": "assumed",
    "tolerance_difference": "difference to a finer run", "each": "one is a",
    "misfire_speed_share": "speed left by a lost combustion", "p": "pressure p",
    "natural": "natural frequency", "natural_bare": "natural frequency, bare",
    "closing_share": "closing", "failing": "safety factors too low",
    "rms_before": "before, root mean square", "rms_after": "after, root mean square",
}  # fmt: skip
_FRONT = {"max": "largest", "min": "least", "mean": "mean", "avg": "mean", "peak": "largest", "rms": "rms"}
_TOKENS = {"mep": "IMEP", "sfc": "consumption", "deg": "", "ca10": "CA10", "ca50": "CA50", "ca90": "CA90"}
_PLACE = re.compile(r"\[(\d+)\]")


def key_words(key: str, known: Mapping[str, str] | None = None) -> str:
    """A key, or the path of a number, as words; what is no key stays as it is.

    known: words of keys that have their own.

    >>> key_words("torque_max"), key_words("speeds.phi.mean"), key_words("twist[0].twist_peak")
    ('largest torque', 'speeds, phi, mean', 'twist 1, largest twist')
    >>> key_words("energy_residual"), key_words("load torque")
    ('energy left over', 'load torque')
    """
    if " " in key:
        return key
    return ", ".join(filter(None, (_part(part, known or {}) for part in key.split("."))))


def _part(part: str, known: Mapping[str, str]) -> str:
    name, place = _PLACE.sub("", part), _PLACE.search(part)
    number = f" {int(place[1]) + 1}" if place else ""
    if (words := _WHOLE.get(name) or known.get(name, "")) and "_" not in words:
        return words + number
    *tokens, last = [_TOKENS.get(token, token) for token in name.split("_")]
    if tokens and last in _FRONT:
        tokens, last = [_FRONT[last], *tokens[:-1]], tokens[-1]
    return " ".join(filter(None, (*tokens, last))) + number

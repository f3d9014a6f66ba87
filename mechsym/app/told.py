"""What a command says in JSON as rows for people: every number in its unit, what belongs together in one row."""

import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from mechsym.cycle.columns import UNITS, WORDS
from mechsym.files import Json
from mechsym.quantities.display import figure, key_words, quantity_text, ratio_text, shown_in, without_unit

Rows = list[tuple[str, str]]

# of a folder that is gone; beside their values; ends of curves; at the head of the page
_SILENT = ("files", "written", "units", "final_state", "case", "mechanism", "each")
_MOST = 8  # entries of a list that are told
_DIGITS = 4
_SENTENCE = 90  # letters: a longer text stands under a heading of its own
_SPANNED = ("min", "max", "angle_of_max_deg", "reactions")
_TURN = "least to largest over the turn"
_RODS = {"two_mass_": "with the rod as two masses", "terskih_": "with the rod after Terskih"}
_ORDERS = 4  # orders of a harmonic analysis that are told
_NAMES = {"component", "quantity"}
_HARMONIC = {"order", "amplitude", "phase"}
_AS_ONE = ({"value", "confidence"}, {"limit", "multiplier", "unit"})
_PRODUCT = re.compile(r"(?<=\d )k?(N\*m|g\*m(\^2)?)(?![*\w])")  # a unit behind its number
# what is less in any machine of ours is round-off [its unit]
_BARE = dict.fromkeys(("N", "N*m", "J"), 1e-9) | dict.fromkeys(("kg*m", "rad", "deg"), 1e-12)
_ROUNDING = 1e-9  # of the largest number of one unit in a group
_FREQUENCIES = ("natural", "natural_bare", "natural_frequencies")  # told in Hz
_PLAIN = ("tolerance", "knock")  # pure numbers that are no ratios
#: Words of results without the unit that ends their names
KNOWN = {without_unit(name, UNITS[name]): words for name, words in WORDS.items()} | {
    "d2x_dphi2": "curvature of x", "dpsi_dphi": "slope of psi", "dinertia_dphi": "slope of the inertia",
}  # fmt: skip
Units = Mapping[str, str]  # of numbers by their paths


def told(data: Json | list[Json], units: Units) -> Rows:
    """Rows of what a command said; units: of its numbers by path, `speeds.phi.mean`."""
    rows = _told(data, units)
    worded = {name: key_words(name, KNOWN) for name, _ in rows}
    often = Counter(worded.values())
    return [(worded[name] if often[worded[name]] == 1 else key_words(name), text) for name, text in rows]


def grouped(rows: Sequence[tuple[str, str]]) -> dict[str, Rows]:
    """Rows by the first word of their names, where several share it; those that stand alone under none.

    >>> grouped([("speed", "89 rpm"), ("work, gas", "9 J"), ("work, load", "-9 J"), ("assumed", "a"), ("assumed", "b")])
    {'': [('speed', '89 rpm')], 'work': [('gas', '9 J'), ('load', '-9 J')], 'assumed': [('', 'a'), ('', 'b')]}
    """
    often = Counter(name.partition(", ")[0] for name, _ in rows)
    groups: dict[str, Rows] = {}
    for name, text in rows:
        title, _, rest = name.partition(", ")
        several = often[title] > 1 or len(text) > _SENTENCE
        groups.setdefault(title if several else "", []).append((rest if several else name, text))
    return groups


def _told(data: Json | list[Json], units: Units) -> Rows:
    if isinstance(data, list):
        # rows of a sizing or an audit: what, and its value beside its limit; what does not hold stands first
        if not all(isinstance(row, Mapping) and row.keys() >= _NAMES for row in data):
            return _rows("", list(data), units)
        order = sorted(data, key=lambda row: (row.get("holds") is not False, row["limit"] is None))
        return [(f"{key_words(r['component'])}: {r['quantity']}", _beside(r)) for r in order]
    rows = [
        (word, f"{d['quantity']} = {figure(d['value'])}, usual is {d['usual']}: {d['why']}")
        for word, key in (("doubt", "doubts"), ("accepted", "accepted"))
        for d in data.get(key) or ()
    ]
    spans = isinstance(data.get("min"), Mapping) and isinstance(data.get("max"), Mapping)
    hidden = {"doubts", "accepted", "headline", *_SILENT, *(_SPANNED if spans else ())}
    rest = {k: v for k, v in data.items() if k not in hidden}
    inner = {k: v for k, v in rest.items() if isinstance(v, (Mapping, list))}
    said = {k: v for k, v in inner.items() if isinstance(v, list) and v and isinstance(v[0], str)}
    rows += _rows("", {k: v for k, v in rest.items() if k not in inner}, units) + _rows("", said, units)
    others = {k: v for k, v in inner.items() if k not in said}
    return rows + (_spans(data, units) if spans else []) + _rows("", others, units)


def unit_of(path: str, units: Units) -> tuple[str, str]:
    """The path of a number without the unit that it carries, and its unit: `-` of a pure number, empty where unknown.

    >>> unit_of("per_cylinder.power_kw", {"per_cylinder.power_kw": "kW"}), unit_of("power", {})
    (('per_cylinder.power', 'kW'), ('power', ''))
    """
    last = path.rpartition(".")[2].partition("[")[0]
    unit = units.get(path) or units.get(re.sub(r"(\[\d+\])+$", "", path), "")
    unit = "" if " " in unit else unit  # of coordinates of several kinds
    if last in _FREQUENCIES and unit == "rad/s":
        return path, "Hz"
    front, dot, last = path.rpartition(".")
    return f"{front}{dot}{without_unit(last, unit) if unit else last}", "1" if last in _PLAIN else unit


def pretty(text: str) -> str:
    """A unit as people write it.

    >>> pretty("9 kN*m"), pretty("kg*m^2"), pretty("g/(kW*h)")
    ('9 kN m', 'kg m²', 'g/(kW h)')
    """
    return text.replace("*", " ").replace("^2", "²").replace("^3", "³")


def pretty_words(text: str) -> str:
    """A sentence with its units as people write them; what may be a formula stays as it is.

    >>> pretty_words("the shaft carries 70.21 N*m of it"), pretty_words("2*m*r")
    ('the shaft carries 70.21 N m of it', '2*m*r')
    """
    return _PRODUCT.sub(lambda match: pretty(match[0]), text)


def measure(value: float, unit: str) -> str:
    """A number in SI with its unit for people; frequencies in Hz; what rounds to nothing is said to be [unit]."""
    if unit in ("", "-", "1"):
        return ratio_text(value, _DIGITS) if unit == "-" else figure(value)
    value = 0.0 if unit in _BARE and abs(value) < _BARE[unit] else value
    return pretty(quantity_text(value / (2 * math.pi) if unit == "Hz" else value, unit, _DIGITS))


def span(low: float, high: float, unit: str) -> str:
    """Least and largest value in one unit of people [unit]."""
    (a, b), shown = shown_in([low, high], unit)
    return f"{figure(a, _DIGITS)} to {figure(b, _DIGITS)}{_after(shown)}"


def _spans(data: Json, units: Units) -> Rows:
    """Least and largest of each quantity in one row, and where it is largest."""
    low, high, where = data["min"], data["max"], data.get("angle_of_max_deg") or {}
    rows, places = [], data.get("reactions") or {}
    for key in (k for k in high if k in low and k != "phi_deg"):
        at = f", largest at {figure(where[key])} deg" if key in where else ""
        group, rest = next(((g, key.removeprefix(s)) for s, g in _RODS.items() if key.startswith(s)), (_TURN, key))
        on = f" ({places[key]})".replace("_", " ") if key in places else ""
        name = f"{group}, {key_words(rest, KNOWN)}{on}"
        rows.append((name, span(low[key], high[key], unit_of(f"max.{key}", units)[1]) + at))
    return rows


def _after(unit: str | None) -> str:
    return "" if unit in (None, "", "-") else f" {pretty(unit or '')}"


def _beside(row: Json) -> str:
    unit = row["unit"] or "-"
    if not isinstance(row["value"], (int, float)):
        return _text(row["value"], unit)
    if row["limit"] is None:
        return measure(row["value"], unit)
    word = "" if row["holds"] else ", BELOW what is wanted"
    return (
        f"{measure(row['value'], unit)}, limit {measure(row['limit'], unit)}, "
        f"factor {figure(row['safety_factor'])}{word}"
    )


def _rows(prefix: str, data: object, units: Units) -> Rows:
    """Numbers and texts by dotted name; sentences each in a row, of a long list its length and ends."""
    if data in (None, "") or (isinstance(data, list) and all(value is None for value in data)):
        return []  # what this case does not have
    if isinstance(data, Mapping):
        if data.keys() in _AS_ONE:
            return [(prefix, _as_one(data, unit_of(f"{prefix}.value", units)[1]))]
        if _harmonic(data):
            data = {"": data}
        if data and all(map(_harmonic, data.values())):
            return [(f"{prefix}.{k}".rstrip("."), v) for k, v in _orders(prefix, data, units).items()]
        data = _settled(prefix, data, units)
        paths = {f"{prefix}.{key}" if prefix else str(key): value for key, value in data.items()}
        return _apart([(path, row) for path, value in paths.items() for row in _rows(path, value, units)])
    if not isinstance(data, list):
        name, unit = unit_of(prefix, units) if _number(data) else (prefix, "")
        return [(name, _text(data, unit))]
    if isinstance(data[0], str):
        return [(prefix, pretty_words(value)) for value in data]
    if isinstance(data[0], (Mapping, list)):
        rows = [row for i, value in enumerate(data[:_MOST]) for row in _entry(f"{prefix}[{i}]", value, units)]
        left = len(data) - _MOST
        return [*rows, (prefix, f"and {left} more in the JSON")] if left > 0 else rows
    name, unit = unit_of(prefix, units)
    if name.endswith("residual") and all(map(_number, data)):
        return [(name, f"{measure(max(map(abs, data)), unit)} at most")]
    return [(name, _listed(data, unit))]


def _apart(rows: Sequence[tuple[str, tuple[str, str]]]) -> Rows:
    """Rows by their paths; two that differ in their unit only keep it in their names."""
    named = Counter(name for path, (name, _) in rows if path != name)
    return [(path if named[name] > 1 and path.startswith(f"{name}_") else name, text) for path, (name, text) in rows]


def _entry(prefix: str, entry: object, units: Units) -> Rows:
    """An entry of a list: in one row where it holds plain values only."""
    rows = _rows(prefix, entry, units)
    flat = isinstance(entry, Mapping) and not any(isinstance(v, (Mapping, list)) for v in entry.values())
    if not flat or len(rows) < 2:
        return rows
    return [(prefix, "; ".join(f"{key_words(name.rpartition('.')[2], KNOWN)} {value}" for name, value in rows))]


def _as_one(data: Mapping[str, Any], unit: str) -> str:
    """A value with its confidence, or a limit with what one more of it would give."""
    if "limit" in data:
        per = "" if data["unit"] in (None, "-") else f" per {pretty(data['unit'])}"
        return f"{key_words(data['limit'])}, multiplier {figure(data['multiplier'])}{per}"
    return f"{_text(data['value'], unit)} \u00b1 {_text(data['confidence'], unit)}"


def _settled(prefix: str, data: Mapping[str, Any], known: Units) -> Json:
    """A group whose numbers are 0 where they only round beside the largest of their unit."""
    units = {k: unit_of(f"{prefix}.{k}", known)[1] for k, v in data.items() if isinstance(v, float)}
    sizes = {u: max(abs(data[k]) for k in units if units[k] == u) for u in {*units.values()} - {"", "-", "1"}}
    settled = {k: 0.0 if k in units and abs(v) < _ROUNDING * sizes.get(units[k], 0.0) else v for k, v in data.items()}
    nothing = abs(data.get("unbalance") or 0.0) < _BARE["kg*m"] and "unbalance" in data
    return {k: v for k, v in settled.items() if not (nothing and k.startswith("angle"))}  # nothing has no direction


def _listed(values: Sequence[Any], unit: str) -> str:
    """Numbers of a list in one unit, of a long one the first and the last."""
    if unit == "-" and len(values) == 1 and isinstance(values[0], float):
        return measure(values[0], unit)
    numbers = [v / (2 * math.pi) if unit == "Hz" and _number(v) else v for v in values]
    changed, shown = shown_in(numbers, unit) if unit not in ("", "1") else (numbers, "")
    texts = [figure(float(v), _DIGITS) if _number(v) else _text(v, "") for v in changed]
    short = texts if len(texts) <= _MOST else [texts[0], "..", texts[-1]]
    return ", ".join(short) + _after(shown)


def _harmonic(value: object) -> bool:
    """Whether something is a harmonic analysis."""
    return isinstance(value, Mapping) and value.keys() == _HARMONIC and isinstance(value["order"], list)


def _orders(prefix: str, group: Mapping[str, Mapping[str, Any]], units: Units) -> dict[str, str]:
    """Mean and largest orders of each analysis of a group; what is round-off beside the largest of all is left out."""
    size = max((abs(a) for one in group.values() for a in one["amplitude"] if a is not None), default=0.0)
    words = {}
    for name, one in group.items():
        unit = unit_of(f"{prefix}.{name}".rstrip(".") + ".amplitude", units)[1]
        seen = [(n, a) for n, a in zip(one["order"], one["amplitude"], strict=True) if a and abs(a) > _ROUNDING * size]
        largest = sorted((p for p in seen if p[0]), key=lambda p: -abs(p[1]))[:_ORDERS]
        parts = [f"mean {measure(a, unit)}" for n, a in seen if not n]
        words[name] = "; ".join([*parts, *(f"order {n:g}: {measure(a, unit)}" for n, a in largest)]) or "0"
    return words


def _number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _text(value: object, unit: str) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return f"{value}{_after(unit)}"
    if isinstance(value, float):
        return measure(value, unit)
    return "-" if value is None else pretty_words(str(value))

"""Where each value of a case comes from: the comments of its file, key by key.

    bore = "0.3 m"   # Zotov et al. 2024, text above Fig. 3

A comment "same" names the source above it in its section. What is overridden says so; what the file leaves away
has mechsym's usual value.
"""

import dataclasses
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from mechsym import cases
from mechsym.cases import Case
from mechsym.cases.keys import meaning
from mechsym.quantities import record
from mechsym.quantities.display import chosen, figure, quantity_text

_SECTION = re.compile(r"\s*\[\[?\s*([\w.-]+)\s*\]\]?")
_KEY = re.compile(r"\s*([\w-]+(?:\.[\w-]+)*)\s*=")
_CHOICE = re.compile(r"^[a-z]+(_[a-z]+)+$")  # a word to choose
_NAMES = ("Wiebe", "Young's", "Poisson's", "Hertz", "Nusselt", "Reynolds")
_OPEN, _CLOSED = "[{", "]}"
_FAR = 1e3  # a length that may be so large is told in metres [m]
_UNTOLD = "stated in the case, without a source"


@record
class SourcedValue:
    """One value of a case."""

    key: str  #: Section and field, dotted
    value: str  #: With its unit
    about: str  #: What it means
    origin: str  #: Where it comes from


def sourced(case: Case) -> list[SourcedValue]:
    """The values of a case with unit, meaning and origin, section by section."""
    origins = comments(cases.text(case.path))
    places = [cases.locate(case.path, key) for key in case.overrides]
    replaced = {f"{place.section}.{place.field}" for place in places}
    rows = []
    for section, values in case.sections.items():
        for field in dataclasses.fields(values):
            key, shown = f"{section}.{field.name}", _shown(getattr(values, field.name), field.metadata)
            if shown:
                # a key may carry its unit: speed_rpm = 142
                written = [k for k in origins if k == key or k.startswith(f"{key}_")]
                usual = _UNTOLD if written else "usual value of mechsym"
                origin = next((origins[k] for k in [key, *written] if origins.get(k)), usual)
                origin = "set for this run" if key in replaced else origin
                # a comment of a record as a reader's meaning: no marks of code, no capital before a small letter
                about = meaning(type(values), field).replace("`", "")
                small = about[1:2].islower() and not about.startswith(_NAMES)
                about = about[:1].lower() + about[1:] if small else about
                rows.append(SourcedValue(key=key, value=shown, about=about, origin=origin))
    return rows


def comments(text: str) -> dict[str, str]:
    """Comment of each key of a case file, by dotted key without a unit; empty where there is none.

    >>> comments('[operation]\\nspeed = "89 rpm" # a; b')
    {'operation.speed': 'a; b'}
    """
    origins: dict[str, str] = {}
    section, source = "", ""
    for line, comment in _joined(text):
        if heading := _SECTION.match(line):
            section, source = heading[1], comment
        elif key := _KEY.match(line):
            same = re.match(r"same\b", comment)
            source = source if same or not comment else comment
            origins[f"{section}.{key[1]}"] = source.partition(":")[0] + comment[4:] if same else comment
    return origins


def _joined(text: str) -> Iterator[tuple[str, str]]:
    """Lines without their comments, an array over several lines as one, and the comments."""
    held, notes = "", list[str]()
    for raw in text.splitlines():
        line, comment = _parted(raw)
        held += line
        notes += [comment.strip()] if comment.strip() else []
        if sum(held.count(c) for c in _OPEN) <= sum(held.count(c) for c in _CLOSED):
            yield held, "; ".join(notes)
            held, notes = "", []


def _parted(line: str) -> tuple[str, str]:
    """A line at the # that is not in a text."""
    quote = ""
    for i, letter in enumerate(line):
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "\"'":
            quote = letter
        elif letter == "#":
            return line[:i], line[i + 1 :]
    return line, ""


def _shown(value: object, about: Mapping[str, Any]) -> str:
    unit = about.get("unit") or ""
    if unit == "m" and (about.get("high") or 0.0) >= _FAR and not chosen() and isinstance(value, (int, float)):
        return f"{figure(float(value), 6)} m"  # no length of a machine: a height above the sea
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, str):
        # a reader has not the writer's folders
        return Path(value).name if Path(value).is_absolute() else _CHOICE.sub(lambda m: m[0].replace("_", " "), value)
    if isinstance(value, (int, float)):
        return quantity_text(float(value), unit, 6)
    if isinstance(value, (tuple, list)) and value and all(isinstance(v, (int, float)) for v in value):
        shown = [quantity_text(float(v), unit, 6) for v in value]
        return shown[0] + " (each)" if len(set(shown)) == 1 and len(shown) > 1 else ", ".join(shown)
    return ""

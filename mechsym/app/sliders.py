"""Sliders of a case: every number of its sections that stands alone, with unit, meaning and a range around it."""

import dataclasses
import math
import tomllib
from collections.abc import Mapping

from mechsym import cases
from mechsym.app import uploads
from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.quantities import quantity, record
from mechsym.quantities.display import key_words
from mechsym.quantities.records import Field, Record

REACH = 2.0  #: times a value, and its inverse, are as far as its slider goes
_STEPS = 200
#: how far the slider of a zero goes by its unit; else as far as the largest value of its section with that unit, or 1
_FROM_ZERO = {"Pa": 2e5, "m/s^2": 20.0}
_HALVINGS = 8
_SYMBOL = 4  # letters: a longer name is no symbol


@record
class Slider:
    """One value that can be moved."""

    key: str  #: section.name, as `--set` takes it
    label: str
    about: str
    unit: str  #: SI
    value: float = quantity("-", about="of the case, in `unit`")
    low: float = quantity("-", about="left end, in `unit`")
    high: float = quantity("-", about="right end, in `unit`")
    step: float = quantity("-", above=0, about="between two places, in `unit`")


def sliders(case: Case) -> tuple[Slider, ...]:
    """Every number that stands alone in the text of a case; whatever single slider is moved, the case can be read."""
    shown = []
    for section, data in case.sections.items():
        for field in numbers(case, section):
            value = float(getattr(data, field.name))
            reach = REACH * abs(value) or _from_zero(data, field.metadata["unit"])
            shown.append(_slider(case, f"{section}.{field.name}", field, value, reach))
    return tuple(shown)


def numbers(case: Case, section: str) -> list[Field]:
    """The fields of a section that stand in the text of the case as one number with a unit."""
    given, data = tomllib.loads(cases.text(case.path)).get(section), case.sections[section]
    if not dataclasses.is_dataclass(data) or not isinstance(given, dict):
        return []
    stand = [f for f in dataclasses.fields(data) if any(k == f.name or k.startswith(f"{f.name}_") for k in given)]
    return [f for f in stand if "unit" in f.metadata and isinstance(getattr(data, f.name), (int, float))]


def safe(name: str, own: str, texts: Mapping[str, str]) -> dict[str, float]:
    """Values from an address in the browser, which anybody may have written.

    name: case that the address names: a built-in one, an upload of this browser, or `own`, with which it was started.
    texts: keys and SI values as text. Returns values: only numbers of keys that have a slider, so no file can be named
    [unit of the key].
    """
    upload = uploads.kept(name)
    if name != own and name not in cases.names() and upload is None:
        raise BadInput(f"case {name!r} is not built in; start the workbench with it: mechsym app {name}")
    known = {s.key for s in sliders(cases.load(upload or name))}
    values = {}
    for key, text in texts.items():
        if key not in known:
            raise BadInput(f"{key!r} is no value of {name} that has a slider")
        try:
            values[key] = float(text)
        except ValueError:
            raise BadInput(f"{key} = {text!r} is not a number") from None
        if not math.isfinite(values[key]):
            raise BadInput(f"{key} = {text!r} is not finite")
    return values


def _from_zero(data: Record, unit: str) -> float:
    """How far the slider of a zero among the values of a section goes [`unit`]."""
    alike = [getattr(data, f.name) for f in dataclasses.fields(data) if f.metadata.get("unit") == unit]
    return _FROM_ZERO.get(unit) or max((abs(v) for v in alike if isinstance(v, (int, float))), default=0.0) or 1.0


def _slider(case: Case, key: str, field: Field, value: float, reach: float) -> Slider:
    """The slider of a value, as far as a reach in its unit on the side away from zero [unit of the key]."""
    meta = field.metadata
    low, high = sorted((value / REACH, math.copysign(reach, value))) if value else (-reach, reach)
    low = max(x for x in (low, meta.get("low"), meta.get("above")) if x is not None)
    high = min(x for x in (high, meta.get("high"), meta.get("below")) if x is not None)
    whole = value == round(value) and meta["unit"] == "-" and not _accepted(case, key, value + 0.5)
    if whole:
        low, high = float(math.ceil(low)), float(math.floor(high))
    low, high = _reached(case, key, value, low, whole), _reached(case, key, value, high, whole)
    step = 1.0 if whole else (high - low) / _STEPS or 1e-9
    name, about = field.name, str(meta.get("about", "")).partition(";")[0].partition(":")[0]
    symbol = f"{about}, {name}" if len(name) <= _SYMBOL and "_" not in name else about
    label = symbol if about else key_words(name)
    return Slider(key=key, label=label, about=meta.get("about", ""), unit=meta["unit"], value=value, low=low,
                  high=high, step=step)  # fmt: skip


def _reached(case: Case, key: str, value: float, end: float, whole: bool) -> float:
    """The value nearest to an end that the case accepts, by halving the way."""
    for _ in range(_HALVINGS):
        if _accepted(case, key, end):
            return end
        end = value + (end - value) / 2
        if whole:
            end = float(round(end))
    return value


def _accepted(case: Case, key: str, value: float) -> bool:
    try:
        cases.load(case.path, {**case.overrides, key: value})
    except BadInput:
        return False
    return True

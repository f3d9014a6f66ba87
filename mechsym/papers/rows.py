"""A row of a reproduction: what a source prints beside what the computation gives."""

import functools
import json
import math
import re
import tomllib
from collections.abc import Sequence
from importlib import resources
from pathlib import Path
from typing import Any

from mechsym.files import Json, to_json, write_text
from mechsym.quantities import choice, record
from mechsym.quantities.results import part, quantity, result, tell
from mechsym.quantities.units import Pure

REPRODUCED, SLIP = "reproduced", "reproduced with the source's slip"
NOT_REPRODUCED, NOT_COMPUTABLE = "not reproduced", "not computable"
# follows from other printed numbers without any model: it checks the source's arithmetic and nothing else
ARITHMETIC = "arithmetic of the source"
VERDICTS = (REPRODUCED, SLIP, NOT_REPRODUCED, NOT_COMPUTABLE, ARITHMETIC)
# `printed` keeps the digits and the words of the source, `published` is its number
KEYS = ("source", "item", "published", "computed", "rel_error", "verdict", "note", "printed", "unit")
_UNIT = re.compile(r"\[(.+?)\]")


@result
class OtherModels:
    """What further models give; null where they do not differ."""

    unit: str  #: Of the print
    converged: float | None = quantity("@unit")  #: The source's model with steps as small as it takes
    corrected: float | None = quantity("@unit")  #: Without the source's slips


@result
class ReproducedNumber:
    """What `mechsym reproduce` tells of a number or a claim."""

    source: str = part()
    item: str = part()
    published: float | None = quantity("@unit")  #: As printed; null where words or nothing stand there
    computed: float | None = quantity("@unit")  #: What the models here give
    rel_error: float | None = quantity("-")  #: Of what is computed, beside the print
    verdict: str = part()
    note: str = part()
    models: OtherModels | None = part(inline=True, optional=True)
    printed: str | None = part()
    unit: str = part()
    tolerance: float = quantity("-")  #: Of a comparison with the record, relative


@record
class Row:
    """A number or a claim of a source beside what the computation gives."""

    item: str  #: What it is, with its place in the source and the unit
    published: str | None  #: As printed: a number or words; None where the source gives no value
    computed: float | None  #: In the unit of the print; None where nothing can be computed [-]
    verdict: str = choice(*VERDICTS)
    note: str = ""  #: What is missing, which slip, how far off
    models: OtherModels | None = None  #: What further models give, where they are run

    @property
    def unit(self) -> str:
        """Of the print, as it stands in brackets behind what it is; `-` where it is a pure number."""
        bracket = _UNIT.search(self.item)
        return bracket[1] if bracket else "-"

    @property
    def corrected(self) -> float | None:
        """What the model without the source's slips gives; None where it does not differ [unit of the print]."""
        return None if self.models is None else self.models.corrected

    def told(self, source: str, tolerance: Pure = 0.0) -> Json:
        """The documented keys: no published for words, no rel_error where one is no number or the print is 0."""
        value = number(self.published)
        error = self.computed / value - 1 if self.computed is not None and value else None
        return tell(ReproducedNumber(
            source=source, item=self.item, published=value, computed=self.computed, rel_error=error,
            verdict=self.verdict, note=self.note, models=self.models, printed=self.published, unit=self.unit,
            tolerance=tolerance,
        ))  # fmt: skip


def row(item: str, published: str | None, computed: float | None, verdict: str, note: str = "") -> Row:
    """One row; `computed` stands in the unit of the print [-]."""
    value = None if computed is None else float(computed)
    return Row(item=item, published=published, computed=value, verdict=verdict, note=note)


def claim(item: str, published: str, computed: float | None, holds: bool, note: str = "") -> Row:
    """A row of a sentence that holds or not; `computed` is what decides it [-]."""
    return row(item, published, computed, REPRODUCED if holds else NOT_REPRODUCED, note)


@functools.cache
def _texts(paper: str) -> dict[str, dict[str, str]]:
    return tomllib.loads((resources.files(f"mechsym.papers.{paper}") / "numbers.toml").read_text(encoding="utf-8"))


def listed(paper: str, name: str, computed: float | None, verdict: str | bool, /, **numbers: object) -> Row:
    """A row of a paper's `numbers.toml`: what it is, as printed, and a note, with the numbers that they name.

    computed: in the unit of the print [-]. verdict: one of `VERDICTS`; of a sentence, whether it holds.
    """
    item, published, note = (_texts(paper)[name].get(key) for key in ("item", "published", "note"))
    item, note = ((text or "").format_map(numbers) for text in (item, note))
    if isinstance(verdict, str):
        return row(item, published, computed, verdict, note)
    return claim(item, published or "", computed, verdict, note)


def number(text: str | None) -> float | None:
    """The value of a printed text; None for words [-]."""
    try:
        return None if text is None else float(text)
    except ValueError:
        return None


def last_digit(text: str) -> float:
    """Value of one unit in the last printed digit: 0.001 for `9.188` [-]."""
    mantissa, _, exponent = text.lower().partition("e")
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def by_digits(published: str, computed: float) -> str:
    """Verdict on a number by its printed digits alone: `reproduced` when rounding gives the print [-]."""
    return REPRODUCED if abs(computed - float(published)) <= 0.5 * last_digit(published) else NOT_REPRODUCED


_LEAST = 1e-9  # what rounding leaves where a number should be 0 [unit of the number]


def stored(package: str) -> list[Json]:
    """The findings recorded beside a package; empty when there is no record yet."""
    file = resources.files(package) / "findings.json"
    return json.loads(file.read_text(encoding="utf-8")) if file.is_file() else []


def write(package: str, rows: Sequence[Json], keys: Sequence[str]) -> Path:
    """Record findings."""
    path = Path(str(resources.files(package) / "findings.json"))
    return write_text(path, to_json([{k: row[k] for k in keys} for row in rows]) + "\n")


def differences(package: str, rows: Sequence[Json], name: Sequence[str], compared: Sequence[str]) -> list[str]:
    """How findings differ from the recorded ones of the same sources.

    name: keys that name a finding; one of them is `source`; compared: keys whose values must not change; numbers may by
    the recorded `tolerance` of their finding, relative and as small as 1e-9 in any unit, since the last digits belong
    to the processor.
    """
    sources = {row["source"] for row in rows}
    before = {tuple(str(r[k]) for k in name): r for r in stored(package) if r["source"] in sources}
    now = {tuple(str(r[k]) for k in name): r for r in rows}
    lines = [f"{' '.join(key)} is not recorded" for key in now if key not in before]
    lines += [f"{' '.join(key)} is recorded but was not found" for key in before if key not in now]
    for key in now.keys() & before.keys():
        for k in compared:
            value, old = now[key][k], before[key].get(k)
            if _differs(value, old, before[key].get("tolerance", 0.0)):
                lines.append(f"{' '.join(key)}: {k} {value!r}, recorded {old!r}")
    return sorted(lines)


def _differs(now: Any, before: Any, tolerance: float) -> bool:
    numbers = all(isinstance(v, int | float) and not isinstance(v, bool) for v in (now, before))
    if not numbers or not tolerance:
        return bool(now != before)
    return not math.isclose(now, before, rel_tol=tolerance, abs_tol=_LEAST)

"""A row of a reproduction: what a source prints beside what the computation gives."""

import re

from mechsym.files import Json
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

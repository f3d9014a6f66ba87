"""What sizing an engine gave: sizes, checks and headline figures as the rows that people and files see."""

import dataclasses
import functools
from typing import Any

from mechsym.files import Json
from mechsym.page import Shown
from mechsym.quantities import record, results
from mechsym.quantities.records import Record
from mechsym.quantities.results import part, result, tell
from mechsym.sizing.checks import Check, holds
from mechsym.sizing.hypocycloid.engine import Stock


@result
class SizeRow:
    """A size, a figure or a check of a sizing."""

    component: str = part()
    quantity: str = part()
    value: float = results.quantity("@unit")  #: Of the size, or of what is checked
    unit: str = part()
    limit: float | None = results.quantity("@unit", default=None)  #: Of a check
    safety_factor: float | None = results.quantity("-", default=None)  #: Of a check: how far it is from its limit
    rule: str = part()
    source: str = part()
    wanted: float | None = results.quantity("-", default=None)  #: Safety factor that is asked for
    holds: bool | None = part(default=None)  #: Whether a check has the factor that is wanted
    note: str = part()


COLUMNS = tuple(field.name for field in dataclasses.fields(SizeRow))


def fact(
    component: str, quantity: str, value: float, unit: str, rule: str, source: str = "", note: str = ""
) -> SizeRow:
    """A row for a figure that no limit belongs to. value: the figure [unit]."""
    return SizeRow(
        component=component, quantity=quantity, value=float(value), unit=unit, rule=rule, source=source, note=note
    )


def size_rows(component: str, sized: Record, rule: str) -> list[SizeRow]:
    """One row for each size of a part."""
    return [
        fact(component, field.metadata["about"] or field.name, getattr(sized, field.name), field.metadata["unit"], rule)
        for field in dataclasses.fields(sized)
        if "unit" in field.metadata
    ]


def check_rows(checks: list[Check]) -> list[SizeRow]:
    """One row for each check."""
    names = [name for name in COLUMNS if name != "holds"]
    return [SizeRow(**{name: getattr(check, name) for name in names}, holds=holds(check)) for check in checks]


@record
class Sizing(Shown):
    """What sizing an engine gave."""

    told: list[SizeRow]
    failing: list[Check]
    converged: bool
    rounds: int
    parts: Any
    forces: Any
    stock: Stock | None  #: None where no stock part belongs to it

    @functools.cached_property
    def rows(self) -> list[Json]:
        """The rows as JSON shows them."""
        return [tell(row) for row in self.told]

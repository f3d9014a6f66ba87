"""What sizing an engine gave: sizes, checks and headline figures as the rows that people and files see."""

import dataclasses
import functools
from typing import Any

from mechsym.files import Json
from mechsym.page import Card, Finding, Picture, Shown, View, shows
from mechsym.page.finding import NOT_MET
from mechsym.quantities import record, results
from mechsym.quantities.display import figure, key_words
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

    checked: list[SizeRow]
    failing: list[Check]
    converged: bool
    rounds: int
    parts: Any
    forces: Any
    stock: Stock | None  #: None where no stock part belongs to it

    @functools.cached_property
    def rows(self) -> list[Json]:
        """The rows as JSON shows them."""
        return [tell(row) for row in self.checked]


@shows(Sizing)
def sizing_view(sizing: Sizing) -> View:
    """Whether every factor holds, and the tightest checks."""
    checks = [row for row in sizing.rows if row["limit"] is not None and row["safety_factor"] is not None]
    state = f"{len(sizing.failing)} of {len(checks)} too low" if sizing.failing else "all hold"
    about = f"{len(checks)} checks; masses and loads {'agree' if sizing.converged else 'do NOT agree'}"
    cards = [Card(name="safety factors", value=state, about=about, mark="no" if sizing.failing else "yes")]
    if not checks and not sizing.failing:
        cards = [Card(name="sizes", value="loads only", about="no rule sizes its parts")]
    for row in tightest(sizing)[:3]:
        wanted = f"factor; wanted {figure(row['wanted'])}"
        cards.append(Card(name=f"{key_words(row['component'])}, {row['quantity']}", about=wanted,
                          value=figure(row["safety_factor"], 4), mark="" if row["holds"] else "no"))  # fmt: skip
    drawn: tuple[Picture, ...] = ()
    if sizing.stock is not None:
        see = "Section to scale at top dead centre: the sizes of the tables, and whether they fit."
        drawn = (Picture(name="section", see=see, draw=lambda: _section(sizing)),)
    return View(title="Sizes and safety factors", cards=tuple(cards), pictures=drawn,
                columns=lambda: {name: [row[name] for row in sizing.rows] for name in COLUMNS},
                findings=lambda: _too_low(sizing))  # fmt: skip


def _too_low(sizing: Sizing) -> list[Finding]:
    """Each check that does not hold."""
    factors = (
        (row, f"factor {figure(row.safety_factor, 3)}, wanted {figure(row.wanted, 3)}") for row in sizing.failing
    )
    return [
        Finding(rank=NOT_MET, words=f"{key_words(row.component)}, {row.quantity}: {said}", value=row.safety_factor)
        for row, said in factors
    ]


def tightest(sizing: Sizing) -> list[Json]:
    """Checks with a factor, the least beside the wanted one first."""
    rows = [row for row in sizing.rows if row["limit"] and row["safety_factor"] is not None and row["wanted"]]
    return sorted(rows, key=lambda row: float(row["safety_factor"] / row["wanted"]))


def _section(sizing: Sizing) -> Any:
    from mechsym.sizing.drawing import section

    return section(sizing.parts, sizing.forces, sizing.stock)  # type: ignore[arg-type]

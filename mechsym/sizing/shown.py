"""What of the sizes of an engine is worth seeing."""

from typing import Any

from mechsym.files import Json
from mechsym.page import Card, Finding, Picture, View, shows
from mechsym.page.finding import NOT_MET
from mechsym.quantities.display import figure, key_words
from mechsym.sizing.rows import COLUMNS, Sizing


@shows(Sizing)
def sizing_view(found: Sizing) -> View:
    """Whether every factor holds, and the tightest checks."""
    checks = [row for row in found.rows if row["limit"] is not None and row["safety_factor"] is not None]
    state = f"{len(found.failing)} of {len(checks)} too low" if found.failing else "all hold"
    about = f"{len(checks)} checks; masses and loads {'agree' if found.converged else 'do NOT agree'}"
    cards = [Card(name="safety factors", value=state, about=about, mark="no" if found.failing else "yes")]
    if not checks and not found.failing:
        cards = [Card(name="sizes", value="loads only", about="no rule sizes its parts")]
    for row in tightest(found)[:3]:
        wanted = f"factor; wanted {figure(row['wanted'])}"
        cards.append(Card(name=f"{key_words(row['component'])}, {row['quantity']}", about=wanted,
                          value=figure(row["safety_factor"], 4), mark="" if row["holds"] else "no"))  # fmt: skip
    drawn: tuple[Picture, ...] = ()
    if found.stock is not None:
        see = "Section to scale at top dead centre: the sizes of the tables, and whether they fit."
        drawn = (Picture(name="section", see=see, draw=lambda: _section(found)),)
    return View(title="Sizes and safety factors", cards=tuple(cards), pictures=drawn,
                columns=lambda: {name: [row[name] for row in found.rows] for name in COLUMNS},
                findings=lambda: _too_low(found))  # fmt: skip


def _too_low(found: Sizing) -> list[Finding]:
    """Each check that does not hold."""
    factors = ((row, f"factor {figure(row.safety_factor, 3)}, wanted {figure(row.wanted, 3)}") for row in found.failing)
    return [
        Finding(rank=NOT_MET, words=f"{key_words(row.component)}, {row.quantity}: {said}", value=row.safety_factor)
        for row, said in factors
    ]


def tightest(found: Sizing) -> list[Json]:
    """Checks with a factor, the least beside the wanted one first."""
    rows = [row for row in found.rows if row["limit"] and row["safety_factor"] is not None and row["wanted"]]
    return sorted(rows, key=lambda row: float(row["safety_factor"] / row["wanted"]))


def _section(found: Sizing) -> Any:
    from mechsym.sizing.drawing import section

    return section(found.parts, found.forces, found.stock)  # type: ignore[arg-type]

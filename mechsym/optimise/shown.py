"""What of a best design is worth seeing."""

from mechsym.optimise.result import Optimised
from mechsym.page import Card, View, shows
from mechsym.quantities.display import quantity_text
from mechsym.quantities.results import Columns


@shows(Optimised)
def optimised_view(found: Optimised) -> View:
    """The best design and what stops it from being better."""
    best = found.best
    cards = [
        Card(name="optimum", value=best.status, about=best.reason, mark="yes" if best.status == "optimal" else "no")
    ]
    cards += [Card(name="objective", value=quantity_text(best.objective, best.unit), about=found.objective_name)]
    cards += [Card(name=name, value=quantity_text(value, best.variables.units[name]))
              for name, value in best.variables.items()]  # fmt: skip
    cards += [Card(name=f"limit {row.name}", value=f"{row.side} {quantity_text(row.limit, row.unit)}",
                   about=row.meaning) for row in best.active]  # fmt: skip
    points, units = found.front or (best,), {**best.variables.units, "objective": best.unit, "status": ""}
    return View(title="Best design", cards=tuple(cards), columns=lambda: Columns({
        **{name: [p.variables[name] for p in points] for name in best.variables},
        "objective": [p.objective for p in points], "status": [p.status for p in points]}, units))  # fmt: skip

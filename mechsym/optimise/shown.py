"""What of a best design is worth seeing, and of an identification: the trace and what is left over."""

from pathlib import Path

from mechsym.optimise.identify import Identified
from mechsym.optimise.solver import Optimised
from mechsym.page import Card, View, shows
from mechsym.quantities.display import SMALLEST, key_words, quantity_text
from mechsym.quantities.results import Columns
from mechsym.style import BLUE, INK, QUIET, RED, axis_unit, legend, panels, write_picture

SIDES = {"low": "at least", "high": "at most", "equal": "equal to"}  #: Of a limit


@shows(Optimised)
def optimised_view(result: Optimised) -> View:
    """The best design and what stops it from being better."""
    best = result.best
    cards = [
        Card(name="optimum", value=best.status, about=best.reason, mark="yes" if best.status == "optimal" else "no")
    ]
    cards += [
        Card(name="objective", value=quantity_text(best.objective, best.unit), about=key_words(result.objective_name))
    ]
    cards += [Card(name=key_words(name), value=quantity_text(value, best.variables.units[name]))
              for name, value in best.variables.items()]  # fmt: skip
    for row in best.active:
        limit = f"{SIDES[row.side]} {quantity_text(row.limit, row.unit)}"
        cards.append(Card(name=f"limit: {key_words(row.name)}", value=limit, about=row.meaning))
    points, units = result.front or (best,), {**best.variables.units, "objective": best.unit, "status": ""}
    return View(title="Best design", cards=tuple(cards), columns=lambda: Columns({
        **{name: [p.variables[name] for p in points] for name in best.variables},
        "objective": [p.objective for p in points], "status": [p.status for p in points]}, units))  # fmt: skip


def trace_picture(path: Path, result: Identified) -> Path:
    """Speeds measured and fitted, and their difference, over time."""
    figure, axes = panels(9, 3.6, 1, 2, "Measured speeds and the model through them, and what is left over")
    factor, unit = axis_unit(result.unit, *result.measured.values())
    for (name, measured), color in zip(result.measured.items(), (BLUE, RED, INK), strict=False):
        of = name.removesuffix("d") + " " if len(result.measured) > 1 else ""
        axes[0].plot(result.t, measured * factor, ".", ms=2, color=color, alpha=0.4, label=f"{of}measured")
        axes[0].plot(result.t, result.fitted[name] * factor, color=color, lw=0.8, label=f"{of}fitted")
        axes[1].plot(
            result.t, (measured - result.fitted[name]) * factor, ".", ms=2, color=color, label=of.strip() or None
        )
    largest = max(float(abs(values).max()) for values in result.measured.values())
    if result.noise < SMALLEST * largest:  # round-off is no picture
        axes[1].clear()
        axes[1].set_xlim(axes[0].get_xlim())
        axes[1].set_yticks([])
        axes[1].text(0.5, 0.5, "0 to round-off", transform=axes[1].transAxes, ha="center", color=QUIET)
    axes[0].set(xlabel="time [s]", ylabel=f"speed [{unit}]")
    axes[1].set(xlabel="time [s]", ylabel=f"measured less fitted [{unit}]")
    for axis in axes:
        legend(axis)
    return write_picture(path, figure)

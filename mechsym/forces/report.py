"""Files of a force analysis: one HTML page that opens offline, tables, summary, pictures."""

from pathlib import Path
from typing import Any

from mechsym.files import to_json, write_quantities, write_text
from mechsym.forces import plots as plots_forces
from mechsym.forces.result import Forces
from mechsym.forces.summary import quantities
from mechsym.mechanisms import plots as plots_mechanism
from mechsym.style import page, svg


def write(found: Forces, numbers: dict[str, Any], folder: Path, about: str, source: str) -> list[Path]:
    """Write page, tables, summary and pictures.

    Parameters
    ----------
    folder : Path
        Where to write; made when missing
    about, source : str
        What the page says of the machine, and where its data come from
    """
    drive, figures = found.turn.drive, _figures(found)
    turning = plots_mechanism.animation(drive.name, drive.parameters, about)
    files = [
        write_text(folder / "report.html", html(numbers, figures, about, source)),
        write_quantities(folder / "forces.csv", found.columns),
        write_text(folder / "summary.json", to_json(numbers) + "\n"),
        write_text(folder / "mechanism.html", turning),
    ]
    if found.comparison is not None:
        files.append(write_quantities(folder / "comparison.csv", _table(found.comparison)))
    return files + [write_text(folder / f"{name}.svg", text) for name, text in figures.items()]


def html(numbers: dict[str, Any], figures: dict[str, str], about: str, source: str) -> str:
    """The page as text."""
    shown = quantities(numbers)
    return page("forces.html", numbers=numbers, figures=figures, about=about, source=source, shown=shown)


def _figures(found: Forces) -> dict[str, str]:
    drive = found.turn.drive
    figures = {
        "forces": plots_forces.chain(found),
        "polar": plots_forces.polar_diagrams(found),
        "orders": plots_forces.orders(found),
        "mechanism": plots_mechanism.figure(drive.name, drive.parameters, 0.8),
    }
    if found.losses is not None:
        figures["friction"] = plots_forces.friction(found)
    if found.comparison is not None:
        figures["comparison"] = plots_forces.comparison(found.comparison)
    return {name: svg(figure) for name, figure in figures.items()}


def _table(rows: list[dict[str, Any]]) -> dict[str, Any]:
    names = [k for k, v in rows[0].items() if not isinstance(v, dict)]
    return {k: ["" if row[k] is None else row[k] for row in rows] for k in names}

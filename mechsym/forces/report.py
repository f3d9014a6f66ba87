"""Files of a force analysis: one HTML page that opens offline, tables, summary, pictures."""

from pathlib import Path
from typing import Any

from mechsym.files import to_json, write_quantities, write_text
from mechsym.forces.borne import borne
from mechsym.forces.result import Forces
from mechsym.mechanisms import plots as plots_mechanism
from mechsym.page import page
from mechsym.style import svg


def write(found: Forces, numbers: dict[str, Any], folder: Path, about: str) -> list[Path]:
    """Write page, tables, summary and pictures.

    Parameters
    ----------
    folder : Path
        Where to write; made when missing
    about : str
        What the page says of the machine
    """
    drive, figures = found.turn.drive, _figures(found)
    turning = plots_mechanism.animation(drive.name, drive.parameters, about, _bore(found))
    files = [
        write_text(folder / "report.html", html(found, numbers, figures, about)),
        write_quantities(folder / "forces.csv", found.columns),
        write_text(folder / "summary.json", to_json(numbers) + "\n"),
        write_text(folder / "mechanism.html", turning),
    ]
    if found.comparison is not None:
        files.append(write_quantities(folder / "comparison.csv", _table(found.comparison)))
    return files + [write_text(folder / f"{name}.svg", text) for name, text in figures.items()]


def html(found: Forces, numbers: dict[str, Any], figures: dict[str, str], about: str) -> str:
    """The page as text."""
    rows = [row | {"at": numbers["angle_of_max_deg"][row["name"]]} for row in borne(numbers)]
    largest = max(abs(value) for value in numbers["max"].values())
    return page(
        "forces.html", numbers=numbers, figures=figures, about=about, see=_see(found), rows=rows,
        cards=found.view.cards, several=any(row["of"] for row in rows), largest=largest,
        heaviest=largest / found.turn.omega**2,
    )  # fmt: skip


def _see(found: Forces) -> dict[str, str]:
    return {picture.name: picture.see for picture in found.view.pictures}


def _bore(found: Forces) -> float | None:
    return None if found.turn.gas is None else float(found.turn.gas.chamber.bore)


def _figures(found: Forces) -> dict[str, str]:
    drive = found.turn.drive
    drawn = {picture.name: picture.draw() for picture in found.view.pictures}
    drawn["mechanism"] = plots_mechanism.figure(drive.name, drive.parameters, 0.8, _bore(found))
    return {name: svg(figure) for name, figure in drawn.items()}


def _table(rows: list[dict[str, Any]]) -> dict[str, Any]:
    names = [k for k, v in rows[0].items() if not isinstance(v, dict)]
    return {k: ["" if row[k] is None else row[k] for row in rows] for k in names}

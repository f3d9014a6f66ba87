"""The report of a hinge design: one HTML file that opens offline, with equations, figures and a moving picture."""

import dataclasses
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from mechsym.files import to_json, write_quantities, write_text
from mechsym.hinge.moving import readouts, scenes
from mechsym.hinge.result import Design
from mechsym.hinge.setting import setting_text
from mechsym.hinge.shown import cards, pictures
from mechsym.hinge.summary import guide_columns, guide_turn, hinge_columns, summary
from mechsym.mechanisms.record import listing
from mechsym.mechanisms.turning import rules
from mechsym.page import page
from mechsym.style import svg


def write(design: Design, folder: Path) -> list[Path]:
    """Write report, tables, summary and pictures of a design.

    Parameters
    ----------
    folder : Path
        Where to write; made when missing
    """
    numbers = summary(design)
    figures = {picture.name: svg(picture.draw()) for picture in pictures(design)}
    files = [write_text(folder / "report.html", html(design, numbers, figures))]
    files.append(write_text(folder / "summary.json", to_json(numbers) + "\n"))
    files.append(write_quantities(folder / "hinge.csv", hinge_columns(design)))
    if design.guide.rho is not None:
        files.append(write_quantities(folder / "guide.csv", guide_columns(design, guide_turn(design, 3601))))
    return files + [write_text(folder / f"{name}.svg", text) for name, text in figures.items()]


def html(design: Design, numbers: dict[str, Any], figures: dict[str, str]) -> str:
    """The report as text."""
    return page(
        "hinge.html",
        case=design.origin,
        design=design,
        numbers=numbers,
        cards=cards(design, numbers),
        figures=figures,
        see={picture.name: picture.see for picture in pictures(design)},
        setting=partial(setting_text, design.guide.spring),
        parameters=_parameters(design),
        equations=listing(design.machine.mechanism.name)["equations"],
        scenes=scenes(design),
        readouts=readouts(design),
        rules=rules(),
        degrees=180 / np.pi,
    )


def _parameters(design: Design) -> list[tuple[str, str, str, float]]:
    rows = []
    for section, record in design.origin.sections.items():
        for field in dataclasses.fields(record):
            value = getattr(record, field.name)
            if "unit" in field.metadata and isinstance(value, float):
                rows.append((f"{section}.{field.name}", field.metadata["about"], field.metadata["unit"], value))
    return rows

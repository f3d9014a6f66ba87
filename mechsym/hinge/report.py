"""The report of a hinge design: one HTML file that opens offline, with equations, figures and a moving picture."""

import dataclasses
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from mechsym.files import to_json, write_quantities, write_text
from mechsym.hinge.guide import setting_text
from mechsym.hinge.result import Design
from mechsym.hinge.shown import cards, of_design, pictures, readouts, scenes
from mechsym.hinge.summary import HingeNumbers, guide_columns, guide_turn, hinge_columns
from mechsym.mechanisms.record import listing
from mechsym.mechanisms.turning import rules
from mechsym.page import page, ranked, title_mark
from mechsym.quantities.results import tell
from mechsym.style import svg


def write(design: Design, folder: Path, finish: Callable[[str], str] = str) -> list[Path]:
    """Write report, tables, summary and pictures into a folder. finish: makes the text that is written of it."""
    numbers, columns = HingeNumbers(judged=design), hinge_columns(design)
    figures = {picture.name: svg(picture.draw()) for picture in pictures(design)}
    files = [write_text(folder / "report.html", finish(html(design, numbers, figures)))]
    files.append(write_text(folder / "summary.json", to_json(tell(numbers)) + "\n"))
    files.append(write_quantities(folder / "hinge.csv", columns, columns.units))
    if design.guide.rho is not None:
        columns = guide_columns(design, guide_turn(design, 3601))
        files.append(write_quantities(folder / "guide.csv", columns, columns.units))
    return files + [write_text(folder / f"{name}.svg", text) for name, text in figures.items()]


def html(design: Design, numbers: HingeNumbers, figures: dict[str, str]) -> str:
    """The report as text."""
    findings = ranked(of_design(design))
    return page(
        "hinge.html",
        case=design.origin,
        design=design,
        numbers=numbers,
        cards=cards(design, numbers),
        findings=findings,
        mark=title_mark(findings),
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

"""The report of a hinge design: one HTML file that opens offline, with equations, figures and a moving picture."""

import dataclasses
import json
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from mechsym.files import to_json, write_quantities, write_text
from mechsym.hinge.result import Design
from mechsym.hinge.rollers import parallel
from mechsym.hinge.setting import setting_text
from mechsym.hinge.shown import cards, pictures, shapes_of
from mechsym.hinge.summary import guide_columns, guide_turn, hinge_columns, summary
from mechsym.machine.record import gas_of
from mechsym.mechanisms.plots import animation_of
from mechsym.mechanisms.record import curves, listing
from mechsym.page import page
from mechsym.style import axis_unit, svg

_FRAMES = 180


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
    if (shapes := shapes_of(design)) is not None:
        files.append(write_text(folder / "mechanism.html", animation_of(shapes, design.origin.about)))
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
        motion=json.dumps(_motion(design)) if _slider_crank(design) else None,
        degrees=180 / np.pi,
    )


def _slider_crank(design: Design) -> bool:
    """Whether the moving picture of the page, crank, rod and crosshead, is that of the mechanism."""
    return hasattr(design.origin.sections["parameters"], "r1") and "drawing" not in design.machine.mechanism.functions


def _parameters(design: Design) -> list[tuple[str, str, str, float]]:
    rows = []
    for section, record in design.origin.sections.items():
        for field in dataclasses.fields(record):
            value = getattr(record, field.name)
            if "unit" in field.metadata and isinstance(value, float):
                rows.append((f"{section}.{field.name}", field.metadata["about"], field.metadata["unit"], value))
    return rows


def _motion(design: Design) -> dict[str, Any]:
    """Positions for the moving picture, with five digits of the rod's length."""
    p = design.origin.sections["parameters"]
    r, l = p.r1 + p.r2, p.l1 + p.l2
    phi = np.linspace(0, design.hinge.period, _FRAMES, endpoint=False)
    found, digits = curves(design.machine.mechanism, phi), 5 - int(np.floor(np.log10(l)))
    factor, unit = axis_unit("N*m", design.hinge.torque_max, design.hinge.torque_min)
    bore = gas_of(design.machine).chamber.bore
    motion = {
        "torque_unit": unit, "r": r, "l": l, "bore": bore, "phi": np.round(phi, 5).tolist(),
        "crosshead": np.round(r + l - found["x"], digits).tolist(),
        "torque": np.round(design.hinge.torque(phi) * factor, 2).tolist(), "rho": [], "profile": [], "rollers": 0,
        "radius": 0.0, "ratio": 1.0,
    }  # fmt: skip
    if design.guide.rho is not None:
        turn, radius = guide_turn(design), design.rollers.radius
        x, y = parallel(turn.rho, turn.drho, turn.theta, radius)
        ratio = design.guide.parameters.shaft_ratio
        rho = np.interp(ratio * phi % (2 * np.pi), turn.theta, turn.rho)
        motion |= {
            "rho": np.round(rho, digits).tolist(), "profile": np.round(np.column_stack([x, y])[::3], digits).tolist(),
            "rollers": design.guide.rollers, "radius": radius, "ratio": ratio,
        }  # fmt: skip
    return motion

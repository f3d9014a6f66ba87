"""Files of a force analysis: one HTML page that opens offline, tables, summary, pictures."""

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from mechsym.files import Json, to_json, write_quantities, write_text
from mechsym.forces.comparison import ComparedFriction, ComparedMechanism
from mechsym.forces.moving import charged
from mechsym.forces.result import Forces, extremes
from mechsym.forces.summary import quantities
from mechsym.mechanisms import plots as plots_mechanism
from mechsym.mechanisms.drawing import Shapes, drawn
from mechsym.mechanisms.turning import rules, scene
from mechsym.page import Finding, page, title_mark
from mechsym.quantities.results import tell, units_of
from mechsym.style import svg


def write(result: Forces, numbers: Json, folder: Path, about: str, findings: Sequence[Finding] = ()) -> list[Path]:
    """Write page, tables, summary and pictures.

    folder: where to write; made when missing. about: what the page says of the machine. findings: what has to be known
    before its numbers.
    """
    shapes = drawing_of(result)
    pictures = {picture.name: picture.draw() for picture in result.view.pictures}
    scenes = []
    if shapes is not None:
        pictures["mechanism"] = plots_mechanism.figure_of(shapes, 0.8)
        scenes = [charged(scene(shapes, "the machine to scale"), result.turn.drive, result.turn.acting)]
    figures = {name: svg(figure) for name, figure in pictures.items()}
    files = [
        write_text(folder / "report.html", html(result, numbers, figures, about, findings, scenes)),
        write_quantities(folder / "forces.csv", result.columns, result.columns.units),
        write_text(folder / "summary.json", to_json(numbers) + "\n"),
    ]
    if shapes is not None:
        files.append(write_text(folder / "mechanism.html", plots_mechanism.turning_page(scenes, about)))
    if result.comparison is not None:
        rows = [tell(row) for row in result.comparison]
        names = [name for name, value in rows[0].items() if not isinstance(value, Mapping)]
        columns: dict[str, Any] = {name: ["" if row[name] is None else row[name] for row in rows] for name in names}
        units = units_of(ComparedMechanism) | units_of(ComparedFriction)
        files.append(write_quantities(folder / "comparison.csv", columns, units))
    return files + [write_text(folder / f"{name}.svg", text) for name, text in figures.items()]


def html(
    result: Forces, numbers: Json, figures: dict[str, str], about: str, findings: Sequence[Finding] = (),
    scenes: Sequence[Json] = (),
) -> str:  # fmt: skip
    """The page as text."""
    rows = [row | {"at": numbers["angle_of_max_deg"][row["name"]]} for row in borne(result)]
    see = {picture.name: picture.see for picture in result.view.pictures}
    largest = max(abs(value) for value in numbers["max"].values())
    return page(
        "forces.html", numbers=numbers, figures=figures, about=about, see=see, rows=rows,
        cards=result.view.cards, several=any(row["of"] for row in rows), largest=largest,
        heaviest=largest / result.turn.omega**2, closing=numbers.get(numbers["mechanism"]),
        findings=findings, mark=title_mark(findings), scenes=scenes, rules=rules(),
    )  # fmt: skip


def drawing_of(forces: Forces) -> Callable[[float], Shapes] | None:
    """The mechanism at a crank angle [rad]; None where nothing draws it."""
    one, gas = forces.turn.drive, forces.turn.gas
    bore = None if gas is None else float(gas.chamber.bore)
    return drawn(one.name, one.parameters, lambda: one.mechanism, bore)


# what bears a load, by how its name starts
_BEARS = {
    "p": "gas in the cylinder", "piston_pin": "piston pin, from the rod", "pin_force": "crank pin, from its load",
    "pin_and_guide": "pin and guides together", "crank_pin": "crank pin, in the crank's frame",
    "main_bearing": "main bearing, in the frame", "side_force": "guide of the piston", "F": "piston, from the gas",
    "shaft_torque": "shaft behind the throw", "torque": "load", "roll_moment": "mounts of the frame",
    "tooth": "teeth", "piston_torque": "crank, from the piston", "guide_combination": "guides together",
    "knuckle_force": "knuckle pin, from the rod that carries it",
    "journal": "journal of the planet or slider", "X_": "guide of the slider",
}  # fmt: skip
_RAW = re.compile(r"_force_[xy](_|$)")
_NUMBERED = re.compile(r"(_|^F)(\d+)(?=_|$)")


def borne(forces: Forces) -> list[Json]:
    """Rows of a name, quantity, of which cylinders or throws, max, min (SI), unit, and what bears it."""
    rows: dict[tuple[str, ...], Json] = {}
    largest, smallest = extremes(forces.columns)
    joints = forces.turn.drive.roles.joints
    gas = {one.face.input for one in forces.turn.acting}
    other = set(forces.turn.drive.mechanism.inputs) - gas  # what acts and is no gas
    for name in quantities(forces):
        number, ends = _NUMBERED.search(name), (largest[name], smallest[name])
        printed = tuple(f"{value:.6g}" for value in ends)
        # the same force under the mechanism's own name
        if _RAW.search(name) and any(key[1:] == printed and "bearing" in key[0] for key in rows):
            continue
        pattern = name if name in joints else _NUMBERED.sub(r"\1*", name)
        row = rows.setdefault((pattern, *printed), {"names": [], "of": [], "ends": ends})
        row["names"].append(name)
        row["of"] += [number[2]] if number else []
    table = []
    for (pattern, *_), row in rows.items():
        several, name, (high, low) = len(row["of"]) > 1, row["names"][0], row["ends"]
        fitting = [start for start in _BEARS if pattern.startswith(start)]
        on = _BEARS[max(fitting, key=len)] if fitting and pattern not in other else joints.get(pattern, "")
        table.append({
            "name": name, "quantity": pattern if several else name, "of": ", ".join(row["of"]) if several else "",
            "max": high, "min": low, "unit": forces.columns.units[name], "on": on,
        })  # fmt: skip
    return table

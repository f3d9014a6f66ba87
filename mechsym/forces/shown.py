"""What of a force analysis is worth seeing, its scene in motion, and its files: page, tables, pictures."""

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mechsym.files import Json, to_json, write_quantities, write_text
from mechsym.forces import plots, summary
from mechsym.forces.arrows import charged, pressed
from mechsym.forces.loads import polar
from mechsym.forces.result import ComparedFriction, ComparedMechanism, Forces, extremes
from mechsym.forces.summary import CounterweightNumbers, half, quantities
from mechsym.mechanisms import plots as plots_mechanism
from mechsym.mechanisms.drawing import Shapes, drawn
from mechsym.mechanisms.turning import rules, scene
from mechsym.page import Card, Finding, Picture, View, card, page, shows, title_mark
from mechsym.page.finding import NOT_MET
from mechsym.quantities.display import SMALLEST, figure, key_words, quantity_text, without_rounding
from mechsym.quantities.results import tell, units_of
from mechsym.style import svg

_LARGEST = (("crank pin", "crank_pin", "_load"), ("main bearing", "main_bearing", "_load"),
            ("side force on a guide", "side_force", ""), ("tooth force", "tooth_force", ""),
            ("guide of a slider", "X_", ""))  # fmt: skip


@shows(Forces)
def forces_view(forces: Forces) -> View:
    """Largest loads, friction and shaking of a turn."""
    return View(
        title=f"Forces of {forces.turn.drive.name} at {quantity_text(forces.turn.omega, 'rad/s')}",
        cards=_cards(forces),
        pictures=_pictures(forces),
        columns=lambda: forces.columns,
        findings=lambda: [
            *(Finding(rank=NOT_MET, words=reason) for reason in forces.unbalanced),
            *summary.findings(forces.turn),
        ],
    )


def _cards(forces: Forces) -> tuple[Card, ...]:
    cards, units = [], forces.columns.units
    for name, start, end in _LARGEST:
        if forces.journals and start == "main_bearing":  # the columns have what a throw leans on its neighbours with
            heaviest = max(forces.journals, key=lambda one: float(one.load.max()))
            value, place = (quantity_text(v, u, 4) for v, u in ((float(heaviest.load.max()), "N"), (heaviest.z, "m")))
            cards.append(Card(name=name, value=value, about=f"largest, at z = {place} along the shaft"))
            continue
        fitting = {k: abs(v).max() for k, v in forces.columns.items() if k.startswith(start) and k.endswith(end)}
        if fitting:
            largest = max(map(float, fitting.values()))
            most = next(k for k, v in fitting.items() if v >= (1 - 1e-6) * largest)  # the first of equal ones
            where = most.replace("_load", "").replace("_", " ")
            about = "largest" if where in name else f"largest, {where}"
            cards.append(Card(name=name, value=quantity_text(float(fitting[most]), units[most], 4), about=about))
    torque, of = forces.turn.torque, "of one piston, " if half(forces) else ""
    ends = torque.mean(), torque.min(), torque.max()
    least = 1e-12 * max(map(abs, ends))  # below it a mean is round-off
    mean, low, high = (quantity_text(float(v) if abs(v) > least else 0.0, units["torque"], 4) for v in ends)
    cards.append(Card(name="torque at the shaft", value=mean, about=f"{of}{low} to {high}"))
    if forces.losses is not None:
        share = forces.losses.mechanical_efficiency
        about = of.rstrip(", ") if share is None else f"{of}mechanical efficiency {figure(100 * share, 4)} %"
        power = quantity_text(sum(forces.losses.places.values()), "W", 4)
        cards.append(Card(name="friction", value=power, about=about))
    if forces.shaking is None:
        return tuple(cards)
    weight = forces.shaking.counterweight
    size = max((float(abs(v).max()) for k, v in forces.columns.items() if k != "phi_deg"), default=1.0)
    shaken = 0.0 if weight.rms_before < 1e-9 * size else weight.rms_before
    about = "root mean square, without a further counterweight"
    cards.append(card(CounterweightNumbers, "rms_before", shaken, about))
    return tuple(cards)


def _pictures(result: Forces) -> tuple[Picture, ...]:
    torque, orders = result.turn.torque, result.torque_orders
    span = " to ".join(quantity_text(float(v), "N*m", 4) for v in (torque.min(), torque.max()))
    off = max((float(np.abs(rod - exact).max()) for rod, exact in plots.lumped(result).values()), default=0.0)
    beside = f"; dotted and dashed, rods as two masses, {quantity_text(off, 'N', 3)} off at most" if off else ""
    most = 1 + int(np.argmax(orders.amplitude[1:]))
    swings = orders.amplitude[most] > SMALLEST * np.abs(torque).max()
    by = f"most in order {orders.order[most]:g}, by {quantity_text(float(orders.amplitude[most]), 'N*m', 4)}"
    rows = [
        Picture(name="forces", draw=lambda: plots.chain(result),
                see=f"Exact forces over the cycle; the torque is {span}{beside}."),
        Picture(name="orders", draw=lambda: plots.orders(result),
                see=f"Amplitudes by order, oscillations per turn: the torque swings {by if swings else 'in none'}."),
    ]  # fmt: skip
    if result.loads.pins and result.loads.bearings:
        sizes = {name: float(np.hypot(*both).max()) for name, both in polar(result.loads).items()}
        of_pins = {pin.name for pin in result.loads.pins}
        pin, bearing = (quantity_text(max(size for name, size in sizes.items() if (name in of_pins) == one), "N", 4)
                        for one in (True, False))  # fmt: skip
        rows.insert(1, Picture(name="polar", draw=lambda: plots.polar_diagrams(result),
                    see=f"The load of a crank pin, {pin} at most, seen from its crank, and of "
                    f"{'a throw on its bearings' if result.journals else 'a main bearing'}, {bearing}, from the frame: "
                    "where a bearing is never loaded, oil may enter."))  # fmt: skip
    if result.journals:
        rows.append(Picture(name="journals", draw=lambda: plots.journal_loads(result),
                    see="What the shaft presses on each main bearing; neighbours share a throw."))  # fmt: skip
    if result.losses is not None and any(np.abs(v).max() > 0 for v in result.losses.curves.values()):
        place, power = max(result.losses.places.items(), key=lambda one: one[1])
        see = f"Where friction takes its power: most in the {place.replace('_', ' ')}, "
        see += f"{quantity_text(power, 'W', 3)} over the turn."
        rows.append(Picture(name="friction", draw=lambda: plots.friction(result), see=see))
    if result.losses is not None and result.losses.mechanical_efficiency is not None and rows[-1].name == "friction":
        rows.append(Picture(name="brake", draw=lambda: plots.brake_bar(result),
                    see="Brake power and what friction takes add up to the net indicated power."))  # fmt: skip
    if result.comparison is not None:
        peers = result.comparison
        by_force = sorted(peers, key=lambda peer: peer.side_force_max)
        ends = [f"{quantity_text(one.side_force_max, 'N', 4)} ({key_words(one.mechanism)})"
                for one in (by_force[0], by_force[-1])]  # fmt: skip
        see = "The mechanisms at equal stroke, mass and indicator diagram: the largest force on a guide is "
        see += f"{' to '.join(ends)}."
        rows.append(Picture(name="comparison", draw=lambda: plots.comparison(peers), see=see))
    return tuple(rows)


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
        shown = charged(scene(shapes, "the machine to scale"), result.turn.drive, result.turn.acting)
        scenes = [pressed(shown, result.turn)]
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
    rows = [row | {"quantity": named(row), "at": numbers["angle_of_max_deg"][row["name"]]} for row in borne(result)]
    see = {picture.name: picture.see for picture in result.view.pictures}
    largest = max(abs(value) for value in numbers["max"].values())
    return page(
        "forces.html", numbers=numbers, figures=figures, about=about, see=see, rows=rows,
        cards=result.view.cards, several=any(row["of"] for row in rows), largest=largest,
        heaviest=largest / result.turn.omega**2, closing=numbers.get(numbers["mechanism"]),
        findings=findings, mark=title_mark(findings), scenes=scenes, rules=rules(),
        pistons=bool(result.turn.drive.roles.pistons),
    )  # fmt: skip


def drawing_of(forces: Forces) -> Callable[[float], Shapes] | None:
    """The mechanism at a crank angle [rad]; None where nothing draws it."""
    one, gas = forces.turn.drive, forces.turn.gas
    bore = None if gas is None else float(gas.chamber.bore)
    return drawn(one.name, one.parameters, lambda: one.mechanism, bore)


BESIDE_THROW = "bearings beside the throw together"
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
_LETTERS = {"p": "gas pressure p", "F": "gas force F", "F a": "gas force F_a", "F b": "gas force F_b"}
_RAW = re.compile(r"_force_[xy](_|$)")
_NUMBERED = re.compile(r"(_|^F)(\d+)(?=_|$)")


def named(row: Json) -> str:
    """A load's name as people say it; which cylinders it is of stands beside it."""
    name = row["quantity"].replace("_", " ").replace("*", "").replace("  ", " ").strip()
    return _LETTERS.get(name, name)


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
        said = pattern if several else name
        if forces.journals and pattern.startswith("main_bearing"):
            said, on = plots.as_throw(said), f"{BESIDE_THROW}, in the frame"
        said = f"force {said}" if pattern in other and said.startswith("F") else said
        table.append({
            "name": name, "quantity": said, "of": ", ".join(row["of"]) if several else "",
            "max": high, "min": low, "unit": forces.columns.units[name], "on": on,
        })  # fmt: skip
    return without_rounding(table, ("max", "min"))

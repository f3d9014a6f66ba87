"""Section view of a sized engine to scale: cylinder axis across the page, crank axes upright. matplotlib lives here."""

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from mechsym.sizing.bearing_design import Choice
from mechsym.sizing.hypocycloid.engine import PartForces, Parts, Stock, chosen, shaft_length, spans
from mechsym.sizing.rules.bearings import Bearing
from mechsym.sizing.slider_crank import SliderForces, SliderParts
from mechsym.sizing.wants import CrankPart
from mechsym.style import INK, PAPER, RED, axis_unit, legend, panels, write_picture
from mechsym.style.panels import BEARING, CARRIER, CRANK, CYLINDER, GEAR, PISTON, SHAFT

_COLOURS = {"piston and rod": PISTON, "cylinder": CYLINDER, "crankshaft": CRANK, "gears": GEAR, "bearings": BEARING,
            "carrier": CARRIER, "output shaft": SHAFT, "bore": PAPER}  # fmt: skip
_CAP_WALL = 4e-3  # of the rod's cap, for the picture [m]

Box = tuple[float, float, float, float, str]  # x from, x to, y from, y to, colour key


def section_view(path: Path, parts: Parts | SliderParts, forces: PartForces | SliderForces, stock: Stock) -> Path:
    """Draw both cranks and the cylinder at top dead centre, into a file."""
    return write_picture(path, section(parts, forces, stock))


def section(parts: Parts | SliderParts, forces: PartForces | SliderForces, stock: Stock) -> Figure:
    """Both cranks and the cylinder at top dead centre."""
    if isinstance(parts, Parts) and isinstance(forces, PartForces):
        boxes, labels = hypocycloid_boxes(parts, forces, stock)
    else:
        boxes, labels = slider_crank_boxes(parts, forces)  # type: ignore[arg-type]
    figure, (axes,) = panels(9, 5.5, title="Section of the engine at top dead centre, to scale")
    for box in boxes:
        for sign in (-1, 1):
            _draw(axes, box, sign)
    for name, colour in _COLOURS.items():
        if name != "bore" and any(box[4] == name for box in boxes):
            axes.add_patch(Rectangle((0, 0), 0, 0, facecolor=colour, edgecolor=INK, label=name))
    legend(axes)
    factor, unit = axis_unit("m", 1.0)
    for x, y, text in labels:
        axes.annotate(text, (x * factor, y * factor), ha="center", va="center", fontsize=7, color=INK)
    axes.axhline(0, color=RED, linewidth=0.6, linestyle="-.")
    x = factor * max(max(abs(b[0]), abs(b[1])) for b in boxes)
    y = factor * max(max(abs(b[2]), abs(b[3])) for b in boxes)
    axes.set_aspect("equal")
    axes.set_xlim(-1.03 * x, 1.03 * x)
    axes.set_ylim(-1.05 * y, 1.05 * y)
    axes.set_xlabel(f"along the cylinder axis [{unit}]")
    axes.set_ylabel(f"along the crank axes [{unit}]")
    return figure


def hypocycloid_boxes(
    parts: Parts, forces: PartForces, stock: Stock
) -> tuple[list[Box], list[tuple[float, float, str]]]:
    """Rectangles of the right half of the engine, crank at top dead centre, and labels.

    Returns boxes: x from, x to, y from, y to [m], colour key; the drawing mirrors them in x. labels: x, y [m], text.
    """
    places, z, e = chosen(parts.bearings, stock), spans(parts, stock), forces.e
    rod = places["rod"].bearing
    pin = forces.gap / 2 + parts.piston.head + parts.piston.rod_length + rod.outside / 2
    planet, axis = pin + e, pin + 2 * e
    crank, gears = parts.crank, parts.gears
    pitch = gears.module * gears.teeth_pinion
    end = crank.pin_length / 2 + crank.web + shaft_length(parts, stock)
    boxes = [*_cylinder_boxes(parts, forces), *_piston_boxes(parts, forces, rod, pin)]
    half, disc = places["main"].bearing.bore / 2, e + places["outer"].bearing.outside / 2 + 3e-3
    width = max(places["main"].bearing.width, places["inner"].stack)
    for side in (1, -1):
        boxes += [
            _across(axis - half, axis + half, z.inner - width / 2, width, side, "carrier"),
            _across(axis - disc, axis + disc, z.gear + gears.face / 2, end + 5e-3 - z.gear - gears.face / 2, side,
                    "carrier"),
            _across(pin - crank.pin / 2, planet + crank.shaft / 2, crank.pin_length / 2, crank.web, side, "crankshaft"),
            _across(planet - crank.shaft / 2, planet + crank.shaft / 2, crank.pin_length / 2 + crank.web,
                    z.inner * 2 - crank.pin_length - 2 * crank.web, side, "crankshaft"),
            _across(planet - gears.pinion_bore / 2, planet + gears.pinion_bore / 2,
                    2 * z.inner - crank.pin_length / 2 - crank.web,
                    end - 2 * z.inner + crank.pin_length / 2 + crank.web, side, "crankshaft"),
            *_ring((planet, z.gear), (gears.pinion_bore / 2, pitch / 2), gears.face, side, "gears"),
            *_ring((axis, z.gear), (pitch, gears.ring_outside / 2), gears.face, side, "gears"),
            *_bearing(planet, places["inner"], crank.shaft / 2, z.inner, side),
            *_bearing(planet, places["outer"], gears.pinion_bore / 2, z.outer, side),
            *_bearing(axis, places["main"], places["main"].bearing.bore / 2, z.inner, side),
            *_bearing(axis, places["outboard"], places["outboard"].bearing.bore / 2, z.outboard, side),
            _across(axis - crank.output / 2, axis + crank.output / 2, end, z.outboard - end + 0.02, side,
                    "output shaft"),
        ]  # fmt: skip
    boxes += _pin_boxes(crank, pin)
    text = f"{gears.teeth_pinion:.0f}/{gears.teeth_ring:.0f} teeth"
    labels = [
        (pin, 0.0, "crankpin"),
        (planet, z.gear, text),
        (forces.gap / 2 + 0.05, 0.0, "rod"),
        (axis + 0.042, z.inner, places["main"].bearing.designation),
    ]
    return boxes, labels


def slider_crank_boxes(parts: SliderParts, forces: SliderForces) -> tuple[list[Box], list[tuple[float, float, str]]]:
    """Rectangles of the right half of a slider crank engine at top dead centre, and labels.

    forces: for crank radius, rod, bore and gap. Returns labels: x, y [m], text.
    """
    crank, rod, main = parts.crank, parts.rod_bearing.bearing, parts.main_bearing
    pin = forces.gap / 2 + parts.piston.height + forces.l
    axis = pin + forces.r
    boxes = [*_cylinder_boxes(parts, forces), *_piston_boxes(parts, forces, rod, pin)]
    start = crank.pin_length / 2 + crank.web
    for side in (1, -1):
        arm = start + 2e-3 + main.stack / 2
        boxes += [
            _across(pin - crank.pin / 2, axis + crank.shaft / 2, crank.pin_length / 2, crank.web, side, "crankshaft"),
            _across(axis - crank.shaft / 2, axis + crank.shaft / 2, start, 2 * (arm - start), side, "crankshaft"),
            *_bearing(axis, main, crank.shaft / 2, arm, side),
            _across(axis - crank.output / 2, axis + crank.output / 2, 2 * arm - start, 0.03, side, "output shaft"),
        ]
    boxes += _pin_boxes(crank, pin)
    return boxes, [(pin, 0.0, "crankpin"), (axis, start + 0.005, main.bearing.designation)]


def _cylinder_boxes(parts: Parts | SliderParts, forces: PartForces | SliderForces) -> list[Box]:
    part, inner = parts.cylinder, forces.bore / 2
    outer, half = inner + part.wall, part.length / 2
    reach = outer + 2.2e-3 * part.thread_mm  # the flange must hold a washer
    boxes = []
    for side in (1, -1):
        boxes.append(_across(0.0, half, inner, part.wall, side, "cylinder"))
        boxes.append(_across(half - part.flange, half, outer, reach - outer, side, "cylinder"))
    return boxes


def _piston_boxes(parts: Parts | SliderParts, forces: PartForces | SliderForces, rod: Bearing, pin: float) -> list[Box]:
    part, start, radius = parts.piston, forces.gap / 2, forces.bore / 2
    cap = rod.outside / 2 + _CAP_WALL
    width = parts.crank.pin_length - 2e-3
    boxes = [(start, start + part.head, -radius, radius, "piston and rod")]
    for side in (1, -1):
        boxes.append(
            _across(start + part.head, start + part.height, radius - part.barrel, part.barrel, side, "piston and rod")
        )
    boxes += [
        (start + part.head, pin - rod.outside / 2, -part.rod / 2, part.rod / 2, "piston and rod"),
        (pin - cap, pin + cap, -width / 2, width / 2, "piston and rod"),
        (pin - rod.outside / 2, pin + rod.outside / 2, -width / 2, width / 2, "bearings"),
    ]
    return boxes


def _pin_boxes(crank: CrankPart, pin: float) -> list[Box]:
    half, end = crank.pin_length / 2, crank.pin_length / 2 + crank.web
    boxes = [(pin - crank.pin / 2, pin + crank.pin / 2, -half, half, "crankshaft")]
    if crank.pin_bore > 0:
        boxes.append((pin - crank.pin_bore / 2, pin + crank.pin_bore / 2, -end, end, "bore"))
    return boxes


def _across(x_from: float, x_to: float, y_from: float, width: float, side: int, colour: str) -> Box:
    low, high = sorted((side * y_from, side * (y_from + width)))
    return x_from, x_to, low, high, colour


def _ring(place: tuple[float, float], radii: tuple[float, float], width: float, side: int, colour: str) -> list[Box]:
    (x, y), (inner, outer) = place, radii
    return [
        _across(x + sign * a, x + sign * b, y - width / 2, width, side, colour)
        for sign, a, b in ((1, inner, outer), (-1, outer, inner))
    ]


def _bearing(x: float, choice: Choice, inner: float, y: float, side: int) -> list[Box]:
    return _ring((x, y), (inner, choice.bearing.outside / 2), choice.stack, side, "bearings")


def _draw(axes: Axes, box: Box, sign: int) -> None:
    x_from, x_to, y_from, y_to, colour = box
    low, high = sorted((sign * x_from, sign * x_to))
    k, _ = axis_unit("m", 1.0)
    axes.add_patch(Rectangle((low * k, y_from * k), (high - low) * k, (y_to - y_from) * k, facecolor=_COLOURS[colour],
                             edgecolor=INK, linewidth=0.6))  # fmt: skip

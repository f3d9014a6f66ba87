"""A drawing of a mechanism painted with matplotlib, or moving in a page that opens offline."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.mechanisms import constraints, own
from mechsym.mechanisms.drawing import Circle, Line, Shapes, declared, extent_of, shapes
from mechsym.mechanisms.drawn_parts import turns_round
from mechsym.mechanisms.record import bind
from mechsym.mechanisms.turning import ordered, rules, scene
from mechsym.page import page
from mechsym.quantities.records import Record
from mechsym.quantities.units import Metre, Radian
from mechsym.style import INK, axis_unit, svg
from mechsym.style.shapes import STYLES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def _paint(axes: "Axes", drawn: Callable[[float], Shapes], angle: float) -> None:
    from matplotlib import patches

    for shape in ordered(drawn(angle)):
        color, width, fill = STYLES[shape.role]
        if isinstance(shape, Circle):
            axes.add_patch(patches.Circle(shape.centre, shape.radius, ec=color, lw=width, fc=fill))
        elif shape.points[0] == shape.points[-1]:
            axes.add_patch(patches.Polygon(shape.points[:-1], ec=color, lw=width, fc=fill))
        else:
            axes.plot(*zip(*shape.points, strict=True), color=color, lw=width, solid_capstyle="round")
    left, right, low, high = extent_of(drawn)
    pad = 0.04 * max(right - left, high - low)
    axes.set(xlim=(left - pad, right + pad), ylim=(low - pad, high + pad), aspect="equal")
    axes.set_axis_off()


_VIEWS = {"from the front: x, z": (0, 2), "from the right: y, z": (1, 2), "from above: x, y": (0, 1)}


def _view(drawn: Callable[[float], Shapes], i: int, j: int) -> Callable[[float], Shapes]:
    """A drawing in space along an axis: the coordinates i and j of its places."""

    def flat(shape: Line | Circle) -> Line | Circle:
        points = tuple((place[i], place[j]) for place in shape.space)
        if isinstance(shape, Circle):
            return replace(shape, centre=points[0], space=())
        return replace(shape, points=points, space=())

    return lambda angle: tuple(flat(shape) for shape in drawn(angle) if shape.space)


def figure(mechanism: str, parameters: Record, angle: Radian, bore: Metre | None = None) -> "Figure":
    """One drawing with a scale. bore: diameter of the cylinders."""
    return figure_of(lambda at: shapes(mechanism, parameters, at, bore), angle, standing=_standing(mechanism, angle))


def _standing(mechanism: str, value: float) -> str:
    """Where a mechanism stands, by its first coordinate [rad] or [m]."""
    name, unit = next(iter(own.load(mechanism).listing["coordinates"].items())) if own.is_file(mechanism) else ("", "")
    if unit != "m":
        return f"crank at {math.degrees(value):.0f} deg"
    factor, shown = axis_unit("m", value)
    return f"{name} = {value * factor:.4g} {shown}"


def figure_of(drawn: Callable[[float], Shapes], angle: float, title: str = "", standing: str = "") -> "Figure":
    """One drawing with a scale, at a crank angle [rad]; standing: what is written beside the scale."""
    from matplotlib.figure import Figure

    standing = standing or f"crank at {math.degrees(angle):.0f} deg"
    if any(shape.space for shape in drawn(angle)):
        picture = Figure(figsize=(7.6, 6.8), layout="constrained")
        grid = picture.subplots(2, 2)
        views = {name: _view(drawn, *axes) for name, axes in _VIEWS.items()}
        left, right, *_ = extent_of(drawn)  # whichever way it is turned: one scale for all
        for axes, (name, view) in zip(grid.flat, {**views, "turned": drawn}.items(), strict=True):
            _paint(axes, view, angle)
            x0, x1, y0, y1 = extent_of(view)
            middles, half = ((x0 + x1) / 2, (y0 + y1) / 2), 0.55 * (right - left)
            axes.set(**{f"{n}lim": (m - half, m + half) for n, m in zip("xy", middles, strict=True)})
            axes.set_title(name, fontsize=8, color=INK)
        axes, drawn = grid[0, 0], views["from the front: x, z"]
    else:
        left, right, low, high = extent_of(drawn)
        size = min(8.0 / (right - left), 6.0 / (high - low))
        inches = max(size * (right - left), 3.4), max(size * (high - low), 1.2) + 0.8
        picture = Figure(figsize=inches, layout="constrained")
        axes = picture.add_subplot()
        _paint(axes, drawn, angle)
    picture.set_label(title or f"The mechanism to scale, {standing}")
    _scale(axes, drawn, standing)
    return picture


def _scale(axes: "Axes", drawn: Callable[[float], Shapes], standing: str) -> None:
    """A length below a drawing, and where it stands."""
    left, right, low, high = extent_of(drawn)
    wide, tall = right - left, high - low
    step = 10 ** math.floor(math.log10(max(wide, tall / 4) / 3))
    length = max(k * step for k in (1, 2, 5) if k == 1 or k * step <= wide / 3)
    y, pad = low - 0.08 * max(wide, tall), 0.04 * max(wide, tall)
    axes.plot([left, left + length], [y, y], color=INK, lw=1.5, marker="|")
    axes.set_ylim(bottom=y - pad)
    factor, unit = axis_unit("m", length)
    label = f"{length * factor:.4g} {unit}, {standing}"
    axes.text(left + length + pad, y, label, va="center", fontsize=8, color=INK)


def animation(mechanism: str, parameters: Record, title: str, bore: float | None = None) -> str:
    """A page in which the mechanism turns; it needs nothing from outside; with a bore [m] to scale."""
    drawn = scene(lambda at: shapes(mechanism, parameters, at, bore), "the mechanism to scale")
    return turning_page([drawn], title)


def turning_page(scenes: Sequence[Json], title: str) -> str:
    """A page in which scenes turn."""
    return page("mechanism.html", title=title, scenes=scenes, readouts=[], rules=rules())


def assembled(name: str) -> tuple[str, str]:
    """Name and drawing (SVG) of a mechanism of a file in its pose, with the paths of what it watches if it turns round.

    Raises BadInput: a letter has no value in the file, or nothing is drawn.
    """
    said = own.load(name).listing
    sizes, pose = said.get("ranges", {}), said.get("pose", {})
    if unsaid := [p for p in said["parameters"] if "default" not in sizes.get(p, {})]:
        why = f"a drawing needs sizes, and {', '.join(unsaid)} have no value in the file"
        raise BadInput(f"{name}: {why}; give them a default=, or write the report of a case")
    mechanism = bind(name, {p: float(sizes[p]["default"]) for p in said["parameters"]})
    places = constraints.close(mechanism, pose) if mechanism.dependents else pose
    at = [float(places.get(q, 0.0)) for q in mechanism.coordinates]
    turning = declared(mechanism, said)
    drawn = turning if turning and turns_round(turning) else declared(mechanism, said, lambda _: at)
    if drawn is None:
        raise BadInput(f"{name} has nothing to draw; give it links and joints, or m.draw_line")
    return said["name"], svg(figure_of(drawn, at[0], standing=_standing(name, at[0])), said["name"])

"""A drawing of a mechanism painted with matplotlib, or moving in a page that opens offline."""

import json
import math
from collections.abc import Callable
from importlib import resources
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from mechsym.mechanisms.drawing import Circle, Line, Shapes, extent_of, shapes
from mechsym.style import INK, QUIET

# role: colour of the line, line width in points, filled colour
STYLES: dict[str, tuple[str, float, str]] = {
    "frame": (QUIET, 1.4, "none"),
    "flywheel": ("#b9c0cc", 1.4, "#f1f3f6"),
    "piston": (INK, 1.4, "#dfe5ee"),
    "planet": ("#3a7d44", 2.0, "none"),
    "rod": ("#2f6690", 3.0, "none"),
    "crank": ("#c8553d", 3.4, "none"),
    "joint": (INK, 1.2, "#ffffff"),
}
_FRAMES = 120


def paint(axes: Any, mechanism: str, parameters: Any, angle: float) -> None:
    """Paint a mechanism to scale.

    Parameters
    ----------
    angle : float
        Crank angle [rad]
    """
    _paint(axes, lambda at: shapes(mechanism, parameters, at), angle)


def _paint(axes: Any, drawn: Callable[[float], Shapes], angle: float) -> None:
    from matplotlib import patches

    for shape in _ordered(drawn(angle)):
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


def _ordered(found: tuple[Line | Circle, ...]) -> list[Line | Circle]:
    # frame behind, joints in front
    return sorted(found, key=lambda shape: list(STYLES).index(shape.role))


def figure(mechanism: str, parameters: Any, angle: float) -> Figure:
    """One drawing with a scale.

    Parameters
    ----------
    angle : float
        Crank angle [rad]
    """
    return figure_of(lambda at: shapes(mechanism, parameters, at), angle)


def figure_of(drawn: Callable[[float], Shapes], angle: float) -> Figure:
    """One drawing with a scale, at a crank angle [rad]."""
    left, right, low, high = extent_of(drawn)
    wide, tall = right - left, high - low
    size = 8.0 / max(wide, tall)
    picture = Figure(figsize=(max(size * wide, 3.0), max(size * tall, 1.6) + 0.5), layout="constrained")
    axes = picture.add_subplot()
    _paint(axes, drawn, angle)
    step = 10 ** math.floor(math.log10(max(wide, tall / 4) / 3))
    length = max(k * step for k in (1, 2, 5) if k == 1 or k * step <= wide / 3)
    y = low - 0.02 * max(wide, tall)
    axes.plot([left, left + length], [y, y], color=INK, lw=1.5)
    axes.text(
        left + length, y, f"  {1e3 * length:g} mm, crank at {math.degrees(angle):.0f} deg", va="center", fontsize=8
    )
    return picture


def animation(mechanism: str, parameters: Any, title: str) -> str:
    """A page in which the mechanism turns; it needs nothing from outside."""
    return animation_of(lambda at: shapes(mechanism, parameters, at), title)


def animation_of(drawn: Callable[[float], Shapes], title: str) -> str:
    """A page in which a drawing over the crank angle [rad] turns; it needs nothing from outside."""
    import jinja2

    source = (resources.files("mechsym") / "templates" / "mechanism.html").read_text(encoding="utf-8")
    left, right, low, high = extent_of(drawn)
    angles = np.linspace(0, 2 * math.pi, _FRAMES, endpoint=False)
    frames = [[_plain(s) for s in _ordered(drawn(float(a)))] for a in angles]
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined, autoescape=True, trim_blocks=True)
    return environment.from_string(source).render(
        title=title,
        frames=json.dumps(frames, separators=(",", ":")),
        styles=json.dumps(STYLES),
        box=json.dumps([left, right, low, high]),
        count=_FRAMES,
    )


def _plain(shape: Line | Circle) -> list[Any]:
    """Role first; a circle has three numbers, a line its corners."""
    if isinstance(shape, Circle):
        return [shape.role, round(shape.centre[0], 6), round(shape.centre[1], 6), round(shape.radius, 6)]
    return [shape.role, [[round(x, 6), round(y, 6)] for x, y in shape.points]]

"""Drawings that turn in a page: what stands still once, what moves for every angle; colours by the role of a part."""

import math
from collections.abc import Callable, Iterable

import numpy as np

from mechsym.files import Json
from mechsym.mechanisms.drawn_parts import Circle, Line, Shapes, extent_of
from mechsym.quantities.units import Pure
from mechsym.style import BLUE, DARK, GREEN, INK, PAPER, QUIET, RED, VIOLET
from mechsym.style.palette import GAS, PISTON, ROLLER, WHEEL

FRAMES = 120
# role: colour of the line, line width in points, filled colour; what comes first lies behind
STYLES: dict[str, tuple[str, float, str]] = {
    "second_track": (VIOLET, 1.6, "none"),
    "track": (RED, 2.2, "none"),
    "gas": (GAS, 0.5, GAS),
    "frame": (QUIET, 1.4, "none"),
    "flywheel": (QUIET, 1.2, WHEEL),
    "piston": (INK, 1.4, PISTON),
    "planet": (GREEN, 2.0, "none"),
    "rod": (BLUE, 3.0, "none"),
    "spring": (BLUE, 2.0, "none"),
    "crank": (RED, 3.4, "none"),
    "roller": (INK, 1.4, ROLLER),
    "joint": (INK, 1.2, PAPER),
}

_BODIES, _BODY = ("rod", "crank"), 4.0  # drawn by their middle lines; as wide as bodies in a page


def ordered(found: Iterable[Line | Circle]) -> list[Line | Circle]:
    """Shapes by their role, what lies behind first."""
    return sorted(found, key=lambda shape: list(STYLES).index(shape.role))


def scene(drawn: Callable[[float], Shapes], name: str, turns: Pure = 1.0, frames: int = FRAMES) -> Json:
    """A drawing over the crank angle as a page moves it, with a name for what it shows.

    turns: of the crank, after which it begins again. Returns scene: `scale` is how many of its units a metre has.
    """
    left, right, low, high = extent_of(drawn)
    pad = 0.04 * max(right - left, high - low)
    scale = 1000 / (right - left + 2 * pad)
    angles = np.linspace(0, 2 * math.pi * turns, frames, endpoint=False)

    def places(shape: Line | Circle) -> list[float]:
        points = [shape.centre] if isinstance(shape, Circle) else shape.points
        return [round(v, 1) for x, y in points for v in (scale * (x - left + pad), scale * (high + pad - y))]

    all_frames = [ordered(drawn(float(angle))) for angle in angles]
    paths = np.array([[v for shape in frame for v in places(shape)] for frame in all_frames])
    moves = (paths != paths[0]).any(axis=0)
    shapes, start = [], 0
    for shape in all_frames[0]:
        at = slice(start, start := start + len(places(shape)))
        radius = round(scale * shape.radius, 1) if isinstance(shape, Circle) else 0
        closed = isinstance(shape, Circle) or shape.points[0] == shape.points[-1]
        moving = paths[:, at].tolist() if moves[at].any() else []
        shapes.append({"role": shape.role, "r": radius, "closed": closed, "at": places(shape), "moves": moving})
    size = [1000.0, round(scale * (high - low + 2 * pad), 1)]
    return {"name": name, "size": size, "scale": scale, "turns": turns, "count": frames, "shapes": shapes}


def rules() -> str:
    """Styles of the roles for light and dark paper."""
    dark = "".join(f".{role}{_colours(DARK[line], DARK.get(fill, fill))}" for role, (line, _, fill) in STYLES.items())
    light = "".join(
        f".{role}{_colours(line, fill)[:-1]};stroke-width:{1.6 * width:g}}}"
        for role, (line, width, fill) in STYLES.items()
    )
    light += "".join(f".{role}.open{{stroke-width:{_BODY * STYLES[role][1]:g}}}" for role in _BODIES)
    return f"{light}@media screen and (prefers-color-scheme:dark){{{dark}}}"


def _colours(line: str, fill: str) -> str:
    return f"{{stroke:{line};fill:{fill}}}"

"""Drawings that turn in a page: what stands still once, what moves for every angle; colours by the role of a part."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence

import numpy as np

from mechsym.files import Json
from mechsym.mechanisms.drawn_parts import Circle, Line, Shapes, extent_of
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Pure
from mechsym.style import DARK, RED
from mechsym.style.panels import GAS
from mechsym.style.shapes import STYLES

FRAMES = 120
_BODIES, _BODY = ("rod", "crank"), 4.0  # drawn by their middle lines; as wide as bodies in a page


def ordered(shapes: Iterable[Line | Circle]) -> list[Line | Circle]:
    """Shapes by their role, what lies behind first."""
    return sorted(shapes, key=lambda shape: list(STYLES).index(shape.role))


@record
class Course:
    """How a picture goes over a motion in time."""

    starts: float = quantity("s", low=0, about="time of its first frame")
    lasts: float = quantity("s", low=0, about="how long the motion takes")
    back: bool = False  #: Whether it goes back again


def scene(
    drawn: Callable[[float], Shapes], name: str, turns: Pure = 1.0, frames: int = FRAMES, course: Course | None = None
) -> Json:
    """A drawing over the crank angle as a page moves it, with a name for what it shows.

    turns: of the crank, after which it begins again. course: of what moves over time in place of an angle. Returns
    scene: `scale` is how many of its units a metre has.
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
    for number, shape in enumerate(all_frames[0]):
        at = slice(start, start := start + len(places(shape)))
        radius = round(scale * shape.radius, 1) if isinstance(shape, Circle) else 0
        closed = isinstance(shape, Circle) or shape.points[0] == shape.points[-1]
        moving = paths[:, at].tolist() if moves[at].any() else []
        shapes.append({"role": shape.role, "r": radius, "closed": closed, "at": places(shape), "moves": moving})
        shapes[-1] |= {"of": shape.of} if shape.of else {}
        if shape.space:
            rows = [[round(scale * v, 1) for p in frame[number].space for v in p] for frame in all_frames]
            shapes[-1]["space"] = rows if moving else rows[:1]
    size = [1000.0, round(scale * (high - low + 2 * pad), 1)]
    origin = [round(scale * (pad - left), 1), round(scale * (high + pad), 1)]
    facts = {"name": name, "size": size, "scale": scale, "origin": origin, "turns": turns, "count": frames}
    facts |= {} if course is None else {"starts": course.starts, "lasts": course.lasts, "back": course.back}
    return facts | {"shapes": shapes} | ({"space": True} if any("space" in shape for shape in shapes) else {})


ARROW = 200  # length of the largest force of the gas, of a scene that is 1000 wide


@record
class Load:
    """A force in a joint, at the frames of a scene."""

    name: str  #: What presses on what
    at: np.ndarray  #: Where, x + i y, shape (n,) [m]
    force: np.ndarray  #: Along x + i y, shape (n,) [N]


@record
class Pushed:
    """What the gas does to a piston."""

    travel: np.ndarray  #: From the head, at the frames of a scene, shape (n,) [m]
    force: np.ndarray  #: Net force away from the head over the whole period of the gas, shape (m,) [N]


def filled(shown: Json, charges: Sequence[Pushed]) -> Json:
    """A scene whose cylinders say what their gas does, as shares of the largest force.

    A piston that is drawn is the one that moves as it does; of several that move alike the first that is not yet drawn.
    """
    most = max((float(np.abs(one.force).max()) for one in charges), default=0.0)
    walls = [k for k, s in enumerate(shown["shapes"]) if s["role"] == "frame" and len(s["at"]) == 2 * len(_WALLS)]
    crowns = [k for k, s in enumerate(shown["shapes"]) if s["role"] == "piston" and s["closed"]]
    rows, drawn = [], [0] * len(charges)
    for wall, crown in ((w, c) for w in walls for c in crowns if most):
        depth = _depth(*(_places(shown["shapes"][k]) for k in (wall, crown)))
        if depth is None:
            continue
        away = [float(np.abs(_share(depth) - _share(one.travel)).max()) for one in charges]
        number = min(range(len(charges)), key=lambda k: (round(away[k], 2), drawn[k]))
        number = shown["shapes"][crown].get("of", number + 1) - 1
        drawn[number] += 1
        share = np.rint(100 * charges[number].force / most).astype(int)
        rows.append({"wall": wall, "piston": crown, "share": share.tolist()})
    count = max([shown["count"], *(len(row["share"]) for row in rows)])
    turns = shown["turns"] * count / shown["count"]
    return shown | {"gases": rows, "most": most, "count": count, "turns": turns}


def pushed(shown: Json, loads: Sequence[Load]) -> Json:
    """A scene with the forces in its joints, to one scale with those of its gas where there are any."""
    most = shown.get("most") or max((float(np.abs(one.force).max()) for one in loads), default=0.0)
    rows = [
        {
            "name": one.name,
            "at": _pixels(shown, one.at),
            "to": [[round(ARROW * f.real / most), round(-ARROW * f.imag / most)] for f in one.force],
        }
        for one in loads
        if most
    ]
    return shown | {"loads": rows, "most": most}


def corners(shown: Json, role: str) -> Iterator[tuple[int, np.ndarray]]:
    """Cylinder and corners of each line or circle of a role that moves, x + i y at its frames, (n, corners) [m]."""
    left, top = shown["origin"]
    for shape in (s for s in shown["shapes"] if s["role"] == role and s["moves"] and (s["r"] or not s["closed"])):
        x, y = np.moveaxis(_places(shape)[np.arange(shown["count"]) % len(shape["moves"])], -1, 0)
        yield shape.get("of", 0), (x - left - 1j * (y - top)) / shown["scale"]


def _pixels(shown: Json, at: np.ndarray) -> list[list[float]]:
    (left, top), scale = shown["origin"], shown["scale"]
    pixels = np.rint([left + scale * at.real, top - scale * at.imag]).astype(int).T
    once: list[list[float]] = pixels[:1].tolist() if (pixels == pixels[0]).all() else pixels.tolist()
    return once


_WALLS = "wall head head wall".split()  # corners of a cylinder as it is drawn


def _places(shape: Json) -> np.ndarray:
    """Corners of a shape at the frames, or once where it stands still, shape (n, corners, 2)."""
    return np.reshape(shape["moves"] or [shape["at"]], (-1, len(shape["at"]) // 2, 2))


def _depth(wall: np.ndarray, piston: np.ndarray) -> np.ndarray | None:
    """How far a piston stands from the head of a cylinder at each frame; None where it runs in another one."""
    way = wall[:, 1] - wall[:, 0]
    length = np.linalg.norm(way, axis=1)
    along, middle = way / length[:, None], (wall[:, 0] + wall[:, 3]) / 2
    corners = np.einsum("fcx,fx->fc", piston - middle[:, None], along)
    beside = np.linalg.norm(piston[:, :4].mean(axis=1) - middle - corners[:, :4].mean(axis=1)[:, None] * along, axis=1)
    depth = length - corners.max(axis=1)
    return depth if beside.max() < 0.02 * length.min() and depth.min() > 0 and corners.min() > -length.min() else None


def _share(values: np.ndarray) -> np.ndarray:
    return (values - values.min()) / (np.ptp(values) or 1.0)


def rules() -> str:
    """Styles of the roles for light and dark paper."""
    dark = "".join(f".{role}{_colours(DARK[line], DARK.get(fill, fill))}" for role, (line, _, fill) in STYLES.items())
    light = "".join(
        f".{role}{_colours(line, fill)[:-1]};stroke-width:{1.6 * width:g}}}"
        for role, (line, width, fill) in STYLES.items()
    )
    light += "".join(f".{role}.open{{stroke-width:{_BODY * STYLES[role][1]:g}}}" for role in _BODIES)
    light += f".gas{{fill:color-mix(in srgb,{RED} calc(.6*var(--share,0%)),{GAS})}}"
    dark += f".gas{{fill:color-mix(in srgb,{DARK[RED]} calc(.6*var(--share,0%)),{DARK[GAS]})}}"
    return f"{light}@media screen and (prefers-color-scheme:dark){{{dark}}}"


def _colours(line: str, fill: str) -> str:
    return f"{{stroke:{line};fill:{fill}}}"

"""Drawing of a mechanism: shapes at declared points, or by formulas of its letters.

draw_*   lines, circles and boxes at points of links; the derived code places them
sketch   shapes by formulas, stored as text; pistons and cylinders are as wide as the bore of the case
"""

from typing import NamedTuple

from sympy import Expr

from mechsym.derive.letters import Letters
from mechsym.derive.linkage import Pair, point_of
from mechsym.derive.refuse import refuse
from mechsym.files import Json
from mechsym.style.shapes import DECLARED

SKETCHED = ("line", "circle", "box", "piston", "cylinder", "slider_crank")


class DrawnCam(NamedTuple):
    """A cam about the origin and its follower, as drawings need them."""

    base: Expr  # radius of its base circle [m]
    roller: Expr  # radius; 0 without one [m]
    turned: Expr  # [rad]
    place: Pair  # of its contact, or of the roller's centre there [m]
    lines: tuple[tuple[Pair, ...], ...]  # of the follower [m]


class Drawing(Letters):
    """The part of a declaration that draws it."""

    def _start_drawing(self) -> None:
        self.shapes: list[Json] = []
        self.pins: dict[str, list[str]] = {}  # names of their places, of a slide also of one across it
        self.shape_points: dict[str, Expr] = {}
        self.sketches: list[Json] = []
        self.cams_drawn: list[DrawnCam] = []

    def point_names(self, points: tuple[object, ...]) -> list[list[str]]:
        """Names under which the derived code places points: pairs (x, y) [m] or points of links."""
        all_names = []
        for point in points:
            pair = self._pair(point, "m", "point of the drawing") if isinstance(point, tuple) else point_of(point).xy
            names = []
            for axis, value in zip("xy", pair, strict=True):
                name = f"draw_{axis}{len(self.shape_points) // 2}"
                self.shape_points[name] = self.tape.named(value)
                names.append(name)
            all_names.append(names)
        return all_names

    def _shape(self, kind: str, role: str, points: tuple[object, ...], **sizes: object) -> None:
        if role not in DECLARED:
            refuse(f"nothing is painted as {role!r}; there are {', '.join(DECLARED)}")
        named = {key: self._size(size) for key, size in sizes.items()}
        self.shapes.append({"kind": kind, "role": role, "points": self.point_names(points), **named})

    def draw_line(self, *points: object, role: str = "rod") -> None:
        """Draw a line through points: pairs (x, y) [m] or points of links."""
        if len(points) < 2:
            refuse(f"a line goes through two points or more, and {len(points)} is named")
        self._shape("line", role, points)

    def draw_circle(self, point: object, radius: Expr | float, role: str = "joint") -> None:
        """Draw a circle of a radius [m] about a point [m]."""
        self._shape("circle", role, (point,), radius=radius)

    def draw_box(self, point: object, width: Expr | float, height: Expr | float, role: str = "piston") -> None:
        """Draw a box of a width and height [m] about a point [m], its sides along x and y."""
        self._shape("box", role, (point,), width=width, height=height)

    def sketch(
        self,
        kind: str,
        *points: tuple[Expr | float, Expr | float],
        role: str = "",
        turned: Expr | float = 0,
        **sizes: Expr | float,
    ) -> None:
        """Draw a shape by formulas of parameters and coordinates, turned about the shaft by an angle [rad]: a `line`
        through points, a `circle` with its radius, a `box` from its lower left corner with width and height, a `piston`
        at its pin and the `cylinder` from its lowest pin on, both with the stroke along x and as wide as the bore, and
        a `slider_crank` with throw r, rod l, offset and the angle of its crank [m, rad]."""
        if kind not in SKETCHED:
            refuse(f"nothing is sketched as {kind!r}; there are {', '.join(SKETCHED)}")
        if role and role not in DECLARED:
            refuse(f"nothing is painted as {role!r}; there are {', '.join(DECLARED)}")
        moving = (*self.q,)
        named = {
            k: self._size_of(v, "rad" if k == "angle" else "m", f"{k} of a {kind}", moving) for k, v in sizes.items()
        }
        places = [[self._size_of(v, "m", f"point of a {kind}", moving) for v in point] for point in points]
        self.sketches.append(
            {
                "kind": kind,
                "role": role,
                "points": places,
                "sizes": named,
                "turned": self._size_of(turned, "rad", "turn"),
            }
        )

    def _size(self, value: Expr | float) -> str:
        name = f"draw_s{len(self.shape_points)}"
        self.shape_points[name] = self.tape.named(self._checked(value, "m", "size in the drawing"))
        # an even count keeps the numbering of points
        self.shape_points[f"{name}_"] = self.shape_points[name]
        return name

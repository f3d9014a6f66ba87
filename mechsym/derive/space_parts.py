"""What a mechanism in space is declared of: points, links and joints."""

from dataclasses import dataclass, field
from typing import Any

from sympy import Expr, cos, sin

from mechsym.derive.refuse import refuse
from mechsym.derive.space_joints import Freedom
from mechsym.derive.space_rows import ClosureRow, JointSide
from mechsym.derive.space_tree import TreeBody
from mechsym.derive.vectors import NONE, Matrix, O, Vector

Declaration = Any  # of space.py, which imports this module


@dataclass(eq=False)
class SpacePoint:
    """A point of a link, and perhaps a direction, in the link's axes."""

    link: "SpaceLink"
    at: Vector = NONE
    direction: Vector | None = None

    def __repr__(self) -> str:
        return f"{self.link!r}.at{self.at}"

    @property
    def xyz(self) -> Vector:
        """Where it is [m]."""
        return self.link.m.placed(self)

    xy = property(lambda self: self.xyz, doc="Where it is [m].")
    x = property(lambda self: self.xyz[0], doc="Where it is along x [m].")
    y = property(lambda self: self.xyz[1], doc="Where it is along y [m].")
    z = property(lambda self: self.xyz[2], doc="Where it is along z [m].")


@dataclass(eq=False)
class SpaceLink:
    """A rigid body with axes of its own."""

    m: Declaration
    name: str
    turns: Expr | None = None
    guess: float | None = None
    where: str = ""
    part: Any = None  #: Of the tree, once it hangs there
    angle: Expr | None = None  #: About z, of what has only turned about z
    mass: Expr = O
    centre: Vector = NONE
    inertia: Matrix = (NONE, NONE, NONE)
    flat: bool = False  #: Whether only its inertia about z is known

    def __repr__(self) -> str:
        return self.name

    def at(self, x: Expr | float = 0, y: Expr | float = 0, z: Expr | float = 0) -> SpacePoint:
        """A point of the link, in its own axes [m]."""
        return SpacePoint(self, self.m._triple((x, y, z), "m", f"point of {self.name}", f"{self.name}_"))

    def axis(self, direction: object, at: object = (0, 0, 0)) -> SpacePoint:
        """A line of the link: "x", "-y" or three values along it, through a point [m]."""
        point = at if isinstance(at, SpacePoint) else self.at(*three(at))
        return SpacePoint(self, point.at, self.m._direction(direction))

    def line(self, u: Expr | float = 0, v: Expr | float = 0, *, angle: Expr | float = 0) -> SpacePoint:
        """A line of the link in its x and y through a point [m] at an angle [rad]."""
        tilt = self.m._sized(angle, "rad", f"{self.name}_tilt", "line")
        return SpacePoint(self, self.at(u, v).at, (cos(tilt), sin(tilt), O))


@dataclass(eq=False)
class SpaceJoint:
    """A joint in space."""

    kind: str
    name: str
    first: SpacePoint
    second: SpacePoint
    given: tuple[Any, ...] = ()  #: Coordinates of the user's own
    pose: Any = None
    sequence: str = ""
    lead: Expr = O
    length: Expr = O
    axes: SpaceLink | None = None  #: In whose axes its reactions are told; the frame's without
    where: str = ""
    asked: bool = False  #: Whether a formula takes a coordinate of it, so that it hangs before others
    child: SpaceLink | None = None  #: What it has placed
    parts: tuple[TreeBody, ...] = ()
    freedoms: list[Freedom] = field(default_factory=list)
    rows: dict[str, ClosureRow] = field(default_factory=dict)

    @property
    def sides(self) -> tuple[JointSide, JointSide]:
        """Both points as the tree has them."""
        first, second = (JointSide(s.link.part, s.at, s.direction or NONE) for s in (self.first, self.second))
        return first, second

    @property
    def comes_first(self) -> bool:
        """Whether it hangs a body before joints of few freedoms do: by coordinates that a formula takes, or freely."""
        return bool(self.given) or self.asked or self.kind == "free"

    def coordinate(self, turns: bool, number: int = 0) -> Expr:
        """A coordinate of the joint: of its turns [rad] or of its ways [m], the first where there are several."""
        m = self.second.link.m
        self.asked = True
        m.settle(self.second.link)
        values = [f.value for f in self.freedoms if f.turns is turns]
        if number >= len(values):
            why = f"has {len(values)} of them"
            if self.child is None:
                why = "closes a loop; ask it before coordinates of other joints"
            refuse(f"the {self.kind} joint {self.name!r} has no such coordinate: it {why}")
        return values[number]

    turn = property(lambda self: self.coordinate(True), doc="Its turn, of the second against the first [rad].")
    slide = property(lambda self: self.coordinate(False), doc="Its way, of the second along the first [m].")


def three(value: object) -> tuple[Any, Any, Any]:
    """Three values, the third 0 where two are given."""
    given = tuple(value) if isinstance(value, (tuple, list)) else (value,)
    if len(given) not in (2, 3):
        refuse(f"{value!r} is no place in space; write three values (x, y, z)")
    x, y, *rest = given
    return x, y, rest[0] if rest else 0

"""Planar linkages without algebra: links, and the joints between them.

    rod = m.link("rod", mass=m2, centre=(l / 2, 0), inertia=I2)      a rigid body with axes of its own (u, v)
    m.pin("A", m.frame, crank)                                      their points coincide
    m.slider("G", m.frame.line(), piston)                           lines on both coincide
    m.slot("S", rocker.line(), crank.at(r))                         a point of one on a line of the other
    m.gear("T", ring, planet, radii=(2 * e, e), inside=True)        pitch circles roll

A joint says its name, the first and the second body; its reaction is the force of the first on the second. Links are
placed as soon as their joints allow a closed form (closing.py); what remains closes by constraint.
"""

from dataclasses import dataclass, field
from typing import Any

from sympy import Expr, Integer, Symbol, cos, sin, sympify

from mechsym.derive.refuse import place, refuse

Pair = tuple[Expr, Expr]


@dataclass(eq=False)
class LinkPoint:
    """A point of a link, in the link's axes."""

    link: "Link"
    u: Expr
    v: Expr

    def __repr__(self) -> str:
        return f"{self.link!r}.at({self.u}, {self.v})"

    @property
    def xy(self) -> Pair:
        """Where it is [m]."""
        self.link.settle()
        return self.link.out((self.u, self.v))

    x = property(lambda self: self.xy[0], doc="Where it is along x [m].")
    y = property(lambda self: self.xy[1], doc="Where it is along y [m].")


@dataclass(eq=False)
class LinkLine:
    """A line of a link: a point of it and its angle, in the link's axes."""

    link: "Link"
    u: Expr
    v: Expr
    tilt: Expr

    def __repr__(self) -> str:
        return f"{self.link!r}.line({self.u}, {self.v}, angle={self.tilt})"


@dataclass(eq=False)
class Link:
    """A rigid body with axes of its own; `turns` is its angle where that is known beforehand."""

    m: Any  # the declaration
    name: str
    mass: Expr = Integer(0)
    centre: Pair = (Integer(0), Integer(0))
    inertia: Expr = Integer(0)
    turns: Expr | None = None
    origin: Pair | None = None
    guess: float = 0.0
    where: str = ""
    turned: Symbol | None = None  # carrier of a gear's line of centres
    given: bool = field(default=False)

    def __repr__(self) -> str:
        return self.name

    def at(self, u: Any = 0, v: Any = 0) -> LinkPoint:
        """A point of the link, in its own axes [m]."""
        return LinkPoint(self, *(self.m._checked(c, "m", f"point of {self.name}") for c in (u, v)))

    def line(self, u: Any = 0, v: Any = 0, *, angle: Any = 0) -> LinkLine:
        """A line of the link through a point [m] at an angle [rad], in its own axes."""
        at = self.at(u, v)
        return LinkLine(self, at.u, at.v, self.m._checked(angle, "rad", "line"))

    @property
    def placed(self) -> bool:
        """Whether its angle and its origin are known."""
        return self.turns is not None and self.origin is not None

    @property
    def angle(self) -> Expr:
        """Its angle, positive from x to y [rad]."""
        self.settle()
        return self.turns

    def settle(self) -> None:
        """Place the linkage as declared so far, by constraint where there is no closed form."""
        if not self.placed:
            self.m.settle(self)

    def turn(self, vector: Pair) -> Pair:
        """A vector of the link's axes in those of the frame."""
        (u, v), angle = vector, self.turns
        return u * cos(angle) - v * sin(angle), u * sin(angle) + v * cos(angle)

    def out(self, point: Pair) -> Pair:
        """A point of the link's axes in those of the frame [m]."""
        (x, y), (x0, y0) = self.turn(point), self.origin or (Integer(0), Integer(0))
        return x0 + x, y0 + y


@dataclass(eq=False)
class Joint:
    """A joint between two links: what kind, what on each, displacements and reactions."""

    kind: str
    name: str
    first: Any
    second: Any
    branch: int = 0
    radii: Pair = (Integer(0), Integer(0))
    inside: bool = False
    used: bool = False
    where: str = ""
    displacements: tuple[Symbol, ...] = ()

    def side(self, link: Link) -> Any:
        """What the joint holds of a link."""
        return self.first if self.first.link is link else self.second

    def other(self, link: Link) -> Any:
        """What the joint holds of the link on the other side."""
        return self.second if self.first.link is link else self.first

    def sign(self, link: Link) -> int:
        """1 where the link is the second, on which the reaction acts."""
        return 1 if self.second.link is link else -1


_DISPLACED = {"pin": ("x", "y"), "slider": ("n", "turn"), "slot": ("n",), "gear": ("t",)}


class Linkage:
    """The part of a declaration that is made of links and joints."""

    name: str

    def _start_linkage(self) -> None:
        self.links: list[Link] = []
        self.link_joints: list[Joint] = []
        m: Any = self
        self.frame = Link(m, "frame", turns=Integer(0), origin=(Integer(0), Integer(0)))

    def link(
        self, name: str, *, turns: Any = None, mass: Any = 0, centre: Any = (0, 0), inertia: Any = 0, guess: float = 0.0
    ) -> Link:
        """Add a rigid link.

        Parameters
        ----------
        name : str
            Name of the link
        turns : Expr, optional
            Its angle where that is known: a coordinate of the crank [rad]
        mass, inertia : Expr
            Mass [kg], inertia about the centre of mass [kg*m^2]
        centre : tuple of Expr
            Centre of mass in the link's axes [m]
        guess : float
            Angle near which it starts, where the loop closes by constraint [rad]

        Returns
        -------
        link : Link
            Its points are `link.at(u, v)`, its lines `link.line(u, v, angle=..)`
        """
        m: Any = self
        if name == "frame" or any(k.name == name for k in self.links):
            refuse(f"the link {name!r} is declared twice in {self.name}; give one of them another name")
        found = Link(m, name, guess=float(guess), where=place(), given=turns is not None)
        found.turns = None if turns is None else m._checked(turns, "rad", f"angle of {name}")
        found.mass, found.inertia = m._checked(mass, "kg", "mass"), m._checked(inertia, "kg*m^2", "inertia")
        found.centre = tuple(m._checked(c, "m", f"centre of {name}") for c in centre)
        self.links.append(found)
        return found

    def pin(self, name: str, first: Any, second: Any, *, branch: int = 0) -> None:
        """Join two points (a link stands for its origin); `branch` 1 or -1 chooses the side of a dyad."""
        self._join(Joint("pin", name, point_of(first), point_of(second), branch))

    def slider(self, name: str, first: Any, second: Any, *, branch: int = 0) -> None:
        """Let a line of the second slide on a line of the first (a link stands for its own u axis)."""
        self._join(Joint("slider", name, _line(first), _line(second), branch))

    def slot(self, name: str, first: Any, second: Any, *, branch: int = 0) -> None:
        """Hold a point of one link on a line of the other."""
        pair = [s if isinstance(s, (LinkLine, LinkPoint)) else point_of(s) for s in (first, second)]
        if {type(s) for s in pair} != {LinkLine, LinkPoint}:
            refuse(
                f"the slot {name!r} takes a line of one link and a point of the other; write rocker.line(), crank.at(r)"
            )
        self._join(Joint("slot", name, pair[0], pair[1], branch))

    def gear(self, name: str, first: Any, second: Any, *, radii: tuple[Any, Any], inside: bool = False) -> None:
        """Let pitch circles of radii [m] about two points roll; `inside` puts the second within the first (a ring)."""
        m: Any = self
        sizes = tuple(m._checked(r, "m", f"pitch radius of {name}") for r in radii)
        self._join(Joint("gear", name, point_of(first), point_of(second), radii=sizes, inside=inside))

    def _join(self, joint: Joint) -> None:
        joint.where = place()
        for known in self.link_joints:
            if known.name == joint.name:
                refuse(f"the joint {joint.name!r} has two owners (first at {known.where}); give one another name")
        if joint.first.link is joint.second.link:
            refuse(f"the joint {joint.name!r} joins {joint.first.link.name} to itself; name two links")
        if joint.branch not in (-1, 0, 1):
            refuse(f"branch = {joint.branch} of the joint {joint.name!r} must be 1 or -1")
        self.link_joints.append(joint)
        self.advance()

    def advance(self) -> None:
        """Place what has a closed form (see `Declaration`)."""
        raise NotImplementedError

    def displace(self, joint: Joint) -> tuple[Symbol, ...]:
        """Displacements of a joint that places a link; their generalised forces are its reactions."""
        m: Any = self
        parts = _DISPLACED[joint.kind]
        about = f"{joint.first.link.name} on {joint.second.link.name}, {joint.kind} {joint.name}"
        for part in parts:
            unit, stem = ("N*m", "M") if part == "turn" else ("N", f"R_{part}")
            found = m.joints(f"s{part}_{joint.name}", about, unit, f"{stem}_{joint.name}")
            joint.displacements += (found,)
        joint.used = True
        return joint.displacements


def point_of(part: Any) -> LinkPoint:
    """A point of a link; a link stands for its origin."""
    if isinstance(part, Link):
        return part.at()
    if not isinstance(part, LinkPoint):
        refuse(f"{part!r} is no link and no point of one; write link.at(u, v)")
    return part


def _line(part: Any) -> LinkLine:
    if isinstance(part, Link):
        return part.line()
    if not isinstance(part, LinkLine):
        refuse(f"{part!r} is no link and no line of one; write link.line(u, v, angle=..)")
    return part


def named_point(m: Any, name: str, pair: Pair) -> Pair:
    """A point of the frame by its names `x_name, y_name`, where it is not a number or a letter."""
    return m._point(f"x_{name}", sympify(pair[0])), m._point(f"y_{name}", sympify(pair[1]))

"""Planar linkages without algebra: links, and the joints between them.

    rod = m.link("rod", mass=m2, centre=(l / 2, 0), inertia=I2)      a rigid body with axes of its own (u, v)
    m.pin("A", m.frame, crank)                                      their points coincide
    m.slider("G", m.frame.line(), piston)                           lines on both coincide
    m.slot("S", rocker.line(), crank.at(r))                         a point of one on a line of the other
    m.gear("T", ring, planet, radii=(2 * e, e), inside=True)        pitch circles roll

A joint says its name, the first and the second body; its reaction is the force of the first on the second. Links are
placed as soon as their joints allow a closed form (closing.py); what remains closes by constraint.
"""

from collections.abc import Callable
from contextvars import ContextVar
from dataclasses import dataclass, field
from math import pi
from typing import Any

from sympy import Expr, Integer, Symbol, cos, sin

from mechsym.derive.letters import Letters
from mechsym.derive.printer import read
from mechsym.derive.refuse import place, refuse
from mechsym.quantities.units import Radian

Pair = tuple[Expr, Expr]
_FAR = 4 * pi  # rad: a pose beyond two turns is one in degrees

#: Whether declarations that are made now close every loop by constraint, so that they have no dead points
BY_CONSTRAINT: ContextVar[bool] = ContextVar("by_constraint", default=False)


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

    m: "Linkage"
    name: str
    mass: Expr = Integer(0)
    centre: Pair = (Integer(0), Integer(0))
    inertia: Expr = Integer(0)
    turns: Expr | None = None
    origin: Pair | None = None
    guess: float | None = None
    where: str = ""
    turned: Symbol | None = None  # carrier of a gear's line of centres
    given: bool = field(default=False)

    def __repr__(self) -> str:
        return self.name

    def at(self, u: Expr | float = 0, v: Expr | float = 0) -> LinkPoint:
        """A point of the link, in its own axes [m]."""
        names = f"{self.name}_u", f"{self.name}_v"
        return LinkPoint(self, *self.m._pair((u, v), "m", f"point of {self.name}", names))

    def line(self, u: Expr | float = 0, v: Expr | float = 0, *, angle: Expr | float = 0) -> LinkLine:
        """A line of the link through a point [m] at an angle [rad], in its own axes."""
        at = self.at(u, v)
        return LinkLine(self, at.u, at.v, self.m._sized(angle, "rad", f"{self.name}_tilt", "line"))

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
    displacements: tuple[Expr, ...] = ()
    place: Pair | None = None  # of a pin, seen from the placed side
    through: "tuple[Joint, Joint] | None" = None  # pins at one point of a link between, in place of one of its own

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


class Linkage(Letters):
    """The part of a declaration that is made of links and joints."""

    body: Callable[..., None]  # see `Declaration`

    def _start_linkage(self) -> None:
        self.links: list[Link] = []
        self.link_joints: list[Joint] = []
        self.poses: dict[str, float | tuple[float, float]] = {}
        self.sides: list[Any] = []  # how loops were closed, see poses.py
        self.roots: list[Expr] = []  # that are 0 where the two ways to close a loop meet
        self.by_constraint = BY_CONSTRAINT.get()
        self.frame = Link(self, "frame", turns=Integer(0), origin=(Integer(0), Integer(0)))

    def link(
        self,
        name: str,
        *,
        turns: Expr | float | None = None,
        mass: Expr | float = 0,
        centre: object = (0, 0),
        inertia: Expr | float = 0,
        guess: Radian | None = None,
        pose: object = None,
    ) -> Link:
        """Add a rigid link.

        turns: Expr, optional, its angle where that is known: a coordinate of the crank [rad]. mass, inertia: Expr, mass
        [kg], inertia about the centre of mass [kg*m^2]. centre: tuple of Expr, centre of mass in the link's axes [m].
        pose: its angle or place in a rough pose, see `pose`. Returns link: its points are `link.at(u, v)`, its lines
        `link.line(u, v, angle=..)`.

        Parameters
        ----------
        guess : float, optional
            Angle near which it starts, 0 without, where the loop closes by constraint; refused where a closed form with
            its `branch` leaves it without use
        """
        if name == "frame" or any(k.name == name for k in self.links):
            refuse(f"the link {name!r} is declared twice in {self.name}; give one of them another name")
        if name in {q.name for q in self.q}:
            refuse(f"the link {name!r} has the name of a coordinate{self._first(name)}; give one of them another name")
        self._usable(name)
        new = Link(self, name, where=place(), given=turns is not None)
        new.guess = None if guess is None else self._number(guess, f"guess of {name}")
        new.turns = None if turns is None else self._checked(turns, "rad", f"angle of {name}")
        if new.given and guess is not None:
            refuse(f"the link {name!r} turns by {turns}, which leaves its guess without use; leave guess away")
        new.mass = self._constant(mass, "kg", f"{name}_mass", f"mass of {name}")
        new.inertia = self._constant(inertia, "kg*m^2", f"{name}_inertia", f"inertia of {name}")
        new.centre = self._pair(centre, "m", f"centre of {name}", (f"{name}_centre_u", f"{name}_centre_v"))
        self.links.append(new)
        if pose is not None:
            self.pose(**{name: pose})
        return new

    def pose(self, **places: object) -> None:
        """Say roughly how the mechanism stands when assembled, which chooses the side of every loop.

        places: angles of links and values of coordinates [rad, m], also as text with a unit, or places (x, y) of the
        origins of links [m]. It stands before the joints that close.
        """
        letters = {q.name: q for q in self.q}
        for name, value in places.items():
            link = next((k for k in self.links if k.name == name), None)
            if link is None and name not in letters:
                known = ", ".join([*letters, *(k.name for k in self.links)]) or "none"
                refuse(f"the pose names {name!r}, which is no link and no coordinate of {self.name}; there are {known}")
            if link is not None and link.placed:
                refuse(f"the pose of {name} comes after its loop has closed; say it before the joints")
            known_as = str(link.turns) if link is not None and link.turns in self.q else name
            if known_as in self.poses:
                refuse(f"the pose of {known_as} is said twice; say it once")
            if isinstance(value, (tuple, list)) and len(value) == 2 and link is not None:
                x, y = (self._posed(v, "m", f"pose of {name}") for v in value)
                self.poses[name] = x, y
                continue
            unit = "rad" if link is not None else self.units[name]
            self.poses[known_as] = number = self._posed(value, unit, f"pose of {name}")
            if unit == "rad" and abs(number) > _FAR and not (isinstance(value, str) and any(map(str.isalpha, value))):
                refuse(f"the pose of {name} = {value} is in rad; write degrees as '{value} deg'")

    def pin(self, name: str, first: object, second: object, *, branch: int = 0) -> None:
        """Join two points (a link stands for its origin); `branch` 1 or -1 chooses the side of a dyad."""
        self._join(Joint("pin", name, point_of(first), point_of(second), branch))

    def slider(self, name: str, first: object, second: object, *, branch: int = 0) -> None:
        """Let a line of the second slide on a line of the first (a link stands for its own u axis)."""
        self._join(Joint("slider", name, _line(first), _line(second), branch))

    def slot(self, name: str, first: object, second: object, *, branch: int = 0) -> None:
        """Hold a point of one link on a line of the other."""
        pair = [s if isinstance(s, (LinkLine, LinkPoint)) else point_of(s) for s in (first, second)]
        if {type(s) for s in pair} != {LinkLine, LinkPoint}:
            refuse(
                f"the slot {name!r} takes a line of one link and a point of the other; write rocker.line(), crank.at(r)"
            )
        self._join(Joint("slot", name, pair[0], pair[1], branch))

    def gear(self, name: str, first: object, second: object, *, radii: object, inside: bool = False) -> None:
        """Let pitch circles of radii [m] about two points roll; `inside` puts the second within the first (a ring)."""
        if not isinstance(inside, bool):
            refuse(f"inside = {inside!r} of the gear {name!r} must be True or False")
        sizes = self._pair(radii, "m", f"pitch radii of {name}", (f"{name}_r1", f"{name}_r2"))
        above = [r.subs({s: Symbol(s.name, positive=True) for s in r.free_symbols}) for r in sizes]
        if any(r.is_zero or r.is_negative for r in above) or any(self.sizes.get(s, (0,))[-1] < 0 for s in sizes):
            refuse(f"the gear {name!r} has pitch radii {sizes}; both must be above 0, and inside=True makes a ring")
        if inside and sizes[0] == sizes[1]:
            refuse(f"the gear {name!r} has one radius for the ring and for what rolls in it, {sizes[0]}; name two")
        self._join(Joint("gear", name, point_of(first), point_of(second), radii=sizes, inside=inside))

    def _join(self, joint: Joint) -> None:
        joint.where = place()
        self._usable(joint.name)
        for side in (joint.first, joint.second):
            if side.link.m is not self:
                refuse(f"the joint {joint.name!r} takes {side} of {side.link.m.name}; name links of {self.name}")
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

    def _point(self, name: str, value: Expr | float) -> Expr:
        value = self._checked(value, "m", name)
        return value if value.is_Number or value.is_Symbol else self.derived(name, value, "m")

    def settle(self, link: Link | None = None) -> None:
        """Place a link, or all of them (see `Declaration`)."""
        raise NotImplementedError

    def displace(self, joint: Joint) -> tuple[Expr, ...]:
        """Displacements of a joint that places a link; their generalised forces are its reactions."""
        joint.used = True
        if joint.displacements:
            return joint.displacements
        if joint.through:
            one, other = joint.through
            pairs = zip(self.displace(one), self.displace(other), strict=True)
            signs = -one.sign(joint.first.link), other.sign(joint.second.link)
            joint.displacements = tuple(signs[0] * d + signs[1] * e for d, e in pairs)
            one.used = False  # it has yet to place the link between
            return joint.displacements
        parts = _DISPLACED[joint.kind]
        about = f"{joint.first.link.name} on {joint.second.link.name}, {joint.kind} {joint.name}"
        for part in parts:
            unit, stem = ("N*m", "M") if part == "turn" else ("N", f"R_{part}")
            names = (self.free_name(f"{first}_{joint.name}") for first in (f"s{part}", stem))
            displacement = self.joints(next(names), about, unit, next(names))
            joint.displacements += (displacement,)
        return joint.displacements


def point_of(part: object) -> LinkPoint:
    """A point of a link; a link stands for its origin."""
    if isinstance(part, Link):
        return part.at()
    if not isinstance(part, LinkPoint):
        refuse(f"{part!r} is no link and no point of one; write link.at(u, v)")
    return part


def _line(part: object) -> LinkLine:
    if isinstance(part, Link):
        return part.line()
    if not isinstance(part, LinkLine):
        refuse(f"{part!r} is no link and no line of one; write link.line(u, v, angle=..)")
    return part


def named_point(m: Linkage, name: str, pair: Pair) -> Pair:
    """A point of the frame by its names `x_name, y_name`, where it is not a number or a letter."""
    return m._point(f"x_{name}", read(pair[0])), m._point(f"y_{name}", read(pair[1]))

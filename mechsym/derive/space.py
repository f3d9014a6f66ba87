"""Declarations in space: the same language with three coordinates to a point, bodies with axes, joints about them.

    m = Mechanism("gimbal", space=3)
    ring = m.link("ring", mass=m1, centre=(0, 0, a), inertia=(A, A, C))     about its centre, or six numbers
    m.revolute("A", m.frame.axis("z"), ring.axis("x"), turns=phi)           axes coincide, as do their points
    m.spherical("B", ring.at(0, 0, h), rod)                                 a link stands for its origin

At the zero of a joint the bodies' own axes are parallel, or where the joint's axes differ, turned the shortest way from
one to the other. The words of the plane hold too: pins turn about z, sliders and slots lie in x and y. Joints with
coordinates of the user's own, then those with fewer freedoms, make a tree from the frame; the rest closes loops.
"""

from collections.abc import Callable
from functools import partial
from typing import Any, ClassVar

from sympy import Expr, Integer, Rational, Symbol, cos, pi, sin, sqrt

from mechsym.derive import rates
from mechsym.derive import vectors as vec
from mechsym.derive.declare import Declaration
from mechsym.derive.refuse import place, refuse
from mechsym.derive.space_joints import KINDS, hung
from mechsym.derive.space_parts import SpaceJoint, SpaceLink, SpacePoint, three
from mechsym.derive.space_rows import ClosureRow
from mechsym.derive.space_tree import SharedSteps, Tree, about_origin
from mechsym.derive.vectors import AXES, NONE, Matrix, O, Vector


class SpatialDeclaration(Declaration):
    """What a mechanism in space is made of."""

    tape: SharedSteps
    solved_by: ClassVar[Callable[[Any], Any]]  #: Makes the equations, see space_equations.py

    def __init__(self, name: str, source: str = "own", about: str = "", *, space: int = 3) -> None:
        super().__init__(name, source, about)
        self.tape = SharedSteps(lambda text: text in self.units)
        self.tree = Tree(
            self.tape, lambda q: Symbol(f"{q.name}d", real=True), lambda q: Symbol(f"{q.name}dd", real=True)
        )
        self.frame: Any = SpaceLink(self, "frame", part=self.tree.frame, angle=O)
        self.space_links: list[SpaceLink] = []
        self.space_joints: list[SpaceJoint] = []
        self.places: dict[Symbol, tuple[SpacePoint, int]] = {}
        self.by_expression: dict[str, Expr] = {}
        self.own: dict[Symbol, float] = {}  # coordinates that joints have named, with their guesses
        self.norms: dict[str, ClosureRow] = {}
        self.watched: dict[str, Any] = {}
        self.gravity: Any = NONE
        self.words: list[str] = []  # what was decided, for `derive --explain`

    def own_equations(self) -> Any:
        """The equations, by recursions over the tree."""
        return type(self).solved_by(self)

    def explained(self) -> list[str]:
        """How the tree hangs and what closes it, a line each."""
        self.own_equations()
        return self.words

    # what moves

    def link(
        self, name: str, *, turns: Expr | float | None = None, mass: Expr | float = 0, centre: object = (0, 0, 0),
        inertia: object = 0, guess: float | None = None, pose: object = None,
    ) -> Any:  # fmt: skip
        """Add a rigid body.

        mass: [kg]. centre: of mass, in the body's axes [m]. inertia: about the centre of mass, along the body's axes
        [kg*m^2]: three moments, or six numbers (xx, yy, zz, xy, xz, yz) with the products as they stand in the matrix;
        one number is about z, of what only turns about z. turns: its angle about z where it is pinned [rad]. pose,
        guess: that angle, roughly [rad]. Returns link: points `link.at(x, y, z)`, lines `link.axis("x", at=..)`.
        """
        if name == "frame" or any(k.name == name for k in self.space_links):
            refuse(f"the link {name!r} is declared twice in {self.name}; give one of them another name")
        self._usable(name)
        new = SpaceLink(self, name, where=place())
        new.turns = None if turns is None else self._checked(turns, "rad", f"angle of {name}")
        rough = pose if guess is None else guess
        new.guess = None if rough is None else self._posed(rough, "rad", f"pose of {name}")
        new.mass = self._constant(mass, "kg", f"{name}_mass", f"mass of {name}")
        new.centre = self._triple(centre, "m", f"centre of {name}", f"{name}_centre_")
        new.inertia, new.flat = self._inertia(inertia, name)
        (xx, xy, xz), (_, yy, yz), (*_, zz) = new.inertia
        self.tensors[name] = [str(entry) for entry in (xx, yy, zz, xy, xz, yz)]
        self.space_links.append(new)
        return new

    def pose(self, **places: object) -> None:
        """Say roughly how the mechanism stands: angles of pinned links and values of coordinates [rad, m]; other joints
        have a pose= of their own."""
        for name, value in places.items():
            link = next((k for k in self.space_links if k.name == name), None)
            if link is None and name not in {q.name for q in self.q}:
                refuse(f"the pose names {name!r}, which is no link and no coordinate of {self.name}; joints have pose=")
            posed = self._posed(value, "rad" if link else self.units[name], f"pose of {name}")
            if link is None:
                self.poses[name] = posed
            else:
                link.guess = posed

    def _inertia(self, value: object, name: str) -> tuple[Matrix, bool]:
        given = list(value) if isinstance(value, (tuple, list)) else [0, 0, value]
        if len(given) not in (3, 6):
            refuse(f"inertia of {name} has {len(given)} numbers; give three moments, or xx, yy, zz, xy, xz, yz")
        names = [f"{name}_I{a}" for a in ("xx", "yy", "zz", "xy", "xz", "yz")]
        size = [self._constant(v, "kg*m^2", n, f"inertia of {name}") for v, n in zip(given[:3], names, strict=False)]
        more = [self._sized(v, "kg*m^2", n, f"inertia of {name}") for v, n in zip(given[3:], names[3:], strict=False)]
        xy, xz, yz = more or (O, O, O)
        rows = (size[0], xy, xz), (xy, size[1], yz), (xz, yz, size[2])
        return rows, not isinstance(value, (tuple, list)) and size[2] != 0

    def body(self, name: str, **facts: object) -> None:
        """Bodies in space are links."""
        refuse(f"the body {name!r} is in space: write {name} = m.link({name!r}, mass=.., centre=.., inertia=..)")

    def weight(self, x: Expr | float, y: Expr | float, z: Expr | float = 0) -> None:
        """Declare the acceleration of free fall by its components [m/s^2]."""
        self.gravity = self._triple((x, y, z), "m/s^2", "weight", "weight_")

    # joints

    def revolute(self, name: str, first: object, second: object, **how: Any) -> SpaceJoint:
        """Let two bodies turn about a common axis; `turns` is the angle of the second against the first [rad]."""
        return self._joined("revolute", name, first, second, how, ("turns",))

    def prismatic(self, name: str, first: object, second: object, **how: Any) -> SpaceJoint:
        """Let the second slide along a common axis, without turning; `slides` is how far [m]."""
        return self._joined("prismatic", name, first, second, how, ("slides",))

    def cylindrical(self, name: str, first: object, second: object, **how: Any) -> SpaceJoint:
        """Let the second turn about and slide along a common axis, by `turns` [rad] and `slides` [m]."""
        return self._joined("cylindrical", name, first, second, how, ("turns", "slides"))

    def screw(self, name: str, first: object, second: object, *, lead: Expr | float, **how: Any) -> SpaceJoint:
        """Let the second slide by a lead [m] along a common axis with every turn about it."""
        size = self._sized(lead, "m", f"{name}_lead", f"lead of {name}")
        return self._joined("screw", name, first, second, how, ("turns",), lead=size)

    def spherical(self, name: str, first: object, second: object, sequence: str = "", **how: Any) -> SpaceJoint:
        """Let two points meet. Its turn is a quaternion, or angles `turns=(a, b, c)` about axes of a sequence as "zxz"
        that follow one another, which have a pole."""
        return self._joined("spherical", name, first, second, how, ("turns",) * len(sequence), sequence=sequence)

    def universal(self, name: str, first: object, second: object, **how: Any) -> SpaceJoint:
        """Let an axis of the first stay square to one of the second through one point; `turns=(a, b)` about both."""
        return self._joined("universal", name, first, second, how, ("turns", "turns"))

    def planar(self, name: str, first: object, second: object, **how: Any) -> SpaceJoint:
        """Let the second slide and turn on a plane of the first, square to the axis; `moves=(x, y, angle)`."""
        return self._joined("planar", name, first, second, how, ("moves",) * 3)

    def fixed(self, name: str, first: object, second: object, **how: Any) -> SpaceJoint:
        """Join two bodies rigidly."""
        return self._joined("fixed", name, first, second, how, ())

    def free(self, name: str, body: object, **how: Any) -> SpaceJoint:
        """Let a body move freely: the place of its point in the frame, and a quaternion."""
        return self._joined("free", name, self.frame.at(), body, how, ())

    def strut(self, name: str, first: object, second: object, *, length: Expr | float) -> SpaceJoint:
        """Hold two points at a distance [m] by a rod without mass between two spheres."""
        size = self._sized(length, "m", f"{name}_length", f"length of {name}")
        return self._joined("strut", name, first, second, {}, (), length=size)

    def plane(self, name: str, first: object, second: object, **how: Any) -> SpaceJoint:
        """Hold a point of the second on a plane of the first, square to its axis."""
        return self._joined("plane", name, first, second, how, ())

    def pin(self, name: str, first: object, second: object, *, branch: int = 0) -> Any:
        """Join two points by a hinge along z, as in the plane."""
        return self._joined("pin", name, first, second, {"axis": "z"}, ())

    def slider(self, name: str, first: object, second: object, *, branch: int = 0) -> Any:
        """Let a line of the second slide on a line of the first, as in the plane."""
        return self._joined("prismatic", name, first, second, {"axis": "x"}, ())

    def slot(self, name: str, first: object, second: object, *, branch: int = 0) -> Any:
        """Hold a point of one link on a line of the other."""
        one, other = (self._side(s, None, name) for s in (first, second))
        line, point = (one, other) if one.direction is not None or not isinstance(first, SpacePoint) else (other, one)
        return self._joined("slot", name, line, point, {"axis": "x"}, ())

    def gear(self, name: str, first: object, second: object, **how: object) -> None:
        """Gears in space are couplings."""
        refuse(f"the gear {name!r}: couple the angles by turns=, or m.constraint({name!r}, z1 * phi1 + z2 * phi2)")

    def _joined(
        self, kind: str, name: str, first: object, second: object, how: dict[str, Any], takes: tuple[str, ...],
        **more: Any,
    ) -> SpaceJoint:  # fmt: skip
        self._usable(name)
        if known := next((j for j in self.space_joints if j.name == name), None):
            refuse(f"the joint {name!r} has two owners (first at {known.where}); give one another name")
        if unknown := set(how) - {*takes, "axis", "pose", "axes"}:
            can = ", ".join([*dict.fromkeys(takes), "axis", "pose", "axes"])
            refuse(f"{', '.join(sorted(unknown))} is nothing that the {kind} joint {name!r} takes; it takes {can}")
        sides = [self._side(s, how.get("axis"), name) for s in (first, second)]
        if sides[0].link is sides[1].link:
            refuse(f"the joint {name!r} joins {sides[0].link.name} to itself; name two links")
        needs = KINDS[kind].axes
        for side, wanted in zip(sides, needs, strict=True):
            if wanted and side.direction is None:
                refuse(f"the {kind} joint {name!r} needs an axis: axis='z', or {side.link.name}.axis('z', at=..)")
        given: list[Any] = []
        for key in dict.fromkeys(takes):
            value = how.get(key)
            many = value if isinstance(value, (tuple, list)) else (value,)
            given += [] if value is None else [self._checked(v, "", f"{key} of {name}") for v in many]
        if given and len(given) != len(takes):
            refuse(f"the {kind} joint {name!r} has {len(takes)} freedoms ({', '.join(takes)}); name all or none")
        joint = SpaceJoint(kind, name, sides[0], sides[1], tuple(given), how.get("pose"), where=place(), **more)
        joint.axes = how.get("axes") or self.frame
        about = f"{joint.first.link.name} on {joint.second.link.name}, {kind} {name}"
        for reaction, unit in KINDS[kind].reactions(name):
            symbol = self._reaction(reaction, unit)
            self.reaction_of[symbol], self.joint_about[symbol] = symbol, about
        self.space_joints.append(joint)
        return joint

    def _side(self, part: object, axis: object, name: str) -> SpacePoint:
        if isinstance(part, SpaceLink):
            part = part.at()
        if not isinstance(part, SpacePoint):
            refuse(f"{part!r} of the joint {name!r} is no link and no point of one; write link.at(x, y, z)")
        if part.link.m is not self:
            refuse(f"the joint {name!r} takes {part} of {part.link.m.name}; name links of {self.name}")
        if part.direction is None and axis is not None:
            return SpacePoint(part.link, part.at, self._direction(axis))
        return part

    def _direction(self, value: object) -> Vector:
        if isinstance(value, str):
            if value not in AXES:
                refuse(f"{value!r} is no direction; there are {', '.join(AXES)}, or three values")
            return AXES[value]
        exact = (Rational(repr(v)) if isinstance(v, float) else v for v in three(value))
        x, y, z = (self._checked(v, "", "direction") for v in exact)
        return vec.unit((x, y, z), f"the direction {value}")

    # places

    def settle(self, link: Any = None) -> None:
        """Hang a link on the tree, or all of them, by the joints so far."""
        while any(k.part is None for k in self.space_links) and (link is None or link.part is None):
            ready = [j for j in self.space_joints if (j.first.link.part is None) != (j.second.link.part is None)]
            hanging = [j for j in ready if KINDS[j.kind].hangs]
            if not hanging:
                loose = link or next(k for k in self.space_links if k.part is None)
                refuse(
                    f"link {loose.name!r} hangs on nothing that is placed; join it, or m.free('..', link)", loose.where
                )
            self._hang(min(hanging, key=lambda j: (not j.comes_first, KINDS[j.kind].count(j))))

    def _hang(self, joint: SpaceJoint) -> None:
        joint.child = child = joint.second.link if joint.second.link.part is None else joint.first.link
        joint.parts = hung(self, joint, child)
        last = joint.parts[-1]
        last.mass = child.mass
        last.moment, last.inertia = about_origin(child.mass, child.centre, child.inertia)
        child.part = last
        before = joint.first.link if child is joint.second.link else joint.second.link
        named = ", ".join(f.value.name for f in joint.freedoms if f.value.is_Symbol)
        way = f"{child.name} hangs on {before.name} by the {joint.kind} joint {joint.name}"
        self.words.append(f"{way} ({named})" if named else way)

    def freedom(self, stem: str, joint: SpaceJoint, unit: str, guess: float) -> Symbol:
        """A coordinate that a joint names, with where it starts [unit]."""
        symbol = self.coordinates(self.free_name(f"{stem}_{joint.name}"), unit)
        self.own[symbol] = guess
        return symbol

    def placed(self, point: SpacePoint) -> Vector:
        """Names of where a point is; their slopes come from the freedoms before it, not through its rotations."""
        self.settle(point.link)
        known = next((p for p in self.places.values() if p[0].link is point.link and p[0].at == point.at), None)
        if known is not None:
            return tuple(s for s, (p, _) in self.places.items() if p is known[0])
        names = []
        for k, value in enumerate(self.tree.place(point.link.part, point.at)):
            symbol = self.derived(f"{'xyz'[k]}_{point.link.name}", value, "m")
            self.places[symbol] = point, k
            self.tape.follow(symbol, partial(self._slope, point, k))
            names.append(symbol)
        return names[0], names[1], names[2]

    def _slope(self, point: SpacePoint, k: int, v: Symbol) -> Expr:
        part, total = point.link.part, O
        place_ = self.tree.place(part, point.at)
        for one in part.path:
            for column in one.columns:
                if v in column.by:
                    total += column.by[v] * self.tree.column(one, column, place_)[1][k]
        return total

    def watch(self, point: Any, name: str) -> None:
        """Put a point among the outputs under a name of its own, with its motion."""
        point = point.at() if isinstance(point, SpaceLink) else point
        part, at = (self.placed(point), point.link.part)[1], point.at
        moving = self.tree.velocity(part, at), self.tree.acceleration(part, at, True)
        for k, value in enumerate(self.placed(point)):
            rates.output(self, self.let(f"{name}_{'xyz'[k]}", value, "m"), order=0)
            rates.output_dynamic(self, f"{name}_{'xyz'[k]}_d", moving[0][k], "m/s")
            rates.output_dynamic(self, f"{name}_{'xyz'[k]}_dd", moving[1][k], "m/s^2")
        self.watched[name] = point

    def force_at(self, force: Any, point: Any, axes: SpaceLink | None = None) -> None:
        """Add a force vector (x, y, z) [N] at a point of a link, in axes of the frame or of a link."""
        at = point.at() if isinstance(point, SpaceLink) else point
        given = self._triple(force, "N", "force", "force_")
        if axes is not None and axes is not self.frame:
            self.settle(axes)
            given = self.tree.out(axes.part, given)
        for component, coordinate in zip(given, at.xyz, strict=True):
            if component != 0:
                self.force(component, along=coordinate)

    def between(self, first: Any, second: Any) -> Expr:
        """Distance of two points [m], for springs, dampers and forces that push them apart."""
        one, other = (s.at() if isinstance(s, SpaceLink) else s for s in (first, second))
        gap = vec.less(other.xyz, one.xyz)
        return self.derived(f"between_{one.link.name}_{other.link.name}", sqrt(vec.dot(gap, gap)), "m")

    # words

    def _triple(self, value: object, unit: str, what: str, stem: str) -> Vector:
        given = three(value)
        x, y, z = (self._sized(v, unit, f"{stem}{a}", what) for v, a in zip(given, "xyz", strict=True))
        return x, y, z

    def _dimension_of_letter(self, symbol: Symbol) -> Any:
        unknown = symbol in self.tape.entries and symbol not in self.dimensions and symbol.name not in self.units
        return None if unknown and not self.tape.derived_from(symbol)[1] else super()._dimension_of_letter(symbol)

    # drawing

    def draw_drum(self, axis: Any, radius: Expr | float, length: Expr | float, role: str = "piston") -> None:
        """Draw a drum of a radius and a length [m] about an axis of a link, from its point on."""
        n, b = vec.normals(axis.direction)
        r, l = self._checked(radius, "m", "radius of the drum"), self._checked(length, "m", "length of the drum")
        ends = []
        for way in (O, l):
            middle = vec.add(axis.at, vec.scaled(way, axis.direction))
            arms = [vec.add(vec.scaled(cos(k * pi / 6), n), vec.scaled(sin(k * pi / 6), b)) for k in range(12)]
            ends.append([axis.link.at(*vec.add(middle, vec.scaled(r, arm))) for arm in arms])
            self.draw_line(*ends[-1], ends[-1][0], role=role)
        for k in range(0, 12, 3):
            self.draw_line(ends[0][k], ends[1][k], role=role)

    def point_names(self, points: tuple[object, ...]) -> list[list[str]]:
        """Names of the points of a shape as it is seen from one side, and in space."""
        names = []
        for point in points:
            at = point.at() if isinstance(point, SpaceLink) else point
            p = at.xyz if isinstance(at, SpacePoint) else self._triple(at, "m", "point of the drawing", "draw_at_")
            n = len(self.shape_points) // 5
            values = [vec.dot(side, p) for side in VIEW] + [*p]
            keys = [f"draw_{axis}{n}" for axis in ("x", "y", "in_x", "in_y", "in_z")]
            self.shape_points |= {k: self.tape.named(v) for k, v in zip(keys, values, strict=True)}
            names.append(keys)
        return names

    def _shape(self, kind: str, role: str, points: tuple[object, ...], **sizes: object) -> None:
        super()._shape(kind, role, points, **sizes)
        shape = self.shapes[-1]
        shape["space"], shape["points"] = [p[2:] for p in shape["points"]], [p[:2] for p in shape["points"]]

    def _size(self, value: Expr | float) -> str:
        """The name of a size, with a place for each of the five names of a point."""
        name = super()._size(value)
        self.shape_points |= {f"{name}{'_' * k}": self.shape_points[name] for k in range(2, 5)}
        return name


#: Across and up, of a view from the front, from the right and from above
VIEW = ((sqrt(3) / 2, Integer(1) / 2, O), (-Integer(1) / 4, sqrt(3) / 4, sqrt(3) / 2))


Declaration.kinds[3] = SpatialDeclaration

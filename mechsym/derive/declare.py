"""The declaration of a mechanism: it reads like the paper and is built up step by step.

Positions are functions of the coordinates and of joint displacements. A joint displacement enters the closed form
like a coordinate and is held at zero: it gives the relative displacement of the second body against the first, and
its generalised force is the reaction of the first body on the second. Letters and names are in letters.py, links and
joints without algebra in linkage.py, what parts are for in roles.py; what shall come out is said by rates.py.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

from sympy import Expr, Integer

from mechsym.derive import closing, dimensions, rates
from mechsym.derive.drawing import Drawing
from mechsym.derive.elements import Elements
from mechsym.derive.linkage import Link, Linkage, LinkPoint, point_of
from mechsym.derive.refuse import place, refuse


@dataclass(frozen=True, kw_only=True)
class Body:
    """A rigid body: mass at a point, and an inertia that turns.

    Parameters
    ----------
    name : str
        Name of the body
    mass, inertia : Expr
        Mass, and inertia about the centre of mass or, with `about_axis`, about the fixed axis
    at : tuple of Expr
        Centre of mass, (x, y)
    turns : Expr
        Angle, positive from x to y
    about_axis : bool
        Whether the inertia is about a fixed axis that the centre of mass turns round
    """

    name: str
    mass: Expr
    at: tuple[Expr, Expr]
    turns: Expr
    inertia: Expr
    about_axis: bool


@dataclass(frozen=True, kw_only=True)
class Element:
    """A force, spring or damper that acts along a displacement.

    Parameters
    ----------
    value : Expr
        Force or torque, stiffness, or damping
    along : Expr
        The displacement or angle that it works on
    """

    value: Expr
    along: Expr


class Declaration(Linkage, Elements, Drawing):
    """What a mechanism is made of.

    name: name through all stages; source: file stem of the source; about: one line for lists; space: 3 for one that
    moves in space, see space.py.
    """

    kinds: ClassVar[dict[int, type]] = {}

    def __new__(cls, *said: Any, space: int = 2, **named: Any) -> "Declaration":
        """A declaration in the plane, or in space."""
        if space not in (2, 3):
            refuse(f"space = {space!r} has no mechanisms; there are 2 (the plane) and 3")
        return object.__new__(cls.kinds.get(space, cls))

    def __init__(self, name: str, source: str = "own", about: str = "", *, space: int = 2) -> None:
        super().__init__(name, source, about)
        self.bodies: list[Body] = []
        self.springs: list[Element] = []
        self.stores: list[Expr] = []  # energies of springs by their laws
        self.dampers: list[Element] = []
        self.forces: list[Element] = []
        self.constraints: dict[str, Expr] = {}
        self.gravity: tuple[Expr, Expr] = (Integer(0), Integer(0))
        self.given: tuple[list[list[Expr]], list[Expr], list[Expr]] | None = None
        self.watched: dict[str, object] = {}
        self.faces: list[tuple[Any, Expr, Any, Any]] = []
        self.undetermined: list[str] = []  # reactions that joints hold against one another, in space
        self.tensors: dict[str, list[str]] = {}  # inertia of bodies in space: xx, yy, zz, xy, xz, yz
        self.redundant: list[str] = []
        self._start_linkage()
        self._start_roles()
        self._start_drawing()

    def own_equations(self) -> Any:
        """The equations, where the declaration has a way of its own to them."""
        return None

    def explained(self) -> list[str]:
        """How the loops are closed, a line each, in order."""
        closing.finish(self)
        held = [
            f"{letter} is held by constraint, from {self.guesses[letter.name]:g} on" for letter in self.dependent_list
        ]
        return [*map(str, self.sides), *held]

    def advance(self) -> None:
        """Place every link that has a closed form."""
        closing.advance(self)

    def settle(self, link: Link | None = None) -> None:
        """Place a link, or all of them, with dependent coordinates where there is no closed form."""
        closing.settle(self, link)

    def body(
        self,
        name: str,
        *,
        mass: Expr | float = 0,
        at: tuple[Expr | float, Expr | float] = (0, 0),
        turns: Expr | float = 0,
        inertia: Expr | float = 0,
        inertia_about_axis: Expr | float | None = None,
    ) -> None:
        """Add a rigid body.

        name: name of the body; its centre is named `x_name, y_name`. mass: Expr, mass [kg]. at: tuple of Expr, centre
        of mass, (x, y) [m]. turns: Expr, angle, positive from x to y [rad]. inertia: Expr, inertia about the centre of
        mass [kg*m^2]. inertia_about_axis: Expr, optional, inertia about a fixed axis through the origin instead; it
        includes the share of the mass [kg*m^2].
        """
        if any(body.name == name for body in self.bodies):
            refuse(f"the body {name!r} is declared twice in {self.name}; give one of them another name")
        pair = self._pair(at.xy if isinstance(at, LinkPoint) else at, "m", f"centre of {name}")
        x, y = (self._point(f"{axis}_{name}", value) for axis, value in zip("xy", pair, strict=True))
        about_axis = inertia_about_axis is not None
        self._usable(name)
        if about_axis and inertia != 0:
            refuse(f"the body {name!r} has two inertias; give inertia, or inertia_about_axis in its place")
        kept = inertia_about_axis if about_axis else inertia
        self.bodies.append(
            Body(
                name=name,
                mass=self._constant(mass, "kg", f"{name}_mass", f"mass of {name}"),
                at=(x, y),
                turns=self._checked(turns, "rad", f"angle of {name}"),
                inertia=self._constant(kept, "kg*m^2", f"{name}_inertia", f"inertia of {name}"),
                about_axis=about_axis,
            )
        )

    def watch(self, point: object, name: str) -> None:
        """Put a point among the outputs under a name of its own, with its motion.

        point: of a link, or a pair (x, y) [m]. name: before a dot and x or y, with the slope by each coordinate, rate
        (`_d`) and the acceleration (`_dd`); letters of formulas have a low line in place of the dot.
        """
        pair = self._pair(point, "m", f"watched {name}") if isinstance(point, tuple) else point_of(point).xy
        for axis, value in zip("xy", pair, strict=True):
            place = self.let(f"{name}_{axis}", value, "m")
            rates.output(self, place, order=2)
            rates.output_dynamic(self, f"{name}_{axis}_d", rates.velocity(self, place), "m/s")
            rates.output_dynamic(self, f"{name}_{axis}_dd", rates.acceleration(self, place), "m/s^2")
        self.watched[name] = point

    def weight(self, x: Expr | float, y: Expr | float) -> None:
        """Declare the acceleration of free fall by its components [m/s^2]."""
        self.gravity = (
            self._sized(x, "m/s^2", "weight_x", "weight"), self._sized(y, "m/s^2", "weight_y", "weight"),
        )  # fmt: skip

    def force(self, value: Expr | float, *, along: Expr | float) -> None:
        """Add a force [N] along a displacement [m] or a torque [N*m] along an angle [rad], positive where it drives."""
        self.forces.append(self._element(value, along, "force", ("N", "N*m")))

    torque = force

    def force_at(self, force: tuple[Expr | float, Expr | float], point: object) -> None:
        """Add a force vector (x, y) [N] at a point: a pair (x, y) [m] or a point of a link."""
        at = self._pair(point, "m", "point of the force") if isinstance(point, tuple) else point_of(point).xy
        for component, coordinate in zip(self._pair(force, "N", "force"), at, strict=True):
            self.force(component, along=coordinate)

    def spring(self, stiffness: Expr | float, *, stretch: Expr | float) -> None:
        """Add a linear spring of a stiffness [N/m, N*m/rad] by its stretch from the free length or angle."""
        self.springs.append(self._element(stiffness, stretch, "stiffness", ("N/m", "N*m/rad")))

    def damper(self, damping: Expr | float, *, stretch: Expr | float) -> None:
        """Add a viscous damper [N*s/m, N*m*s/rad] on the rate of a displacement."""
        self.dampers.append(self._element(damping, stretch, "damping", ("N*s/m", "N*m*s/rad")))

    def _element(self, value: Expr | float, along: Expr | float, what: str, units: tuple[str, str]) -> Element:
        displacement = Integer(0) if along == 0 and what == "force" else self._moving(along, "displacement")
        kind = self.dimension(displacement)
        straight = kind == self._unit("m")
        if kind not in (None, dimensions.PURE) and not straight:
            refuse(f"{what} acts along {along}, which is in {dimensions.in_words(kind)}; give a length or an angle")
        if kind == dimensions.PURE:
            self._checked(displacement, "rad", "displacement")
        unit = "" if kind is None else units[0 if straight else 1]
        return Element(value=self._sized(value, unit or units[0], what, what), along=displacement)

    def _moving(self, value: Expr | float, what: str) -> Expr:
        """An expression that a coordinate moves."""
        expression = self._checked(value, "", what)
        if not expression.free_symbols & {*self.tape.variables, *self.tape.entries}:
            refuse(f"{what} = {value} moves with no coordinate; there are {', '.join(map(str, self.q)) or 'none'}")
        return expression

    def constraint(self, name: str, value: Expr | float, *, between: str = "", reaction: str = "") -> None:
        """Hold an expression at zero with a multiplier, where the loop cannot be closed in closed form.

        name: name of the constraint; its multiplier is the generalised reaction, an output `force_<name>`. value: Expr
        or tuple of Expr, what vanishes; a pair (x, y), the second body's point less the first's, closes a joint by its
        name. between, reaction: which body acts on which; the reaction, where it is not `R_<name>`, or `R_x_<name>,
        R_y_<name>`.
        """
        self._usable(name)
        pair = self._pair(value, "", f"constraint {name}") if isinstance(value, (tuple, list)) else ()
        parts = {f"x_{name}": pair[0], f"y_{name}": pair[1]} if pair else {name: value}
        for part, vanishing in parts.items():
            if part in self.constraints:
                refuse(
                    f"the joint {name!r} has two owners (first at {self.where['joint ' + part]}); name one otherwise"
                )
            self.constraints[part] = self.tape.named(self._moving(vanishing, f"constraint {part}"))
            self.where[f"joint {part}"] = place()
            if between or isinstance(value, tuple):
                unit = "N" if self.dimension(self.constraints[part]) == self._unit("m") else "N*m"
                self.multiplier_of[part] = self._reaction(reaction or f"R_{part}", unit)
                self.joint_about[self.multiplier_of[part]] = between or f"joint {name}"

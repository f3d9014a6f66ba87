"""The declaration of a mechanism: it reads like the paper and is built up step by step.

Positions are functions of the coordinates and of joint displacements. A joint displacement enters the closed form
like a coordinate and is held at zero: it gives the relative displacement of the second body against the first, and
its generalised force is the reaction of the first body on the second. What shall come out is said by outputs.py;
links and joints without algebra are in linkage.py, what parts are for in roles.py.
"""

from math import inf
from typing import Any

from sympy import Expr, Integer, Symbol

from mechsym.derive import closing, dimensions
from mechsym.derive.elements import Body, Element
from mechsym.derive.letters import Letters
from mechsym.derive.linkage import Link, Linkage
from mechsym.derive.refuse import place, refuse
from mechsym.derive.roles import Roles
from mechsym.derive.tape import Intermediates

_RANGE = ("above", "below", "low", "high", "default")


class Declaration(Letters, Linkage, Roles):
    """What a mechanism is made of.

    Parameters
    ----------
    name : str
        Name through all stages
    source : str
        File stem of the source
    about : str
        One line for lists
    """

    def __init__(self, name: str, source: str = "own", about: str = "") -> None:
        self.name, self.source, self.about = name, source, about
        self.where = {name: place()}
        self.tape = Intermediates()
        self.units: dict[str, str] = {}
        self.dimensions: dict[Symbol, dimensions.Dimension | None] = {}
        self.ranges: dict[str, dict[str, Any]] = {}
        self.q: list[Symbol] = []
        self.dependent_list: list[Symbol] = []
        self.guesses: dict[str, float] = {}
        self.parameter_list: list[Symbol] = []
        self.input_list: list[Symbol] = []
        self.joint_list: list[Symbol] = []
        self.joint_about: dict[Symbol, str] = {}
        self.reaction_of: dict[Symbol, Symbol] = {}
        self.bodies: list[Body] = []
        self.springs: list[Element] = []
        self.dampers: list[Element] = []
        self.forces: list[Element] = []
        self.constraints: dict[str, Expr] = {}
        self.multiplier_of: dict[str, Symbol] = {}
        self.gravity: tuple[Expr, Expr] = (Integer(0), Integer(0))
        self.kinematic_outputs: list[Symbol] = []
        self.dynamic_outputs: dict[str, Expr] = {}
        self.given: tuple[list[list[Expr]], list[Expr], list[Expr]] | None = None
        self._start_linkage()
        self._start_roles()

    def advance(self) -> None:
        """Place every link that has a closed form."""
        closing.advance(self)

    def settle(self, link: Link | None = None) -> None:
        """Place a link, or all of them, with dependent coordinates where there is no closed form."""
        closing.settle(self, link)

    def coordinates(self, names: str, unit: str = "rad") -> Any:
        """Declare generalised coordinates, names separated by spaces; one symbol, or a list in the order given."""
        symbols = self._symbols(names, unit)
        for rate in (f"{s.name}{ending}" for s in symbols for ending in ("d", "dd")):
            if rate in self.units:
                refuse(f"{rate!r} is the name of a rate of the coordinate {rate.rstrip('d')!r}; rename one of them")
        self.q += symbols
        self.tape.variables += symbols
        return _one_or_all(symbols)

    def dependents(self, names: str, unit: str = "rad", *, guess: float = 0.0) -> Any:
        """Declare coordinates that constraints hold.

        Parameters
        ----------
        guess : float
            Where they start, which chooses the branch; `[start]` of a case goes before [rad or m]
        """
        symbols = self.coordinates(names, unit)
        found = symbols if isinstance(symbols, list) else [symbols]
        self.dependent_list += found
        self.guesses |= dict.fromkeys((s.name for s in found), float(guess))
        return symbols

    def parameters(self, names: str, unit: str, *, about: str = "", **bounds: float) -> Any:
        """Declare constants with their range: `above, below, low, high` and a `default`, all in the unit [unit]."""
        if unknown := set(bounds) - set(_RANGE):
            refuse(f"{', '.join(sorted(unknown))} is no bound of a parameter; there are {', '.join(_RANGE)}, about")
        _require_range(names, bounds)
        symbols = self._symbols(names, unit)
        self.parameter_list += symbols
        described = {k: float(v) for k, v in bounds.items()} | ({"about": about} if about else {})
        self.ranges |= {s.name: described for s in symbols if described}
        return _one_or_all(symbols)

    def inputs(self, names: str, unit: str) -> Any:
        """Declare applied forces or torques that the outside world sets."""
        symbols = self._symbols(names, unit)
        self.input_list += symbols
        return _one_or_all(symbols)

    def joints(self, names: str, about: str, unit: str = "N", reactions: str = "") -> Any:
        """Declare joint displacements, held at zero, whose generalised forces are the reactions.

        Parameters
        ----------
        names : str
            Names, separated by spaces
        about : str
            Which body acts on which
        unit : str
            Unit of the reactions
        reactions : str
            Names of the reactions; without them the reaction of `x_A` is `R_x_A`

        Returns
        -------
        symbols : Symbol or list of Symbol
            One symbol, or a list in the order given
        """
        symbols = self._symbols(names, "m" if unit == "N" else "rad")
        self.joint_list += symbols
        self.tape.variables += symbols
        self.joint_about.update(dict.fromkeys(symbols, about))
        names_of = reactions.split() or [f"R_{s.name}" for s in symbols]
        self.reaction_of.update({s: self._reaction(n, unit) for s, n in zip(symbols, names_of, strict=True)})
        return _one_or_all(symbols)

    def _reaction(self, name: str, unit: str) -> Symbol:
        if name in self.units:
            refuse(f"the reaction {name!r} has two owners (first at {self.where[name]}); name one joint otherwise")
        self.units[name], self.where[name] = unit, place()
        return Symbol(name, real=True)

    def let(self, name: str, value: Any, unit: str = "") -> Symbol:
        """Name a physical intermediate; its unit is checked against the expression."""
        self._usable(name)
        expression = self._checked(value, unit, name)
        if name in self.units:
            refuse(f"the name {name!r} is taken (first at {self.where[name]}); give one of them another name")
        symbol = self.tape.define(name, expression)
        self.units[name], self.where[name] = unit, place()
        self.dimensions[symbol] = self._unit(unit) if unit else self.dimension(expression)
        return symbol

    def angle(self, name: str, sine: Any) -> Symbol:
        """Name an angle in (-pi/2, pi/2) that closes a loop, by its sine."""
        symbol = self.tape.define_angle(name, self._checked(sine, "-", f"sine of {name}"))
        self.units[name], self.where[name] = "rad", place()
        self.dimensions[symbol] = dimensions.PURE
        return symbol

    def body(
        self,
        name: str,
        *,
        mass: Any = 0,
        at: tuple[Any, Any] = (0, 0),
        turns: Any = 0,
        inertia: Any = 0,
        inertia_about_axis: Any = None,
    ) -> None:
        """Add a rigid body.

        Parameters
        ----------
        name : str
            Name of the body; its centre is named `x_name, y_name`
        mass : Expr
            Mass [kg]
        at : tuple of Expr
            Centre of mass, (x, y) [m]
        turns : Expr
            Angle, positive from x to y [rad]
        inertia : Expr
            Inertia about the centre of mass [kg*m^2]
        inertia_about_axis : Expr, optional
            Inertia about a fixed axis through the origin instead; it includes the share of the mass [kg*m^2]
        """
        x, y = (self._point(f"{axis}_{name}", value) for axis, value in zip("xy", at, strict=True))
        about_axis = inertia_about_axis is not None
        kept = inertia_about_axis if about_axis else inertia
        self.bodies.append(
            Body(
                name=name,
                mass=self._checked(mass, "kg", f"mass of {name}"),
                at=(x, y),
                turns=self._checked(turns, "rad", f"angle of {name}"),
                inertia=self._checked(kept, "kg*m^2", f"inertia of {name}"),
                about_axis=about_axis,
            )
        )

    def _point(self, name: str, value: Any) -> Expr:
        value = self._checked(value, "m", name)
        return value if value.is_Number or value.is_Symbol else self.let(name, value, "m")

    def weight(self, x: Any, y: Any) -> None:
        """Declare the acceleration of free fall by its components [m/s^2]."""
        self.gravity = (self._checked(x, "m/s^2", "weight"), self._checked(y, "m/s^2", "weight"))

    def force(self, value: Any, *, along: Any) -> None:
        """Add a force [N] along a displacement [m] or a torque [N*m] along an angle [rad], positive where it drives."""
        self.forces.append(self._element(value, along, "force", ("N", "N*m")))

    torque = force

    def force_at(self, force: tuple[Any, Any], point: Any) -> None:
        """Add a force vector (x, y) [N] at a point: a pair (x, y) [m] or a point of a link."""
        for component, coordinate in zip(force, (point if isinstance(point, tuple) else point.xy), strict=True):
            self.force(component, along=coordinate)

    def spring(self, stiffness: Any, *, stretch: Any) -> None:
        """Add a linear spring of a stiffness [N/m, N*m/rad] by its stretch from the free length or angle."""
        self.springs.append(self._element(stiffness, stretch, "stiffness", ("N/m", "N*m/rad")))

    def damper(self, damping: Any, *, stretch: Any) -> None:
        """Add a viscous damper [N*s/m, N*m*s/rad] on the rate of a displacement."""
        self.dampers.append(self._element(damping, stretch, "damping", ("N*s/m", "N*m*s/rad")))

    def _element(self, value: Any, along: Any, what: str, units: tuple[str, str]) -> Element:
        displacement = self._checked(along, "", "displacement")
        found = self.dimension(displacement)
        straight = found == self._unit("m")
        if found not in (None, dimensions.PURE) and not straight:
            refuse(f"{what} acts along {along}, which is in {dimensions.in_words(found)}; give a length or an angle")
        unit = "" if found is None else units[0 if straight else 1]
        return Element(value=self._checked(value, unit, what), along=displacement)

    def constraint(self, name: str, value: Any, *, between: str = "", reaction: str = "") -> None:
        """Hold an expression at zero with a multiplier, where the loop cannot be closed in closed form.

        Parameters
        ----------
        name : str
            Name of the constraint; its multiplier is the generalised reaction, an output `force_<name>`
        value : Expr or tuple of Expr
            What vanishes; a pair (x, y), the second body's point less the first's, closes a joint by its name
        between, reaction : str
            Which body acts on which; the reaction, where it is not `R_<name>`, or `R_x_<name>, R_y_<name>`
        """
        parts = {f"x_{name}": value[0], f"y_{name}": value[1]} if isinstance(value, tuple) else {name: value}
        for part, vanishing in parts.items():
            if part in self.constraints:
                refuse(
                    f"the joint {name!r} has two owners (first at {self.where['joint ' + part]}); name one otherwise"
                )
            self.constraints[part] = self.tape.named(self._checked(vanishing, "", part))
            self.where[f"joint {part}"] = place()
            if between or isinstance(value, tuple):
                unit = "N" if self.dimension(self.constraints[part]) == self._unit("m") else "N*m"
                self.multiplier_of[part] = self._reaction(reaction or f"R_{part}", unit)
                self.joint_about[self.multiplier_of[part]] = between or f"joint {name}"


def _require_range(names: str, bounds: dict[str, float]) -> None:
    """Refuse bounds that leave nothing between them, and a default that they do not allow."""
    least = max(float(bounds[k]) for k in bounds if k in ("above", "low")) if {"above", "low"} & bounds.keys() else -inf
    most = min(float(bounds[k]) for k in bounds if k in ("below", "high")) if {"below", "high"} & bounds.keys() else inf
    if least > most:
        refuse(f"nothing is above {least:g} and below {most:g}; correct the bounds of {names}")
    if "default" in bounds and not least <= float(bounds["default"]) <= most:
        refuse(f"default = {bounds['default']:g} of {names} is outside its bounds; correct one of them")


def _one_or_all(symbols: list[Symbol]) -> Any:
    return symbols[0] if len(symbols) == 1 else symbols

"""The declaration of a mechanism: it reads like the paper and is built up step by step.

Positions are functions of the coordinates and of joint displacements. A joint displacement enters the closed form
like a coordinate and is held at zero: it gives the relative displacement of the second body against the first, and
its generalised force is the reaction of the first body on the second. What shall come out is said by outputs.py.
"""

from sympy import Expr, Integer, Symbol, sympify

from mechsym.derive.elements import Body, Element
from mechsym.derive.tape import Tape


class Mechanism:
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

    def __init__(self, name: str, source: str, about: str = "") -> None:
        self.name, self.source, self.about = name, source, about
        self.tape = Tape()
        self.units: dict[str, str] = {}
        self.q: list[Symbol] = []
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
        self.gravity: tuple[Expr, Expr] = (Integer(0), Integer(0))
        self.kinematic_outputs: list[Symbol] = []
        self.dynamic_outputs: dict[str, Expr] = {}
        self.given: tuple[list[list[Expr]], list[Expr], list[Expr]] | None = None

    def _symbols(self, names: str, unit: str) -> list[Symbol]:
        symbols = [Symbol(n, real=True) for n in names.split()]
        for symbol in symbols:
            if symbol.name in self.units:
                raise ValueError(f"the letter {symbol.name!r} is declared twice in {self.name}")
            self.units[symbol.name] = unit
        return symbols

    def coordinates(self, names: str, unit: str = "rad") -> list[Symbol] | Symbol:
        """Declare generalised coordinates.

        Parameters
        ----------
        names, unit : str
            Names separated by spaces, unit of all of them

        Returns
        -------
        symbols : Symbol or list of Symbol
            One symbol, or a list in the order given
        """
        symbols = self._symbols(names, unit)
        self.q += symbols
        self.tape.variables += symbols
        return _one_or_all(symbols)

    def parameters(self, names: str, unit: str) -> list[Symbol] | Symbol:
        """Declare constants.

        Parameters
        ----------
        names, unit : str
            Names separated by spaces, unit of all of them

        Returns
        -------
        symbols : Symbol or list of Symbol
            One symbol, or a list in the order given
        """
        symbols = self._symbols(names, unit)
        self.parameter_list += symbols
        return _one_or_all(symbols)

    def inputs(self, names: str, unit: str) -> list[Symbol] | Symbol:
        """Declare applied forces or torques that the outside world sets.

        Parameters
        ----------
        names, unit : str
            Names separated by spaces, unit of all of them

        Returns
        -------
        symbols : Symbol or list of Symbol
            One symbol, or a list in the order given
        """
        symbols = self._symbols(names, unit)
        self.input_list += symbols
        return _one_or_all(symbols)

    def joints(self, names: str, about: str, unit: str = "N", reactions: str = "") -> list[Symbol] | Symbol:
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
        self.reaction_of.update({s: Symbol(n, real=True) for s, n in zip(symbols, names_of, strict=True)})
        self.units.update(dict.fromkeys(names_of, unit))
        return _one_or_all(symbols)

    def let(self, name: str, value: Expr, unit: str = "") -> Symbol:
        """Name a physical intermediate.

        Parameters
        ----------
        name : str
            A new identifier
        value : Expr
            Its expression
        unit : str
            Its unit, for listings

        Returns
        -------
        symbol : Symbol
            The name as a symbol
        """
        self.units[name] = unit
        return self.tape.define(name, value)

    def angle(self, name: str, sine: Expr) -> Symbol:
        """Name an angle in (-pi/2, pi/2) that closes a loop, by its sine.

        Parameters
        ----------
        name : str
            A new identifier
        sine : Expr
            Sine of the angle

        Returns
        -------
        symbol : Symbol
            The angle
        """
        self.units[name] = "rad"
        return self.tape.define_angle(name, sine)

    def body(
        self,
        name: str,
        *,
        mass: Expr = 0,
        at: tuple[Expr, Expr] = (0, 0),
        turns: Expr = 0,
        inertia: Expr = 0,
        inertia_about_axis: Expr | None = None,
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
            Inertia about a fixed axis through the origin instead; it includes the share of the mass
        """
        x, y = (self._point(f"{axis}_{name}", value) for axis, value in zip("xy", at, strict=True))
        about_axis = inertia_about_axis is not None
        self.bodies.append(
            Body(
                name=name,
                mass=sympify(mass),
                at=(x, y),
                turns=sympify(turns),
                inertia=sympify(inertia_about_axis if about_axis else inertia),
                about_axis=about_axis,
            )
        )

    def _point(self, name: str, value: Expr) -> Expr:
        value = sympify(value)
        return value if value.is_Number or value.is_Symbol else self.let(name, value, "m")

    def weight(self, x: Expr, y: Expr) -> None:
        """Declare the acceleration of free fall.

        Parameters
        ----------
        x, y : Expr
            Components [m/s^2]
        """
        self.gravity = (sympify(x), sympify(y))

    def force(self, value: Expr, *, along: Expr) -> None:
        """Add a force that works on a displacement.

        Parameters
        ----------
        value : Expr
            Force [N]
        along : Expr
            Displacement, positive where the force does positive work [m]
        """
        self.forces.append(Element(value=sympify(value), along=sympify(along)))

    torque = force

    def force_at(self, force: tuple[Expr, Expr], point: tuple[Expr, Expr]) -> None:
        """Add a force vector at a point.

        Parameters
        ----------
        force : tuple of Expr
            Components (x, y) [N]
        point : tuple of Expr
            Position (x, y) [m]
        """
        for component, coordinate in zip(force, point, strict=True):
            self.force(component, along=coordinate)

    def spring(self, stiffness: Expr, *, stretch: Expr) -> None:
        """Add a linear spring.

        Parameters
        ----------
        stiffness : Expr
            Stiffness [N/m] or [N*m/rad]
        stretch : Expr
            Stretch from the free length or angle
        """
        self.springs.append(Element(value=sympify(stiffness), along=sympify(stretch)))

    def damper(self, damping: Expr, *, stretch: Expr) -> None:
        """Add a viscous damper.

        Parameters
        ----------
        damping : Expr
            Damping [N*s/m] or [N*m*s/rad]
        stretch : Expr
            Displacement whose rate is damped
        """
        self.dampers.append(Element(value=sympify(damping), along=sympify(stretch)))

    def constraint(self, name: str, value: Expr) -> None:
        """Hold an expression at zero with a multiplier, where the loop cannot be closed in closed form.

        Parameters
        ----------
        name : str
            Name of the constraint; its multiplier is the generalised reaction
        value : Expr
            Expression in the coordinates that vanishes
        """
        self.constraints[name] = self.tape.named(sympify(value))


def _one_or_all(symbols: list[Symbol]) -> list[Symbol] | Symbol:
    return symbols[0] if len(symbols) == 1 else symbols

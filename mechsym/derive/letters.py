"""Letters of a declaration with their units, and the check of every expression that is made of them."""

import keyword
import unicodedata
from collections.abc import Iterable
from math import inf, isfinite

from sympy import Expr, Float, Integer, Symbol, cos, nan, oo, pi, sin, tan, zoo

from mechsym.derive.dimensions import PURE, Dimension, dimension_of, in_words, of_unit
from mechsym.derive.printer import UnsupportedNode, read, require_known
from mechsym.derive.refuse import place, refuse
from mechsym.derive.tape import Intermediates
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.quantities.units import parse, scale

_RANGE = ("above", "below", "low", "high", "default")


class Letters:
    """The part of a declaration that knows its letters."""

    def __init__(self, name: str, source: str = "own", about: str = "") -> None:
        if not isinstance(name, str) or not name:
            refuse(f"{name!r} names no mechanism; write Mechanism('press', about='..')")
        if not name.isidentifier() or keyword.iskeyword(name):
            refuse(f"{name!r} is not a usable name of a mechanism; use letters, digits and inner underscores")
        self.name, self.source, self.about = name, source, str(about)
        self.where = {name: place()}
        self.tape = Intermediates()
        self.units: dict[str, str] = {}
        self.dimensions: dict[Symbol, Dimension | None] = {}
        self.ranges: dict[str, Json] = {}
        self.q: list[Symbol] = []
        self.dependent_list: list[Symbol] = []
        self.derived_list: list[Symbol] = []  # named by links and joints
        self.guesses: dict[str, float] = {}
        self.parameter_list: list[Symbol] = []
        self.input_list: list[Symbol] = []
        self.joint_list: list[Symbol] = []
        self.joint_about: dict[Symbol, str] = {}
        self.reaction_of: dict[Symbol, Symbol] = {}
        self.multiplier_of: dict[str, Symbol] = {}
        self.sizes: dict[Symbol, tuple[str, str, float]] = {}  # letters that numbers with units have made
        self.kinematic_outputs: list[Symbol] = []
        self.dynamic_outputs: dict[str, Expr] = {}

    def coordinates(self, names: str, unit: str = "rad") -> Symbol | list[Symbol]:
        """Declare generalised coordinates, names separated by spaces; one symbol, or a list in the order given."""
        symbols = self._symbols(names, unit)
        if "t" in {s.name for s in symbols}:
            refuse("'t' is the time of every run; give the coordinate another name")
        for rate in (f"{s.name}{ending}" for s in symbols for ending in ("d", "dd")):
            if rate in self.units:
                refuse(f"{rate!r} is the name of a rate of the coordinate {rate.rstrip('d')!r}; rename one of them")
        self.q += symbols
        self.tape.variables += symbols
        return _one_or_all(symbols)

    def dependents(self, names: str, unit: str = "rad", *, guess: float = 0.0) -> Symbol | list[Symbol]:
        """Declare coordinates that constraints hold.

        guess: where they start, which chooses the branch; `[start]` of a case goes before [rad or m].
        """
        symbols = self.coordinates(names, unit)
        held = symbols if isinstance(symbols, list) else [symbols]
        self.dependent_list += held
        self.guesses |= dict.fromkeys((s.name for s in held), self._number(guess, f"guess of {names}"))
        return symbols

    def parameters(self, names: str, unit: str, *, about: str = "", **bounds: float) -> Symbol | list[Symbol]:
        """Declare constants with their range: `above, below, low, high` and a `default`, all in the unit [unit]."""
        if unknown := set(bounds) - set(_RANGE):
            refuse(f"{', '.join(sorted(unknown))} is no bound of a parameter; there are {', '.join(_RANGE)}, about")
        described: Json = {k: self._posed(v, unit, f"{k} of {names}") for k, v in bounds.items()}
        least = max((v for k, v in described.items() if k in ("above", "low")), default=-inf)
        most = min((v for k, v in described.items() if k in ("below", "high")), default=inf)
        if least > most:
            refuse(f"nothing is above {least:g} and below {most:g}; correct the bounds of {names}")
        if not least <= described.get("default", least) <= most:
            refuse(f"default = {described['default']:g} of {names} is outside its bounds; correct one of them")
        symbols = self._symbols(names, unit)
        self.parameter_list += symbols
        described |= {"about": str(about)} if about else {}
        self.ranges |= {s.name: described for s in symbols if described}
        return _one_or_all(symbols)

    def inputs(self, names: str, unit: str) -> Symbol | list[Symbol]:
        """Declare applied forces or torques that the outside world sets."""
        symbols = self._symbols(names, unit)
        self.input_list += symbols
        return _one_or_all(symbols)

    def joints(self, names: str, about: str, unit: str = "N", reactions: str = "") -> Symbol | list[Symbol]:
        """Declare joint displacements, held at zero, whose generalised forces are the reactions.

        names: names, separated by spaces. about: which body acts on which. reactions: names of the reactions; without
        them the reaction of `x_A` is `R_x_A`. Returns symbols: Symbol or list of Symbol, one symbol, or a list in the
        order given.
        """
        if unit not in ("N", "N*m"):
            refuse(f"a reaction is in N or N*m, not in {unit!r}")
        symbols = self._symbols(names, "m" if unit == "N" else "rad")
        self.joint_list += symbols
        self.tape.variables += symbols
        self.joint_about.update(dict.fromkeys(symbols, about))
        names_of = reactions.split() or [f"R_{s.name}" for s in symbols]
        if len(names_of) != len(symbols):
            refuse(f"joints {names!r} have {len(symbols)} reactions; {reactions!r} names {len(names_of)}: name each")
        self.reaction_of.update({s: self._reaction(n, unit) for s, n in zip(symbols, names_of, strict=True)})
        return _one_or_all(symbols)

    def _reaction(self, name: str, unit: str) -> Symbol:
        if name in self.units:
            refuse(f"the reaction {name!r} has two owners{self._first(name)}; name one joint otherwise")
        self.units[name], self.where[name] = unit, place()
        return Symbol(name, real=True)

    def let(self, name: str, value: Expr | float, unit: str = "") -> Symbol:
        """Name a physical intermediate; its unit is checked against the expression."""
        dimension = self._unit(unit) if unit != "" else None
        expression = self._checked(value, unit, str(name))
        if known := next((s for s in self.derived_list if s.name == name and s == expression), None):
            return known  # the place of a joint under its own name
        self._take(name, unit)
        symbol = self.tape.define(name, expression)
        self.dimensions[symbol] = dimension or self.dimension(expression)
        return symbol

    def derived(self, name: str, value: Expr | float, unit: str) -> Symbol:
        """Name what a link or a joint needs; letters of the declaration go before it."""
        self.derived_list.append(self.let(self.free_name(name), value, unit))
        return self.derived_list[-1]

    def free_name(self, name: str) -> str:
        """A name for what a link or a joint needs, with `_` behind it where the declaration has taken it."""
        known = {*self.units, *(s.name for s in self.tape.entries)}
        while known & {name, f"sin_{name}", f"cos_{name}"}:
            name += "_"
        return name

    def angle(self, name: str, sine: Expr | float) -> Symbol:
        """Name an angle in (-pi/2, pi/2) that closes a loop, by its sine."""
        expression = self._checked(sine, "-", f"sine of {name}")
        if expression.is_number and not -1 < expression < 1:
            refuse(f"sine of {name} = {sine} is that of no angle; it lies between -1 and 1")
        self._take(name, "rad", f"sin_{name}", f"cos_{name}")
        symbol = self.tape.define_angle(name, expression)
        self.dimensions[symbol] = PURE
        return symbol

    def _symbols(self, names: str, unit: str) -> list[Symbol]:
        if not isinstance(names, str) or not names.split():
            refuse(f"{names!r} names no letter; write names divided by spaces: m.parameters('r l', 'm')")
        symbols = [Symbol(n, real=True) for n in names.split()]
        for symbol in symbols:
            name = symbol.name
            if name in self.units:
                why = f"the letter {name!r} is declared twice in {self.name}{self._first(name)}"
                refuse(f"{why}; give one of them another name")
            self._usable(name)
            self.units[name], self.where[name] = unit, place()
            dimension = self._unit(unit)
            self.dimensions[symbol] = dimension
            if scale(unit) != 1:
                si = "rad or -" if dimension == PURE else in_words(dimension)
                why = f"{name!r} is in {unit}, and letters are in SI: write {si!r}"
                refuse(f"{why}; values in a case may have any unit")
        return symbols

    def _take(self, name: str, unit: str, *parts: str) -> None:
        """Take a name for what is derived, and those of its parts, with its unit and the line that asks for it."""
        self._usable(name)
        known = {*self.units, *(s.name for s in self.tape.entries)}
        if taken := next((n for n in (name, *parts) if n in known), None):
            why = "links and joints name what they need, as angle_LINK, x_JOINT"
            refuse(f"the name {taken!r} is taken{self._first(taken)}; give one of them another name ({why})")
        self.units[name], self.where[name] = unit, place()

    def _first(self, name: str) -> str:
        return f" (first at {self.where[name]})" if name in self.where else ""

    def _usable(self, name: str) -> None:
        if not isinstance(name, str) or not name.isidentifier() or name.startswith("_"):
            refuse(f"{name!r} is not a usable name; use letters, digits and inner underscores")
        if keyword.iskeyword(name) or name == "ca":  # as which the derived code knows CasADi
            refuse(f"{name!r} has a meaning in the derived code; write {name}_")
        if (plain := unicodedata.normalize("NFKC", name)) != name:
            refuse(f"Python reads {name!r} as {plain!r}; write that")
        for q in self.q:
            if name in (f"{q.name}d", f"{q.name}dd"):
                refuse(f"{name!r} is the name of a rate of the coordinate {q.name!r}; take another")

    def _unit(self, unit: str) -> Dimension:
        if not isinstance(unit, str):
            refuse(f"the unit {unit!r} is no text; write for example 'm', 'kg*m^2', or '-' for a pure number")
        try:
            return of_unit(unit)
        except ValueError as error:
            refuse(str(error))

    def dimension(self, expression: Expr) -> Dimension | None:
        """Dimension of an expression; unknown letters and sums of unlike terms are refused."""
        known = {s: self._dimension_of_letter(s) for s in expression.free_symbols}
        return dimension_of(expression, known)

    def _dimension_of_letter(self, symbol: Symbol) -> Dimension | None:
        if symbol in self.dimensions:
            return self.dimensions[symbol]
        root, by = self.tape.derived_from(symbol)
        if by:
            below = [self.dimensions[v] or PURE for v in by]
            above = self._dimension_of_letter(root)
            return None if above is None else tuple(a - sum(powers) for a, *powers in zip(above, *below, strict=True))
        for q in self.q:
            for order, ending in enumerate(("d", "dd"), 1):
                if symbol.name == q.name + ending:
                    kg, metre, second, kelvin = self.dimensions[q] or PURE
                    return kg, metre, second - order, kelvin
        if symbol in self.reaction_of.values() or symbol in self.multiplier_of.values():
            return of_unit(self.units[symbol.name])
        if symbol in self.tape.entries:
            return PURE if symbol.name.startswith(("sin_", "cos_")) else None
        if symbol.name in self.units:
            refuse(f"{symbol.name!r} is not the letter of that name; write the letter itself, no text and no Symbol")
        refuse(f"the letter {symbol.name!r} is not declared in {self.name}; declare it before it is used")

    def _checked(self, value: Expr | float, unit: str, what: str) -> Expr:
        try:
            expression = None if isinstance(value, bool) else read(value)
        except UnsupportedNode:
            expression = None
        if not isinstance(expression, Expr):
            refuse(f"{what} = {value!r} is no expression; write one in letters of {self.name}, no text")
        if expression.has(nan, zoo, oo, -oo):
            refuse(f"{what} = {value} is not finite; something is divided by zero")
        if expression.has(Float):
            number = min(expression.atoms(Float), key=str)
            why = f"{what} = {value} holds the floating-point number {number:.6g}, which would be rounded"
            refuse(f"{why}; write Rational(1, 2), pi / 2, or make it a parameter")
        try:
            require_known(expression)
        except UnsupportedNode as error:
            refuse(f"{what} = {value}: {error}")
        dimension = self.dimension(expression)
        if unit and dimension is not None and dimension != self._unit(unit):
            refuse(f"{what} = {value} is in {in_words(dimension)}, and must be in {unit}")
        angles = {f.args[0] for f in expression.atoms(sin, cos, tan)} | ({expression} if unit == "rad" else set())
        for number in (angle.as_coeff_Add()[0] for angle in angles):
            if abs(number) > 2 * pi and number.is_Rational:
                refuse(f"{what} = {value} turns by {number} rad; write degrees as {number} * pi / 180")
        return expression

    def _sized(self, value: object, unit: str, name: str, what: str) -> Expr:
        """An expression, or the letter that a number with a unit makes: a parameter of that default value."""
        whole = isinstance(value, int) and not isinstance(value, bool) and self._unit(unit) != PURE
        if not (isinstance(value, (str, float)) or whole) or value == 0:
            return self._checked(Integer(0) if isinstance(value, float) else value, unit, what)
        number = self._posed(value, unit, what)
        letter = next((s for s, of in self.sizes.items() if of == (name, unit, number)), None)
        if letter is None:
            more = sum(of[0] == name for of in self.sizes.values())
            letter = self.parameters(self.free_name(f"{name}{more + 1}" if more else name), unit, default=number)
            self.sizes[letter] = name, unit, number
        return letter

    def _posed(self, value: object, unit: str, what: str) -> float:
        """A number in SI, also from a text with a unit."""
        if not isinstance(value, str):
            return self._number(value, what)
        try:
            return parse(value, unit, what)
        except BadInput as error:
            refuse(str(error))

    def _constant(self, value: Expr | float | str, unit: str, name: str, what: str) -> Expr:
        """A mass or an inertia: of parameters alone, and not below zero whatever values they have."""
        expression = self._sized(value, unit, name, what)
        if expression in self.sizes and self.sizes[expression][2] < 0:
            refuse(f"{what} = {value} is below zero; write it with the other sign")
        if moving := expression.free_symbols & {*self.tape.variables, *self.tape.entries}:
            refuse(
                f"{what} = {value} changes with {', '.join(sorted(map(str, moving)))}; that of a rigid body does not"
            )
        if expression.subs({s: Symbol(s.name, positive=True) for s in expression.free_symbols}).is_negative:
            refuse(f"{what} = {value} is below zero; write it with the other sign")
        return expression

    def _pair(self, value: object, unit: str, what: str, names: tuple[str, str] | None = None) -> tuple[Expr, Expr]:
        """Two expressions, along x and y or u and v; names: of the letters that numbers with units make."""
        if not isinstance(value, (tuple, list)) or len(value) != 2:
            refuse(f"{what} = {value!r} is no pair; mechanisms are planar: write two values (x, y)")
        if names is None:
            first, second = (self._checked(v, unit, what) for v in value)
        else:
            first, second = (self._sized(v, unit, n, what) for v, n in zip(value, names, strict=True))
        return first, second

    def _number(self, value: Expr | float, what: str) -> float:
        """A finite number, which no letter is."""
        try:
            number = nan if isinstance(value, bool) else float(value)
        except (TypeError, ValueError):
            number = nan
        if not isfinite(number):
            refuse(f"{what} = {value!r} is no number; write one in SI, with any unit in the case")
        return number

    def _size_of(self, value: Expr | float, unit: str, what: str, moving: tuple[Symbol, ...] = ()) -> str:
        """An expression of parameters, and of coordinates where they may move it, as text."""
        expression = self._checked(value, unit, what)
        while names := (expression.free_symbols & self.tape.entries.keys()) - {*moving}:
            expression = expression.xreplace({name: self.tape.entries[name] for name in names})
        if other := expression.free_symbols - {*self.parameter_list, *moving}:
            refuse(f"the {what} = {value} takes {listed(sorted(other, key=str))}; write it in parameters")
        return str(expression)

    def _sizes(self, what: str, **sizes: tuple[Expr | float | None, str]) -> dict[str, str]:
        """Sizes of a role that are named, with their units."""
        return {
            name: self._size_of(value, unit, f"{name} of {what}")
            for name, (value, unit) in sizes.items()
            if value is not None
        }


def _one_or_all(symbols: list[Symbol]) -> Symbol | list[Symbol]:
    return symbols[0] if len(symbols) == 1 else symbols


def listed(symbols: Iterable[Symbol]) -> str:
    """Letters in words, `none` where there are none."""
    return ", ".join(map(str, symbols)) or "none"

"""Named intermediates and their named derivatives.

A tape is an ordered list of assignments `name = expression` in earlier names, coordinates and parameters. A derivative
of a name is itself a name, made once on first use: the second derivative of `x` by `phi` is `d2x_dphi2`. The sine and
cosine of a coordinate or of a named angle are names too (`sin_phi`, `cos_phi`), so that everything stays polynomial
in them and no derivative is ever expanded into trigonometric functions.
"""

from collections.abc import Callable, Iterable

from sympy import Expr, Float, Integer, Symbol, asin, atan2, cos, cse, numbered_symbols, sin, sqrt

from mechsym.derive.printer import read

Rule = Callable[[Symbol], Expr]


class Intermediates:
    """Ordered assignments with derivatives by the chain rule.

    coordinates: what intermediates are differentiated by and may take sine and cosine of.
    """

    def __init__(self, coordinates: Iterable[Symbol] = ()) -> None:
        self.variables = list(coordinates)
        self.entries: dict[Symbol, Expr] = {}
        self._rules: dict[Symbol, Rule] = {}
        self._derived_from: dict[Symbol, tuple[Symbol, tuple[Symbol, ...]]] = {}
        self._derivatives: dict[tuple[Symbol, Symbol], Expr] = {}
        # every joint asks for the same ones again
        self._totals: dict[tuple[Expr, Symbol], Expr] = {}
        self.curvatures: dict[Expr, Expr] = {}

    def define(self, name: str, value: Expr | int) -> Symbol:
        """Put `name = value` on the tape.

        name: a new identifier. value: expression in earlier names, coordinates and parameters; no floating-point
        numbers.

        Raises
        ------
        ValueError
            The name is taken, is not an identifier, or the value holds a Float
        """
        symbol, expression = Symbol(name, real=True), self.named(read(value))
        if not name.isidentifier() or name.startswith("_"):
            raise ValueError(f"{name!r} is not a usable name; use letters, digits and inner underscores")
        if symbol in self.entries or symbol in self.variables:
            raise ValueError(f"the name {name!r} is taken; give the new intermediate another one")
        if expression.has(Float):
            raise ValueError(f"{name} holds a floating-point number; write a Rational or make it a parameter")
        self.entries[symbol] = expression
        self._forget()
        return symbol

    def _forget(self) -> None:
        self._totals.clear()
        self.curvatures.clear()

    def define_angle(self, name: str, sine: Expr) -> Symbol:
        """Put an angle in (-pi/2, pi/2) on the tape by its sine, with its cosine as a name of its own.

        name: name of the angle; `sin_name` and `cos_name` are defined with it.
        """
        s = self.define(f"sin_{name}", sine)
        c = self.define(f"cos_{name}", sqrt(1 - s**2))
        angle = self.define(name, asin(s))
        self._rules[angle] = lambda v: self.derivative(s, v) / c
        self._rules[c] = lambda v: -s * self.derivative(angle, v)
        return angle

    def define_direction(self, name: str, cosine: Expr, sine: Expr) -> Symbol:
        """Put an angle on the tape by its cosine and sine, of which one follows from the other.

        name: name of the angle; `sin_name` and `cos_name` are defined with it. cosine, sine: their squares add up to 1,
        displaced joints included.
        """
        c, s = self.define(f"cos_{name}", cosine), self.define(f"sin_{name}", sine)
        values = self.entries[c], self.entries[s]
        angle = self.define(name, atan2(s, c))
        self._rules[angle] = lambda v: c * self.diff(values[1], v) - s * self.diff(values[0], v)
        self._rules[s] = lambda v: c * self.derivative(angle, v)
        self._rules[c] = lambda v: -s * self.derivative(angle, v)
        return angle

    def define_turn(self, name: str, value: Expr, x: Expr, y: Expr) -> Symbol:
        """Put the turn of a line on the tape: `value` where joints are held, rates from the line's ends.

        name: name of the angle; value: its value, without the jumps of an arc tangent; x, y: the line from end to end.
        """
        ends = self.named(x), self.named(y)
        angle = self.define(name, value)
        square = ends[0] ** 2 + ends[1] ** 2
        self._rules[angle] = lambda v: (ends[0] * self.diff(ends[1], v) - ends[1] * self.diff(ends[0], v)) / square
        return angle

    def follow(self, symbol: Symbol, rule: Rule) -> None:
        """Let a name have its derivative by a rule in place of its expression's."""
        self._rules[symbol] = rule
        self._forget()

    def named(self, expression: Expr) -> Expr:
        """Replace sine and cosine of single names by the tape's names for them. expression: any expression."""
        functions = sorted(expression.atoms(sin, cos), key=str)
        return expression.xreplace({f: self._circular(f) for f in functions})

    def _circular(self, function: Expr) -> Expr:
        angle = function.args[0]
        if angle not in self.entries and angle not in self.variables:
            return function
        s, c = (Symbol(f"{f}_{angle.name}", real=True) for f in ("sin", "cos"))
        if s not in self.entries:
            self.entries[s], self.entries[c] = sin(angle), cos(angle)
            self._rules[s] = lambda v: c * self.derivative(angle, v)
            self._rules[c] = lambda v: -s * self.derivative(angle, v)
        return s if isinstance(function, sin) else c

    def diff(self, expression: Expr, variable: Symbol) -> Expr:
        """Total derivative of an expression in names.

        expression: expression in names, coordinates and parameters; variable: coordinate or joint displacement. Returns
        derivative: expression in names, among them new named derivatives.
        """
        if (expression, variable) in self._totals:
            return self._totals[expression, variable]
        named = self.named(expression)
        symbols = sorted(named.free_symbols, key=lambda s: s.name)
        total = sum((named.diff(s) * self.derivative(s, variable) for s in symbols), Integer(0))
        self._totals[expression, variable] = total
        return total

    def derivative(self, symbol: Symbol, variable: Symbol) -> Expr:
        """Derivative of one name, itself a name unless it is a number or a single symbol.

        symbol: a name, coordinate or parameter; variable: coordinate or joint displacement. Returns derivative: usually
        a symbol such as `dx_dphi`.
        """
        if symbol == variable:
            return Integer(1)
        if symbol not in self.entries:
            return Integer(0)
        if (symbol, variable) not in self._derivatives:
            self._derivatives[symbol, variable] = self._make_derivative(symbol, variable)
        return self._derivatives[symbol, variable]

    def _make_derivative(self, symbol: Symbol, variable: Symbol) -> Expr:
        rule = self._rules.get(symbol)
        value = rule(variable) if rule else self.diff(self.entries[symbol], variable)
        if value.is_Number or value.is_Symbol or (-value).is_Symbol:
            return value
        return self.name_derivative(symbol, variable, value)

    def name_derivative(self, symbol: Symbol, variable: Symbol, value: Expr) -> Symbol:
        """Put a derivative on the tape by its own name, for example `dx_dphi`."""
        root, by = self.derived_from(symbol)
        by = tuple(sorted([*by, variable], key=self.variables.index))
        name = Symbol(derivative_name(root.name, [v.name for v in by]), real=True)
        if name not in self.entries:
            self.entries[name] = value
            self._derived_from[name] = (root, by)
        return name

    def common(self, expressions: list[Expr]) -> tuple[list[tuple[Symbol, Expr]], list[Expr]]:
        """Repeated terms of expressions, named `_t0, _t1, ...`, and the expressions in them."""
        return cse(expressions, numbered_symbols("_t"), order="canonical")

    def derived_from(self, symbol: Symbol) -> tuple[Symbol, tuple[Symbol, ...]]:
        """What a name is the derivative of, and by which variables.

        symbol: any name. Returns root: the name itself when it is no derivative; by: variables with repetition, empty
        when it is no derivative.
        """
        return self._derived_from.get(symbol, (symbol, ()))

    def flat(self, expression: Expr) -> Expr:
        """The expression in coordinates and parameters: every name replaced by its definition."""
        values: dict[Symbol, Expr] = {}
        for symbol in self.needed([expression]):
            values[symbol] = self.entries[symbol].xreplace(values)
        return expression.xreplace(values)

    def needed(self, expressions: Iterable[Expr]) -> list[Symbol]:
        """Names that the expressions depend on, each after what it uses."""
        done: dict[Symbol, None] = {}

        def visit(expression: Expr) -> None:
            for symbol in sorted(expression.free_symbols & self.entries.keys(), key=lambda s: s.name):
                if symbol not in done:
                    visit(self.entries[symbol])
                    done[symbol] = None

        for expression in expressions:
            visit(expression)
        return list(done)


def derivative_name(root: str, by: list[str]) -> str:
    """Name of a derivative: `dx_dphi`, `d2x_dphi2`, and `d2x0_dphi0_dphi0` where a letter ends in a digit.

    root: what is differentiated; by: what it is differentiated by, with repetition. Returns name: an identifier.
    """
    order = len(by)
    head = f"d{root}" if order == 1 else f"d{order}{root}"
    if len(set(by)) == 1 and order > 1 and not by[0][-1].isdigit():
        return f"{head}_d{by[0]}{order}"
    return "_".join([head, *(f"d{v}" for v in by)])

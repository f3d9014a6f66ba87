"""Letters of a declaration with their units, and the check of every expression that is made of them."""

import keyword
import unicodedata
from typing import Any

from sympy import Expr, Float, Symbol, nan, oo, sympify, zoo

from mechsym.derive.dimensions import PURE, Dimension, dimension_of, in_words, of_unit
from mechsym.derive.refuse import place, refuse
from mechsym.derive.tape import Intermediates
from mechsym.quantities.units import scale


class Letters:
    """The part of a declaration that knows its letters."""

    name: str
    tape: Intermediates
    q: list[Symbol]
    units: dict[str, str]
    where: dict[str, str]
    dimensions: dict[Symbol, Dimension | None]
    reaction_of: dict[Symbol, Symbol]
    multiplier_of: dict[str, Symbol]

    def _symbols(self, names: str, unit: str) -> list[Symbol]:
        symbols = [Symbol(n, real=True) for n in names.split()]
        if not symbols:
            refuse("no letter is named; write for example m.parameters('r l', 'm')")
        for symbol in symbols:
            self._new_letter(symbol, unit)
        return symbols

    def _new_letter(self, symbol: Symbol, unit: str) -> None:
        name = symbol.name
        if name in self.units:
            first = f" (first at {self.where[name]})" if name in self.where else ""
            refuse(f"the letter {name!r} is declared twice in {self.name}{first}; give one of them another name")
        self._usable(name)
        self.units[name], self.where[name] = unit, place()
        found = self._unit(unit)
        self.dimensions[symbol] = found
        if scale(unit) != 1:
            si = "rad or -" if found == PURE else in_words(found)
            refuse(f"{name!r} is in {unit}, and letters are in SI: write {si!r}; values in a case may have any unit")

    def _usable(self, name: str) -> None:
        if not name.isidentifier() or name.startswith("_"):
            refuse(f"{name!r} is not a usable name; use letters, digits and inner underscores")
        if keyword.iskeyword(name) or name == "ca":  # as which the derived code knows CasADi
            refuse(f"{name!r} has a meaning in the derived code; write {name}_")
        if (plain := unicodedata.normalize("NFKC", name)) != name:
            refuse(f"Python reads {name!r} as {plain!r}; write that")
        for q in self.q:
            if name in (f"{q.name}d", f"{q.name}dd"):
                refuse(f"{name!r} is the name of a rate of the coordinate {q.name!r}; take another")

    def _unit(self, unit: str) -> Dimension:
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
        refuse(f"the letter {symbol.name!r} is not declared in {self.name}; declare it before it is used")

    def _checked(self, value: Any, unit: str, what: str) -> Expr:
        try:
            expression = sympify(value)
        except (TypeError, ValueError, AttributeError) as error:
            refuse(f"{what} = {value!r} is no expression ({' '.join(str(error).split())})")
        if expression.has(nan, zoo, oo, -oo):
            refuse(f"{what} = {value} is not finite; something is divided by zero")
        if expression.has(Float):
            number = min(expression.atoms(Float), key=str)
            why = f"{what} = {value} holds the floating-point number {number:.6g}, which would be rounded"
            refuse(f"{why}; write Rational(1, 2), pi / 2, or make it a parameter")
        found = self.dimension(expression)
        if unit and found is not None and found != self._unit(unit):
            refuse(f"{what} = {value} is in {in_words(found)}, and must be in {unit}")
        return expression

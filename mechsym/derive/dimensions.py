"""Units of expressions, checked while a mechanism is declared: exponents of kg, m, s, K; angles are pure numbers."""

from collections.abc import Mapping

from sympy import Abs, Add, Expr, Max, Min, Mod, Mul, Piecewise, Pow, Rational, Symbol, atan2, sign

from mechsym import quantities
from mechsym.derive.printer import Lookup
from mechsym.derive.refuse import refuse

Dimension = tuple[Rational | int, ...]
PURE: Dimension = (0, 0, 0, 0)
_BASE = ("kg", "m", "s", "K")
_NAMED = {of: unit for unit in ("N", "N*m", "Pa", "W", "N/m", "N*s/m", "N*m*s") for of in [quantities.dimension(unit)]}


def of_unit(unit: str) -> Dimension:
    """Exponents of a unit. unit: product of units, `"-"` for a pure number. Returns dimension: of kg, m, s, K."""
    return quantities.dimension(unit)


def in_words(dimension: Dimension) -> str:
    """Exponents of kg, m, s, K as a unit that people write: ``N*m``, ``kg*m^2``, ``-`` for a pure number."""
    if tuple(dimension) in _NAMED:
        return _NAMED[tuple(dimension)]

    def product(powers: list[tuple[str, Rational | int]]) -> str:
        return "*".join(b if p == 1 else f"{b}^{p}" for b, p in powers)

    above = product([(b, p) for b, p in zip(_BASE, dimension, strict=True) if p > 0])
    below = product([(b, -p) for b, p in zip(_BASE, dimension, strict=True) if p < 0])
    if not below:
        return above or "-"
    return f"{above or '1'}/{below}" if "*" not in below else f"{above or '1'}/({below})"


def dimension_of(expression: Expr, letters: Mapping[Symbol, Dimension | None]) -> Dimension | None:
    """Dimension of an expression; a sum of unlike terms is refused.

    expression: in letters; letters: dimension of each letter, None where it is not known. Returns dimension: None for 0
    and for what is not known.
    """
    if expression.is_Symbol:
        return letters.get(expression)
    if expression.is_number:
        return None if expression.is_zero else PURE
    if isinstance(expression, Lookup):
        return None
    parts = [dimension_of(a, letters) for a in expression.args if isinstance(a, Expr)]
    if isinstance(expression, (Add, Max, Min, Mod, Piecewise)):
        return _alike(expression, parts)
    if isinstance(expression, Mul):
        known = [p for p in parts if p is not None]
        return tuple(sum(powers) for powers in zip(*known, strict=True)) if len(known) == len(parts) else None
    if isinstance(expression, Pow):
        base = parts[0]
        if base is None or base == PURE:
            return base
        if not expression.exp.is_number:
            refuse(f"{expression} raises {in_words(base)} to a letter; only pure numbers may be")
        return tuple(p * expression.exp for p in base)
    if isinstance(expression, Abs):
        return parts[0]
    if isinstance(expression, (atan2, sign)):
        _alike(expression, parts)
        return PURE
    for argument, dimension in zip(expression.args, parts, strict=True):
        if dimension not in (None, PURE):
            refuse(f"{expression} takes a pure number or an angle, but {argument} is in {in_words(dimension)}")
    return PURE


def _alike(expression: Expr, parts: list[Dimension | None]) -> Dimension | None:
    terms = expression.args if not isinstance(expression, Piecewise) else [e for e, _ in expression.args]
    known = [(t, p) for t, p in zip(terms, parts, strict=False) if p is not None]
    for term, dimension in known[1:]:
        if dimension != known[0][1]:
            one, other = in_words(known[0][1]), in_words(dimension)
            refuse(f"{expression} adds {known[0][0]} in {one} to {term} in {other}; both must have one unit")
    return known[0][1] if known else None

"""sympy -> CasADi, as text for generated modules and as expressions.

Only what is listed here is printed; anything else is refused by name. sympy's own Python printer writes `max`,
`and` and `x if c else y`, which raise or go wrong on CasADi symbols; here they become `ca.fmax`, `ca.logic_and`,
`ca.if_else`. The text works for floats, CasADi symbols and CasADi matrices.

Examples
--------
>>> from sympy import Max, Symbol
>>> casadi_text(Max(Symbol("x"), 0))
'ca.fmax(0, x)'
"""

import keyword
from collections.abc import Iterable, Mapping

import sympy as sp
from sympy.core.relational import Relational
from sympy.printing.precedence import PRECEDENCE, precedence
from sympy.printing.str import StrPrinter

from mechsym.errors import shown
from mechsym.quantities.units import Scalar


class UnsupportedNode(ValueError):
    """The expression holds something that has no place in generated code; the message names it."""


class Lookup(sp.Function):
    """A number that is constant between breaks of its argument: the first value below the first break."""

    breaks: tuple[float, ...] = ()
    values: tuple[float, ...] = ()

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Between its breaks it does not change."""
        return sp.Integer(0)

    def _casadi(self, printer: "_Printer") -> str:
        steps = [after - before for before, after in zip(self.values, self.values[1:], strict=False)]
        passed = f"ca.ge({printer._print(self.args[0])}, ca.DM({list(self.breaks)}))"
        return f"({self.values[0]!r} + ca.dot(ca.DM({steps}), {passed}))"


_FUNCTIONS = {
    "sin": "sin", "cos": "cos", "tan": "tan", "asin": "asin", "acos": "acos", "atan": "atan", "atan2": "atan2",
    "sinh": "sinh", "cosh": "cosh", "tanh": "tanh", "exp": "exp", "log": "log", "Abs": "fabs", "sign": "sign",
    "floor": "floor", "ceiling": "ceil", "erf": "erf",
}  # fmt: skip
_RELATIONS = {"==": "ca.eq", "!=": "ca.ne", "<": "ca.lt", "<=": "ca.le", ">": "ca.gt", ">=": "ca.ge"}


_NODES = {
    "Add", "And", "BooleanFalse", "BooleanTrue", "Equality", "Exp1", "ExprCondPair", "GreaterThan", "Half",
    "ImmutableDenseMatrix", "Integer", "LessThan", "Max", "Min", "Mod", "Mul", "MutableDenseMatrix", "NegativeOne",
    "Not", "One", "Or", "Pi", "Piecewise", "Pow", "Rational", "StrictGreaterThan", "StrictLessThan", "Symbol", "Tuple",
    "Unequality", "Zero",
}  # fmt: skip


def require_known(expr: sp.Basic | float) -> None:
    """Refuse an expression that holds what cannot be printed.

    Raises
    ------
    UnsupportedNode
        Names the node and what is known
    """
    for node in sp.preorder_traversal(expr):
        name = type(node).__name__
        if isinstance(node, sp.Float):
            raise UnsupportedNode(f"the number {node} is a Float and would be rounded; write a Rational or a parameter")
        if (
            isinstance(node, sp.Basic)
            and name not in _NODES
            and name not in _FUNCTIONS
            and not isinstance(node, Lookup)
        ):
            raise UnsupportedNode(f"{name!r} in {expr} has no CasADi counterpart; known are {known()}")
        if isinstance(node, sp.Piecewise) and node.args[-1].cond != sp.true:
            raise UnsupportedNode(f"{node} has no value where no condition holds; end it with (value, True)")


class _Printer(StrPrinter):
    """Prints whitelisted nodes; the order of terms is sympy's canonical one, so the text is reproducible."""

    printmethod = "_casadi"

    def doprint(self, expr: sp.Basic | float) -> str:
        """Check every node against the list, then print. expr: Expr, sympy expression. Returns text: Python text."""
        require_known(expr)
        return self._print(expr)

    def _print_Symbol(self, expr: sp.Symbol) -> str:
        if not expr.name.isidentifier() or keyword.iskeyword(expr.name):
            raise UnsupportedNode(f"the letter {expr.name!r} is no Python identifier; rename it in the derivation")
        return expr.name

    def _print_Integer(self, expr: sp.Integer) -> str:
        return str(expr.p)

    def _print_Rational(self, expr: sp.Rational) -> str:
        return f"{expr.p} / {expr.q}"

    def _print_Pi(self, expr: sp.Basic | float) -> str:
        return "ca.pi"

    def _print_Exp1(self, expr: sp.Basic | float) -> str:
        return "ca.exp(1)"

    def _print_Pow(self, expr: sp.Pow, rational: bool = False) -> str:
        base = self.parenthesize(expr.base, PRECEDENCE["Pow"], strict=False)
        if expr.exp == sp.Rational(1, 2):
            return f"ca.sqrt({self._print(expr.base)})"
        if expr.exp == -sp.Rational(1, 2):
            return f"1 / ca.sqrt({self._print(expr.base)})"
        if expr.exp == -1:
            return f"1 / {base}"
        if expr.exp.is_Integer and expr.exp.is_negative:
            return f"1 / {base}**{-expr.exp}"
        return f"{base}**{self.parenthesize(expr.exp, PRECEDENCE['Pow'], strict=False)}"

    def _print_Function(self, expr: sp.Function) -> str:
        return f"ca.{_FUNCTIONS[type(expr).__name__]}({', '.join(self._print(a) for a in expr.args)})"

    def _print_Mod(self, expr: sp.Mod) -> str:
        # sympy's Mod has the divisor's sign, C's fmod the dividend's
        a, b = (self.parenthesize(arg, PRECEDENCE["Mul"], strict=False) for arg in expr.args)
        return f"({a} - {b} * ca.floor({a} / {b}))"

    def _fold(self, function: str, args: Iterable[sp.Expr]) -> str:
        texts = [self._print(a) for a in args]
        result = texts[-1]
        for text in reversed(texts[:-1]):
            result = f"ca.{function}({text}, {result})"
        return result

    def _print_Max(self, expr: sp.Max) -> str:
        return self._fold("fmax", sp.ordered(expr.args))

    def _print_Min(self, expr: sp.Min) -> str:
        return self._fold("fmin", sp.ordered(expr.args))

    def _print_And(self, expr: sp.And) -> str:
        return self._fold("logic_and", sp.ordered(expr.args))

    def _print_Or(self, expr: sp.Or) -> str:
        return self._fold("logic_or", sp.ordered(expr.args))

    def _print_Not(self, expr: sp.Not) -> str:
        return f"ca.logic_not({self._print(expr.args[0])})"

    def _print_BooleanTrue(self, expr: sp.Basic | float) -> str:
        return "1"

    def _print_BooleanFalse(self, expr: sp.Basic | float) -> str:
        return "0"

    def _print_Relational(self, expr: Relational) -> str:
        return f"{_RELATIONS[expr.rel_op]}({self._print(expr.lhs)}, {self._print(expr.rhs)})"

    def _print_Piecewise(self, expr: sp.Piecewise) -> str:
        *branches, (last, _) = expr.args
        result = self._print(last)
        for value, test in reversed(branches):
            result = f"ca.if_else({self._print(test)}, {self._print(value)}, {result})"
        return result

    def _print_MatrixBase(self, expr: sp.MatrixBase) -> str:
        rows = (f"ca.horzcat({', '.join(self._print(e) for e in expr.row(i))})" for i in range(expr.rows))
        return f"ca.vertcat({', '.join(rows)})"

    _print_ImmutableDenseMatrix = _print_MatrixBase
    _print_MutableDenseMatrix = _print_MatrixBase

    def _print_Mul(self, expr: sp.Mul) -> str:
        coefficient, rest = expr.as_coeff_Mul()
        sign = "-" if coefficient.could_extract_minus_sign() else ""
        top = [] if abs(coefficient.p) == 1 else [sp.Integer(abs(coefficient.p))] if coefficient.is_Rational else []
        bottom = [sp.Integer(coefficient.q)] if coefficient.is_Rational and coefficient.q != 1 else []
        for factor in sp.Mul.make_args(rest):
            base, exponent = factor.as_base_exp()
            if exponent.is_Rational and exponent.is_negative:
                bottom.append(sp.Pow(base, -exponent, evaluate=False) if exponent != -1 else base)
            elif factor != 1:
                top.append(factor)
        text = " * ".join(self._factor(f) for f in top) or "1"
        if not bottom:
            return sign + text
        below = " * ".join(self._factor(f) for f in bottom)
        return f"{sign}{text} / ({below})" if len(bottom) > 1 else f"{sign}{text} / {below}"

    def _factor(self, factor: sp.Expr) -> str:
        text = self._print(factor)
        loose = precedence(factor) <= PRECEDENCE["Mul"] or "/" in text and isinstance(factor, (sp.Pow, sp.Rational))
        return f"({text})" if loose and not factor.is_Atom or factor.is_Rational and not factor.is_Integer else text

    def _print_Add(self, expr: sp.Add, order: object = None) -> str:
        text = ""
        for term in self._as_ordered_terms(expr, order=order):
            part = self._print(term)
            negative = part.startswith("-")
            part = part[1:] if negative else part
            if precedence(term) < PRECEDENCE["Add"]:
                part = f"({part})"
            text += (" - " if negative else " + ") + part if text else ("-" if negative else "") + part
        return text


def known() -> str:
    """The functions and nodes that are printed. Returns names: sorted, separated by commas."""
    return ", ".join(sorted([*_FUNCTIONS, *_NODES], key=str.lower))


def read(value: object) -> sp.Basic:
    """A number or what sympy has made, as sympy has it.

    Raises
    ------
    UnsupportedNode
        A text, alone or in a list: sympy would read it by running it
    """
    try:
        if isinstance(value, (sp.Basic, sp.MatrixBase)) or not isinstance(value, Iterable):
            return sp.sympify(value, strict=True)
    except (sp.SympifyError, TypeError):
        pass
    raise UnsupportedNode(f"{shown(value)} is no expression of sympy; write the letters themselves, no text")


def casadi_text(expression: sp.Basic | float) -> str:
    """Python text that evaluates the expression with CasADi functions (`ca.`).

    expression: Expr, Boolean or Matrix, sympy expression without Floats.

    Raises
    ------
    UnsupportedNode
        A node that is not on the list; the message names it
    """
    return _Printer().doprint(read(expression))


def to_casadi(expression: sp.Basic | float, letters: Mapping[str, Scalar]) -> Scalar:
    """The expression evaluated on CasADi symbols, matrices or floats.

    expression: Expr, Boolean or Matrix, sympy expression without Floats; letters: mapping of str to value, CasADi
    symbol or number for each free letter. Returns value: of their kind [unit of the expression].

    Raises
    ------
    UnsupportedNode
        A node that is not on the list, or a letter without a value
    """
    import casadi as ca

    missing = sorted(s.name for s in read(expression).free_symbols if s.name not in letters)
    if missing:
        raise UnsupportedNode(f"no value for {', '.join(missing)}; given are {', '.join(sorted(letters))}")
    code = compile(casadi_text(expression), "<casadi_text>", "eval")
    return eval(code, {"__builtins__": {}, "ca": ca}, dict(letters))

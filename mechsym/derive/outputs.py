"""What shall come out of a mechanism beside its equations: kinematic names with derivatives, and dynamic quantities."""

from typing import Any

from sympy import Expr, Symbol, sympify

from mechsym.derive.refuse import refuse

Declaration = Any  # the declaration, which imports this module


def output(m: Declaration, *symbols: Symbol, order: int = 0) -> None:
    """Make names part of the kinematic outputs, with their derivatives by the coordinates.

    Parameters
    ----------
    m : Declaration
        The declaration
    *symbols : Symbol
        Names on the tape
    order : int
        Highest derivative, 0 to 2
    """
    for symbol in symbols:
        if not isinstance(symbol, Symbol) or symbol not in {*m.tape.entries, *m.q}:
            refuse(f"output takes names of the declaration, and {symbol} is none; name it: x = m.let('x', .., 'm')")
        found = [symbol]
        for _ in range(order):
            m.kinematic_outputs += found
            found = [d for f in found for v in m.q if (d := _named(m, f, v)).is_Symbol]
        m.kinematic_outputs += found
    m.kinematic_outputs = list(dict.fromkeys(m.kinematic_outputs))


def _named(m: Declaration, symbol: Symbol, v: Symbol) -> Expr:
    """A derivative by its own name, also where it is another name with its sign turned."""
    value = m.tape.derivative(symbol, v)
    return m.tape.name_derivative(symbol, v, value) if (-value).is_Symbol else value


def output_dynamic(m: Declaration, name: str, value: Expr, unit: str) -> None:
    """Add an output that needs velocities, accelerations or inputs.

    Parameters
    ----------
    m : Declaration
        The declaration
    name : str
        Name of the output
    value : Expr
        Expression in names, `velocity` and `acceleration` of names, reactions, inputs and parameters
    unit : str
        Its unit
    """
    m.units[name] = unit
    m.dynamic_outputs[name] = m.tape.named(sympify(value))

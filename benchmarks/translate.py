"""The same programs for the other tools: sympy expressions, heyoka expressions, plain Python."""

from collections.abc import Callable
from typing import Any

import casadi as ca

from mechsym.native.tape import Tape, read

_ARITHMETIC: dict[str, Callable[..., Any]] = {
    "add": lambda a, b: a + b, "sub": lambda a, b: a - b, "mul": lambda a, b: a * b, "div": lambda a, b: a / b,
    "neg": lambda a: -a, "inv": lambda a: 1 / a, "sq": lambda a: a * a, "twice": lambda a: 2 * a,
    "pow": lambda a, b: a**b,
}  # fmt: skip
_PYTHON = {
    "add": "{0} + {1}", "sub": "{0} - {1}", "mul": "{0} * {1}", "div": "{0} / {1}", "neg": "-{0}", "inv": "1.0 / {0}",
    "sq": "{0} * {0}", "twice": "{0} + {0}", "pow": "{0} ** {1}", "sin": "math.sin({0})", "cos": "math.cos({0})",
    "sqrt": "math.sqrt({0})", "exp": "math.exp({0})", "log": "math.log({0})", "fmin": "min({0}, {1})",
    "fmax": "max({0}, {1})", "lt": "(1.0 if {0} < {1} else 0.0)", "le": "(1.0 if {0} <= {1} else 0.0)",
    "if_else_zero": "({1} if {0} != 0.0 else 0.0)", "not": "(1.0 if {0} == 0.0 else 0.0)",
    "and": "(1.0 if {0} != 0.0 and {1} != 0.0 else 0.0)",
}  # fmt: skip


def values(tape: Tape, inputs: list[Any], functions: dict[str, Callable[..., Any]]) -> list[Any]:
    """The results of a program for any kind of number.

    Parameters
    ----------
    tape : Tape
        The program
    inputs : list
        One for each input
    functions : dict of str to callable
        `sin`, `cos`, `sqrt` and what else occurs

    Returns
    -------
    results : list
        One for each output
    """
    operators = _ARITHMETIC | functions
    found: list[Any] = []
    for op, args in tape.nodes:
        if op == "input":
            found.append(inputs[args[0]])
        elif op == "constant":
            found.append(args[0])
        else:
            found.append(operators[op](*(found[a] for a in args)))
    return [found[r] for r in tape.results]


def sympy_expressions(function: ca.Function) -> tuple[list[Any], list[Any]]:
    """Symbols and expressions of a function in sympy, in the form in which mechsym derived it.

    Parameters
    ----------
    function : casadi.Function
        SX function

    Returns
    -------
    symbols, expressions : list
        For lambdify
    """
    import sympy

    tape = read(function)
    symbols = [sympy.Symbol(n.replace("[", "_").replace("]", "")) for n in tape.inputs]
    known = {"sin": sympy.sin, "cos": sympy.cos, "sqrt": sympy.sqrt}
    return symbols, values(tape, list(symbols), known)


def heyoka_expressions(function: ca.Function, inputs: list[Any]) -> list[Any]:
    """Expressions of a function in heyoka.

    Parameters
    ----------
    function : casadi.Function
        SX function
    inputs : list of heyoka.expression
        One for each input

    Returns
    -------
    expressions : list of heyoka.expression
        One for each output
    """
    import heyoka as hy

    known = {"sin": hy.sin, "cos": hy.cos, "sqrt": hy.sqrt}
    found = values(read(function), inputs, known)
    return [v if isinstance(v, hy.expression) else hy.expression(float(v)) for v in found]


def python_text(function: ca.Function, name: str) -> str:
    """A function as plain Python of floats, for numba and for CPython.

    Parameters
    ----------
    function : casadi.Function
        SX function
    name : str
        Name of the Python function

    Returns
    -------
    text : str
        Source; takes the inputs, returns a tuple
    """
    tape = read(function)
    names: list[str] = []
    lines = []
    for i, (op, args) in enumerate(tape.nodes):
        if op == "input":
            names.append(f"x{args[0]}")
        elif op == "constant":
            names.append(f"({args[0]!r})")
        else:
            lines.append(f"    t{i} = {_PYTHON[op].format(*(names[a] for a in args))}")
            names.append(f"t{i}")
    arguments = ", ".join(f"x{i}" for i in range(len(tape.inputs)))
    result = ", ".join(names[r] for r in tape.results)
    return "\n".join([f"def {name}({arguments}):", *lines, f"    return ({result},)"])

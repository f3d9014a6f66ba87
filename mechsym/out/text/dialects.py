"""How each language writes an operator, a statement and a number.

Statements of a tape in a dialect: each value has one name and is written once.
"""

import math
from collections.abc import Callable, Mapping

from mechsym.errors import BadInput
from mechsym.native.tape import Tape
from mechsym.quantities import record

_COMMON = {
    "add": "{0} + {1}", "sub": "{0} - {1}", "mul": "{0} * {1}", "div": "{0} / {1}", "neg": "-{0}", "inv": "1.0 / {0}",
    "sq": "{0} * {0}", "twice": "{0} + {0}",
}  # fmt: skip
_CALLED = ("sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "asinh", "acosh",
           "atanh", "floor", "ceil", "log1p", "expm1", "erf")  # fmt: skip


def _calls(prefix: str = "", **other: str) -> dict[str, str]:
    return {name: f"{prefix}{other.get(name, name)}({{0}})" for name in _CALLED}


@record
class Dialect:
    """A language: operators with places for operands, a pattern for a statement (name, value), and its infinity."""

    name: str
    operators: Mapping[str, str]
    statement: str
    infinity: str
    comment: str


C99 = Dialect(
    name="c", statement="    const double {0} = {1};", infinity="INFINITY", comment="/* {} */",
    operators=_COMMON | _calls() | {
        "fabs": "fabs({0})", "pow": "pow({0}, {1})", "atan2": "atan2({0}, {1})", "hypot": "hypot({0}, {1})",
        "fmin": "fmin({0}, {1})", "fmax": "fmax({0}, {1})", "fmod": "fmod({0}, {1})", "copysign": "copysign({0}, {1})",
        "lt": "({0} < {1} ? 1.0 : 0.0)", "le": "({0} <= {1} ? 1.0 : 0.0)", "eq": "({0} == {1} ? 1.0 : 0.0)",
        "ne": "({0} != {1} ? 1.0 : 0.0)", "not": "({0} == 0.0 ? 1.0 : 0.0)",
        "and": "({0} != 0.0 && {1} != 0.0 ? 1.0 : 0.0)", "or": "({0} != 0.0 || {1} != 0.0 ? 1.0 : 0.0)",
        "if_else_zero": "({0} != 0.0 ? {1} : 0.0)", "sign": "(({0} > 0.0) - ({0} < 0.0))",
    },
)  # fmt: skip

JULIA = Dialect(
    name="julia", statement="    {0} = {1}", infinity="Inf", comment="# {}",
    operators=_COMMON | _calls() | {
        "fabs": "abs({0})", "pow": "{0}^{1}", "atan2": "atan({0}, {1})", "hypot": "hypot({0}, {1})",
        "fmin": "min({0}, {1})", "fmax": "max({0}, {1})", "fmod": "rem({0}, {1})", "copysign": "copysign({0}, {1})",
        "lt": "ifelse({0} < {1}, 1.0, 0.0)", "le": "ifelse({0} <= {1}, 1.0, 0.0)",
        "eq": "ifelse({0} == {1}, 1.0, 0.0)", "ne": "ifelse({0} != {1}, 1.0, 0.0)", 
        "not": "ifelse({0} == 0.0, 1.0, 0.0)",
        "and": "ifelse(({0} != 0.0) & ({1} != 0.0), 1.0, 0.0)", "or": "ifelse(({0} != 0.0) | ({1} != 0.0), 1.0, 0.0)",
        "if_else_zero": "ifelse({0} != 0.0, {1}, 0.0)", "sign": "sign({0})",
    },
)  # fmt: skip

MATLAB = Dialect(
    name="matlab", statement="    {0} = {1};", infinity="Inf", comment="% {}",
    operators=_COMMON | _calls() | {
        "fabs": "abs({0})", "pow": "{0} ^ {1}", "atan2": "atan2({0}, {1})", "hypot": "hypot({0}, {1})",
        "fmin": "min({0}, {1})", "fmax": "max({0}, {1})", "fmod": "rem({0}, {1})",
        "lt": "double({0} < {1})", "le": "double({0} <= {1})", "eq": "double({0} == {1})", "ne": "double({0} ~= {1})",
        "not": "double({0} == 0.0)", "and": "double({0} ~= 0.0 && {1} ~= 0.0)",
        "or": "double({0} ~= 0.0 || {1} ~= 0.0)", "if_else_zero": "pick({0}, {1})", "sign": "sign({0})",
    },
)  # fmt: skip

JAX = Dialect(
    name="jax", statement="    {0} = {1}", infinity="jnp.inf", comment="# {}",
    operators=_COMMON | _calls("jnp.", asin="arcsin", acos="arccos", atan="arctan", asinh="arcsinh", acosh="arccosh",
                               atanh="arctanh") | {
        "erf": "jax.scipy.special.erf({0})",
        "fabs": "jnp.abs({0})", "pow": "jnp.power({0}, {1})", "atan2": "jnp.arctan2({0}, {1})",
        "hypot": "jnp.hypot({0}, {1})", "fmin": "jnp.fmin({0}, {1})", "fmax": "jnp.fmax({0}, {1})",
        "fmod": "jnp.fmod({0}, {1})", "copysign": "jnp.copysign({0}, {1})",
        "lt": "jnp.where({0} < {1}, 1.0, 0.0)", "le": "jnp.where({0} <= {1}, 1.0, 0.0)",
        "eq": "jnp.where({0} == {1}, 1.0, 0.0)", "ne": "jnp.where({0} != {1}, 1.0, 0.0)",
        "not": "jnp.where({0} == 0.0, 1.0, 0.0)",
        "and": "jnp.where(({0} != 0.0) & ({1} != 0.0), 1.0, 0.0)",
        "or": "jnp.where(({0} != 0.0) | ({1} != 0.0), 1.0, 0.0)",
        "if_else_zero": "jnp.where({0} != 0.0, {1}, 0.0)", "sign": "jnp.sign({0})",
    },
)  # fmt: skip

MODELICA = Dialect(
    name="modelica", statement="  {0} := {1};", infinity="Modelica.Constants.inf", comment="// {}",
    operators=_COMMON | {name: f"{name}({{0}})" for name in _CALLED if name not in ("asinh", "acosh", "atanh", "log1p",
                                                                                    "expm1", "erf")} | {
        "fabs": "abs({0})", "pow": "{0} ^ {1}", "atan2": "atan2({0}, {1})", "hypot": "sqrt({0} * {0} + {1} * {1})",
        "fmin": "min({0}, {1})", "fmax": "max({0}, {1})", "fmod": "rem({0}, {1})",
        "lt": "(if {0} < {1} then 1.0 else 0.0)", "le": "(if {0} <= {1} then 1.0 else 0.0)",
        "not": "(if abs({0}) > 0.0 then 0.0 else 1.0)",
        "and": "(if abs({0}) > 0.0 and abs({1}) > 0.0 then 1.0 else 0.0)",
        "or": "(if abs({0}) > 0.0 or abs({1}) > 0.0 then 1.0 else 0.0)",
        "if_else_zero": "(if abs({0}) > 0.0 then {1} else 0.0)", "sign": "sign({0})",
    },
)  # fmt: skip


def number(dialect: Dialect, value: float) -> str:
    """A constant in a language, to the last digit [any unit]."""
    if math.isnan(value):
        raise BadInput("the function holds a constant that is not a number; check the parameters")
    if math.isinf(value):
        return dialect.infinity if value > 0 else f"(-{dialect.infinity})"
    return repr(float(value)) if value >= 0 else f"({float(value)!r})"


def operation(dialect: Dialect, operator: str, operands: list[str]) -> str:
    """One operation on names and numbers."""
    if operator not in dialect.operators:
        known = ", ".join(sorted(dialect.operators))
        raise BadInput(f"operator {operator!r} has no word in {dialect.name}; it has {known}")
    return dialect.operators[operator].format(*operands)


def statements(tape: Tape, dialect: Dialect, place: Callable[[int], str]) -> tuple[list[str], list[str]]:
    """Statements that compute a tape, and the text of each result; `place` says where input i is read."""
    names: list[str] = []
    lines: list[str] = []
    for i, (operator, operands) in enumerate(tape.nodes):
        if operator == "input":
            names.append(place(operands[0]))
        elif operator == "constant":
            names.append(number(dialect, operands[0]))
        else:
            names.append(f"t{i}")
            value = operation(dialect, operator, [names[k] for k in operands])
            lines.append(dialect.statement.format(names[-1], value))
    return lines, [names[r] for r in tape.results]

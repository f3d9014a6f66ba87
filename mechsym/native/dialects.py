"""How each operator is written in C and in numpy.

C names with the prefix `ms_` are in `c/elementary.h`: branch-free, so that a loop over them becomes vector
instructions. What stays a call of the C library is right but is computed one number at a time.
"""

import math

from mechsym.errors import BadInput
from mechsym.native.tape import Tape
from mechsym.quantities.units import Pure

# exponents that become products; beyond them the generic power is as exact and not slower
_PRODUCTS = {2.0: "{0} * {0}", 3.0: "{0} * {0} * {0}", 4.0: "({0} * {0}) * ({0} * {0})"}

C = {
    "add": "{0} + {1}", "sub": "{0} - {1}", "mul": "{0} * {1}", "div": "{0} / {1}",
    "neg": "-{0}", "inv": "1.0 / {0}", "sq": "{0} * {0}", "twice": "{0} + {0}",
    "sqrt": "sqrt({0})", "fabs": "fabs({0})", "floor": "floor({0})", "ceil": "ceil({0})",
    "exp": "ms_exp({0})", "log": "ms_log({0})", "pow": "ms_pow({0}, {1})", "pow_broken": "ms_pow_broken({0}, {1})",
    "asin": "ms_asin({0})", "acos": "acos({0})", "atan": "atan({0})", "tan": "ms_tan({0})",
    "lt": "({0} < {1} ? 1.0 : 0.0)", "le": "({0} <= {1} ? 1.0 : 0.0)",
    "eq": "({0} == {1} ? 1.0 : 0.0)", "ne": "({0} != {1} ? 1.0 : 0.0)",
    "not": "({0} == 0.0 ? 1.0 : 0.0)",
    "and": "({0} != 0.0 & {1} != 0.0 ? 1.0 : 0.0)", "or": "({0} != 0.0 | {1} != 0.0 ? 1.0 : 0.0)",
    "if_else_zero": "({0} != 0.0 ? {1} : 0.0)",
    "sign": "({0} > 0.0 ? 1.0 : ({0} < 0.0 ? -1.0 : {0}))",
    "fmin": "ms_fmin({0}, {1})", "fmax": "ms_fmax({0}, {1})", "copysign": "copysign({0}, {1})",
    "fmod": "fmod({0}, {1})", "remainder": "remainder({0}, {1})", "hypot": "ms_hypot({0}, {1})",
    "atan2": "atan2({0}, {1})", "erf": "erf({0})", "log1p": "log1p({0})", "expm1": "expm1({0})",
    "sinh": "sinh({0})", "cosh": "cosh({0})", "tanh": "tanh({0})",
    "asinh": "asinh({0})", "acosh": "acosh({0})", "atanh": "atanh({0})",
}  # fmt: skip

NUMPY = {
    "add": "{0} + {1}", "sub": "{0} - {1}", "mul": "{0} * {1}", "div": "{0} / {1}",
    "neg": "-{0}", "inv": "1.0 / {0}", "sq": "{0} * {0}", "twice": "{0} + {0}",
    "sqrt": "np.sqrt({0})", "fabs": "np.fabs({0})", "floor": "np.floor({0})", "ceil": "np.ceil({0})",
    "exp": "np.exp({0})", "log": "np.log({0})", "pow": "np.power({0}, {1})", "pow_broken": "np.power({0}, {1})",
    "sin": "np.sin({0})", "cos": "np.cos({0})", "tan": "np.tan({0})",
    "asin": "np.arcsin({0})", "acos": "np.arccos({0})", "atan": "np.arctan({0})",
    "lt": "({0} < {1}) * 1.0", "le": "({0} <= {1}) * 1.0", "eq": "({0} == {1}) * 1.0", "ne": "({0} != {1}) * 1.0",
    "not": "({0} == 0.0) * 1.0",
    "and": "np.logical_and({0}, {1}) * 1.0", "or": "np.logical_or({0}, {1}) * 1.0",
    "if_else_zero": "np.where({0}, {1}, 0.0)", "sign": "np.sign({0})",
    "fmin": "np.fmin({0}, {1})", "fmax": "np.fmax({0}, {1})", "copysign": "np.copysign({0}, {1})",
    "fmod": "np.fmod({0}, {1})", "hypot": "np.hypot({0}, {1})", "atan2": "np.arctan2({0}, {1})",
    "log1p": "np.log1p({0})", "expm1": "np.expm1({0})",
    "sinh": "np.sinh({0})", "cosh": "np.cosh({0})", "tanh": "np.tanh({0})",
    "asinh": "np.arcsinh({0})", "acosh": "np.arccosh({0})", "atanh": "np.arctanh({0})",
}  # fmt: skip


def unknown(tape: Tape, dialect: dict[str, str]) -> list[str]:
    """Operators of a program that a dialect cannot write. Returns operators: sorted; empty when all can be written."""
    known = {*dialect, "input", "constant", "sin", "cos"}
    return sorted({op for op, _ in tape.nodes} - known)


def expression(dialect: dict[str, str], op: str, args: list[str], exponent: Pure | None = None) -> str:
    """One operation as text. exponent: value of a constant exponent, which may become products."""
    if op == "pow" and exponent in _PRODUCTS:
        return _PRODUCTS[exponent].format(args[0])
    if op == "pow" and exponent == 0.5:
        return dialect["sqrt"].format(args[0])
    if op not in dialect:
        raise BadInput(f"operator {op!r} cannot be compiled; allowed are {', '.join(sorted(dialect))}")
    return dialect[op].format(*args)


def literal(value: float) -> str | None:
    """Text of a constant that every dialect writes in place, or None when it belongs into the table of constants.

    value: the constant [SI]. Returns text: small integers and halves have a text.
    """
    small = math.isfinite(value) and abs(value) <= 16 and value * 2 == int(value * 2)
    return f"{value!r}" if small and value >= 0 else f"({value!r})" if small else None

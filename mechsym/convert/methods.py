"""The converter: expressions, matrices, and the equations of sympy.physics.mechanics."""

from collections.abc import Sequence
from typing import Any

import casadi as ca
import sympy as sp
from sympy.physics.mechanics import KanesMethod, LagrangesMethod

from mechsym.convert.expressions import evaluate
from mechsym.convert.letters import free_letters, names, plain
from mechsym.errors import BadInput

_NAME = "converted"


def casadi(source: Any, inputs: Sequence[Any] = ()) -> ca.Function:
    r"""A sympy expression, matrix or method as a named CasADi function.

    .. math:: M(x)\, \dot x = f(x), \quad x = (q, u) \text{ for the methods}

    Parameters
    ----------
    source : Expr, Matrix, sequence of them, LagrangesMethod or KanesMethod
        What to convert; the methods give `mass_matrix` and `forcing` of all states, in the units of the source
    inputs : sequence of Symbol, dynamicsymbol or Derivative, optional
        Arguments in order, each in its own unit; without them all free letters, sorted by name. Arguments are called
        `q1` for q1(t), `q1d` for its derivative

    Returns
    -------
    function : casadi.Function
        Outputs `mass_matrix` and `forcing` of a method, else `value` or `value0, value1, ..` [units of the source]

    Raises
    ------
    BadInput
        A letter is missing among the inputs, or a node has no counterpart; the message names it

    Notes
    -----
    Source: sympy.physics.mechanics, `mass_matrix_full`, `forcing_full`; kinematic equations are put into the forcing.
    Valid: real arguments.

    Examples
    --------
    >>> from sympy import Symbol, atan2
    >>> from mechsym import convert
    >>> x, y = Symbol("x"), Symbol("y")
    >>> float(convert.casadi(atan2(y, x), inputs=(x, y))(-1, 0))
    3.141592653589793
    """
    outputs = _outputs(source)
    matrices = [plain(sp.ImmutableDenseMatrix(m)) for m in outputs.values()]
    letters = [sp.sympify(s) for s in inputs] or free_letters(matrices)
    called = names(letters)
    if clash := sorted(set(called) & set(outputs)):
        raise BadInput(f"the letter {clash[0]!r} has the name of an output; rename it")
    symbols = [ca.SX.sym(name) for name in called]
    known = dict(zip(letters, symbols, strict=True))
    found = [_matrix(m, known) for m in matrices]
    return ca.Function(_NAME, symbols, found, called, list(outputs), {"cse": True})


def _outputs(source: Any) -> dict[str, Any]:
    """Named matrices of what is converted."""
    if isinstance(source, LagrangesMethod):
        if source.eom is None:
            source.form_lagranges_equations()
        return {"mass_matrix": source.mass_matrix_full, "forcing": source.forcing_full}
    if isinstance(source, KanesMethod):
        return _kane(source)
    if isinstance(source, (list, tuple)):
        return {f"value{i}": _as_matrix(s) for i, s in enumerate(source)}
    return {"value": _as_matrix(source)}


def _kane(method: KanesMethod) -> dict[str, Any]:
    try:
        mass, forcing = method.mass_matrix_full, method.forcing_full
    except (ValueError, AttributeError) as error:
        raise BadInput(f"the KanesMethod has no equations yet ({error}); call kanes_equations(..) first") from None
    rates = method.kindiffdict()
    return {"mass_matrix": mass.subs(rates), "forcing": forcing.subs(rates)}


def _as_matrix(source: Any) -> Any:
    try:
        found = sp.sympify(source)
    except (sp.SympifyError, TypeError) as error:
        raise BadInput(f"{source!r} is no sympy expression, matrix, LagrangesMethod or KanesMethod ({error})") from None
    if isinstance(found, sp.MatrixBase):
        return found
    if isinstance(found, (sp.Expr, sp.logic.boolalg.Boolean)):
        return sp.ImmutableDenseMatrix([[found]]) if isinstance(found, sp.Expr) else _logical(found)
    raise BadInput(f"{type(found).__name__} is no sympy expression, matrix, LagrangesMethod or KanesMethod")


def _logical(condition: Any) -> Any:
    return sp.ImmutableDenseMatrix([[sp.Piecewise((1, condition), (0, True))]])


def _matrix(matrix: Any, known: dict[Any, ca.SX]) -> ca.SX:
    rows = [[evaluate(matrix[i, j], known) for j in range(matrix.cols)] for i in range(matrix.rows)]
    return ca.vertcat(*(ca.horzcat(*row) for row in rows))

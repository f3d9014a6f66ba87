"""IPOPT with every function of the problem compiled, for problems that are solved again and again.

A collocation has the same equations at every node. Expanded, they are thousands of instructions that no compiler should
see one by one; rolled (see `kernels`), they are one body and a table of places, compiled in a second and evaluated in
microseconds. What is left of a solve is IPOPT's own linear algebra.
"""

import logging
from collections.abc import Mapping
from typing import Any

import casadi

from mechsym.native.compiler import NoCompiler
from mechsym.native.evaluate import externals

_LOG = logging.getLogger("mechsym.native")
_FUNCTIONS = {"grad_f": "nlp_grad_f", "jac_g": "nlp_jac_g", "hess_lag": "nlp_hess_l"}


def nlpsol(
    name: str, problem: Mapping[str, Any], options: Mapping[str, Any] | None = None, mode: str = "fast"
) -> casadi.Function:
    """A solver like `casadi.nlpsol(name, "ipopt", problem, options)`, with exact derivatives, compiled.

    Parameters
    ----------
    name : str
        Name of the solver
    problem : mapping
        `x`, `f`, `g` and perhaps `p`, as casadi takes them; parameters that change between solves belong into `p`
    options : mapping, optional
        Options of casadi and IPOPT
    mode : str
        `fast` or `strict`

    Returns
    -------
    solver : casadi.Function
        Interpreted when there is no compiler
    """
    plain = casadi.nlpsol(name, "ipopt", dict(problem), {**(options or {}), "expand": True})
    oracle = _oracle(problem)
    # the reverse derivative gives the multipliers of the parameters
    functions = [oracle, *(plain.get_function(f) for f in _FUNCTIONS.values()), oracle.reverse(1)]
    try:
        compiled = externals(functions, mode)
    except NoCompiler as error:
        _LOG.warning("interpreted instead of C: %s", error)
        return plain
    own = dict(zip(_FUNCTIONS, compiled[1:-1], strict=True))
    return casadi.nlpsol(name, "ipopt", compiled[0], {**(options or {}), **own})


def _oracle(problem: Mapping[str, Any]) -> casadi.Function:
    return casadi.Function("nlp", dict(problem), ["x", "p"], ["f", "g"]).expand()

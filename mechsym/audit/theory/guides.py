r"""Theory of the air spring in its guide (source 000): gas law, virtual work, and the curve that follows.

z = 2 rho0 - 2 rho closes the spring of height H and area A; p0 is the pressure at z = 0.
W(phi) is the work of the hinge on the crank from phi = 0, M_h its torque: the spring gives what it loses.
"""

from collections.abc import Mapping

import sympy
from sympy import Symbol, diff

from mechsym.audit.theory.conversion import tape_of
from mechsym.audit.theory.record import Letter, Theory

_LETTERS = {
    "H": ("m", 1.0), "A": ("m^2", 0.031), "n": ("-", 1.25), "p0": ("Pa", 5e6), "p0s": ("Pa", 5e6), "rho0": ("m", 0.8),
    "rho": ("m", 0.7), "W": ("J", -20000.0), "M_h": ("N*m", -15000.0),
}  # fmt: skip


def guide(values: Mapping[str, float], data: str) -> Theory:
    """The guide of the air spring with the law that the paper prints.

    Parameters
    ----------
    values : mapping of str to float
        Not needed: the spring's data stand in the caption of Fig. 5

    Returns
    -------
    theory : Theory
        `spring_force`, `work` as a function of rho, `rho_of_work`, `drho_dphi`, and `torque_at_pressure`
    """
    H, A, n, p0, p0s, rho0, rho, W, M_h = (Symbol(k, positive=True) for k in _LETTERS)
    z = Symbol("z", positive=True)
    height = Symbol("y", positive=True)  # y = H - z
    force = p0 * A * (H / height) ** n  # p V^n = p0 (A H)^n with V = A y
    stored = height * force / (1 - n)  # the integral of force over height for n other than 1
    closed, reference = (_path(H, A, n, p, rho0, W) for p in (p0, p0s))
    slope = diff(reference, W) * M_h
    expressions = {
        "z": 2 * rho0 - 2 * rho,
        "spring_force": force.subs(height, H - z),
        "work": stored.subs(height, H - z) - stored.subs(height, H),
        "rho_of_work": closed,
        "rho_star": reference,
        "drho_dphi": slope,
        "dz_dphi": -2 * slope,
        "torque_at_pressure": 2 * force.subs(height, H - 2 * rho0 + 2 * Symbol("rho_star")) * slope,
    }
    letters = {k: Letter(unit=unit, value=value) for k, (unit, value) in _LETTERS.items()}
    units = {"z": "m", "spring_force": "N", "work": "J", "rho_of_work": "m", "torque_at_pressure": "N*m"}
    return Theory(
        name="guide", letters=letters, tape=tape_of(expressions), results=tuple(expressions), units=units, data=data
    )


def generic(expression: sympy.Expr) -> sympy.Expr:
    """The branch of an integral that holds for a general exponent.

    Parameters
    ----------
    expression : sympy.Expr
        Perhaps with a case n = 1 of its own
    """
    return expression.replace(sympy.Piecewise, lambda *branches: branches[0][0])


def _path(H: Symbol, A: Symbol, n: Symbol, p0: Symbol, rho0: Symbol, W: Symbol) -> sympy.Expr:
    # W = A p0 H^n (H^(1-n) - y)/(n-1) is linear in y = (H - z)^(1-n)
    y = Symbol("y", positive=True)
    balance = A * p0 * H**n * (H ** (1 - n) - y) / (n - 1) - W
    power = -balance.subs(y, 0) / diff(balance, y)
    return rho0 - H / 2 + power ** (1 / (1 - n)) / 2

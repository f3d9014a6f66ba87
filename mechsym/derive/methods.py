r"""Models as sympy has them: a LagrangesMethod, KanesMethod or System becomes a declaration of its equations.

.. math:: A^{-T} M A^{-1}\, \ddot q = A^{-T} (f - M \dot Y), \qquad u = Y(q, \dot q) = A^{-1} (\dot q - b)

A KanesMethod has speeds u of its own; they are put in by its kinematic equations, so that what is integrated are the
coordinates. Holonomic constraints of Lagrange's method are held as those of a loop; a KanesMethod with dependent speeds
keeps its constraints by their accelerations alone. The units of letters stand in a dictionary `units` beside the model.
"""

import sys
from collections.abc import Callable, Mapping
from typing import Any

import sympy as sp
from sympy.core.function import AppliedUndef

from mechsym.derive.declare import Declaration
from mechsym.derive.letterless import free_letters, name_of, plain
from mechsym.derive.printer import UnsupportedNode, require_known
from mechsym.errors import BadInput

_MECHANICS = "sympy.physics.mechanics"


def is_method(value: object) -> bool:
    """Whether something is a model of `sympy.physics.mechanics`."""
    known = sys.modules.get(_MECHANICS)  # who has not loaded it has none
    names = ("LagrangesMethod", "KanesMethod", "System")
    return known is not None and isinstance(value, tuple(getattr(known, n) for n in names if hasattr(known, n)))


def declaration_of(name: str, source: Any, units: Mapping[str, str]) -> Declaration:
    """A model as a declaration under a name. units: of letters by name; what is not named is a pure number."""
    method = _formed(name, source)
    lagrange = hasattr(method, "_hol_coneqs")
    q, holds = list(method.q), []
    if lagrange:
        holds = list(method._hol_coneqs)
        if len(method.coneqs) > len(holds):
            raise BadInput(
                f"{name} has nonholonomic constraints, which Lagrange's method gives no place; take a KanesMethod"
            )
        mass, force = method._m_d, method._f_d
    else:
        mass, force = _by_coordinates(name, method)
    return _declared(name, q, sp.Matrix(mass), sp.Matrix(force), holds, units)


def _formed(name: str, source: Any) -> Any:
    """The method with its equations."""
    if hasattr(source, "form_eoms"):
        if source.eom_method is None:
            source.form_eoms()
        return source.eom_method
    if hasattr(source, "form_lagranges_equations"):
        if source.eom is None:
            source.form_lagranges_equations()
    elif source._fr is None:
        raise BadInput(
            f"the KanesMethod {name} has no equations yet; call {name}.kanes_equations(bodies, loads) in the file"
        )
    return source


def _by_coordinates(name: str, method: Any) -> tuple[sp.Matrix, sp.Matrix]:
    """Mass matrix and forcing by the second derivatives of the coordinates."""
    q, u, t = method.q, method.u, sp.physics.mechanics.dynamicsymbols._t
    rates, speeds = q.diff(t), method.kindiffdict()
    if len(q) != len(u):
        raise BadInput(f"{name} has {len(q)} coordinates and {len(u)} speeds; give it as many speeds as coordinates")
    right = sp.Matrix([speeds[r] for r in rates])
    A = right.jacobian(u)
    inverse = A.inv()
    by_rates = dict(zip(u, inverse * (rates - right.subs(dict.fromkeys(u, 0))), strict=True))
    mass, force = method.mass_matrix.subs(speeds), method.forcing.subs(speeds)
    change = sp.Matrix([by_rates[s] for s in u]).diff(t)
    rest = change.subs(dict.fromkeys(q.diff(t, 2), 0)).doit()
    mass_q, force_q = mass * inverse, force - mass * rest
    if not method._udep:
        mass_q, force_q = inverse.T * mass_q, inverse.T * force_q
    return mass_q.subs(by_rates), force_q.subs(by_rates)


def _declared(
    name: str, q: list[sp.Expr], mass: sp.Matrix, force: sp.Matrix, holds: list[sp.Expr], units: Mapping[str, str]
) -> Declaration:
    t = sp.Symbol("t")
    moving = [[s.diff(t, k) for s in q] for k in range(3)]
    parts = [*map(plain, mass), *map(plain, force), *map(plain, holds)]
    letters = free_letters(parts)
    if any(s.is_Symbol and s.name == "t" for s in letters):
        raise BadInput(f"{name} depends on the time t itself; make what acts an input: a dynamicsymbol")
    known = {s for order in moving for s in order}
    free = [s for s in letters if s not in known]
    if rates := [s for s in free if isinstance(s, sp.Derivative)]:
        raise BadInput(f"{name} takes the rate {rates[0]} of what it does not move; make it an input of its own")
    m = Declaration(name, about="A model of sympy.physics.mechanics.")
    called = {s: name_of(s) for s in [*q, *free]}
    new: dict[sp.Basic, sp.Symbol] = {}
    held = q[len(q) - len(holds) :]
    makers: list[tuple[sp.Expr, Callable[..., Any]]] = [(s, m.dependents if s in held else m.coordinates) for s in q]
    makers += [(s, m.inputs if isinstance(s, AppliedUndef) else m.parameters) for s in free]
    for letter, declare in makers:
        new[letter] = declare(called[letter], units.get(called[letter], "-"))
    new |= {s: sp.Symbol(called[one] + "d" * k, real=True) for k in (1, 2) for one, s in zip(q, moving[k], strict=True)}

    def read(value: sp.Expr) -> sp.Expr:
        exact = plain(value).xreplace(new)
        exact = exact.xreplace({f: sp.Rational(str(f)) for f in exact.atoms(sp.Float)})
        try:
            require_known(exact)
        except UnsupportedNode as error:
            raise BadInput(f"{name}: {error}") from None
        return m.tape.named(exact)

    n = len(q)
    m.given = [[read(mass[i, j]) for j in range(n)] for i in range(n)], [sp.Integer(0)] * n, list(map(read, force))
    m.constraints |= {f"loop{k}": read(g) for k, g in enumerate(holds, 1)}
    return m

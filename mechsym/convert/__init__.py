"""From sympy as people have it to named CasADi functions.

    from mechsym import convert
    f = convert.casadi(KanesMethod(..), inputs=[q1, q2, u1, u2, m, g])
    mass_matrix, forcing = f(0.1, 0.2, 0, 0, 1, 9.81)          # mass_matrix * d/dt (q, u) = forcing

expressions.py   node by node, every common part once; what has no counterpart is refused by name
letters.py       dynamicsymbols and their derivatives as letters with names that CasADi takes
methods.py       equations of LagrangesMethod and KanesMethod
"""

from mechsym.convert.methods import casadi

__all__ = ["casadi"]

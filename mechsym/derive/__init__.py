"""The symbolic side: declare a mechanism, derive its exact equations, generate code from them. The only home of sympy
besides `mechsym.audit`.

declare.py    what a mechanism is made of (bodies, joints, springs, forces; records in elements.py)
tape.py       named intermediates and their named derivatives
outputs.py    what shall come out beside the equations
rates.py      velocities and accelerations of named expressions
lagrange.py   mass matrix, bias, generalised forces, energies, reactions
textbook.py   the Lagrangian d/dt(dT/dqdot) - dT/dq as the check
identity.py   is an expression zero? numbers at 50 digits refute, a polynomial certificate proves
printer.py    sympy -> CasADi text and expressions
emit.py       one readable module of Python per mechanism
listing.py    the equations as LaTeX and MathML for reports
build.py      from derivations/ to generated/, or compare the two
"""

from sympy import (
    Abs,
    And,
    Max,
    Min,
    Mod,
    Not,
    Or,
    Piecewise,
    Rational,
    acos,
    asin,
    atan,
    atan2,
    cos,
    exp,
    log,
    pi,
    sign,
    sin,
    sqrt,
    tan,
)

from mechsym.derive.declare import Mechanism
from mechsym.derive.lagrange import Equations, derive, given_equations
from mechsym.derive.outputs import output, output_dynamic
from mechsym.derive.printer import UnsupportedNode, casadi_text, to_casadi
from mechsym.derive.rates import acceleration, reaction, velocities, velocity

__all__ = [
    "Abs", "And", "Equations", "Max", "Mechanism", "Min", "Mod", "Not", "Or", "Piecewise", "Rational",
    "UnsupportedNode", "acceleration", "acos", "asin", "atan", "atan2", "casadi_text", "cos", "derive", "exp",
    "given_equations", "log", "output", "output_dynamic", "pi", "reaction", "sign", "sin", "sqrt", "tan", "to_casadi",
    "velocities", "velocity",
]  # fmt: skip

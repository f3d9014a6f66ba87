"""The symbolic side: declare a mechanism, derive its exact equations, generate code from them. The only home of sympy
besides `mechsym.audit`.

declare.py    what a mechanism is made of (bodies, springs, forces; coordinates, parameters, joints and names in
              letters.py, units in dimensions.py; refusals with file and line in refuse.py)
linkage.py    links and joints without algebra; closing.py places them, by dyads.py or by constraint
roles.py      what parts are for: pistons, rotors, bearings, guides, teeth; drawing.py  how they look
tape.py       named intermediates and their named derivatives
space.py      the same in space: space_parts.py, joints in space_joints.py, rows that close loops in space_rows.py,
              recursions in space_tree.py, equations in space_equations.py, ranks in space_rank.py, vectors.py
rates.py      velocities and accelerations of named expressions, and what shall come out beside the equations
lagrange.py   mass matrix, bias, generalised forces, energies, reactions
textbook.py   the Lagrangian d/dt(dT/dqdot) - dT/dq as the check
identity.py   is an expression zero? numbers at 50 digits refute, a polynomial certificate proves
printer.py    sympy -> CasADi text and expressions
emit.py       one readable module of Python per mechanism, with its stamp
listing.py    the equations as LaTeX and MathML for reports
build.py      from derivations/ to generated/, or compare the two
files.py      mechanisms in files of the user's own
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

from mechsym.derive.declare import Declaration as Mechanism
from mechsym.derive.lagrange import Equations, derive, given_equations
from mechsym.derive.printer import UnsupportedNode, casadi_text, to_casadi
from mechsym.derive.rates import acceleration, output, output_dynamic, reaction, velocities, velocity
from mechsym.derive.space import SpatialDeclaration
from mechsym.derive.space_equations import equations as _in_space  # noqa: F401

__all__ = [
    "Abs", "And", "Equations", "Max", "Mechanism", "Min", "Mod", "Not", "Or", "Piecewise", "Rational",
    "SpatialDeclaration", "UnsupportedNode", "acceleration", "acos", "asin", "atan", "atan2", "casadi_text", "cos",
    "derive", "exp", "given_equations", "log", "output", "output_dynamic", "pi", "reaction", "sign", "sin", "sqrt",
    "tan", "to_casadi", "velocities", "velocity",
]  # fmt: skip

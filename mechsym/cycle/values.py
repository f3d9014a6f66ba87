"""What the formulas of the cycle take and give.

Within one formula all values are of one kind: numbers, or expressions of the same CasADi type. A union such as
`float | SX | MX` cannot say so (a type checker would ask for SX + MX, which does not exist), so both names stand for
any type and say what is meant.
"""

from typing import Any, TypeAlias

Scalar: TypeAlias = Any  # a float, or a CasADi SX or MX scalar
Value: TypeAlias = Any  # a Scalar, or an ndarray of floats

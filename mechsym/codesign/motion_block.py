r"""The steady motion of one point as constraints of the programme, exact under propeller and constant load.

.. math:: u^2 = (\dot\varphi/\omega)^2 = 1 + \frac{2 (g - w)}{I_t \omega^2}, \qquad g' = a (w - g), \qquad
          a = \frac{2 M_r}{I_t \omega^2}

with w the missing work. Propeller: g is periodic, and the mean of u^2 over the angle is 1 of itself. Constant load:
a = 0, g is a number, and a governor holds the mean speed in time, mean(1/u) = 1.
"""

import casadi as ca
import numpy as np

from mechsym.codesign.points import Point, Samples
from mechsym.quantities import record
from mechsym.quantities.units import Inertia, Joule, NewtonMetre, Pure, Scalar


@record
class MotionRows:
    """Unknowns and constraints of one motion, scaled to the order of one."""

    unknowns: ca.SX  #: g by its scale, then the lowest and the highest u [-]
    start: np.ndarray  #: where the unknowns start [-]
    ripple: ca.SX  #: (max - min) / mean over the angles; the programme bounds it from above [-]
    rows: tuple[ca.SX, ...]  #: constraints in pieces: low <= rows <= high [-]
    low: tuple[float, ...]  #: least value of each piece [-]
    high: tuple[float, ...]  #: largest value of each piece [-]


def block(
    point: Point,
    k: int,
    samples: Samples,
    missing: Joule[Scalar],
    inertia: Inertia[Scalar],
    ripple: Pure[Scalar],
    taken: NewtonMetre[Scalar] = 0.0,
) -> MotionRows:
    """The motion of a point that keeps a ripple.

    missing: work that is wanted and missing; inertia: all inertia that turns; ripple: largest (max - min) / mean of the
    speed; taken: mean torque that the hinge takes from the load.
    """
    n = samples.phi.size
    scale = 0.1 * float(np.ptp(samples.work[k]))
    propeller = point.law == "propeller"
    g = ca.SX.sym(f"g{k}", n if propeller else 1)
    u_low, u_high = ca.SX.sym(f"u_low{k}"), ca.SX.sym(f"u_high{k}")
    lag = g - missing / scale
    squares = 1 + 2 * scale * lag / (inertia * point.omega**2)
    # outside of sensible speeds the square root would leave the programme without a number
    inverse = 1 / ca.sqrt(ca.fmax(squares, 1e-3))
    mean = ca.dot(ca.DM(samples.weights), inverse)
    rows = [squares - u_low**2, squares - u_high**2, (u_high - u_low) * mean - ripple]
    if propeller:
        rate = -2 * (point.load_torque - taken) / (inertia * point.omega**2) * lag
        after = ca.vertcat(rate[1:], rate[0])
        rows.append(ca.vertcat(g[1:], g[0]) - g - ca.DM(samples.step) / 2 * (rate + after))
    else:
        rows.append(mean - 1)
    return MotionRows(
        unknowns=ca.vertcat(g, u_low, u_high),
        start=np.concatenate([np.zeros(g.numel()), [0.9, 1.1]]),
        ripple=(ca.mmax(1 / inverse) - ca.mmin(1 / inverse)) * mean,
        rows=tuple(rows),
        low=(0.0, -np.inf, -np.inf, 0.0),
        high=(np.inf, 0.0, 0.0, 0.0),
    )

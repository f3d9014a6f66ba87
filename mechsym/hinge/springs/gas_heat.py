r"""A closed gas that exchanges heat with a wall of constant temperature.

    p = m R T / V,   V = A (H - z)                closed gas, one temperature, wall at T_w
    tau = m c_v / (h A_w)                         time in which the gas takes the temperature of the wall

.. math:: T' = -(\gamma - 1)\,T\,\frac{V'}{V} - \frac{T - T_w}{\omega\tau}, \qquad s = T V^{\gamma - 1}: \quad
          s' = \frac{T_w V^{\gamma - 1} - s}{\omega\tau}

over the angle. It is linear in s: one pass around the turn and one division give the periodic motion. tau to infinity
is the adiabatic spring, n = gamma; tau to 0 the isothermal one, n = 1; both give back all that they take. Between them
heat flows through a difference of temperature, and work is lost: a spring that shows n = 1.25 with gamma = 1.4 has
omega tau = 1.29, and that is where it loses most. Only a heat store that follows the gas (foam) shows it without loss.
"""

import casadi as ca
import numpy as np

from mechsym.hinge.losses import HingeLosses
from mechsym.quantities.units import Kelvin, Metre, Pascal, Pure, Radian, Scalar, Volume

R_NITROGEN = 296.8  # [J/kg/K]


def thermal_pressure(
    z: Metre[Scalar], H: Metre[Scalar], p0: Pascal[Scalar], pa: Pascal[Scalar], warmth: Pure[Scalar]
) -> Pascal[Scalar]:
    r"""Excess pressure of a gas spring whose temperature is known, for numbers and symbols alike.

    .. math:: p = (p_0 + p_a) \frac{H}{H - z} \frac{T}{T_w} - p_a

    z, H: closing and free height; p0, pa: excess pressure of the full column at the wall's temperature, and the
    pressure outside. Source: ideal gas of constant mass.

    >>> thermal_pressure(0.5, 1.0, 5e6, 1e5, 1.0)
    10100000.0
    """
    return (p0 + pa) * (H / (H - z)) * warmth - pa


def gas_temperature(
    volume: Volume[Scalar], step: Radian[Scalar], x: Radian[Scalar], gamma: Pure, wall: Kelvin
) -> Kelvin[Scalar]:
    r"""Periodic temperature of a closed gas in a volume that moves; arrays and CasADi symbols.

    .. math:: s_{i+1} = e^{-h/x} s_i + T_w \int V^{\gamma - 1} e^{-(h - t)/x} \frac{dt}{x}, \qquad T = s V^{1 - \gamma}

    with V^(gamma - 1) a straight line over each step: exact in the limits of slow and fast exchange. volume: V over one
    period without its end, in any unit. step: angle from each to the next; the last one closes the period. x: omega
    tau. gamma: ratio of specific heats. Source: first law of a closed gas with heat flow in proportion to T - T_w.
    Valid: one temperature in the gas, wall of constant temperature, ideal gas.

    >>> still = gas_temperature(np.ones(4), np.full(4, np.pi / 2), 1.0, 1.4, 320.0)
    >>> np.round(still, 6).tolist()
    [320.0, 320.0, 320.0, 320.0]
    """
    forcing, count = wall * volume ** (gamma - 1), volume.shape[0]
    symbols = isinstance(volume, ca.SX | ca.MX)
    rates = [step[i] / x for i in range(count)] if symbols else list(np.asarray(step) / x)
    known: dict[Scalar, tuple[Scalar, Scalar, Scalar]] = {}
    for r in rates:  # even angles have one relaxation
        if symbols or r not in known:
            known[r] = relaxation(r)
    decay = [known[r][0] for r in rates]
    gains = [known[r][1] * forcing[i] + known[r][2] * forcing[(i + 1) % count] for i, r in enumerate(rates)]
    end = 0.0
    for keep, gain in zip(decay, gains, strict=True):
        end = keep * end + gain
    values = [end / _lost(sum(rates))]
    for keep, gain in zip(decay[:-1], gains[:-1], strict=True):
        values.append(keep * values[-1] + gain)
    return (ca.vertcat(*values) if symbols else np.array(values)) * volume ** (1 - gamma)


def relaxation_time(n: float, omega: float, losses: HingeLosses) -> float:
    """Time [s] of the gas to take the wall's temperature: as assumed, or such that the index n shows at omega [rad/s].

    An index at gamma or above leaves no exchange, one at 1 a very fast one.
    """
    if losses.tau > 0:
        return losses.tau
    return x_of_index(min(max(n, 1 + 1e-6), losses.gamma - 1e-6), losses.gamma) / omega


def x_of_index(n: Pure, gamma: Pure = 1.4) -> Radian:
    r"""omega tau at which small strokes show an index between 1 and gamma.

    .. math:: x = \sqrt{\frac{n - 1}{\gamma - n}}

    n: index, above 1 and below gamma; gamma: ratio of specific heats.

    >>> round(x_of_index(1.25), 2)
    1.29
    """
    return float(np.sqrt((n - 1) / (gamma - n)))


def relaxation(r: Scalar) -> tuple[Scalar, Scalar, Scalar]:
    """exp(-r), and the weights of both ends of a straight line over a step of r relaxation times [-]."""
    keep, lost = _exp(-r), _lost(r)
    # lost / r - keep cancels for short steps; there its series stands
    short = r / 2 - r**2 / 3 + r**3 / 8
    if isinstance(r, ca.SX | ca.MX):
        first = ca.if_else(r < 1e-4, short, lost / r - keep)
    else:
        first = short if r < 1e-4 else lost / r - keep
    return keep, first, lost - first


def _exp(r: Scalar) -> Scalar:
    return ca.exp(r) if isinstance(r, ca.SX | ca.MX) else float(np.exp(r))


def _lost(r: Scalar) -> Scalar:
    """1 - exp(-r) with all its digits."""
    return -ca.expm1(-r) if isinstance(r, ca.SX | ca.MX) else float(-np.expm1(-r))

r"""Gas spring that exchanges heat with its wall: the law `air_thermal`.

    p = m R T / V,   V = A (H - z)                closed gas, one temperature, wall at T_w
    tau = m c_v / (h A_w)                         time in which the gas takes the temperature of the wall

.. math:: T' = -(\gamma - 1)\,T\,\frac{V'}{V} - \frac{T - T_w}{\omega\tau}, \qquad s = T V^{\gamma - 1}: \quad
          s' = \frac{T_w V^{\gamma - 1} - s}{\omega\tau}

over the angle. It is linear in s: one pass around the turn and one division give the periodic motion. tau to infinity
is the adiabatic spring, n = gamma; tau to 0 the isothermal one, n = 1; both give back all that they take. Between them
heat flows through a difference of temperature, and work is lost: a spring that shows n = 1.25 with gamma = 1.4 has
omega tau = 1.29, and that is where it loses most. Only a heat store that follows the gas (foam) shows it without loss.
"""

from typing import Any

import casadi as ca
import numpy as np

from mechsym.quantities import quantity, record

R_NITROGEN = 296.8  # [J/kg/K]


@record
class AirThermal:
    """Gas spring with a wall of constant temperature; what leaks, make-up brings back."""

    A: float = quantity("m^2", low=1e-8, high=100, about="piston area")
    H: float = quantity("m", low=1e-4, high=100, about="free height of the gas column")
    p0: float = quantity("Pa", low=1, high=1e12, about="excess pressure of the full column at the wall's temperature")
    tau: float = quantity("s", above=0, about="time in which the gas takes the temperature of the wall")
    gamma: float = quantity("-", default=1.4, above=1, below=2, about="ratio of specific heats")
    wall_temperature: float = quantity("K", default=320.0, above=0, about="temperature of the wall")
    pa: float = quantity("Pa", default=101325.0, low=0, about="pressure outside, absolute")
    leak: float = quantity("kg/s/Pa", default=0.0, low=0, about="leakage by excess pressure")


@record
class GasTurn:
    """A periodic turn of the gas; arrays over the angles that were asked for."""

    temperature: np.ndarray  #: shape (n,) [K]
    pressure: np.ndarray  #: excess pressure, shape (n,) [Pa]
    loss: float = quantity("J", about="work that the gas takes and does not give back in a period")
    n_effective: float = quantity("-", about="index that fits pressure over volume around the turn")
    leaked: float = quantity("kg", default=0.0, about="mass that make-up has to bring back in a period")


def thermal_pressure(z: Any, H: Any, p0: Any, pa: Any, warmth: Any) -> Any:
    r"""Excess pressure of a gas spring whose temperature is known, for numbers and symbols alike.

    .. math:: p = (p_0 + p_a) \frac{H}{H - z} \frac{T}{T_w} - p_a

    Parameters
    ----------
    z, H : float, ndarray or casadi.SX
        Closing and free height [m]
    p0, pa : float or casadi.SX
        Excess pressure of the full column at the wall's temperature, and the pressure outside [Pa]
    warmth : float, ndarray or casadi.SX
        T / T_w [-]

    Returns
    -------
    p : same kind as z
        Excess pressure [Pa]

    Notes
    -----
    Source: ideal gas of constant mass.

    Examples
    --------
    >>> thermal_pressure(0.5, 1.0, 5e6, 1e5, 1.0)
    10100000.0
    """
    return (p0 + pa) * (H / (H - z)) * warmth - pa


def gas_temperature(volume: Any, step: Any, x: Any, gamma: float, wall: float) -> Any:
    r"""Periodic temperature of a closed gas in a volume that moves; arrays and CasADi symbols.

    .. math:: s_{i+1} = e^{-h/x} s_i + T_w \int V^{\gamma - 1} e^{-(h - t)/x} \frac{dt}{x}, \qquad T = s V^{1 - \gamma}

    with V^(gamma - 1) a straight line over each step: exact in the limits of slow and fast exchange.

    Parameters
    ----------
    volume : ndarray or casadi.SX, shape (n,)
        V over one period without its end, in any unit [m^3]
    step : ndarray, shape (n,)
        Angle from each to the next; the last one closes the period [rad]
    x : float or casadi.SX
        omega tau [rad]
    gamma : float
        Ratio of specific heats [-]
    wall : float
        Temperature of the wall [K]

    Returns
    -------
    temperature : same kind as volume, shape (n,)
        [K]

    Notes
    -----
    Source: first law of a closed gas with heat flow in proportion to T - T_w. Valid: one temperature in the gas, wall
    of constant temperature, ideal gas.

    Examples
    --------
    >>> still = gas_temperature(np.ones(4), np.full(4, np.pi / 2), 1.0, 1.4, 320.0)
    >>> np.round(still, 6).tolist()
    [320.0, 320.0, 320.0, 320.0]
    """
    forcing, count = wall * volume ** (gamma - 1), volume.shape[0]
    symbols = isinstance(volume, ca.SX | ca.MX)
    rates = [step[i] / x for i in range(count)] if symbols else list(np.asarray(step) / x)
    known: dict[Any, Any] = {}
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


def turn(spring: AirThermal, z: np.ndarray, step: np.ndarray, omega: float) -> GasTurn:
    r"""Periodic turn of the gas in a spring whose closing is given.

    .. math:: p = (p_0 + p_a) \frac{H}{H - z} \frac{T}{T_w} - p_a, \qquad L = -\oint p\,A\,d(H - z) > 0

    Parameters
    ----------
    spring : AirThermal
        Filled with the mass of the full column at p0 and the temperature of the wall
    z : ndarray, shape (n,)
        Closing over one period without its end [m]
    step : ndarray, shape (n,)
        Angle from each to the next [rad]
    omega : float
        Speed of the shaft [rad/s]

    Returns
    -------
    turn : GasTurn
        Temperature [K], pressure [Pa], loss [J], index [-], leakage [kg]

    Notes
    -----
    Small strokes: n* = 1 + (gamma - 1)(x^2 + i x)/(1 + x^2), x = omega tau; loss pi Im(n*) p V (dV/V)^2. In a turn
    the gas gives as heat what it keeps of the work: slow exchange is summed as heat, where the work would cancel, fast
    exchange as work, where the difference of temperature would.
    """
    height = spring.H - z
    x = omega * spring.tau
    T = gas_temperature(height, step, x, spring.gamma, spring.wall_temperature)
    filled = spring.p0 + spring.pa
    absolute = thermal_pressure(z, spring.H, spring.p0, spring.pa, T / spring.wall_temperature) + spring.pa
    weights = (step + np.roll(step, 1)) / 2
    if x > 1:
        heat = filled * spring.A * spring.H / (spring.gamma - 1) * (T / spring.wall_temperature - 1) / x
        loss = float(heat @ weights)
    else:
        loss = -float((absolute + np.roll(absolute, -1)) / 2 @ (np.roll(height, -1) - height)) * spring.A
    excess = np.maximum(absolute - spring.pa, 0.0)
    return GasTurn(
        temperature=T,
        pressure=absolute - spring.pa,
        loss=loss,
        n_effective=_index(height, absolute, weights),
        leaked=float(spring.leak * (excess @ weights) / omega),
    )


def small_stroke_index(x: float, gamma: float = 1.4) -> complex:
    r"""Index of a gas spring for small strokes, complex where work is lost.

    .. math:: n^* = 1 + (\gamma - 1) \frac{x^2 + i x}{1 + x^2}, \qquad x = \omega \tau

    Parameters
    ----------
    x : float
        omega tau [rad]
    gamma : float
        Ratio of specific heats [-]

    Returns
    -------
    index : complex
        Real part: what an indicator shows; imaginary part: loss, at most (gamma - 1)/2 [-]

    Notes
    -----
    The loss of a turn is pi Im(n*) p V (dV/V)^2 with the amplitude dV of the volume.

    Examples
    --------
    >>> index = small_stroke_index(1.29)
    >>> round(index.real, 3), round(index.imag, 3)
    (1.25, 0.194)
    """
    return 1 + (gamma - 1) * complex(x**2, x) / (1 + x**2)


def x_of_index(n: float, gamma: float = 1.4) -> float:
    r"""omega tau at which small strokes show an index between 1 and gamma.

    .. math:: x = \sqrt{\frac{n - 1}{\gamma - n}}

    Parameters
    ----------
    n : float
        Index, above 1 and below gamma [-]
    gamma : float
        Ratio of specific heats [-]

    Returns
    -------
    x : float
        omega tau [rad]

    Examples
    --------
    >>> round(x_of_index(1.25), 2)
    1.29
    """
    return float(np.sqrt((n - 1) / (gamma - n)))


def foam_index(gas: float, store: float, gamma: float = 1.4) -> float:
    r"""Index of a gas whose heat store follows its temperature, such as foam: reversible, without loss.

    .. math:: n = \frac{m c_p + C}{m c_v + C}

    Parameters
    ----------
    gas : float
        Heat capacity of the gas at constant volume, m c_v [J/K]
    store : float
        Heat capacity of what follows it, C [J/K]
    gamma : float
        Ratio of specific heats [-]

    Returns
    -------
    n : float
        Between 1 and gamma [-]

    Examples
    --------
    >>> foam_index(1.0, 0.6)
    1.25
    """
    return (gamma * gas + store) / (gas + store)


def relaxation(r: Any) -> tuple[Any, Any, Any]:
    """exp(-r), and the weights of both ends of a straight line over a step of r relaxation times."""
    keep, lost = _exp(-r), _lost(r)
    # lost / r - keep cancels for short steps; there its series stands
    short = r / 2 - r**2 / 3 + r**3 / 8
    if isinstance(r, ca.SX | ca.MX):
        first = ca.if_else(r < 1e-4, short, lost / r - keep)
    else:
        first = short if r < 1e-4 else lost / r - keep
    return keep, first, lost - first


def _exp(r: Any) -> Any:
    return ca.exp(r) if isinstance(r, ca.SX | ca.MX) else float(np.exp(r))


def _lost(r: Any) -> Any:
    """1 - exp(-r) with all its digits."""
    return -ca.expm1(-r) if isinstance(r, ca.SX | ca.MX) else float(-np.expm1(-r))


def _index(height: np.ndarray, pressure: np.ndarray, weights: np.ndarray) -> float:
    """Slope of the straight line through ln p over ln V; 1 for a spring that does not move."""
    v, p = np.log(height), np.log(pressure)
    v, p = v - v @ weights / weights.sum(), p - p @ weights / weights.sum()
    square = float((v * v) @ weights)
    return 1.0 if square <= 1e-30 else -float((v * p) @ weights) / square

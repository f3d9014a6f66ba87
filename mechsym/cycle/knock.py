r"""Knock: how far the end gas gets on its way to igniting by itself before the flame has passed through it.

Livengood and Wu's integral adds up the shares of the ignition delay that pass; the mixture knocks where it reaches 1
before combustion ends. The delay is Douaud and Eyzat's; the end gas is compressed without heat by what burns.
"""

from collections.abc import Callable, Mapping

import casadi as ca
import numpy as np

from mechsym.cycle.closed.run import GRADING, steps_of
from mechsym.cycle.heat import ConstantGamma, NasaMixture, properties
from mechsym.quantities.units import Array, Kelvin, Pascal, Pure, Radian, RadPerSecond, Scalar, Second

ATM = 101325.0
_SYMBOLS = (ca.SX, ca.MX, ca.DM)
# end weights that make equal steps exact for cubics (Gregory)
_ENDS = (3 / 8, 7 / 6, 23 / 24)
_NODES = 481


def ignition_delay(p: Pascal[Scalar], T: Kelvin[Scalar], octane: Pure[Scalar]) -> Second[Scalar]:
    r"""Time until a mixture of gasoline and air ignites by itself.

    .. math:: \tau = 17.68\,\mathrm{ms}\,\left(\frac{ON}{100}\right)^{3.402}
              \left(\frac{p}{1\,\mathrm{atm}}\right)^{-1.7} \exp\frac{3800\,\mathrm{K}}{T}

    p: absolute pressure; T: temperature of the end gas; octane: octane number of the fuel. Returns tau: delay.
    Source: A. M. Douaud, P. Eyzat, SAE 780080 (1978), as printed in J. B. Heywood, Internal Combustion Engine
    Fundamentals (1988), eq. (9.27). Valid: octane number 80 to 100, stoichiometric, engine conditions; fitted on few
    engines, so a limit of 1 is good for comparing designs and not for guaranteeing one.

    >>> round(float(ignition_delay(50 * ATM, 900.0, 95.0)) * 1e3, 3)
    1.31
    """
    exp = ca.exp if isinstance(T, _SYMBOLS) else np.exp
    return 17.68e-3 * (octane / 100) ** 3.402 * (p / ATM) ** -1.7 * exp(3800 / T)


def end_gas_temperature(
    p: Pascal[Scalar], p_0: Pascal[Scalar], T_0: Kelvin[Scalar], kappa: Pure[Scalar]
) -> Kelvin[Scalar]:
    r"""Temperature of the end gas, compressed without heat.

    .. math:: T_u = T_0 \left(\frac{p}{p_0}\right)^{\kappa}, \qquad \kappa = R/c_p

    p, p_0: absolute pressure, and that when combustion starts; T_0: temperature when combustion starts; kappa: gas
    constant by heat capacity at constant pressure.
    Source: isentropic ideal gas. Valid: no heat to the walls, kappa taken where combustion starts.

    >>> round(float(end_gas_temperature(40e5, 20e5, 700.0, 0.25)), 1)
    832.4
    """
    return T_0 * (p / p_0) ** kappa


def share_of_delay(
    s_slope: Radian[Scalar], p: Scalar, T: Scalar, omega: RadPerSecond[Scalar], octane: Pure[Scalar]
) -> Pure[Scalar]:
    r"""Livengood and Wu's integral over a stretch whose nodes lie evenly in a variable s from 0 to 1.

    .. math:: K = \int \frac{\mathrm{d}t}{\tau(p, T)} = \int_0^1 \frac{1}{\omega\,\tau}\,
              \frac{\mathrm{d}\varphi}{\mathrm{d}s}\,\mathrm{d}s

    s_slope: dphi/ds at the nodes, n at least 6. Returns share: 1 where the end gas ignites by itself, shape (k,).

    p, T: pressure and temperature of the end gas at the nodes, of k cycles side by side [Pa, K], shape (n,) or (k, n).
    Source: J. C. Livengood, P. C. Wu, Proc. Combust. Inst. 5 (1955) 347. Valid: the delay depends on the instant alone.

    >>> n = np.ones(9)
    >>> tau = float(ignition_delay(2e6, 800.0, 95.0))
    >>> round(float(share_of_delay(200.0 * tau * n, 2e6 * n, 800.0 * n, 200.0, 95.0)), 12)
    1.0
    """
    n = p.numel() if isinstance(p, _SYMBOLS) else np.shape(p)[-1]
    weights = np.ones(n) / (n - 1)
    weights[:3] *= _ENDS
    weights[-3:] *= _ENDS[::-1]
    rate = s_slope / (omega * ignition_delay(p, T, octane))
    return ca.mtimes(rate, ca.DM(weights)) if isinstance(rate, _SYMBOLS) else (rate @ weights)[()]


def knock_integral(
    values: Mapping[str, ca.MX], steps: int, gas: ConstantGamma | NasaMixture, octane: Pure[Scalar]
) -> Scalar:
    """Livengood and Wu's integral of a closed period, from the closing of the inlet to the end of combustion [-].

    values: mapping of str to CasADi expression, what `closed_function` gives: nodes `p` [Pa] and `t` [K], and the
    angles between the phases [rad]. steps: steps of that function in all. octane: octane number of the fuel.
    """
    first, second = steps_of("before", steps) + 1, steps_of("during", steps) + 1
    before = values["p"][:first], values["t"][:first]
    p, p_0, T_0 = values["p"][first : first + second], before[0][first - 1], before[1][first - 1]
    T = end_gas_temperature(p, p_0, T_0, kappa(gas, T_0))
    power = GRADING["during"]
    grading = ca.DM(power * np.linspace(0, 1, second) ** (power - 1)).T
    still, burning = values["starts"] - values["closes"], values["ends"] - values["starts"]
    ahead = share_of_delay(still * ca.DM.ones(1, first), *before, values["omega"], octane)
    return ahead + share_of_delay(burning * grading, p, T, values["omega"], octane)


def knock_of_runs(
    values: Mapping[str, np.ndarray], gas: ConstantGamma | NasaMixture, octane: Pure[Scalar]
) -> Pure[Array]:
    """The same integral of closed periods that are numbers, one beside the other.

    values: nodes `p` [Pa] and `t` [K] of shape (k, steps + 3), angles between the phases [rad] and `omega` [rad/s] of
    shape (k,); octane: octane number of the fuel, shape (k,). Returns share: 1 where the end gas ignites by itself,
    shape (k,).
    """
    steps = values["p"].shape[1] - 3
    first, second = steps_of("before", steps) + 1, steps_of("during", steps) + 1
    column = {name: np.asarray(values[name], float)[:, None] for name in ("closes", "starts", "ends", "omega")}
    number = np.broadcast_to(np.asarray(octane, float), values["p"].shape[:1])[:, None]
    p, p_0, T_0 = values["p"][:, first : first + second], values["p"][:, [first - 1]], values["t"][:, [first - 1]]
    T = end_gas_temperature(p, p_0, T_0, kappa(gas, T_0))
    power = GRADING["during"]
    grading = power * np.linspace(0, 1, second) ** (power - 1)
    ahead = share_of_delay(
        column["starts"] - column["closes"], values["p"][:, :first], values["t"][:, :first], column["omega"], number
    )
    return np.asarray(
        ahead + share_of_delay((column["ends"] - column["starts"]) * grading, p, T, column["omega"], number)
    )


def knock_along(
    curves: tuple[Callable[[Scalar], Scalar], Callable[[Scalar], Scalar]],
    angles: tuple[Radian, Radian, Radian],
    omega: RadPerSecond,
    share: Pure,
    octane: Pure,
) -> float:
    """The same integral along a cycle whose pressure [Pa] and temperature [K] are functions of the crank angle [rad].

    angles: where the inlet closes, combustion starts and ends; share: gas constant by heat capacity at constant
    pressure; octane: octane number of the fuel.
    """
    (pressure, temperature), (closes, starts, ends) = curves, angles
    before, during = np.linspace(closes, starts, _NODES), np.linspace(starts, ends, _NODES)
    p = pressure(during)
    T = end_gas_temperature(p, p[0], temperature(starts), share)
    ahead = share_of_delay(starts - closes, pressure(before), temperature(before), omega, octane)
    return float(ahead + share_of_delay(ends - starts, p, T, omega, octane))


def kappa(gas: ConstantGamma | NasaMixture, T: Scalar) -> Scalar:
    """Gas constant by heat capacity at constant pressure, of the unburnt gas at a temperature [K]."""
    air = properties(gas, T, 0.0)
    return air.gas_constant / (air.heat_capacity + air.gas_constant)

r"""Knock: how far the end gas gets on its way to igniting by itself before the flame has passed through it.

Livengood and Wu's integral adds up the shares of the ignition delay that pass; the mixture knocks where it reaches 1
before combustion ends. The delay is Douaud and Eyzat's; the end gas is compressed without heat by what burns.
"""

from collections.abc import Mapping
from typing import Any

import casadi as ca
import numpy as np

from mechsym.cycle.closed.phases import GRADING, steps_of
from mechsym.cycle.mixture import ConstantGamma, NasaMixture, properties

ATM = 101325.0
_SYMBOLS = (ca.SX, ca.MX, ca.DM)
# end weights that make equal steps exact for cubics (Gregory)
_ENDS = (3 / 8, 7 / 6, 23 / 24)


def ignition_delay(p: Any, T: Any, octane: Any) -> Any:
    r"""Time until a mixture of gasoline and air ignites by itself.

    .. math:: \tau = 17.68\,\mathrm{ms}\,\left(\frac{ON}{100}\right)^{3.402}
              \left(\frac{p}{1\,\mathrm{atm}}\right)^{-1.7} \exp\frac{3800\,\mathrm{K}}{T}

    Parameters
    ----------
    p : float, ndarray or CasADi expression
        Absolute pressure [Pa]
    T : float, ndarray or CasADi expression
        Temperature of the end gas [K]
    octane : float or CasADi expression
        Octane number of the fuel [-]

    Returns
    -------
    tau : same kind as `p`
        Delay [s]

    Notes
    -----
    Source: A. M. Douaud, P. Eyzat, SAE 780080 (1978), as printed in J. B. Heywood, Internal Combustion Engine
    Fundamentals (1988), eq. (9.27). Valid: octane number 80 to 100, stoichiometric, engine conditions; fitted on few
    engines, so a limit of 1 is good for comparing designs and not for guaranteeing one.

    Examples
    --------
    >>> round(float(ignition_delay(50 * ATM, 900.0, 95.0)) * 1e3, 3)
    1.31
    """
    exp = ca.exp if isinstance(T, _SYMBOLS) else np.exp
    return 17.68e-3 * (octane / 100) ** 3.402 * (p / ATM) ** -1.7 * exp(3800 / T)


def end_gas_temperature(p: Any, p_0: Any, T_0: Any, kappa: Any) -> Any:
    r"""Temperature of the end gas, compressed without heat.

    .. math:: T_u = T_0 \left(\frac{p}{p_0}\right)^{\kappa}, \qquad \kappa = R/c_p

    Parameters
    ----------
    p, p_0 : float, ndarray or CasADi expression
        Absolute pressure, and that when combustion starts [Pa]
    T_0 : float or CasADi expression
        Temperature when combustion starts [K]
    kappa : float or CasADi expression
        Gas constant by heat capacity at constant pressure [-]

    Returns
    -------
    T_u : same kind as `p`
        Temperature [K]

    Notes
    -----
    Source: isentropic ideal gas. Valid: no heat to the walls, kappa taken where combustion starts.

    Examples
    --------
    >>> round(float(end_gas_temperature(40e5, 20e5, 700.0, 0.25)), 1)
    832.4
    """
    return T_0 * (p / p_0) ** kappa


def share_of_delay(s_slope: Any, p: Any, T: Any, omega: Any, octane: Any) -> Any:
    r"""Livengood and Wu's integral over a stretch whose nodes lie evenly in a variable s from 0 to 1.

    .. math:: K = \int \frac{\mathrm{d}t}{\tau(p, T)} = \int_0^1 \frac{1}{\omega\,\tau}\,
              \frac{\mathrm{d}\varphi}{\mathrm{d}s}\,\mathrm{d}s

    Parameters
    ----------
    s_slope : ndarray or CasADi row, shape (n,)
        dphi/ds at the nodes, n at least 6 [rad]
    p, T : ndarray or CasADi row, shape (n,)
        Pressure and temperature of the end gas at the nodes [Pa, K]
    omega : float or CasADi expression
        Crank speed [rad/s]
    octane : float or CasADi expression
        Octane number [-]

    Returns
    -------
    share : float or CasADi expression
        1 where the end gas ignites by itself [-]

    Notes
    -----
    Source: J. C. Livengood, P. C. Wu, Proc. Combust. Inst. 5 (1955) 347. Valid: the delay depends on the instant alone.

    Examples
    --------
    >>> n = np.ones(9)
    >>> tau = float(ignition_delay(2e6, 800.0, 95.0))
    >>> round(float(share_of_delay(200.0 * tau * n, 2e6 * n, 800.0 * n, 200.0, 95.0)), 12)
    1.0
    """
    n = p.numel() if isinstance(p, _SYMBOLS) else np.size(p)
    weights = np.ones(n) / (n - 1)
    weights[:3] *= _ENDS
    weights[-3:] *= _ENDS[::-1]
    rate = s_slope / (omega * ignition_delay(p, T, octane))
    return ca.mtimes(rate, ca.DM(weights)) if isinstance(rate, _SYMBOLS) else float(rate @ weights)


def knock_integral(found: Mapping[str, Any], steps: int, gas: ConstantGamma | NasaMixture, octane: Any) -> Any:
    """Livengood and Wu's integral of a closed period, from the closing of the inlet to the end of combustion.

    Parameters
    ----------
    found : mapping of str to CasADi expression
        What `closed_function` gives: nodes `p` [Pa] and `t` [K], and the angles between the phases [rad]
    steps : int
        Steps of that function in all
    octane : float or CasADi expression
        Octane number of the fuel [-]
    """
    first, second = steps_of("before", steps) + 1, steps_of("during", steps) + 1
    before = found["p"][:first], found["t"][:first]
    p, p_0, T_0 = found["p"][first : first + second], before[0][first - 1], before[1][first - 1]
    air = properties(gas, T_0, 0.0)
    T = end_gas_temperature(p, p_0, T_0, air.gas_constant / (air.heat_capacity + air.gas_constant))
    power = GRADING["during"]
    grading = ca.DM(power * np.linspace(0, 1, second) ** (power - 1)).T
    still, burning = found["starts"] - found["closes"], found["ends"] - found["starts"]
    ahead = share_of_delay(still * ca.DM.ones(1, first), *before, found["omega"], octane)
    return ahead + share_of_delay(burning * grading, p, T, found["omega"], octane)

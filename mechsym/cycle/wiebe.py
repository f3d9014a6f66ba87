r"""Wiebe functions: the burnt fraction f(y) over the scaled crank angle y = (phi - start) / duration.

    f  1 |          ________
         |       .-'
         |     .'              single:  f = 1 - exp(-a y^(m+1))
       0 |__.-'____________    double:  premixed share (1 - b), diffusive share b
            0     y = 1   y

f is 0 up to the start (y <= 0) and goes on beyond the nominal end y = 1, where it is 1 - exp(-a), not 1: `duration` is
a scale, not a stop. Floats, arrays and CasADi symbols are taken; the derivatives of the symbolic form are finite at
y = 0, also with respect to m.
"""

from typing import Any

import casadi as ca
import numpy as np

from mechsym.cycle.values import Value

# Smallest y of the symbolic form: log(y), which the derivative with respect to m needs, stays finite
_TINY = 1e-300

# Fitted sets of Shen et al. (2020), from low to high load
SHEN_2020 = (
    {"a_p": 3.415, "a_d": 23.8, "m_p": 1.148, "m_d": 1.006, "b": 0.6749},
    {"a_p": 3.769, "a_d": 23.72, "m_p": 1.292, "m_d": 0.9729, "b": 0.6481},
    {"a_p": 3.45, "a_d": 17.28, "m_p": 1.578, "m_d": 0.9035, "b": 0.6992},
    {"a_p": 3.319, "a_d": 12.71, "m_p": 2.2, "m_d": 0.7247, "b": 0.8023},
)


def wiebe(y: Value, a: Value, m: Value) -> Value:
    r"""Burnt fraction of one Wiebe function.

    .. math:: f = 1 - \exp(-a\,y^{m+1}), \quad y \ge 0

    Parameters
    ----------
    y : float, ndarray or casadi symbol
        (phi - start) / duration; values below 0 count as 0 [-]
    a : float or casadi symbol
        Completeness: f(1) = 1 - exp(-a) [-]
    m : float or casadi symbol
        Form factor, m >= 0 [-]

    Returns
    -------
    f : like y
        Burnt fraction, 0 <= f < 1 [-]

    Notes
    -----
    Valid: m >= 0; for -1 < m < 0 the rate at y = 0 is infinite.
    Source: Wiebe (1956); Shen et al. (2020).
    """
    return -_expm1(-a * _from_start(y) ** (m + 1))


def dwiebe_dy(y: Value, a: Value, m: Value) -> Value:
    r"""Burning rate of one Wiebe function.

    .. math:: \frac{df}{dy} = a (m+1)\, y^m \exp(-a\,y^{m+1}), \quad y \ge 0

    Parameters
    ----------
    y : float, ndarray or casadi symbol
        (phi - start) / duration; the rate is 0 below 0 [-]
    a : float or casadi symbol
        Completeness [-]
    m : float or casadi symbol
        Form factor, m >= 0 [-]

    Returns
    -------
    rate : like y
        df/dy; divide by the duration for df/dphi [-]

    Notes
    -----
    For m = 0 the rate steps to a at y = 0, the value given there.
    """
    t = _from_start(y)
    return _where_burning(y, a * (m + 1) * t**m * _exp(-a * t ** (m + 1)))


def double_wiebe(y: Value, a_p: Value, m_p: Value, a_d: Value, m_d: Value, b: Value) -> Value:
    r"""Burnt fraction of a premixed and a diffusive Wiebe function with a common start.

    .. math:: f = (1-b)\,[1-\exp(-a_p\,y^{m_p+1})] + b\,[1-\exp(-a_d\,y^{m_d+1})]

    Parameters
    ----------
    y : float, ndarray or casadi symbol
        (phi - start) / duration; values below 0 count as 0 [-]
    a_p, m_p : float or casadi symbol
        Completeness and form factor of the share 1 - b [-]
    a_d, m_d : float or casadi symbol
        Completeness and form factor of the share b [-]
    b : float or casadi symbol
        Share of the second function, 0 <= b <= 1 [-]

    Returns
    -------
    f : like y
        Burnt fraction [-]

    Notes
    -----
    Source: Shen et al. (2020), J. Mar. Sci. Eng.; the letters p and d are theirs.
    """
    return (1 - b) * wiebe(y, a_p, m_p) + b * wiebe(y, a_d, m_d)


def ddouble_wiebe_dy(y: Value, a_p: Value, m_p: Value, a_d: Value, m_d: Value, b: Value) -> Value:
    r"""Burning rate of `double_wiebe`.

    .. math:: \frac{df}{dy} = (1-b)\,f_p'(y) + b\,f_d'(y)

    Parameters
    ----------
    y : float, ndarray or casadi symbol
        (phi - start) / duration; the rate is 0 below 0 [-]
    a_p, m_p : float or casadi symbol
        Completeness and form factor of the share 1 - b [-]
    a_d, m_d : float or casadi symbol
        Completeness and form factor of the share b [-]
    b : float or casadi symbol
        Share of the second function, 0 <= b <= 1 [-]

    Returns
    -------
    rate : like y
        df/dy; divide by the duration for df/dphi [-]
    """
    return (1 - b) * dwiebe_dy(y, a_p, m_p) + b * dwiebe_dy(y, a_d, m_d)


def _symbolic(value: Any) -> bool:
    return isinstance(value, (ca.SX, ca.MX))


def _from_start(y: Value) -> Value:
    return ca.fmax(y, _TINY) if _symbolic(y) else np.maximum(y, 0.0)


def _where_burning(y: Value, rate: Value) -> Value:
    # only m = 0 needs this: y^0 is 1 before the start too
    return ca.if_else(y >= 0, rate, 0) if _symbolic(y) else np.where(np.asarray(y) >= 0, rate, 0.0)[()]


def _exp(value: Any) -> Value:
    return ca.exp(value) if _symbolic(value) else np.exp(value)


def _expm1(value: Any) -> Value:
    return ca.expm1(value) if _symbolic(value) else np.expm1(value)

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

import casadi as ca
import numpy as np

from mechsym.periodic.roots import root
from mechsym.quantities.units import Pure, Scalar

# Smallest y of the symbolic form: log(y), which the derivative with respect to m needs, stays finite
_TINY = 1e-300


def wiebe(y: Pure[Scalar], a: Pure[Scalar], m: Pure[Scalar]) -> Pure[Scalar]:
    r"""Burnt fraction of one Wiebe function.

    .. math:: f = 1 - \exp(-a\,y^{m+1}), \quad y \ge 0

    y: (phi - start) / duration; values below 0 count as 0. a: completeness: f(1) = 1 - exp(-a). m: form factor, m >= 0.
    Valid: m >= 0; for -1 < m < 0 the rate at y = 0 is infinite. Source: Wiebe (1956); Shen et al. (2020).
    """
    value = -a * _from_start(y) ** (m + 1)
    return -(ca.expm1(value) if _symbolic(value) else np.expm1(value))


def dwiebe_dy(y: Pure[Scalar], a: Pure[Scalar], m: Pure[Scalar]) -> Pure[Scalar]:
    r"""Burning rate of one Wiebe function.

    .. math:: \frac{df}{dy} = a (m+1)\, y^m \exp(-a\,y^{m+1}), \quad y \ge 0

    y: (phi - start) / duration; the rate is 0 below 0. a: completeness. m: form factor, m >= 0. Returns rate: df/dy;
    divide by the duration for df/dphi. For m = 0 the rate steps to a at y = 0, the value given there.
    """
    t = _from_start(y)
    # only m = 0 needs this: y^0 is 1 before the start too
    value = -a * t ** (m + 1)
    rate = a * (m + 1) * t**m * (ca.exp(value) if _symbolic(value) else np.exp(value))
    return ca.if_else(y >= 0, rate, 0) if _symbolic(y) else np.where(np.asarray(y) >= 0, rate, 0.0)[()]


def double_wiebe(
    y: Pure[Scalar], a_p: Pure[Scalar], m_p: Pure[Scalar], a_d: Pure[Scalar], m_d: Pure[Scalar], b: Pure[Scalar]
) -> Pure[Scalar]:
    r"""Burnt fraction of a premixed and a diffusive Wiebe function with a common start.

    .. math:: f = (1-b)\,[1-\exp(-a_p\,y^{m_p+1})] + b\,[1-\exp(-a_d\,y^{m_d+1})]

    y: (phi - start) / duration; values below 0 count as 0. a_p, m_p: completeness and form factor of the share 1 - b.
    a_d, m_d: completeness and form factor of the share b. b: share of the second function, 0 <= b <= 1.
    Source: Shen et al. (2020), J. Mar. Sci. Eng.; the letters p and d are theirs.
    """
    return (1 - b) * wiebe(y, a_p, m_p) + b * wiebe(y, a_d, m_d)


def ddouble_wiebe_dy(
    y: Pure[Scalar], a_p: Pure[Scalar], m_p: Pure[Scalar], a_d: Pure[Scalar], m_d: Pure[Scalar], b: Pure[Scalar]
) -> Pure[Scalar]:
    r"""Burning rate of `double_wiebe`.

    .. math:: \frac{df}{dy} = (1-b)\,f_p'(y) + b\,f_d'(y)

    y: (phi - start) / duration; the rate is 0 below 0. a_p, m_p: completeness and form factor of the share 1 - b. a_d,
    m_d: completeness and form factor of the share b. b: share of the second function, 0 <= b <= 1. Returns rate: df/dy;
    divide by the duration for df/dphi.
    """
    return (1 - b) * dwiebe_dy(y, a_p, m_p) + b * dwiebe_dy(y, a_d, m_d)


BURNT = {"ca10_deg": 0.1, "ca50_deg": 0.5, "ca90_deg": 0.9}  #: Shares of the heat whose angles are told


def burnt_at(share: Pure, a: Pure[Scalar], m: Pure[Scalar]) -> Pure[Scalar]:
    r"""Where a share of what has burnt at the nominal end is burnt.

    .. math:: y = \left(-\ln[1 - s(1 - e^{-a})]/a\right)^{1/(m+1)}

    a, m: completeness and form factor of `wiebe`. Returns y: (phi - start) / duration.

    >>> round(float(burnt_at(0.5, 5.0, 2.0)), 4)
    0.5159
    """
    return (-np.log1p(share * np.expm1(-a)) / a) ** (1 / (np.asarray(m) + 1))


def double_burnt_at(share: Pure, shape: tuple[float, ...], end: Pure) -> Pure:
    r"""Where a share of what burns is burnt, y of :math:`f(y) = s f(y_{end})`.

    shape: a_p, m_p, a_d, m_d, b of `double_wiebe` [-]. end: y where burning stops; infinite where nothing cuts it off.
    Returns y: (phi - start) / duration.
    """
    wanted, last = share * float(double_wiebe(end, *shape)), 1.0
    while double_wiebe(last, *shape) < wanted:
        last *= 2
    return root(lambda y: double_wiebe(y, *shape) - wanted, 0.0, last, xtol=1e-14)


def _symbolic(value: object) -> bool:
    return isinstance(value, (ca.SX, ca.MX))


def _from_start(y: Scalar) -> Scalar:
    return ca.fmax(y, _TINY) if _symbolic(y) else np.maximum(y, 0.0)

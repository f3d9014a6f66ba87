r"""Guides and crank pin of the rodless mechanism with play, and a crank that is not exactly half the link.

The rigid mechanism leaves one force open, S along the crank, in balance with X_a = -S sin(alpha), X_b = -S cos(alpha).
Play and elasticity close it: a part that carries X gives way by X/k and by its play towards the side that it lies on,

.. math:: u(X) = X/k + g\,\mathrm{sgn} X, \qquad u_c(S) - u_a(X_a)\sin\alpha - u_b(X_b)\cos\alpha = e

where e is how much the crank is longer than half the link. At X = 0 the part floats anywhere within its play. The left
side only grows with S, so there is one S, the least point of a convex function, and it is a median.
"""

from typing import Any

import casadi as ca

from mechsym.quantities import quantity, record

_FLAT = 1e-9  # sine or cosine below which a guide has no part in the redundant force


@record
class Clearances:
    """Closing rule: guides and crank pin are springs with play, the crank may be cut wrong."""

    k_a: float = quantity("N/m", above=0, about="stiffness of the guide of slider a")
    k_b: float = quantity("N/m", above=0, about="stiffness of the guide of slider b")
    k_c: float = quantity("N/m", above=0, about="stiffness of crank and pin along the radius")
    gap_a: float = quantity("m", default=0.0, low=0, about="play of slider a to each side of its guide")
    gap_b: float = quantity("m", default=0.0, low=0, about="play of slider b to each side of its guide")
    gap_c: float = quantity("m", default=0.0, low=0, about="radial play of the crank pin")
    radius_error: float = quantity("m", default=0.0, about="crank longer than half the link by")


def redundant_force(rule: Clearances, X_a: Any, X_b: Any, s: Any, c: Any) -> Any:
    r"""Radial pin force of a mechanism with play.

    .. math:: m S + \sum_i G_i\,\mathrm{sgn}(S - b_i) = e + \frac{X_a^0 s}{k_a} + \frac{X_b^0 c}{k_b}, \qquad
              m = \frac1{k_c} + \frac{s^2}{k_a} + \frac{c^2}{k_b}

    with G = g_c, g_a|s|, g_b|c| and b = 0, X_a^0/s, X_b^0/c; S is the median of the b in ascending order and of the
    four S that the equation gives with the first 0, 1, 2, 3 signs positive.

    Parameters
    ----------
    X_a, X_b : float or CasADi expression
        Guide reactions at S = 0 [N]
    s, c : float or CasADi expression
        Sine and cosine of alpha [-]

    Returns
    -------
    S : CasADi expression
        Along the crank, positive away from the shaft [N]

    Notes
    -----
    Source: principle of virtual forces with the one self-balanced state of the mechanism. Valid: contacts without
    friction or impact, deflections small against the crank radius, the play taken up at each instant.

    Examples
    --------
    >>> rule = Clearances(k_a=1e8, k_b=1e8, k_c=1e8, radius_error=1e-5)
    >>> round(float(redundant_force(rule, 0.0, 0.0, 0.6, 0.8)), 6)
    500.0
    """
    stiffness = 1 / rule.k_c + s**2 / rule.k_a + c**2 / rule.k_b
    right = rule.radius_error + X_a * s / rule.k_a + X_b * c / rule.k_b
    points = [(0.0, rule.gap_c), _point(X_a, s, rule.gap_a), _point(X_b, c, rule.gap_b)]
    b, G = _ascending(points)
    candidates = [(right + sum(G[k:]) - sum(G[:k])) / stiffness for k in range(4)]
    return _median([*b, *candidates])


def _point(X: Any, sine: Any, gap: float) -> tuple[Any, Any]:
    flat = ca.fabs(sine) < _FLAT
    return ca.if_else(flat, 0.0, X / ca.if_else(flat, 1.0, sine)), gap * ca.fabs(sine)


def _ascending(points: list[tuple[Any, Any]]) -> tuple[list[Any], list[Any]]:
    pairs = list(points)
    for i, j in ((0, 1), (1, 2), (0, 1)):
        (b_i, G_i), (b_j, G_j) = pairs[i], pairs[j]
        swap = b_i > b_j
        pairs[i] = (ca.fmin(b_i, b_j), ca.if_else(swap, G_j, G_i))
        pairs[j] = (ca.fmax(b_i, b_j), ca.if_else(swap, G_i, G_j))
    return [b for b, _ in pairs], [G for _, G in pairs]


def _median(values: list[Any]) -> Any:
    found = list(values)
    for end in range(len(found) - 1, 0, -1):
        for i in range(end):
            found[i], found[i + 1] = ca.fmin(found[i], found[i + 1]), ca.fmax(found[i], found[i + 1])
    return found[len(found) // 2]

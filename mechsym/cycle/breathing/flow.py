r"""Gas exchange by filling and emptying: flow through valves, ports and throttles between volumes of one pressure each.

    ambient --throttle-- [plenum] --inlet valve-- [cylinder] --exhaust valve-- [manifold] --tail pipe-- ambient

A valve is known by its lift, a polynomial of the cam angle; a port by the piston that uncovers it. Pressures are
absolute; flow is positive from the first volume to the second.
"""

import math
from typing import Annotated

import casadi as ca

from mechsym.quantities.units import Area, MassFlow, Metre, Pure, Radian, Scalar

_SOFT = 1e-3  # relative difference of pressure below which the root is a straight line, so that a flow can turn round


def critical_ratio(gamma: Pure) -> Pure:
    r"""Ratio of the pressures at and below which the flow is choked.

    .. math:: \left(\frac{2}{\gamma + 1}\right)^{\gamma/(\gamma - 1)}

    gamma: ratio of the heat capacities. Returns ratio: pressure behind the throat by the pressure before it.
    Source: ideal gas, isentropic to the throat; Heywood (1988), eq. (C.7). Valid: constant heat capacities.

    >>> round(critical_ratio(1.4), 4)
    0.5283
    """
    return (2 / (gamma + 1)) ** (gamma / (gamma - 1))


def orifice_flow(
    area: Area[Scalar],
    up: tuple[Scalar, Scalar],
    down: tuple[Scalar, Scalar],
    gamma: Pure,
    R: Annotated[float, "J/(kg*K)"],
) -> MassFlow[Scalar]:
    r"""Mass flow through a throat between two volumes.

    .. math:: \dot m = \frac{A\,p_0}{\sqrt{R T_0}}\sqrt{\frac{2\gamma}{\gamma - 1}
              \left(r^{2/\gamma} - r^{(\gamma + 1)/\gamma}\right)}, \qquad r = \max(p_1/p_0, r_{crit})

    area: effective area, discharge coefficient included; up, down: pressure and temperature of the first and the second
    volume [Pa, K]; gamma: ratio of the heat capacities; R: gas constant. Returns flow: from the first to the second
    volume; the volume of the higher pressure gives p_0 and T_0. Source: Heywood (1988), eqs. (C.8), (C.9). Valid:
    quasi-steady; within 1e-3 of equal pressures a straight line stands for the root.

    >>> round(float(orifice_flow(1e-4, (2e5, 300.0), (1e5, 300.0), 1.4, 287.0)), 5)  # choked
    0.04667
    """
    forward = up[0] >= down[0]
    p_0, p_1 = ca.fmax(up[0], down[0]), ca.fmin(up[0], down[0])
    T_0 = ca.if_else(forward, up[1], down[1])
    ratio = ca.fmax(p_1 / p_0, critical_ratio(gamma))
    return area * p_0 / ca.sqrt(R * T_0) * _root(ratio, gamma) * ca.if_else(forward, 1.0, -1.0)


def _root(ratio: Scalar, gamma: float) -> Scalar:
    def exact(r: Scalar) -> Scalar:
        return ca.sqrt(2 * gamma / (gamma - 1) * (r ** (2 / gamma) - r ** ((gamma + 1) / gamma)))

    near = 1 - _SOFT
    straight = exact(near) * (1 - ratio) / _SOFT
    return ca.if_else(ratio < near, exact(ca.fmin(ratio, near)), straight)


def valve_lift(
    phi: Radian[Scalar], opens: Radian, closes: Radian, lift: Metre, period: Radian = 4 * math.pi
) -> Metre[Scalar]:
    r"""Lift of a valve on a polynomial cam.

    .. math:: h = h_{max}\,(1 - u^2)^3, \qquad u = \frac{2\varphi - \varphi_o - \varphi_c}{\varphi_c - \varphi_o}

    opens, closes: crank angles between which it is open, closes above opens; lift: largest lift; period: of the cycle.
    Returns h: lift, 0 while closed; velocity and acceleration have no jump.
    Source: polynomial cam of the 6th degree with two free derivatives at its ends. Valid: closes - opens below period.

    >>> [round(float(valve_lift(a, 0.0, 4.0, 0.01)), 5) for a in (0.0, 1.0, 2.0)]
    [0.0, 0.00422, 0.01]
    """
    along = phi - opens - period * ca.floor((phi - opens) / period)
    u = ca.fmin(2 * along / (closes - opens) - 1, 1.0)
    return lift * (1 - u**2) ** 3


def curtain_area(lift: Metre[Scalar], diameter: Metre, discharge: Pure) -> Area[Scalar]:
    r"""Effective area of a poppet valve.

    .. math:: A = C_d \min(\pi d h,\ \pi d^2/4)

    diameter: inner diameter of the seat d; discharge: discharge coefficient.
    Source: Heywood (1988), section 6.3.2, without the seat's angle. Valid: stem thin against the seat.

    >>> round(float(curtain_area(0.005, 0.02, 1.0)) * 1e6, 2)
    314.16
    """
    return discharge * ca.fmin(math.pi * diameter * lift, math.pi / 4 * diameter**2)


def port_area(x: Metre[Scalar], uncovered_from: Metre, height: Metre, width: Metre, discharge: Pure) -> Area[Scalar]:
    r"""Effective area of ports that the piston uncovers.

    .. math:: A = C_d\, w\,\min(\max(x - x_p, 0), h)

    x: travel of the piston from top dead centre; uncovered_from, height, width: travel x_p at the upper edge, height h
    and total width w of the ports; discharge: discharge coefficient.
    Source: geometry of rectangular ports. Valid: piston crown flat, ports of equal height.

    >>> round(float(port_area(0.09, 0.08, 0.02, 0.1, 0.7)) * 1e4, 6)
    7.0
    """
    return discharge * width * ca.fmin(ca.fmax(x - uncovered_from, 0.0), height)

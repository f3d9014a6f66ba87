"""The truncated forms that Zotov et al. (2024) print, for comparison with the exact mechanism; never the default.

Each function is one printed expression, with the paper's letters: r = r1 + r2, l = l1 + l2, lam = r / l, phi = 0 at top
dead centre. Weights P_i are written as masses times g.
"""

from typing import Protocol

import numpy as np

Array = np.ndarray


class CrossheadLetters(Protocol):
    """The letters of the paper's mechanism: lengths [m], masses [kg], IC2 [kg*m^2], g [m/s^2]."""

    r1: float
    r2: float
    l1: float
    l2: float
    m1: float
    m2: float
    m3: float
    m4: float
    m5: float
    IC2: float
    g: float


def _lengths(p: CrossheadLetters) -> tuple[float, float, float]:
    r, l = p.r1 + p.r2, p.l1 + p.l2
    return r, l, r / l


def dinertia_dphi_printed(p: CrossheadLetters, phi: Array) -> Array:
    """Derivative of the reduced inertia as printed below equation (7).

    phi: crank angle [rad]. Returns slope: derivative by phi [kg*m^2/rad].
    Source: Zotov et al. (2024), below eq. (7); consistent with the printed sign in (2).
    """
    r, l, lam = _lengths(p)
    s, c, c2, s2 = np.sin(phi), np.cos(phi), np.cos(2 * phi), np.sin(2 * phi)
    root = cos_psi_printed(p, phi)
    turning = p.IC2 * (-2 * lam**2 * c * s / root**2 + lam**4 * c**2 * s2 / root**3)
    sliding = 2 * (p.m3 + p.m4 + p.m5) * r**2 * (c + lam * c2) * (s + lam / 2 * s2)
    across = -2 * p.l2**2 * c * s / l**2
    along = 2 * (c - lam * p.l1 * c2 / l) * (s - lam * p.l1 * s2 / (2 * l))
    return turning + sliding + p.m2 * r**2 * (across + along)


def dx_dphi_printed(p: CrossheadLetters, phi: Array) -> Array:
    r"""Transmission of the piston as printed below equation (3).

    .. math:: dx/d\varphi \approx r\sin\varphi + \tfrac12 l\lambda^2\sin 2\varphi

    phi: crank angle [rad]. Returns slope: derivative of the travel [m/rad]. Source: Zotov et al. (2024), below eq. (3).
    """
    r, l, lam = _lengths(p)
    return r * np.sin(phi) + l / 2 * lam**2 * np.sin(2 * phi)


def cos_psi_printed(p: CrossheadLetters, phi: Array) -> Array:
    r"""Cosine of the rod's angle as printed below equation (3).

    .. math:: \cos\psi \approx 1 - \lambda^2/4 + (\lambda^2/4)\cos 2\varphi

    phi: crank angle [rad]. Returns cos_psi: cosine [-]. Source: Zotov et al. (2024), below eq. (3).
    """
    lam = _lengths(p)[2]
    return 1 - lam**2 / 4 + lam**2 / 4 * np.cos(2 * phi)


def gravity_torque_printed(p: CrossheadLetters, phi: Array) -> Array:
    r"""Torque of the weights in equation (6); the engine lies down, the axis is horizontal.

    .. math:: -P_1 r_1\cos\varphi - P_2 l_2\cos\psi\,\frac{\lambda\cos\varphi}{\sqrt{1-\lambda^2\sin^2\varphi}}

    phi: crank angle [rad]. Returns torque: generalised force of the weights [N*m].
    Source: Zotov et al. (2024), eq. (6).
    """
    lam = _lengths(p)[2]
    dpsi_dphi = lam * np.cos(phi) / np.sqrt(1 - lam**2 * np.sin(phi) ** 2)
    return -p.g * (p.m1 * p.r1 * np.cos(phi) + p.m2 * p.l2 * cos_psi_printed(p, phi) * dpsi_dphi)


def load_torque_printed(p: CrossheadLetters, force: np.ndarray, phi: np.ndarray) -> float:
    r"""Load torque as equation (5) prints it, with the truncated transmission.

    .. math:: M_r = \frac1{2\pi}\int_0^{2\pi} F\,(r\sin\varphi + \tfrac12 l \lambda^2 \sin 2\varphi)\,d\varphi

    force: net force on the piston at even crank angles over a turn, without its end [N]; phi: these angles [rad].
    Returns M_r: load torque [N*m]. Source: Zotov et al. (2024), eqs. (4) and (5).
    """
    return float(np.mean(force * dx_dphi_printed(p, phi)))


def hinge_torque_printed(
    p: CrossheadLetters, omega: float, force: np.ndarray, load_torque: float, phi: np.ndarray
) -> np.ndarray:
    r"""Hinge torque as equation (8) prints it: truncated kinematics and the wrong sign in the rod's inertia.

    .. math:: M_h = \dot I \dot\varphi - \tfrac12\dot\varphi^2 I' - F x' + M_r + P_1 r_1\cos\varphi
              + P_2 l_2 \cos\psi\,\frac{\lambda\cos\varphi}{\sqrt{1 - \lambda^2\sin^2\varphi}}

    p: engine, lying down as in the paper; omega: crank speed [rad/s]; force: net force on the piston [N]; load_torque:
    m_r [N*m]; phi: crank angle [rad]. Returns M_h: torque of the hinge on the crank [N*m].
    Source: Zotov et al. (2024), eq. (8); its derivative of the inertia is printed below eq. (7).
    """
    slope = dinertia_dphi_printed(p, phi)
    inertia_part = slope * omega**2 - omega**2 / 2 * slope
    return inertia_part - force * dx_dphi_printed(p, phi) + load_torque - gravity_torque_printed(p, phi)

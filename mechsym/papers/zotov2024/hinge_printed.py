"""The hinge torque as the source prints it, for comparison; the design uses `mechsym.hinge`."""

import numpy as np

from mechsym.mechanisms.crosshead import CrossheadParameters
from mechsym.papers.zotov2024.equations_printed import dinertia_dphi_printed, dx_dphi_printed, gravity_torque_printed


def load_torque_printed(p: CrossheadParameters, force: np.ndarray, phi: np.ndarray) -> float:
    r"""Load torque as equation (5) prints it, with the truncated transmission.

    .. math:: M_r = \frac1{2\pi}\int_0^{2\pi} F\,(r\sin\varphi + \tfrac12 l \lambda^2 \sin 2\varphi)\,d\varphi

    Parameters
    ----------
    force : ndarray, shape (n,)
        Net force on the piston at even crank angles over a turn, without its end [N]
    phi : ndarray, shape (n,)
        These angles [rad]

    Returns
    -------
    M_r : float
        Load torque [N*m]

    Notes
    -----
    Source: Zotov et al. (2024), eqs. (4) and (5).
    """
    return float(np.mean(force * dx_dphi_printed(p, phi)))


def hinge_torque_printed(
    p: CrossheadParameters, omega: float, force: np.ndarray, load_torque: float, phi: np.ndarray
) -> np.ndarray:
    r"""Hinge torque as equation (8) prints it: truncated kinematics and the wrong sign in the rod's inertia.

    .. math:: M_h = \dot I \dot\varphi - \tfrac12\dot\varphi^2 I' - F x' + M_r + P_1 r_1\cos\varphi
              + P_2 l_2 \cos\psi\,\frac{\lambda\cos\varphi}{\sqrt{1 - \lambda^2\sin^2\varphi}}

    Parameters
    ----------
    p : CrossheadParameters
        Engine, lying down as in the paper
    omega : float
        Crank speed [rad/s]
    force : ndarray, shape (n,)
        Net force on the piston [N]
    load_torque : float
        M_r [N*m]
    phi : ndarray, shape (n,)
        Crank angle [rad]

    Returns
    -------
    M_h : ndarray, shape (n,)
        Torque of the hinge on the crank [N*m]

    Notes
    -----
    Source: Zotov et al. (2024), eq. (8); its derivative of the inertia is printed below eq. (7).
    """
    slope = dinertia_dphi_printed(p, phi)
    inertia_part = slope * omega**2 - omega**2 / 2 * slope
    return inertia_part - force * dx_dphi_printed(p, phi) + load_torque - gravity_torque_printed(p, phi)

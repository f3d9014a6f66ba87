"""The truncated forms that Zotov et al. (2024) print, for comparison with the exact mechanism; never the default.

Each function is one printed expression, with the paper's letters: r = r1 + r2, l = l1 + l2, lam = r / l, phi = 0 at top
dead centre. Weights P_i are written as masses times g.
"""

import numpy as np

from mechsym.mechanisms.crosshead import CrossheadParameters

Array = np.ndarray


def _lengths(p: CrossheadParameters) -> tuple[float, float, float]:
    r, l = p.r1 + p.r2, p.l1 + p.l2
    return r, l, r / l


def inertia_printed(p: CrossheadParameters, phi: Array) -> Array:
    r"""Reduced inertia as equation (2) prints it, with the rod's term sin(phi) - l1 lam/(2 l) sin(2 phi).

    .. math:: I = I_{01} + m_2 r^2 \left[(\sin\varphi - \tfrac{l_1\lambda}{2l}\sin 2\varphi)^2
              + \tfrac{l_2^2\cos^2\varphi}{l^2}\right] + \dots

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angle [rad]

    Returns
    -------
    inertia : ndarray, shape (n,)
        Reduced moment of inertia [kg*m^2]

    Notes
    -----
    Source: Zotov et al. (2024), eq. (2). The minus sign is wrong, see docs/errata.md.
    """
    return _inertia(p, phi, -1.0)


def inertia_sign_turned(p: CrossheadParameters, phi: Array) -> Array:
    """Reduced inertia of equation (2) with the sign of the rod's term turned to plus: truncated, but right.

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angle [rad]

    Returns
    -------
    inertia : ndarray, shape (n,)
        Reduced moment of inertia [kg*m^2]

    Notes
    -----
    Source: Zotov et al. (2024), eq. (2) corrected.
    """
    return _inertia(p, phi, 1.0)


def _inertia(p: CrossheadParameters, phi: Array, sign: float) -> Array:
    r, l, lam = _lengths(p)
    rod = (np.sin(phi) + sign * p.l1 * lam / (2 * l) * np.sin(2 * phi)) ** 2 + (p.l2 * np.cos(phi) / l) ** 2
    turning = p.IC2 * (lam * np.cos(phi)) ** 2 / cos_psi_printed(p, phi) ** 2
    sliding = (p.m3 + p.m4 + p.m5) * r**2 * (np.sin(phi) + lam / 2 * np.sin(2 * phi)) ** 2
    return p.I01 + p.m2 * r**2 * rod + turning + sliding


def dinertia_dphi_printed(p: CrossheadParameters, phi: Array) -> Array:
    """Derivative of the reduced inertia as printed below equation (7).

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angle [rad]

    Returns
    -------
    slope : ndarray, shape (n,)
        Derivative by phi [kg*m^2/rad]

    Notes
    -----
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


def dx_dphi_printed(p: CrossheadParameters, phi: Array) -> Array:
    r"""Transmission of the piston as printed below equation (3).

    .. math:: dx/d\varphi \approx r\sin\varphi + \tfrac12 l\lambda^2\sin 2\varphi

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angle [rad]

    Returns
    -------
    slope : ndarray, shape (n,)
        Derivative of the travel [m/rad]

    Notes
    -----
    Source: Zotov et al. (2024), below eq. (3).
    """
    r, l, lam = _lengths(p)
    return r * np.sin(phi) + l / 2 * lam**2 * np.sin(2 * phi)


def cos_psi_printed(p: CrossheadParameters, phi: Array) -> Array:
    r"""Cosine of the rod's angle as printed below equation (3).

    .. math:: \cos\psi \approx 1 - \lambda^2/4 + (\lambda^2/4)\cos 2\varphi

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angle [rad]

    Returns
    -------
    cos_psi : ndarray, shape (n,)
        Cosine [-]

    Notes
    -----
    Source: Zotov et al. (2024), below eq. (3).
    """
    lam = _lengths(p)[2]
    return 1 - lam**2 / 4 + lam**2 / 4 * np.cos(2 * phi)


def gravity_torque_printed(p: CrossheadParameters, phi: Array) -> Array:
    r"""Torque of the weights in equation (6); the engine lies down, the axis is horizontal.

    .. math:: -P_1 r_1\cos\varphi - P_2 l_2\cos\psi\,\frac{\lambda\cos\varphi}{\sqrt{1-\lambda^2\sin^2\varphi}}

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angle [rad]

    Returns
    -------
    torque : ndarray, shape (n,)
        Generalised force of the weights [N*m]

    Notes
    -----
    Source: Zotov et al. (2024), eq. (6).
    """
    lam = _lengths(p)[2]
    dpsi_dphi = lam * np.cos(phi) / np.sqrt(1 - lam**2 * np.sin(phi) ** 2)
    return -p.g * (p.m1 * p.r1 * np.cos(phi) + p.m2 * p.l2 * cos_psi_printed(p, phi) * dpsi_dphi)

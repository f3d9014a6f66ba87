r"""The force chains that the sources print, with the rod as two masses, beside the exact rigid-body forces.

              F (on the piston, away from the head)     beta = psi, the rod's angle; alpha = phi
              |
     N <------+------   B = F / cos beta along the rod  Z towards the shaft, T in the sense of rotation
              |\
              | \ B     Z_B = B cos(alpha + beta), T = B sin(alpha + beta)

Two masses that carry the rod's mass and centre of mass have the inertia m_b a b instead of I_C2; Terskih's rule moves
the centre of mass as well. Their error in the torque is (I_C2 - m_b a b) omega^2 psi' psi''.
"""

import dataclasses
import functools
import math

import numpy as np

from mechsym.errors import BadInput
from mechsym.forces.loads import loads, radial, tangential
from mechsym.forces.turn import Turn, at, chain_of, crank_drive
from mechsym.mechanisms.chain import SliderCrank
from mechsym.quantities import record

_FREE_FALL = 9.81  # [m/s^2]


@record
class Chain:
    """The whole chain of Moroianu (2017), arrays of shape (n,)."""

    #: Pressure force, inertia force of the masses in translation, their sum [N]
    F_p: np.ndarray
    F_it: np.ndarray
    F: np.ndarray
    #: Along the rod, across the cylinder [N]
    B: np.ndarray
    N: np.ndarray
    #: On the crank pin towards the shaft, and in the sense of rotation [N]
    Z_B: np.ndarray
    T: np.ndarray
    F_ibm: np.ndarray  #: Inertia force of the rod's share on the crank pin, towards the shaft [N]
    Z: np.ndarray  #: Total towards the shaft [N]
    M: np.ndarray  #: Torque [N*m]


def terskih(omega: float) -> float:
    r"""Place of a rod's centre of mass after Terskih, as part of its length from the crank pin.

    .. math:: L_m / L = 0.2\,\frac{(0.001 n)^2 + 2}{(0.001 n)^2 + 1}, \quad n \text{ in rpm}

    Parameters
    ----------
    omega : float
        Crank speed [rad/s]

    Returns
    -------
    ratio : float
        Between 0.2 (fast) and 0.4 (slow) [-]

    Notes
    -----
    Source: Moroianu (2017), eq. (3). Empirical.

    Examples
    --------
    >>> round(terskih(89 * math.pi / 30), 4)
    0.3984
    """
    n = (0.001 * omega * 30 / math.pi) ** 2
    return 0.2 * (n + 2) / (n + 1)


def slider_crank(turn: Turn) -> SliderCrank:
    """The slider crank of a turn in the letters of the sources.

    Returns
    -------
    slider_crank : SliderCrank
        With the true centre of mass of the rod
    """
    letters = chain_of(turn.drive).letters
    if letters is None:
        raise BadInput(f"the chain of Moroianu is that of a slider crank, not of {turn.drive.name}")
    return letters(turn.drive.mechanism.parameters)


def chain(turn: Turn, ratio: float) -> Chain:
    r"""Moroianu's chain with the rod's mass at its two ends.

    .. math::
        F = F_p + F_{it}, \; B = F/\cos\beta, \; N = F\tan\beta, \;
        Z = B\cos(\alpha+\beta) + F_{ibm}, \; T = B\sin(\alpha+\beta), \; M = T R

    Parameters
    ----------
    ratio : float
        L_m / L: the rod's centre of mass from the crank pin, as part of its length [-]

    Notes
    -----
    Source: Moroianu (2017), eqs. (2), (4), (6) to (13). The share on the crank pin, m_b (1 - L_m/L), is not printed.
    Valid: constant speed, no weight.
    """
    s, alpha, beta = slider_crank(turn), turn.phi, turn.kinematics["psi"]
    m_bp, m_bm = s.m_b * ratio, s.m_b * (1 - ratio)
    F_p = turn.inputs.get("F", np.zeros_like(alpha))
    F_it = -(s.m_p + m_bp) * turn.kinematics["d2x_dphi2"] * turn.omega**2
    F = F_p + F_it
    B = F / np.cos(beta)
    Z_B, T = B * np.cos(alpha + beta), B * np.sin(alpha + beta)
    F_ibm = np.full_like(alpha, -m_bm * s.R * turn.omega**2)
    return Chain(F_p=F_p, F_it=F_it, F=F, B=B, N=F * np.tan(beta), Z_B=Z_B, T=T, F_ibm=F_ibm, Z=Z_B + F_ibm, M=T * s.R)


def errors(turn: Turn, approximate: Chain) -> dict[str, float]:
    """How far a chain is from the exact rigid-body forces without weight, which the chain leaves out.

    Returns
    -------
    errors : dict of str to float
        For N, Z, T, M and the loads of crank pin and main bearing: largest difference over the largest exact value [-]
    """
    return _shares(_approximate(turn, approximate), _exact(turn, 0.0))


def weight_shares(turn: Turn) -> dict[str, float]:
    """What the weights do to the forces, which the chain leaves out; also where the case leaves them out (g = 0).

    Returns
    -------
    shares : dict of str to float
        For the same quantities as `errors`: largest change by the weights over the largest value without [-]
    """
    return _shares(_exact(turn, _FREE_FALL), _exact(turn, 0.0))


def with_weight(turn: Turn, g: float) -> Turn:
    """The same cycle under another gravity.

    Parameters
    ----------
    g : float
        Acceleration of free fall [m/s^2]
    """
    drive = crank_drive(turn.drive.name, dataclasses.replace(turn.drive.parameters, g=g))
    return at(drive, turn.gas, turn.omega, turn.phi)


# every chain is held against the same
@functools.lru_cache(maxsize=4)
def _exact(turn: Turn, g: float) -> dict[str, np.ndarray]:
    weighted = with_weight(turn, g)
    found = loads(weighted)
    pin = found.pins[0]
    return {
        "N": found.guides["side_force"],
        "Z": -radial(pin),
        "T": tangential(pin),
        "M": weighted.torque,
        "crank_pin": np.hypot(pin.x, pin.y),
        "main_bearing": np.hypot(*found.bearings["main_bearing"]),
    }


def _approximate(turn: Turn, chain: Chain) -> dict[str, np.ndarray]:
    # the crank's own unbalance pulls the main bearing outwards, against Z
    pull = slider_crank(turn).u_c * turn.omega**2
    loads = {"crank_pin": np.hypot(chain.Z, chain.T), "main_bearing": np.hypot(chain.Z - pull, chain.T)}
    return {n: getattr(chain, n) for n in "NZTM"} | loads


def _shares(found: dict[str, np.ndarray], exact: dict[str, np.ndarray]) -> dict[str, float]:
    return {n: float(np.abs(found[n] - v).max() / np.abs(v).max()) for n, v in exact.items()}


def piston_inertia_printed(turn: Turn) -> np.ndarray:
    r"""Inertia force of the reciprocating mass to the first order in R/L.

    .. math:: P_j = -m_j R \omega^2 (\cos\varphi + \lambda\cos 2\varphi)

    Returns
    -------
    P_j : ndarray, shape (n,)
        Positive away from the head [N]

    Notes
    -----
    Source: Prymak, eq. (6). m_j is the piston's mass with the rod's share by its true centre of mass.
    """
    s = slider_crank(turn)
    m_j, lam = s.m_p + s.m_b * s.L_m / s.L, s.R / s.L
    return -m_j * s.R * turn.omega**2 * (np.cos(turn.phi) + lam * np.cos(2 * turn.phi))

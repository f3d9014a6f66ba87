"""Fatigue of a round section that turns against its bending load: every fibre has its own history, the worst counts.

Source: DE-Goodman as in `fatigue.py`; the fibre at angle a of a shaft turned by beta feels M cos(beta + a - direction).
"""

import numpy as np

from mechsym.quantities import quantity, record
from mechsym.sizing.checks import require
from mechsym.sizing.rules.crankshaft import bending_stress, torsion_stress
from mechsym.sizing.rules.fatigue import stress_cycle

_FIBRES = 24  # an even number: each has one opposite


@record
class Section:
    """A round section and what its material bears."""

    d: float = quantity("m", above=0, about="diameter")
    #: Endurance limit of the part and ultimate strength [Pa]
    S_e: float = quantity("Pa", above=0, about="endurance limit")
    S_ut: float = quantity("Pa", above=0, about="ultimate strength")
    K_f: float = quantity("-", default=1.0, low=1, about="notch factor in bending")
    K_fs: float = quantity("-", default=1.0, low=1, about="notch factor in torsion")
    bore: float = quantity("m", default=0.0, low=0, about="bore")

    def __post_init__(self) -> None:
        require("bore", self.bore, "m", below=self.d, hint="the bore must leave a wall")


def fatigue_factor(section: Section, M_x: np.ndarray, M_y: np.ndarray, turn: np.ndarray, T: np.ndarray) -> np.ndarray:
    r"""Fatigue safety factor of a turning section at each speed.

    .. math:: \sigma(\alpha) = \frac{32}{\pi d^3}\left(M_x\cos(\beta + \alpha) + M_y\sin(\beta + \alpha)\right),
              \qquad \frac1n = \max_\alpha\left(\frac{\sigma_a^*}{S_e} + \frac{\sigma_m^*}{S_{ut}}\right)

    with equivalent stresses sigma* of bending and torsion, notches included.

    Parameters
    ----------
    M_x, M_y : ndarray, shape (k, n)
        Bending moment by the direction of the force that makes it, in a frame that does not turn [N*m]
    turn : ndarray, shape (n,)
        Angle of the section in that frame [rad]
    T : ndarray, shape (k, n)
        Torque in the section [N*m]

    Returns
    -------
    n : ndarray, shape (k,)
        Safety factor at each speed [-]

    Notes
    -----
    Source: Shigley, eq. 7-7 (DE-Goodman), fibre by fibre. A constant moment on a turning shaft is fully reversed, a
    constant moment on a standing one is a mean stress.

    Examples
    --------
    >>> section, angle = Section(d=0.01, S_e=1e8, S_ut=4e8), np.linspace(0, 2 * np.pi, 360, endpoint=False)
    >>> M, none = np.full((1, 360), np.pi * 0.01**3 / 32 * 5e7), np.zeros((1, 360))
    >>> [f"{fatigue_factor(section, M, none, turn, none)[0]:.2f}" for turn in (angle, 0 * angle)]
    ['2.00', '8.00']
    """
    hollow = 1 - (section.bore / section.d) ** 4
    tau_a, tau_m = stress_cycle(torsion_stress(np.asarray(T), section.d) / hollow)
    # moments in the section's own axes: turned once, they serve all fibres
    cos, sin, per_moment = np.cos(turn), np.sin(turn), bending_stress(1.0, section.d) / hollow
    along, across = M_x * cos + M_y * sin, M_y * cos - M_x * sin
    used = np.zeros(np.shape(M_x)[0])
    for alpha in np.arange(_FIBRES // 2) * 2 * np.pi / _FIBRES:
        sigma_a, sigma_m = stress_cycle(along * np.cos(alpha) + across * np.sin(alpha))
        # the fibre on the other side has the same amplitude and the opposite mean
        sigma_a, sigma_m = per_moment * sigma_a, per_moment * np.abs(sigma_m)
        amplitude = np.hypot(section.K_f * sigma_a, np.sqrt(3) * section.K_fs * tau_a)
        mean = np.hypot(section.K_f * sigma_m, np.sqrt(3) * section.K_fs * tau_m)
        used = np.maximum(used, amplitude / section.S_e + mean / section.S_ut)
    with np.errstate(divide="ignore"):
        return 1 / used


def static_factor(section: Section, M_x: np.ndarray, M_y: np.ndarray, T: np.ndarray, strength: float) -> np.ndarray:
    r"""Factor against a static strength at each speed.

    .. math:: n = R / \max_\theta\sqrt{\sigma^2 + 3\tau^2}

    Parameters
    ----------
    M_x, M_y, T : ndarray, shape (k, n)
        Bending moment and torque [N*m]
    strength : float
        Yield or ultimate strength R [Pa]

    Returns
    -------
    n : ndarray, shape (k,)
        Safety factor at each speed [-]

    Notes
    -----
    Source: Shigley, eq. 7-15, without notches.

    Examples
    --------
    >>> section, none = Section(d=0.008, S_e=7e8, S_ut=1.985e9), np.zeros((1, 1))
    >>> f"{static_factor(section, none, none, np.full((1, 1), 243.6), 1.565e9)[0]:.2f}"
    '0.37'
    """
    hollow = 1 - (section.bore / section.d) ** 4
    sigma = bending_stress(np.hypot(M_x, M_y), section.d) / hollow
    tau = torsion_stress(np.asarray(T), section.d) / hollow
    with np.errstate(divide="ignore"):
        return strength / np.sqrt(sigma**2 + 3 * tau**2).max(axis=-1)

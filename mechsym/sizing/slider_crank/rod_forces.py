"""Forces of a slider crank along its rod, for the parts of a conventional engine.

Source: Nunes (2017), eqs. 2.65 to 2.67.
"""

import numpy as np

from mechsym.sizing.checks import require


def slider_crank_chain(F: np.ndarray, theta: np.ndarray, r: float, l: float) -> dict[str, np.ndarray]:
    r"""Forces of a slider crank with mass on the piston only.

    .. math:: \sin\psi = \tfrac{r}{l}\sin\theta, \quad S = F/\cos\psi, \quad N = F\tan\psi, \quad
              T_t = S\sin(\theta + \psi), \quad T_r = S\cos(\theta + \psi)

    Parameters
    ----------
    F : ndarray, shape (k, n)
        Force on the piston pin, positive away from the head [N]
    theta : ndarray, shape (n,)
        Crank angle from top dead centre [rad]
    r, l : float
        Crank radius and rod length [m]

    Returns
    -------
    chain : dict of str to ndarray, shape (k, n)
        `rod`, `side`, `tangential`, `radial` [N]

    Notes
    -----
    Source: Nunes (2017), eqs. 2.65 to 2.67. Valid: r < l.

    Examples
    --------
    >>> chain = slider_crank_chain(np.array([[1000.0]]), np.array([np.pi / 2]), 0.026, 0.09)
    >>> round(float(chain["tangential"][0, 0])), round(float(chain["side"][0, 0]))
    (1000, 302)
    """
    require("ratio r/l", r / l, "-", above=0, below=1, hint="the rod must be longer than the crank")
    psi = np.arcsin(r / l * np.sin(theta))
    rod = np.asarray(F) / np.cos(psi)
    return {
        "rod": rod,
        "side": np.asarray(F) * np.tan(psi),
        "tangential": rod * np.sin(theta + psi),
        "radial": rod * np.cos(theta + psi),
    }

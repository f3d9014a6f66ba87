"""Forces of the derived rodless mechanism with four rod journals of equal mass, two to an axis."""

import numpy as np

from mechsym import mechanisms
from mechsym.mechanisms.record import curves
from mechsym.mechanisms.rodless import RodlessParameters

RADIUS, SPEED, MASS = 0.04, 300.0, 1.0  # any: the results are pure numbers [m], [rad/s], [kg] per rod journal
PARAMETERS = RodlessParameters(r=RADIUS, I1=0.1, m_link=0.0, I_link=0.0, m_a=2 * MASS, m_b=2 * MASS)


def inertia_resultant(alpha: np.ndarray) -> np.ndarray:
    """Resultant of the inertia forces of four rod journals, two on each axis, at constant speed.

    Parameters
    ----------
    alpha : ndarray, shape (n,)
        Crank angles [rad]

    Returns
    -------
    force : ndarray, shape (2, n)
        Along the axis of the slider that is outermost at angle 0, and along the other one [N]
    """
    found = curves(mechanisms.build("rodless", PARAMETERS), alpha)
    return -2 * MASS * SPEED**2 * np.array([found["d2x_a_dalpha2"], found["d2x_b_dalpha2"]])

"""Prymak (undated): the inertia forces of a rodless mechanism, which are the paper's only computed result."""

from typing import Any

import numpy as np

from mechsym.mechanism import curves
from mechsym.mechanisms.rodless import RodlessParameters, build
from mechsym.reproduce.rows import row

SOURCE = "003_8746f5f4ad51b1d1"
# the paper prints no data; its results are pure numbers and do not depend on these
RADIUS, SPEED, MASS = 0.04, 300.0, 1.0  # [m], [rad/s], [kg] reciprocating per rod journal


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
    parameters = RodlessParameters(r=RADIUS, I1=0.1, u1=0.0, m_link=0.0, I_link=0.0, m_a=2 * MASS, m_b=2 * MASS)
    found = curves(build(parameters), alpha)
    return -2 * MASS * SPEED**2 * np.array([found["d2x_a_dalpha2"], found["d2x_b_dalpha2"]])


def rows() -> list[dict[str, Any]]:
    """The paper's results (4) and (5), and its conclusion 3.

    Returns
    -------
    rows : list of dict
        Keys source, item, published, computed, rel_error, verdict, note
    """
    alpha = np.linspace(0, 2 * np.pi, 361)
    along, across = inertia_resultant(alpha)
    size = np.hypot(along, across) / (MASS * RADIUS * SPEED**2)
    turned = np.unwrap(np.arctan2(across, along))
    return [
        row(SOURCE, "(4) resultant inertia force over m r omega^2", 4.0, float(size.mean()), "reproduced",
            f"constant within {np.ptp(size):.0e} over a turn"),
        row(SOURCE, "(5) angle of the resultant over the crank angle", 1.0,
        float((turned[-1] - turned[0]) / (2 * np.pi)),
            "reproduced", "it turns with the crank"),
        row(SOURCE, "conclusion 3: share of the resultant across a rod, at most", 0.0,
            float(np.max(np.abs(across)) / np.max(np.hypot(along, across))), "not reproduced",
            "the resultant points along a rod at four angles of a turn only; what turns with the crank is not along a "
            "rod"),
        row(SOURCE, "conclusions 1 and 2: losses by friction, wear", None, None, "not computable",
            "the paper gives no loads, no coefficients and no numbers"),
    ]  # fmt: skip

r"""A shaft with one coordinate over the angle: kinetic energy instead of speed, angle instead of time.

.. math:: \frac{\mathrm{d}T}{\mathrm{d}\varphi} = Q(\varphi) - M_r(\omega),
          \qquad T = \tfrac12 (I(\varphi) + J)\,\omega^2

Q is the torque of everything that depends on the angle only (gas, hinge, gravity), M_r the load, J a flywheel. Kinks of
the torque are known angles, so panels end at them; a shaft that stops is T = 0, where nothing is singular. Each panel
carries Gauss points, and a turn costs less than a millisecond.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre

from mechsym.errors import BadInput
from mechsym.machine.loads import Load
from mechsym.quantities import record

_POINTS = 10
_WIDEST = np.pi / 18


@record
class ReducedMachine:
    """A machine reduced to its crank: inertia and torque over the angle, and the load."""

    inertia: Callable[[np.ndarray], np.ndarray]  #: phi, ndarray (n,), to reduced inertia [kg*m^2]
    #: phi, ndarray (n,), to the torque of all that depends on the angle only [N*m]
    torque: Callable[[np.ndarray], np.ndarray]
    load: Load
    period: float = 2 * np.pi  #: Period of inertia and torque [rad]
    kinks: tuple[float, ...] = ()  #: Where they are not smooth, in [0, period) [rad]


@record
class Panels:
    """A machine evaluated once at the Gauss points of one period."""

    load: Load
    edges: np.ndarray  #: shape (k + 1,): Ends of the panels [rad]
    phi: np.ndarray  #: shape (k, n): Gauss points [rad]
    #: shape (k, n): There [kg*m^2, N*m]
    inertia: np.ndarray
    torque: np.ndarray
    inertia_edges: np.ndarray  #: shape (k + 1,): Inertia at the ends [kg*m^2]


@lru_cache(maxsize=1)
def gauss() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Gauss points of a panel.

    Returns
    -------
    x, weights, matrix : ndarray, shape (n,), (n,) and (n, n)
        On [-1, 1], and what integrates from -1 to each point [-]
    """
    x, weights = legendre.leggauss(_POINTS)
    to_coefficients = np.linalg.inv(legendre.legvander(x, _POINTS - 1))
    integrals = np.array([legendre.legval(x, legendre.legint(row, lbnd=-1)) for row in np.eye(_POINTS)])
    return x, weights, integrals.T @ to_coefficients


def tabulate(machine: ReducedMachine, phi_start: float = 0.0) -> Panels:
    """Evaluate a machine at the Gauss points of one period.

    Parameters
    ----------
    phi_start : float
        Where the period begins [rad]

    Returns
    -------
    panels : Panels
        Values for `turn` and what builds on it
    """
    kinks = [phi_start + (k - phi_start) % machine.period for k in machine.kinks]
    ends = np.unique([phi_start, *kinks, phi_start + machine.period])
    ends = ends[np.append(True, np.diff(ends) > 1e-12)]
    even = [np.linspace(a, b, int(np.ceil((b - a) / _WIDEST)) + 1)[:-1] for a, b in zip(ends, ends[1:], strict=False)]
    edges = np.append(np.concatenate(even), phi_start + machine.period)
    x = gauss()[0]
    phi = (edges[1:, None] + edges[:-1, None]) / 2 + np.diff(edges)[:, None] / 2 * x
    inertia, torque, at_edges = machine.inertia(phi.ravel()), machine.torque(phi.ravel()), machine.inertia(edges)
    for name, values in (("inertia", inertia), ("torque", torque), ("inertia", at_edges)):
        bad = ~np.isfinite(values) | ((values <= 0) if name == "inertia" else False)
        if np.any(bad):
            raise BadInput(f"{name} = {values[bad][0]} at an angle of the turn; it must be finite, an inertia > 0")
    return Panels(
        load=machine.load, edges=edges, phi=phi, inertia=inertia.reshape(phi.shape),
        torque=torque.reshape(phi.shape), inertia_edges=at_edges,
    )  # fmt: skip

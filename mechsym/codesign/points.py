r"""Operating points of a machine: the work that each wants from the hinge, the motion it leaves.

    W_k(phi)  work wanted [J], period 2 pi or 4 pi     I(phi)  inertia of the engine [kg*m^2]
    w_k(phi)  wanted and missing, W_k + U(z; p_k) + omega_k^2 I_h / 2 with the energy U that the springs store

phi = 0 at top dead centre, positive in the sense of rotation; pressures of springs are excess pressures.
"""

from collections.abc import Callable, Sequence

import casadi as ca
import numpy as np

from mechsym import periodic
from mechsym.errors import BadInput
from mechsym.hinge.balance import constant_load_speed, or_stopped, propeller_load_speed, ripple
from mechsym.periodic.pieces import PPoly
from mechsym.periodic.roots import root
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.units import Array, Inertia, Joule, Pure, Radian

_EVEN = 1440  # angles for the closed forms of the motion

Function = Callable[[np.ndarray], np.ndarray]


@record
class Point:
    """One speed and load at which the machine has to turn evenly."""

    omega: float = quantity("rad/s", above=0, about="mean speed")
    load: float = quantity("Pa", default=0.0, about="mean indicated pressure; 0 where the machine has none")
    load_torque: float = quantity("N*m", about="mean torque that the load takes")
    law: str = choice("propeller", "constant", default="propeller", about="how the load follows the speed")
    weight: float = quantity("-", default=1.0, low=0, about="share of the time at this point")
    period: float = quantity("rad", above=0, about="period of the torque")
    work: PPoly  #: work W wanted from the hinge, from phi = 0 [J]
    inertia: PPoly  #: inertia I of the engine [kg*m^2]
    torque: Function  #: gas and gravity over the angle [rad], as computed, not fitted [N*m]
    misfire: Function | None = None  #: the same for a turn without combustion [N*m]
    kinks: tuple[float, ...] = ()  #: angles where the torque is not smooth [rad]
    misfire_kinks: tuple[float, ...] = ()  #: the same of the turn without combustion [rad]
    #: Formulas of the torque, gas and gravity, from angle to angle [rad], and of the inertia; none where a table is
    formulas: tuple[tuple[float, float, ca.Function], ...] = ()
    inertia_formula: ca.Function | None = None


@record
class Samples:
    """Points on angles that contain the kinks, for the programme."""

    phi: np.ndarray  #: shape (n,), ascending from 0 without the end of the period [rad]
    step: np.ndarray  #: shape (n,), to the next angle [rad]
    work: np.ndarray  #: shape (k, n) [J]
    inertia: np.ndarray  #: shape (n,) [kg*m^2]
    omega: np.ndarray  #: shape (k,) [rad/s]

    @property
    def weights(self) -> np.ndarray:
        """Shares of the angles in a mean by trapezia, shape (n,) [-]."""
        return (self.step + np.roll(self.step, 1)) / 2 / self.step.sum()


def grid(period: float, kinks: Sequence[float], count: int) -> np.ndarray:
    """About `count` angles of a period [rad], even between the kinks, which are among them; the end is left out."""
    inner = {round(float(k % period), 12) for k in kinks}
    ends = np.array(sorted({0.0, *inner} - {round(period, 12)}))
    ends = np.append(ends, period)
    width = period / count
    pieces = [np.linspace(a, b, max(1, round((b - a) / width)) + 1)[:-1] for a, b in zip(ends, ends[1:], strict=False)]
    return np.concatenate(pieces)


def sample(points: Sequence[Point], count: int) -> Samples:
    """All points on common angles; `count` is how many in a period, about."""
    first = points[0]
    if any(p.period != first.period for p in points):
        raise BadInput("the operating points have different periods; a guide is made for one")
    phi = grid(first.period, sorted({k for p in points for k in p.kinks}), count)
    return Samples(
        phi=phi,
        step=np.diff(phi, append=first.period),
        work=np.array([p.work(phi) for p in points]),
        inertia=first.inertia(phi),
        omega=np.array([p.omega for p in points]),
    )


def motion(point: Point, missing: Function, inertia: Function) -> tuple[np.ndarray, np.ndarray | None]:
    """Even angles [rad] and the steady speed there [rad/s] by the closed forms; None where the shaft would stop.

    missing: angle to work that is wanted and missing [J]; inertia: angle to all inertia that turns [kg*m^2].
    """
    phi = even_angles(point)
    return phi, speed(point, missing(phi), inertia(phi))


def even_angles(point: Point) -> Radian[Array]:
    """Angles of a period at which `motion` knows the speed."""
    return periodic.even_angles(point.period, _EVEN)


def speed(point: Point, missing: Joule[Array], inertia: Inertia[Array]) -> np.ndarray | None:
    """The steady speed at those angles [rad/s], see `motion`."""
    if point.law == "constant":
        return constant_load_speed(missing, inertia, point.omega)
    return propeller_load_speed(missing, inertia, point.omega, point.load_torque, point.period)


def bare_ripple(point: Point, flywheel: float) -> float | None:
    """Ripple without a hinge and with a flywheel [kg*m^2] beside the engine's own inertia; None if the shaft stops."""
    return ripple(motion(point, point.work, lambda phi: point.inertia(phi) + flywheel)[1])


def swing(points: Sequence[Point]) -> Inertia:
    r"""Largest swing of the wanted works: the size of the flywheels of a machine, and the unit that they are sought in.

    .. math:: \max_k \mathrm{ptp}\,W_k / \omega_k^2
    """
    return max(float(np.ptp(p.work(np.linspace(0, p.period, 361)))) / p.omega**2 for p in points)


def bare_flywheel(points: Sequence[Point], wanted: Pure) -> Inertia:
    r"""Flywheel that keeps the ripple at all points without a hinge.

    .. math:: J + \overline{I} \approx \frac{1}{\delta} \max_k \frac{\mathrm{ptp}\,W_k}{\omega_k^2}

    for weak ripple; here the motion is exact. wanted: largest ripple, (max - min) / mean of the speed. Returns inertia:
    added to the engine's own; 0 where none is needed.
    """

    def excess(flywheel: float) -> float:
        return max(or_stopped(bare_ripple(point, flywheel)) for point in points) - wanted

    if excess(0.0) <= 0:
        return 0.0
    high = 2 * swing(points) / wanted
    while excess(high) > 0:
        high *= 2
    return root(excess, 0.0, high, xtol=1e-6 * high, rtol=1e-10)

r"""A guide cut for a gas spring that exchanges heat with its wall: the law `air_thermal`.

Such a spring has no law of its closing alone; it is cut for its periodic motion at the speed of the design. With the
work G that the rollers put into the gas by angle, first law and gas law give its state,

.. math:: G = \frac{l - M_\theta}{1 - p_a/p}, \qquad T' = \frac{(\gamma - 1) G}{K} - \frac{T - T_w}{\omega\tau}, \qquad
          (\ln V)' = -\frac{G}{K T}, \qquad K = \frac{(p_0 + p_a) A H}{T_w}

and l, the mean torque that the gas keeps, closes the volume after a period.
"""

import math
from collections.abc import Callable

import numpy as np
import scipy

from mechsym.errors import BadInput
from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import ROLLERS, GuideParameters
from mechsym.hinge.thermal import AirThermal, GasTurn, turn
from mechsym.hinge.torque import Hinge
from mechsym.quantities import record

_STEP = np.pi / 360  # widest step of the march
_STABLE = 1.5  # and by omega tau; the method is stable up to 2.78
_FASTEST = 2e-3  # least omega tau: below it the gas is isothermal within 0.1 % of its pressure [rad]
_COLDEST, _HOTTEST, _WIDEST = 1.0, 1e5, 30.0  # where a march that cannot be held is stopped [K, K, ln of the volume]
_SCALES = (0.5, 1.0)  # shares of the torque on the way to all of it
_LEAST = 1.0001  # of the pressure outside; below it the march goes on and the path is refused
_POINTS = 1440  # angles of a period at which the gas of a path is followed
_FULL = 1 - 1e-6  # share of the closing beyond which rounding would decide the force
_CLOSED = 1e-9  # largest gap of state and volume after a period


@record
class ThermalPath:
    """Path of the roller centres for a gas that exchanges heat."""

    #: Over the angle of the guide's shaft [m]; None where the spring cannot hold the work
    rho: "scipy.interpolate.PPoly | None"
    status: str  #: As in `Guide`
    reason: str
    kept: float  #: Mean torque that the gas keeps, on the guide's shaft [N*m]
    closure: float  #: Gap of the path after a period [m]


@record
class _March:
    temperature: np.ndarray  #: shape (n,) [K]
    volume: np.ndarray  #: shape (n,) [m^3]
    pressure: np.ndarray  #: shape (n,): Absolute [Pa]


@record
class _Task:
    """What a march needs: the spring, the angles, and the torque at them and in the middle of each step."""

    spring: AirThermal
    theta: np.ndarray  #: shape (n,) [rad]
    at: np.ndarray  #: shape (n,): Torque of the guide there [N*m]
    between: np.ndarray  #: shape (n - 1,): Torque in the middle of each step [N*m]
    x: float  #: omega tau of the guide's shaft [rad]
    top: float  #: Largest volume, or that at the start [m^3]
    placed: bool


def thermal_path(wanted: Hinge | Balance, spring: AirThermal, parameters: GuideParameters) -> ThermalPath:
    """Path on which the gas gives a torque, less the mean that it keeps.

    Parameters
    ----------
    wanted : Hinge or Balance
        Torque to give at its own speed

    Notes
    -----
    Source: first law of a closed gas with heat flow in proportion to T - T_w, see `thermal`. Valid: one temperature in
    the gas, steady running at the speed of the design.
    """
    ratio, count = parameters.shaft_ratio, ROLLERS[parameters.arrangement]
    x, placed = wanted.omega * ratio * spring.tau, parameters.start == "placed"
    if x < _FASTEST:
        raise BadInput(
            f"spring.tau = {spring.tau:g} s: at {wanted.omega * ratio:.4g} rad/s the gas always has the temperature of "
            f"the wall; write law = 'air_absolute' with n = 1, or give at least {_FASTEST / wanted.omega / ratio:.2g} s"
        )
    theta = _nodes(wanted.torque.x * ratio, min(_STEP, _STABLE * x))
    middle = (theta[1:] + theta[:-1]) / 2
    task = _Task(
        spring=spring, theta=theta, at=wanted.torque(theta / ratio) / ratio,
        between=wanted.torque(middle / ratio) / ratio, x=x,
        top=spring.A * (spring.H - (parameters.z_margin if placed else 0.0)), placed=placed,
    )  # fmt: skip
    kept, found = _periodic(task)
    z, force = spring.H - found.volume / spring.A, spring.A * (found.pressure - spring.pa)
    status, reason = _status(task, z, found, parameters)
    if status != "cut":
        return ThermalPath(rho=None, status=status, reason=reason, kept=kept, closure=0.0)
    rho, gap = parameters.rho0 - z / count, abs(float(z[-1] - z[0])) / count
    rho[-1] = rho[0]
    slope = (task.at - kept) / (count * force)
    slope[-1] = slope[0]
    curve = scipy.interpolate.CubicHermiteSpline(theta, rho, slope)
    path = scipy.interpolate.PPoly(curve.c, curve.x, extrapolate="periodic")
    return ThermalPath(rho=path, status="cut", reason="", kept=kept, closure=gap)


def gas_on(
    spring: AirThermal, rho: "scipy.interpolate.PPoly", closing: Callable[[np.ndarray], np.ndarray], omega: float
) -> GasTurn:
    """Steady turn of the gas on a path, at even angles of a period.

    Parameters
    ----------
    closing : callable
        Of rho [m], in [m]
    omega : float
        Speed of the guide's shaft [rad/s]
    """
    period = float(rho.x[-1] - rho.x[0])
    theta = rho.x[0] + np.arange(_POINTS) * period / _POINTS
    return turn(spring, closing(rho(theta)), np.full(_POINTS, period / _POINTS), omega)


def warmth_of(spring: AirThermal, found: GasTurn, rho: "scipy.interpolate.PPoly") -> "scipy.interpolate.PPoly":
    """Temperature of the gas by the wall's [-] over the angle of the guide's shaft."""
    values = np.append(found.temperature, found.temperature[0]) / spring.wall_temperature
    curve = scipy.interpolate.CubicSpline(np.linspace(rho.x[0], rho.x[-1], _POINTS + 1), values, bc_type="periodic")
    return scipy.interpolate.PPoly(curve.c, curve.x, extrapolate="periodic")


def _nodes(breaks: np.ndarray, step: float) -> np.ndarray:
    pairs = zip(breaks, breaks[1:], strict=False)
    parts = [np.linspace(a, b, int(np.ceil((b - a) / step)) + 1)[:-1] for a, b in pairs]
    return np.append(np.concatenate(parts), breaks[-1])


def _periodic(task: _Task) -> tuple[float, _March]:
    """Mean torque [N*m] that the gas keeps and its periodic state, found with a growing share of the torque."""
    size = float(np.abs(task.at).max())
    unknown = np.array([1.0, 0.0, 0.0])  # temperature by the wall's, ln of the volume by the largest, kept by the size

    def gaps(y: np.ndarray, share: float) -> np.ndarray:
        start = task.top * math.exp(min(max(y[1], -_WIDEST), _WIDEST))
        march = _march(task, y[0] * task.spring.wall_temperature, start, y[2] * size, share)
        level = march.volume.max() if task.placed else march.volume[0]
        closing = np.log(march.volume[-1] / march.volume[0])
        warmer = (march.temperature[-1] - march.temperature[0]) / task.spring.wall_temperature
        return np.array([warmer, closing, np.log(level / task.top)])

    for share in _SCALES:
        unknown = scipy.optimize.root(gaps, unknown, args=(share,), tol=1e-13).x
    wall = task.spring.wall_temperature
    start = task.top * math.exp(min(max(unknown[1], -_WIDEST), _WIDEST))
    return float(unknown[2] * size), _march(task, unknown[0] * wall, start, unknown[2] * size)


def _march(task: _Task, temperature: float, volume: float, kept: float, share: float = 1.0) -> _March:
    """The state along a period by the classical method of Runge and Kutta, from its first angle."""
    spring, wall = task.spring, task.spring.wall_temperature
    full = (spring.p0 + spring.pa) * spring.A * spring.H / wall
    gain, rate, least = (spring.gamma - 1) / full, 1 / task.x, _LEAST * spring.pa

    def slope(T: float, lnv: float, torque: float) -> tuple[float, float]:
        T, lnv = max(T, _COLDEST), max(lnv, -_WIDEST)
        p = max(full * T * math.exp(-lnv), least)
        G = (kept - share * torque) / (1 - spring.pa / p)
        return gain * G - (T - wall) * rate, -G / (full * T)

    T, lnv = min(max(temperature, _COLDEST), _HOTTEST), math.log(volume)
    rows, steps = [(T, lnv)], np.diff(task.theta).tolist()
    for h, first, half, last in zip(steps, task.at.tolist(), task.between.tolist(), task.at[1:].tolist(), strict=False):
        a = slope(T, lnv, first)
        b = slope(T + h / 2 * a[0], lnv + h / 2 * a[1], half)
        c = slope(T + h / 2 * b[0], lnv + h / 2 * b[1], half)
        d = slope(T + h * c[0], lnv + h * c[1], last)
        T = min(max(T + h / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0]), _COLDEST), _HOTTEST)
        lnv = min(max(lnv + h / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1]), -_WIDEST), _WIDEST)
        rows.append((T, lnv))
    states = np.array(rows)
    V = np.exp(states[:, 1])
    return _March(temperature=states[:, 0], volume=V, pressure=full * states[:, 0] / V)


def _status(task: _Task, z: np.ndarray, found: _March, parameters: GuideParameters) -> tuple[str, str]:
    spring, gap = task.spring, abs(float(z[-1] - z[0]))
    if not np.all(np.isfinite(z)) or gap > _CLOSED * spring.H or float(found.pressure.min()) <= _LEAST * spring.pa:
        return "spring_pulls", "the gas would have to give more work than it holds; raise p0, A, H or z_margin"
    if z.max() >= _FULL * spring.H:
        why = "the spring would have to close fully; make it stiffer or longer"
        return "spring_bottoms", f"{why} (H = {spring.H:g} m)"
    rho_min = parameters.rho0 - float(z.max()) / ROLLERS[parameters.arrangement]
    if rho_min <= 0:
        return "crosses_axis", (
            f"the path crosses the shaft axis: its smallest rho would be {rho_min * 1e3:.4g} mm; "
            "enlarge rho0, stiffen the spring, or let two rollers share its closing"
        )
    return "cut", ""

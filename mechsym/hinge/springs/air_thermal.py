r"""A gas spring that exchanges heat with a wall of constant temperature, and the guide cut for it.

    p = m R T / V,   V = A (H - z)                closed gas, one temperature, wall at T_w
    tau = m c_v / (h A_w)                         time in which the gas takes the temperature of the wall

.. math:: T' = -(\gamma - 1)\,T\,\frac{V'}{V} - \frac{T - T_w}{\omega\tau}, \qquad s = T V^{\gamma - 1}: \quad
          s' = \frac{T_w V^{\gamma - 1} - s}{\omega\tau}

over the angle. It is linear in s: one pass around the turn and one division give the periodic motion. tau to infinity
is the adiabatic spring, n = gamma; tau to 0 the isothermal one, n = 1; both give back all that they take. Between them
heat flows through a difference of temperature, and work is lost: a spring that shows n = 1.25 with gamma = 1.4 has
omega tau = 1.29, and that is where it loses most. Only a heat store that follows the gas (foam) shows it without loss.

The law `air_thermal`: such a spring has no law of its closing alone; a guide is cut for its periodic motion at the
speed of the design. With the work G that the rollers put into the gas by angle, first law and gas law give its state,

.. math:: G = \frac{l - M_\theta}{1 - p_a/p}, \qquad T' = \frac{(\gamma - 1) G}{K} - \frac{T - T_w}{\omega\tau}, \qquad
          (\ln V)' = -\frac{G}{K T}, \qquad K = \frac{(p_0 + p_a) A H}{T_w}

and l, the mean torque that the gas keeps, closes the volume after a period.
"""

import math

import casadi as ca
import numpy as np
import scipy

from mechsym.errors import BadInput
from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import GuideParameters
from mechsym.hinge.rollers import HingeLosses
from mechsym.hinge.springs.face import GasTurn, Spring
from mechsym.hinge.springs.law_path import FULL, TrackPath, can_be_given, crossing, takes_work
from mechsym.hinge.torque import Hinge
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Array, Kelvin, Metre, Pascal, Pure, Radian, RadPerSecond, Scalar, Volume


def thermal_pressure(
    z: Metre[Scalar], H: Metre[Scalar], p0: Pascal[Scalar], pa: Pascal[Scalar], warmth: Pure[Scalar]
) -> Pascal[Scalar]:
    r"""Excess pressure of a gas spring whose temperature is known, for numbers and symbols alike.

    .. math:: p = (p_0 + p_a) \frac{H}{H - z} \frac{T}{T_w} - p_a

    z, H: closing and free height; p0, pa: excess pressure of the full column at the wall's temperature, and the
    pressure outside. Source: ideal gas of constant mass.

    >>> thermal_pressure(0.5, 1.0, 5e6, 1e5, 1.0)
    10100000.0
    """
    return (p0 + pa) * (H / (H - z)) * warmth - pa


def gas_temperature(
    volume: Volume[Scalar], step: Radian[Scalar], x: Radian[Scalar], gamma: Pure, wall: Kelvin
) -> Kelvin[Scalar]:
    r"""Periodic temperature of a closed gas in a volume that moves; arrays and CasADi symbols.

    .. math:: s_{i+1} = e^{-h/x} s_i + T_w \int V^{\gamma - 1} e^{-(h - t)/x} \frac{dt}{x}, \qquad T = s V^{1 - \gamma}

    with V^(gamma - 1) a straight line over each step: exact in the limits of slow and fast exchange. volume: V over one
    period without its end, in any unit. step: angle from each to the next; the last one closes the period. x: omega
    tau. gamma: ratio of specific heats. Source: first law of a closed gas with heat flow in proportion to T - T_w.
    Valid: one temperature in the gas, wall of constant temperature, ideal gas.

    >>> still = gas_temperature(np.ones(4), np.full(4, np.pi / 2), 1.0, 1.4, 320.0)
    >>> np.round(still, 6).tolist()
    [320.0, 320.0, 320.0, 320.0]
    """
    forcing, count = wall * volume ** (gamma - 1), volume.shape[0]
    symbols = isinstance(volume, ca.SX | ca.MX)
    rates = [step[i] / x for i in range(count)] if symbols else list(np.asarray(step) / x)
    known: dict[Scalar, tuple[Scalar, Scalar, Scalar]] = {}
    for r in rates:  # even angles have one relaxation
        if symbols or r not in known:
            known[r] = relaxation(r)
    decay = [known[r][0] for r in rates]
    gains = [known[r][1] * forcing[i] + known[r][2] * forcing[(i + 1) % count] for i, r in enumerate(rates)]
    end = 0.0
    for keep, gain in zip(decay, gains, strict=True):
        end = keep * end + gain
    values = [end / _lost(sum(rates))]
    for keep, gain in zip(decay[:-1], gains[:-1], strict=True):
        values.append(keep * values[-1] + gain)
    return (ca.vertcat(*values) if symbols else np.array(values)) * volume ** (1 - gamma)


def relaxation_time(n: float, omega: float, losses: HingeLosses) -> float:
    """Time [s] of the gas to take the wall's temperature: as assumed, or such that the index n shows at omega [rad/s].

    An index at gamma or above leaves no exchange, one at 1 a very fast one.
    """
    if losses.tau > 0:
        return losses.tau
    return x_of_index(min(max(n, 1 + 1e-6), losses.gamma - 1e-6), losses.gamma) / omega


def x_of_index(n: Pure, gamma: Pure = 1.4) -> Radian:
    r"""omega tau at which small strokes show an index between 1 and gamma.

    .. math:: x = \sqrt{\frac{n - 1}{\gamma - n}}

    n: index, above 1 and below gamma; gamma: ratio of specific heats.

    >>> round(x_of_index(1.25), 2)
    1.29
    """
    return float(np.sqrt((n - 1) / (gamma - n)))


def relaxation(r: Scalar) -> tuple[Scalar, Scalar, Scalar]:
    """exp(-r), and the weights of both ends of a straight line over a step of r relaxation times [-]."""
    keep, lost = _exp(-r), _lost(r)
    # lost / r - keep cancels for short steps; there its series stands
    short = r / 2 - r**2 / 3 + r**3 / 8
    if isinstance(r, ca.SX | ca.MX):
        first = ca.if_else(r < 1e-4, short, lost / r - keep)
    else:
        first = short if r < 1e-4 else lost / r - keep
    return keep, first, lost - first


def _exp(r: Scalar) -> Scalar:
    return ca.exp(r) if isinstance(r, ca.SX | ca.MX) else float(np.exp(r))


def _lost(r: Scalar) -> Scalar:
    """1 - exp(-r) with all its digits."""
    return -ca.expm1(-r) if isinstance(r, ca.SX | ca.MX) else float(-np.expm1(-r))


_STEP = np.pi / 360  # widest step of the march
_STABLE = 1.5  # and by omega tau; the method is stable up to 2.78
_FASTEST = 2e-3  # least omega tau: below it the gas is isothermal within 0.1 % of its pressure [rad]
_COLDEST, _HOTTEST, _WIDEST = 1.0, 1e5, 30.0  # where a march that cannot be held is stopped [K, K, ln of the volume]
_SCALES = (0.5, 1.0)  # shares of the torque on the way to all of it
_LEAST = 1.0001  # of the pressure outside; below it the march goes on and the path is refused
_CLOSED = 1e-9  # largest gap of state and volume after a period


@record
class AirThermal(Spring):
    """Gas spring with a wall of constant temperature; what leaks, make-up brings back."""

    setting = "p0", "Pa"
    sensitive = "p0", "tau"
    words = "air that exchanges heat with its wall"
    gas = True
    state = "warmth"

    A: float = quantity("m^2", low=1e-8, high=100, about="piston area")
    H: float = quantity("m", low=1e-4, high=100, about="free height of the gas column")
    p0: float = quantity("Pa", low=1, high=1e12, about="excess pressure of the full column at the wall's temperature")
    tau: float = quantity("s", above=0, about="time in which the gas takes the temperature of the wall")
    gamma: float = quantity("-", default=1.4, above=1, below=2, about="ratio of specific heats")
    wall_temperature: float = quantity("K", default=320.0, above=0, about="temperature of the wall")
    pa: float = quantity("Pa", default=101325.0, low=0, about="pressure outside, absolute")
    leak: float = quantity("kg/s/Pa", default=0.0, low=0, about="leakage by excess pressure")

    @property
    def tunable(self) -> tuple[str, ...]:
        """Its temperature is a curve, which the others would change."""
        return ("A", "H", "p0", "pa")

    @property
    def area(self) -> float:
        """Its own [m^2]."""
        return self.A

    @property
    def outside(self) -> float:
        """The atmosphere [Pa]."""
        return self.pa

    @property
    def capacity(self) -> float:
        """m c_v T_w of the gas [J]."""
        return (self.p0 + self.pa) * self.A * self.H / (self.gamma - 1)

    def pressure(self, z: Scalar, warm: object = None) -> Scalar:
        """Pressure [Pa] at a closing z [m], see `thermal_pressure`."""
        return thermal_pressure(z, self.H, self.p0, self.pa, warm)

    def force(self, z: Scalar, warm: object = None) -> Scalar:
        """Piston area by the excess pressure [N]."""
        return self.A * self.pressure(z, warm)

    def energy(self, z: Scalar, warm: Scalar = None) -> Scalar:
        """Heat in the gas, and the work against the air outside [J]."""
        return self.capacity * warm + self.pa * self.A * (self.H - z)

    def path(self, wanted: Hinge | Balance, parameters: GuideParameters) -> TrackPath:
        """Path for its periodic motion at the speed of the torque, less the mean that the gas keeps."""
        return _path(wanted, self, parameters)

    def with_wall(self, losses: HingeLosses, omega: float) -> "AirThermal":
        """It has one, at any speed [rad/s]."""
        return self

    def turn(self, z: Metre[Array], step: Radian[Array], omega: RadPerSecond) -> GasTurn:
        r"""Periodic turn of the gas.

        .. math:: p = (p_0 + p_a) \frac{H}{H - z} \frac{T}{T_w} - p_a, \qquad L = -\oint p\,A\,d(H - z) > 0

        z: closing over one period without its end; step: angle from each to the next. Small strokes: n* = 1 + (gamma -
        1)(x^2 + i x)/(1 + x^2), x = omega tau; loss pi Im(n*) p V (dV/V)^2. In a turn the gas gives as heat what it
        keeps of the work: slow exchange is summed as heat, where the work would cancel, fast exchange as work, where
        the difference of temperature would.
        """
        height = self.H - z
        x = omega * self.tau
        T = gas_temperature(height, step, x, self.gamma, self.wall_temperature)
        filled = self.p0 + self.pa
        absolute = thermal_pressure(z, self.H, self.p0, self.pa, T / self.wall_temperature) + self.pa
        weights = (step + np.roll(step, 1)) / 2
        if x > 1:
            heat = filled * self.A * self.H / (self.gamma - 1) * (T / self.wall_temperature - 1) / x
            loss = float(heat @ weights)
        else:
            loss = -float((absolute + np.roll(absolute, -1)) / 2 @ (np.roll(height, -1) - height)) * self.A
        excess = np.maximum(absolute - self.pa, 0.0)
        # slope of the straight line through ln p over ln V; 1 for a spring that does not move
        v, p = np.log(height), np.log(absolute)
        v, p = v - v @ weights / weights.sum(), p - p @ weights / weights.sum()
        square = float((v * v) @ weights)
        return GasTurn(
            temperature=T,
            warmth=T / self.wall_temperature,
            pressure=absolute - self.pa,
            loss=loss,
            n_effective=1.0 if square <= 1e-30 else -float((v * p) @ weights) / square,
            leaked=float(self.leak * (excess @ weights) / omega),
        )

    def warming(self, warm: Scalar, z: Scalar, opening: Scalar) -> Scalar:
        """First law over time: expansion cools, the wall warms [1/s]."""
        return -(self.gamma - 1) * warm * (opening / (self.H - z)) - (warm - 1) / self.tau

    def heat(self, warm: Scalar) -> Scalar:
        """In proportion to the difference of temperature [W]."""
        return self.capacity * (warm - 1) / self.tau


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


def _path(wanted: Hinge | Balance, spring: AirThermal, parameters: GuideParameters) -> TrackPath:
    """Path on which the gas gives a torque, less the mean that it keeps.

    wanted: torque to give at its own speed. Source: first law of a closed gas with heat flow in proportion to T - T_w,
    see above. Valid: one temperature in the gas, steady running at the speed of the design.
    """
    if not can_be_given(wanted):
        return TrackPath(status="takes_work", reason=takes_work(wanted))
    ratio, count = parameters.shaft_ratio, parameters.rollers
    x, placed = wanted.omega * ratio * spring.tau, parameters.start == "placed"
    if x < _FASTEST:
        raise BadInput(
            f"spring.tau = {spring.tau:g} s: at {wanted.omega * ratio:.4g} rad/s the gas always has the temperature of "
            f"the wall; write law = 'air_absolute' with n = 1, or give at least {_FASTEST / wanted.omega / ratio:.2g} s"
        )
    breaks = wanted.torque.x * ratio
    step = min(_STEP, _STABLE * x)
    pairs = zip(breaks, breaks[1:], strict=False)
    parts = [np.linspace(a, b, int(np.ceil((b - a) / step)) + 1)[:-1] for a, b in pairs]
    theta = np.append(np.concatenate(parts), breaks[-1])
    middle = (theta[1:] + theta[:-1]) / 2
    task = _Task(
        spring=spring, theta=theta, at=wanted.torque(theta / ratio) / ratio,
        between=wanted.torque(middle / ratio) / ratio, x=x,
        top=spring.A * (spring.H - (parameters.z_margin if placed else 0.0)), placed=placed,
    )  # fmt: skip
    kept, last = _periodic(task)
    z, force = spring.H - last.volume / spring.A, spring.A * (last.pressure - spring.pa)
    status, reason = _status(task, z, last, parameters)
    if status != "cut":
        return TrackPath(status=status, reason=reason)
    rho, gap = parameters.rho0 - z / count, abs(float(z[-1] - z[0])) / count
    rho[-1] = rho[0]
    slope = (task.at - kept) / (count * force)
    slope[-1] = slope[0]
    path = PPoly.hermite(theta, rho, slope)
    path.extrapolate = "periodic"
    return TrackPath(status="cut", rho=path, closure=gap)


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


def _status(task: _Task, z: np.ndarray, march: _March, parameters: GuideParameters) -> tuple[str, str]:
    spring, gap = task.spring, abs(float(z[-1] - z[0]))
    if not np.all(np.isfinite(z)) or gap > _CLOSED * spring.H or float(march.pressure.min()) <= _LEAST * spring.pa:
        return "spring_pulls", "the gas would have to give more work than it holds; raise p0, A, H or z_margin"
    if z.max() >= FULL * spring.H:
        why = "the spring would have to close fully; make it stiffer or longer"
        return "spring_bottoms", f"{why} (H = {spring.H:g} m)"
    return crossing(parameters, float(z.max()))

r"""Unknowns and constraints of the programme: guides with their springs, where they start, limits, losses.

Paths are periodic cubic B-splines with a knot at every kink of the torque, as sparse matrices. Friction of a hinge and
heat of its gas are unknowns and constraints too:

.. math:: s' = \frac{V^{\gamma-1} - s}{x}, \quad \frac{T}{T_w} = s V^{1-\gamma}, \qquad
          \lambda' = M_\mathrm{friction} + \frac{(p_0 + p_a) A H}{(\gamma - 1)\,x}\Bigl(\frac{T}{T_w} - 1\Bigr)
          - \overline M

s is an unknown at each angle, one for each guide and each x = omega tau; lambda is the work that is lost beyond its
mean rate, and the mean torque M is taken from the load. The gas stores (p_0 + p_a) A H T / T_w / (gamma - 1) - p_a A z;
where exchange is fast (x below 1) temperatures differ too little for that, and its work stands in lambda instead.
"""

import dataclasses
from collections.abc import Iterable, Sequence

import casadi as ca
import numpy as np
import scipy

from mechsym.codesign.points import Point, Samples, swing
from mechsym.codesign.settings import FREE
from mechsym.codesign.task import MOST_MASS, CoDesignTask, Hardware, Path, path_of, roller_inertia
from mechsym.hinge.choices import ROOM
from mechsym.hinge.guide import setting_of
from mechsym.hinge.rollers import HingeLosses, friction_torques
from mechsym.hinge.springs.air_thermal import AirThermal, gas_temperature, relaxation
from mechsym.hinge.springs.face import lettered
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Scalar

_DEGREE = 3


@record
class Basis:
    """Knots of one period; a spline has as many coefficients as there are knots."""

    knots: np.ndarray  #: shape (m,), ascending in [0, period) [rad]
    period: float = quantity("rad", above=0, about="period of the splines")

    @property
    def count(self) -> int:
        """Number of coefficients."""
        return int(self.knots.size)


def basis(period: float, kinks: Sequence[float], count: int) -> Basis:
    """About `count` even knots over a period [rad]; the nearest one is moved onto each kink [rad]."""
    knots = np.arange(count) * period / count
    moved = np.zeros(count)
    for kink in sorted({float(k % period) for k in kinks}):
        away = np.abs((knots - kink + period / 2) % period - period / 2) + moved
        nearest = int(np.argmin(away))
        knots[nearest], moved[nearest] = kink, np.inf
    return Basis(knots=np.unique(knots), period=period)


def matrices(basis: Basis, phi: np.ndarray) -> tuple[ca.DM, ca.DM, ca.DM]:
    """Sparse matrices of shape (n, m) from coefficients to the value and its first two derivatives at phi [rad]."""
    splines, columns = scipy.interpolate.BSpline(_extended(basis), np.eye(basis.count + _DEGREE), _DEGREE), []
    phi = basis.knots[0] + (phi - basis.knots[0]) % basis.period
    for order in range(3):
        spread = splines.derivative(order)(phi) if order else splines(phi)
        folded = spread[:, : basis.count].copy()
        folded[:, :_DEGREE] += spread[:, basis.count :]
        folded[np.abs(folded) < 1e-14] = 0.0
        columns.append(ca.sparsify(ca.DM(folded)))
    return columns[0], columns[1], columns[2]


def curve(basis: Basis, coefficients: np.ndarray) -> PPoly:
    """The periodic piecewise polynomial of some coefficients, over [0, period) [rad]."""
    t, wrapped = _extended(basis), np.append(coefficients, coefficients[:_DEGREE])
    whole = scipy.interpolate.PPoly.from_spline(scipy.interpolate.BSpline(t, wrapped, _DEGREE))
    inside = [i for i in range(whole.x.size - 1) if whole.x[i + 1] > whole.x[i]]
    first = basis.knots[0]
    inside = [i for i in inside if first - 1e-12 <= whole.x[i] < first + basis.period - 1e-12]
    breaks = np.append(whole.x[inside], first + basis.period)
    return PPoly(whole.c[:, inside], breaks, extrapolate="periodic")


def fitted(basis: Basis, values: np.ndarray, phi: np.ndarray) -> np.ndarray:
    """Coefficients, shape (m,), of the spline nearest to values at phi [rad]."""
    return np.linalg.lstsq(np.asarray(matrices(basis, phi)[0].full()), values, rcond=None)[0]


def _extended(basis: Basis) -> np.ndarray:
    before = basis.knots[-_DEGREE:] - basis.period
    after = basis.knots[: _DEGREE + 1] + basis.period
    return np.concatenate([before, basis.knots, after])


_LEAST, _MOST = 1e-3, 1e3  # pressures by those of the start


@record
class GuideSymbols:
    """One guide of the programme: symbols, all in SI."""

    coefficients: ca.SX  #: of the spline of z, shape (m,) [m]
    p0: ca.SX  #: excess pressure at each point, shape (k,) [Pa]
    largest: ca.SX  #: bound of all of them [Pa]
    scale: float = quantity("Pa", about="size of the pressures")
    #: hardware that may be free, as far as it has it: A [m^2], H, rho0, radius, width [m], moving_mass [kg]
    values: dict[str, ca.SX]
    shares: tuple[ca.SX, ...]  #: free ones of it by the values of the case [-]
    path: Path
    inertia: ca.SX  #: of the rollers about the crank, shape (n,) [kg*m^2]


@dataclasses.dataclass
class Gathered:
    """Unknowns and rows while the programme is put together."""

    unknowns: list[ca.SX] = dataclasses.field(default_factory=list)
    start: list[np.ndarray] = dataclasses.field(default_factory=list)
    box: list[np.ndarray] = dataclasses.field(default_factory=list)
    rows: list[list[ca.SX]] = dataclasses.field(default_factory=list)
    low: list[np.ndarray] = dataclasses.field(default_factory=list)
    high: list[np.ndarray] = dataclasses.field(default_factory=list)

    def unknown(self, name: str, start: np.ndarray, low: float = -np.inf, high: float = np.inf) -> ca.SX:
        """A column of unknowns with its start and bounds [-]."""
        letters = ca.SX.sym(name, len(start))
        self.add(letters, start, low, high)
        return letters

    def add(self, symbols: ca.SX, start: np.ndarray, low: float = -np.inf, high: float = np.inf) -> None:
        """Unknowns that exist already, with their start and bounds [-]."""
        self.unknowns.append(symbols)
        self.start.append(np.clip(start, low, high))
        self.box.append(np.tile([low, high], (len(start), 1)))

    def group(self, pieces: Iterable[tuple[ca.SX, float, float]]) -> None:
        """Constraints that share terms, in pieces (rows, low, high): low <= rows <= high [-]."""
        self.rows.append([])
        for rows, low, high in pieces:
            self.rows[-1].append(rows)
            self.low.append(np.broadcast_to(low, rows.numel()))
            self.high.append(np.broadcast_to(high, rows.numel()))


def guides(task: CoDesignTask, samples: Samples, splines: Basis, gathered: Gathered) -> list[GuideSymbols]:
    """Symbols of each guide, with their start; the pressures of a guide stand below one bound."""
    B, B1, B2 = matrices(splines, samples.phi)
    pressures, symbols, given = start_pressures(task, samples), [], task.hardware
    count = 1 if task.schedule == "one" else len(task.points)
    for s, shape in enumerate(shapes(task, samples)):
        values, shares = _hardware(task, s, gathered)
        size = given.spring.H
        c = size * gathered.unknown(f"z{s}", fitted(splines, shape / size, samples.phi))
        scale = float(pressures[s].max())
        p0 = gathered.unknown(f"p{s}", np.ones(count), _LEAST, _MOST) * pressures[s][:count]
        largest = scale * gathered.unknown(f"p_max{s}", np.ones(1), _LEAST, _MOST)
        path = path_of(given, values["rho0"], B @ c, B1 @ c, B2 @ c)
        rollers = roller_inertia(
            path.rho, path.drho, values["moving_mass"], given.roller_inertia, values["radius"], given.count
        )
        symbols.append(GuideSymbols(
            coefficients=c, p0=ca.repmat(p0, len(task.points) // count, 1), largest=largest, scale=scale,
            values=values, shares=tuple(shares), path=path, inertia=given.shaft_ratio**2 * rollers,
        ))  # fmt: skip
    return symbols


def _hardware(task: CoDesignTask, s: int, gathered: Gathered) -> tuple[dict[str, ca.SX], list[ca.SX]]:
    given = task.hardware.values(*FREE, "moving_mass")
    values = {name: ca.SX(value) for name, value in given.items()}
    shares = []
    for name in task.free:
        if name == "moving_mass":
            mass = 0.1 * swing(task.points) / task.hardware.spring.H**2  # of the size of the rollers that pay
            values[name] = mass * gathered.unknown(f"{name}{s}", np.ones(1), 0.0, MOST_MASS / mass)
        else:
            shares.append(gathered.unknown(f"{name}{s}", np.ones(1), *FREE[name]))
            values[name] = given[name] * shares[-1]
    if ROOM.holds(task.hardware.spring, task.hardware.count) and set(task.free) & {"rho0", "H", "radius"}:
        # between the roller centres lie 2 rho = H - z + (2 rho0 - H); the rest beside the gas must hold both rollers
        beside = values["rho0"] - values["H"] / 2 - values["radius"]
        gathered.group([(beside / task.hardware.spring.H, 0.0, np.inf)])
    return values, shares


_SMOOTH = 1e-3  # |rho'| is sqrt(rho'^2 + (_SMOOTH rho)^2), so that it has derivatives where a guide turns back
_FAST = 1.0  # omega tau below which the work of the gas is summed as work


@record
class Taken:
    """What friction and heat do to one motion."""

    work: ca.SX  #: energy of the gas and work lost, shape (n,) [J]
    torque: Scalar  #: mean of what is lost [N*m]


@record
class Warmth:
    """Gas of the guides at one x."""

    walled: AirThermal  #: the spring of the case with a wall
    x: float = quantity("rad", above=0, about="omega tau")
    ratio: tuple[ca.SX, ...]  #: T / T_w of each guide, shape (n,) [-]


def warmths(
    task: CoDesignTask, samples: Samples, symbols: list[GuideSymbols], given: HingeLosses, gathered: Gathered
) -> list[Warmth | None]:
    """Temperatures at each point; points with the same x share their unknowns. None of a law without heat."""
    known: dict[float, Warmth] = {}
    by_guide: list[Warmth | None]
    by_guide, started = [], shapes(task, samples)
    for point in task.points:
        walled = task.hardware.walled(setting_of(task.hardware.spring), given, point.omega)
        if walled is None:
            by_guide.append(None)
            continue
        x = round(point.omega * walled.tau, 12)
        if x not in known:
            ratio = (_warmth(g, z, task, samples, x, given, gathered) for g, z in zip(symbols, started, strict=True))
            known[x] = Warmth(walled=walled, x=x, ratio=tuple(ratio))
        by_guide.append(known[x])
    return by_guide


def taken(
    task: CoDesignTask, point: Point, samples: Samples, symbols: list[GuideSymbols], pressures: list[ca.SX],
    warm: Warmth | None, given: HingeLosses, gathered: Gathered,
) -> Taken:  # fmt: skip
    """Energy of the gas, work lost and mean loss at one point; pressures at free height [Pa], one for each guide."""
    n, scale = samples.phi.size, 0.02 * abs(point.load_torque) * point.period
    unknown = gathered.unknown("lost", np.zeros(n))
    mean, lost = scale * unknown[0] / point.period, scale * ca.vertcat(0.0, unknown[1:])
    rate, stored = ca.SX(n, 1), ca.SX(n, 1)
    for s, (guide, p0) in enumerate(zip(symbols, pressures, strict=True)):
        z = guide.path.z
        if warm is None:
            spring = task.hardware.charged(p0, **guide.values)
            rate += _friction(task, guide, spring.force(z), point.omega, given)
            stored += spring.symbolic().energy(z)
            continue
        walled, ratio = lettered(warm.walled, {"A": guide.values["A"], "H": guide.values["H"], "p0": p0}), warm.ratio[s]
        force = walled.force(z, ratio)
        rate += _friction(task, guide, force, point.omega, given)
        if warm.x > _FAST:
            stored += walled.energy(z, ratio)
            rate += walled.capacity * (ratio - 1) / warm.x
        else:
            rate -= force * task.hardware.count * task.hardware.shaft_ratio * guide.path.drho
    after = ca.vertcat(rate[1:], rate[0])
    steps = ca.DM(samples.step) * ((rate + after) / 2 - mean)
    gathered.group([((ca.vertcat(lost[1:], lost[0]) - lost - steps) / scale, 0.0, 0.0)])
    return Taken(work=stored + lost, torque=mean)


def _warmth(
    guide: GuideSymbols, z: np.ndarray, task: CoDesignTask, samples: Samples, x: float, given: HingeLosses,
    gathered: Gathered,
) -> ca.SX:  # fmt: skip
    """T / T_w of the gas of a guide; `z` [m] is the closing that the programme starts from, x [rad]."""
    power, step = given.gamma - 1, samples.step / x
    start = 1 - z / task.hardware.spring.H
    s = gathered.unknown("s", gas_temperature(start, samples.step, x, given.gamma, 1.0) * start**power)
    volume = (1 - guide.path.z / guide.values["H"]) ** power
    keep, first, last = (ca.DM(np.array(column)) for column in zip(*(relaxation(float(r)) for r in step), strict=True))
    after = ca.vertcat(volume[1:], volume[0])
    rows = ca.vertcat(s[1:], s[0]) - keep * s - first * volume - last * after
    gathered.group([(rows / ca.DM(np.maximum(step, 1e-3)), 0.0, 0.0)])
    return s / volume


def _friction(task: CoDesignTask, guide: GuideSymbols, force: Scalar, omega: float, given: HingeLosses) -> Scalar:
    """Torque on the crank that bearings, seals and guides take [N*m]; spring force of each roller in [N]."""
    h, path = task.hardware, guide.path
    steep = ca.sqrt(path.drho**2 + (_SMOOTH * path.rho) ** 2)
    at, rollers = (path.rho, path.drho, path.d2rho), lettered(h, guide.values)
    torques = friction_torques(force, at, h.shaft_ratio * omega, rollers, h.count, given, steep)
    return h.shaft_ratio * sum(torques.values())


_SECOND = (0.15, 0.05)  # closing of a second spring at the start and its swing, by the height of its column
_DEEPEST = 0.98  # share of the allowed closing that the start may take


def closing(hardware: Hardware, energy: np.ndarray, p0: float, deepest: float) -> np.ndarray:
    """Closing [m], at most `deepest`, at which a spring of pressure p0 [Pa] stores an energy [J]."""
    z = np.linspace(0, deepest, 4001)
    return np.interp(energy, hardware.charged(p0).energy(z), z)


def middle(samples: Samples) -> int:
    """The point whose wanted work has the middle swing."""
    order = np.argsort(np.ptp(samples.work, axis=1))
    return int(order[(len(order) - 1) // 2])


def start_pressures(task: CoDesignTask, samples: Samples) -> list[np.ndarray]:
    """Excess pressures for each spring and point [Pa]: in proportion to the swing of the work."""
    swing = np.ptp(samples.work, axis=1)
    p0 = setting_of(task.hardware.spring) * swing / swing[middle(samples)]
    return [p0 if s == 0 else p0 / 4 for s in range(task.springs)]


def shapes(task: CoDesignTask, samples: Samples) -> list[np.ndarray]:
    """Closing of each spring over the angles [m]."""
    hardware, work = task.hardware, samples.work[middle(samples)]
    spring = hardware.spring
    deepest = _DEEPEST * task.bounds.closing_share * spring.H
    first = closing(hardware, float(spring.energy(hardware.z_margin)) + work.max() - work, setting_of(spring), deepest)
    mean, swing = _SECOND
    turn = 2 * np.pi / (samples.phi[-1] + samples.step[-1])
    others = [spring.H * (mean + swing * np.cos((s + 1) * turn * samples.phi)) for s in range(task.springs - 1)]
    return [first, *others]

r"""The co-designed machine as built: its torque and inertia over the angle, and a run in time.

.. math:: I_t \ddot\varphi + \tfrac12 I_t' \dot\varphi^2 = Q(\varphi) - \sum F(z) z' - M_\mathrm{load}(\dot\varphi),
          \qquad I_t = I + J + I_h

Q is the torque of gas and gravity as computed, never what the programme was fitted to. `steady` solves for the energy
over the angle by collocation (mechsym.simulate); `run` integrates this equation over time by a Runge-Kutta method of
order eight. They share the functions of the machine and no method.

The equation of a co-designed machine over time, one text: run in compiled C, by scipy where there is no compiler. What
depends on the angle alone (torque of the engine, its inertia, closing of each spring) are tables of polynomials; what a
machine has one of (pressures, flywheel, load) are held values, so all machines share one compiled file.
"""

import dataclasses
import functools
from collections.abc import Callable, Sequence
from typing import Any

import casadi as ca
import numpy as np
import scipy

from mechsym import periodic
from mechsym.codesign.points import Function, Point
from mechsym.codesign.task import Hardware, Track, path_of, roller_inertia
from mechsym.errors import BadInput
from mechsym.hinge.springs.face import Spring, of_letters
from mechsym.machine.loads import ConstantLoad, PropellerLoad, propeller_torque
from mechsym.native.compiler import NoCompiler
from mechsym.native.integrate import integrate
from mechsym.native.runs import STATUS, Breaks, Level, Runs, Table
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Array, Inertia, Metre, Pure, Radian, Scalar, Second
from mechsym.simulate.angle import Panels, ReducedMachine, tabulate
from mechsym.simulate.speed import Dense, last_period, speeds
from mechsym.simulate.steady import Steady, mean_torque, steady_state

_PER_TURN = 1440  # angles at which a run is read
_LOOKS = 1441  # at the last period, for its extremes
_STALLED = 0.02  # of the mean speed


@record
class Running:
    """A machine at one point, ready to turn."""

    point: Point
    tracks: tuple[Track, ...]
    pressures: tuple[float, ...]  #: excess pressure of each spring at free height [Pa]
    flywheel: float = quantity("kg*m^2", about="inertia added to the engine's own")
    load: ConstantLoad | PropellerLoad
    torque: Function  #: gas and gravity over the angle [N*m]
    kinks: tuple[float, ...]  #: of that torque [rad]
    extra: PPoly | None = None  #: torque of friction, and of a gas with heat beside the polytrope [N*m]


@record
class TimeRun:
    """A run in time."""

    t: np.ndarray  #: [s]
    phi: np.ndarray  #: [rad]
    omega: np.ndarray  #: [rad/s]
    stalled: bool
    energy_residual: float = quantity("-", about="(work in - load - change of energy) / work of the load")
    #: Angle and speed, shape (1, n) each, at any ascending times within the run; None for several behind each other
    dense: Dense | None = dataclasses.field(default=None, repr=False, compare=False)


def running(
    point: Point, tracks: Sequence[Track], k: int, flywheel: float, errors: Sequence[float] | None = None
) -> Running:
    """A point of a co-design with its load law; `errors` [-] are shares that each pressure is off."""
    law: ConstantLoad | PropellerLoad = (
        PropellerLoad(torque=point.load_torque, speed=point.omega)
        if point.law == "propeller"
        else ConstantLoad(torque=point.load_torque)
    )
    factors = errors or [0.0] * len(tracks)
    return Running(
        point=point, tracks=tuple(tracks), flywheel=flywheel, load=law, torque=point.torque,
        kinks=point.kinks,
        pressures=tuple(float(t.p0[k]) * (1 + e) for t, e in zip(tracks, factors, strict=True)),
    )  # fmt: skip


def spring_torque(track: Track, p0: float, phi: Scalar) -> np.ndarray:
    """Torque of one guide on the shaft, positive driving [N*m], at phi [rad] with pressure p0 [Pa]."""
    return -track.hardware.charged(p0).force(track.z(phi)) * track.z.derivative()(phi)


def spring_energy(track: Track, p0: float, phi: Scalar) -> np.ndarray:
    """Energy in one spring [J] at phi [rad] with pressure p0 [Pa]."""
    return np.asarray(track.hardware.charged(p0).energy(track.z(phi)))


def added_inertia(track: Track, phi: Scalar) -> np.ndarray:
    """Inertia of the rollers of one guide about the shaft [kg*m^2] at phi [rad]."""
    return inertia_of(track.hardware, track.z(phi), track.z.derivative()(phi))


def inertia_of(h: Hardware, z: Metre[Scalar], dz: Scalar) -> Inertia[Array]:
    """The same of a spring that is closed by z, with its slope over the crank angle [m/rad]."""
    path = path_of(h, h.rho0, z, dz, 0 * dz)
    return h.shaft_ratio**2 * roller_inertia(path.rho, path.drho, h.moving_mass, h.roller_inertia, h.radius, h.count)


def inertia(machine: Running, phi: Scalar) -> np.ndarray:
    """All inertia that turns [kg*m^2] at phi [rad]."""
    return machine.point.inertia(phi) + machine.flywheel + sum(added_inertia(t, phi) for t in machine.tracks)


def torque(machine: Running, phi: Scalar) -> np.ndarray:
    """Torque of gas, gravity and springs on the shaft [N*m] at phi [rad]."""
    springs = zip(machine.tracks, machine.pressures, strict=True)
    extra = 0.0 if machine.extra is None else machine.extra(phi)
    return machine.torque(phi) + extra + sum(spring_torque(track, p0, phi) for track, p0 in springs)


def panels(machine: Running) -> Panels:
    """The machine over the angle, for `mechsym.simulate`."""
    point = machine.point
    knots = {float(x) for t in machine.tracks for x in t.z.x[:-1] % point.period}
    table = tabulate(
        ReducedMachine(
            inertia=lambda phi: inertia(machine, phi), torque=lambda phi: torque(machine, phi), load=machine.load,
            period=point.period, kinks=tuple(sorted({*machine.kinks, *knots})),
        )
    )  # fmt: skip
    if isinstance(machine.load, ConstantLoad):
        # a governor holds the mean: the load is what these panels integrate
        return dataclasses.replace(table, load=ConstantLoad(torque=mean_torque(table)))
    return table


def steady(machine: Running) -> Steady:
    """The periodic motion of the machine."""
    return steady_state(panels(machine), machine.point.omega)


def run(machine: Running, speed: float, turns: Pure, phi_start: float = 0.0, stall: Pure = _STALLED) -> TimeRun:
    """Run the machine in time from a speed [rad/s] and an angle [rad] for some turns; it may stall.

    turns: turns of the crank; stall: share of the point's speed below which the run ends.
    """
    turning = Turning(
        rates=equation(tuple(type(t.hardware.spring) for t in machine.tracks)), tables=tables_of(machine),
        held=_held(machine), kinks=bends(machine), period=machine.point.period,
        start=(phi_start, speed, 0.0, 0.0), turned=phi_start + 2 * np.pi * turns, stalled=stall * machine.point.omega,
        longest=20 * turns * 2 * np.pi / speed,
    )  # fmt: skip
    t_end, states, stalled = turn(turning)
    t = np.linspace(0, t_end, int(_PER_TURN * turns) + 1)
    phi, omega, gained, taken = states(t)
    ends = np.array([phi[0], phi[-1]])
    stored = sum(
        np.diff(spring_energy(t_, p0, ends))[0] for t_, p0 in zip(machine.tracks, machine.pressures, strict=True)
    )
    kinetic = inertia(machine, ends) * np.array([omega[0], omega[-1]]) ** 2 / 2
    turned_over = abs(taken[-1]) or abs(gained[-1]) or 1e-30
    residual = float((gained[-1] - taken[-1] - np.diff(kinetic)[0] - stored) / turned_over)
    return TimeRun(
        t=t, phi=phi, omega=omega, stalled=stalled, energy_residual=residual,
        dense=lambda times: (states(times)[:1], states(times)[1:2]),
    )  # fmt: skip


def joined(legs: Sequence[TimeRun]) -> TimeRun:
    """Runs one behind the other as one."""
    times = np.cumsum([0.0, *(leg.t[-1] for leg in legs[:-1])])
    turned = np.cumsum([0.0, *(leg.phi[-1] - leg.phi[0] for leg in legs[:-1])])
    return TimeRun(
        t=np.concatenate([leg.t + t for leg, t in zip(legs, times, strict=True)]),
        phi=np.concatenate([leg.phi + a for leg, a in zip(legs, turned, strict=True)]),
        omega=np.concatenate([leg.omega for leg in legs]),
        stalled=legs[-1].stalled,
        energy_residual=max((leg.energy_residual for leg in legs), key=abs),
    )


def extremes(motion: TimeRun) -> tuple[float, float]:
    """Least and greatest speed [rad/s] of a whole run; of several behind each other those that were read."""
    if motion.dense is None:
        return float(motion.omega.min()), float(motion.omega.max())
    (speed,) = speeds(motion.dense, motion.t)
    return speed.min, speed.max


def ripple_of_last_turn(motion: TimeRun, period: float) -> float | None:
    """Ripple of the speed over the last period [rad], see `mechsym.simulate.speed`; None after a stall."""
    if motion.stalled or motion.dense is None:
        return None
    (speed,) = speeds(
        motion.dense, np.linspace(last_period(motion.t, motion.phi, motion.omega, period), motion.t[-1], _LOOKS)
    )
    return speed.ripple


# the legs of a run share it
@functools.lru_cache(maxsize=8)
def fitted(torque: Function, kinks: tuple[float, ...], period: Radian) -> PPoly:
    """Torque over the angle, or several at once, as polynomials [N*m]; what consists of them already stays as it is."""
    return torque if isinstance(torque, PPoly) else periodic.fit(torque, kinks, period, _TOLERANCE)


def bends(machine: Running) -> Radian[Array]:
    """Where it is not smooth in a period; what is nearer than rounding is one."""
    angles = np.concatenate([machine.kinks, *(t.z.x for t in machine.tracks)]) % machine.point.period
    return np.unique(np.round(angles, 12))


def tables_of(machine: Running) -> tuple[PPoly, ...]:
    """Over the angle: torque of the engine, extra torque, inertia, its slope, of each track z, z', z''."""
    point = machine.point
    driving = fitted(machine.torque, machine.kinks, point.period)
    extra = PPoly([[0.0]], [0.0, point.period]) if machine.extra is None else machine.extra
    closings = (p for t in machine.tracks for p in (t.z, t.z.derivative(), t.z.derivative(2)))
    return driving, extra, point.inertia, point.inertia.derivative(), *closings


def _held(machine: Running) -> tuple[float, ...]:
    load = machine.load
    if isinstance(load, PropellerLoad):
        laws = (0.0, float(load.torque or 0.0), float(load.speed or 1.0))
    else:
        laws = (float(load.torque or 0.0), 0.0, 1.0)
    guides = (of_track(t.hardware, p0) for t, p0 in zip(machine.tracks, machine.pressures, strict=True))
    return (machine.flywheel, *laws, *(value for guide in guides for value in guide))


_TOLERANCE = 1e-10
_OF_GUIDE = ("rho0", "moving_mass", "roller_inertia", "radius", "count", "shaft_ratio")
_MET = 1  # index into STATUS
_KEPT = 2000  # steps that a run is thought to take at most


@record
class Turning:
    """A machine as its equation takes it, until it has turned so far or is too slow."""

    rates: ca.Function  #: (t, states, tables and held values) -> rates of the states, angle and speed first
    tables: tuple[PPoly, ...]  #: polynomials over the angle, by the rates
    held: tuple[float, ...] = ()  #: see `equation` [SI]
    kinks: np.ndarray  #: where a table is not smooth [rad]
    period: float  #: [rad]
    start: tuple[float, ...]  #: angle [rad], speed [rad/s] and the other states [SI]
    turned: float  #: Angle at which it ends [rad]
    stalled: float  #: Speed at which it ends [rad/s]
    longest: float  #: [s]


def of_track(hardware: Hardware, p0: float) -> tuple[float, ...]:
    """Held values of one guide at a pressure [Pa]."""
    spring = hardware.charged(p0)
    return (*(float(getattr(spring, name)) for name in _numbers(type(spring))),
            *(float(getattr(hardware, name)) for name in _OF_GUIDE))  # fmt: skip


def _numbers(law: type[Spring]) -> tuple[str, ...]:
    return tuple(field.name for field in dataclasses.fields(law))


@functools.lru_cache(maxsize=4)
def equation(laws: tuple[type[Spring], ...]) -> ca.Function:
    r"""Rates of angle, speed, work of the engine and work of the load, of guides whose springs have some laws.

    .. math:: I_t \ddot\varphi + \tfrac12 I_t' \dot\varphi^2 = Q(\varphi) - \sum F(z) z' - M_\mathrm{load}(\dot\varphi)

    Returns
    -------
    function : casadi.Function
        (t, y, p) -> dy/dt; p has the values of the tables, then flywheel [kg*m^2], constant torque [N*m], torque and
        speed of a propeller [N*m, rad/s], and `of_track` of each guide
    """
    tracks, sizes = len(laws), [len(_numbers(law)) + len(_OF_GUIDE) for law in laws]
    y, p = ca.SX.sym("y", 4), ca.SX.sym("p", 8 + 3 * tracks + sum(sizes))
    driving, extra, inertia, slope, *rest = ca.vertsplit(p)
    driving = driving + extra
    closings, (flywheel, steady, *propeller), guides = (
        rest[: 3 * tracks], rest[3 * tracks : 3 * tracks + 4], rest[3 * tracks + 4 :]
    )  # fmt: skip
    omega, total, push = y[1], inertia + flywheel, 0.0
    for law, z, dz, d2z in zip(laws, *(closings[i::3] for i in range(3)), strict=True):
        names = (*_numbers(law), *_OF_GUIDE)
        h: dict[str, Scalar] = dict(zip(names, guides, strict=False))
        guides = guides[len(names) :]
        added = h["shaft_ratio"] ** 2 * roller_inertia(
            h["rho0"] - z / h["count"], dz / (h["count"] * h["shaft_ratio"]), h["moving_mass"], h["roller_inertia"],
            h["radius"], h["count"],
        )  # fmt: skip
        total, slope = total + added, slope + ca.jtimes(added, ca.vertcat(z, dz), ca.vertcat(dz, d2z))
        push -= of_letters(law, h).force(z) * dz
    taken = steady + propeller_torque(omega, *propeller)
    rate = (driving + push - taken - slope * omega**2 / 2) / total
    rates = ca.vertcat(omega, rate, driving * omega, taken * omega)
    return ca.Function("turning", [ca.SX.sym("t"), y, p], [rates])


def turn(machine: Turning) -> tuple[Second, Callable[[np.ndarray], np.ndarray], bool]:
    """Run it to its end.

    Returns t, states, stalled: when it ended [s]; ascending times (n,) [s] to its states, shape (states, n); whether it
    became too slow. Raises BadInput: a step fails.
    """
    try:
        runs = _runs(machine)
        outcome = integrate(runs, "dop853")
        if outcome.steps[0] > runs.keep:  # more than was thought: now they are counted
            outcome = integrate(dataclasses.replace(runs, keep=int(outcome.steps[0])), "dop853")
        if outcome.status[0] > _MET:
            raise BadInput(f"the machine in time {STATUS[outcome.status[0]]}")
        return float(outcome.t[0]), outcome.last[0].at, bool(outcome.met[0] != 0)
    except NoCompiler:
        return _by_scipy(machine)


def _runs(machine: Turning) -> Runs:
    return Runs(
        rhs=machine.rates, start=np.array(machine.start), until=np.array([machine.longest]),
        held=np.array([[*(0.0 for _ in machine.tables), *machine.held]]),
        tables=tuple(Table(held=i, state=0, polynomials=((p.x, p.c),)) for i, p in enumerate(machine.tables)),
        surfaces=(
            Level(state=0, level=machine.turned, direction=1), Level(state=1, level=machine.stalled, direction=-1)
        ),
        kinks=(Breaks(state=0, angles=machine.kinks, period=machine.period),), rtol=_TOLERANCE, atol=_TOLERANCE,
        keep=_KEPT, kept_states=len(machine.start),
    )  # fmt: skip


def _by_scipy(machine: Turning) -> tuple[Second, Callable[[np.ndarray], np.ndarray], bool]:
    tables = [periodic.scalar(p) for p in machine.tables]
    buffer: Any
    buffer, call = machine.rates.buffer()
    n, p = len(machine.start), np.array([*(0.0 for _ in tables), *machine.held])
    state, rates = np.zeros(n), np.zeros(n)
    for i, given in enumerate((np.zeros(1), state, p)):
        buffer.set_arg(i, given.data)
    buffer.set_res(0, rates.data)

    # the default argument keeps the buffer alive as long as the function
    def rate(t: float, y: np.ndarray, _alive: object = buffer) -> np.ndarray:
        phi = float(y[0])
        state[:], p[: len(tables)] = y, [of(phi)[0] for of in tables]
        call()
        return rates.copy()

    ends = [_end(lambda y: y[0] - machine.turned, 1.0), _end(lambda y: y[1] - machine.stalled, -1.0)]
    solution = scipy.integrate.solve_ivp(
        rate, (0.0, machine.longest), machine.start, method="DOP853", rtol=_TOLERANCE, atol=_TOLERANCE,
        events=ends, dense_output=True, max_step=machine.period / machine.start[1] / 90,
    )  # fmt: skip
    return float(solution.t[-1]), solution.sol, not len(solution.t_events[0])


def _end(value: Callable[[Scalar], float], direction: float) -> Any:
    def event(t: float, y: Scalar) -> float:
        return value(y)

    event.terminal, event.direction = True, direction  # type: ignore[attr-defined]
    return event

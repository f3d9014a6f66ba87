"""The equation of a co-designed machine over time, one text: run in compiled C, by scipy where there is no compiler.

What depends on the angle alone (torque of the engine, its inertia, closing of each spring) are tables of polynomials;
what a machine has one of (pressures, flywheel, load) are held values, so all machines share one compiled file.
"""

import dataclasses
import functools
from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np
import scipy

from mechsym import periodic
from mechsym.codesign.hardware import Hardware, roller_inertia
from mechsym.errors import BadInput
from mechsym.hinge.springs.face import Spring, of_letters
from mechsym.machine.loads import propeller_torque
from mechsym.native.compiler import NoCompiler
from mechsym.native.integrate import integrate
from mechsym.native.runs import STATUS, Breaks, Level, Runs, Table
from mechsym.quantities import record
from mechsym.quantities.units import Scalar

_TOLERANCE = 1e-10
_OF_GUIDE = ("rho0", "moving_mass", "roller_inertia", "radius", "count", "shaft_ratio")
_MET = 1  # index into STATUS
_BEYOND = 1.0  # angle that a motion may go on behind its end [rad]


@record
class Turning:
    """A machine as its equation takes it, until it has turned so far or is too slow."""

    laws: tuple[type[Spring], ...]  #: of the spring of each track
    #: polynomials over the angle: torque of the engine, extra torque, inertia, its slope, of each track z, z', z''
    tables: tuple["scipy.interpolate.PPoly", ...]
    held: tuple[float, ...]  #: see `equation` [SI]
    kinks: np.ndarray  #: where a table is not smooth [rad]
    period: float  #: [rad]
    start: tuple[float, float]  #: angle [rad] and speed [rad/s]
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


def turn(machine: Turning, readings: int) -> tuple[np.ndarray, np.ndarray, bool]:
    """Run it to its end, and say whether it became too slow.

    Returns t: even times from the start to the end [s], shape (readings,); y: angle [rad], speed [rad/s], work of the
    engine and work of the load [J], shape (4, readings).
    """
    try:
        return _compiled(machine, readings)
    except NoCompiler:
        return _by_scipy(machine, readings)


def at_times(machine: Turning, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Angle [rad] and speed [rad/s], shape (1, n) each, at ascending times [s] from its start on, up to its end."""
    # the last time is when it has turned far enough, to rounding: that must not end it before
    machine = dataclasses.replace(machine, turned=machine.turned + _BEYOND)
    runs = _runs(machine)
    try:
        found = integrate(
            dataclasses.replace(runs, until=times[-1:], times=times[(times > 0) & (times < times[-1])]), "dop853"
        )
        states = np.vstack([*([runs.start] if times[0] <= 0 else []), found.samples[0], found.y])
        states = states[np.isfinite(states[:, 1])]
    except NoCompiler:
        states = _solved(machine).sol(times).T
    return states[:, 0][None], states[:, 1][None]


def _runs(machine: Turning) -> Runs:
    return Runs(
        rhs=equation(machine.laws), start=np.array([*machine.start, 0.0, 0.0]),
        until=np.array([machine.longest]),
        held=np.array([[*(0.0 for _ in machine.tables), *machine.held]]),
        tables=tuple(Table(held=i, state=0, polynomials=((p.x, p.c),)) for i, p in enumerate(machine.tables)),
        surfaces=(
            Level(state=0, level=machine.turned, direction=1), Level(state=1, level=machine.stalled, direction=-1)
        ),
        kinks=(Breaks(state=0, angles=machine.kinks, period=machine.period),), rtol=_TOLERANCE, atol=_TOLERANCE,
    )  # fmt: skip


def _compiled(machine: Turning, readings: int) -> tuple[np.ndarray, np.ndarray, bool]:
    runs = _runs(machine)
    # once to see how long it takes, and once to be read at even times
    t = np.linspace(0, integrate(runs, "dop853").t[0], readings)
    found = integrate(dataclasses.replace(runs, times=t[1:-1]), "dop853")
    if found.status[0] > _MET:
        raise BadInput(f"the machine in time {STATUS[found.status[0]]}")
    return t, np.vstack([runs.start, found.samples[0], found.y[0]]).T, bool(found.met[0] == 1)


def _by_scipy(machine: Turning, readings: int) -> tuple[np.ndarray, np.ndarray, bool]:
    found = _solved(machine)
    t = np.linspace(0, found.t[-1], readings)
    return t, found.sol(t), bool(len(found.t_events[1]))


def _solved(machine: Turning) -> Any:
    tables = [periodic.scalar(p) for p in machine.tables]
    buffer: Any
    buffer, call = equation(machine.laws).buffer()
    state, p, rates = np.zeros(4), np.array([*(0.0 for _ in tables), *machine.held]), np.zeros(4)
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
    return scipy.integrate.solve_ivp(
        rate, (0.0, machine.longest), [*machine.start, 0.0, 0.0], method="DOP853", rtol=_TOLERANCE, atol=_TOLERANCE,
        events=ends, dense_output=True, max_step=machine.period / machine.start[1] / 90,
    )  # fmt: skip


def _end(value: Callable[[Scalar], float], direction: float) -> Any:
    def event(t: float, y: Scalar) -> float:
        return value(y)

    event.terminal, event.direction = True, direction  # type: ignore[attr-defined]
    return event

"""The equation of a co-designed machine over time, one text: run in compiled C, by scipy where there is no compiler.

What depends on the angle alone (torque of the engine, its inertia, closing of each spring) are tables of polynomials;
what a machine has one of (pressures, flywheel, load) are held values, so all machines share one compiled file.
"""

import dataclasses
import functools
from collections.abc import Callable, Sequence
from typing import Any

import casadi as ca
import numpy as np
import scipy

from mechsym import periodic
from mechsym.codesign.hardware import Hardware, gas_pressure, outside, roller_inertia
from mechsym.errors import BadInput
from mechsym.machine.loads import propeller_torque
from mechsym.native.compiler import NoCompiler
from mechsym.native.integrate import integrate
from mechsym.native.runs import STATUS, Breaks, Level, Runs, Table
from mechsym.quantities import record

_TOLERANCE = 1e-10
_OF_TRACK = ("A", "H", "n", "rho0", "moving_mass", "roller_inertia", "radius", "count", "shaft_ratio")
_MET = 1  # index into STATUS


@record
class Turning:
    """A machine as its equation takes it, until it has turned so far or is too slow."""

    #: polynomials over the angle: torque of the engine, extra torque, inertia, its slope, of each track z, z', z''
    tables: tuple[Any, ...]
    held: tuple[float, ...]  #: see `equation` [SI]
    kinks: np.ndarray  #: where a table is not smooth [rad]
    period: float  #: [rad]
    start: tuple[float, float]  #: angle [rad] and speed [rad/s]
    turned: float  #: Angle at which it ends [rad]
    stalled: float  #: Speed at which it ends [rad/s]
    longest: float  #: [s]


def of_track(hardware: Hardware, p0: float) -> tuple[float, ...]:
    """Held values of one guide at a pressure [Pa]."""
    return (p0, outside(hardware), *(float(getattr(hardware, name)) for name in _OF_TRACK))


@functools.lru_cache(maxsize=4)
def equation(tracks: int) -> ca.Function:
    r"""Rates of angle, speed, work of the engine and work of the load, of a machine with so many guides.

    .. math:: I_t \ddot\varphi + \tfrac12 I_t' \dot\varphi^2 = Q(\varphi) - \sum F(z) z' - M_\mathrm{load}(\dot\varphi)

    Returns
    -------
    function : casadi.Function
        (t, y, p) -> dy/dt; p has the values of the tables, then flywheel [kg*m^2], constant torque [N*m], torque and
        speed of a propeller [N*m, rad/s], and `of_track` of each guide
    """
    y, p = ca.SX.sym("y", 4), ca.SX.sym("p", 8 + tracks * (5 + len(_OF_TRACK)))
    driving, extra, inertia, slope, *rest = ca.vertsplit(p)
    driving = driving + extra
    closings, (flywheel, steady, *propeller), guides = (
        rest[: 3 * tracks], rest[3 * tracks : 3 * tracks + 4], rest[3 * tracks + 4 :]
    )  # fmt: skip
    omega, total, push = y[1], inertia + flywheel, 0.0
    for z, dz, d2z, (p0, pa, *own) in zip(*(closings[i::3] for i in range(3)), _guides(guides, tracks), strict=True):
        h = dict(zip(_OF_TRACK, own, strict=True))
        added = h["shaft_ratio"] ** 2 * roller_inertia(
            h["rho0"] - z / h["count"], dz / (h["count"] * h["shaft_ratio"]), h["moving_mass"], h["roller_inertia"],
            h["radius"], h["count"],
        )  # fmt: skip
        total, slope = total + added, slope + ca.jtimes(added, ca.vertcat(z, dz), ca.vertcat(dz, d2z))
        push -= h["A"] * gas_pressure(z, p0, h["H"], h["n"], pa) * dz
    taken = steady + propeller_torque(omega, *propeller)
    rate = (driving + push - taken - slope * omega**2 / 2) / total
    rates = ca.vertcat(omega, rate, driving * omega, taken * omega)
    return ca.Function("turning", [ca.SX.sym("t"), y, p], [rates])


def _guides(values: Sequence[Any], tracks: int) -> list[Sequence[Any]]:
    each = 2 + len(_OF_TRACK)
    return [values[i * each : (i + 1) * each] for i in range(tracks)]


def turn(machine: Turning, readings: int) -> tuple[np.ndarray, np.ndarray, bool]:
    """Run it to its end, and say whether it became too slow.

    Returns
    -------
    t : ndarray, shape (readings,)
        Even times from the start to the end [s]
    y : ndarray, shape (4, readings)
        Angle [rad], speed [rad/s], work of the engine and work of the load [J]
    """
    try:
        return _compiled(machine, readings)
    except NoCompiler:
        return _by_scipy(machine, readings)


def _compiled(machine: Turning, readings: int) -> tuple[np.ndarray, np.ndarray, bool]:
    start = np.array([*machine.start, 0.0, 0.0])
    runs = Runs(
        rhs=equation((len(machine.tables) - 4) // 3), start=start, until=np.array([machine.longest]),
        held=np.array([[*(0.0 for _ in machine.tables), *machine.held]]),
        tables=tuple(Table(held=i, state=0, polynomials=((p.x, p.c),)) for i, p in enumerate(machine.tables)),
        surfaces=(
            Level(state=0, level=machine.turned, direction=1), Level(state=1, level=machine.stalled, direction=-1)
        ),
        kinks=(Breaks(state=0, angles=machine.kinks, period=machine.period),), rtol=_TOLERANCE, atol=_TOLERANCE,
    )  # fmt: skip
    # once to see how long it takes, and once to be read at even times
    t = np.linspace(0, integrate(runs, "dop853").t[0], readings)
    found = integrate(dataclasses.replace(runs, times=t[1:-1]), "dop853")
    if found.status[0] > _MET:
        raise BadInput(f"the machine in time {STATUS[found.status[0]]}")
    return t, np.vstack([start, found.samples[0], found.y[0]]).T, bool(found.met[0] == 1)


def _by_scipy(machine: Turning, readings: int) -> tuple[np.ndarray, np.ndarray, bool]:
    tables = [periodic.scalar(p) for p in machine.tables]
    buffer: Any
    buffer, call = equation((len(tables) - 4) // 3).buffer()
    state, p, rates = np.zeros(4), np.array([*(0.0 for _ in tables), *machine.held]), np.zeros(4)
    for i, given in enumerate((np.zeros(1), state, p)):
        buffer.set_arg(i, given.data)
    buffer.set_res(0, rates.data)

    # the default argument keeps the buffer alive as long as the function
    def rate(t: float, y: np.ndarray, _alive: Any = buffer) -> np.ndarray:
        phi = float(y[0])
        state[:], p[: len(tables)] = y, [of(phi)[0] for of in tables]
        call()
        return rates.copy()

    ends = [_end(lambda y: y[0] - machine.turned, 1.0), _end(lambda y: y[1] - machine.stalled, -1.0)]
    found = scipy.integrate.solve_ivp(
        rate, (0.0, machine.longest), [*machine.start, 0.0, 0.0], method="DOP853", rtol=_TOLERANCE, atol=_TOLERANCE,
        events=ends, dense_output=True, max_step=machine.period / machine.start[1] / 90,
    )  # fmt: skip
    t = np.linspace(0, found.t[-1], readings)
    return t, found.sol(t), bool(len(found.t_events[1]))


def _end(value: Callable[[Any], float], direction: float) -> Any:
    def event(t: float, y: Any) -> float:
        return value(y)

    event.terminal, event.direction = True, direction  # type: ignore[attr-defined]
    return event

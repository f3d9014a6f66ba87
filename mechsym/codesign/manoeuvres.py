r"""Standing still, starting, turning the other way, and a governor that answers a jump of the load.

.. math:: V(\varphi) = \sum U(z(\varphi)) - \int Q_0\, d\varphi, \qquad
          M_0 = \max_{\varphi > \varphi_0} \frac{V(\varphi) - V(\varphi_0)}{\varphi - \varphi_0}

V is the energy that the shaft meets when it is turned slowly: springs under pressure and the gas of a turn without
fuel, Q_0, with the weights. The shaft comes to rest in a minimum phi_0 of V; a constant torque turns it from there for
good when it is larger than M_0. Friction is not in it.

A controller that holds the pressures of the springs, from nothing but the speed over one turn.

.. math:: w_m = -\tfrac12 I_t (\dot\varphi^2 - \overline{\dot\varphi^2})
          - \int (M_\mathrm{load}(\dot\varphi) - \overline M)\,d\varphi, \qquad
          w_m - w_\mathrm{design} \approx \sum_j \Delta p_j\,\partial U_j/\partial p_j + c_0 + c_1 \varphi

The work that is missing in the turn less the work that is missing by design is what an error of pressure leaves; a
regression gives the error. Without w_design the controller would chase the shape that no pressure can give.
"""

import dataclasses

import numpy as np
import scipy

from mechsym.codesign import running
from mechsym.codesign.loss import machine_at
from mechsym.codesign.running import Running, TimeRun, spring_energy
from mechsym.codesign.task import CoDesign, Track
from mechsym.hinge.springs.face import affine_energy
from mechsym.machine.loads import load_torque
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Pure, RadPerSecond

_ANGLES = 1440  # of a period
_PROPORTIONAL, _INTEGRAL = 0.6, 0.2  # of the fuel that one turn would need to mend the error
_FUEL = (0.0, 1.15)  # the gas torque that a governor can set, by that of the point [-]


@record
class Standstill:
    """Where the shaft rests with its springs under pressure, and what turns it from there."""

    angles: tuple[float, ...]  #: of rest [rad]
    torque: float = quantity("N*m", about="constant torque that turns the shaft from its deepest rest for good")
    vented: float = quantity("N*m", about="the same with springs without pressure")


def standstill(machine: Running) -> Standstill:
    """Angles of rest and starting torque of a machine, without friction; the cylinder holds its gas."""
    deep, angles = _rest(machine)
    empty = dataclasses.replace(machine, pressures=tuple(0.0 for _ in machine.pressures))
    return Standstill(
        angles=angles, torque=_turning_torque(machine, deep), vented=_turning_torque(empty, _rest(empty)[0])
    )


def rest_from(machine: Running, angle: float) -> float:
    """Angle of rest [rad] that a shaft falls into which stands at an angle [rad], friction taking its swing away."""
    phi, V = _energy(machine)
    V, i = V[:-1], int(round(angle / phi[1])) % (len(phi) - 1)
    for _ in range(V.size):
        around = [(i + step) % V.size for step in (-1, 0, 1)]
        lowest = around[int(np.argmin(V[around]))]
        if lowest == i:
            break
        i = lowest
    return float(phi[i])


def start(machine: Running, share: Pure, turns: Pure = 2.0) -> TimeRun:
    """Run from the deepest rest under a constant torque and no load.

    share: torque by that of `standstill`; the shaft stops where it is below 1. turns: turns of the crank.
    """
    pushed = share * standstill(machine).torque
    unfired = machine.point.misfire or _nothing
    alone = dataclasses.replace(
        machine, torque=lambda phi: unfired(phi) + pushed, kinks=machine.point.misfire_kinks, extra=None,
        load=dataclasses.replace(machine.load, torque=0.0),
    )  # fmt: skip
    return running.run(alone, 1e-3 * machine.point.omega, turns, _rest(machine)[0], stall=0.0)


def astern(machine: Running) -> Running:
    """The machine turning the other way on the same guides, fired as ahead; the engine is its own mirror image."""
    tracks = tuple(mirrored(t, machine.point.period) for t in machine.tracks)
    return dataclasses.replace(machine, tracks=tracks, extra=None)


def mirrored(track: Track, period: float) -> Track:
    """A guide as a shaft meets it that turns the other way; `period` in [rad]."""
    z = track.z
    back = scipy.interpolate.BPoly.from_power_basis(scipy.interpolate.PPoly(z.c, z.x)).c[::-1, ::-1]
    turned = scipy.interpolate.PPoly.from_bernstein_basis(scipy.interpolate.BPoly(back, period - z.x[::-1]))
    return dataclasses.replace(track, z=PPoly(turned.c, turned.x, extrapolate="periodic"))


def governed(machine: Running, speed: RadPerSecond, turns: int) -> TimeRun:
    """Run with a governor that sets the fuel of each turn by the mean speed of the turns before.

    speed: at the start, at dead centre; turns: periods of the torque to run.
    """
    point, fuel, total, legs = machine.point, 1.0, 0.0, []
    kinks = tuple(sorted({*machine.kinks, *point.misfire_kinks}))
    unfired = point.misfire or _nothing
    both = running.fitted(lambda phi: np.stack([machine.torque(phi), unfired(phi)]), kinks, point.period)
    inertia = float(np.mean(running.inertia(machine, np.linspace(0, point.period, 181))))
    # fuel, by that of the point, that one period needs to mend a whole speed
    one_turn = inertia * point.omega**2 / (abs(point.load_torque) * point.period)
    for _ in range(turns):
        torque = PPoly(both.c @ [fuel, 1 - fuel], both.x, "periodic")
        fuelled = dataclasses.replace(machine, torque=torque, kinks=kinks)
        legs.append(running.run(fuelled, speed, point.period / (2 * np.pi)))
        speed = float(legs[-1].omega[-1])
        if legs[-1].stalled:
            break
        error = 1 - point.period / legs[-1].t[-1] / point.omega
        total += error
        fuel = float(np.clip(1 + one_turn * (_PROPORTIONAL * error + _INTEGRAL * total), *_FUEL))
    return running.joined(legs)


def _energy(machine: Running) -> tuple[np.ndarray, np.ndarray]:
    """Angles of a period [rad] and the energy V there [J]."""
    phi = np.linspace(0, machine.point.period, _ANGLES + 1)
    gas = (machine.point.misfire or _nothing)(phi)
    given = np.concatenate([[0.0], np.cumsum((gas[1:] + gas[:-1]) / 2 * np.diff(phi))])
    stored = sum(running.spring_energy(t, p, phi) for t, p in zip(machine.tracks, machine.pressures, strict=True))
    return phi, stored - given


def _rest(machine: Running) -> tuple[float, tuple[float, ...]]:
    """The deepest angle of rest, and all of them [rad]."""
    phi, V = _energy(machine)
    # the gas of an unfired turn gives and takes the same but for its losses, so V closes but for a slope
    V = (V - (V[-1] - V[0]) * phi / phi[-1])[:-1]
    low = np.flatnonzero((V <= np.roll(V, 1)) & (V < np.roll(V, -1)))
    return float(phi[np.argmin(V)]), tuple(float(phi[i]) for i in low)


def _turning_torque(machine: Running, rest: float) -> float:
    phi, V = _energy(machine)
    count, first = len(phi) - 1, int(np.argmin(np.abs(phi[:-1] - rest)))
    turned = phi[1] * np.arange(1, 2 * count + 1)
    steps = np.tile(np.diff(V), 3)[first : first + 2 * count]
    return max(0.0, float(np.max(np.cumsum(steps) / turned)))


def _nothing(phi: np.ndarray) -> np.ndarray:
    return np.zeros_like(np.asarray(phi, dtype=float))


@record
class Held:
    """Turns of a machine whose pressures a controller sets after each of them."""

    pressure_error: np.ndarray  #: shape (turns, springs), by the design's pressure, at the start of each turn [-]
    ripple: np.ndarray  #: shape (turns,) of each turn, not a number where the shaft stalled [-]
    gain: float = quantity("-", about="share of the error that is taken away in a turn")
    run: TimeRun  #: all turns


def pressure_error(machine: Running, turn: TimeRun) -> np.ndarray:
    """Error of each pressure that a turn of the speed shows, shape (springs,) [Pa]. machine: as designed."""
    phi, omega = turn.phi, turn.omega
    load = np.asarray(load_torque(machine.load, omega))
    mean = np.trapezoid(load, phi) / np.ptp(phi)
    taken = _integral(load - mean, phi)
    square = np.trapezoid(omega**2, phi) / np.ptp(phi)
    seen = -running.inertia(machine, phi) * (omega**2 - square) / 2 - taken
    columns = [_by_pressure(machine, s, phi) for s in range(len(machine.tracks))]
    matrix = np.column_stack([*columns, np.ones(phi.size), phi - phi[0]])
    scale = np.abs(matrix).max(axis=0)
    shares = np.linalg.lstsq(matrix / scale, seen - _designed(machine, phi), rcond=None)[0] / scale
    return np.asarray(shares[: len(columns)])


def hold(
    solved: CoDesign, k: int, off: float, turns: int = 6, gain: Pure = 1.0, noise: Pure = 0.0, rate: Pure = np.inf
) -> Held:
    """Start a point with its pressures off by a share [-] and let the controller set them after every turn.

    gain: share of the error that is taken away in a turn; noise: one sigma of every measured speed by the mean speed;
    rate: largest change of a pressure in a turn by the design's.
    """
    point, rng = solved.task.points[k], np.random.default_rng(9)
    design = machine_at(solved, k)
    wanted = np.array(design.pressures)
    p, speed, errors, ripples, legs = wanted * (1 + off), point.omega, [], [], []
    for _ in range(turns):
        errors.append(p / wanted - 1)
        leg = running.run(dataclasses.replace(design, pressures=tuple(p)), speed, point.period / (2 * np.pi))
        legs.append(leg)
        speed = float(leg.omega[-1])
        ripple = running.ripple_of_last_turn(leg, point.period)
        ripples.append(np.nan if ripple is None else ripple)
        if leg.stalled:
            break
        noisy = leg.omega * (1 + noise * rng.standard_normal(leg.omega.size))
        change = -gain * pressure_error(design, dataclasses.replace(leg, omega=noisy))
        p = p + np.clip(change, -rate * wanted, rate * wanted)
    return Held(pressure_error=np.array(errors), ripple=np.array(ripples), gain=gain, run=running.joined(legs))


def _by_pressure(machine: Running, s: int, phi: np.ndarray) -> np.ndarray:
    """Energy of a spring for each pascal of its pressure [J/Pa]."""
    track = machine.tracks[s]
    return np.asarray(affine_energy(track.hardware.spring, track.z(phi))[1])


def _designed(machine: Running, phi: np.ndarray) -> np.ndarray:
    """Work that is missing by design [J]."""
    springs = list(zip(machine.tracks, machine.pressures, strict=True))
    w = machine.point.work(phi) + sum(spring_energy(t, p0, phi) for t, p0 in springs)
    rollers = sum(running.added_inertia(t, phi) for t in machine.tracks)
    # of friction and heat, where they are designed for, the wave only: their mean is the regression's slope
    given = 0.0 if machine.extra is None else _integral(machine.extra(phi), phi)
    return np.asarray(w + machine.point.omega**2 / 2 * rollers - given)


def _integral(torque: np.ndarray, phi: np.ndarray) -> np.ndarray:
    """Work of a torque [N*m] from the first angle to each [J]."""
    return np.concatenate([[0.0], np.cumsum((torque[1:] + torque[:-1]) / 2 * np.diff(phi))])

r"""A controller that holds the pressures of the springs, from nothing but the speed over one turn.

.. math:: w_m = -\tfrac12 I_t (\dot\varphi^2 - \overline{\dot\varphi^2})
          - \int (M_\mathrm{load}(\dot\varphi) - \overline M)\,d\varphi, \qquad
          w_m - w_\mathrm{design} \approx \sum_j \Delta p_j\,\partial U_j/\partial p_j + c_0 + c_1 \varphi

The work that is missing in the turn less the work that is missing by design is what an error of pressure leaves; a
regression gives the error. Without w_design the controller would chase the shape that no pressure can give.
"""

import dataclasses

import numpy as np

from mechsym.codesign import running
from mechsym.codesign.loss import machine_at
from mechsym.codesign.running import Running, TimeRun, spring_energy
from mechsym.codesign.task import CoDesign
from mechsym.hinge.springs.face import affine_energy
from mechsym.machine.loads import load_torque
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Pure


@record
class Held:
    """Turns of a machine whose pressures a controller sets after each of them."""

    pressure_error: np.ndarray  #: shape (turns, springs), by the design's pressure, at the start of each turn [-]
    ripple: np.ndarray  #: shape (turns,) of each turn, not a number where the shaft stalled [-]
    gain: float = quantity("-", about="share of the error that is taken away in a turn")
    run: TimeRun  #: all turns


def pressure_error(machine: Running, turn: TimeRun) -> np.ndarray:
    """Error of each pressure that a turn of the speed shows, shape (springs,) [Pa].

    machine: as designed: its pressures are those wanted.
    """
    phi, omega = turn.phi, turn.omega
    load = np.asarray(load_torque(machine.load, omega))
    mean = np.trapezoid(load, phi) / np.ptp(phi)
    taken = _integral(load - mean, phi)
    square = np.trapezoid(omega**2, phi) / np.ptp(phi)
    seen = -running.inertia(machine, phi) * (omega**2 - square) / 2 - taken
    columns = [_by_pressure(machine, s, phi) for s in range(len(machine.tracks))]
    matrix = np.column_stack([*columns, np.ones(phi.size), phi - phi[0]])
    scale = np.abs(matrix).max(axis=0)
    found = np.linalg.lstsq(matrix / scale, seen - _designed(machine, phi), rcond=None)[0] / scale
    return np.asarray(found[: len(columns)])


def hold(
    found: CoDesign, k: int, off: float, turns: int = 6, gain: Pure = 1.0, noise: Pure = 0.0, rate: Pure = np.inf
) -> Held:
    """Start a point with its pressures off by a share [-] and let the controller set them after every turn.

    gain: share of the error that is taken away in a turn; noise: one sigma of every measured speed by the mean speed;
    rate: largest change of a pressure in a turn by the design's.
    """
    point, rng = found.task.points[k], np.random.default_rng(9)
    design = machine_at(found, k)
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

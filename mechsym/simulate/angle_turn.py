"""One turn of a shaft over the angle: collocation at the Gauss points of every panel, see `machine`.

A load that grows with speed makes the energies of a panel depend on each other and on the panel before. Newton's method
takes all panels of a turn at once: one step where the load is linear in the energy, as the propeller's is.
"""

import numpy as np

from mechsym.machine.loads import ConstantLoad, Load, PropellerLoad, load_slope, load_torque
from mechsym.quantities import record
from mechsym.simulate.angle import Panels, gauss

_SLOWEST = 1e-9  # the load's slope is asked for at this speed at least, where the shaft has stopped [rad/s]


@record
class AngleTurn:
    """One period of motion."""

    energy: np.ndarray  #: shape (k, n): Kinetic energy at the Gauss points; negative beyond a stop [J]
    energy_edges: np.ndarray  #: shape (k + 1,): At the ends of the panels [J]
    multiplier: float  #: Change of the energy at the end per change at the start [-]


def turn(panels: Panels, flywheel: float, energy: float) -> AngleTurn:
    """Integrate one period from a kinetic energy.

    Parameters
    ----------
    flywheel : float
        Inertia added to the shaft [kg*m^2]
    energy : float
        Kinetic energy at the start [J]

    Returns
    -------
    turn : AngleTurn
        Energies; where they are negative the shaft has stopped before
    """
    if isinstance(panels.load, ConstantLoad):
        return _turn_constant(panels, energy)
    return _turn_together(panels, flywheel, energy) or _turn_panel_by_panel(panels, flywheel, energy)


def _turn_constant(panels: Panels, energy: float) -> AngleTurn:
    _, weights, matrix = gauss()
    half = np.diff(panels.edges)[:, None] / 2
    net = panels.torque - panels.load.torque  # type: ignore[union-attr]
    edges = energy + np.concatenate([[0.0], np.cumsum(half * net @ weights[:, None])])
    return AngleTurn(energy=edges[:-1, None] + half * net @ matrix.T, energy_edges=edges, multiplier=1.0)


def _turn_together(panels: Panels, flywheel: float, energy: float) -> AngleTurn | None:
    """All panels in one Newton iteration; a linear law, such as the propeller's, needs one step. None if it fails."""
    inertia, half = panels.inertia + flywheel, np.diff(panels.edges)[:, None] / 2
    found, edges = np.full_like(panels.phi, energy), np.full(len(panels.edges), energy)
    for _ in range(20):
        omega = np.sqrt(2 * np.maximum(found, 0.0) / inertia)
        net = panels.torque - load_torque(panels.load, omega)
        slope = _slope(panels.load, omega, inertia)
        # a shaft that has stopped feels the load of standing still, whatever its energy
        lively = np.where(found > 0, slope, 0.0)
        before, (found, edges, multiplier) = found, _linear(net + lively * found, lively, half, energy)
        if not np.all(np.isfinite(found)):
            return None
        # a law that is linear in the energy, slope and all, is met by the first step
        met = isinstance(panels.load, PropellerLoad) and before.min() > 0 and found.min() > 0
        if met or np.max(np.abs(found - before)) <= 1e-13 * np.max(np.abs(found)):
            if np.any(found <= 0):
                multiplier = _linear(net, slope, half, energy)[2]
            return AngleTurn(energy=found, energy_edges=edges, multiplier=multiplier)
    return None


def _linear(
    constant: np.ndarray, slope: np.ndarray, half: np.ndarray, energy: float
) -> tuple[np.ndarray, np.ndarray, float]:
    """Energies at the points and the edges, and the multiplier, for the net torque constant - slope * energy."""
    _, weights, matrix = gauss()
    whole = half[..., None] * matrix
    right = np.stack([np.ones_like(constant), (whole @ constant[..., None])[..., 0]], axis=-1)
    solved = np.linalg.solve(np.eye(len(matrix)) + whole * slope[:, None, :], right)
    of_start, rest = solved[..., 0], solved[..., 1]
    grown = 1 - (half * slope * of_start) @ weights
    gained = (half * (constant - slope * rest)) @ weights
    edges = [energy]
    for a, b in zip(grown.tolist(), gained.tolist(), strict=True):
        edges.append(a * edges[-1] + b)
    starts = np.array(edges[:-1])[:, None]
    return starts * of_start + rest, np.array(edges), float(np.prod(grown))


def _slope(load: Load, omega: np.ndarray, inertia: np.ndarray) -> np.ndarray:
    """Slope of the load over the energy."""
    turning = np.maximum(omega, _SLOWEST)
    return load_slope(load, turning) / (inertia * turning)


def _turn_panel_by_panel(panels: Panels, flywheel: float, energy: float) -> AngleTurn:
    _, weights, matrix = gauss()
    edges, points, multiplier = [energy], [], 1.0
    guess = np.full(len(weights), energy)
    for inertia, torque, half in zip(panels.inertia + flywheel, panels.torque, np.diff(panels.edges) / 2, strict=True):
        guess, net, slope = _collocate(panels.load, inertia, torque, half * matrix, edges[-1], guess)
        sensitivity = np.linalg.solve(np.eye(len(matrix)) + half * matrix * slope, np.ones(len(matrix)))
        points.append(guess)
        multiplier *= 1 - half * float(weights @ (slope * sensitivity))
        edges.append(edges[-1] + half * float(weights @ net))
        guess = np.full(len(weights), edges[-1])
    return AngleTurn(energy=np.array(points), energy_edges=np.array(edges), multiplier=multiplier)


def _collocate(
    load: Load, inertia: np.ndarray, torque: np.ndarray, matrix: np.ndarray, start: float, guess: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Energies at the points of one panel by Newton's method; net torque and slope of the load over energy there."""
    energy = guess
    for _ in range(20):
        omega = np.sqrt(2 * np.maximum(energy, 0.0) / inertia)
        net = torque - load_torque(load, omega)
        slope = _slope(load, omega, inertia)
        residual = energy - start - matrix @ net
        change = np.linalg.solve(np.eye(len(matrix)) + matrix * slope, residual)
        energy = energy - change
        if np.max(np.abs(change)) <= 1e-13 * max(abs(start), float(np.max(np.abs(energy)))):
            break
    return energy, net, slope


def speeds(panels: Panels, flywheel: float, turn: AngleTurn) -> tuple[np.ndarray, np.ndarray, float]:
    """Speed around a turn that does not stop, and how long the turn takes.

    Parameters
    ----------
    flywheel : float
        Inertia added to the shaft [kg*m^2]

    Returns
    -------
    phi, omega : ndarray, shape (m,)
        Angles, ends of the panels included, and the speeds there [rad, rad/s]
    time : float
        Duration [s]
    """
    at_points = np.sqrt(2 * turn.energy / (panels.inertia + flywheel))
    at_edges = np.sqrt(2 * turn.energy_edges / (panels.inertia_edges + flywheel))
    time = float(np.sum(np.diff(panels.edges) / 2 * ((1 / at_points) @ gauss()[1])))
    phi = np.append(np.column_stack([panels.edges[:-1], panels.phi]).ravel(), panels.edges[-1])
    omega = np.append(np.column_stack([at_edges[:-1], at_points]).ravel(), at_edges[-1])
    return phi, omega, time


def lowest_energy(turn: AngleTurn) -> float:
    """Smallest kinetic energy of a turn.

    Returns
    -------
    energy : float
        Not positive when the shaft stops [J]
    """
    return float(min(turn.energy.min(), turn.energy_edges.min()))


def stop_angle(panels: Panels, turn: AngleTurn) -> float | None:
    """Where a turn stops.

    Returns
    -------
    phi : float or None
        First angle without kinetic energy, between two points by a straight line; None if it does not stop [rad]
    """
    phi = np.append(np.column_stack([panels.edges[:-1], panels.phi]).ravel(), panels.edges[-1])
    energy = np.append(np.column_stack([turn.energy_edges[:-1], turn.energy]).ravel(), turn.energy_edges[-1])
    stopped = np.flatnonzero(energy <= 0)
    if not len(stopped):
        return None
    i = max(int(stopped[0]), 1)
    share = energy[i - 1] / (energy[i - 1] - energy[i])
    return float(phi[i - 1] + share * (phi[i] - phi[i - 1]))

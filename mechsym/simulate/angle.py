r"""A shaft with one coordinate over the angle: kinetic energy instead of speed, angle instead of time.

.. math:: \frac{\mathrm{d}T}{\mathrm{d}\varphi} = Q(\varphi) - M_r(\omega),
          \qquad T = \tfrac12 (I(\varphi) + J)\,\omega^2

Q is the torque of everything that depends on the angle only (gas, hinge, gravity), M_r the load, J a flywheel. Kinks of
the torque are known angles, so panels end at them; a shaft that stops is T = 0, where nothing is singular. Each panel
carries Gauss points, and a turn costs less than a millisecond.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre

from mechsym.errors import BadInput
from mechsym.machine.loads import ConstantLoad, Load, PropellerLoad, load_slope, load_torque
from mechsym.quantities import record
from mechsym.quantities.units import Array, Inertia, Joule, Pure, Radian, Second

_POINTS = 10
_WIDEST = np.pi / 18


@record
class ReducedMachine:
    """A machine reduced to its crank: inertia and torque over the angle, and the load."""

    inertia: Callable[[np.ndarray], np.ndarray]  #: phi, ndarray (n,), to reduced inertia [kg*m^2]
    #: phi, ndarray (n,), to the torque of all that depends on the angle only [N*m]
    torque: Callable[[np.ndarray], np.ndarray]
    load: Load
    period: float = 2 * np.pi  #: Period of inertia and torque [rad]
    kinks: tuple[float, ...] = ()  #: Where they are not smooth, in [0, period) [rad]


@record
class Panels:
    """A machine evaluated once at the Gauss points of one period."""

    load: Load
    edges: np.ndarray  #: shape (k + 1,): Ends of the panels [rad]
    phi: np.ndarray  #: shape (k, n): Gauss points [rad]
    #: shape (k, n): There [kg*m^2, N*m]
    inertia: np.ndarray
    torque: np.ndarray
    inertia_edges: np.ndarray  #: shape (k + 1,): Inertia at the ends [kg*m^2]


@lru_cache(maxsize=1)
def gauss() -> tuple[Pure[Array], Pure[Array], Pure[Array]]:
    """Gauss points of a panel. Returns x, weights, matrix: on [-1, 1], and what integrates from -1 to each point."""
    x, weights = legendre.leggauss(_POINTS)
    to_coefficients = np.linalg.inv(legendre.legvander(x, _POINTS - 1))
    integrals = np.array([legendre.legval(x, legendre.legint(row, lbnd=-1)) for row in np.eye(_POINTS)])
    return x, weights, integrals.T @ to_coefficients


def tabulate(machine: ReducedMachine, phi_start: Radian = 0.0) -> Panels:
    """Values of a machine at the Gauss points of one period, for `turn`. phi_start: where the period begins."""
    kinks = [phi_start + (k - phi_start) % machine.period for k in machine.kinks]
    ends = np.unique([phi_start, *kinks, phi_start + machine.period])
    ends = ends[np.append(True, np.diff(ends) > 1e-12)]
    even = [np.linspace(a, b, int(np.ceil((b - a) / _WIDEST)) + 1)[:-1] for a, b in zip(ends, ends[1:], strict=False)]
    edges = np.append(np.concatenate(even), phi_start + machine.period)
    x = gauss()[0]
    phi = (edges[1:, None] + edges[:-1, None]) / 2 + np.diff(edges)[:, None] / 2 * x
    inertia, torque, at_edges = machine.inertia(phi.ravel()), machine.torque(phi.ravel()), machine.inertia(edges)
    for name, values in (("inertia", inertia), ("torque", torque), ("inertia", at_edges)):
        bad = ~np.isfinite(values) | ((values <= 0) if name == "inertia" else False)
        if np.any(bad):
            raise BadInput(f"{name} = {values[bad][0]} at an angle of the turn; it must be finite, an inertia > 0")
    return Panels(
        load=machine.load,
        edges=edges,
        phi=phi,
        inertia=inertia.reshape(phi.shape),
        torque=torque.reshape(phi.shape),
        inertia_edges=at_edges,
    )


_SLOWEST = 1e-9  # the load's slope is asked for at this speed at least, where the shaft has stopped [rad/s]


@record
class AngleTurn:
    """One period of motion."""

    energy: np.ndarray  #: shape (k, n): Kinetic energy at the Gauss points; negative beyond a stop [J]
    energy_edges: np.ndarray  #: shape (k + 1,): At the ends of the panels [J]
    multiplier: float  #: Change of the energy at the end per change at the start [-]


def turn(panels: Panels, flywheel: Inertia, energy: Joule) -> AngleTurn:
    """Integrate one period from a kinetic energy.

    flywheel: inertia added to the shaft; energy: kinetic energy at the start. Returns turn: energies; where they are
    negative the shaft has stopped before.
    """
    if isinstance(panels.load, ConstantLoad):
        _, weights, matrix = gauss()
        half, net = np.diff(panels.edges)[:, None] / 2, panels.torque - panels.load.torque
        edges = energy + np.concatenate([[0.0], np.cumsum(half * net @ weights[:, None])])
        return AngleTurn(energy=edges[:-1, None] + half * net @ matrix.T, energy_edges=edges, multiplier=1.0)
    return _turn_together(panels, flywheel, energy) or _turn_panel_by_panel(panels, flywheel, energy)


def _turn_together(panels: Panels, flywheel: float, energy: float) -> AngleTurn | None:
    """All panels in one Newton iteration; a linear law, such as the propeller's, needs one step. None if it fails."""
    inertia, half = panels.inertia + flywheel, np.diff(panels.edges)[:, None] / 2
    energies, edges = np.full_like(panels.phi, energy), np.full(len(panels.edges), energy)
    for _ in range(20):
        omega = np.sqrt(2 * np.maximum(energies, 0.0) / inertia)
        net = panels.torque - load_torque(panels.load, omega)
        slope = _slope(panels.load, omega, inertia)
        # a shaft that has stopped feels the load of standing still, whatever its energy
        lively = np.where(energies > 0, slope, 0.0)
        before, (energies, edges, multiplier) = energies, _linear(net + lively * energies, lively, half, energy)
        if not np.all(np.isfinite(energies)):
            return None
        # a law that is linear in the energy, slope and all, is met by the first step
        met = isinstance(panels.load, PropellerLoad) and before.min() > 0 and energies.min() > 0
        if met or np.max(np.abs(energies - before)) <= 1e-13 * np.max(np.abs(energies)):
            if np.any(energies <= 0):
                multiplier = _linear(net, slope, half, energy)[2]
            return AngleTurn(energy=energies, energy_edges=edges, multiplier=multiplier)
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


def speeds(panels: Panels, flywheel: Inertia, turn: AngleTurn) -> tuple[np.ndarray, np.ndarray, Second]:
    """Speed around a turn that does not stop, and how long the turn takes.

    flywheel: inertia added to the shaft. Returns phi, omega: angles, ends of the panels included, and the speeds there
    [rad, rad/s], shape (m,); time: duration.
    """
    at_points = np.sqrt(2 * turn.energy / (panels.inertia + flywheel))
    at_edges = np.sqrt(2 * turn.energy_edges / (panels.inertia_edges + flywheel))
    time = float(np.sum(np.diff(panels.edges) / 2 * ((1 / at_points) @ gauss()[1])))
    phi = np.append(np.column_stack([panels.edges[:-1], panels.phi]).ravel(), panels.edges[-1])
    omega = np.append(np.column_stack([at_edges[:-1], at_points]).ravel(), at_edges[-1])
    return phi, omega, time


def extremes(panels: Panels, phi: np.ndarray, omega: np.ndarray) -> tuple[float, float]:
    """Least and greatest speed of a turn: of the polynomial through the ends and points of each panel [rad/s].

    phi, omega: as `speeds` returns them [rad, rad/s], shape (m,).
    """
    at = np.append(-1.0, np.append(gauss()[0], 1.0))
    rows = np.column_stack([omega[:-1].reshape(panels.phi.shape[0], -1), omega[len(at) - 1 :: len(at) - 1]])
    inside = [_peak(at, sign * rows[int((sign * rows).max(axis=1).argmax())]) for sign in (-1.0, 1.0)]
    return -inside[0], inside[1]


def _peak(at: np.ndarray, row: np.ndarray) -> float:
    """Greatest value on [-1, 1] of the polynomial through values at points."""
    through = np.polynomial.Chebyshev.fit(at, row - row[0], len(at) - 1, domain=[-1, 1])
    roots = through.deriv().roots()
    inside = roots.real[(np.abs(roots.imag) < 1e-9) & (np.abs(roots.real) < 1)]
    return float(max(row.max(), row[0] + through(inside).max(initial=-np.inf)))


def lowest_energy(turn: AngleTurn) -> Joule:
    """Smallest kinetic energy of a turn. Returns energy: not positive when the shaft stops."""
    return float(min(turn.energy.min(), turn.energy_edges.min()))


def stop_angle(panels: Panels, turn: AngleTurn) -> Radian | None:
    """First angle without kinetic energy, between two points by a straight line; None if a turn does not stop."""
    phi = np.append(np.column_stack([panels.edges[:-1], panels.phi]).ravel(), panels.edges[-1])
    energy = np.append(np.column_stack([turn.energy_edges[:-1], turn.energy]).ravel(), turn.energy_edges[-1])
    stopped = np.flatnonzero(energy <= 0)
    if not len(stopped):
        return None
    i = max(int(stopped[0]), 1)
    share = energy[i - 1] / (energy[i - 1] - energy[i])
    return float(phi[i - 1] + share * (phi[i] - phi[i - 1]))

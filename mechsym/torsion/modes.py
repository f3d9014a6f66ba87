r"""Torsional vibration of a chain of inertias: natural frequencies, orders of excitation, critical speeds.

    [I0]--k1,c1--[I2]      all coordinates turn together at omega, plus a small twist v(t)
     ^
     T_k(omega) cos(k omega t)    k orders per turn, from the reciprocating inertia (~ omega^2) and the gas

.. math:: \bar M \ddot v + C \dot v + K v = \sum_k \mathrm{Re}\,\big(T_k e^{\mathrm{i} k \omega t}\big)

M is the mean mass matrix over a turn. A speed is critical where an order meets a natural frequency.
"""

from collections.abc import Callable, Mapping
from typing import Annotated

import casadi as ca
import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms import crank_train
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities import record
from mechsym.quantities.units import Array, NewtonMetre, Radian, RadPerSecond

_POINTS = 512


@record
class Matrices:
    """Linear model of the twist about uniform turning."""

    coordinates: tuple[str, ...]
    mass: np.ndarray  #: shape (n, n): Mean mass matrix over a turn [kg*m^2]
    stiffness: np.ndarray  #: shape (n, n): Second derivative of the potential energy, mean over a turn [N*m/rad]
    damping: np.ndarray  #: shape (n, n): Torque per speed [N*m*s/rad]


@record
class Modes:
    """Natural frequencies and shapes."""

    frequencies: np.ndarray  #: shape (n,): Ascending; 0 for turning as a whole [rad/s]
    shapes: np.ndarray  #: shape (n, n): One column a mode, shape^T M shape = 1 [1/sqrt(kg*m^2)]


@record
class Orders:
    """Torques on the coordinates by order, at uniform speed."""

    order: np.ndarray  #: shape (k,): Oscillations per turn, halves included when the gas repeats every two turns [-]
    #: shape (k, n): Complex amplitudes from the reciprocating masses, per square of the speed [N*m*s^2/rad^2]
    inertia: np.ndarray
    gas: np.ndarray  #: shape (k, n): Complex amplitudes from the gas forces [N*m]


@record
class Critical:
    """A speed at which an order excites a mode."""

    mode: int
    order: float  #: Order [-]
    speed: float  #: Natural frequency / order [rad/s]
    force: float  #: Amplitude of the modal force there [N*m/sqrt(kg*m^2)]
    damping: float  #: Modal damping, shape^T C shape [1/s]
    #: Mean torque that the resonance takes at this speed; a weaker drive is held there. None without damping, when the
    #: amplitude grows until something else limits it [N*m]
    holding_torque: float | None


def matrices(mechanism: Mechanism) -> Matrices:
    """Linear model of a mechanism all of whose coordinates are angles that advance alike."""
    if "energy" not in mechanism.functions:
        raise BadInput(f"{mechanism.name} has no energies; use the derived mechanism for torsional analysis")
    n = len(mechanism.coordinates)
    phi, q, u = ca.SX.sym("phi"), ca.SX.sym("q", n), ca.SX.sym("u", n)
    zeros = [0.0] * len(mechanism.inputs)
    mass, _, force = mechanism.functions["dynamics"](*ca.vertsplit(q), *ca.vertsplit(u), *zeros)
    potential = mechanism.functions["energy"](*ca.vertsplit(q), *ca.vertsplit(u))[1]
    parts = [mass, ca.hessian(potential, q)[0], -ca.jacobian(force, u)]
    together = ca.substitute(parts, [q, u], [ca.repmat(phi, n, 1), ca.SX.zeros(n, 1)])
    values = ca.Function("linear", [phi], [ca.densify(m) for m in together])(_angles(2 * np.pi)[None, :])
    mean = [np.asarray(v).reshape(n, _POINTS, n).mean(axis=1) for v in values]
    return Matrices(coordinates=mechanism.coordinates, mass=mean[0], stiffness=mean[1], damping=mean[2])


def modes(mass: np.ndarray, stiffness: np.ndarray) -> Modes:
    r"""Natural frequencies and mass-normalised shapes.

    .. math:: (K - \omega_n^2 M)\,v = 0, \qquad v^T M v = 1

    mass, stiffness: symmetric; the mass matrix positive definite [kg*m^2, N*m/rad], shape (n, n). Returns modes: the
    first component of each shape is not negative.
    """
    inverse = np.linalg.inv(np.linalg.cholesky(mass))  # M = L L^T
    squares, shapes = np.linalg.eigh(inverse @ stiffness @ inverse.T)
    shapes = inverse.T @ shapes
    scale = float(np.max(np.abs(squares)))
    squares = np.where(squares > 1e-12 * scale, squares, 0.0)
    return Modes(frequencies=np.sqrt(squares), shapes=shapes * np.where(shapes[0] < 0, -1.0, 1.0))


def orders(
    mechanism: Mechanism,
    count: int = 8,
    gas: Mapping[str, Callable[[np.ndarray], np.ndarray]] | None = None,
    period: Radian = 2 * np.pi,
) -> Orders:
    r"""Torques by order while all coordinates turn uniformly together.

    .. math:: T_\mathrm{inertia} = -h(\varphi, \omega), \qquad T_\mathrm{gas} = Q(\varphi, F(\varphi)) - Q(\varphi, 0)

    mechanism: all coordinates are angles that advance alike; gas: input to its value over the angle, ndarray (m,) to
    (m,); period: period of the gas force, 2 pi or 4 pi. Returns orders: complex amplitudes T with torque = Re(T exp(i k
    phi)).
    """
    phi = _angles(period)
    turning = [np.reshape(phi, (1, -1))] * len(mechanism.coordinates)
    inputs = {name: np.reshape(force(phi), (1, -1)) for name, force in (gas or {}).items()}
    zero, one = np.zeros((1, _POINTS)), np.ones((1, _POINTS))
    at_rest = [zero] * len(mechanism.coordinates)
    dynamics = mechanism.functions["dynamics"]
    none = [zero] * len(mechanism.inputs)
    bias = np.asarray(dynamics(*turning, *[one] * len(turning), *none)[1])
    idle = np.asarray(dynamics(*turning, *at_rest, *none)[2])
    pushed = np.asarray(dynamics(*turning, *at_rest, *(inputs.get(name, zero) for name in mechanism.inputs))[2])
    per_turn = round(period / (2 * np.pi))
    index = np.arange(1, count * per_turn + 1)
    return Orders(order=index / per_turn, inertia=_amplitudes(-bias, index), gas=_amplitudes(pushed - idle, index))


def _angles(period: float) -> np.ndarray:
    return period * np.arange(_POINTS) / _POINTS


def _amplitudes(torque: np.ndarray, index: np.ndarray) -> np.ndarray:
    """Complex amplitudes of rows over one period, shape (k, n)."""
    return (2 * np.fft.rfft(torque, axis=-1) / torque.shape[-1])[:, index].T


def critical_speeds(modes: Modes, excitation: Orders, damping: Annotated[Array, "N*m*s/rad"]) -> tuple[Critical, ...]:
    r"""Where orders meet natural frequencies, and what drive they hold.

    .. math:: \omega = \omega_n / k,\quad f = |v^T T_k(\omega)|,\quad d = v^T C v,
              \quad M_\mathrm{hold} = \frac{f^2}{2 d \omega}

    damping: damping matrix, shape (n, n). Returns criticals: from the highest speed down; orders without force are left
    out. At resonance the modal speed is f / d, so the mean power into the vibration is f^2 / (2 d); it comes from the
    shaft, as a mean torque at speed omega. A drive that is weaker cannot pass (Sommerfeld effect).
    """
    rows = []
    for mode in np.flatnonzero(modes.frequencies > 0):
        shape, loss = modes.shapes[:, mode], float(modes.shapes[:, mode] @ damping @ modes.shapes[:, mode])
        for order, inertia, gas in zip(excitation.order, excitation.inertia, excitation.gas, strict=True):
            speed = float(modes.frequencies[mode] / order)
            force = float(abs(shape @ (inertia * speed**2 + gas)))
            holding = force**2 / (2 * loss * speed) if loss > 0 else None
            rows.append(
                Critical(
                    mode=int(mode), order=float(order), speed=speed, force=force, damping=loss, holding_torque=holding
                )
            )
    strongest = max((c.force for c in rows), default=0.0)
    return tuple(sorted((c for c in rows if c.force > 1e-9 * strongest), key=lambda c: -c.speed))


def holding_damping(critical: Critical, drive: NewtonMetre, unit_damping: float) -> Annotated[float, "N*m*s/rad"]:
    r"""Damping below which a drive is held at a critical speed.

    .. math:: c = \frac{f^2}{2 M \omega\, d_1}

    drive: driving torque; unit_damping: modal damping d_1 that a damper of 1 N m s/rad brings [1/s per N*m*s/rad].
    Returns c: with a stronger damper the drive passes.
    """
    return critical.force**2 / (2 * drive * critical.speed * unit_damping)


MAJOR = 0.5  # phase-vector sum from which an order is major
AWAY = 0.1  # of a major order's critical speed from the speed of operation, either way
_FELT = 0.02  # phase-vector sum below which an order hardly pushes its mode
_FREE = (0.05, 0.01)  # wanted distance of what is felt and not major, in the first mode and in all
_HIGHEST = 12.0  # orders above are too weak
_FACTORS = np.exp(np.linspace(np.log(0.25), np.log(4.0), 1109))  # of the stiffness, a quarter of a per cent apart


def phase_sums(parameters: CrankTrainParameters, orders: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Natural frequencies (m,) [rad/s] of a crank train and its phase-vector sums (n, m) at orders (n,) [-]."""
    linear = matrices(crank_train.build(parameters))
    own = modes(linear.mass, linear.stiffness)
    moved = own.shapes[np.asarray(parameters.throw) - 1, 1:]
    turning = np.exp(1j * orders[:, None] * np.asarray(parameters.firing))
    return own.frequencies[1:], np.abs(turning @ moved) / np.abs(moved).sum(axis=0)


def stiffness_factor(parameters: CrankTrainParameters, omega: RadPerSecond, period: Radian) -> float | None:
    r"""By how much the stiffness of all sections has to be changed, the least that is enough [-]; None if nothing is.

    .. math:: w_{jk} = \frac{|\sum_i v_{ij} e^{\mathrm{i} k \alpha_i}|}{\sum_i |v_{ij}|}, \qquad
              d_{jk} = \left|\frac{\omega_j}{k \omega} - 1\right|

    Cylinder i fires at the shaft angle :math:`\alpha_i` and moves by :math:`v_{ij}` in mode j: w is the phase-vector
    sum of order k, 1 where all push together (Ker Wilson 1956; Den Hartog 1956, section 5.5). An order is major in a
    mode where w is at least a half. Half orders of many cylinders in several modes lie within a few per cent of each
    other: those that are not major are kept away as far as they can be, those of the first mode, which carry most,
    before the others. omega: speed of operation. period: of the gas: a turn, or two of a four-stroke engine.
    """
    orders = np.arange(1, round(_HIGHEST * period / (2 * np.pi)) + 1) * 2 * np.pi / period
    natural, sums = phase_sums(parameters, orders)
    ratio = natural / (orders[:, None] * omega)
    away = np.abs(np.sqrt(_FACTORS)[:, None, None] * ratio - 1)
    major = np.where(sums >= MAJOR, away, np.inf).min(axis=(1, 2))
    felt = np.where(sums >= _FELT, away, np.inf)
    best = np.flatnonzero(major >= AWAY)
    if not best.size:
        return None
    for wanted, least in zip(_FREE, (felt[:, :, 0].min(axis=1), felt.min(axis=(1, 2))), strict=True):
        best = best[least[best] >= min(wanted, least[best].max())]
    return float(_FACTORS[best[np.abs(np.log(_FACTORS[best])).argmin()]])

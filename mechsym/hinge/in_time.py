r"""A run in time with what a real hinge has: friction, mass on the rollers, a gas with a temperature of its own.

The path is a curve over the crank angle, so everything on it is a formula of rho, its derivatives, the speed of the
moment and the state of the gas. Friction takes `losses` from the shaft; the mass adds the inertia

.. math:: I_h = c\,\lambda^2 m_h\,(\rho^2 + \rho'^2), \qquad \lambda: \text{turns of the guide's shaft by the crank's}

and the gas of an `air_thermal` spring is integrated with the motion, w = T / T_w:

.. math:: \dot w = -(\gamma - 1)\,w\,\frac{\dot V}{V} - \frac{w - 1}{\tau}, \qquad
          E = m c_v T_w\,w + p_a V, \qquad \dot Q = m c_v T_w\,\frac{w - 1}{\tau}

so that the balance has the energy in the gas and the heat that has left it, in place of the work of the hinge.
"""

import functools
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import scipy

from mechsym.hinge import losses as laws
from mechsym.hinge.guide import Guide, path, warmth
from mechsym.hinge.losses import HingeLosses
from mechsym.hinge.rollers import RollerParameters, contact_force, loss_torque
from mechsym.machine.record import Machine, kinks_of, period_of
from mechsym.quantities import record
from mechsym.quantities.units import Scalar
from mechsym.simulate.problem import Along, Kinks, Part, Periodic, Problem, State

HEAT = "spring_heat"
KINDS = {"bearing": "work_bearing", "seal": "work_seal", "guide": "work_guide", "rolling": "work_rolling", "gas": HEAT}
_SAME = 1e-9  # kinks nearer than this are one [rad]


@record
class RealHinge:
    """What acts in a run in time beside the torque of an ideal hinge."""

    guide: Guide
    rollers: RollerParameters
    losses: HingeLosses | None = None  #: Friction; None for none but rolling resistance


def is_real(hinge: RealHinge) -> bool:
    """Whether a hinge has anything that the ideal one has not."""
    friction = hinge.losses is not None or hinge.rollers.friction != "none"
    return friction or hinge.rollers.moving_mass > 0 or bool(hinge.guide.spring.state)


def with_real_hinge(problem: Problem, machine: Machine, hinge: RealHinge) -> Problem:
    """A problem of `simulate.engine` with a real hinge in place of its part `hinge`.

    problem: of the machine, with the ideal hinge; machine: it says where the torque is not smooth.
    """
    rho = _over_crank(path(hinge.guide), hinge.guide.parameters.shaft_ratio)
    (q,) = problem.mechanism.coordinates
    curves = tuple(_curve(q, rho.derivative(i) if i else rho) for i in range(3))
    parts = [replace(p, value=_torque(hinge)) if p.name == "hinge" else p for p in problem.parts]
    taken = tuple(Part(name=name, input="M_h", role="loss", value=value) for name, value in _friction(hinge).items())
    kinks = _kinks(kinks_of(machine), rho, period_of(machine))
    return replace(
        problem,
        parts=(*parts, *taken),
        curves=curves,
        states=_gas(hinge, problem.q0[0]) if hinge.guide.spring.state else (),
        stored=Along(function=functools.partial(_stored, hinge)),
        inertia=_inertia(q, hinge, rho),
        kinks=(Kinks(coordinate=q, angles=kinks, period=period_of(machine)),),
    )


def _over_crank(rho: "scipy.interpolate.PPoly", ratio: float) -> "scipy.interpolate.PPoly":
    """The same path over the angle of the crank."""
    if ratio == 1:
        return rho
    powers = ratio ** np.arange(rho.c.shape[0] - 1, -1, -1)
    return scipy.interpolate.PPoly(rho.c * powers[:, None], rho.x / ratio, extrapolate="periodic")


def _curve(coordinate: str, poly: "scipy.interpolate.PPoly") -> Periodic:
    curve = scipy.interpolate.PPoly(poly.c, poly.x, extrapolate="periodic")
    return Periodic(coordinate=coordinate, value=curve, period=float(poly.x[-1] - poly.x[0]))


def _path_at(hinge: RealHinge, u: Scalar, curves: Sequence[Scalar]) -> tuple[Scalar, Scalar, Scalar, Scalar]:
    """rho [m], its derivatives by the angle of the guide's shaft [m/rad, m/rad^2] and the speed of that [rad/s]."""
    rho, drho, d2rho = curves
    ratio = hinge.guide.parameters.shaft_ratio
    return rho, drho / ratio, d2rho / ratio**2, ratio * u[0]


def _closing(hinge: RealHinge, rho: Scalar) -> Scalar:
    return hinge.guide.rollers * (hinge.guide.parameters.rho0 - rho)


def _force(hinge: RealHinge, rho: Scalar, states: Sequence[Scalar]) -> Scalar:
    """Force of the spring on each roller [N]."""
    return hinge.guide.spring.force(_closing(hinge, rho), states[0] if states else None)


def _torque(hinge: RealHinge) -> Along:
    c, ratio = hinge.guide.rollers, hinge.guide.parameters.shaft_ratio

    def torque(u: Scalar, curves: Sequence[Scalar], states: Sequence[Scalar]) -> Scalar:
        rho, drho, _, _ = _path_at(hinge, u, curves)
        return ratio * c * _force(hinge, rho, states) * drho

    return Along(function=torque)


def _friction(hinge: RealHinge) -> dict[str, Along]:
    """Torques on the crank by kind, each against its motion."""
    r, given, c = hinge.rollers, hinge.losses, hinge.guide.rollers
    ratio = hinge.guide.parameters.shaft_ratio

    def taken(of: Callable[..., Scalar]) -> Along:
        def value(u: Scalar, curves: Sequence[Scalar], states: Sequence[Scalar]) -> Scalar:
            rho, drho, d2rho, omega = _path_at(hinge, u, curves)
            return -ratio * of(_force(hinge, rho, states), rho, drho, d2rho, omega)

        return Along(function=value)

    def contact(F: Scalar, rho: Scalar, drho: Scalar, d2rho: Scalar, omega: Scalar) -> Scalar:
        return contact_force(F, rho, drho, d2rho, r.moving_mass, omega)

    found = {}
    if given is not None:
        r_b = given.bearing_radius or r.radius / 2
        found["bearing"] = taken(
            lambda F, rho, drho, *more: laws.bearing_torque(
                contact(F, rho, drho, *more), rho, drho, given.bearing_mu, r_b, r.radius, c
            )
        )
        found["seal"] = taken(lambda F, rho, drho, *more: laws.seal_torque(F, drho, given.seal_mu, c))
        found["guide"] = taken(
            lambda F, rho, drho, d2rho, omega: laws.guide_torque(
                laws.side_force(F, rho, drho, d2rho, r.moving_mass, omega), drho, given.guide_mu, c
            )
        )
    if r.friction != "none":
        found["rolling"] = taken(
            lambda F, rho, drho, *more: c * loss_torque(contact(F, rho, drho, *more), rho, drho, r)
        )
    return found


def _gas(hinge: RealHinge, phi: float) -> tuple[State, ...]:
    """Temperature by the wall's, as it is in steady running, and the heat that the wall has taken."""
    spring = hinge.guide.spring

    def warming(u: Scalar, curves: Sequence[Scalar], states: Sequence[Scalar]) -> Scalar:
        rho, drho, _, omega = _path_at(hinge, u, curves)
        return spring.warming(states[0], _closing(hinge, rho), hinge.guide.rollers * drho * omega)

    def cooling(u: Scalar, curves: Sequence[Scalar], states: Sequence[Scalar]) -> Scalar:
        return spring.heat(states[0])

    start = float(warmth(hinge.guide)(hinge.guide.parameters.shaft_ratio * phi))
    return (
        State(name=spring.state, unit="-", start=start, rate=Along(function=warming)),
        State(name=HEAT, unit="J", start=0.0, role="heat", rate=Along(function=cooling)),
    )


def _stored(hinge: RealHinge, u: Scalar, curves: Sequence[Scalar], states: Sequence[Scalar]) -> Scalar:
    """Energy in the spring [J]."""
    return hinge.guide.spring.energy(_closing(hinge, curves[0]), states[0] if states else None)


def _inertia(coordinate: str, hinge: RealHinge, rho: "scipy.interpolate.PPoly") -> tuple[Periodic, Periodic] | None:
    """Inertia of the moving masses on the crank [kg*m^2] and its derivative."""
    if hinge.rollers.moving_mass == 0:
        return None
    ratio = hinge.guide.parameters.shaft_ratio
    mass = hinge.guide.rollers * ratio**2 * hinge.rollers.moving_mass
    drho = rho.derivative()
    squared = mass * (_square(rho.c) + _padded(_square(drho.c) / ratio**2, 2))
    poly = scipy.interpolate.PPoly(squared, rho.x, extrapolate="periodic")
    return _curve(coordinate, poly), _curve(coordinate, poly.derivative())


def _square(c: np.ndarray) -> np.ndarray:
    """Coefficients of the square of each piece, highest power first."""
    return np.stack([np.convolve(piece, piece) for piece in c.T], axis=1)


def _padded(c: np.ndarray, rows: int) -> np.ndarray:
    return np.vstack([np.zeros((rows, c.shape[1])), c])


def _kinks(gas: tuple[float, ...], rho: "scipy.interpolate.PPoly", period: float) -> tuple[float, ...]:
    """Where the gas is not smooth, on every turn of the guide, and where the rollers turn back."""
    own = float(rho.x[-1] - rho.x[0])
    back = rho.derivative().roots(discontinuity=False, extrapolate=False)
    once = np.concatenate([np.asarray(gas, dtype=float), back[np.isfinite(back)]]) % own
    every = np.sort(np.concatenate([once + k * own for k in range(max(1, round(period / own)))]))
    return tuple(float(a) for i, a in enumerate(every) if i == 0 or a - every[i - 1] > _SAME)

r"""A run in time with what a real hinge has: friction, mass on the rollers, a gas with a temperature of its own.

The path is a curve over the crank angle, so everything on it is a formula of rho, its derivatives, the speed of the
moment and the state of the gas. Friction takes `losses` from the shaft; the mass adds the inertia

.. math:: I_h = c\,\lambda^2 m_h\,(\rho^2 + \rho'^2), \qquad \lambda: \text{turns of the guide's shaft by the crank's}

and the gas of an `air_thermal` spring is integrated with the motion, w = T / T_w:

.. math:: \dot w = -(\gamma - 1)\,w\,\frac{\dot V}{V} - \frac{w - 1}{\tau}, \qquad
          E = m c_v T_w\,w + p_a V, \qquad \dot Q = m c_v T_w\,\frac{w - 1}{\tau}

so that the balance has the energy in the gas and the heat that has left it, in place of the work of the hinge.

The design put to the test by running it in time, side by side: without hinge, with it, and started 1 per cent fast.

Each run audits its energy and takes the hinge's torque from the geometry of the guide and the law of the spring, never
from the table it was designed from. `steady.py` finds steady motions without running them.
"""

import functools
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from mechsym.hinge.guide import Guide, fitted, path, warmth
from mechsym.hinge.limits import at_angles
from mechsym.hinge.price import friction
from mechsym.hinge.rollers import HingeLosses, RollerParameters, contact_force, friction_torques, loss_torque
from mechsym.hinge.torque import Hinge
from mechsym.machine.loads import ConstantLoad, Load, PropellerLoad
from mechsym.machine.record import Machine, kinks_of, period_of
from mechsym.mechanisms import roles_of
from mechsym.mechanisms.record import Mechanism, bind
from mechsym.mechanisms.shaft import with_inertia
from mechsym.periodic import even_angles
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import record
from mechsym.quantities.display import figure
from mechsym.quantities.results import computed, part, quantity, result, seen
from mechsym.quantities.units import Inertia, Pure, RadPerSecond, Scalar
from mechsym.simulate import Result, Settings, simulate
from mechsym.simulate.angle import tabulate
from mechsym.simulate.engine import problem, reduced
from mechsym.simulate.problem import Along, Kinks, Part, Periodic, Problem, State
from mechsym.simulate.result import speed_ripple
from mechsym.simulate.steady import steady_state

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
    # where the gas is not smooth, on every turn of the guide, and where the rollers turn back
    gas = kinks_of(machine)
    period = period_of(machine)
    own = float(rho.x[-1] - rho.x[0])
    back = rho.derivative().zeros()
    once = np.concatenate([np.asarray(gas, dtype=float), back]) % own
    every = np.sort(np.concatenate([once + k * own for k in range(max(1, round(period / own)))]))
    kinks = tuple(float(a) for i, a in enumerate(every) if i == 0 or a - every[i - 1] > _SAME)
    return replace(
        problem,
        parts=(*parts, *taken),
        curves=curves,
        states=_gas(hinge, problem.q0[0]) if hinge.guide.spring.state else (),
        stored=Along(function=functools.partial(_stored, hinge)),
        inertia=_inertia(q, hinge, rho),
        kinks=(Kinks(coordinate=q, angles=kinks, period=period_of(machine)),),
    )


def _over_crank(rho: PPoly, ratio: float) -> PPoly:
    """The same path over the angle of the crank."""
    if ratio == 1:
        return rho
    powers = ratio ** np.arange(rho.c.shape[0] - 1, -1, -1)
    return PPoly(rho.c * powers[:, None], rho.x / ratio, extrapolate="periodic")


def _curve(coordinate: str, poly: PPoly) -> Periodic:
    curve = PPoly(poly.c, poly.x, extrapolate="periodic")
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

    def lost(kind: str, F: Scalar, path: tuple[Scalar, Scalar, Scalar], omega: Scalar) -> Scalar:
        if kind == "rolling" or given is None:
            return c * loss_torque(contact_force(F, *path, r.moving_mass, omega), path[0], path[1], r)
        return friction_torques(F, path, omega, r, c, given)[kind]

    def taken(kind: str) -> Along:
        def value(u: Scalar, curves: Sequence[Scalar], states: Sequence[Scalar]) -> Scalar:
            rho, drho, d2rho, omega = _path_at(hinge, u, curves)
            return -ratio * lost(kind, _force(hinge, rho, states), (rho, drho, d2rho), omega)

        return Along(function=value)

    rubbing = () if given is None else ("bearing", "seal", "guide")
    return {kind: taken(kind) for kind in (*rubbing, *(() if r.friction == "none" else ("rolling",)))}


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


def _inertia(coordinate: str, hinge: RealHinge, rho: PPoly) -> tuple[Periodic, Periodic] | None:
    """Inertia of the moving masses on the crank [kg*m^2] and its derivative."""
    if hinge.rollers.moving_mass == 0:
        return None
    ratio = hinge.guide.parameters.shaft_ratio
    mass = hinge.guide.rollers * ratio**2 * hinge.rollers.moving_mass
    drho = rho.derivative()
    c = _square(drho.c) / ratio**2
    squared = mass * (_square(rho.c) + np.vstack([np.zeros((2, c.shape[1])), c]))
    poly = PPoly(squared, rho.x, extrapolate="periodic")
    return _curve(coordinate, poly), _curve(coordinate, poly.derivative())


def _square(c: np.ndarray) -> np.ndarray:
    """Coefficients of the square of each piece, highest power first."""
    return np.stack([np.convolve(piece, piece) for piece in c.T], axis=1)


_ANGLES = 1440  # of a turn of the guide
_LAWS: dict[str, Load] = {"constant": ConstantLoad(), "propeller": PropellerLoad()}


@result
class TrialEvent:
    """What stopped a run."""

    name: str = part()
    t: float = quantity("s")  #: When
    phi: float = quantity("rad")  #: Where the crank was


@result
class Trial:
    """One run in time."""

    name: str  # its key
    about: str = part()  #: What is tried in a few words
    speed_ripple: float | None = quantity("-")  #: (max - min) / mean over the last period; None if the shaft stopped
    result: Result
    #: Mean torque that each kind of loss took over the last period [N*m]; None for an ideal hinge
    losses: Mapping[str, float] | None = None

    energy_residual: float | None = seen("result.energy.residual", "-")  #: What the balance of energy leaves open

    @computed()
    def event(self) -> TrialEvent | None:
        """What stopped it."""
        event = self.result.event
        return None if event is None else TrialEvent(name=event.name, t=event.t, phi=event.state["phi"])


def run(
    name: str,
    about: str,
    machine: Machine,
    speed: RadPerSecond,
    turns: Pure,
    settings: Settings | None = None,
    real: RealHinge | None = None,
) -> Trial:
    """Run a machine from top dead centre. speed: at the start. real: losses of its hinge; None for an ideal one."""
    what = problem(machine, speed, turns)
    result = simulate(
        what if real is None else with_real_hinge(what, machine, real), settings or Settings(check="none")
    )
    (angle,) = machine.mechanism.coordinates
    stopped = result.event is not None or result.status == "failed"
    ripple = None if stopped else speed_ripple(result, angle, period_of(machine))
    losses = None if real is None or stopped else _losses(result, angle, period_of(machine))
    return Trial(name=name, about=about, result=result, speed_ripple=ripple, losses=losses)


def trial(name: str, machine: Machine, wanted: Hinge, hinge: RealHinge, turns: Pure) -> Trial:
    """One run with a guide: `hinge_constant`, `hinge_propeller`; `off_constant`, `off_propeller` start 1 % fast."""
    kind, law = name.split("_")
    engine, real = ready(replace(machine, load=_LAWS[law]), wanted, hinge)
    if kind == "hinge":
        return run(name, f"hinge, {law} load", engine, machine.omega, turns, Settings(), real)
    return run(name, f"hinge, {law} load, started 1 % fast", engine, 1.01 * machine.omega, turns, real=real)


def ready(machine: Machine, wanted: Hinge, hinge: RealHinge) -> tuple[Machine, RealHinge | None]:
    """A machine with its hinge, its load lowered by what is lost; and what that hinge has beside the ideal one."""
    hinge = replace(hinge, guide=replace(hinge.guide, omega=machine.omega))
    if not is_real(hinge):
        return fitted(machine, wanted, hinge.guide), None
    return fitted(machine, wanted, hinge.guide, _friction_torque(hinge)), hinge


def _friction_torque(hinge: RealHinge) -> float:
    """Mean torque on the crank that friction takes at constant speed [N*m]."""
    theta = even_angles(2 * np.pi, _ANGLES)
    contact = at_angles(hinge.guide, hinge.rollers, theta)
    none = HingeLosses(bearing_mu=0.0, seal_mu=0.0, guide_mu=0.0)
    return float(sum(np.mean(t) for t in friction(contact, hinge.guide, hinge.rollers, hinge.losses or none).values()))


def _losses(result: Result, angle: str, period: float) -> dict[str, float]:
    """Mean torque that each kind of loss took over the last period [N*m]."""
    q = result.columns[angle]
    since = max(float(q[-1]) - period, float(q[0]))
    powers = {}
    for kind, name in KINDS.items():
        column = result.columns.get(name)
        lost = 0.0 if column is None else abs(float(column[-1] - np.interp(since, q, column)))
        powers[kind] = lost / (float(q[-1]) - since)
    return powers


def side_by_side(
    machine: Machine, wanted: Hinge, hinge: RealHinge | None, turns: Pure, known: Trial | None
) -> list[Trial]:
    """The runs of the report: without anything, and the hinge at the design speed and 1 per cent off.

    hinge: with what acts on it in time; None without a guide. turns: turns to run. known: one of them that has been
    run. Returns trials: keys without, hinge_constant, off_constant, hinge_propeller, off_propeller.
    """
    runs = [run("without", "no hinge, no flywheel", fitted(machine, wanted), machine.omega, turns)]
    if hinge is None:
        return runs
    for name in (f"{kind}_{law}" for law in _LAWS for kind in ("hinge", "off")):
        again = known is not None and known.name == name
        runs.append(known if known and again else trial(name, machine, wanted, hinge, turns))
    return runs


def with_flywheel(machine: Machine, wanted: Hinge, inertia: Inertia, turns: Pure) -> Trial:
    """The engine without hinge and with a flywheel, run in time from its steady motion.

    wanted: gives the mean torque for the load; inertia: flywheel on top of what the case keeps.
    """
    mechanism = machine.mechanism
    heavier = _heavier(mechanism, inertia)
    engine = fitted(replace(machine, mechanism=heavier), wanted)
    steady = steady_state(tabulate(reduced(engine)), machine.omega)
    speed = float(steady.omega[0]) if len(steady.omega) else machine.omega
    return run("flywheel", f"no hinge, flywheel of {figure(inertia, 4)} kg m²", engine, speed, turns)


def _heavier(mechanism: Mechanism, inertia: float) -> Mechanism:
    own = mechanism.parameters
    letter = next((r.inertia for r in roles_of(mechanism.name).rotors if r.inertia), None)
    if letter is not None:
        heavy = bind(mechanism.name, {**own, letter: own[letter] + inertia})
        if heavy.inputs == mechanism.inputs:  # nothing was put on its shaft, and no loop was closed
            return heavy
    return with_inertia(mechanism, inertia)

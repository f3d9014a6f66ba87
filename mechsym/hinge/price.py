r"""What the ideal hinge leaves out: friction, heat of the gas, mass of the rollers, and a turn without combustion.

The design is that of a hinge without losses. Here its guide turns with them: friction is a torque over the angle, the
gas takes heat from a wall and gives it back, rollers with mass add inertia,

.. math:: I_h = c\,m_h\,(\rho^2 + \rho'^2), \qquad T = \tfrac12 (I + I_h)\,\omega^2

and the load is lowered by the mean of what is lost. The fill of the spring is set anew for the least ripple.
"""

import dataclasses

import numpy as np

from mechsym.cycle.pressure import unfired, unfired_kinks
from mechsym.hinge.balance import least_ripple
from mechsym.hinge.guide import Guide, fitted
from mechsym.hinge.limits import Contact, at_angles
from mechsym.hinge.rollers import HingeLosses, LossTorques, RollerParameters, friction_torques
from mechsym.hinge.springs.air_thermal import AirThermal
from mechsym.hinge.springs.face import GasTurn
from mechsym.hinge.torque import Hinge
from mechsym.machine.loads import ConstantLoad, Load, PropellerLoad, TableLoad
from mechsym.machine.record import Firing, Machine, firings, lever
from mechsym.quantities import quantity, record
from mechsym.quantities.units import RadPerSecond
from mechsym.simulate import angle
from mechsym.simulate.angle import Panels, ReducedMachine, tabulate
from mechsym.simulate.engine import reduced
from mechsym.simulate.steady import Steady, mean_torque, steady_state

_POINTS = 1440  # angles of a turn of the guide
FILLS = (0.8, 1.3)  #: Fills that are tried, by that of the design


@record
class Price:
    """What a hinge costs that the ideal design does not show."""

    losses: LossTorques
    assumed: HingeLosses  #: friction and heat that were taken
    speed_ripple: float | None = quantity("-", about="steady ripple with losses; None where there is no steady motion")
    fill: float = quantity("-", about="fill of the spring with which it has that ripple, by that of the design")
    tau: float | None = quantity("s", default=None, about="time of the gas to take the wall's temperature")
    gas_index: float | None = quantity("-", default=None, about="index that the gas shows with that time")
    misfire_speed_share: float | None = quantity(
        "-", about="lowest speed after one turn without combustion by the mean before; 0 for a stop"
    )


def price(machine: Machine, wanted: Hinge, guide: Guide, rollers: RollerParameters, given: HingeLosses) -> Price:
    """Losses of a guide, the ripple with them, and what one lost combustion does."""
    theta = np.arange(_POINTS) * 2 * np.pi / _POINTS
    contact = at_angles(guide, rollers, theta)
    taken = friction(contact, guide, rollers, given)
    walled = guide.spring.with_wall(given, guide.omega * guide.parameters.shaft_ratio)
    gas = None if walled is None else gas_turn(contact, guide, walled)
    means = {kind: float(np.mean(curve)) for kind, curve in taken.items()}
    heat = 0.0 if gas is None else max(0.0, guide.parameters.shaft_ratio * gas.loss / (2 * np.pi))
    lost = LossTorques(**means, gas=heat)
    ideal = _with_mass(reduced(fitted(machine, wanted, guide)), guide, contact, rollers)
    fill, ripple = 1.0, None
    # an engine may give less than the hinge takes; what is driven is driven harder
    if lost.total < wanted.load_torque or wanted.load_torque <= 0:
        already = heat if guide.spring.state else 0.0  # its own load is lowered by it
        fill, ripple = _best_fill(ideal, guide, contact, taken, walled, lost.total - already, machine.omega)
    return Price(
        losses=lost, assumed=given, speed_ripple=ripple, fill=fill,
        tau=None if walled is None else walled.tau, gas_index=None if gas is None else gas.n_effective,
        misfire_speed_share=misfire_share(machine, wanted, guide, rollers),
    )  # fmt: skip


def friction(contact: Contact, guide: Guide, rollers: RollerParameters, given: HingeLosses) -> dict[str, np.ndarray]:
    """Torques on the crank that are lost to friction over a turn of the guide, each of shape (n,) [N*m]."""
    ratio, path = guide.parameters.shaft_ratio, (contact.rho, contact.drho, contact.d2rho)
    taken = friction_torques(contact.force, path, guide.omega * ratio, rollers, guide.rollers, given)
    return {kind: ratio * torque for kind, torque in {**taken, "rolling": contact.loss_torque}.items()}


def gas_turn(contact: Contact, guide: Guide, walled: AirThermal) -> GasTurn:
    """The gas of the spring with a wall that takes heat, over a turn of the guide."""
    step = np.full(_POINTS, 2 * np.pi / _POINTS)
    return walled.turn(contact.z, step, guide.omega * guide.parameters.shaft_ratio)


def misfire_share(machine: Machine, wanted: Hinge, guide: Guide | None, rollers: RollerParameters) -> float | None:
    """Lowest speed in one period in which a cylinder does not fire, by the mean speed before; 0 for a stop [-].

    Its gas goes back along the compression line, the load brakes on; of several cylinders the one that costs most. None
    where there is no steady motion before, or the gas is known by its torque only.
    """
    lost, fired = firings(machine), reduced(fitted(machine, wanted, guide))
    if not lost:
        return None
    missed = [_without(machine, fired, one) for one in lost]
    if guide is not None and guide.rho is not None:
        contact = at_angles(guide, rollers, np.arange(_POINTS) * 2 * np.pi / _POINTS)
        fired, *missed = (_with_mass(m, guide, contact, rollers) for m in (fired, *missed))
    before = steady_state(_panels(fired), machine.omega)
    if before.speed_mean is None:
        return None
    lowest = min(_lowest_speed(_panels(fired), m, float(before.omega[0])) for m in missed)
    return lowest / before.speed_mean


def _without(machine: Machine, fired: ReducedMachine, lost: Firing) -> ReducedMachine:
    """The machine in a period in which one cylinder does not fire."""
    cold = unfired(lost.force, lost.period)

    def torque(phi: np.ndarray) -> np.ndarray:
        arm, angle = lever(machine.mechanism, lost.input)(phi), phi - lost.start
        return np.asarray(fired.torque(phi) + lost.sense * (cold(angle) - lost.force(angle)) * arm)

    kinks = {(k + lost.start) % fired.period for k in unfired_kinks(lost.kinks, lost.period)}
    return dataclasses.replace(fired, torque=torque, kinks=tuple({*fired.kinks, *kinks}))


def _lowest_speed(panels: Panels, missed: ReducedMachine, omega: RadPerSecond) -> float:
    """Lowest speed of a period that begins with a speed; 0 for a stop [rad/s]."""
    one = dataclasses.replace(tabulate(missed), load=panels.load)
    turn = angle.turn(one, 0.0, 0.5 * float(one.inertia_edges[0]) * omega**2)
    return 0.0 if angle.lowest_energy(turn) <= 0 else float(angle.speeds(one, 0.0, turn)[1].min())


def _with_mass(machine: ReducedMachine, guide: Guide, contact: Contact, rollers: RollerParameters) -> ReducedMachine:
    if rollers.moving_mass == 0:
        return machine
    ratio = guide.parameters.shaft_ratio
    added = guide.rollers * ratio**2 * rollers.moving_mass * (contact.rho**2 + contact.drho**2)
    return dataclasses.replace(
        machine, inertia=lambda phi: machine.inertia(phi) + _over(contact.theta, added, ratio * np.asarray(phi))
    )


def _over(theta: np.ndarray, values: np.ndarray, at: np.ndarray) -> np.ndarray:
    return np.asarray(np.interp(at % (2 * np.pi), theta, values, period=2 * np.pi))


def _panels(machine: ReducedMachine) -> Panels:
    panels = tabulate(machine)
    if isinstance(machine.load, ConstantLoad):
        return dataclasses.replace(panels, load=ConstantLoad(torque=mean_torque(panels)))
    return panels


def _best_fill(
    ideal: ReducedMachine, guide: Guide, contact: Contact, friction: dict[str, np.ndarray], walled: AirThermal | None,
    lost: float, omega: float,
) -> tuple[float, float | None]:  # fmt: skip
    """Fill of the spring with the least steady ripple, and that ripple [-]; 1 for a coil."""
    taken, ratio, panels = np.sum(list(friction.values()), axis=0), guide.parameters.shaft_ratio, tabulate(ideal)
    gas = None if walled is None else gas_turn(contact, guide, walled)

    def motion(fill: float) -> Steady:
        extra = -taken
        if walled is not None and gas is not None and contact.pressure is not None:
            # the temperature does not know the fill, the pressure is in proportion to it
            pa = walled.pa
            filled = (fill * walled.p0 + pa) / (walled.p0 + pa)
            change = (gas.pressure + pa) * filled - pa - contact.pressure
            extra = extra + ratio * guide.rollers * walled.A * change * contact.drho
        torque = panels.torque + _over(contact.theta, extra, ratio * panels.phi)
        real = dataclasses.replace(panels, torque=torque, load=_lowered(ideal.load, lost))
        if isinstance(real.load, ConstantLoad):
            real = dataclasses.replace(real, load=ConstantLoad(torque=mean_torque(real)))
        return steady_state(real, omega)

    if gas is None:
        return 1.0, motion(1.0).speed_ripple
    return least_ripple(lambda fill: motion(fill).speed_ripple, *FILLS)


def _lowered(load: Load, lost: float) -> Load:
    if isinstance(load, TableLoad):
        return dataclasses.replace(load, torques=tuple(t - lost for t in load.torques))
    if isinstance(load, PropellerLoad) and (load.torque or 0.0) < lost:  # more is lost than it takes: it has to drive
        return ConstantLoad(torque=(load.torque or 0.0) - lost)
    return dataclasses.replace(load, torque=(load.torque or 0.0) - lost)

"""The design put to the test by running it in time, side by side: without hinge, with it, and started 1 per cent fast.

Each run audits its energy and takes the hinge's torque from the geometry of the guide and the law of the spring, never
from the table it was designed from. `steady.py` finds steady motions without running them.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from mechsym.hinge.contact import at_angles
from mechsym.hinge.guide import fitted
from mechsym.hinge.in_time import KINDS, RealHinge, is_real, with_real_hinge
from mechsym.hinge.losses import HingeLosses
from mechsym.hinge.price import friction
from mechsym.hinge.torque import Hinge
from mechsym.machine.loads import ConstantLoad, Load, PropellerLoad
from mechsym.machine.record import Machine, period_of
from mechsym.mechanisms import roles_of
from mechsym.mechanisms.record import Mechanism, bind
from mechsym.mechanisms.shaft import with_inertia
from mechsym.periodic import even_angles
from mechsym.quantities.display import figure
from mechsym.quantities.results import computed, part, quantity, result
from mechsym.quantities.units import Inertia, Pure, RadPerSecond
from mechsym.simulate import Result, Settings, simulate
from mechsym.simulate.angle import tabulate
from mechsym.simulate.engine import problem, reduced
from mechsym.simulate.result import speed_ripple
from mechsym.simulate.steady import steady_state

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

    @computed("-")
    def energy_residual(self) -> float | None:
        """What the balance of energy leaves open."""
        return self.result.energy.residual

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
    found = {}
    for kind, name in KINDS.items():
        column = result.columns.get(name)
        lost = 0.0 if column is None else abs(float(column[-1] - np.interp(since, q, column)))
        found[kind] = lost / (float(q[-1]) - since)
    return found


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

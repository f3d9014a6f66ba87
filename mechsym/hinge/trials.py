"""The design put to the test by running it in time, side by side: without hinge, with it, and started 1 per cent fast.

Each run audits its energy and takes the hinge's torque from the geometry of the guide and the law of the spring, never
from the table it was designed from. `steadiness.py` finds steady motions without running them.
"""

from dataclasses import replace

from mechsym.hinge.fitted import fitted
from mechsym.hinge.guide import Guide
from mechsym.hinge.torque import Hinge
from mechsym.machine.loads import ConstantLoad, Load, PropellerLoad
from mechsym.machine.record import Machine, period_of
from mechsym.mechanisms.record import Mechanism, bind
from mechsym.mechanisms.shaft_inertia import with_inertia
from mechsym.quantities import record
from mechsym.simulate import Result, Settings, simulate
from mechsym.simulate.angle import tabulate
from mechsym.simulate.engine import problem, reduced
from mechsym.simulate.steady import steady_state
from mechsym.simulate.summary import speed_ripple

_LAWS: dict[str, Load] = {"constant": ConstantLoad(), "propeller": PropellerLoad()}


@record
class Trial:
    """One run in time."""

    #: Key, and what is tried in a few words
    name: str
    about: str
    result: Result
    speed_ripple: float | None  #: (max - min) / mean over the last period; None if the shaft stopped before [-]


def run(name: str, about: str, machine: Machine, speed: float, turns: float, settings: Settings | None = None) -> Trial:
    """Run a machine in time from top dead centre.

    Parameters
    ----------
    speed : float
        Speed at the start [rad/s]
    turns : float
        Turns to run [-]
    """
    result = simulate(problem(machine, speed, turns), settings or Settings(check="none"))
    (angle,) = machine.mechanism.coordinates
    stopped = result.event is not None or result.status == "failed"
    ripple = None if stopped else speed_ripple(result, angle, period_of(machine))
    return Trial(name=name, about=about, result=result, speed_ripple=ripple)


def trial(name: str, machine: Machine, wanted: Hinge, guide: Guide, turns: float) -> Trial:
    """One run with a guide.

    Parameters
    ----------
    name : str
        `hinge_constant`, `hinge_propeller`; `off_constant`, `off_propeller` start 1 per cent fast
    turns : float
        Turns to run [-]
    """
    kind, law = name.split("_")
    engine = fitted(replace(machine, load=_LAWS[law]), wanted, guide)
    if kind == "hinge":
        return run(name, f"hinge, {law} load", engine, machine.omega, turns, Settings())
    return run(name, f"hinge, {law} load, started 1 % fast", engine, 1.01 * machine.omega, turns)


def side_by_side(
    machine: Machine, wanted: Hinge, guide: Guide | None, turns: float, known: Trial | None
) -> list[Trial]:
    """The runs of the report: without anything, and the hinge at the design speed and 1 per cent off.

    Parameters
    ----------
    turns : float
        Turns to run [-]
    known : Trial or None
        One of them that has been run

    Returns
    -------
    trials : list of Trial
        Keys without, hinge_constant, off_constant, hinge_propeller, off_propeller
    """
    runs = [run("without", "no hinge, no flywheel", fitted(machine, wanted), machine.omega, turns)]
    if guide is None:
        return runs
    for name in (f"{kind}_{law}" for law in _LAWS for kind in ("hinge", "off")):
        again = known is not None and known.name == name
        runs.append(known if known and again else trial(name, machine, wanted, guide, turns))
    return runs


def with_flywheel(machine: Machine, wanted: Hinge, inertia: float, turns: float) -> Trial:
    """The engine without hinge and with a flywheel, run in time from its steady motion.

    Parameters
    ----------
    wanted : Hinge
        Gives the mean torque for the load
    inertia : float
        Flywheel on top of what the case keeps [kg*m^2]
    turns : float
        Turns to run [-]
    """
    mechanism = machine.mechanism
    heavier = _heavier(mechanism, inertia)
    engine = fitted(replace(machine, mechanism=heavier), wanted)
    steady = steady_state(tabulate(reduced(engine)), machine.omega)
    speed = float(steady.omega[0]) if len(steady.omega) else machine.omega
    return run("flywheel", f"no hinge, flywheel of {inertia:.4g} kg m²", engine, speed, turns)


def _heavier(mechanism: Mechanism, inertia: float) -> Mechanism:
    own = mechanism.parameters
    if "I01" in own:  # inertia about the shaft axis
        return bind(mechanism.name, {**own, "I01": own["I01"] + inertia})
    return with_inertia(mechanism, inertia)

"""The design put to the test by running it in time, side by side: without hinge, with it, and started 1 per cent fast.

Each run audits its energy and takes the hinge's torque from the geometry of the guide and the law of the spring, never
from the table it was designed from. `steadiness.py` finds steady motions without running them.
"""

import dataclasses

from mechsym.hinge.guide import Guide
from mechsym.hinge.torque import Hinge
from mechsym.jobs.machine import Assembly, running
from mechsym.machine.loads import ConstantLoad, Load, PropellerLoad
from mechsym.mechanisms.record import bind
from mechsym.quantities import record
from mechsym.simulate import Result, Settings, simulate
from mechsym.simulate.angle import tabulate
from mechsym.simulate.engine import Engine, machine, problem
from mechsym.simulate.steady import steady_state
from mechsym.simulate.summary import speed_ripple


@record
class Trial:
    """One run in time."""

    #: Key, and what is tried in a few words
    name: str
    about: str
    result: Result
    speed_ripple: float | None  #: (max - min) / mean over the last period; None if the shaft stopped before [-]


def run(name: str, about: str, engine: Engine, speed: float, turns: float, settings: Settings | None = None) -> Trial:
    """Run an engine in time from top dead centre.

    Parameters
    ----------
    speed : float
        Speed at the start [rad/s]
    turns : float
        Turns to run [-]
    """
    result = simulate(problem(engine, speed, turns), settings or Settings(check="none"))
    (angle,) = engine.mechanism.coordinates
    stopped = result.event is not None or result.status == "failed"
    ripple = None if stopped else speed_ripple(result, angle, engine.period)
    return Trial(name=name, about=about, result=result, speed_ripple=ripple)


def side_by_side(assembly: Assembly, wanted: Hinge, guide: Guide | None, load: Load, turns: float) -> list[Trial]:
    """The runs of the report: without anything, and the hinge at the design speed and 1 per cent off.

    Parameters
    ----------
    turns : float
        Turns to run [-]

    Returns
    -------
    trials : list of Trial
        Keys without, hinge_constant, hinge_propeller, off_constant, off_propeller
    """
    omega = assembly.omega
    trials = [run("without", "no hinge, no flywheel", running(assembly, wanted, load), omega, turns)]
    if guide is None:
        return trials
    for law, words in ((ConstantLoad(), "constant load"), (PropellerLoad(), "propeller load")):
        engine, key = running(assembly, wanted, law, guide), words.split()[0]
        trials.append(run(f"hinge_{key}", f"hinge, {words}", engine, omega, turns, Settings()))
        trials.append(run(f"off_{key}", f"hinge, {words}, started 1 % fast", engine, 1.01 * omega, turns))
    return trials


def with_flywheel(assembly: Assembly, wanted: Hinge, load: Load, inertia: float, turns: float) -> Trial:
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
    mechanism = assembly.mechanism
    heavier = bind(mechanism.name, {**mechanism.parameters, "I01": mechanism.parameters["I01"] + inertia})
    engine = running(dataclasses.replace(assembly, mechanism=heavier), wanted, load)
    steady = steady_state(tabulate(machine(engine)), assembly.omega)
    speed = float(steady.omega[0]) if len(steady.omega) else assembly.omega
    return run("flywheel", f"no hinge, flywheel of {inertia:.4g} kg m²", engine, speed, turns)

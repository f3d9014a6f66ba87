"""The design put to the test by running it: side by side with and without hinge, with errors, at another speed.

Each trial runs in time with an energy audit, or finds the steady turn over the angle; both take the hinge's torque from
the geometry of the guide and the law of the spring, never from the table it was designed from.
"""

import dataclasses

import numpy as np
from scipy.optimize import minimize_scalar

from mechsym.assembly import Assembly, running
from mechsym.guide import Guide, Spring
from mechsym.hinge import Hinge
from mechsym.loads import ConstantLoad, Load, PropellerLoad
from mechsym.mechanism import velocities
from mechsym.retune import retune, with_setting
from mechsym.simulate import Result, Settings, simulate
from mechsym.simulate.engine import Engine, machine, problem
from mechsym.simulate.machine import tabulate
from mechsym.simulate.steady import (
    Flywheel,
    Steady,
    flywheel_for_ripple,
    smallest_flywheel_that_turns,
    steady_state,
)
from mechsym.springs import Coil

RIPPLE = 1 / 50


@dataclasses.dataclass(frozen=True, kw_only=True)
class Trial:
    """One run in time.

    Parameters
    ----------
    name, about : str
        Key, and what is tried in a few words
    result : Result
        Series, energy audit, event
    speed_ripple : float or None
        (max - min) / mean over the last period; None if the shaft stopped before [-]
    """

    name: str
    about: str
    result: Result
    speed_ripple: float | None


@dataclasses.dataclass(frozen=True, kw_only=True)
class Flywheels:
    """Flywheels that would do without the hinge, or beside a faulty one.

    Parameters
    ----------
    turns : Flywheel
        Smallest with which the bare engine completes turns at all
    steady : Flywheel
        For a ripple of 1/50 without hinge
    beside_faulty : Flywheel or None
        For a ripple of 1/50 with the hinge when p0 is 2 per cent high; None without a guide
    """

    turns: Flywheel
    steady: Flywheel
    beside_faulty: Flywheel | None


@dataclasses.dataclass(frozen=True, kw_only=True)
class Sensitivity:
    """Ripple for each per cent of error in the spring.

    Parameters
    ----------
    name, unit : str
        Quantity that is off by one per cent, and its unit
    value : float
        Its value as designed [unit]
    low, high : Steady
        Steady motion with the quantity 1 per cent low and high
    """

    name: str
    unit: str
    value: float
    low: Steady
    high: Steady


@dataclasses.dataclass(frozen=True, kw_only=True)
class Retuned:
    """The same guide at another speed with the spring setting that ripples least.

    Parameters
    ----------
    other : Assembly
        Engine at the other speed
    wanted : Hinge
        Torque that it needs there
    spring : record of mechsym.springs
        Spring with the best setting
    setting, ratio : float
        p0 [Pa] (F0 of a coil [N]), and over that of the design [-]
    steady : Steady
        Steady motion with it
    paper : Steady
        Steady motion with the paper's factor 1.9 on the setting
    trial : Trial or None
        Run in time from the design speed; None when no setting turns steadily
    """

    other: Assembly
    wanted: Hinge
    spring: Spring
    setting: float
    ratio: float
    steady: Steady
    paper: Steady
    trial: Trial | None


def run(name: str, about: str, engine: Engine, speed: float, turns: float, settings: Settings | None = None) -> Trial:
    """Run an engine in time from top dead centre.

    Parameters
    ----------
    name, about : str
        Key, and what is tried
    engine : Engine
        Engine with its load
    speed : float
        Speed at the start [rad/s]
    turns : float
        Turns to run [-]
    settings : Settings, optional
        Tolerance and check

    Returns
    -------
    trial : Trial
        Result and ripple
    """
    result = simulate(problem(engine, speed, turns), settings or Settings(check="none"))
    return Trial(name=name, about=about, result=result, speed_ripple=last_ripple(engine, result))


def last_ripple(engine: Engine, result: Result) -> float | None:
    """Ripple of the speed over the last period of a run.

    Parameters
    ----------
    engine : Engine
        What ran
    result : Result
        Its series

    Returns
    -------
    ripple : float or None
        (max - min) / mean [-]; None if the run ended by an event
    """
    if result.event is not None or result.status == "failed":
        return None
    (q,), (u,) = engine.mechanism.coordinates, velocities(engine.mechanism)
    angle, omega = result.columns[q], result.columns[u]
    last = angle >= angle[-1] - engine.period * (1 + 1e-9)
    mean = np.ptp(angle[last]) / np.ptp(result.t[last])
    return float(np.ptp(omega[last]) / mean)


def side_by_side(assembly: Assembly, wanted: Hinge, guide: Guide | None, load: Load, turns: float) -> list[Trial]:
    """The runs of the report: without anything, and the hinge at the design speed and 1 per cent off.

    Parameters
    ----------
    assembly : Assembly
        Engine
    wanted : Hinge
        Designed torque
    guide : Guide or None
        Guide that could be cut
    load : record of mechsym.loads
        Load law of the case
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


def flywheels(assembly: Assembly, wanted: Hinge, guide: Guide | None, load: Load) -> Flywheels:
    """Flywheels that replace the hinge, or that a faulty hinge needs.

    Parameters
    ----------
    assembly : Assembly
        Engine
    wanted : Hinge
        Designed torque
    guide : Guide or None
        Guide that could be cut
    load : record of mechsym.loads
        Load law of the case

    Returns
    -------
    flywheels : Flywheels
        Inertias on top of what the case keeps
    """
    bare = tabulate(machine(running(assembly, wanted, load)))
    faulty = None
    if guide is not None:
        spring = scaled(guide.spring, setting_name(guide.spring), 1.02)
        beside = tabulate(machine(running(assembly, wanted, load, guide, spring)))
        faulty = flywheel_for_ripple(beside, assembly.omega, RIPPLE)
    return Flywheels(
        turns=smallest_flywheel_that_turns(bare, assembly.omega),
        steady=flywheel_for_ripple(bare, assembly.omega, RIPPLE),
        beside_faulty=faulty,
    )


def sensitivities(assembly: Assembly, wanted: Hinge, guide: Guide, load: Load) -> list[Sensitivity]:
    """Steady motion with one quantity of the spring one per cent off.

    Parameters
    ----------
    assembly : Assembly
        Engine
    wanted : Hinge
        Designed torque
    guide : Guide
        Guide that could be cut
    load : record of mechsym.loads
        Load law of the case

    Returns
    -------
    sensitivities : list of Sensitivity
        p0 and n of an air spring, F0 and k of a coil
    """
    found = []
    for name, unit in [("F0", "N"), ("k", "N/m")] if isinstance(guide.spring, Coil) else [("p0", "Pa"), ("n", "-")]:
        low, high = (
            with_spring(assembly, wanted, guide, load, scaled(guide.spring, name, factor)) for factor in (0.99, 1.01)
        )
        found.append(Sensitivity(name=name, unit=unit, value=getattr(guide.spring, name), low=low, high=high))
    return found


def with_spring(assembly: Assembly, wanted: Hinge, guide: Guide, load: Load, spring: Spring) -> Steady:
    """Steady motion with another spring in the guide.

    Parameters
    ----------
    assembly : Assembly
        Engine
    wanted : Hinge
        Gives the mean torque for the load
    guide : Guide
        Guide that could be cut
    load : record of mechsym.loads
        Load law
    spring : record of mechsym.springs
        The spring inside

    Returns
    -------
    steady : Steady
        Motion, or why there is none
    """
    return steady_state(tabulate(machine(running(assembly, wanted, load, guide, spring))), assembly.omega)


def scaled(spring: Spring, name: str, factor: float) -> Spring:
    """The spring with one of its numbers multiplied.

    Parameters
    ----------
    spring : record of mechsym.springs
        A spring
    name : str
        Name of the number
    factor : float
        Factor [-]

    Returns
    -------
    spring : record of mechsym.springs
        Same law
    """
    return dataclasses.replace(spring, **{name: factor * getattr(spring, name)})


def setting_name(spring: Spring) -> str:
    """What is changed to serve another speed.

    Parameters
    ----------
    spring : record of mechsym.springs
        A spring

    Returns
    -------
    name : str
        `F0` of a coil, else `p0`
    """
    return "F0" if isinstance(spring, Coil) else "p0"


def retuned(other: Assembly, wanted: Hinge, guide: Guide, load: Load, turns: float) -> Retuned:
    """The spring setting with the least steady ripple at another speed, and how the engine runs with it.

    Parameters
    ----------
    other : Assembly
        Engine at the other speed
    wanted : Hinge
        Torque that it needs there
    guide : Guide
        Guide as cut for the design speed
    load : record of mechsym.loads
        Load law
    turns : float
        Turns to run in time [-]

    Returns
    -------
    retuned : Retuned
        Setting, ripple, run
    """
    design = getattr(guide.spring, setting_name(guide.spring))
    near = retune(guide, wanted, "least_ripple_propeller_load").setting

    def ripple(setting: float) -> float:
        found = with_spring(other, wanted, guide, load, with_setting(guide.spring, setting)).speed_ripple
        return 2.0 if found is None else found

    bounds = (0.8 * near, 1.25 * near)
    best = float(minimize_scalar(ripple, bounds=bounds, method="bounded", options={"xatol": 1e-4 * near}).x)
    spring = with_setting(guide.spring, best)
    steady = with_spring(other, wanted, guide, load, spring)
    trial = None
    if steady.speed_mean is not None:
        engine = running(other, wanted, load, guide, spring)
        trial = run("retuned", "same guide, best pressure, other speed", engine, float(steady.omega[0]), turns)
    return Retuned(
        other=other,
        wanted=wanted,
        spring=spring,
        setting=best,
        ratio=best / design,
        steady=steady,
        paper=with_spring(other, wanted, guide, load, with_setting(guide.spring, 1.9 * design)),
        trial=trial,
    )

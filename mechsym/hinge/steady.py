"""How steadily an engine turns with its hinge, without one, with a faulty one, and at another speed.

Steady motions are found over the angle of one period; nothing is run in time except the retuned guide. The hinge's
torque comes from the geometry of the guide and the law of the spring.
"""

import dataclasses
import functools

import scipy

from mechsym.hinge.fitted import fitted
from mechsym.hinge.guide import Guide, refit
from mechsym.hinge.in_time import RealHinge
from mechsym.hinge.retune import retune
from mechsym.hinge.setting import setting_of, with_setting
from mechsym.hinge.springs.face import Spring
from mechsym.hinge.torque import Hinge
from mechsym.hinge.trials import Trial, ready, run
from mechsym.machine.loads import ConstantLoad
from mechsym.machine.record import Machine
from mechsym.quantities import record
from mechsym.quantities.units import Pure
from mechsym.simulate.angle import Panels, tabulate
from mechsym.simulate.engine import reduced
from mechsym.simulate.steady import (
    Flywheel,
    Steady,
    flywheel_for_ripple,
    mean_torque,
    smallest_flywheel_that_turns,
    steady_state,
)

RIPPLE = 1 / 50


@record
class Flywheels:
    """Flywheels that would do without the hinge."""

    turns: Flywheel  #: Smallest with which the bare engine completes turns at all
    steady: Flywheel  #: For a ripple of 1/50 without hinge


@record
class Sensitivity:
    """Ripple for each per cent of error in the spring."""

    #: Quantity that is off by one per cent, and its unit
    name: str
    unit: str
    value: float  #: Its value as designed [unit]
    #: Steady motion with the quantity 1 per cent low and high
    low: Steady
    high: Steady


@record
class Retuned:
    """The same guide at another speed with the spring setting that ripples least."""

    other: Machine  #: The machine at that speed
    wanted: Hinge
    spring: Spring
    #: p0 [Pa] (F0 of a coil [N]), and over that of the design [-]
    setting: float
    ratio: float
    steady: Steady
    paper: Steady  #: Steady motion with the paper's factor 1.9 on the setting
    trial: Trial | None  #: Run in time from the design speed; None when no setting turns steadily


# the springs of a sweep share one engine
@functools.lru_cache(maxsize=8)
def flywheels(machine: Machine, wanted: Hinge) -> Flywheels:
    """Flywheels that replace the hinge: inertias on top of what the case keeps."""
    bare = _panels(machine, wanted)
    return Flywheels(
        turns=smallest_flywheel_that_turns(bare, machine.omega),
        steady=flywheel_for_ripple(bare, machine.omega, RIPPLE),
    )


def beside_faulty(machine: Machine, wanted: Hinge, guide: Guide) -> Flywheel:
    """The flywheel for a ripple of 1/50 with a hinge whose p0 is 2 per cent high."""
    spring = with_setting(guide.spring, 1.02 * setting_of(guide.spring))
    return flywheel_for_ripple(_panels(machine, wanted, refit(guide, spring)), machine.omega, RIPPLE)


def sensitivities(machine: Machine, wanted: Hinge, guide: Guide) -> list[Sensitivity]:
    """Steady motion with one quantity of the spring one per cent off.

    Returns sensitivities: p0 and n of an air spring, p0 and tau where it exchanges heat, F0 and k of a coil.
    """
    rows, spring = [], guide.spring
    fields = {field.name: field.metadata for field in dataclasses.fields(spring)}
    for name in spring.sensitive:
        value, least = getattr(spring, name), fields[name]["low"]
        motions = []
        for factor in (0.99, 1.01):
            off = factor * value if least is None else max(factor * value, least)  # n = 1 is isothermal
            changed = dataclasses.replace(spring, **{name: off})
            motions.append(with_guide(machine, wanted, refit(guide, changed)))
        low, high = motions
        rows.append(Sensitivity(name=name, unit=fields[name]["unit"], value=value, low=low, high=high))
    return rows


def with_guide(machine: Machine, wanted: Hinge, guide: Guide) -> Steady:
    """Steady motion with a guide and the spring in it.

    wanted: gives the mean torque for the load. Returns steady: motion, or why there is none.
    """
    return steady_state(_panels(machine, wanted, guide), machine.omega)


def retuned(other: Machine, wanted: Hinge, hinge: RealHinge, turns: Pure) -> Retuned:
    """The spring setting with the least steady ripple at another speed, and how the engine runs with it.

    hinge: guide as cut for the design speed, with what acts on it in time; turns: turns to run in time.
    """
    guide = hinge.guide
    design = setting_of(guide.spring)
    near = retune(guide, wanted, "least_ripple_propeller_load").setting

    def ripple(setting: float) -> float:
        found = with_guide(other, wanted, refit(guide, with_setting(guide.spring, setting))).speed_ripple
        return 2.0 if found is None else found

    bounds = (0.8 * near, 1.25 * near)
    best = float(
        scipy.optimize.minimize_scalar(ripple, bounds=bounds, method="bounded", options={"xatol": 1e-4 * near}).x
    )
    spring = with_setting(guide.spring, best)
    steady = with_guide(other, wanted, refit(guide, spring))
    trial = None
    if steady.speed_mean is not None:
        engine, real = ready(other, wanted, dataclasses.replace(hinge, guide=refit(guide, spring)))
        about = "same guide, best pressure, other speed"
        trial = run("retuned", about, engine, float(steady.omega[0]), turns, real=real)
    return Retuned(
        other=other,
        wanted=wanted,
        spring=spring,
        setting=best,
        ratio=best / design,
        steady=steady,
        paper=with_guide(other, wanted, refit(guide, with_setting(guide.spring, 1.9 * design))),
        trial=trial,
    )


def _panels(machine: Machine, wanted: Hinge, guide: Guide | None = None) -> Panels:
    """The machine over the angle; a constant load without a number is the mean that these very panels integrate."""
    panels = tabulate(reduced(fitted(machine, wanted, guide)))
    if isinstance(machine.load, ConstantLoad) and machine.load.torque is None:
        return dataclasses.replace(panels, load=ConstantLoad(torque=mean_torque(panels)))
    return panels

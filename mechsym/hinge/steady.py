r"""How steadily an engine turns with its hinge, without one, with a faulty one, and at another speed.

Steady motions are found over the angle of one period; nothing is run in time except the retuned guide. The hinge's
torque comes from the geometry of the guide and the law of the spring.

A guide at another speed: which spring setting serves it best, and what remains. The guide stays as it was cut; only the
pressure p0 (the preload F0 of a coil) changes. All laws are affine in that setting s, so torque and work of the guide
are too, and two criteria have a closed form:

.. math:: M_h^*(\varphi; s) = M_0 + s\,M_1, \qquad
          s = \frac{\langle M_h - M_0, M_1\rangle}{\langle M_1, M_1\rangle}

The speed follows the missing work, not the missing torque (see `mechsym.hinge.balance`), so the criteria on work serve
it better.

Source: Zotov et al. (2024), eqs. (12) to (14) and fig. 6, who raise p0 by 1.9 and compare torques by eye.
"""

import dataclasses
import functools
from collections.abc import Callable

import numpy as np

from mechsym.errors import BadInput
from mechsym.hinge.balance import constant_load_speed, or_stopped, propeller_load_speed, ripple
from mechsym.hinge.guide import Affine, Guide, affine, fitted, missing_work, refit, setting_of, with_setting, work_swing
from mechsym.hinge.springs.face import Spring
from mechsym.hinge.torque import Hinge
from mechsym.hinge.trials import RealHinge, Trial, ready, run
from mechsym.machine.loads import ConstantLoad
from mechsym.machine.record import Machine
from mechsym.periodic.roots import minimum
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
    """Steady motion with a guide and its spring, or why there is none. wanted: gives the load's mean torque."""
    return steady_state(_panels(machine, wanted, guide), machine.omega)


def retuned(other: Machine, wanted: Hinge, hinge: RealHinge, turns: Pure) -> Retuned:
    """The spring setting with the least steady ripple at another speed, and how the engine runs with it.

    hinge: guide as cut for the design speed, with what acts on it in time; turns: turns to run in time.
    """
    guide = hinge.guide
    design = setting_of(guide.spring)
    near = retune(guide, wanted, "least_ripple_propeller_load").setting

    def ripple(setting: float) -> float:
        value = with_guide(other, wanted, refit(guide, with_setting(guide.spring, setting))).speed_ripple
        return 2.0 if value is None else value

    best, _ = minimum(ripple, 0.8 * near, 1.25 * near, 1e-4 * near)
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


CRITERIA = (
    "least_squares_torque",
    "least_squares_work",
    "least_work_swing",
    "least_ripple_constant_load",
    "least_ripple_propeller_load",
)


@record
class Retuning:
    """A guide with a new spring setting at another speed."""

    criterion: str
    omega: float  #: Speed that it is for [rad/s]
    setting: float  #: Excess pressure p0 [Pa], or preload F0 of a coil [N]
    spring: Spring
    torque_error: float  #: Root mean square of the missing torque, as a share of that of the wanted torque [-]
    work_swing: float  #: Largest minus smallest missing work [J]
    #: Expected speed ripple; None if the crank would stop [-]
    ripple_constant_load: float | None
    ripple_propeller_load: float | None


def retune(guide: Guide, hinge: Hinge, criterion: str) -> Retuning:
    """Spring setting with which a guide comes nearest to the hinge that another speed needs.

    hinge: torque that the other speed needs. Raises BadInput: unknown criterion.
    """
    # a spring only pushes: where the other speed asks for the opposite torque, the best setting would be negative
    parts, least = affine(guide, hinge), (0.01 * setting_of(guide.spring) if guide.spring.gas else 0.0)
    # the constant of the work is free
    wanted, given = parts.work_wanted - parts.work_0, parts.work_1
    near = max(_projection(wanted - wanted.mean(), given - given.mean()), least)

    def least_of(cost: Callable[[float], float]) -> float:
        return minimum(cost, near / 2, near * 2, 1e-9 * near)[0]

    def least_uneven(ripple: Callable[[Affine, float], float | None]) -> float:
        energy = float(parts.inertia.max()) * parts.omega**2 / 2
        return least_of(lambda s: or_stopped(ripple(parts, s), work_swing(parts, s) / energy))

    match criterion:
        case "least_squares_torque":
            setting = max(_projection(parts.torque_wanted - parts.torque_0, parts.torque_1), least)
        case "least_squares_work":
            setting = near
        case "least_work_swing":
            setting = least_of(lambda s: work_swing(parts, s))
        case "least_ripple_constant_load":
            setting = least_uneven(_ripple_constant)
        case "least_ripple_propeller_load":
            setting = least_uneven(_ripple_propeller)
        case _:
            raise BadInput(f"criterion {criterion!r} is not an option; options are {', '.join(CRITERIA)}")
    return at_setting(guide, hinge, setting, criterion)


def at_setting(guide: Guide, hinge: Hinge, setting: float, criterion: str = "given") -> Retuning:
    """What remains when a guide works at another speed with a given spring setting.

    hinge: torque that the other speed needs; setting: p0 [Pa], or F0 of a coil [N]; criterion: where the setting comes
    from, for the record.
    """
    parts = affine(guide, hinge)
    missing = parts.torque_wanted - parts.torque_0 - setting * parts.torque_1
    return Retuning(
        criterion=criterion,
        omega=hinge.omega,
        setting=setting,
        spring=with_setting(guide.spring, setting),
        torque_error=float(np.sqrt(np.mean(missing**2) / np.mean(parts.torque_wanted**2))),
        work_swing=work_swing(parts, setting),
        ripple_constant_load=_ripple_constant(parts, setting),
        ripple_propeller_load=_ripple_propeller(parts, setting),
    )


def _projection(wanted: np.ndarray, given: np.ndarray) -> float:
    return float(np.dot(wanted, given) / np.dot(given, given))


def _ripple_constant(parts: Affine, setting: float) -> float | None:
    return ripple(constant_load_speed(missing_work(parts, setting), parts.inertia, parts.omega))


def _ripple_propeller(parts: Affine, setting: float) -> float | None:
    missing = missing_work(parts, setting)
    return ripple(propeller_load_speed(missing, parts.inertia, parts.omega, parts.load_torque, parts.period))

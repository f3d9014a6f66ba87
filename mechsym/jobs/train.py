"""What acts on the crank train of a case: gas on every piston, a torque at the free end, the load at the flywheel.

    M_drive --> [throw 1]--[throw 2]-- ... --[throw N]--[flywheel] <-- M (load law of the flywheel's speed)
                   ^ F1       ^ F2              ^ FN
                   each gas force follows the angle of its own throw, twist included

Sections of a case: `[drive]` (input left out: the free end), `[cycle]`, `[load]`; at least one of the first two.
"""

import math

import numpy as np

from mechsym.cases import Case
from mechsym.cycle.gas import Gas
from mechsym.cycle.kinds import kind_of
from mechsym.errors import BadInput
from mechsym.jobs.gas import gas
from mechsym.jobs.turn import turn
from mechsym.machine.loads import Load, PropellerLoad, settle
from mechsym.mechanisms.crank_train.firing import refuse_wrong_firing
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each
from mechsym.mechanisms.traits import is_train
from mechsym.quantities import record
from mechsym.simulate.problem import Kinks, Part, Periodic


@record
class Cylinders:
    """Gas forces of a crank train."""

    parts: tuple[Part, ...] = ()  #: One a cylinder, `gas_1` and so on
    kinks: tuple[Kinks, ...] = ()  #: One a throw whose gas force is not smooth
    torque: float = 0.0  #: Their mean torque on the shaft [N*m]


def cylinders(case: Case) -> Cylinders:
    """Gas forces of a crank train.

    Parameters
    ----------
    case : Case
        Perhaps with `[cycle]`; without it no gas acts

    Returns
    -------
    cylinders : Cylinders
        Over the angle of each cylinder's own throw

    Raises
    ------
    BadInput
        A cycle that follows the speed, or pistons on two throws that share one gas
    """
    if "cycle" not in case.sections:
        return Cylinders()
    if kind_of(case.sections["cycle"]).given == "engine":
        raise BadInput(f"{case.file}: spark ignition follows the motion; use 'mechsym cycle CASE --loop CYCLES'")
    found, parameters = gas(case), case.need("parameters")
    assert found is not None
    starts = _starts(case, found, parameters)
    rows = enumerate(zip(parameters.throw, starts, strict=True))
    parts = [_part(found, i, throw, start) for i, (throw, start) in rows]
    mean = float(np.mean(turn(case).torque))
    return Cylinders(parts=tuple(parts), kinks=_kinks(found, parameters, starts), torque=mean)


def _starts(case: Case, found: Gas, parameters: CrankTrainParameters) -> tuple[float, ...]:
    """Shaft angle at which each cylinder's pressure has its angle 0."""
    if not found.pistons:
        refuse_wrong_firing(parameters, found.pressure.period)
        return each(parameters, "firing")
    if len(set(parameters.throw)) > 1:
        raise BadInput(
            f"{case.file}: throw = {list(parameters.throw)}: the twist between throws would change the volume of a gas "
            "that both cylinders share; put them on one throw"
        )
    return (0.0,) * len(parameters.throw)


def _part(found: Gas, index: int, throw: int, start: float) -> Part:
    share = found.pistons[index] / found.chamber.area if found.pistons else 1.0

    def force(phi: np.ndarray) -> np.ndarray:
        return found.force(phi - start) * share

    kinks = tuple(sorted((k + start) % found.pressure.period for k in found.pressure.kinks))
    value = Periodic(coordinate=f"phi{throw}", value=force, period=found.pressure.period, kinks=kinks)
    return Part(name=f"gas_{index + 1}", input=f"F{index + 1}", value=value)


def _kinks(found: Gas, parameters: CrankTrainParameters, starts: tuple[float, ...]) -> tuple[Kinks, ...]:
    rows = []
    for throw in range(1, max(parameters.throw) + 1):
        own = [s for t, s in zip(parameters.throw, starts, strict=True) if t == throw]
        angles = sorted({(k + start) % found.pressure.period for start in own for k in found.pressure.kinks})
        if angles:
            rows.append(Kinks(coordinate=f"phi{throw}", angles=tuple(angles), period=found.pressure.period))
    return tuple(rows)


def load(case: Case, torque: float, speed_start: float) -> Load | None:
    """The law of the load at the flywheel.

    Parameters
    ----------
    case : Case
        Perhaps with `[load]`
    torque : float
        Mean torque of gas and drive, for a law without its own [N*m]
    speed_start : float
        Speed at the start [rad/s]

    Raises
    ------
    BadInput
        A law that pulls a shaft at rest backwards
    """
    if "load" not in case.sections:
        return None
    law = case.sections["load"]
    if speed_start <= 0 and not isinstance(law, PropellerLoad):
        raise BadInput(
            f"{case.file}: a load with a torque at rest would pull the shaft backwards; give simulation.speed_start "
            "above 0 rad/s or [load] law = 'propeller'"
        )
    blank = isinstance(law, PropellerLoad) and law.speed is None
    return settle(law, torque, case.need("operation").speed if blank else math.nan)


def remarks(case: Case) -> tuple[str, ...]:
    """What a reader of a run should know about a crank train."""
    if not is_train(case.mechanism) or {"load", "cycle"} & set(case.sections):
        return ()
    return ("there is no [load]: nothing brakes the flywheel, and the speed is not that of steady running",)

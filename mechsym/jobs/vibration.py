"""Case -> criticals of its crank train: gas of a turn on the elastic shaft, at the speed of operation."""

from collections.abc import Callable

import numpy as np

from mechsym.cases import Case
from mechsym.forces.turn import Turn
from mechsym.jobs.turn import turn
from mechsym.mechanisms.traits import is_train
from mechsym.torsion.train import ShaftLimits, TrainVibration, operating_range
from mechsym.torsion.train import vibration as vibration_of


def vibration(case: Case, one: Turn | None = None) -> TrainVibration | None:
    """Natural frequencies, criticals and steady vibration of a crank train; None for every other mechanism.

    Parameters
    ----------
    case : Case
        With `[operation]`; `[cycle]` excites beside the masses, `[speeds]` is the operating range, `[shaft]` its limits
    one : Turn, optional
        A cycle of it at constant speed, when there is one already
    """
    if not is_train(case.mechanism) or "operation" not in case.sections:
        return None
    one, given, wanted = one or turn(case), case.sections.get("speeds"), case.sections.get("simulation")
    span = None if given is None else (given.lowest, given.highest)
    gas = {name: _over(one, push) for name, push in one.inputs.items()}
    speeds = operating_range(one.omega, getattr(wanted, "speed_start", None), span)
    return vibration_of(case.need("parameters"), gas, one.period, speeds, case.sections.get("shaft", ShaftLimits()))


def _over(one: Turn, push: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    return lambda phi: np.interp(phi, one.phi, push, period=one.period)

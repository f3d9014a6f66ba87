"""`mechsym cycle`: the engine of a case and its figures over the speeds."""

from dataclasses import replace
from typing import Any

import numpy as np

from mechsym.cases import Case
from mechsym.cases.settings import Speeds
from mechsym.cycle.closed.model import ClosedEngine
from mechsym.cycle.figures import cylinder_columns
from mechsym.cycle.friction import Friction, MechanismFriction, NoFriction
from mechsym.jobs.gas import engine_with, of, one_cylinder
from mechsym.jobs.turn import fitted_law

_FRICTION_SPEEDS = (0.25, 0.5, 0.75, 1.0)  # of the speed of operation, where a mechanism's friction is looked up


def engine(case: Case) -> ClosedEngine:
    """The engine that a case describes.

    Parameters
    ----------
    case : Case
        As for `engine_with`; `[friction_pressure]` defaults to no friction, its law `mechanism` is fitted to the
        case's `[friction]`

    Raises
    ------
    BadInput
        A section is missing, or the cycle is of another kind
    """
    return engine_with(case, _friction(case))


def _friction(case: Case) -> Friction:
    law = case.sections.get("friction_pressure", NoFriction())
    if not isinstance(law, MechanismFriction):
        return law
    # the friction hangs on the gas forces, and those not on the friction
    plain = replace(case, sections={**case.sections, "friction_pressure": NoFriction()})
    return fitted_law(plain, case.need("operation").speed * np.array(_FRICTION_SPEEDS)).law


def columns_of_cylinder(case: Case, omega: np.ndarray) -> dict[str, Any]:
    """Figures of a case whose cycle is no engine's but one cylinder's, over the speeds.

    Parameters
    ----------
    case : Case
        With a cycle of kind `two-stroke-marine` or `two-stroke-zone`
    omega : ndarray, shape (n,)
        Crank speeds [rad/s]
    """
    seen = one_cylinder(case)
    with of(case):
        return cylinder_columns(case.need("cycle"), seen.mechanism, seen.need("parameters"), omega)


def speed_range(speeds: Speeds) -> np.ndarray:
    """The speeds of a performance map.

    Parameters
    ----------
    speeds : Speeds
        Section `[speeds]` of a case

    Returns
    -------
    omega : ndarray, shape (n,)
        lowest, lowest + step, .. up to highest [rad/s]
    """
    count = int((speeds.highest - speeds.lowest) / speeds.step + 1e-9) + 1
    return speeds.lowest + speeds.step * np.arange(count)

r"""A guide at another speed: which spring setting serves it best, and what remains.

The guide stays as it was cut; only the pressure p0 (the preload F0 of a coil) changes. All laws are affine in that
setting s, so torque and work of the guide are too, and two criteria have a closed form:

.. math:: M_h^*(\varphi; s) = M_0 + s\,M_1, \qquad
          s = \frac{\langle M_h - M_0, M_1\rangle}{\langle M_1, M_1\rangle}

The speed follows the missing work, not the missing torque (see `mechsym.hinge.ripple`), so the criteria on work serve
it better.

Source: Zotov et al. (2024), eqs. (12) to (14) and fig. 6, who raise p0 by 1.9 and compare torques by eye.
"""

from collections.abc import Callable

import numpy as np
import scipy

from mechsym.errors import BadInput
from mechsym.hinge.guide import Guide
from mechsym.hinge.ripple import constant_load_speed, propeller_load_speed, ripple
from mechsym.hinge.setting import Affine, affine, missing_work, setting_of, with_setting, work_swing
from mechsym.hinge.springs.face import Spring
from mechsym.hinge.torque import Hinge
from mechsym.quantities import record

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
    parts, least = affine(guide, hinge), _least_setting(guide.spring)
    near = max(_least_squares_work(parts), least)
    match criterion:
        case "least_squares_torque":
            setting = max(_projection(parts.torque_wanted - parts.torque_0, parts.torque_1), least)
        case "least_squares_work":
            setting = near
        case "least_work_swing":
            setting = _minimum(lambda s: work_swing(parts, s), near)
        case "least_ripple_constant_load":
            setting = _minimum(lambda s: _or_more(_ripple_constant(parts, s), parts, s), near)
        case "least_ripple_propeller_load":
            setting = _minimum(lambda s: _or_more(_ripple_propeller(parts, s), parts, s), near)
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


def _least_setting(spring: Spring) -> float:
    # a spring only pushes: where the other speed asks for the opposite torque, the best setting would be negative
    return 0.01 * setting_of(spring) if spring.gas else 0.0


def _projection(wanted: np.ndarray, given: np.ndarray) -> float:
    return float(np.dot(wanted, given) / np.dot(given, given))


def _least_squares_work(parts: Affine) -> float:
    # the constant of the work is free
    wanted, given = parts.work_wanted - parts.work_0, parts.work_1
    return _projection(wanted - wanted.mean(), given - given.mean())


def _minimum(cost: Callable[[float], float], near: float) -> float:
    found = scipy.optimize.minimize_scalar(
        cost, bounds=(near / 2, near * 2), method="bounded", options={"xatol": 1e-9 * near}
    )
    return float(found.x)


def _ripple_constant(parts: Affine, setting: float) -> float | None:
    return ripple(constant_load_speed(missing_work(parts, setting), parts.inertia, parts.omega))


def _ripple_propeller(parts: Affine, setting: float) -> float | None:
    missing = missing_work(parts, setting)
    return ripple(propeller_load_speed(missing, parts.inertia, parts.omega, parts.load_torque, parts.period))


def _or_more(ripple: float | None, parts: Affine, setting: float) -> float:
    """Where the crank would stop, something that is larger than any ripple and still falls with the missing work."""
    energy = float(parts.inertia.max()) * parts.omega**2 / 2
    return 10 + work_swing(parts, setting) / energy if ripple is None else ripple

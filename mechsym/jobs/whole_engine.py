"""From one cylinder's figures to the engine's: how many there are, what adds up, and the largest torque at the shaft.

Cycles are computed for one cylinder. Power and mean torque of equal cylinders add; their largest torques do not, for
they fire one after the other, so that one is taken from the whole mechanism at constant speed, with all its masses.
"""

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from mechsym.cases import Case
from mechsym.cycle.kinds import kind_of
from mechsym.cycle.motion import from_top, piston_roles, slopes
from mechsym.errors import BadInput
from mechsym.forces.turn import shaft_torque
from mechsym.jobs import own_turn
from mechsym.jobs.gas import gas, of
from mechsym.jobs.own import is_own, one_coordinate
from mechsym.jobs.turn import drive_of
from mechsym.mechanisms.crank_train.firing import refuse_wrong_firing
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each
from mechsym.mechanisms.traits import is_train, with_trait
from mechsym.quantities import record

_ADD = ("torque_avg", "power_kw", "brake_torque", "brake_power_kw")
_NOT_LARGER = "torque_max"
_ALIKE = 1e-9  # of the stroke: pistons whose travels differ by less move alike
_SAME = ("r", "l1", "l2", "offset")


@record
class CylinderCount:
    """The cylinders of an engine as its cycle counts them."""

    count: int  #: Chambers of a crank train, working faces of a rodless engine
    share: float  #: What one cylinder's figures are multiplied with for the engine [-]
    each: str = "cylinder"  #: What is counted: a cylinder, or a piston where two share one


def cylinders(case: Case) -> CylinderCount:
    """The cylinders of a case.

    Raises
    ------
    BadInput
        They fire off their dead centres, move differently, or the pistons of a chamber do not divide them
    """
    parameters = case.need("parameters")
    if is_own(case.mechanism):
        return _own(case)
    if "faces" in case.sections and case.mechanism in with_trait(lambda known: known.chain and known.chain.areas):
        areas = case.need("faces").areas
        bore = getattr(case.sections.get("chamber"), "bore", None) or case.need("cycle").bore
        return CylinderCount(count=len(areas), share=sum(areas) / (math.pi / 4 * float(bore) ** 2))
    if not is_train(case.mechanism):
        return CylinderCount(count=1, share=1.0)
    with of(case):
        _refuse_unlike(case, parameters)
    count = len(parameters.throw) // int(getattr(case.sections.get("chamber"), "pistons", 1))
    return CylinderCount(count=count, share=float(count), each="piston" if _face_each_other(parameters) else "cylinder")


def _face_each_other(parameters: CrankTrainParameters) -> bool:
    """Whether the pistons of a crank train stand in pairs on one axis, each towards the other's crank."""
    bank, at = (np.asarray(each(parameters, name)) for name in ("bank", "axis_x"))
    throw, across = np.asarray(parameters.throw) - 1, np.asarray(each(parameters, "axis_y"))
    place, along = at[throw] + 1j * across[throw], np.asarray(each(parameters, "z"))[throw]

    def faces(i: int, k: int) -> bool:
        way = (place[k] - place[i]) * np.exp(-1j * bank[i])  # from crank to crank, along the first one's axis
        turned = abs(np.exp(1j * (bank[k] - bank[i])) + 1) < _ALIKE
        return bool(turned and along[i] == along[k] and way.real > 0 and abs(way.imag) < _ALIKE * way.real)

    pistons = range(len(throw))
    return all(any(faces(i, k) for k in pistons if k != i) for i in pistons)


def piston_travels(case: Case) -> dict[str, np.ndarray]:
    """Travel of each piston of a declaration over a turn, from its own top dead centre on [m]."""
    with of(case):
        roles, mechanism = piston_roles(case.mechanism), one_coordinate(case)
    phi = np.linspace(0, 2 * math.pi, 73)[None, :]
    moved = {role["name"]: from_top(slopes(mechanism, role["travel"], {})) for role in roles}
    return {name: np.asarray(travel.call([phi])[0]).ravel() for name, travel in moved.items()}


def other_piston(case: Case) -> str:
    """The first piston of a declaration that moves otherwise than its first one; empty where all move alike."""
    if not is_own(case.mechanism):
        return ""
    travels = piston_travels(case)
    first = next(iter(travels.values()))
    far = (n for n, travel in travels.items() if np.abs(travel - first).max() > _ALIKE * np.ptp(first))
    return next(far, "")


def _own(case: Case) -> CylinderCount:
    with of(case):
        roles = piston_roles(case.mechanism)
    if other := other_piston(case):
        raise BadInput(
            f"{case.file}: piston {other} moves otherwise than {roles[0]['name']}: this is computed for one of them "
            "and holds for equal cylinders; use 'mechsym cycle' without --over, 'mechsym forces' or 'mechsym simulate'"
        )
    pistons = getattr(case.sections.get("chamber"), "pistons", 1)
    count = max(1, len(roles) // int(pistons))
    return CylinderCount(count=count, share=float(count))


def _refuse_unlike(case: Case, parameters: CrankTrainParameters) -> None:
    four_stroke = kind_of(case.need("cycle")).given in ("engine", "breathing")
    refuse_wrong_firing(parameters, 4 * math.pi if four_stroke else 2 * math.pi)
    count, pistons = len(parameters.throw), getattr(case.sections.get("chamber"), "pistons", 1)
    if count % pistons:
        raise BadInput(f"[chamber] pistons = {pistons} does not divide the {count} cylinders; give 1 or a divisor")
    for name in _SAME:
        if len(set(each(parameters, name))) > 1:
            raise BadInput(
                f"{name} differs between the cylinders: the cycle is computed for one of them and holds for equal "
                "cylinders; give one value, or use 'mechsym forces'"
            )


def of_engine(case: Case, found: Mapping[str, Any], omega: Sequence[float] | np.ndarray | None) -> dict[str, Any]:
    """Figures of the whole engine from those of one cylinder (`cycle.columns`), which stand beside them.

    Parameters
    ----------
    omega : ndarray, shape (n,)
        Crank speeds; None leaves the largest torque of several cylinders open [rad/s]

    Returns
    -------
    figures : dict
        The same columns for the engine, `cylinders`, and `per_cylinder` with those that differ
    """
    counted = cylinders(case)
    own = {name: found[name] for name in (*_ADD, _NOT_LARGER) if name in found}
    if counted.count == 1:
        if is_train(case.mechanism) and omega is not None and _NOT_LARGER in found:  # with the rod's mass
            found = {**found, _NOT_LARGER: largest_torque(case, omega)}
        return {**found, "cylinders": 1, "each": counted.each, "per_cylinder": own}
    whole = {name: np.asarray(found[name]) * counted.share for name in _ADD if name in found}
    whole[_NOT_LARGER] = np.full(np.shape(found[_NOT_LARGER]), np.nan) if omega is None else largest_torque(case, omega)
    return {**found, **whole, "cylinders": counted.count, "each": counted.each, "per_cylinder": own}


def largest_torque(case: Case, omega: Sequence[float] | np.ndarray) -> np.ndarray:
    """Largest torque of the whole mechanism on the shaft at each of some speeds [rad/s]: [N*m]."""
    operation = case.need("operation")
    found = []
    for speed in omega:
        there = dataclasses.replace(operation, speed=float(speed))
        at = dataclasses.replace(case, sections={**case.sections, "operation": there})
        found.append(float(_shaft_torque(at, float(speed)).max()))
    return np.array(found)


def _shaft_torque(case: Case, speed: float) -> np.ndarray:
    if is_own(case.mechanism):
        return -own_turn.turn(case).columns["driving_torque"]
    return shaft_torque(drive_of(case), gas(case), speed)

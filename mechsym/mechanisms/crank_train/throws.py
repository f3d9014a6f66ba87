"""The derived throw, instantiated: the crank of every throw alone, and one instance for every cylinder."""

import dataclasses
from collections.abc import Mapping

from mechsym.mechanisms.crank_train.articulated import top
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each, hung_letters, local_shift, tilt
from mechsym.quantities import record

_CRANK = ("I0", "m0", "u0")
_CYLINDER = ("r", "l1", "l2", "offset", "m_rod", "I_rod", "m_piston")


@record
class ThrowPart:
    """One instance of the derived throw: the crank of a throw alone, or a cylinder on it."""

    cylinder: int  #: Number of the cylinder, 0 for a crank alone
    throw: int  #: Index of its throw from 0
    shift: float  #: Its own crank angle at shaft angle 0 [rad]
    #: Angle of its x axis [rad], and its sense of rotation
    bank: float
    sense: float
    axis: tuple[float, float]  #: Place of the shaft axis [m]
    z: float  #: Position along the shaft [m]
    letters: Mapping[str, float]
    master: int = 0  #: Cylinder on whose rod its rod hangs, 0 for one on a crank pin


def parts(p: CrankTrainParameters) -> list[ThrowPart]:
    """The instances: one a throw, then one a cylinder, those whose rods hang on others last."""
    nothing = dict.fromkeys((*_CRANK, *_CYLINDER), 0.0)
    found = []
    for k in range(max(p.throw)):
        # a throw without rod and piston; its lengths do not matter
        letters = nothing | {"r": 1.0, "l1": 1.0, "l2": 1.0} | {n: each(p, n)[k] for n in _CRANK}
        found.append(_part(p, 0, k, each(p, "u_phase")[k], 0.0, letters))
    shifts, banks, hung = local_shift(p), each(p, "bank"), []
    for i, (k, master) in enumerate(zip(p.throw, each(p, "master"), strict=True)):
        if master:  # in the axes of the cylinder that carries it
            m, own = int(master) - 1, hung_letters(p, i)
            part = _part(p, i + 1, k - 1, shifts[m], banks[m], own | {"top": top(own)[1]})
            hung.append(dataclasses.replace(part, master=m + 1))
        else:
            letters = nothing | {n: each(p, n)[i] for n in _CYLINDER}
            found.append(_part(p, i + 1, k - 1, shifts[i], banks[i], letters))
    return found + hung


def _part(
    p: CrankTrainParameters, cylinder: int, k: int, shift: float, bank: float, letters: dict[str, float]
) -> ThrowPart:
    sense = each(p, "sense")[k]
    return ThrowPart(
        cylinder=cylinder,
        throw=k,
        shift=shift,
        bank=bank,
        sense=sense,
        axis=(each(p, "axis_x")[k], each(p, "axis_y")[k]),
        z=each(p, "z")[k] + (each(p, "z_rod")[cylinder - 1] if cylinder else 0.0),
        letters=letters | {"g": p.g, "axis_tilt": tilt(p, bank, sense)},
    )

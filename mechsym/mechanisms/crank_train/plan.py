"""What a crank train answers for: its parts and their roles, its proportions, what one cylinder sees."""

import math
from itertools import combinations

import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.crank_throw import NAME as THROW
from mechsym.mechanisms.crank_throw import CrankThrowParameters
from mechsym.mechanisms.crank_train.assembly import build, build_rigid, listing
from mechsym.mechanisms.crank_train.firing import refuse_wrong_firing
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, dead_centre, each, local_shift
from mechsym.mechanisms.plan import AssembledMechanism
from mechsym.mechanisms.proportions import Proportions, Reciprocating
from mechsym.mechanisms.roles import BearingRole, FaceRole, GuideRole, PartRoles, RotorRole, ShaftRole
from mechsym.mechanisms.train_drawing import crank_train
from mechsym.quantities.records import Record

_AXIS = 1e-9  # rad, and of a distance: axes that differ by less are one


def roles(p: CrankTrainParameters) -> PartRoles:
    """Roles of a train on a rigid shaft."""
    cylinders, firing = range(1, len(p.throw) + 1), each(p, "firing") or (0.0,) * len(p.throw)
    pins = [bearing for i in cylinders for bearing in _pins(p, i)]
    mains = [_main(p, k) for k in sorted(set(p.throw))]
    tops = [top - shift for top, shift in zip(dead_centre(p), local_shift(p), strict=True)]
    # torque of the weight of all throws, by the angle of the shaft [N*m]
    rows = zip(*(each(p, name) for name in ("u0", "u_phase", "sense")), strict=True)
    terms = [
        f"({-p.g * u * sense!r})*cos(({sense!r})*(phi + ({phase!r})) + ({p.axis_tilt!r}))" for u, phase, sense in rows
    ]
    return PartRoles(
        faces=tuple(
            FaceRole(
                name=f"{i}",
                travel=f"x_{i}",
                force=f"F{i}",
                fires=firing[i - 1],
                throw=p.throw[i - 1] - 1,
                masses=(each(p, "m_piston")[i - 1],),
                top=tops[i - 1] if each(p, "master")[i - 1] else None,
            )
            for i in cylinders
        ),
        rotors=(RotorRole(name="flywheel", angle="phi", load="M", inertia="I_f", weight=" + ".join(terms)),),
        guides=tuple(
            GuideRole(
                name=f"side_force_{i}", reaction=f"side_force_{i}", travel=f"x_{i}", at="guides", way=_ways(p, i)[1]
            )
            for i in cylinders
        ),
        bearings=(*pins, *mains),
        shafts=(ShaftRole(name="shaft", discs=(*each(p, "I0"), p.I_f), stiffness=each(p, "k"), damping=each(p, "c")),),
        opposed=_opposed(p),
    )


def _opposed(p: CrankTrainParameters) -> bool:
    """Whether the pistons stand in pairs on one axis, each towards the other's crank."""
    bank, at, across, z = (np.asarray(each(p, name)) for name in ("bank", "axis_x", "axis_y", "z"))
    throw = np.asarray(p.throw) - 1
    place, along = (at + 1j * across)[throw], z[throw]

    def faces(i: int, k: int) -> bool:
        way = (place[k] - place[i]) * np.exp(-1j * bank[i])  # from crank to crank, along the first one's axis
        turned = abs(np.exp(1j * (bank[k] - bank[i])) + 1) < _AXIS
        return bool(turned and along[i] == along[k] and way.real > 0 and abs(way.imag) < _AXIS * way.real)

    pistons = range(len(throw))
    return all(any(faces(i, k) for k in pistons if k != i) for i in pistons)


def _pins(p: CrankTrainParameters, i: int) -> tuple[BearingRole, BearingRole]:
    piston_pin = BearingRole(
        name=f"piston_pin_{i}", at="piston_pins", turns=f"psi_{i}",
        reactions=(f"piston_pin_force_along_{i}", f"piston_pin_force_across_{i}"), ways=_ways(p, i),
    )  # fmt: skip
    if each(p, "master")[i - 1]:
        knuckle = BearingRole(
            name=f"knuckle_pin_{i}", at="piston_pins", turns=f"knuckle_{i}",
            reactions=(f"knuckle_force_x_{i}", f"knuckle_force_y_{i}"),
        )  # fmt: skip
        return piston_pin, knuckle
    return (
        piston_pin,
        BearingRole(
            name=f"crank_pin_{i}", at="crank_pins", turns=("phi", f"psi_{i}"), throw=each(p, "r")[i - 1],
            phase=each(p, "phase")[i - 1], sense=each(p, "sense")[p.throw[i - 1] - 1],
            z=each(p, "z")[p.throw[i - 1] - 1] + each(p, "z_rod")[i - 1], main=f"main_bearing_{p.throw[i - 1]}",
            reactions=(f"pin_force_x_{i}", f"pin_force_y_{i}"),
        ),
    )  # fmt: skip


def _ways(p: CrankTrainParameters, i: int) -> tuple[float, float]:
    """Along the cylinder, and across it in the sense of rotation [rad]."""
    bank = each(p, "bank")[i - 1]
    return bank, bank + each(p, "sense")[p.throw[i - 1] - 1] * math.pi / 2


def _main(p: CrankTrainParameters, k: int) -> BearingRole:
    return BearingRole(
        name=f"main_bearing_{k}",
        at="main_bearings",
        turns=("phi",),
        sense=each(p, "sense")[k - 1],
        z=each(p, "z")[k - 1],
        reactions=(f"main_bearing_force_x_{k}", f"main_bearing_force_y_{k}"),
    )


def _alone(p: CrankTrainParameters) -> tuple[str, Record]:
    """The first cylinder whose rod is on a crank pin, on a shaft of its own."""
    if any(each(p, "offset")):
        raise BadInput(
            f"offset = {max(each(p, 'offset'), key=abs):g} m: the cycles of a crank train know dead centres half a "
            "turn apart; set offset = 0 or leave [cycle] out"
        )
    first = next(i for i, master in enumerate(each(p, "master")) if not master)
    letters = {n: each(p, n)[first] for n in ("r", "l1", "l2", "offset", "m_rod", "I_rod", "m_piston")}
    return THROW, CrankThrowParameters(**letters, I0=each(p, "I0")[p.throw[first] - 1])


def _proportions(p: CrankTrainParameters) -> Proportions:
    masses = p.m_piston if isinstance(p.m_piston, tuple) else (p.m_piston,)
    named = ("m_piston",) if not masses[1:] else tuple(f"m_piston[{i}]" for i in range(len(masses)))
    moving = tuple(Reciprocating(letters=letters, mass=mass) for letters, mass in zip(named, masses, strict=True))
    r, l1, l2, m0, m_rod, piston = (max(each(p, letter)) for letter in ("r", "l1", "l2", "m0", "m_rod", "m_piston"))
    return Proportions(
        stroke=2 * r, rod_ratio=(l1 + l2) / r, moving=moving, mass=m0 + m_rod + piston,
        shafts={"I0": max(each(p, "I0")), "I_f": p.I_f}, flywheel="I_f",
        parts={"I_rod": (max(each(p, "I_rod")), m_rod * (l1 + l2) ** 2)},
        ends={"I_rod": max(each(p, "I_rod")) / (m_rod * l1 * l2)} if m_rod * l1 * l2 else {},
        unbalances={"u0": max(each(p, "u0"), key=abs)}, pistons=len(p.throw), pitch=pitch(p), span=span(p),
        unequal=unequal(p),
    )  # fmt: skip


PLAN = AssembledMechanism(
    theory=THROW, parameters=CrankTrainParameters, build=build, rigid=lambda p, guesses: build_rigid(p),
    listing=listing, parts=roles, alone=_alone, proportions=_proportions, require_firing=refuse_wrong_firing,
    shapes=crank_train,
)  # fmt: skip


_ALIKE = ("r", "l1", "l2", "m_rod", "m_piston", "I_rod", "I0", "m0")
_Place = tuple[float, float, float]


def pitch(p: CrankTrainParameters) -> tuple[float, float] | None:
    """Distances of cylinders on one shaft from their next, the least and the largest, at half stroke; None where throws
    have no place along it [m].
    """
    if not any(each(p, "z")):
        return None
    at = [_shaft(p, i) for i in range(len(p.throw))]
    middles = [_half(p, i) for i in range(len(p.throw))]
    numbers = range(len(middles))
    beside = [[math.dist(middles[i], middles[j]) for j in numbers if i != j and at[i] == at[j]] for i in numbers]
    near = [min(distances) for distances in beside if distances]
    return (min(near), max(near)) if near else None


def unequal(p: CrankTrainParameters) -> dict[str, float]:
    """Largest over least of what is alike in all cylinders and throws, by letter; zeros leave parts away."""
    lists = {name: [value for value in each(p, name) if value > 0] for name in _ALIKE}
    return {name: max(values) / min(values) for name, values in lists.items() if values}


def span(p: CrankTrainParameters) -> float | None:
    """Distance of the shafts of opposed pistons over the length of both rods and throws; None without such [-]."""
    places = []
    for i, j in combinations(range(len(p.throw)), 2):
        facing = math.cos(each(p, "bank")[i] - each(p, "bank")[j]) < -0.99
        apart = math.dist(_shaft(p, i), _shaft(p, j))
        if facing and apart > 0 and _along(p, i, j) and each(p, "z")[p.throw[i] - 1] == each(p, "z")[p.throw[j] - 1]:
            places.append(apart / (_reach(p, i) + _reach(p, j)))
    # the one that is farthest off
    return max(places, key=lambda ratio: abs(math.log(ratio)), default=None)


def _along(p: CrankTrainParameters, i: int, j: int) -> bool:
    """Whether a cylinder's axis points from its own shaft to that of the other."""
    (x1, y1), (x2, y2), bank = _shaft(p, i), _shaft(p, j), each(p, "bank")[i]
    along = (x2 - x1) * math.cos(bank) + (y2 - y1) * math.sin(bank)
    return along > 0.99 * math.dist((x1, y1), (x2, y2))


def _shaft(p: CrankTrainParameters, i: int) -> tuple[float, float]:
    k = p.throw[i] - 1
    return each(p, "axis_x")[k], each(p, "axis_y")[k]


def _reach(p: CrankTrainParameters, i: int) -> float:
    """Throw and rod of a cylinder [m]."""
    return each(p, "r")[i] + each(p, "l1")[i] + each(p, "l2")[i]


def _half(p: CrankTrainParameters, i: int) -> _Place:
    """The piston's pin at half stroke, by its own shaft [m]."""
    half, bank = _reach(p, i) - each(p, "r")[i], each(p, "bank")[i]
    return half * math.cos(bank), half * math.sin(bank), each(p, "z")[p.throw[i] - 1] + each(p, "z_rod")[i]

"""What the parts of a crank train are for: a pin, a guide and a face a cylinder, a main bearing a throw."""

import numpy as np

from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, dead_centre, each, local_shift
from mechsym.mechanisms.roles import BearingRole, FaceRole, GuideRole, PartRoles, RotorRole, ShaftRole

_AXIS = 1e-9  # rad, and of a distance: axes that differ by less are one


def roles(p: CrankTrainParameters) -> PartRoles:
    """Roles of a train on a rigid shaft."""
    cylinders, firing = range(1, len(p.throw) + 1), each(p, "firing") or (0.0,) * len(p.throw)
    pins = [bearing for i in cylinders for bearing in _pins(p, i)]
    mains = [_main(p, k) for k in sorted(set(p.throw))]
    tops = [top - shift for top, shift in zip(dead_centre(p), local_shift(p), strict=True)]
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
        rotors=(RotorRole(name="flywheel", angle="phi", load="M", inertia="I_f", weight=_weight(p)),),
        guides=tuple(
            GuideRole(name=f"side_force_{i}", reaction=f"side_force_{i}", travel=f"x_{i}", at="guides")
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
        reactions=(f"piston_pin_force_along_{i}", f"piston_pin_force_across_{i}"),
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


def _main(p: CrankTrainParameters, k: int) -> BearingRole:
    return BearingRole(
        name=f"main_bearing_{k}",
        at="main_bearings",
        turns=("phi",),
        sense=each(p, "sense")[k - 1],
        z=each(p, "z")[k - 1],
        reactions=(f"main_bearing_force_x_{k}", f"main_bearing_force_y_{k}"),
    )


def _weight(p: CrankTrainParameters) -> str:
    """Torque of the weight of all throws, by the angle of the shaft [N*m]."""
    rows = zip(*(each(p, name) for name in ("u0", "u_phase", "sense")), strict=True)
    terms = [
        f"({-p.g * u * sense!r})*cos(({sense!r})*(phi + ({phase!r})) + ({p.axis_tilt!r}))" for u, phase, sense in rows
    ]
    return " + ".join(terms)

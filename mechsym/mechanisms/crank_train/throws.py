"""The derived throw, instantiated for every throw and cylinder; its outputs in the common frame and summed."""

import dataclasses
from collections.abc import Mapping

import casadi as ca

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
    throws_here = []
    for k in range(max(p.throw)):
        # a throw without rod and piston; its lengths do not matter
        letters = nothing | {"r": 1.0, "l1": 1.0, "l2": 1.0} | {n: each(p, n)[k] for n in _CRANK}
        throws_here.append(_part(p, 0, k, each(p, "u_phase")[k], 0.0, letters))
    shifts, banks, hung = local_shift(p), each(p, "bank"), []
    for i, (k, master) in enumerate(zip(p.throw, each(p, "master"), strict=True)):
        if master:  # in the axes of the cylinder that carries it
            m, own = int(master) - 1, hung_letters(p, i)
            part = _part(p, i + 1, k - 1, shifts[m], banks[m], own | {"top": top(own)[1]})
            hung.append(dataclasses.replace(part, master=m + 1))
        else:
            letters = nothing | {n: each(p, n)[i] for n in _CYLINDER}
            throws_here.append(_part(p, i + 1, k - 1, shifts[i], banks[i], letters))
    return throws_here + hung


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


Outputs = dict[str, ca.SX]
Instances = list[tuple[ThrowPart, Outputs]]  #: Parts with the outputs of the derived throw


def _common(part: ThrowPart, x: ca.SX, y: ca.SX) -> tuple[ca.SX, ca.SX]:
    # the part's y axis stands a quarter turn ahead in its own sense of rotation
    c, s = ca.cos(part.bank), ca.sin(part.bank)
    return c * x - part.sense * s * y, s * x + part.sense * c * y


def kinematics(throws: Instances, names: tuple[str, ...]) -> Outputs:
    """Travel and rod angle of every cylinder with derivatives by the angle of its throw.

    names: names of the coordinates; one name stands for all throws. Returns outputs: `x_1`, `dx_1_dphi1`,
    `d2x_1_dphi1_dphi1`, `psi_1`, `dpsi_1_dphi1`, of a rod that hangs on another `knuckle_1` and its derivative, the
    turn of its pin.
    """
    outputs: Outputs = {}
    for part, values in throws:
        if part.cylinder:
            i = part.cylinder
            q = names[part.throw] if len(names) > 1 else names[0]
            twice = f"d{q}_d{q}" if len(names) > 1 else f"d{q}2"
            outputs |= {
                f"x_{i}": values["x"],
                f"dx_{i}_d{q}": values["dx_dphi"],
                f"d2x_{i}_{twice}": values["d2x_dphi2"],
            }
            outputs |= {f"psi_{i}": values["psi"], f"dpsi_{i}_d{q}": values["dpsi_dphi"]}
            if part.master:
                outputs |= {f"knuckle_{i}": values["knuckle"], f"dknuckle_{i}_d{q}": values["dknuckle_dphi"]}
    return outputs


def reactions(throws: Instances) -> Outputs:
    """Joint forces of every cylinder and the load on the main bearings of every throw.

    Returns outputs: per cylinder `pin_force_x_1, pin_force_y_1` (crank on rod, common frame),
    `piston_pin_force_along_1`, `piston_pin_force_across_1` (rod on piston), `side_force_1` (cylinder on piston, across,
    positive in the sense of rotation); of a rod that hangs on another `knuckle_force_x_1, knuckle_force_y_1` (that rod
    on it, common frame) in place of the pin force, which the other's has in it; per throw `main_bearing_force_x_1,
    main_bearing_force_y_1` (frame on crank, common frame).
    """
    outputs: Outputs = {}
    bearings: Outputs = {}
    for part, values in throws:
        i, k = part.cylinder, part.throw + 1
        for axis, force in zip("xy", _common(part, values["R_x_O"], values["R_y_O"]), strict=True):
            name = f"main_bearing_force_{axis}_{k}"
            bearings[name] = bearings.get(name, ca.SX(0)) + force
        if part.master:
            outputs |= _hung(part, values, outputs)
        elif i:
            pin = _common(part, values["R_x_A"], values["R_y_A"])
            outputs |= {f"pin_force_x_{i}": pin[0], f"pin_force_y_{i}": pin[1]}
            outputs |= {f"piston_pin_force_along_{i}": values["R_x_B"], f"piston_pin_force_across_{i}": values["R_y_B"]}
            outputs[f"side_force_{i}"] = values["R_y_G"]
    return outputs | bearings


def _hung(part: ThrowPart, values: Outputs, before: Outputs) -> Outputs:
    """Forces at a rod that hangs on another, and those of the other with what it carries."""
    i, m = part.cylinder, part.master
    pin, knuckle = (_common(part, values[f"R_x_{joint}"], values[f"R_y_{joint}"]) for joint in "AK")
    carried = {
        f"pin_force_x_{m}": pin[0], f"pin_force_y_{m}": pin[1], f"piston_pin_force_across_{m}": values["R_y_Bm"],
        f"side_force_{m}": values["R_y_Gm"],
    }  # fmt: skip
    return {name: before[name] + force for name, force in carried.items()} | {
        f"knuckle_force_x_{i}": knuckle[0], f"knuckle_force_y_{i}": knuckle[1],
        f"piston_pin_force_along_{i}": values["R_x_B"], f"piston_pin_force_across_{i}": values["R_y_B"],
        f"side_force_{i}": values["R_y_G"],
    }  # fmt: skip


def momentum(throws: Instances) -> Outputs:
    """Rates of momentum of all moving parts in the common frame, without the flywheel.

    Returns outputs: `momentum_rate_x`, `momentum_rate_y`, `angular_momentum_rate` about the shaft line through the
    origin, and `rocking_rate_x`, `rocking_rate_y` about the X and the Y axis.
    """
    names = ("momentum_rate_x", "momentum_rate_y", "angular_momentum_rate", "rocking_rate_x", "rocking_rate_y")
    totals = {name: ca.SX(0) for name in names}
    for part, values in throws:
        x, y = _common(part, values["momentum_rate_x"], values["momentum_rate_y"])
        about_own = part.sense * values["angular_momentum_rate"]
        rates = (x, y, about_own + part.axis[0] * y - part.axis[1] * x, -part.z * y, part.z * x)
        totals = {name: totals[name] + rate for name, rate in zip(names, rates, strict=True)}
    return totals

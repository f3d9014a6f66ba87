"""Putting derived throws on a shaft: every function of the crank train is a sum over instances of one throw."""

import dataclasses
import math
from collections.abc import Callable, Mapping

import casadi as ca

from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each, local_shift
from mechsym.mechanisms.record import Mechanism, bind, generated
from mechsym.quantities import record

_CRANK = ("I0", "m0", "u0")
_CYLINDER = ("r", "l1", "l2", "offset", "m_rod", "I_rod", "m_piston")


@record
class Part:
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


def parts(p: CrankTrainParameters) -> list[Part]:
    """The instances that a crank train consists of, cranks first.

    Returns
    -------
    parts : list of Part
        One a throw, then one a cylinder
    """
    nothing = dict.fromkeys((*_CRANK, *_CYLINDER), 0.0)
    found = []
    for k in range(max(p.throw)):
        # a throw without rod and piston; its lengths do not matter
        letters = nothing | {"r": 1.0, "l1": 1.0, "l2": 1.0} | {n: each(p, n)[k] for n in _CRANK}
        found.append(_part(p, 0, k, each(p, "u_phase")[k], 0.0, letters))
    for i, k in enumerate(p.throw):
        letters = nothing | {n: each(p, n)[i] for n in _CYLINDER}
        found.append(_part(p, i + 1, k - 1, local_shift(p)[i], each(p, "bank")[i], letters))
    return found


def _part(p: CrankTrainParameters, cylinder: int, k: int, shift: float, bank: float, letters: dict) -> Part:
    sense, tilt = each(p, "sense")[k], p.axis_tilt + bank
    return Part(
        cylinder=cylinder,
        throw=k,
        shift=shift,
        bank=bank,
        sense=sense,
        axis=(each(p, "axis_x")[k], each(p, "axis_y")[k]),
        z=each(p, "z")[k] + (each(p, "z_rod")[cylinder - 1] if cylinder else 0.0),
        letters=letters | {"g": p.g, "axis_tilt": tilt if sense > 0 else math.pi - tilt},  # mirrored, so is gravity
    )


@record
class _Symbols:
    # q, u, a: one symbol a throw and one of the flywheel; in the rigid train all are the same
    names: tuple[str, ...]
    q: list[ca.SX]
    u: list[ca.SX]
    a: list[ca.SX]
    forces: list[ca.SX]
    load: ca.SX


def elastic(p: CrankTrainParameters) -> Mechanism:
    """The mechanism with one coordinate a throw and one of the flywheel."""
    names = (*(f"phi{k + 1}" for k in range(max(p.throw))), "phi_f")
    s = _symbols(names, names, len(p.throw))
    pieces = _dynamics(p, s)
    twist = [a - b for a, b in zip(s.q[:-1], s.q[1:], strict=True)]
    rate = [a - b for a, b in zip(s.u[:-1], s.u[1:], strict=True)]
    springs = zip(each(p, "k"), twist, each(p, "c"), rate, strict=True)
    torques = [k * angle + c * speed for k, angle, c, speed in springs]
    rows = zip(pieces["force"], [*torques, ca.SX(0)], [ca.SX(0), *torques], strict=True)
    force = [applied - own + before for applied, own, before in rows]
    strain = sum((k * angle**2 / 2 for k, angle in zip(each(p, "k"), twist, strict=True)), ca.SX(0))
    outputs = {
        "mass_matrix": ca.diag(ca.vertcat(*pieces["mass"])),
        "bias": ca.vertcat(*pieces["bias"]),
        "generalized_force": ca.vertcat(*force),
    }
    return _mechanism(p, s, outputs, torques, strain)


def driven(p: CrankTrainParameters) -> Mechanism:
    """The elastic train with a torque on its first throw as a further input.

    Returns
    -------
    mechanism : Mechanism
        Named CasADi functions; reactions take the input too, though none of them feels it at given accelerations
    """
    plain, torque = elastic(p), ca.SX.sym("M_drive")
    functions = dict(plain.functions)
    for group in ("dynamics", "reactions"):
        function = plain.functions[group]
        inputs = {name: ca.SX.sym(name) for name in function.name_in()}
        outputs = {name: ca.SX(value) for name, value in function(**inputs).items()}
        if group == "dynamics":
            force = outputs["generalized_force"]
            outputs["generalized_force"] = ca.vertcat(force[0] + torque, force[1:])
        ordered = {name: outputs[name] for name in function.name_out()}
        functions[group] = _function(group, [*inputs.values(), torque], ordered)
    return dataclasses.replace(plain, inputs=(*plain.inputs, "M_drive"), functions=functions)


def rigid(p: CrankTrainParameters) -> Mechanism:
    """The mechanism with one coordinate for the whole shaft; shaft torques from the balance of the throws before."""
    s = _symbols(("phi",), ("phi",) * (max(p.throw) + 1), len(p.throw))
    pieces = _dynamics(p, s)
    torques, sum_before = [], ca.SX(0)
    for mass, bias, force in list(zip(pieces["mass"], pieces["bias"], pieces["force"], strict=True))[:-1]:
        sum_before = sum_before + force - bias - mass * s.a[0]
        torques.append(sum_before)
    totals = {name: ca.SX(sum(values)) for name, values in pieces.items()}
    outputs = {"mass_matrix": totals["mass"], "bias": totals["bias"], "generalized_force": totals["force"]}
    return _mechanism(p, s, outputs, torques, ca.SX(0))


def _symbols(names: tuple[str, ...], per_throw: tuple[str, ...], cylinders: int) -> _Symbols:
    made = {f"{n}{dots}": ca.SX.sym(f"{n}{dots}") for n in names for dots in ("", "d", "dd")}
    return _Symbols(
        names=names,
        q=[made[n] for n in per_throw],
        u=[made[f"{n}d"] for n in per_throw],
        a=[made[f"{n}dd"] for n in per_throw],
        forces=[ca.SX.sym(f"F{i + 1}") for i in range(cylinders)],
        load=ca.SX.sym("M"),
    )


def _caller(s: _Symbols) -> Callable[[str, Part], dict[str, ca.SX]]:
    letters = generated("crank_throw").PARAMETERS
    throw = bind("crank_throw", {n: ca.SX.sym(n) for n in letters}).functions

    def call(group: str, part: Part) -> dict[str, ca.SX]:
        k = part.throw
        force = s.forces[part.cylinder - 1] if part.cylinder else 0
        given = {"phi": s.q[k] + part.shift, "phid": s.u[k], "phidd": s.a[k], "F": force, "M": 0, **part.letters}
        function = throw[group]
        return {n: ca.SX(v) for n, v in function(**{n: given[n] for n in function.name_in()}).items()}

    return call


def _dynamics(p: CrankTrainParameters, s: _Symbols) -> dict[str, list[ca.SX]]:
    count, call = max(p.throw), _caller(s)
    pieces = {name: [ca.SX(0)] * (count + 1) for name in ("mass", "bias", "force")}
    for part in parts(p):
        found = call("dynamics", part)
        for name, key in (("mass", "mass_matrix"), ("bias", "bias"), ("force", "generalized_force")):
            pieces[name][part.throw] = pieces[name][part.throw] + found[key]
    pieces["mass"][-1], pieces["force"][-1] = ca.SX(p.I_f), -s.load
    return pieces


def _mechanism(
    p: CrankTrainParameters, s: _Symbols, dynamics: dict[str, ca.SX], torques: list[ca.SX], strain: ca.SX
) -> Mechanism:
    from mechsym.mechanisms.crank_train import forces as crank_train_forces

    q, u, a = (list({str(v): v for v in values}.values()) for values in (s.q, s.u, s.a))
    forces, call, all_parts = [*s.forces, s.load], _caller(s), parts(p)
    kinetic, potential = p.I_f * s.u[-1] ** 2 / 2, strain
    for part in all_parts:
        found = call("energy", part)
        kinetic, potential = kinetic + found["kinetic_energy"], potential + found["potential_energy"]
    reactions = crank_train_forces.reactions(all_parts, lambda part: call("reactions", part))
    reactions |= {f"shaft_torque_{k + 1}": torque for k, torque in enumerate(torques)}
    momentum = crank_train_forces.momentum(all_parts, lambda part: call("momentum", part))
    flywheel = each(p, "sense")[-1] * p.I_f * s.a[-1]
    momentum["angular_momentum_rate"] = momentum["angular_momentum_rate"] + flywheel
    kinematics = crank_train_forces.kinematics(all_parts, lambda part: call("kinematics", part), s.names)
    groups = {
        "kinematics": (q, kinematics),
        "dynamics": ([*q, *u, *forces], dynamics),
        "energy": ([*q, *u], {"kinetic_energy": kinetic, "potential_energy": potential}),
        "reactions": ([*q, *u, *a, *forces], reactions),
        "momentum": ([*q, *u, *a], momentum),
    }
    functions = {name: _function(name, inputs, outputs) for name, (inputs, outputs) in groups.items()}
    inputs = tuple(str(f) for f in forces)
    values = {f.name: getattr(p, f.name) for f in dataclasses.fields(p)}
    return Mechanism(name="crank_train", coordinates=s.names, inputs=inputs, parameters=values, functions=functions)


def _function(name: str, inputs: list[ca.SX], outputs: dict[str, ca.SX]) -> ca.Function:
    return ca.Function(name, inputs, list(outputs.values()), [str(v) for v in inputs], list(outputs))

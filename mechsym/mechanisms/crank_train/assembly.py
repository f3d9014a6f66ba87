"""Putting derived throws on a shaft: every function of the crank train is a sum over instances of one throw."""

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any

import casadi as ca

from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each
from mechsym.mechanisms.crank_train.throws import ThrowPart, parts
from mechsym.mechanisms.record import Mechanism, bind, generated
from mechsym.quantities import record


@record
class _Symbols:
    # q, u, a: one symbol a throw and one of the flywheel; in the rigid train all are the same
    names: tuple[str, ...]
    q: list[ca.SX]
    u: list[ca.SX]
    a: list[ca.SX]
    forces: list[ca.SX]
    load: ca.SX


def build(p: CrankTrainParameters) -> Mechanism:
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


def build_driven(p: CrankTrainParameters) -> Mechanism:
    """The elastic train with a torque on its first throw as a further input.

    Returns
    -------
    mechanism : Mechanism
        Named CasADi functions; reactions take the input too, though none of them feels it at given accelerations
    """
    plain, torque = build(p), ca.SX.sym("M_drive")
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


def build_rigid(p: CrankTrainParameters) -> Mechanism:
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


def _caller(s: _Symbols) -> Callable[[str, ThrowPart], dict[str, ca.SX]]:
    letters = generated("crank_throw").PARAMETERS
    throw = bind("crank_throw", {n: ca.SX.sym(n) for n in letters}).functions

    def call(group: str, part: ThrowPart) -> dict[str, ca.SX]:
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


def listing(mechanism: Mechanism | None = None) -> Mapping[str, Any]:
    """Letters and units, like the stored listing of a generated mechanism.

    Parameters
    ----------
    mechanism : Mechanism, optional
        Of `build`; without it the letters stand for any number of throws

    Returns
    -------
    listing : mapping
        Keys name, about, source, coordinates, parameters, inputs, outputs, equations
    """
    coordinates = mechanism.coordinates if mechanism else ("phi1..phiN", "phi_f")
    inputs = mechanism.inputs if mechanism else ("F1..", "M")
    names = ("x_1", "psi_1", "pin_force_x_1", "side_force_1", "main_bearing_force_x_1", "shaft_torque_1", "..")
    outputs = names if mechanism is None else _outputs(mechanism)
    fields = dataclasses.fields(CrankTrainParameters)
    return {
        "name": "crank_train",
        "about": "N throws on an elastic shaft with a flywheel.",
        "source": "002_d7297926d6c52225",
        "coordinates": dict.fromkeys(coordinates, "rad"),
        "parameters": {f.name: f.metadata.get("unit", "-") for f in fields},
        "inputs": {n: "N*m" if n == "M" else "N" for n in inputs},
        "outputs": {name: _unit(name) for name in outputs},
        "roles": {"rotor": [{"name": "flywheel", "angle": "phi_f", "load": "M", "drive": None, "inertia": "I_f"}]},
        "equations": [],
    }


def _outputs(mechanism: Mechanism) -> list[str]:
    return [n for group in ("kinematics", "reactions") for n in mechanism.functions[group].name_out()]


def _unit(output: str) -> str:
    """Unit of an output, which is that of the throw's quantity behind it."""
    kinds = {
        "x_": "m",
        "dx_": "m/rad",
        "d2x_": "m/(rad*rad)",
        "psi_": "rad",
        "dpsi_": "rad/rad",
        "shaft_torque_": "N*m",
    }
    return next((unit for start, unit in kinds.items() if output.startswith(start)), "" if output == ".." else "N")

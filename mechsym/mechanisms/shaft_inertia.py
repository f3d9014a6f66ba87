"""What stands on the first coordinate of any mechanism beside it: a flywheel, a place for a torque."""

from dataclasses import replace
from functools import lru_cache

import casadi as ca

from mechsym.mechanisms.record import Mechanism
from mechsym.quantities.units import Inertia, Pure


def with_inertia(mechanism: Mechanism, inertia: Inertia) -> Mechanism:
    """The mechanism with more inertia on its shaft.

    inertia: about the shaft axis, added.
    """
    functions = dict(mechanism.functions)
    count = len(mechanism.coordinates)
    for group, first in (("dynamics", "mass_matrix"), ("energy", "kinetic_energy"), ("kinematics", "inertia")):
        function = functions[group]
        if first not in function.name_out():
            continue
        letters = [ca.SX.sym(function.name_in(i)) for i in range(function.n_in())]
        found = dict(zip(function.name_out(), function.call(letters), strict=True))
        share = ca.SX(*found[first].shape)
        share[0, 0] = inertia * letters[count] ** 2 / 2 if group == "energy" else inertia
        found[first] = found[first] + share
        functions[group] = ca.Function(
            group, letters, list(found.values()), function.name_in(), list(found), {"allow_duplicate_io_names": True}
        )
    return replace(mechanism, functions=functions)


# a machine of many springs is one mechanism with one place for the hinge
@lru_cache(maxsize=64)
def with_torque(mechanism: Mechanism, name: str, sign: Pure = 1.0) -> Mechanism:
    """The mechanism with an input that is a torque on its shaft; itself where it has an input of that name.

    sign: 1 for a torque in the sense of rotation, -1 against it.
    """
    if name in mechanism.inputs:
        return mechanism
    functions, torque = dict(mechanism.functions), ca.SX.sym(name)
    for group in ("dynamics", "reactions"):
        if group not in functions:
            continue
        function = functions[group]
        letters = [ca.SX.sym(n) for n in function.name_in()]
        found = dict(zip(function.name_out(), function.call(letters), strict=True))
        if group == "dynamics":
            share = ca.SX(*found["generalized_force"].shape)
            share[0] = sign * torque
            found["generalized_force"] += share
        functions[group] = ca.Function(group, [*letters, torque], list(found.values()), [*function.name_in(), name],
                                       list(found), {"allow_duplicate_io_names": True})  # fmt: skip
    return replace(mechanism, inputs=(*mechanism.inputs, name), functions=functions)


def is_damped(mechanism: Mechanism) -> bool:
    """Whether its forces depend on its speed."""
    dynamics = mechanism.functions["dynamics"]
    letters = [ca.SX.sym(name) for name in dynamics.name_in()]
    return bool(ca.depends_on(dynamics(*letters)[2], letters[len(mechanism.coordinates)]))


def at_rest(mechanism: Mechanism) -> Mechanism:
    """A mechanism with one coordinate whose dampers do not act; itself where it has none."""
    if not is_damped(mechanism):
        return mechanism
    dynamics = mechanism.functions["dynamics"]
    letters = [ca.SX.sym(name) for name in dynamics.name_in()]
    mass, bias, force = dynamics(*letters)
    outputs = [mass, bias, ca.substitute(force, letters[1], ca.SX(0))]
    still = ca.Function("dynamics", letters, outputs, dynamics.name_in(), dynamics.name_out())
    return replace(mechanism, functions={**mechanism.functions, "dynamics": still})

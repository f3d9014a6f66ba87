"""A flywheel on the first coordinate of any mechanism."""

from dataclasses import replace

import casadi as ca

from mechsym.mechanisms.record import Mechanism


def with_inertia(mechanism: Mechanism, inertia: float) -> Mechanism:
    """The mechanism with more inertia on its shaft.

    Parameters
    ----------
    inertia : float
        About the shaft axis, added [kg*m^2]
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
        functions[group] = ca.Function(group, letters, list(found.values()), function.name_in(), list(found),
                                       {"allow_duplicate_io_names": True})  # fmt: skip
    return replace(mechanism, functions=functions)

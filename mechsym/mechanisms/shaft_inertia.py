"""A flywheel on the first coordinate of any mechanism with one coordinate."""

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
    for group, first in (("dynamics", "mass_matrix"), ("energy", "kinetic_energy"), ("kinematics", "inertia")):
        function = functions[group]
        letters = [ca.SX.sym(function.name_in(i)) for i in range(function.n_in())]
        found = dict(zip(function.name_out(), function.call(letters), strict=True))
        share = inertia * letters[1] ** 2 / 2 if group == "energy" else inertia
        found[first] = found[first] + share
        functions[group] = ca.Function(group, letters, list(found.values()), function.name_in(), list(found))
    return replace(mechanism, functions=functions)

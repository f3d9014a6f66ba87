"""Everything that is known of a mechanism at one state, with or without constraints."""

from collections.abc import Mapping, Sequence
from typing import Any

import casadi as ca
import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms import constraints
from mechsym.mechanisms.record import Mechanism, accelerations, velocities


def state(mechanism: Mechanism, values: Mapping[str, float]) -> dict[str, Any]:
    """Everything that is known of a mechanism at one state.

    Parameters
    ----------
    values : mapping of str to float
        Coordinates, velocities and inputs; what is not named is 0, or what the constraints make it

    Returns
    -------
    state : dict
        Keys mass_matrix, bias, generalized_force, acceleration, kinetic_energy, potential_energy, outputs; the
        energies are None for a model given only by its equations
    """
    q, u = mechanism.coordinates, velocities(mechanism)
    values, qdd, joint_forces = _motion(mechanism, values)

    def numbers(names: Sequence[str]) -> list[float]:
        return [float(values.get(n, 0.0)) for n in names]

    dynamics = mechanism.functions["dynamics"]
    mass, bias, force = (np.asarray(v) for v in dynamics.call(numbers(dynamics.name_in())))
    found = dict(zip(accelerations(mechanism), qdd, strict=True)) | dict(values)
    outputs: dict[str, float | None] = {**_named(mechanism.functions["kinematics"], numbers(q)), **joint_forces}
    if "reactions" in mechanism.functions:
        reactions = mechanism.functions["reactions"]
        outputs |= _named(reactions, [float(found.get(n, 0.0)) for n in reactions.name_in()])
    energies: dict[str, float | None] = {"kinetic_energy": None, "potential_energy": None}
    if "energy" in mechanism.functions:
        energies |= _named(mechanism.functions["energy"], numbers([*q, *u]))
    vectors = {"mass_matrix": mass.tolist(), "bias": bias.ravel().tolist(), "generalized_force": force.ravel().tolist()}
    return vectors | {"acceleration": qdd.tolist()} | energies | {"outputs": outputs}


def _motion(
    mechanism: Mechanism, values: Mapping[str, float]
) -> tuple[dict[str, float], np.ndarray, dict[str, float | None]]:
    if "constraints" in mechanism.functions:
        return constraints.motion(mechanism, values)
    dynamics = mechanism.functions["dynamics"]
    given = [float(values.get(n, 0.0)) for n in dynamics.name_in()]
    mass, bias, force = (np.asarray(v) for v in dynamics.call(given))
    if not all(np.isfinite(v).all() for v in (mass, bias, force)):
        at = ", ".join(f"{q} = {float(values.get(q, 0.0)):g}" for q in mechanism.coordinates)
        raise BadInput(
            f"{mechanism.name}: the loop is open at {at}: links too short there, or a wrong branch; give another pose"
        )
    return dict(values), np.linalg.solve(mass, force - bias).ravel(), {}


def _named(function: ca.Function, values: Sequence[float]) -> dict[str, float]:
    return {n: float(v) for n, v in zip(function.name_out(), function.call(list(values)), strict=True)}

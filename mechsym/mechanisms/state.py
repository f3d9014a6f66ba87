"""Everything that is known of a mechanism at one state, with or without constraints."""

import types
from collections.abc import Mapping, Sequence

import casadi as ca
import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms import constraints
from mechsym.mechanisms.record import Mechanism, accelerations, velocities
from mechsym.quantities.results import Columns, part, quantity, result


@result
class MechanismState:
    """What is known of a mechanism at one state; lists go along its coordinates."""

    mass_matrix: list[list[float]] = quantity("@inertia")  #: Generalised inertia
    bias: list[float] = quantity("@push")  #: Forces of inertia at no acceleration
    generalized_force: list[float] = quantity("@push")  #: Of inputs, gravity, springs and dampers
    acceleration: list[float] = quantity("@rate")  #: Of the coordinates
    kinetic_energy: float | None = quantity("J")  #: None of a model given only by its equations
    potential_energy: float | None = quantity("J")  #: Of gravity and springs
    outputs: Columns = part()  #: Travels, their slopes, reactions, as the declaration names them
    inertia: str
    push: str
    rate: str


_UNITS = {"rad": ("kg*m^2", "N*m", "rad/s^2"), "m": ("kg", "N", "m/s^2")}
_MIXED = ("of its coordinates",) * 3


def state(
    mechanism: Mechanism, values: Mapping[str, float], units: Mapping[str, str] = types.MappingProxyType({})
) -> MechanismState:
    """Everything that is known of a mechanism at one state.

    values: coordinates, velocities and inputs; what is not named is 0, or what the constraints make it. units: of
    outputs, where they are to be told.
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
    kinds = {mechanism.units.get(name, "rad") for name in q}
    inertia, push, rate = _UNITS.get(kinds.pop(), _MIXED) if len(kinds) == 1 else _MIXED
    return MechanismState(
        mass_matrix=mass.tolist(), bias=bias.ravel().tolist(), generalized_force=force.ravel().tolist(),
        acceleration=qdd.tolist(), outputs=Columns(outputs, {**dict.fromkeys(outputs, ""), **units}), **energies,
        inertia=inertia, push=push, rate=rate,
    )  # fmt: skip


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

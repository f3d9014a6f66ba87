"""A shaft: its matrices of inertia, stiffness, damping, and what stands on its first coordinate besides."""

from dataclasses import asdict, replace
from functools import lru_cache

import casadi as ca
import numpy as np

from mechsym import mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities import record
from mechsym.quantities.records import Record
from mechsym.quantities.units import Inertia, Pure

_POINTS = 720


@record
class ElasticShaft:
    """A shaft that twists, from its free end to the flywheel."""

    discs: tuple[float, ...]  #: Inertia of each alone [kg*m^2]
    k: tuple[float, ...]  #: Stiffness of each section [N*m/rad]
    c: tuple[float, ...]  #: Damping of each section [N*m*s/rad]


@record
class ShaftMatrices:
    """Linear torsional model of a shaft."""

    coordinates: tuple[str, ...]  #: Angles, in the order of rows and columns
    inertia: np.ndarray  #: shape (n, n): Discs alone (bare) [kg*m^2]
    inertia_mean: np.ndarray  #: shape (n, n): Discs with the mean over a turn of what reciprocates [kg*m^2]
    stiffness: np.ndarray  #: shape (n, n): Stiffness; rows sum to zero, the shaft turns freely [N*m/rad]
    damping: np.ndarray  #: shape (n, n): Damping [N*m*s/rad]


def elastic(name: str, parameters: Record) -> ElasticShaft | None:
    """The shaft of a mechanism with numbers; None where it does not twist."""
    for role in plan_of(name).parts(parameters).shafts:
        letters = asdict(parameters)
        sizes = ((float(amount(size, letters)) for size in row) for row in (role.discs, role.stiffness, role.damping))
        discs, k, c = map(tuple, sizes)
        return ElasticShaft(discs=discs, k=k, c=c)
    return None


def matrices(name: str, parameters: Record) -> ShaftMatrices:
    """Matrices of the shaft of a mechanism that has one which twists."""
    mechanism, shaft = mechanisms.build(name, parameters), elastic(name, parameters)
    if shaft is None:
        raise BadInput(f"{name} has no elastic shaft; declare it with m.shaft(..)")
    dynamics, n = mechanism.functions["dynamics"], len(mechanism.coordinates)
    angles = ca.DM(np.linspace(0.0, 2 * np.pi, _POINTS, endpoint=False)).T
    given = [angles] * n + [ca.DM.zeros(1, _POINTS)] * (dynamics.n_in() - n)
    mass = np.asarray(dynamics.call(given)[0])
    return ShaftMatrices(
        coordinates=mechanism.coordinates,
        inertia=np.diag(shaft.discs),
        inertia_mean=mass.reshape(n, _POINTS, n).mean(axis=1),
        stiffness=chain(shaft.k),
        damping=chain(shaft.c),
    )


def chain(values: tuple[float, ...]) -> np.ndarray:
    """Matrix of springs (or dampers) between neighbours of a free chain.

    values: stiffness or damping from each disc to the next [N*m/rad] or [N*m*s/rad]. Returns matrix: symmetric, rows
    sum to zero [N*m/rad] or [N*m*s/rad], shape (n + 1, n + 1).
    """
    differences = np.diff(np.eye(len(values) + 1), axis=0)
    return differences.T @ np.diag(values) @ differences


def with_inertia(mechanism: Mechanism, inertia: Inertia) -> Mechanism:
    """The mechanism with more inertia on its shaft. inertia: about the shaft axis, added."""
    functions = dict(mechanism.functions)
    count = len(mechanism.coordinates)
    for group, first in (("dynamics", "mass_matrix"), ("energy", "kinetic_energy"), ("kinematics", "inertia")):
        function = functions.get(group)
        if function is None or first not in function.name_out():
            continue
        letters = [ca.SX.sym(function.name_in(i)) for i in range(function.n_in())]
        values = dict(zip(function.name_out(), function.call(letters), strict=True))
        share = ca.SX(*values[first].shape)
        share[0, 0] = inertia * letters[count] ** 2 / 2 if group == "energy" else inertia
        values[first] = values[first] + share
        functions[group] = ca.Function(
            group, letters, list(values.values()), function.name_in(), list(values), {"allow_duplicate_io_names": True}
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
        values = dict(zip(function.name_out(), function.call(letters), strict=True))
        if group == "dynamics":
            share = ca.SX(*values["generalized_force"].shape)
            share[0] = sign * torque
            values["generalized_force"] += share
        functions[group] = ca.Function(group, [*letters, torque], list(values.values()), [*function.name_in(), name],
                                       list(values), {"allow_duplicate_io_names": True})  # fmt: skip
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

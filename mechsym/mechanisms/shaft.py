"""Matrices of a torsionally elastic shaft, for torsional analysis: inertia, stiffness, damping."""

from dataclasses import asdict

import casadi as ca
import numpy as np

from mechsym import mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities import record
from mechsym.quantities.records import Record

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
    return ShaftMatrices(
        coordinates=mechanism.coordinates,
        inertia=np.diag(shaft.discs),
        inertia_mean=_mean_mass(mechanism),
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


def _mean_mass(mechanism: Mechanism) -> np.ndarray:
    dynamics, n = mechanism.functions["dynamics"], len(mechanism.coordinates)
    angles = ca.DM(np.linspace(0.0, 2 * np.pi, _POINTS, endpoint=False)).T
    given = [angles] * n + [ca.DM.zeros(1, _POINTS)] * (dynamics.n_in() - n)
    mass = np.asarray(dynamics.call(given)[0])
    return mass.reshape(n, _POINTS, n).mean(axis=1)

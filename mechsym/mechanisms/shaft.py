"""Matrices of a torsionally elastic shaft, for torsional analysis: inertia, stiffness, damping."""

from typing import Any

import casadi as ca
import numpy as np

from mechsym import mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.traits import ElasticShaft, name_of, traits_of
from mechsym.quantities import record

_POINTS = 720


@record
class ShaftMatrices:
    """Linear torsional model of a shaft."""

    coordinates: tuple[str, ...]  #: Angles, in the order of rows and columns
    inertia: np.ndarray  #: shape (n, n): Discs alone (bare) [kg*m^2]
    inertia_mean: np.ndarray  #: shape (n, n): Discs with the mean over a turn of what reciprocates [kg*m^2]
    stiffness: np.ndarray  #: shape (n, n): Stiffness; rows sum to zero, the shaft turns freely [N*m/rad]
    damping: np.ndarray  #: shape (n, n): Damping [N*m*s/rad]


def is_elastic(parameters: Any) -> bool:
    """Whether parameters are those of a shaft that twists."""
    known = traits_of(name_of(type(parameters)))
    return known is not None and known.shaft is not None


def matrices(parameters: Any) -> ShaftMatrices:
    """Matrices of an elastic shaft, of the record of its mechanism."""
    name = name_of(type(parameters))
    (k, c), mechanism = springs(parameters), mechanisms.build(name, parameters)
    return ShaftMatrices(
        coordinates=mechanism.coordinates,
        inertia=np.diag(_elastic(parameters).discs(parameters)),
        inertia_mean=_mean_mass(mechanism),
        stiffness=chain(k),
        damping=chain(c),
    )


def springs(parameters: Any) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Stiffness and damping of each section of the shaft, from the free end to the flywheel.

    Returns
    -------
    k, c : tuple of float
        One a section [N*m/rad, N*m*s/rad]
    """
    return _elastic(parameters).springs(parameters)


def _elastic(parameters: Any) -> ElasticShaft:
    known = traits_of(name_of(type(parameters)))
    if known is None or known.shaft is None:
        raise BadInput(f"{type(parameters).__name__} has no elastic shaft")
    return known.shaft


def chain(values: tuple[float, ...]) -> np.ndarray:
    """Matrix of springs (or dampers) between neighbours of a free chain.

    Parameters
    ----------
    values : tuple of float
        Stiffness or damping from each disc to the next [N*m/rad] or [N*m*s/rad]

    Returns
    -------
    matrix : ndarray, shape (n + 1, n + 1)
        Symmetric, rows sum to zero [N*m/rad] or [N*m*s/rad]
    """
    differences = np.diff(np.eye(len(values) + 1), axis=0)
    return differences.T @ np.diag(values) @ differences


def _mean_mass(mechanism: Mechanism) -> np.ndarray:
    dynamics, n = mechanism.functions["dynamics"], len(mechanism.coordinates)
    angles = ca.DM(np.linspace(0.0, 2 * np.pi, _POINTS, endpoint=False)).T
    given = [angles] * n + [ca.DM.zeros(1, _POINTS)] * (dynamics.n_in() - n)
    mass = np.asarray(dynamics.call(given)[0])
    return mass.reshape(n, _POINTS, n).mean(axis=1)

"""The path of the rollers of a co-design, and its limits as constraints of the programme."""

import numpy as np

from mechsym.codesign.hardware import Hardware
from mechsym.codesign.task import Track
from mechsym.hinge.bounds.face import CENTRE, Rows, Station, asked
from mechsym.quantities import record
from mechsym.quantities.records import Record
from mechsym.quantities.units import Metre, Scalar

_FINE = 720  # angles of a turn on which a finished guide is looked at


@record
class Path:
    """Path of the roller centres on the angles of the programme, symbols or arrays of shape (n,)."""

    z: Scalar  #: closing of the spring [m]
    rho: Scalar  #: shaft axis to roller centre [m]
    drho: Scalar  #: its derivative by the angle of the guide's shaft [m/rad]
    d2rho: Scalar  #: and the second [m/rad^2]


def path_of(hardware: Hardware, rho0: Scalar, z: Scalar, dz: Scalar, d2z: Scalar) -> Path:
    """Path of the rollers of a closing z [m] and its derivatives by the crank angle [m/rad, m/rad^2]; rho0 in [m]."""
    c, ratio = hardware.count, hardware.shaft_ratio
    return Path(z=z, rho=rho0 - z / c, drho=-dz / (c * ratio), d2rho=-d2z / (c * ratio**2))


def fine_path(track: Track, period: float) -> tuple[np.ndarray, Path]:
    """Even angles [rad] of a turn and the path of a guide there."""
    phi = np.arange(round(_FINE * period / (2 * np.pi))) * 2 * np.pi / _FINE
    z, h = track.z(phi), track.hardware
    return phi, path_of(h, h.rho0, z, track.z.derivative()(phi), track.z.derivative(2)(phi))


def rows(at: Station, limits: Record, least: Metre, reach: Metre[Scalar] | None) -> Rows:
    """Each limit as (values, lowest, highest), values by the limit or by their scale.

    limits: settings as symbols. least: smallest closing. reach: largest radius that rollers may reach; None asks none.
    """
    made = [((at.z - least) / at.spring.H, 0.0, np.inf)]
    for _, limit, setting in asked(limits, CENTRE):
        if limit.holds(at.spring, at.count):
            made += limit.rows(at, setting)
    if reach is not None:
        made.append(((at.rho + at.rollers.radius) / reach, -np.inf, 1.0))
    return tuple(made)

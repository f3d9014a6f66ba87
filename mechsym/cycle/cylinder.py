r"""The cylinder: all that the gas knows of the mechanism.

        head
     ___________   x = 0, volume = clearance V_c
    |           |
    |           |  x(phi)   V = V_c + A x
    |===========|  piston
    |     |     |  x = stroke, V = V_c + A stroke = compression_ratio V_c

phi = 0 at (firing) top dead centre, x from the head towards the crank.
"""

import math
from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np

from mechsym.quantities import quantity, record


@record
class Cylinder:
    """Bore, clearance and the piston's travel."""

    bore: float = quantity("m", above=0, about="diameter of the piston")
    stroke: float = quantity("m", above=0, about="travel between the dead centres")
    compression_ratio: float = quantity("-", above=1, about="largest volume by smallest volume")
    #: Travel from top dead centre and its derivative: ndarray of phi [rad] to an ndarray of its shape [m], [m/rad]
    x: Callable[[Any], Any]
    dx_dphi: Callable[[Any], Any]


def piston_area(bore: float) -> float:
    r"""Area of the piston.

    .. math:: A = \pi\,\mathrm{bore}^2 / 4

    Parameters
    ----------
    bore : float
        Diameter [m]

    Returns
    -------
    area : float
        Area [m^2]
    """
    return math.pi / 4 * bore**2


def swept_volume(cylinder: Cylinder) -> float:
    r"""Volume between the dead centres.

    .. math:: V_d = A\,\mathrm{stroke}

    Returns
    -------
    volume : float
        Swept volume [m^3]
    """
    return piston_area(cylinder.bore) * cylinder.stroke


def clearance_volume(cylinder: Cylinder) -> float:
    r"""Volume at top dead centre.

    .. math:: V_c = V_d / (\mathrm{CR} - 1)

    Parameters
    ----------
    cylinder : Cylinder
        Bore, stroke and geometric compression ratio

    Returns
    -------
    volume : float
        Clearance volume [m^3]
    """
    return swept_volume(cylinder) / (cylinder.compression_ratio - 1)


def volume(cylinder: Cylinder, phi: Any) -> Any:
    r"""Volume of the gas.

    .. math:: V = V_c + A\,x(\varphi)

    Parameters
    ----------
    phi : float or ndarray
        Crank angle from top dead centre [rad]

    Returns
    -------
    volume : float or ndarray
        Volume, shape of phi [m^3]
    """
    return clearance_volume(cylinder) + piston_area(cylinder.bore) * cylinder.x(phi)


def dvolume_dphi(cylinder: Cylinder, phi: Any) -> Any:
    r"""Slope of the volume.

    .. math:: dV/d\varphi = A\,x'(\varphi)

    Parameters
    ----------
    phi : float or ndarray
        Crank angle from top dead centre [rad]

    Returns
    -------
    slope : float or ndarray
        Slope, shape of phi [m^3/rad]
    """
    return piston_area(cylinder.bore) * cylinder.dx_dphi(phi)


def cylinder_of(kinematics: ca.Function, bore: float, compression_ratio: float) -> Cylinder:
    """The cylinder over a mechanism with one coordinate.

    Parameters
    ----------
    kinematics : casadi.Function
        One input, the crank angle [rad]; named outputs `x` [m] and `dx_dphi` [m/rad]
    bore : float
        Diameter of the piston [m]
    compression_ratio : float
        Largest volume by smallest volume [-]

    Returns
    -------
    cylinder : Cylinder
        Its stroke is x at phi = pi

    Notes
    -----
    Valid: dead centres at 0 and pi, as in every mechanism whose crank axis lies on the cylinder axis.
    """
    x = _output(kinematics, "x")
    return Cylinder(
        bore=bore,
        compression_ratio=compression_ratio,
        stroke=float(x(math.pi)),
        x=x,
        dx_dphi=_output(kinematics, "dx_dphi"),
    )


def _output(kinematics: ca.Function, name: str) -> Callable[[Any], Any]:
    phi = ca.SX.sym("phi")
    index = kinematics.name_out().index(name)
    function = ca.Function(name, [phi], [kinematics.call([phi])[index]])

    def evaluate(phi: Any) -> Any:
        angles = np.asarray(phi, dtype=float)
        return np.asarray(function(angles.reshape(1, -1))).reshape(angles.shape)[()]

    return evaluate

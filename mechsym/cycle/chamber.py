r"""The combustion chamber: all that the engine cycle knows of a mechanism is how far a piston has travelled.

    head, or the other piston
    |<-- V_c -->|<------ x(phi) ------>|
    |           |                      |### piston, area A, one or two to a chamber
    |           x = 0                  |
             top dead centre

phi is the crank angle from (firing) top dead centre, positive in the sense of rotation; x is positive away from the
head. Volume and its slope are `V = V_c + n A x` and `n A dx/dphi` with n pistons to the chamber, the clearance
`V_c = n A S/(CR - 1)` follows from the compression ratio CR and the stroke S of one piston.

Every attribute of a `Chamber` may be a number or a CasADi expression: the same functions then give numbers or the
model that is differentiated.
"""

import dataclasses
from collections.abc import Mapping
from typing import Annotated, Any

import casadi as ca
import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.arrays import over_arrays
from mechsym.periodic.roots import root
from mechsym.quantities import quantity, record
from mechsym.quantities.units import (
    Area,
    Kilogram,
    Metre,
    MetrePerRadian,
    MetrePerRadian2,
    Newton,
    Pascal,
    Pure,
    Radian,
    RadPerSecond,
    Scalar,
    Volume,
)


@record
class Motion:
    """How one piston moves with the crank."""

    name: str
    #: (phi, parameters (k,)) -> x [m], dx_dphi [m/rad], d2x_dphi2 [m/rad^2]; scalars, mapped over columns
    function: ca.Function
    parameters: Mapping[str, Scalar]  #: The k parameters in the order of the function's second input
    masses: tuple[str, ...]  #: Parameters whose sum is the mass that moves with one piston
    bottom: float = np.pi  #: Crank angle of bottom dead centre, pi for every mechanism without offset [rad]
    #: (phi, parameters (k,), omega [rad/s], F [N]) -> named loads of the mechanism at constant speed under the net
    #: pressure force F on the piston
    loads: ca.Function | None = None


@record
class ChamberParameters:
    """Section `[chamber]` of a case."""

    bore: float = quantity("m", above=0, about="cylinder bore")
    compression_ratio: float = quantity("-", above=1, high=60, about="compression ratio; largest over smallest volume")
    #: Pistons that bound the chamber: 1 under a head, or 2 opposed [-]
    pistons: float = quantity("-", default=1, about="1 under a head, or 2 opposed")
    #: Absolute pressure on the other side of the piston; 0 gives forces from absolute pressure [Pa]
    back_pressure: float = quantity("Pa", default=101325.0, low=0, about="absolute pressure behind the piston")

    def __post_init__(self) -> None:
        if self.pistons not in (1, 2):
            raise BadInput(f"pistons = {self.pistons:g} is not an option; options are 1 (under a head), 2 (opposed)")


@record
class Chamber:
    """A chamber of given size on a given motion; attributes are numbers or CasADi expressions."""

    motion: Motion
    pistons: int
    #: Bore [m], area [m^2] and stroke [m] of one piston
    bore: Scalar
    area: Scalar
    stroke: Scalar
    #: Smallest volume, and swept volume of all pistons together [m^3]
    clearance: Scalar
    displacement: Scalar
    compression_ratio: Scalar  #: Largest volume by smallest volume [-]
    back_pressure: Scalar  #: Absolute pressure on the other side of the piston [Pa]


def chamber(parameters: Any, motion: Motion) -> Chamber:
    r"""Size the chamber.

    .. math:: A = \pi B^2/4, \quad V_d = n A S, \quad V_c = V_d/(CR - 1)

    parameters: ChamberParameters, bore, compression ratio, pistons; or any object with these attributes, which may be
    CasADi expressions.
    """
    area = piston_area(parameters.bore)
    stroke = travel(motion, motion.bottom)[0]
    displacement = parameters.pistons * area * stroke
    clearance = displacement / (parameters.compression_ratio - 1)
    return Chamber(
        motion=motion, pistons=parameters.pistons, bore=parameters.bore, area=area, stroke=stroke,
        clearance=clearance, displacement=displacement, back_pressure=parameters.back_pressure,
        compression_ratio=parameters.compression_ratio,
    )  # fmt: skip


def piston_area(bore: Metre[Scalar]) -> Area[Scalar]:
    r"""Area of a piston.

    .. math:: A = \pi B^2/4

    bore: diameter.
    """
    return np.pi / 4 * bore**2


def travel(
    motion: Motion, phi: Radian[Scalar]
) -> tuple[Metre[Scalar], MetrePerRadian[Scalar], MetrePerRadian2[Scalar]]:
    """Travel of one piston and its first two derivatives with respect to the crank angle.

    phi: crank angle from top dead centre. Returns x: travel from top dead centre; dx_dphi: first derivative; d2x_dphi2:
    second derivative.
    """
    parameters = list(motion.parameters.values())
    symbolic = isinstance(phi, (ca.SX, ca.MX)) or any(isinstance(p, (ca.SX, ca.MX)) for p in parameters)
    if symbolic:
        return motion.function(phi, ca.vertcat(*parameters))
    angles = np.asarray(phi, float)
    if batch := over_arrays(motion.function, angles.size):
        columns = batch(angles, *parameters)
    else:
        columns = motion.function(angles.reshape(1, -1), np.asarray(parameters, float).reshape(-1, 1))
    x, dx, d2x = (np.asarray(c).reshape(angles.shape) for c in columns)
    return (x, dx, d2x) if angles.ndim else (float(x), float(dx), float(d2x))


def volume(chamber: Chamber, phi: Radian[Scalar]) -> Volume[Scalar]:
    r"""Volume of the chamber.

    .. math:: V = V_c + n A x(\varphi)

    phi: crank angle from top dead centre.
    """
    return volume_and_slope(chamber, phi)[0]


def dvolume_dphi(chamber: Chamber, phi: Radian[Scalar]) -> Annotated[Scalar, "m^3/rad"]:
    r"""Slope of the volume.

    .. math:: V' = n A x'(\varphi)

    phi: crank angle from top dead centre. Returns dv_dphi: derivative.
    """
    return volume_and_slope(chamber, phi)[1]


def volume_and_slope(chamber: Chamber, phi: Scalar) -> tuple[Scalar, Scalar]:
    """Both at once: `volume` [m^3] and `dvolume_dphi` [m^3/rad]."""
    x, dx, _ = travel(chamber.motion, phi)
    return chamber.clearance + chamber.pistons * chamber.area * x, chamber.pistons * chamber.area * dx


def moving_mass(motion: Motion) -> Kilogram[Scalar]:
    """Mass that moves with one piston. Returns mass: sum of the parameters named in `masses`."""
    return sum(motion.parameters[name] for name in motion.masses)


def wall_area(chamber: Chamber, v: Volume[Scalar]) -> Area[Scalar]:
    """Surface that the gas touches.

    .. math:: A_w = 2 A + 4 V/B

    v: volume of the chamber. Returns area: two crowns, or crown and flat head, and the liner between them.
    Source: Nunes (2017), eq. (2.40), for a cylinder closed by two flat ends.
    """
    return 2 * chamber.area + 4 * v / chamber.bore


def piston_force(
    chamber: Chamber, phi: Radian[Scalar], omega: RadPerSecond[Scalar], p: Pascal[Scalar]
) -> Newton[Scalar]:
    r"""Force that one piston hands to its mechanism at constant speed, from pressure and inertia.

    .. math:: F = (p - p_b) A - m\,x''\omega^2

    phi: crank angle from top dead centre; p: absolute pressure in the chamber. Returns force: positive away from the
    head. Source: Nunes (2017), eqs. (2.62) to (2.64), whose acceleration is -x'' omega^2.
    """
    net = (p - chamber.back_pressure) * chamber.area
    return net - moving_mass(chamber.motion) * travel(chamber.motion, phi)[2] * omega**2


_STILL = 1e-9  # slope of a piston that stands still, by its stroke [1/rad]


def chamber_over(kinematics: ca.Function, bore: Metre, compression_ratio: Pure, back_pressure: Pascal = 0.0) -> Chamber:
    """The chamber under a head, over a mechanism with one coordinate.

    kinematics: one input, the crank angle [rad]; named outputs `x` [m] and `dx_dphi` [m/rad]. bore: diameter of the
    piston. compression_ratio: largest volume by smallest volume. back_pressure: absolute pressure on the other side of
    the piston. Returns chamber: its stroke is x at bottom dead centre. Valid: top dead centre at 0, one bottom dead
    centre in a turn.
    """
    motion = motion_over(kinematics)
    stroke, area = travel(motion, motion.bottom)[0], piston_area(bore)
    ranges = (("bore", bore, 0.0), ("compression_ratio", compression_ratio, 1.0), ("stroke", stroke, 0.0))
    for name, value, least in ranges:
        if not value > least:
            raise BadInput(f"{name} = {value:g} is out of range; it must be > {least:g}")
    return Chamber(
        motion=motion, pistons=1, bore=bore, area=area, stroke=stroke, displacement=area * stroke,
        clearance=area * stroke / (compression_ratio - 1), back_pressure=back_pressure,
        compression_ratio=compression_ratio,
    )  # fmt: skip


def motion_over(kinematics: ca.Function) -> Motion:
    """The motion of a piston without mass; argument as for `chamber_over`."""
    phi, none = ca.SX.sym("phi"), ca.SX.sym("none", 0)
    values = dict(zip(kinematics.name_out(), kinematics.call([phi]), strict=True))
    x, dx = values["x"], values["dx_dphi"]
    function = ca.Function("travel", [phi, none], [x, dx, ca.jacobian(dx, phi)])
    return with_bottom(Motion(name="piston", function=function, parameters={}, masses=()))


def with_bottom(motion: Motion) -> Motion:
    """The motion with its bottom dead centre, which an offset or an articulated rod moves away from pi.

    Raises BadInput: the piston goes out and back more than once in a turn.
    """
    phi = np.linspace(0.0, 2 * np.pi, 361)
    x, slope, _ = travel(motion, phi)
    stroke = float(np.ptp(x))
    if not stroke > 0 or abs(float(travel(motion, np.pi)[1])) <= _STILL * stroke:
        return motion
    ways = np.sign(slope[np.abs(slope) > _STILL * stroke])
    if (count := int(np.sum(np.diff(ways) < 0))) != 1:
        raise BadInput(f"the piston goes out and back {count} times in a turn; a cycle knows one bottom dead centre")
    best = int(np.argmax(x))
    low, high = phi[best - 1], phi[best + 1]
    return dataclasses.replace(motion, bottom=root(lambda a: float(travel(motion, a)[1]), low, high, xtol=1e-15))


def check_motion(motion: Motion) -> None:
    """Refuse a motion whose dead centres are not where the chamber expects them."""
    x, dx, _ = travel(motion, np.append(np.linspace(0.0, 2 * np.pi, 181), motion.bottom))
    stroke = x.max()
    if not stroke > 0 or abs(x[0]) > 1e-9 * stroke or x.min() < -1e-9 * stroke:
        raise BadInput(f"motion {motion.name!r}: travel must be 0 at phi = 0 and positive elsewhere; min {x.min():g} m")
    if abs(dx[-1]) > 1e-9 * stroke or x[-1] < (1 - 1e-9) * stroke:
        raise BadInput(
            f"motion {motion.name!r}: no bottom dead centre at phi = {motion.bottom:g} rad; set its `bottom`"
        )

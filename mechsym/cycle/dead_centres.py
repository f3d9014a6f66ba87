"""A piston's motion made ready for a chamber: its dead centres found, and refused where a cycle knows none."""

import dataclasses

import casadi as ca
import numpy as np
import scipy

from mechsym.cycle.chamber import Chamber, Motion, piston_area, travel
from mechsym.errors import BadInput
from mechsym.quantities.units import Metre, Pascal, Pure

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
    found = dict(zip(kinematics.name_out(), kinematics.call([phi]), strict=True))
    x, dx = found["x"], found["dx_dphi"]
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
    return dataclasses.replace(
        motion, bottom=float(scipy.optimize.brentq(lambda a: float(travel(motion, a)[1]), low, high, xtol=1e-15))
    )


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

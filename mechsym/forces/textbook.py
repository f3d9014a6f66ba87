r"""The force chains that the sources print, with the rod as two masses, beside the exact rigid-body forces.

              F (on the piston, away from the head)     beta = psi, the rod's angle; alpha = phi
              |
     N <------+------   B = F / cos beta along the rod  Z towards the shaft, T in the sense of rotation
              |\
              | \ B     Z_B = B cos(alpha + beta), T = B sin(alpha + beta)

Two masses that carry the rod's mass and centre of mass have the inertia m_b a b instead of I_C2; Terskih's rule moves
the centre of mass as well. Their error in the torque is (I_C2 - m_b a b) omega^2 psi' psi''.
"""

import dataclasses
import functools
import math
from typing import Annotated

import numpy as np

from mechsym.errors import BadInput
from mechsym.forces.loads import loads, radial, tangential
from mechsym.forces.turn import Turn, at, crank_drive
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.roles import RodRole
from mechsym.quantities import record
from mechsym.quantities.units import Pure, RadPerSecond

_FREE_FALL = 9.81  # [m/s^2]


@record
class SliderCrank:
    """A slider crank in the letters of the sources."""

    #: Crank radius and rod length [m]
    R: float
    L: float
    L_m: float  #: Crank pin to the rod's centre of mass [m]
    #: Mass of the rod [kg] and its inertia about the centre of mass [kg*m^2]
    m_b: float
    I_b: float
    m_p: float  #: Mass that moves with the piston: piston, piston rod, crosshead [kg]
    u_c: float  #: Unbalance of the crank on the pin's side [kg*m]


@record
class Chain:
    """The whole chain of Moroianu (2017), arrays of shape (n,)."""

    #: Pressure force, inertia force of the masses in translation, their sum [N]
    F_p: np.ndarray
    F_it: np.ndarray
    F: np.ndarray
    #: Along the rod, across the cylinder [N]
    B: np.ndarray
    N: np.ndarray
    #: On the crank pin towards the shaft, and in the sense of rotation [N]
    Z_B: np.ndarray
    T: np.ndarray
    F_ibm: np.ndarray  #: Inertia force of the rod's share on the crank pin, towards the shaft [N]
    Z: np.ndarray  #: Total towards the shaft [N]
    M: np.ndarray  #: Torque [N*m]


def terskih(omega: RadPerSecond) -> Pure:
    r"""Place of a rod's centre of mass after Terskih, as part of its length from the crank pin.

    .. math:: L_m / L = 0.2\,\frac{(0.001 n)^2 + 2}{(0.001 n)^2 + 1}, \quad n \text{ in rpm}

    Returns ratio: between 0.2 (fast) and 0.4 (slow). Source: Moroianu (2017), eq. (3). Empirical.

    >>> round(terskih(89 * math.pi / 30), 4)
    0.3984
    """
    n = (0.001 * omega * 30 / math.pi) ** 2
    return 0.2 * (n + 2) / (n + 1)


def slider_crank(turn: Turn) -> SliderCrank:
    """The slider crank of a turn in the letters of the sources, with the true centre of mass of the rod."""
    letters = turn.drive.mechanism.parameters
    if (rod := rod_of(turn)) is None:
        raise BadInput(f"the chain of Moroianu is that of a slider crank, not of {turn.drive.name}")
    sizes = (rod.throw, rod.length, rod.centre, rod.mass, rod.inertia, rod.moving, rod.unbalance)
    R, L, L_m, m_b, I_b, m_p, u_c = (float(amount(size, letters)) for size in sizes)
    return SliderCrank(R=R, L=L, L_m=L_m, m_b=m_b, I_b=I_b, m_p=m_p, u_c=u_c)


def rod_of(turn: Turn) -> RodRole | None:
    """The rod of a single slider crank; None where there is no such, or several."""
    rods = [rod for rod in turn.drive.roles.rods if rod.swing]
    return rods[0] if len(rods) == 1 else None


def chain(turn: Turn, ratio: Pure) -> Chain:
    r"""Moroianu's chain with the rod's mass at its two ends.

    .. math::
        F = F_p + F_{it}, \; B = F/\cos\beta, \; N = F\tan\beta, \;
        Z = B\cos(\alpha+\beta) + F_{ibm}, \; T = B\sin(\alpha+\beta), \; M = T R

    ratio: L_m / L: the rod's centre of mass from the crank pin, as part of its length.
    Source: Moroianu (2017), eqs. (2), (4), (6) to (13). The share on the crank pin, m_b (1 - L_m/L), is not printed.
    Valid: constant speed, no weight.
    """
    s, alpha, piston, q = slider_crank(turn), turn.phi, turn.drive.roles.pistons[0], turn.drive.mechanism.coordinates[0]
    beta = turn.kinematics[str(turn.drive.roles.rods[0].swing)]
    m_bp, m_bm = s.m_b * ratio, s.m_b * (1 - ratio)
    F_p = turn.inputs.get(piston.force, np.zeros_like(alpha))
    F_it = -(s.m_p + m_bp) * turn.kinematics[f"d2{piston.travel}_d{q}2"] * turn.omega**2
    F = F_p + F_it
    B = F / np.cos(beta)
    Z_B, T = B * np.cos(alpha + beta), B * np.sin(alpha + beta)
    F_ibm = np.full_like(alpha, -m_bm * s.R * turn.omega**2)
    return Chain(F_p=F_p, F_it=F_it, F=F, B=B, N=F * np.tan(beta), Z_B=Z_B, T=T, F_ibm=F_ibm, Z=Z_B + F_ibm, M=T * s.R)


def errors(turn: Turn, approximate: Chain) -> dict[str, Pure]:
    """How far a chain is from the exact rigid-body forces without weight, which the chain leaves out.

    Returns errors: for N, Z, T, M and the loads of crank pin and main bearing: largest difference over the largest
    exact value.
    """
    return _shares(_approximate(turn, approximate), _exact(turn, 0.0))


def weight_shares(turn: Turn) -> dict[str, Pure]:
    """What the weights do to the forces, which the chain leaves out; also where the case leaves them out (g = 0).

    Returns shares: for the same quantities as `errors`: largest change by the weights over the largest value without.
    """
    return _shares(_exact(turn, _FREE_FALL), _exact(turn, 0.0))


def with_weight(turn: Turn, g: Annotated[float, "m/s^2"]) -> Turn:
    """The same cycle under another gravity. g: acceleration of free fall."""
    rod, parameters = rod_of(turn), turn.drive.parameters
    if rod is not None and rod.gravity is not None:
        parameters = dataclasses.replace(parameters, **{rod.gravity: g})
    return at(crank_drive(turn.drive.name, parameters), turn.acting, turn.omega, turn.phi)


# every chain is held against the same
@functools.lru_cache(maxsize=4)
def _exact(turn: Turn, g: float) -> dict[str, np.ndarray]:
    weighted = with_weight(turn, g)
    carried = loads(weighted)
    pin = carried.pins[0]
    return {
        "N": next(iter(carried.guides.values())),
        "Z": -radial(pin),
        "T": tangential(pin),
        "M": weighted.torque,
        "crank_pin": np.hypot(pin.x, pin.y),
        "main_bearing": np.hypot(*next(iter(carried.bearings.values()))),
    }


def _approximate(turn: Turn, chain: Chain) -> dict[str, np.ndarray]:
    # the crank's own unbalance pulls the main bearing outwards, against Z
    pull = slider_crank(turn).u_c * turn.omega**2
    loads = {"crank_pin": np.hypot(chain.Z, chain.T), "main_bearing": np.hypot(chain.Z - pull, chain.T)}
    return {n: getattr(chain, n) for n in "NZTM"} | loads


def _shares(approximate: dict[str, np.ndarray], exact: dict[str, np.ndarray]) -> dict[str, float]:
    return {n: float(np.abs(approximate[n] - v).max() / np.abs(v).max()) for n, v in exact.items()}

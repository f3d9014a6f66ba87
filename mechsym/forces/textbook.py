r"""The force chains that the sources print, with the rod as two masses, beside the exact rigid-body forces.

              F (on the piston, away from the head)     beta = psi, the rod's angle; alpha = phi
              |
     N <------+------   B = F / cos beta along the rod  Z towards the shaft, T in the sense of rotation
              |\
              | \ B     Z_B = B cos(alpha + beta), T = B sin(alpha + beta)

Two masses that carry the rod's mass and centre of mass have the inertia m_b a b instead of I_C2; Terskih's rule moves
the centre of mass as well. Their error in the torque is (I_C2 - m_b a b) omega^2 psi' psi''.

Cylinder pressure out of the torque that was measured on the shaft: the force chain taken backwards.

At constant speed the derived equations are straight lines in the pressure, at every angle of their own:

.. math::
    M(\varphi) = M_0(\varphi) + (p - p_\mathrm{back})\,h(\varphi), \qquad
    M_0 = -\tfrac12 I'(\varphi)\,\omega^2 - V'(\varphi), \qquad h = A\,x'(\varphi)

At a dead centre x' = 0: no torque tells of the pressure, and none is told there.
"""

import dataclasses
import functools
import math
from collections.abc import Mapping
from typing import Annotated

import numpy as np

from mechsym.errors import BadInput
from mechsym.forces.loads import loads, radial, tangential
from mechsym.forces.turn import Turn, at, crank_drive
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.arrays import along
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.roles import RodRole
from mechsym.quantities import quantity, record
from mechsym.quantities.units import (
    NORMAL_95,
    Area,
    Array,
    Joule,
    NewtonMetre,
    Pascal,
    Pure,
    Radian,
    RadPerSecond,
    Scalar,
)

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
    # the crank's own unbalance pulls the main bearing outwards, against Z
    pull = slider_crank(turn).u_c * turn.omega**2
    loads = {
        "crank_pin": np.hypot(approximate.Z, approximate.T),
        "main_bearing": np.hypot(approximate.Z - pull, approximate.T),
    }
    return _shares({n: getattr(approximate, n) for n in "NZTM"} | loads, _exact(turn, 0.0))


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


def _shares(approximate: dict[str, np.ndarray], exact: dict[str, np.ndarray]) -> dict[str, float]:
    return {n: float(np.abs(approximate[n] - v).max() / np.abs(v).max()) for n, v in exact.items()}


_DEAD = 1e-6  # of the largest lever: below it the round-off of the torque is all that is left


@record
class CrankTorque:
    """The torque of a shaft at constant speed, as it was measured."""

    phi: np.ndarray  #: shape (n,): Crank angles, ascending [rad]
    torque: np.ndarray  #: shape (n,): On the load, positive driving it [N*m]
    omega: float = quantity("rad/s", about="speed of the shaft")
    noise: float = quantity("N*m", about="standard deviation of each torque")
    with_inertia: bool = True  #: Whether the moving masses and weights are in the torque


@record
class IndicatedPressure:
    """Absolute pressure in the cylinder where the torque tells it."""

    phi: np.ndarray  #: shape (n,): Crank angles [rad]
    p: np.ndarray  #: shape (n,): Absolute pressure; finite and without meaning where not `clear` [Pa]
    error: np.ndarray  #: shape (n,): Its standard deviation [Pa]
    clear: np.ndarray  #: shape (n,): Whether the torque tells the pressure there [-]
    gas: np.ndarray  #: shape (n,): Torque of the gas [N*m]
    lever: np.ndarray  #: shape (n,): Torque by pressure h [N*m/Pa]
    limit: float  #: Widest half of a 95 % interval that counts as clear [Pa]


def shaft_lines(
    mechanism: Mechanism, areas: Mapping[str, Area], phi: Radian[Array], omega: RadPerSecond, held: Mapping[str, float]
) -> tuple[NewtonMetre[Array], Annotated[Array, "N*m/Pa"]]:
    r"""Torque on the load without gas, and how much of it a pressure adds.

    .. math:: M_0 = Q(0) - b, \qquad h = Q(A) - Q(0)

    with generalised force Q and bias b of the derived equations at constant speed. mechanism: reduced to the angle of
    its shaft, as `crank_drive` builds it; areas: by input the force that one pascal gives it, with its sign; held:
    inputs that do not change [N] or [N*m]. Source: derived here, from the equations of the mechanism. Valid at constant
    speed. A crank of 1 m, massless but for its rotor, and a long rod: at 90 degrees each newton on the piston is one
    newton metre.

    >>> from mechsym.mechanisms import bind
    >>> letters = dict(r1=0.5, r2=0.5, l1=5e4, l2=5e4, m1=0, m2=0, m3=0, m4=0, m5=0, I01=1, IC2=0, g=0, axis_tilt=0)
    >>> idle, lever = shaft_lines(bind("crosshead", letters), {"F": 1.0}, np.array([np.pi / 2]), 10.0,
    ...                           {"M_r": 0.0, "M_h": 0.0})
    >>> round(float(lever[0]), 4)
    1.0
    """
    (q,) = mechanism.coordinates
    letters: dict[str, Scalar] = {q: phi, f"{q}d": np.full_like(phi, omega), **held}
    dynamics = mechanism.functions["dynamics"]

    def torque(push: Mapping[str, Scalar]) -> tuple[np.ndarray, np.ndarray]:
        _, bias, force = along(dynamics, letters | dict(push)).values()
        return force.ravel() + 0 * phi, bias.ravel() + 0 * phi

    none, bias = torque({})
    lever, _ = torque({name: held.get(name, 0.0) + area for name, area in areas.items()})
    return none - bias, lever - none


def pressure_from_torque(
    measured: CrankTorque, idle: NewtonMetre[Array], lever: Annotated[Array, "N*m/Pa"], p_back: Pascal
) -> IndicatedPressure:
    r"""Pressure out of a measured torque, with the uncertainty that the noise of the torque gives it.

    .. math:: p = p_\mathrm{back} + \frac{M - M_0}{h}, \qquad \sigma_p = \frac{\sigma_M}{|h|}

    Told is what has a 95 % interval of a half width below the pressure that the largest gas torque shows at the largest
    lever: :math:`1.96\,\sigma_p < \max|M - M_0| / \max|h|`. The gap about a dead centre grows with the noise. idle,
    lever: M_0 and h, as `shaft_lines` gives them; p_back: absolute pressure on the other side of the piston. Returns
    pressure: at every angle of the torque [Pa]. Raises BadInput: the noise is as large as the torque.
    Source: derived here. Valid for independent normal noise of the torque; friction in the torque counts as gas, an
    error of the angle or of the masses is not in the interval.

    >>> one = CrankTorque(phi=np.array([1.0]), torque=np.array([30.0]), omega=100.0, noise=1.0)
    >>> indicated = pressure_from_torque(one, np.array([10.0]), np.array([1e-4]), 1e5)
    >>> round(float(indicated.p[0])), round(float(indicated.error[0]))
    (300000, 10000)
    """
    gas = measured.torque - (idle if measured.with_inertia else 0.0)
    size = np.abs(lever)
    limit = float(np.abs(gas).max() / size.max())
    turning = size > _DEAD * size.max()
    safe = np.where(turning, lever, size.max())
    error = measured.noise / np.abs(safe)
    clear = turning & (NORMAL_95 * error < limit)
    if not clear.any():
        raise BadInput(
            f"noise = {measured.noise:g} N*m hides the torque of the gas, at most {np.abs(gas).max():g} N*m; "
            f"below {np.abs(gas).max() / NORMAL_95:.4g} N*m it tells a pressure: average more cycles"
        )
    p = p_back + gas / safe
    return IndicatedPressure(phi=measured.phi, p=p, error=error, clear=clear, gas=gas, lever=lever, limit=limit)


def work(measured: CrankTorque, pressure: IndicatedPressure, period: Radian) -> tuple[Joule, Joule]:
    r"""Work of the gas over a cycle, which needs no pressure and knows no gap, with its standard deviation.

    .. math:: W = \oint (M - M_0)\,d\varphi \approx \sum_i w_i (M - M_0)_i, \qquad
        \sigma_W = \sigma_M \sqrt{\sum_i w_i^2}

    period: 2 pi or 4 pi, over which the rows go.
    Source: trapezoidal rule over a period. Valid for rows that resolve the torque.

    >>> phi = np.arange(4) * np.pi / 2
    >>> one = CrankTorque(phi=phi, torque=np.array([1.0, 3.0, 1.0, 3.0]), omega=1.0, noise=0.1)
    >>> indicated = pressure_from_torque(one, np.zeros(4), np.ones(4), 0.0)
    >>> [round(v, 3) for v in work(one, indicated, 2 * np.pi)]
    [12.566, 0.314]
    """
    around = np.concatenate([[pressure.phi[-1] - period], pressure.phi, [pressure.phi[0] + period]])
    weights = (around[2:] - around[:-2]) / 2
    return float(weights @ pressure.gas), float(measured.noise * np.sqrt(weights @ weights))


def scatter(torque: NewtonMetre[Array]) -> NewtonMetre:
    r"""Standard deviation of the noise that a smooth curve shows by itself.

    .. math:: \sigma \approx 1.4826\,\mathrm{median}|\Delta^3 M| / \sqrt{20}

    torque: rows one after the other.
    Source: third differences of independent noise have 20 times its variance. Valid for steps that are even and small.

    >>> scatter(np.arange(9.0) ** 2)
    0.0
    """
    return float(1.4826 * np.median(np.abs(np.diff(torque, 3))) / np.sqrt(20.0))


def gaps(pressure: IndicatedPressure) -> list[tuple[Radian, Radian]]:
    """Angles where nothing is told [rad]. Returns gaps: first and last row without a pressure, one pair a gap."""
    edges = np.flatnonzero(np.diff(np.concatenate([[True], pressure.clear, [True]]).astype(int)))
    return [(float(pressure.phi[a]), float(pressure.phi[b - 1])) for a, b in zip(edges[::2], edges[1::2], strict=True)]

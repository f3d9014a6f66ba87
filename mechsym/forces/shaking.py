r"""What shakes the frame, by orders, and what a counterweight on the crank can do about it.

The frame feels the opposite of the rates of momentum. The force of order one is a vector that turns with the crank and
one that turns against it,

.. math:: S_x + i S_y = c_+ e^{i\varphi} + c_- e^{-i\varphi} + \dots

A counterweight on the crank only has the first: the one that leaves the least mean square cancels c_+ exactly. For a
single slider crank that is half of the reciprocating mass. On a shaft of several throws two counterweights, one at each
end, cancel the part of force and couple that turns with the crank, and so leave the least mean square of both.
"""

import cmath
import math

import numpy as np

from mechsym.forces.harmonics import Harmonics, orders, whole
from mechsym.forces.loads import roll_sense
from mechsym.forces.turn import Turn, chain_of
from mechsym.mechanisms.chain import stroke_force
from mechsym.quantities import quantity, record

_NAMES = {
    "force_x": "momentum_rate_x",
    "force_y": "momentum_rate_y",
    "rocking_x": "rocking_rate_x",
    "rocking_y": "rocking_rate_y",
}


@record
class BalanceWanted:
    """Section `[shaking]`: which balance is asked for."""

    #: Whole orders that shall vanish, for example 1 and 2 [-]
    orders: tuple[float, ...] = quantity("-", low=1, about="orders that shall vanish")
    #: What may be left of each, as part of the force (couple) of one cylinder's reciprocating mass [-]
    limit: float = quantity("-", default=1e-3, above=0, below=1, about="what may be left of each order")


@record
class Counterweight:
    """The counterweight on the crank that leaves the least mean square of the shaking force."""

    unbalance: float  #: Mass times radius [kg*m]
    angle: float  #: Where it stands on the crank, from the crank angle's zero in the sense of rotation [rad]
    #: Root mean square of the shaking force without and with it [N]
    rms_before: float
    rms_after: float


@record
class PlaneWeight:
    """One of two counterweights that balance force and couple together."""

    z: float  #: Place along the shaft [m]
    unbalance: float  #: Mass times radius [kg*m]
    angle: float  #: Where it stands at shaft angle 0, in the sense of rotation [rad]


@record
class Shaking:
    """Forces and moments on the frame at constant speed."""

    #: shape (n,): `force_x`, `force_y` [N], `roll` [N*m], and of a crank train `rocking_x`, `rocking_y` [N*m]
    curves: dict[str, np.ndarray]
    orders: dict[str, Harmonics]
    counterweight: Counterweight
    #: Best pair at the ends of a shaft whose throws all turn one way; empty for a single throw
    planes: tuple[PlaneWeight, ...]


def shaking(turn: Turn) -> Shaking:
    """Shaking forces and moments of a turn."""
    curves = {name: -turn.momentum[key] for name, key in _NAMES.items() if key in turn.momentum}
    curves["roll"] = -(turn.momentum["angular_momentum_rate"] + roll_sense(turn) * turn.torque)
    found = {name: orders(values, turn.period) for name, values in curves.items()}
    counterweight, planes = _counterweight(turn, curves), _planes(turn, curves)
    return Shaking(curves=curves, orders=found, counterweight=counterweight, planes=planes)


def _counterweight(turn: Turn, curves: dict[str, np.ndarray]) -> Counterweight:
    force = curves["force_x"] + 1j * curves["force_y"]
    with_crank = np.mean(force * np.exp(-1j * turn.phi))
    rest = force - with_crank * np.exp(1j * turn.phi)
    # an unbalance u at the angle a pulls the frame with u omega^2 e^{i (phi + a)}
    return Counterweight(
        unbalance=float(abs(with_crank) / turn.omega**2),
        angle=float(cmath.phase(-with_crank) % (2 * math.pi)) if with_crank != 0 else 0.0,
        rms_before=float(np.sqrt(np.mean(np.abs(force) ** 2))),
        rms_after=float(np.sqrt(np.mean(np.abs(rest) ** 2))),
    )


def _planes(turn: Turn, curves: dict[str, np.ndarray]) -> tuple[PlaneWeight, ...]:
    ends = chain_of(turn.drive).ends(turn.drive.parameters)
    if ends is None:
        return ()
    z = np.array(ends)
    force, couple = (curves[f"force_{n}"] for n in "xy"), (curves["rocking_y"], -curves["rocking_x"])
    turning = [np.mean((x + 1j * y) * np.exp(-1j * turn.phi)) for x, y in (tuple(force), couple)]
    found = np.linalg.solve(np.array([[1.0, 1.0], z]), -np.array(turning) / turn.omega**2)
    return tuple(
        PlaneWeight(z=float(place), unbalance=float(abs(u)), angle=cmath.phase(u) % (2 * math.pi))
        for place, u in zip(z, found.tolist(), strict=True)
    )


def verdict(turn: Turn, found: Shaking, wanted: BalanceWanted) -> list[str]:
    """Why an arrangement does not have the balance that was asked for.

    Returns
    -------
    reasons : list of str
        One sentence for each force or moment that is left; empty when the balance is reached
    """
    reasons = []
    for order in wanted.orders:
        for name, unit in (("force_x", "N"), ("force_y", "N"), ("rocking_x", "N m"), ("rocking_y", "N m")):
            if name not in found.orders:
                continue
            left, scale = abs(whole(found.orders[name], int(order))), _scale(turn, name)
            if scale > 0 and left > wanted.limit * scale:
                reasons.append(
                    f"order {order:g} of {name} is left with {left:.4g} {unit}, {100 * left / scale:.3g} % of one "
                    f"cylinder's; {chain_of(turn.drive).advice(turn, name, int(order))}"
                )
    return reasons


def _scale(turn: Turn, name: str) -> float:
    """Force of one cylinder's reciprocating mass, for a couple times the length of the shaft."""
    chain, mass = chain_of(turn.drive), chain_of(turn.drive).mass
    force = chain.inertia(turn) if chain.inertia is not None else stroke_force(turn, mass(turn.drive))
    return force * (chain.lever(turn.drive.parameters) if name.startswith("rocking") else 1.0)

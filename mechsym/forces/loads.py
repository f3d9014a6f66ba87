r"""Reactions of every mechanism under the names of its parts, as the roles of its declaration say.

Forces on the crank pin are those of the rod (planet, link) on the crank: radial positive outwards, tangential positive
in the sense of rotation. The side force is that of the guide on the piston or slider. Bearing forces are those on the
crank, in the frame; the same forces turned into the crank give the polar diagram of the pin.

The frame feels the opposite of the rates of momentum. The force of order one is a vector that turns with the crank and
one that turns against it,

.. math:: S_x + i S_y = c_+ e^{i\varphi} + c_- e^{-i\varphi} + \dots

A counterweight on the crank only has the first: the one that leaves the least mean square cancels c_+ exactly. For a
single slider crank that is half of the reciprocating mass. On a shaft of several throws two counterweights, one at each
end, cancel the part of force and couple that turns with the crank, and so leave the least mean square of both.

An order k counts oscillations per turn of the crank; a four-stroke cycle has half orders too.
"""

import cmath
import math
from collections.abc import Mapping

import numpy as np

from mechsym.forces.mains import place
from mechsym.forces.turn import Turn, main_roles, mass_with
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.roles import PartRoles, resultants
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Array, Newton, NewtonMetre, Pure, Radian


@record
class Pin:
    """A crank pin with what acts on it."""

    name: str  #: `crank_pin`, or `crank_pin_3` of a crank train
    angle: np.ndarray  #: shape (n,): Angle of its crank from the x axis of the frame [rad]
    radius: float  #: Crank radius [m]
    sense: float  #: Sense of rotation, 1 or -1 [-]
    #: shape (n,): Force on the crank pin, in the frame [N]
    x: np.ndarray
    y: np.ndarray


@record
class Loads:
    """The loads that bearings and guides carry."""

    pins: tuple[Pin, ...]
    bearings: Mapping[str, tuple[np.ndarray, np.ndarray]]  #: Main bearings by name: force on the crank in the frame [N]
    guides: Mapping[str, np.ndarray]  #: Side forces by name [N]
    weight_torque: np.ndarray  #: shape (n,): Torque of the crank's own weight [N*m]


def under_own_name(roles: PartRoles) -> set[str]:
    """Reactions that a bearing or a guide has under its own name."""
    of_bearings = {name for bearing in roles.bearings if bearing.at for name in bearing.reactions}
    return of_bearings | {guide.reaction for guide in roles.guides if guide.at and guide.reaction}


def with_resultants(reactions: Mapping[str, Newton[Array]]) -> dict[str, Newton[Array]]:
    """Reactions [N] or [N*m] and, behind them, the resultant of each joint that bears along several axes."""
    every = dict(reactions)
    for name, parts in resultants(reactions).items():
        every[name] = np.linalg.norm([reactions[part] for part in parts], axis=0)
    return every


def loads(turn: Turn) -> Loads:
    """The loads of a turn."""
    roles, R, letters = turn.drive.roles, turn.reactions, turn.drive.mechanism.parameters
    pins = []
    for role in roles.bearings:
        if role.throw is not None:
            x, y = (-R[name] for name in role.reactions)
            angle = role.sense * (turn.phi + role.phase)
            radius = float(amount(role.throw, letters))
            pins.append(Pin(name=role.name, angle=angle, radius=radius, sense=role.sense, x=x, y=y))
    none = np.zeros_like(turn.phi)
    known = {**letters, turn.drive.mechanism.coordinates[0]: turn.phi}
    mains = main_roles(turn)
    return Loads(
        pins=tuple(pins),
        bearings={role.name: (R[role.reactions[0]], R[role.reactions[1]]) for role in mains},
        guides={role.name: none if role.reaction is None else R[role.reaction] for role in roles.guides if role.at},
        weight_torque=sum((amount(rotor.weight, known) for rotor in roles.rotors), none),
    )


def pin_torque(loads: Loads) -> NewtonMetre[Array]:
    """Torque on the crank from the forces on its pins, together with that of the crank's weight."""
    return loads.weight_torque + sum(pin.radius * tangential(pin) for pin in loads.pins)


def radial(pin: Pin) -> Newton[Array]:
    """Force on a crank pin along its crank. Returns force: positive outwards."""
    return pin.x * np.cos(pin.angle) + pin.y * np.sin(pin.angle)


def tangential(pin: Pin) -> Newton[Array]:
    """Force on a crank pin across its crank. Returns force: positive in the sense of rotation."""
    return pin.sense * (pin.y * np.cos(pin.angle) - pin.x * np.sin(pin.angle))


def power_residual(turn: Turn, loads: Loads) -> Pure:
    """Largest gap between the power from the energies and that from the forces on the crank.

    Returns residual: relative to the largest power of gas or load; where the declaration names no crank pin, the gap to
    the power that the equations of motion ask for.
    """
    # torques below a millionth of I omega^2 are rounding beside what moves, as in a gear set that nothing drives
    still = 1e-6 * np.max(turn.kinematics.get("inertia", 0.0)) * turn.omega**3
    size = max(np.abs(turn.gas_power).max(), np.abs(turn.torque * turn.omega).max(), still)
    other = pin_torque(loads) if loads.pins else -turn.driving
    return float(np.abs(other - turn.torque).max() * turn.omega / size) if size > 0 else 0.0


def polar(loads: Loads) -> dict[str, tuple[Newton[Array], Newton[Array]]]:
    """Polar diagrams: loads on the pins in their cranks, on the main bearings in the frame.

    Returns curves: by name: along the crank and across it for a pin, x and y for a bearing; what the shaft presses with
    is the opposite of what it is pressed with.
    """
    pins = {pin.name: (radial(pin), tangential(pin)) for pin in loads.pins}
    return pins | {name: (-x, -y) for name, (x, y) in loads.bearings.items()}


def roll_sense(turn: Turn) -> Pure:
    """Sense, 1 or -1, of the shaft end that carries the load: the flywheel stands behind the last throw."""
    mains = main_roles(turn)
    return mains[-1].sense if mains else 1.0


_ROUND_OFF = 1e-10  #: Share of the largest amplitude below which an order is round-off and has no phase [-]


@record
class Harmonics:
    """Harmonics of one quantity, arrays of shape (m,)."""

    order: np.ndarray  #: Oscillations per turn, 0 first [-]
    amplitude: np.ndarray  #: a_k; the mean for order 0, with its sign [unit of the quantity]
    phase: np.ndarray  #: delta_k, where the oscillation has its crest; 0 where there is none [rad]


def orders(values: Pure[Array], period: Radian, highest: Pure = 12.0) -> Harmonics:
    """Harmonics of a quantity given at evenly spaced angles.

    values: over one period, without its end, in any unit; period: period, 2 pi or 4 pi; highest: highest order wanted.
    """
    n = len(values)
    spectrum = np.fft.rfft(values) / n
    order = np.arange(len(spectrum)) * 2 * math.pi / period
    wanted = order <= highest + 1e-9
    amplitude = 2 * np.abs(spectrum)
    there = amplitude > _ROUND_OFF * amplitude.max(initial=0.0)
    amplitude[0] = spectrum[0].real
    phase = np.where(there, -np.angle(spectrum), 0.0)
    phase[phase < _ROUND_OFF - math.pi] = math.pi  # the sign of half a turn would be that of round-off
    return Harmonics(order=order[wanted], amplitude=amplitude[wanted], phase=phase[wanted])


def whole(harmonics: Harmonics, order: int) -> complex:
    """One whole order as a complex amplitude a exp(-i delta): the quantity is Re(a exp(i (k phi - delta)))."""
    at = int(np.argmin(np.abs(harmonics.order - order)))
    return complex(harmonics.amplitude[at] * np.exp(-1j * harmonics.phase[at]))


_NAMES = {
    "force_x": "momentum_rate_x",
    "force_y": "momentum_rate_y",
    "force_z": "momentum_rate_z",
    "moment_x": "angular_momentum_rate_x",
    "moment_y": "angular_momentum_rate_y",
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


def shaking(turn: Turn) -> Shaking | None:
    """Shaking forces and moments of a turn; None of a mechanism whose momentum is not known."""
    if not turn.momentum:
        return None
    curves = {name: -turn.momentum[key] for name, key in _NAMES.items() if key in turn.momentum}
    if (roll := roll_moment(turn)) is not None:
        curves["roll"] = roll
    force = curves["force_x"] + 1j * curves["force_y"]
    with_crank = np.mean(force * np.exp(-1j * turn.phi))
    rest = force - with_crank * np.exp(1j * turn.phi)
    along = np.square(curves.get("force_z", np.zeros(1)))  # which no weight on the shaft changes
    # an unbalance u at the angle a pulls the frame with u omega^2 e^{i (phi + a)}
    return Shaking(
        curves=curves,
        orders={name: orders(values, turn.period) for name, values in curves.items()},
        counterweight=Counterweight(
            unbalance=float(abs(with_crank) / turn.omega**2),
            angle=float(cmath.phase(-with_crank) % (2 * math.pi)) if with_crank != 0 else 0.0,
            rms_before=float(np.sqrt(np.mean(np.abs(force) ** 2 + along))),
            rms_after=float(np.sqrt(np.mean(np.abs(rest) ** 2 + along))),
        ),
        planes=_planes(turn, curves),
    )


def roll_moment(turn: Turn) -> np.ndarray | None:
    """Moment on the frame about the shaft; None of a mechanism that does not tell it: shape (n,) [N*m]."""
    rate = turn.momentum.get("angular_momentum_rate")
    return None if rate is None else -(rate + roll_sense(turn) * turn.torque)


def _planes(turn: Turn, curves: dict[str, np.ndarray]) -> tuple[PlaneWeight, ...]:
    """A pair at both ends of a shaft whose throws all turn one way."""
    mains = main_roles(turn)
    places = [place(turn, role) for role in mains]
    if not places or min(places) == max(places) or {role.sense for role in mains} != {1.0}:
        return ()
    z = np.array([min(places), max(places)])
    force, couple = (curves[f"force_{n}"] for n in "xy"), (curves["rocking_y"], -curves["rocking_x"])
    turning = [np.mean((x + 1j * y) * np.exp(-1j * turn.phi)) for x, y in (tuple(force), couple)]
    weights = np.linalg.solve(np.array([[1.0, 1.0], z]), -np.array(turning) / turn.omega**2)
    return tuple(
        PlaneWeight(z=float(place), unbalance=float(abs(u)), angle=cmath.phase(u) % (2 * math.pi))
        for place, u in zip(z, weights.tolist(), strict=True)
    )


def verdict(turn: Turn, shakes: Shaking, wanted: BalanceWanted) -> list[str]:
    """Why an arrangement does not have the balance that was asked for.

    Returns reasons: one sentence for each force or moment that is left; empty when the balance is reached.
    """
    reasons = []
    for order in wanted.orders:
        for name, unit in (("force_x", "N"), ("force_y", "N"), ("rocking_x", "N m"), ("rocking_y", "N m")):
            if name not in shakes.orders:
                continue
            # force of one cylinder's reciprocating mass, for a couple times the length of the shaft
            roles, letters = turn.drive.roles, turn.drive.mechanism.parameters
            force = 0.0
            for part in roles.faces or roles.pistons:
                force = max(
                    force, float(mass_with(part, letters) * np.ptp(turn.kinematics[part.travel]) / 2 * turn.omega**2)
                )
            if name.startswith("rocking"):
                force *= float(np.ptp([place(turn, role) for role in main_roles(turn)] or [0.0]))
            left, scale = abs(whole(shakes.orders[name], int(order))), force
            if scale > 0 and left > wanted.limit * scale:
                reasons.append(
                    f"order {order:g} of {name} is left with {left:.4g} {unit}, {100 * left / scale:.3g} % of one "
                    f"cylinder's; {_advice(turn, shakes, name, int(order))}"
                )
    return reasons


def _advice(turn: Turn, shakes: Shaking, name: str, order: int) -> str:
    """What to do about an order of a shaking force or couple that is left."""
    pins = [role for role in turn.drive.roles.bearings if role.throw is not None]
    names = ", ".join(f"{math.degrees(role.phase) % 360:g}" for role in pins)
    if name.startswith("rocking"):
        return f"cranks at {names} deg are no mirror image about the middle of the shaft; order them symmetrically"
    if "rocking_x" in shakes.orders:
        n = len(main_roles(turn))
        return (
            f"cranks at {names} deg: the arrows exp(i {order} phase) do not add up to zero; {n} equal throws "
            f"{360 / n:g} deg apart cancel every order that is no multiple of {n}"
        )
    return _two_axes(turn, shakes) or (
        "one cylinder cannot balance itself; a counterweight takes at most the part that turns with the crank"
    )


def _two_axes(turn: Turn, shakes: Shaking) -> str:
    """The same of pistons on two axes at right angles, whose forces may add up to one that turns; empty for others."""
    heavy = dict.fromkeys(face.masses for face in turn.drive.roles.faces if face.masses)
    rotor = next((rotor for rotor in turn.drive.roles.rotors if rotor.unbalance), None)
    if len(heavy) != 2 or rotor is None:
        return ""
    letters = turn.drive.mechanism.parameters
    a, b = (masses[0] for masses in heavy)
    m_a, m_b = (float(amount(mass, letters)) for mass in (a, b))
    if m_a != m_b:
        throw = next(role.throw for role in turn.drive.roles.bearings if role.throw is not None)
        return (
            f"{a} = {m_a:g} kg and {b} = {m_b:g} kg: a force ({a} - {b}) {throw} omega^2 turns against the crank, and "
            "no counterweight on it takes that; make the two axes equally heavy"
        )
    has, weight = float(amount(rotor.unbalance, letters)), shakes.counterweight
    wanted = has + weight.unbalance * math.cos(weight.angle)
    return (
        f"the resultant turns with the crank: a counterweight of {rotor.unbalance} = {wanted:.4g} kg m on the "
        f"crank takes all of it, the case has {has:.4g} kg m"
    )

r"""A machine over one cycle at constant speed: gas forces, exact reactions, and the power that they must balance.

At constant speed the load must take, at every angle, what gas, dampers and weight give and the moving masses do not
store:

.. math:: M_\mathrm{load}\,\omega = P_\mathrm{gas} - \frac{d}{dt}(T + V)

The same torque follows from the equations of motion, and from the forces on the crank pins; the largest difference is
the power residual.
"""

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import casadi as ca
import numpy as np

from mechsym import mechanisms
from mechsym.cycle.motion import from_top, slopes, top_of
from mechsym.errors import BadInput
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.arrays import along
from mechsym.mechanisms.closing import ClosingRule, closed
from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.roles import BearingRole, FaceRole, PartRoles, PistonRole
from mechsym.quantities import record
from mechsym.quantities.records import Record
from mechsym.quantities.units import Array, Kilogram, NewtonMetre, Pure, Radian, RadPerSecond

if TYPE_CHECKING:
    from mechsym.cycle.gas import Gas
    from mechsym.mechanisms.closing import RodlessFaces

_STEPS_PER_TURN = 1440
_ROUNDING = 1e-9  # of a torque: less is none [-]


@record
class GasFace:
    """Where gas acts on a mechanism."""

    input: str  #: Takes its force
    travel: str  #: Output by which its piston moves
    fires: float  #: Shaft angle at which it fires [rad]
    area: float | None = None  #: Where it is not that of the bore [m^2]
    sense: float = 1.0  #: 1 where the gas pushes along the travel, else -1 [-]
    mass: float = 0.0  #: That moves with it [kg]
    throw: int = 0  #: Which coordinate turns it
    top: float | None = None  #: Shaft angle at its top dead centre, where it moves otherwise than the first [rad]


@record
class Acting:
    """A cylinder with its gas."""

    face: GasFace
    gas: "Gas"

    @property
    def area(self) -> float:
        """Of its piston [m^2]."""
        return self.gas.chamber.area if self.face.area is None else self.face.area

    def force(self, phi: np.ndarray) -> np.ndarray:
        """On the input that takes it, over the shaft angle [rad]: [N]."""
        net = self.gas.pressure.absolute(phi - self.face.fires) - self.gas.p_back
        return net * self.area if self.face.sense > 0 else -net * self.area


@record
class CrankDrive:
    """A mechanism as its force chain sees it."""

    name: str
    parameters: Record  #: Of the mechanism
    mechanism: Mechanism  #: With one coordinate and all reactions
    roles: PartRoles
    #: Working faces that a case chooses, and how an overconstrained mechanism gives way; None for the others
    faces: "RodlessFaces | None" = None
    closing: ClosingRule | None = None


@record
class Turn:
    """One cycle at constant speed, evenly spaced angles without the last."""

    drive: CrankDrive
    acting: tuple[Acting, ...]
    #: Crank speed [rad/s], period of the cycle [rad]
    omega: float
    period: float
    phi: np.ndarray  #: shape (n,): Crank angles [rad]
    inputs: Mapping[str, np.ndarray]  #: shape (n,): Gas forces, and what else acts, by the mechanism's input
    #: shape (n,): Outputs of the mechanism at these angles
    kinematics: Mapping[str, np.ndarray]
    reactions: Mapping[str, np.ndarray]
    momentum: Mapping[str, np.ndarray]
    torque: np.ndarray  #: shape (n,): Torque for the load, from the energies [N*m]
    driving: np.ndarray  #: shape (n,): Torque that holds the speed, from the equations of motion [N*m]
    gas_power: np.ndarray  #: shape (n,): Power of the gas forces [W]

    # a turn is itself: what is computed of it is kept by identity
    __hash__ = object.__hash__

    @property
    def gas(self) -> "Gas | None":
        """Gas of the first cylinder."""
        return self.acting[0].gas if self.acting else None

    def rate(self, names: str | Sequence[str]) -> np.ndarray:
        """Speed of an output or of the coordinate, or of several that add up: shape (n,) [unit/s]."""
        q, speed = self.drive.mechanism.coordinates[0], np.zeros_like(self.phi)
        for name in (names,) if isinstance(names, str) else names:
            slope: Any = 1.0 if name == q else self.kinematics.get(f"d{name}_d{q}")
            if slope is None:
                slope = np.asarray(slopes(self.drive.mechanism, name, {})(self.phi[None, :])[1]).ravel()
            speed = speed + slope * self.omega
        return speed


Gases: TypeAlias = "Gas | Sequence[Acting] | None"


def turn(drive: CrankDrive, gas: Gases, omega: RadPerSecond) -> Turn:
    """One cycle at a speed.

    gas: of every cylinder alike, or of each; with none of it only inertia and weight act.
    """
    acts = acting(drive, gas)
    return at(drive, acts, omega, angles(period_of(acts)))


def crank_drive(
    name: str, parameters: Record, faces: "RodlessFaces | None" = None, closing: ClosingRule | None = None
) -> CrankDrive:
    """A mechanism with one coordinate and every reaction determined.

    parameters: of the mechanism of that name; a crank train stands on a rigid shaft. faces: record, optional, where gas
    acts, for a mechanism that has a choice. closing: closing rule, optional, what an overconstrained mechanism needs
    besides. Raises BadInput: more than one coordinate is free, or the closing rule is missing.
    """
    return drive_with(mechanisms.rigid(name, parameters), name, parameters, faces, closing)


def drive_with(
    mechanism: Mechanism,
    name: str,
    parameters: Record,
    faces: "RodlessFaces | None" = None,
    closing: ClosingRule | None = None,
) -> CrankDrive:
    """The same of a mechanism that is reduced to one coordinate already."""
    roles = plan_of(name).parts(parameters)
    for role in roles.closings:
        if closing is None:
            raise BadInput(f"{mechanism.name} is overconstrained: give the closing rule")
        mechanism = closed(mechanism, role, closing)
    return CrankDrive(name=name, parameters=parameters, mechanism=mechanism, roles=roles, faces=faces, closing=closing)


def gas_faces(
    roles: PartRoles, letters: Mapping[str, float], faces: "RodlessFaces | None" = None
) -> tuple[GasFace, ...]:
    """Where gas acts on a mechanism: on its pistons with their dead centres at 0, or on faces, as the case chooses.

    letters: its parameters [SI]; faces: record, optional, section `[faces]`. Raises BadInput: the case has to choose,
    and does not.
    """
    if not roles.faces:
        return tuple(
            GasFace(input=role.force, travel=role.travel, fires=role.fires, mass=mass_with(role, letters))
            for role in roles.pistons
        )
    by_name = {face.name: face for face in roles.faces}
    rows: list[tuple[FaceRole, float | None, float]]
    if not roles.chosen:
        rows = [(face, None, float(face.fires or 0.0)) for face in roles.faces]
    elif faces is None:
        raise BadInput("gas acts on the faces of a rodless engine; give them")
    else:
        chosen = zip(faces.sides, faces.areas, faces.firing, strict=True)
        rows = [(by_name[side], area, fires) for side, area, fires in chosen]
    return tuple(
        GasFace(
            input=face.force, travel=face.travel, fires=fires, area=area, sense=face.sense,
            mass=mass_with(face, letters), throw=face.throw, top=face.top,
        )
        for face, area, fires in rows
    )  # fmt: skip


def main_roles(turn: Turn, sense: Pure | None = None) -> list[BearingRole]:
    """The throws of a shaft by their main bearings."""
    mains = [role for role in turn.drive.roles.bearings if role.at == "main_bearings"]
    return [role for role in mains if sense is None or role.sense == sense]


def faces_of(drive: CrankDrive) -> tuple[GasFace, ...]:
    """Where gas acts on a drive; pistons of a declaration fire at their own top dead centres."""
    faces = gas_faces(drive.roles, drive.mechanism.parameters, drive.faces)
    if drive.roles.faces:
        return faces
    tops = (top_of(slopes(drive.mechanism, one.travel, {})) for one in faces)
    return tuple(dataclasses.replace(one, fires=top + one.fires) for one, top in zip(faces, tops, strict=True))


def mass_with(part: PistonRole | FaceRole, letters: Mapping[str, float]) -> Kilogram:
    """Mass that moves with a piston or a face."""
    return sum(float(amount(mass, letters)) for mass in part.masses)


def acting(drive: CrankDrive, gas: Gases) -> tuple[Acting, ...]:
    """The cylinders of a drive with their gas."""
    if gas is None:
        return ()
    if isinstance(gas, Sequence):
        return tuple(gas)
    if gas.pistons:  # one gas pushes all of them, by the angle of the shaft
        shared = zip(gas_faces(drive.roles, drive.mechanism.parameters, drive.faces), gas.pistons, strict=True)
        return tuple(Acting(gas=gas, face=dataclasses.replace(one, fires=0.0, area=area)) for one, area in shared)
    plan_of(drive.name).require_firing(drive.parameters, gas.pressure.period)
    return tuple(Acting(face=one, gas=_own(drive, one, gas)) for one in faces_of(drive))


def _own(drive: CrankDrive, face: GasFace, gas: "Gas") -> "Gas":
    """The gas of a face: that of all, but over its own travel where it moves otherwise."""
    if face.top is None:
        return gas
    from mechsym.cycle.gas import over_travel  # friction in a case needs no gas

    first = next(one.travel for one in drive.roles.faces if one.top is None)
    own, other = (from_top(slopes(drive.mechanism, travel, {})) for travel in (first, face.travel))
    return over_travel(gas, own, other, math.remainder(face.top - face.fires, 2 * math.pi))


def period_of(acts: Sequence[Acting]) -> float:
    """Period of the gas of all cylinders [rad]."""
    return max((one.gas.pressure.period for one in acts), default=2 * math.pi)


def at(
    drive: CrankDrive,
    gas: Gases,
    omega: RadPerSecond,
    phi: Radian[Array],
    held: Mapping[str, np.ndarray] | None = None,
    period: Radian | None = None,
) -> Turn:
    """Forces of a mechanism at given angles.

    phi: crank angles, evenly spaced over a period. held: what acts besides the gas, by input, shape (n,) [unit].
    period: of all that acts; that of the gas without it.
    """
    acts, mechanism = acting(drive, gas), drive.mechanism
    pushed = pushes(acts, phi)
    inputs = pushed if not held else _sums(pushed, held)
    idle = _letters(mechanism, omega, phi)
    letters = idle | inputs
    kinematics, reactions, momentum = (
        _along(mechanism.functions[name], letters) if name in mechanism.functions else {}
        for name in ("kinematics", "reactions", "momentum")
    )
    reactions.pop(f"driving_{mechanism.coordinates[0]}", None)  # the same torque
    dynamics = _along(mechanism.functions["dynamics"], letters)
    powers = _along(_powers(mechanism), letters)
    gained = powers["work"] if not held else _along(_powers(mechanism), idle | pushed)["work"]
    return Turn(
        drive=drive,
        acting=acts,
        omega=omega,
        period=period_of(acts) if period is None else period,
        phi=phi,
        inputs=inputs,
        kinematics=kinematics,
        reactions=reactions,
        momentum=momentum,
        torque=powers["work"] + powers["damping"] - powers["slope"],
        driving=dynamics["bias"] - dynamics["generalized_force"],
        gas_power=gained * omega,
    )


def shaft_torque(
    drive: CrankDrive, acts: Sequence[Acting], omega: RadPerSecond, phi: Radian[Array], held: Mapping[str, np.ndarray]
) -> NewtonMetre[Array]:
    """Torque for the load over a cycle, without the reactions.

    held: what acts besides the gas, by input, shape (n,) [unit]. Returns torque: as `Turn.torque`.
    """
    inputs = _sums(pushes(acts, phi), held)
    powers = _along(_powers(drive.mechanism), _letters(drive.mechanism, omega, phi) | inputs)
    return powers["work"] + powers["damping"] - powers["slope"]


def angles(period: float) -> np.ndarray:
    """Evenly spaced angles of a period [rad] without the last [rad]."""
    steps = round(_STEPS_PER_TURN * period / (2 * math.pi))
    return np.arange(steps) * period / steps


def pushes(acts: Sequence[Acting], phi: np.ndarray) -> dict[str, np.ndarray]:
    """Gas forces by the input of the mechanism that takes them, over crank angles [rad]: shape (n,) [N]."""
    forces: dict[str, np.ndarray] = {}
    for one in acts:
        name, force = one.face.input, one.force(phi)
        forces[name] = forces[name] + force if name in forces else force
    return forces


def _sums(one: Mapping[str, np.ndarray], other: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    return {**one, **{name: one[name] + values if name in one else values for name, values in other.items()}}


def _letters(mechanism: Mechanism, omega: float, phi: np.ndarray) -> dict[str, np.ndarray]:
    q = mechanism.coordinates[0]
    none = np.zeros_like(phi)
    return {q: phi, f"{q}d": none + omega, f"{q}dd": none} | dict.fromkeys(mechanism.inputs, none)


def _along(function: ca.Function, letters: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    return along(function, {name: letters[name] for name in function.name_in()})


def _powers(mechanism: Mechanism) -> ca.Function:
    """At constant speed, by the angle: work of the inputs and of the dampers, and the slope of the energies [N*m]."""
    dynamics, energy = mechanism.functions["dynamics"], mechanism.functions["energy"]
    letters = {n: ca.SX.sym(n) for n in dynamics.name_in()}
    named = [letters[n] for n in mechanism.inputs if n in letters]
    force = dynamics(**letters)["generalized_force"]
    inputs = ca.vertcat(*named) if named else ca.SX(0, 1)
    idle = ca.substitute(force, inputs, ca.DM.zeros(len(named))) if named else force
    stored = energy(**{n: letters[n] for n in energy.name_in()})
    q, u = (letters[f"{mechanism.coordinates[0]}{dot}"] for dot in ("", "d"))
    damping = idle + ca.gradient(stored["potential_energy"], q)
    if not ca.jacobian(idle, u).nnz():  # what is left of weight and springs is rounding, but a constant force is not
        both = ca.Function("both", list(letters.values()), [damping, idle])
        left, whole = (np.abs(np.asarray(v)) for v in both.map(3).call([np.array([[0.3, 1.7, 4.1]])] * both.n_in()))
        damping = damping if np.max(left) > _ROUNDING * np.max(whole) else ca.SX(0)
    slope = ca.gradient(stored["kinetic_energy"] + stored["potential_energy"], q)
    return ca.Function(
        "powers", list(letters.values()), [force - idle, damping, slope], list(letters), ["work", "damping", "slope"]
    )

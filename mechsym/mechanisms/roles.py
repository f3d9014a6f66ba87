"""What the parts of a mechanism are for, as its declaration says, by names of its letters, outputs and reactions.

Sizes are expressions of its parameters as text (see `amounts`), or numbers where a mechanism is put together of lists.
"""

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import field
from typing import TYPE_CHECKING, Any

from mechsym.quantities import record

if TYPE_CHECKING:
    from mechsym.derive.listing import Listing

Size = str | float


@record
class PistonRole:
    """A piston on which gas acts."""

    name: str
    travel: str  #: Output: its travel, positive away from the head
    force: str  #: Input: the net gas force on it, positive likewise
    fires: float = 0.0  #: How long after its own first top dead centre it fires [rad]
    masses: tuple[str, ...] = ()  #: Parameters: what moves with it
    loads: tuple[str, ...] = ()  #: Reactions that limit a design
    stroke: Size | None = None  #: [m]


@record
class FaceRole:
    """A working face of a mechanism whose cases choose where gas acts; so is every piston that shares one gas."""

    name: str
    travel: str  #: Output by which its slider moves
    force: str  #: Input that takes its force, positive along that travel
    sense: float = 1.0  #: 1 where the gas pushes along the travel, -1 where against it [-]
    closes: Size = 0.0  #: Angle at which its chamber is least [rad]
    masses: tuple[Size, ...] = ()  #: What moves with it
    stroke: Size | None = None  #: [m]
    throw: int = 0  #: Which coordinate turns it
    fires: float | None = None  #: Shaft angle at which it fires; None where the case says it [rad]
    #: Shaft angle at its own top dead centre, where it moves otherwise than the first; None where alike [rad]
    top: float | None = None


@record
class RotorRole:
    """A shaft."""

    name: str
    angle: str  #: Its coordinate
    load: str | None = None  #: Input that takes a load, positive against the motion
    drive: str | None = None  #: Input that drives it
    inertia: str | None = None  #: Parameter that a flywheel adds to
    hinge: str | None = None  #: Input that a hinge acts on
    weight: Size = 0.0  #: Torque of its own weight, also by its angle [N*m]
    unbalance: Size = 0.0  #: On the side of the crank pin [kg*m]


@record
class BearingRole:
    """A pin or a journal."""

    name: str
    reactions: tuple[str, ...]  #: Two, or the only one
    turns: str | tuple[str, ...]  #: Output: the turn of one part in the other; several add up
    radius: str | None = None  #: Parameter; None where the case says it in [friction]
    at: str = ""  #: Place in [friction]: `main_bearings`, `crank_pins`, `piston_pins`; empty: it is its own
    throw: Size | None = None  #: Of a crank pin: its distance from the shaft [m]
    phase: float = 0.0  #: Angle of its crank from the first one [rad]
    sense: float = 1.0  #: In which its shaft turns, 1 or -1 [-]
    z: Size = 0.0  #: Place along the shaft [m]
    ways: tuple[float, ...] = (0.0, math.pi / 2)  #: Directions of its reactions in the frame [rad]
    main: str = ""  #: Of a crank pin: the main bearing that carries its throw


@record
class GuideRole:
    """A guide or a slot."""

    name: str
    reaction: str | None  #: None where it carries nothing
    travel: str  #: Output: travel along it
    at: str = ""  #: Place in [friction]: `guides`; empty: it is its own
    way: float = math.pi / 2  #: Direction of its reaction in the frame [rad]


@record
class TeethRole:
    """Teeth in mesh."""

    name: str
    force: str  #: Reaction along the pitch circle
    radius: str  #: Parameter: pitch radius of the driven wheel
    turns: str | tuple[str, ...] = ()  #: Output: the turn of one wheel in the other
    planet: str | None = None  #: Parameter: mass at the centre of a planet that drives the piston
    flank: str | None = None  #: Parameter: its pressure angle


@record
class RodRole:
    """The rod of a slider crank."""

    name: str
    swing: str | None  #: Output: its angle, by which the chains that sources print go on
    throw: Size  #: Of the crank [m]
    length: Size  #: [m]
    centre: Size  #: Its centre of mass, from the crank pin [m]
    mass: Size  #: [kg]
    inertia: Size  #: About its centre of mass [kg*m^2]
    moving: Size  #: Mass that moves with the piston [kg]
    beyond: Size | None = None  #: Of that, what a crosshead moves by the piston rod [kg]
    unbalance: Size = 0.0  #: Of the crank on the pin's side [kg*m]
    gravity: str | None = None  #: Parameter: acceleration of free fall


@record
class MemberRole:
    """A part that turns about its own centre."""

    name: str
    inertia: str  #: Parameter: there
    mass: Size  #: [kg]
    length: Size  #: [m]


@record
class ClosedGuide:
    """A guide that takes part of the force that is left open."""

    name: str  #: Its reaction
    free: str  #: The reaction where the open force is 0 [N]
    share: str  #: How much of the open force it takes [-]


@record
class ClosingRole:
    """The force along the crank that a mechanism overconstrained by one leaves open."""

    name: str  #: The open force, a reaction
    guides: tuple[ClosedGuide, ...]
    gives: Mapping[str, str]  #: Further reactions that follow [N]


@record
class ShaftRole:
    """A shaft that twists, from its free end to the flywheel."""

    name: str
    discs: tuple[Size, ...]  #: Inertia of each alone [kg*m^2]
    stiffness: tuple[Size, ...]  #: Of each section [N*m/rad]
    damping: tuple[Size, ...]  #: Of each section [N*m*s/rad]
    masses: tuple[str, ...] = ()  #: Parameters: what goes to and fro with it


@record
class AlikeRole:
    """A mechanism whose piston moves as every piston of this one."""

    name: str
    parameters: Mapping[str, str]  #: Its letters by those of this one


@record
class StopRole:
    """What a motion meets: it gives way to none, or presses as a spring with damping."""

    name: str
    gap: str  #: Output: what is free, not below 0
    force: str  #: Input: its force, 0 or above
    restitution: Size | None = None  #: Share of the speed that comes back [-]
    stiffness: Size | None = None  #: By how much it gives way [N/m] or [N*m/rad]
    damping: Size | None = None  #: Of its force by the speed [s/m] or [s/rad]


@record
class FrictionRole:
    """Dry friction, in the motion."""

    name: str
    force: str  #: Input: its force or torque
    mu_s: Size  #: Of sticking [-]
    mu_k: Size  #: Of sliding [-]
    reactions: tuple[str, ...] = ()  #: That press the faces together
    normal: Size | None = None  #: Or the force that does [N]
    contact: str = ""  #: Or the contact whose force does
    radius: Size | None = None  #: At which it acts where it is a torque [m]
    stribeck: Size | None = None  #: Speed by which it falls from sticking to sliding [m/s] or [rad/s]
    viscous: Size | None = None  #: [N*s/m] or [N*m*s/rad]
    speed: Size | None = None  #: Of the other face [m/s] or [rad/s]
    law: str = "set-valued"  #: Or `smooth`, which never sticks
    smoothing: Size | None = None  #: Speed over which a smooth law turns about [m/s] or [rad/s]


@record
class CamRole:
    """A cam with its follower."""

    name: str
    lift: str  #: Output
    angle: str  #: Name of its angle within a turn
    force: str = ""  #: Output: contact force of a follower that is held; empty where it may fly
    flat: bool = False  #: Whether the follower has a face
    roller: Size | None = None  #: Radius [m]


@record
class PartRoles:
    """All parts with a role, in the order of the declaration."""

    pistons: tuple[PistonRole, ...] = ()
    faces: tuple[FaceRole, ...] = ()
    rotors: tuple[RotorRole, ...] = ()
    bearings: tuple[BearingRole, ...] = ()
    guides: tuple[GuideRole, ...] = ()
    teeth: tuple[TeethRole, ...] = ()
    rods: tuple[RodRole, ...] = ()
    members: tuple[MemberRole, ...] = ()
    closings: tuple[ClosingRole, ...] = ()
    shafts: tuple[ShaftRole, ...] = ()
    alike: tuple[AlikeRole, ...] = ()
    stops: tuple[StopRole, ...] = ()
    frictions: tuple[FrictionRole, ...] = ()
    cams: tuple[CamRole, ...] = ()
    opposed: bool = False  #: Whether the pistons stand in pairs on one axis, each towards the other's crank
    joints: Mapping[str, str] = field(default_factory=dict)  #: What bears each reaction

    @property
    def own_inputs(self) -> frozenset[str]:
        """Inputs by which stops and friction act, and no drive."""
        return frozenset([*(s.force for s in self.stops), *(f.force for f in self.frictions)])

    @property
    def load(self) -> str:
        """The input that takes a load; empty where none does."""
        return next((rotor.load for rotor in self.rotors if rotor.load), "")

    @property
    def chosen(self) -> bool:
        """Whether a case chooses the faces on which gas acts."""
        return any(face.fires is None for face in self.faces)

    @property
    def heads(self) -> tuple[PistonRole | FaceRole, ...]:
        """Pistons, and faces of which a case has no choice."""
        return self.pistons + (() if self.chosen else self.faces)

    @property
    def rules(self) -> str:
        """The rules by which its parts are sized: `slider crank`, `planet`; empty where there are none."""
        if any(teeth.planet and teeth.flank for teeth in self.teeth):
            return "planet"
        return "slider crank" if len(self.rods) == 1 and self.rods[0].swing else ""


_KINDS = {
    "piston": ("pistons", PistonRole), "face": ("faces", FaceRole), "rotor": ("rotors", RotorRole),
    "bearing": ("bearings", BearingRole), "guide": ("guides", GuideRole), "teeth": ("teeth", TeethRole),
    "rod": ("rods", RodRole), "part": ("members", MemberRole),
    "stop": ("stops", StopRole), "friction": ("frictions", FrictionRole), "cam": ("cams", CamRole),
    "shaft": ("shafts", ShaftRole), "closing": ("closings", ClosingRole), "alike": ("alike", AlikeRole),
}  # fmt: skip


_COMPONENT = re.compile(r"([RM]|\w+_force)_[xyz](|_\w+)")


def resultants(reactions: Iterable[str]) -> dict[str, list[str]]:
    """Reactions that a joint has along several axes, by the name of their resultant, which has no axis."""
    by_joint: dict[str, list[str]] = {}
    for name in reactions:
        if component := _COMPONENT.fullmatch(name):
            by_joint.setdefault(component[1] + component[2], []).append(name)
    return {name: components for name, components in by_joint.items() if len(components) > 1}


def roles_in(listing: "Listing") -> PartRoles:
    """Roles of a mechanism by what is stored of its declaration."""
    joints = dict(listing.get("reactions") or {})
    joints |= {name: joints[components[0]] for name, components in resultants(joints).items() if name not in joints}
    parts: dict[str, Any] = {"joints": joints}
    for kind, rows in (listing.get("roles") or {}).items():
        name, part = _KINDS[kind]
        parts[name] = tuple(part(**{k: tuple(v) if isinstance(v, list) else v for k, v in row.items()}) for row in rows)
    closings = (
        ClosingRole(name=c.name, gives=c.gives, guides=tuple(ClosedGuide(**g) for g in c.guides))
        for c in parts.get("closings", ())
    )
    return PartRoles(**parts | {"closings": tuple(closings)})

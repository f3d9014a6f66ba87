"""The sizes of a mechanism by which it is judged whether its values can be those of a machine."""

from collections.abc import Mapping
from dataclasses import field
from typing import TYPE_CHECKING

from mechsym.mechanisms.amounts import amount
from mechsym.quantities import quantity, record

if TYPE_CHECKING:
    from mechsym.mechanisms.roles import FaceRole, PartRoles, PistonRole


@record
class Reciprocating:
    """What moves to and fro with a piston."""

    letters: str  #: Of its mass, as a reader finds them in the case
    mass: float = quantity("kg", low=0, about="all of it")
    axis: str = ""  #: Of the pistons that drive it, where there are several axes


@record
class Proportions:
    """Travel, rod and reciprocating masses."""

    stroke: float = quantity("m", above=0, about="travel of the piston, the longest of several")
    #: Rod length over crank radius, None without a rod [-]
    rod_ratio: float | None = None
    moving: tuple[Reciprocating, ...] = ()
    mass: float = quantity("kg", default=0.0, low=0, about="all that moves with crank and piston")
    #: Inertia about a shaft's axis by its letter [kg*m^2]
    shafts: Mapping[str, float] = field(default_factory=dict)
    flywheel: str = ""  #: Letter of the shaft's inertia that is one
    #: Inertia about a part's own centre by its letter, and the part's mass by its length squared [kg*m^2]
    parts: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    #: Inertia of a rod by that of its mass at both joints, m l_1 l_2, by its letter [-]
    ends: Mapping[str, float] = field(default_factory=dict)
    unbalances: Mapping[str, float] = field(default_factory=dict)  #: By their letter [kg*m]
    pistons: int = 1  #: How many drive its shaft
    unequal: Mapping[str, float] = field(default_factory=dict)  #: Largest over least of a list, by its letter [-]
    #: Least and largest distance of a cylinder of a shaft from its next, None where their places are not given [m]
    pitch: tuple[float, float] | None = None
    #: Distance of the shafts of opposed pistons over the length of both rods and throws, None without such [-]
    span: float | None = None


def declared(roles: "PartRoles", units: Mapping[str, str], letters: Mapping[str, float]) -> Proportions | None:
    """Those that a declaration says: by its strokes, rods and inertias; None where it names no stroke.

    units, letters: of its parameters, by letter.
    """

    def size(text: str | float) -> float:
        return float(amount(text, letters))

    heads: tuple[PistonRole | FaceRole, ...] = (*roles.pistons, *roles.faces)
    strokes = [size(head.stroke) for head in heads if head.stroke is not None] or [
        2 * size(rod.throw) for rod in roles.rods
    ]
    if not strokes:
        return None
    ratios = [size(rod.length) / size(rod.throw) for rod in roles.rods if size(rod.throw)]
    moving = {
        " + ".join(map(str, head.masses)): head.name.rstrip("+-") if roles.chosen else ""
        for head in heads
        if head.masses
    }
    moving = moving or {str(rod.moving): "" for rod in roles.rods}
    shafts = [r.inertia for r in roles.rotors if r.inertia] + [d for shaft in roles.shafts for d in shaft.discs]
    members = [(rod.inertia, rod.mass, rod.length) for rod in roles.rods if rod.inertia in letters]
    members += [(member.inertia, member.mass, member.length) for member in roles.members]
    return Proportions(
        stroke=max(strokes),
        rod_ratio=ratios[0] if ratios else None,
        pistons=max(len(roles.pistons), 1),
        moving=tuple(Reciprocating(letters=text, mass=size(text), axis=axis) for text, axis in moving.items()),
        mass=sum(letters[letter] for letter, unit in units.items() if unit == "kg"),
        shafts={str(text): size(text) for text in shafts},
        parts={str(text): (size(text), size(mass) * size(length) ** 2) for text, mass, length in members},
        unbalances={letter: letters[letter] for letter, unit in units.items() if unit == "kg*m"},
    )

"""The sizes of a mechanism by which it is judged whether its values can be those of a machine."""

from collections.abc import Mapping
from dataclasses import field
from typing import Any

from mechsym.quantities import quantity, record


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
    #: Inertia about a part's own centre by its letter, and the part's mass by its length squared [kg*m^2]
    parts: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    unbalances: Mapping[str, float] = field(default_factory=dict)  #: By their letter [kg*m]
    pistons: int = 1  #: How many drive its shaft
    unequal: Mapping[str, float] = field(default_factory=dict)  #: Largest over least of a list, by its letter [-]
    #: Least distance of two cylinders of a shaft, None where their places are not given [m]
    pitch: float | None = None
    #: Distance of the shafts of opposed pistons over the length of both rods and throws, None without such [-]
    span: float | None = None


def slider_crank(r: float, l: float, moving: tuple[Reciprocating, ...] = (), **more: Any) -> Proportions:  # noqa: E741
    """Those of a crank and a rod, by their lengths [m]; more are other fields."""
    return Proportions(stroke=2 * r, rod_ratio=l / r if r else None, moving=moving, **more)

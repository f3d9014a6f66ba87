"""The sizes of a mechanism by which it is judged whether its values can be those of a machine."""

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


def slider_crank(r: float, l: float, moving: tuple[Reciprocating, ...] = ()) -> Proportions:  # noqa: E741
    """Those of a crank and a rod, by their lengths [m]."""
    return Proportions(stroke=2 * r, rod_ratio=l / r if r else None, moving=moving)

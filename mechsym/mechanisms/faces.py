"""Which working faces drive a rodless engine: any number, single or double acting, two-stroke or four-stroke.

Each face of a piston that closes a chamber counts. Side "a+" is the face whose chamber the outward travel of slider a
compresses (dead centre at alpha = 0); "b+" has its dead centre at pi/2, "a-" at pi, "b-" at 3 pi/2. An opposite piston
on the same rod and the inner face of a double-acting piston both have a "-" side.
"""

import math

from mechsym.errors import BadInput
from mechsym.quantities import check, quantity, record

DEAD_CENTRES = {"a+": 0.0, "b+": math.pi / 2, "a-": math.pi, "b-": 3 * math.pi / 2}


@record
class RodlessFaces:
    """Section `[faces]`: the working faces of one link."""

    sides: tuple[str, ...]  #: Side of each face, of a+, a-, b+, b-
    #: Area of each working face; less by the rod's where a rod passes through [m^2]
    areas: tuple[float, ...] = quantity("m^2", above=0, about="area of each working face")
    #: Crank angle at which the chamber of each face fires, a dead centre of its side, within one cycle [rad]
    firing: tuple[float, ...] = quantity("rad", about="crank angle at which each face's chamber fires")

    def __post_init__(self) -> None:
        lengths = {name: len(getattr(self, name)) for name in ("sides", "areas", "firing")}
        if len(set(lengths.values())) != 1 or not self.sides:
            raise BadInput(f"sides, areas and firing need one value a face; found {lengths}")
        check(self)
        for side, fires in zip(self.sides, self.firing, strict=True):
            if side not in DEAD_CENTRES:
                raise BadInput(f"side {side!r} is not an option; options are {', '.join(DEAD_CENTRES)}")
            late = math.remainder(fires - DEAD_CENTRES[side], 2 * math.pi)
            if abs(late) > 1e-9:
                centre = math.degrees(DEAD_CENTRES[side])
                raise BadInput(
                    f"firing = {math.degrees(fires):g} deg is no dead centre of side {side}; "
                    f"give {centre:g} deg or {centre + 360:g} deg"
                )


def four_faces(area: float, period: float) -> RodlessFaces:
    """Two faces on each axis that fire as evenly as they can; area [m^2], period of the cycle [rad]."""
    # a four-stroke star of four dead centres a quarter turn apart: gaps 270, 180, 90, 180
    late = {"a+": 0, "b-": 270, "b+": 450, "a-": 540} if period > 7 else {"a+": 0, "b+": 90, "a-": 180, "b-": 270}
    firing = tuple(math.radians(d) for d in late.values())
    return RodlessFaces(sides=tuple(late), areas=(area,) * 4, firing=firing)

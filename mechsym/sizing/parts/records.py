"""The parts of an engine as records: what a drawing needs and every check reads. Sections `[part_*]` of a case."""

from mechsym.errors import BadInput
from mechsym.quantities import quantity, record


@record
class PistonPart:
    """Piston and rod in one piece."""

    head: float = quantity("m", above=0, about="thickness of the head")
    barrel: float = quantity("m", above=0, about="thickness of the barrel")
    ring_radial: float = quantity("m", above=0, about="ring, radial")
    ring_axial: float = quantity("m", above=0, about="ring, axial")
    land_top: float = quantity("m", above=0, about="top land")
    land: float = quantity("m", above=0, about="other lands")
    height: float = quantity("m", above=0, about="height of the head")
    rod: float = quantity("m", above=0, about="diameter of the rod")
    #: Length of the rod from the head to the bearing's outside [m]
    rod_length: float = quantity("m", above=0, about="length of the rod")


@record
class CylinderPart:
    """Cylinder and its bolts."""

    wall: float = quantity("m", above=0, about="thickness of the wall")
    flange: float = quantity("m", above=0, about="thickness of the flange")
    length: float = quantity("m", above=0, about="length")
    bolts: float = quantity("-", low=2, about="number of bolts")
    thread_mm: float = quantity("-", above=0, about="metric thread M, by its nominal diameter in mm")


@record
class GearPart:
    """One of the two gear pairs of a crank."""

    module: float = quantity("m", above=0, about="module")
    teeth_pinion: float = quantity("-", low=6, about="teeth of the pinion")
    teeth_ring: float = quantity("-", low=6, about="teeth of the ring")
    pressure_angle: float = quantity("rad", above=0, below=0.6, about="pressure angle")
    shift: float = quantity("-", default=0.0, about="addendum modification of the pinion")
    face: float = quantity("m", above=0, about="face width")
    ring_outside: float = quantity("m", above=0, about="outside diameter of the ring")
    pinion_bore: float = quantity("m", low=0, about="bore of the pinion")

    def __post_init__(self) -> None:
        if self.teeth_ring != 2 * self.teeth_pinion:
            told = f"teeth_ring = {self.teeth_ring:g} is not twice teeth_pinion = {self.teeth_pinion:g}"
            raise BadInput(f"{told}: the planet of a hypocycloid rolls in a ring of twice its size")


@record
class CrankPart:
    """Crankshaft: the hypocycloid's planet, or a slider crank's shaft, and the output shaft."""

    pin: float = quantity("m", above=0, about="diameter of the crankpin")
    pin_length: float = quantity("m", above=0, about="length of the crankpin")
    web: float = quantity("m", above=0, about="thickness of a web")
    web_width: float = quantity("m", above=0, about="smallest width of a web")
    #: Diameter of the shaft at the inner journal [m]
    shaft: float = quantity("m", above=0, about="shaft at the inner journal")
    #: Length of the shaft from the web [m]
    shaft_length: float = quantity("m", above=0, about="length of the shaft")
    #: Diameter of the output shaft [m]
    output: float = quantity("m", above=0, about="output shaft")
    pin_bore: float = quantity("m", default=0.0, low=0, about="bore of the crankpin")

    def __post_init__(self) -> None:
        if self.pin_bore >= self.pin:
            raise BadInput(f"pin_bore = {self.pin_bore:g} m is not below pin = {self.pin:g} m")


@record
class BearingPart:
    """Bearings of one crank, by designation; counts are for one place."""

    #: On the crankpin, at the inner and outer journal of each side, around the carrier, at the shaft's end
    rod: str
    inner: str
    outer: str
    main: str
    outboard: str
    rod_count: float = quantity("-", default=2.0, low=1, high=4, about="bearings on the crankpin")
    inner_count: float = quantity("-", default=1.0, low=1, high=4, about="bearings at an inner journal")
    outer_count: float = quantity("-", default=1.0, low=1, high=4, about="bearings at an outer journal")
    ring_off: str = "no"  #: `yes` when the inner journal's bearing runs on the shaft without its inner ring


@record
class MassPart:
    """Masses of the printed parts, from which those of other sizes are reckoned."""

    piston: float = quantity("kg", above=0, about="piston with rod")
    cylinder: float = quantity("kg", above=0, about="cylinder with fins")
    pinion: float = quantity("kg", above=0, about="pinion")
    ring: float = quantity("kg", above=0, about="ring")
    crankshaft: float = quantity("kg", above=0, about="crankshaft")
    output_set: float = quantity("kg", above=0, about="output shaft set")
    support_set: float = quantity("kg", above=0, about="support shaft set")
    #: The three crankcases of one crank together [kg]
    crankcases: float = quantity("kg", above=0, about="crankcases of one crank")

"""The parts of an engine as records: what a drawing needs and every check reads. Sections `[part_*]` of a case."""

from dataclasses import dataclass

from mechsym.quantities import check, quantity


@dataclass(frozen=True, kw_only=True)
class PistonPart:
    """Piston and rod in one piece.

    Parameters
    ----------
    head, barrel : float
        Thickness of head and barrel [m]
    ring_radial, ring_axial, land_top, land : float
        Rings and lands [m]
    height : float
        Height of the piston head [m]
    rod : float
        Diameter of the rod [m]
    rod_length : float
        Length of the rod from the head to the bearing's outside [m]
    """

    head: float = quantity("m", above=0, about="thickness of the head")
    barrel: float = quantity("m", above=0, about="thickness of the barrel")
    ring_radial: float = quantity("m", above=0, about="ring, radial")
    ring_axial: float = quantity("m", above=0, about="ring, axial")
    land_top: float = quantity("m", above=0, about="top land")
    land: float = quantity("m", above=0, about="other lands")
    height: float = quantity("m", above=0, about="height of the head")
    rod: float = quantity("m", above=0, about="diameter of the rod")
    rod_length: float = quantity("m", above=0, about="length of the rod")

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, kw_only=True)
class CylinderPart:
    """Cylinder and its bolts.

    Parameters
    ----------
    wall, flange, length : float
        Thickness of wall and flange, length [m]
    bolts : float
        Number of bolts [-]
    thread_mm : float
        Nominal diameter of the thread [mm]
    """

    wall: float = quantity("m", above=0, about="thickness of the wall")
    flange: float = quantity("m", above=0, about="thickness of the flange")
    length: float = quantity("m", above=0, about="length")
    bolts: float = quantity("-", low=2, about="number of bolts")
    thread_mm: float = quantity("-", above=0, about="nominal diameter of the thread in mm")

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, kw_only=True)
class GearPart:
    """One of the two gear pairs of a crank.

    Parameters
    ----------
    module, teeth_pinion, teeth_ring, pressure_angle, shift : float
        Tooth system: module [m], teeth [-], pressure angle [rad], addendum modification of the pinion [-]
    face : float
        Face width [m]
    ring_outside, pinion_bore : float
        Outside diameter of the ring, bore of the pinion [m]
    """

    module: float = quantity("m", above=0, about="module")
    teeth_pinion: float = quantity("-", low=6, about="teeth of the pinion")
    teeth_ring: float = quantity("-", low=6, about="teeth of the ring")
    pressure_angle: float = quantity("rad", above=0, below=0.6, about="pressure angle")
    shift: float = quantity("-", default=0.0, about="addendum modification of the pinion")
    face: float = quantity("m", above=0, about="face width")
    ring_outside: float = quantity("m", above=0, about="outside diameter of the ring")
    pinion_bore: float = quantity("m", low=0, about="bore of the pinion")

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, kw_only=True)
class CrankPart:
    """Crankshaft: the hypocycloid's planet, or a slider crank's shaft, and the output shaft.

    Parameters
    ----------
    pin, pin_length, pin_bore : float
        Diameter, length and bore of the crankpin [m]
    web, web_width : float
        Thickness of a web and its smallest width [m]
    shaft : float
        Diameter of the shaft at the inner journal [m]
    shaft_length : float
        Length of the shaft from the web [m]
    output : float
        Diameter of the output shaft [m]
    """

    pin: float = quantity("m", above=0, about="diameter of the crankpin")
    pin_length: float = quantity("m", above=0, about="length of the crankpin")
    web: float = quantity("m", above=0, about="thickness of a web")
    web_width: float = quantity("m", above=0, about="smallest width of a web")
    shaft: float = quantity("m", above=0, about="shaft at the inner journal")
    shaft_length: float = quantity("m", above=0, about="length of the shaft")
    output: float = quantity("m", above=0, about="output shaft")
    pin_bore: float = quantity("m", default=0.0, low=0, about="bore of the crankpin")

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, kw_only=True)
class BearingPart:
    """Bearings of one crank, by designation; counts are for one place.

    Parameters
    ----------
    rod, inner, outer, main, outboard : str
        On the crankpin, at the inner and outer journal of each side, around the carrier, at the shaft's end
    rod_count, inner_count, outer_count : float
        Bearings side by side [-]
    ring_off : str
        `yes` when the inner journal's bearing runs on the shaft without its inner ring
    """

    rod: str
    inner: str
    outer: str
    main: str
    outboard: str
    rod_count: float = quantity("-", default=2.0, low=1, high=4, about="bearings on the crankpin")
    inner_count: float = quantity("-", default=1.0, low=1, high=4, about="bearings at an inner journal")
    outer_count: float = quantity("-", default=1.0, low=1, high=4, about="bearings at an outer journal")
    ring_off: str = "no"

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, kw_only=True)
class MassPart:
    """Masses of the printed parts, from which those of other sizes are reckoned.

    Parameters
    ----------
    piston, cylinder, pinion, ring, crankshaft, output_set, support_set : float
        Mass of one part; the cylinder with its fins [kg]
    crankcases : float
        The three crankcases of one crank together [kg]
    """

    piston: float = quantity("kg", above=0, about="piston with rod")
    cylinder: float = quantity("kg", above=0, about="cylinder with fins")
    pinion: float = quantity("kg", above=0, about="pinion")
    ring: float = quantity("kg", above=0, about="ring")
    crankshaft: float = quantity("kg", above=0, about="crankshaft")
    output_set: float = quantity("kg", above=0, about="output shaft set")
    support_set: float = quantity("kg", above=0, about="support shaft set")
    crankcases: float = quantity("kg", above=0, about="crankcases of one crank")

    def __post_init__(self) -> None:
        check(self)

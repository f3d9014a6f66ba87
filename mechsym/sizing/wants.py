"""Sections `[sizing]` and `[part_*]` of a case: what a design must reach and assumes, and the parts as they are."""

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import choice, quantity, record, reference
from mechsym.quantities.units import Pure, RadPerSecond, Scalar, Second

_HOUR = 3600.0


@record
class Wants:
    """What a design must reach. The defaults are the source's where it states one, else usual values (marked)."""

    settings: tuple[str, ...] = ()  #: Cycle settings for the loads, KEY=VALUE as for `--set`
    #: Step of the speeds at which parts are sized and checked [rad/s]
    speed_step: float = quantity("rad/s", default=50 * np.pi / 30, above=0, about="step of the speeds")
    rival: str = reference("case", "")  #: Case of the engine to compare with
    #: Safety factors: piston head against the hot strength, rod against fatigue, cylinder wall against fatigue, shafts
    #: against static strength, shafts against fatigue (usual) [-]
    head: float = quantity("-", default=1.5, low=1, about="safety factor of the piston head")
    rod: float = quantity("-", default=1.5, low=1, about="safety factor of the rod, fatigue")
    wall: float = quantity("-", default=2.0, low=1, about="safety factor of the cylinder wall, fatigue")
    #: Allowable stress in the core of the bolts [Pa]
    bolt_stress: float = quantity("Pa", default=70e6, above=0, about="allowable stress of the bolts")
    gear_bending: float = quantity("-", default=1.0, low=0.5, about="safety factor of the teeth, bending (S_F of AGMA)")
    gear_contact: float = quantity("-", default=1.0, low=0.5, about="safety factor of the teeth, contact (S_H of AGMA)")
    #: Reliabilities of the rating (bearing: usual) [-]
    gear_reliability: float = quantity("-", default=0.99, low=0.5, high=0.9999, about="reliability of the gears")
    shaft_static: float = quantity("-", default=1.5, low=1, about="safety factor of shafts, static")
    fatigue: float = quantity("-", default=1.5, low=1, about="safety factor of shafts, fatigue")
    bearing_reliability: float = quantity("-", default=0.90, low=0.9, high=0.99, about="reliability of the bearings")
    static_ball: float = quantity("-", default=1.0, low=0.5, about="safety factor of ball bearings, static")
    static_roller: float = quantity("-", default=1.5, low=0.5, about="safety factor of roller bearings, static")
    #: Wanted life of gears and bearings; the source states none: 200 h between overhauls of a small aircraft [s]
    life: float = quantity("s", default=200 * _HOUR, above=0, about="life of gears and bearings")
    piston: str = "al-242-t571"  #: Material of the piston
    cylinder: str = "al-a390-t6"  #: Material of the cylinder
    gears: str = "nitralloy-n"  #: Material of the gears
    crankshaft: str = "nitralloy-n"  #: Material of the crankshaft
    shaft: str = "ferrium-s53"  #: Material of the output shaft
    #: Files with more materials and bearings
    materials_file: str = reference("file", "")
    bearings_file: str = reference("file", "")
    accuracy: float = quantity("-", default=6.0, low=6, high=12, about="accuracy grade of the gears")
    #: Enclosure of the gears, for the mesh alignment
    enclosure: str = choice("open", "commercial", "precision", "extra-precision", default="extra-precision")
    C_pm: float = quantity("-", default=1.1, low=1, high=1.1, about="pinion proportion modifier")
    C_e: float = quantity("-", default=0.8, low=0.8, high=1, about="mesh alignment correction")
    rings: float = quantity("-", default=3.0, low=1, high=8, about="number of piston rings")
    ring_thickness: float = quantity("m", default=0.002, above=0, about="radial thickness of a ring")
    heat_share: float = quantity("-", default=0.05, low=0, high=1, about="share of the heat through a piston head")
    head_dT: float = quantity("K", default=75.0, above=0, about="piston head, middle hotter than the edge by")
    reboring: float = quantity("m", default=0.002, low=0, about="allowance in the cylinder wall")
    bolts: float = quantity("-", default=5.0, low=2, high=24, about="number of bolts of the cylinder")
    reach: float = quantity("m", default=0.145, above=0, about="crank axis to the middle of the engine")
    pin_bore: float = quantity("-", default=0.5, low=0, high=0.8, about="bore of the crankpin over its diameter")
    #: Radius of the fillets on the crankshaft (usual) [m]
    fillet: float = quantity("m", default=0.0025, above=0, about="radius of the fillets of the crankshaft")
    surface: str = choice("ground", "machined", "as-forged", default="ground", about="surface of the shafts")
    #: Thinnest wall of the carrier between journal and main bearing (usual) [m]
    carrier_wall: float = quantity("m", default=0.002, low=0, about="thinnest wall between journal and main bearing")
    #: `both_ends`: half of a crank's torque leaves at each end; `one_end`: all of it at the output shaft
    take_off: str = choice("both_ends", "one_end", default="both_ends", about="where the torque leaves")
    #: Stiffness of a journal over that of a gear mesh, for `one_end` (usual) [-]
    stiffness_ratio: float = quantity("-", default=1.0, low=0, about="stiffness of a journal over that of the mesh")

    def __post_init__(self) -> None:
        if self.rings % 1 or self.bolts % 1:
            raise BadInput(f"rings = {self.rings:g} and bolts = {self.bolts:g} must be whole numbers")


def cycles(life: Second, omega: RadPerSecond[Scalar], events_per_turn: Pure) -> Pure[Scalar]:
    r"""Number of events in a life.

    .. math:: N = t\,\frac{\omega}{2\pi}\,n

    events_per_turn: of the crank; a tooth of the hypocycloid meets the peak load once in two turns.

    >>> f"{cycles(3600.0, 8000 * 2 * np.pi / 60, 0.5):.3g}"
    '2.4e+05'
    """
    return life * np.abs(omega) / (2 * np.pi) * events_per_turn


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
            problem = f"teeth_ring = {self.teeth_ring:g} is not twice teeth_pinion = {self.teeth_pinion:g}"
            raise BadInput(f"{problem}: the planet of a hypocycloid rolls in a ring of twice its size")


@record
class CrankPart:
    """Crankshaft: the hypocycloid's planet, or a slider crank's shaft, and the output shaft."""

    pin: float = quantity("m", above=0, about="diameter of the crankpin")
    pin_length: float = quantity("m", above=0, about="length of the crankpin")
    web: float = quantity("m", above=0, about="thickness of a web")
    web_width: float = quantity("m", above=0, about="smallest width of a web")
    #: Diameter of the shaft at the inner journal [m]
    shaft: float = quantity("m", above=0, about="shaft at the inner journal")
    shaft_length: float = quantity("m", above=0, about="length of the shaft")  #: Length of the shaft from the web [m]
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

"""Section `[sizing]` of a case: wanted safety factors and life, materials, and what the designer assumes."""

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import choice, quantity, record

_HOUR = 3600.0


@record
class Wants:
    """What a design must reach. The defaults are the source's where it states one, else usual values (marked)."""

    settings: tuple[str, ...] = ()  #: Cycle settings for the loads, KEY=VALUE as for `--set`
    #: Step of the speeds at which parts are sized and checked [rad/s]
    speed_step: float = quantity("rad/s", default=50 * np.pi / 30, above=0, about="step of the speeds")
    rival: str = ""  #: Case of the engine to compare with
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
    materials_file: str = ""
    bearings_file: str = ""
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


def cycles(life, omega, events_per_turn):
    r"""Number of events in a life.

    .. math:: N = t\,\frac{\omega}{2\pi}\,n

    Parameters
    ----------
    life : float
        Time [s]
    omega : float or ndarray
        Crank speed [rad/s]
    events_per_turn : float
        Events in a turn of the crank; a tooth of the hypocycloid meets the peak load once in two turns [-]

    Returns
    -------
    N : float or ndarray
        Number of events [-]

    Examples
    --------
    >>> f"{cycles(3600.0, 8000 * 2 * np.pi / 60, 0.5):.3g}"
    '2.4e+05'
    """
    return life * np.abs(omega) / (2 * np.pi) * events_per_turn

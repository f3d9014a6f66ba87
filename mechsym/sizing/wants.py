"""Section `[sizing]` of a case: wanted safety factors and life, materials, and what the designer assumes."""

from dataclasses import dataclass

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import check, choice, quantity

_HOUR = 3600.0


@dataclass(frozen=True, kw_only=True)
class Wants:
    """What a design must reach. The defaults are the source's where it states one, else usual values (marked).

    Parameters
    ----------
    settings : tuple of str
        Cycle settings for the loads, KEY=VALUE as for `--set`
    speed_step : float
        Step of the speeds at which parts are sized and checked [rad/s]
    rival : str
        Case of the engine to compare with
    head, rod, wall, shaft_static, fatigue : float
        Safety factors: piston head against the hot strength, rod against fatigue, cylinder wall against fatigue,
        shafts against static strength, shafts against fatigue (usual) [-]
    bolt_stress : float
        Allowable stress in the core of the bolts [Pa]
    gear_bending, gear_contact : float
        Safety factors S_F and S_H of AGMA [-]
    gear_reliability, bearing_reliability : float
        Reliabilities of the rating (bearing: usual) [-]
    static_ball, static_roller : float
        Static safety factors of bearings (ISO 76) [-]
    life : float
        Wanted life of gears and bearings; the source states none: 200 h between overhauls of a small aircraft [s]
    piston, cylinder, gears, crankshaft, shaft : str
        Keys of the materials
    materials_file, bearings_file : str
        Files with more materials and bearings
    accuracy : float
        Accuracy grade A_v of the gears [-]
    enclosure : str
        Enclosure of the gears, for the mesh alignment
    C_pm, C_e : float
        Pinion proportion modifier, alignment correction [-]
    rings : float
        Number of piston rings [-]
    ring_thickness : float
        Radial thickness of a ring [m]
    heat_share, head_dT : float
        Share of the heat through a piston head [-], its temperature difference [K]
    reboring : float
        Allowance in the cylinder wall [m]
    bolts : float
        Number of bolts [-]
    reach : float
        Crank axis to the middle of the engine [m]
    pin_bore : float
        Bore of the crankpin over its diameter (usual) [-]
    fillet : float
        Radius of the fillets on the crankshaft (usual) [m]
    surface : str
        Surface of the shafts (usual)
    carrier_wall : float
        Thinnest wall of the carrier between journal and main bearing (usual) [m]
    take_off : str
        `both_ends`: half of a crank's torque leaves at each end; `one_end`: all of it at the output shaft
    stiffness_ratio : float
        Stiffness of a journal over that of a gear mesh, for `one_end` (usual) [-]
    """

    settings: tuple[str, ...] = ()
    speed_step: float = quantity("rad/s", default=50 * np.pi / 30, above=0, about="step of the speeds")
    rival: str = ""
    head: float = quantity("-", default=1.5, low=1, about="piston head")
    rod: float = quantity("-", default=1.5, low=1, about="piston rod")
    wall: float = quantity("-", default=2.0, low=1, about="cylinder wall")
    bolt_stress: float = quantity("Pa", default=70e6, above=0, about="allowable stress of the bolts")
    gear_bending: float = quantity("-", default=1.0, low=0.5, about="S_F of AGMA")
    gear_contact: float = quantity("-", default=1.0, low=0.5, about="S_H of AGMA")
    gear_reliability: float = quantity("-", default=0.99, low=0.5, high=0.9999, about="gears")
    shaft_static: float = quantity("-", default=1.5, low=1, about="shafts, static")
    fatigue: float = quantity("-", default=1.5, low=1, about="shafts, fatigue")
    bearing_reliability: float = quantity("-", default=0.90, low=0.9, high=0.99, about="bearings")
    static_ball: float = quantity("-", default=1.0, low=0.5, about="ball bearings, static")
    static_roller: float = quantity("-", default=1.5, low=0.5, about="roller bearings, static")
    life: float = quantity("s", default=200 * _HOUR, above=0, about="gears and bearings")
    piston: str = "al-242-t571"
    cylinder: str = "al-a390-t6"
    gears: str = "nitralloy-n"
    crankshaft: str = "nitralloy-n"
    shaft: str = "ferrium-s53"
    materials_file: str = ""
    bearings_file: str = ""
    accuracy: float = quantity("-", default=6.0, low=6, high=12, about="accuracy grade of the gears")
    enclosure: str = choice("open", "commercial", "precision", "extra-precision", default="extra-precision")
    C_pm: float = quantity("-", default=1.1, low=1, high=1.1, about="pinion proportion modifier")
    C_e: float = quantity("-", default=0.8, low=0.8, high=1, about="mesh alignment correction")
    rings: float = quantity("-", default=3.0, low=1, high=8, about="piston rings")
    ring_thickness: float = quantity("m", default=0.002, above=0, about="radial thickness of a ring")
    heat_share: float = quantity("-", default=0.05, low=0, high=1, about="heat through a piston head")
    head_dT: float = quantity("K", default=75.0, above=0, about="piston head, middle over edge")
    reboring: float = quantity("m", default=0.002, low=0, about="allowance in the cylinder wall")
    bolts: float = quantity("-", default=5.0, low=2, high=24, about="bolts of the cylinder")
    reach: float = quantity("m", default=0.145, above=0, about="crank axis to the middle of the engine")
    pin_bore: float = quantity("-", default=0.5, low=0, high=0.8, about="bore of the crankpin over its diameter")
    fillet: float = quantity("m", default=0.0025, above=0, about="fillets of the crankshaft")
    surface: str = choice("ground", "machined", "as-forged", default="ground", about="shafts")
    carrier_wall: float = quantity("m", default=0.002, low=0, about="wall between journal and main bearing")
    take_off: str = choice("both_ends", "one_end", default="both_ends", about="where the torque leaves")
    stiffness_ratio: float = quantity("-", default=1.0, low=0, about="journal over mesh stiffness")

    def __post_init__(self) -> None:
        check(self)
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

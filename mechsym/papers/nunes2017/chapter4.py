"""What chapter 4 of the thesis computes with, and its gear calculation: as it was made, and with its slips removed.

The shipped case, its materials, the peaks of the thesis's march; tables 4.8 to 4.12.
As made: each member has its own K_v (pitch speed from its own diameter, half the true mesh speed for the pinion) and
its own K_m, the ring's diameter stands in its contact stress, I and J are those of an external pair as printed in table
4.8, 200 stands for 196.85.
Corrected: one mesh, I of the internal pair and J by the formulas of AGMA 908, load and factors of safety as printed.
"""

from collections.abc import Mapping
from functools import cache

import numpy as np

from mechsym.cases import load
from mechsym.cycle.chamber import chamber
from mechsym.cycle.closed.model import closed_period
from mechsym.cycle.engine import columns, over_speeds
from mechsym.jobs.cycle import engine, speed_range
from mechsym.jobs.size import printed_parts
from mechsym.quantities import RPM, record
from mechsym.sizing.hypocycloid.engine import PrintedMasses
from mechsym.sizing.rules import bearings, gears, materials
from mechsym.sizing.rules.bearings import Bearing
from mechsym.sizing.rules.gear_bending import bending_geometry_factor
from mechsym.sizing.rules.gear_geometry import Pair, pitting_geometry_factor
from mechsym.sizing.rules.materials import Material, need
from mechsym.sizing.wants import Wants

# table 4.8: (shift, teeth of the pinion): I, J pinion, J gear
GEOMETRY = {
    (0.0, 26): ("0.1168", "0.4385", "0.4855"), (0.0, 52): ("0.1190", "0.5153", "0.5382"),
    (0.25, 26): ("0.1233", "0.4900", "0.4440"), (0.25, 52): ("0.1222", "0.5516", "0.5043"),
    (0.5, 26): ("0.1278", "0.5385", "0.4010"), (0.5, 52): ("0.1246", "0.5770", "0.4704"),
}  # fmt: skip
# tables 4.11 and 4.12 [mm]: bending pinion, bending gear, contact pinion, contact gear
SINGLE = {
    (0.0, 26): "62.68 52.45 85.18 39.46", (0.0, 52): "106.68 94.62 83.61 38.73",
    (0.25, 26): "56.09 57.35 80.69 37.38", (0.25, 52): "99.66 100.98 81.42 37.71",
    (0.5, 26): "51.04 63.50 77.85 36.06", (0.5, 52): "95.27 108.26 79.85 36.99",
}  # fmt: skip
TWIN = {
    (0.0, 26): "31.34 26.22 42.59 19.50", (0.0, 52): "53.34 47.31 41.80 19.14",
    (0.25, 26): "28.05 28.67 40.34 18.47", (0.25, 52): "49.83 50.49 40.71 18.64",
    (0.5, 26): "25.52 31.75 38.92 17.82", (0.5, 52): "47.64 54.13 39.92 18.28",
}  # fmt: skip
COLUMNS = ("bending, pinion", "bending, gear", "contact, pinion", "contact, gear")


CASE = "nunes-hypocycloid"


@record
class Peaks:
    """Peaks of the thesis's march."""

    p: float  #: [Pa]
    F: float  #: On a piston [N]
    T: float  #: [N*m]
    rpm: np.ndarray  #: Speeds [rpm]
    tooth: np.ndarray  #: Of the teeth at each speed [N]


@record
class Chapter4:
    """Data of the thesis's hypocycloid engine as the shipped case has them."""

    wants: Wants
    printed: PrintedMasses
    bore: float  #: Bore [m]
    e: float  #: Throw of the planet's centre; the stroke of a piston is 4 e [m]
    area: float  #: Of a piston [m^2]
    clearance: float  #: Volume at top dead centre [m^3]
    fuel: float  #: In a cycle [kg]
    heating_value: float  #: Of the fuel [J/kg]
    top_rpm: float  #: Maximum rated speed [rpm]
    peaks: Peaks
    materials: Mapping[str, Material]
    bearings: Mapping[str, Bearing]

    def material(self, part: str) -> Material:
        """The material that the case chooses for a part: piston, cylinder, gears, crankshaft, shaft."""
        return self.materials[getattr(self.wants, part)]


@cache
def chapter4() -> Chapter4:
    """Everything from the case `nunes-hypocycloid`, the peaks by the thesis's own march."""
    case = load(CASE, {"cycle.method": "nunes2017_printed"})
    machine, omega = engine(case), case.need("operation").speed
    room = chamber(machine.chamber, machine.motion)
    table = columns(over_speeds(machine, speed_range(case.need("speeds"))))
    pressure, force, torque = (float(table[name].max()) for name in ("p_max_mpa", "force_max", "torque_max"))
    peaks = Peaks(p=pressure * 1e6, F=force, T=torque, rpm=table["speed_rpm"], tooth=table["loads"]["tooth_force"])
    return Chapter4(
        wants=case.need("sizing"), printed=printed_parts(case), bore=case.need("chamber").bore,
        e=case.need("parameters").e, area=float(room.area), clearance=float(room.clearance),
        fuel=float(closed_period(machine, {"omega": omega}).fuel), heating_value=machine.cycle.heating_value,
        top_rpm=omega / RPM, peaks=peaks, materials=materials.load(), bearings=bearings.catalogue(),
    )  # fmt: skip


def area_printed(chapter: Chapter4) -> float:
    """Area of a piston as table 3.2 prints it, ten times too large. Returns area: 0.02827 for 0.002827 [m^2]."""
    return float(np.round(10 * chapter.area, 5))


D_PINION, D_RING, WIDEST = 0.026, 0.052, 0.052
_Z_E = 187030.0  # table 4.10
_ANGLE = np.radians(25)


def _allowed(field: str) -> float:
    return need(chapter4().material("gears"), field)


def load_distribution_printed(member: int) -> float:
    """K_m of table 4.10. Returns K_m: 1.2537 and 1.1349 [-]."""
    d, C_pm = (D_PINION, 1.1) if member == 1 else (D_RING, 1.0)
    return gears.load_distribution_factor(WIDEST, d, C_pm, "extra-precision", 0.8)


def load_distribution_twin_contact() -> float:
    """K_m = 1.12185 [-] of table 4.12 for the ring in contact: eq. 4.22, meant for 25 mm and less, at 52 mm."""
    align = gears.mesh_alignment_factor(WIDEST, "extra-precision")
    return 1 + (WIDEST / (10 * D_RING) - 0.025) + 0.8 * align


def dynamic_printed(member: int, rpm: float | np.ndarray, feet: float) -> np.ndarray:
    """K_v as the thesis made it [-].

    member: 1 pinion, 2 ring: the pitch speed of a wheel of its diameter at the crank's speed; rpm: crank speed [rpm];
    feet: 196.85 in table 4.10, 200 in tables 4.11 and 4.12 [ft*s/(min*m)].
    """
    d = D_PINION if member == 1 else D_RING
    return gears.dynamic_factor(np.pi * d * np.asarray(rpm) / 60, 6.0, feet)


def widths_printed(shift: float, teeth: int, rpm: np.ndarray, tooth: np.ndarray, twin: bool) -> tuple[float, ...]:
    """A line of table 4.11, or of table 4.12 for the twin set [m].

    shift: addendum modification [-]; rpm, tooth: speeds [rpm] and largest tooth load at each [N]; twin: half the load
    on each of two sets.
    """
    module = D_PINION / teeth
    I, *J = (float(text) for text in GEOMETRY[shift, teeth])
    share, widths = 0.5 if twin else 1.0, []
    for member in (1, 2):
        load = share * np.max(tooth * dynamic_printed(member, rpm, 200.0))
        factors = gears.LoadFactors(K_m=load_distribution_printed(member))
        widths.append(gears.face_width_bending(load, module, J[member - 1], _allowed("gear_bending"), factors))
    for member, d in ((1, D_PINION), (2, D_RING)):
        load = share * np.max(tooth * dynamic_printed(member, rpm, 200.0))
        ring = twin and member == 2
        factors = gears.LoadFactors(K_m=load_distribution_twin_contact() if ring else load_distribution_printed(member))
        widths.append(gears.face_width_contact(load, d, I, _Z_E, _allowed("gear_contact"), factors))
    return tuple(float(b) for b in widths)


def widths_corrected(
    shift: float, teeth: int, rpm: np.ndarray, tooth: np.ndarray, limits: Mapping[str, float] | None = None
) -> tuple[float, float, float]:
    """The twin set with the slips removed, at the face width of 52 mm that K_m was taken for.

    shift: addendum modification [-]; rpm, tooth: speeds [rpm] and largest tooth load at each [N]; limits: `bending` and
    `contact` limit of another material [Pa]. Returns pinion, ring, contact: face widths for bending of either and for
    the contact that they share [m].
    """
    bounds = {"bending": _allowed("gear_bending"), "contact": _allowed("gear_contact")} | dict(limits or {})
    module = D_PINION / teeth
    pair = Pair(kind="internal", module=module, teeth_1=teeth, teeth_2=2 * teeth, pressure_angle=_ANGLE, shift=shift)
    speed = gears.mesh_speed(D_PINION, np.asarray(rpm) * RPM)
    load = 0.5 * np.max(tooth * gears.dynamic_factor(speed, 6.0))
    factors = gears.LoadFactors(K_m=load_distribution_printed(1))
    bend = [
        gears.face_width_bending(load, module, bending_geometry_factor(pair, m), bounds["bending"], factors)
        for m in (1, 2)
    ]
    I = pitting_geometry_factor(pair)
    contact = gears.face_width_contact(load, D_PINION, I, _Z_E, bounds["contact"], factors)
    return float(bend[0]), float(bend[1]), float(contact)

"""What decides the claims of source 004: parameters, torque, remainder, crossover, parts, masses, bearings, gears."""

import math
from functools import cache

import numpy as np

from mechsym.audit.read.algebra import FLOATS
from mechsym.audit.theory.catalogue import theory
from mechsym.audit.theory.record import complete
from mechsym.audit.verdict import Decision
from mechsym.cases import load
from mechsym.cycle.chamber import chamber, piston_force
from mechsym.cycle.kinds.printed import marched
from mechsym.jobs.cycle import engine, speed_range
from mechsym.jobs.size import check_printed
from mechsym.papers.nunes2017 import chapter4 as printed
from mechsym.papers.nunes2017 import errata, sizing
from mechsym.papers.nunes2017.chapter4 import chapter4
from mechsym.papers.nunes2017.numbers import TIMINGS
from mechsym.papers.rows import Row
from mechsym.papers.sources import Weighed, against, weighed
from mechsym.quantities import RPM, dimension
from mechsym.sizing.loads import journal_load_massless, tooth_load_printed
from mechsym.sizing.rules import bearings, crankshaft, gears, piston

_B, _STROKES, _V_C, _AREA_PRINTED = 0.060, 104.0, 3.2673e-5, 0.02827
_ULTIMATE = 1250e6  # shear strength of Ferrium S53
_F_PRINTED = 27410.0
_PRESSURE_ANGLE = np.radians(25)
_TEETH = (26, 52)  # of the pinion, in tables 4.8 to 4.12
_CHOSEN, _SHIFT = 39.0, 0.5  # face width [mm], addendum modification
_FEET = 60 / 0.3048  # feet per minute of 1 m/s


@cache
def items() -> dict[str, Row]:
    """Rows of the reproduction of chapter 4, by item."""
    return {row.item: row for row in sizing.rows()}


def computed(item: str) -> float:
    """The value by the thesis's own rules, slips included [unit of the item]."""
    return float(items()[item].computed or 0)


def right(item: str) -> float:
    """The value without the source's slip, or as computed where it has none [unit of the item]."""
    corrected = items()[item].corrected
    return computed(item) if corrected is None else corrected


def displacement() -> Weighed:
    """Bore and stroke against the displacement of the text."""
    return against(2.9405e-5, math.pi * _B**2 / 4 * 0.104)


def combustion_columns() -> Weighed:
    """Lines through the columns of table 3.1: they are (3.2) and (3.1) the other way round."""
    speed, *columns = TIMINGS.T
    first, second = (np.polyfit(speed, column, 1) for column in columns)
    return weighed(False, first=first, second=second, shift=-(first[0] + 0.0004) * 8000)


def heat_capacity_ratio() -> Weighed:
    """The unit of a ratio of two heat capacities."""
    return weighed(dimension("-") == dimension("J/kg/K"))


def peak_torque() -> Weighed:
    """Both cranks' torque."""
    costs = errata.engine_torque()
    return against(276.255, costs["torque_max slider-crank"], **costs)


def unburnt() -> Weighed:
    """The remainder of the shares against the fuel that is not released."""
    costs = errata.unburnt_share()
    closes = "closes" if costs["first_law_residual"] < 1e-12 else "does not close"
    return against(costs["remainder_max"], costs["unburnt_max"], closes=closes, **costs)


def vapour_charge() -> Weighed:
    """The march with vapour that brings its internal energy."""
    costs = errata.vapour_energy()
    return against(9.604, costs["p_max_mpa hypocycloid"], more=100 * costs["torque_max_change hypocycloid"], **costs)


def best_speeds() -> Weighed:
    """Where the burn of the march ends at the published maxima."""
    return weighed(False, **errata.lost_burn())


def crossover() -> Weighed:
    """The crossover speed with the rod of table 3.2."""
    costs = errata.rod_length()
    return against(6436.0, costs["crossover_rpm 90 mm"], **costs)


def net_pressure() -> Weighed:
    """Absolute pressure as net pressure, against that with the atmosphere on the piston's back."""
    costs, force = errata.back_pressure(), chapter4().peaks.F
    return against(force, force - costs["surplus_force"], **costs)


def piston_area() -> Weighed:
    """The area of table 3.2 is ten times too large against the bore's; what chapter 4 made of it."""
    area = math.pi * _B**2 / 4
    gaps = [1e3 * piston.tdc_gap(_V_C, a) for a in (_AREA_PRINTED, area)]
    lengths = (f"length of the {name} [mm]" for name in ("cylinder", "rod"))
    cylinder, rod = ((computed(item), right(item)) for item in lengths)
    return against(_AREA_PRINTED, area, gaps=gaps, drawn=1 + _STROKES / gaps[0], cylinder=cylinder, rod=rod)


def disc_constant() -> Weighed:
    """The constant of (4.3) from the conduction in a disc."""
    parts = theory("engine_parts")
    names = {k: letter.value for k, letter in parts.letters.items()} | {"pi": math.pi}
    complete(parts, names, ["head_heat"], FLOATS)
    return against(12.56, names["H"] / (names["k"] * (names["T_C"] - names["T_E"]) * names["head_heat"]), within=1e-3)


def head_for_heat() -> Weighed:
    """The thickness by (4.3) and (4.4) with all the fuel."""
    half = computed("thickness of the head, heat [mm]")
    return weighed(False, -0.5, half=half, all=2 * half)


def rod_diameter() -> Weighed:
    """The diameter by (4.5) with the stress of the text."""
    text, used = (piston.rod_diameter(chapter4().peaks.F, stress) * 1e3 for stress in (60e6, 75e6 / 1.5))
    return against(26.29, text, used=used)


def rod_length() -> Weighed:
    """The length by (4.12) with the right gap."""
    length = right("length of the rod [mm]")
    return against(88.6, length, gap=right("distance of the heads at TDC [mm]"), more=88.6 - length)


def gap() -> Weighed:
    """The gap by (4.15) with the right area."""
    return against(1.2, right("distance of the heads at TDC [mm]"))


def cylinder_length() -> Weighed:
    """The length by (4.17) with the right gap."""
    correct, wanted = right("length of the cylinder [mm]"), 0.15 * 52
    chosen = correct - 170
    return against(169.4, correct, short=correct - 169.4, chosen=chosen, left=wanted - chosen / 2, wanted=wanted)


def bolts() -> Weighed:
    """The stress in the core of five M10 bolts, above the range of the rule."""
    pressure, root = chapter4().peaks.p, piston.root_diameter(10)
    stress = piston.bolt_stress(pressure, _B, 5, root) / 1e6
    cores = [piston.core_diameter(pressure, _B, 5, s) for s in (70e6, 35e6)]
    threads = [piston.thread_for(core) for core in cores]
    return weighed(stress <= 70, stress / 70 - 1, core=cores[0] * 1e3, root=root * 1e3, stress=stress, threads=threads)


def crankpin_force() -> Weighed:
    """The force of section 4.5 against the largest of chapter 3."""
    bearing, pin = right("load of a main bearing [N]"), right("diameter of the crankpin [mm]")
    return against(_F_PRINTED, chapter4().peaks.F, within=1e-3, bearing=bearing, pin=pin)


def web_stress() -> Weighed:
    """The stress by (4.34) with the right force and the width of (4.33): for a disc of 65 mm only."""
    force = chapter4().peaks.F
    disc, lean = (crankshaft.web_stress(force / 2, 0.043, 0.034, 0.015, w) / 1e6 for w in (0.065, 0.04082))
    return against(118.074, lean, lean=lean, disc=disc)


def output_shaft() -> Weighed:
    """The diameter by (4.35), and the stress of the shaft as chosen."""
    torque = chapter4().peaks.T
    one, both = (crankshaft.shaft_diameter(t, _ULTIMATE / 1.5) * 1e3 for t in (torque, 2 * torque))
    stress = crankshaft.torsion_stress(torque, 0.008) / 1e6
    would = math.pi * 0.00782**3 / 16 * _ULTIMATE / 1.5
    return against(7.82, one, torque=torque, would=would, stress=stress, both=both)


def moving_mass() -> Weighed:
    """The mass of the thesis's own parts on the cylinder axis, and what it changes at 8000 rpm."""
    figures = errata.reciprocating_mass()
    return against(0.250, figures["mass_kg"], **figures)


def unbalance_unit() -> Weighed:
    """The unit of mass times distance."""
    return weighed(dimension("g*mm") == dimension("g*mm/s^2"))


def balance() -> Weighed:
    """The moments of both shaft sets against those of the moving parts."""
    moving = right("unbalance of the moving parts [g.mm]")
    left = [right(f"balance of the {which} shaft set [g.mm]") for which in ("output", "support")]
    share = (moving + left[0]) / moving
    return weighed(abs(share) < 5e-3, share, moving=moving, left=left, rest=100 * share)


def rod_bearing_rating() -> Weighed:
    """Rating of a set of two after ISO 281."""
    rating = float(bearings.set_rating(15.1e3, 2, "drawn-cup"))
    return against(30.2e3, rating, kn=rating / 1e3)


def journal_load() -> Weighed:
    """Largest load of the planet's journals over all speeds and angles."""
    machine = engine(load("nunes-hypocycloid", {"cycle.method": "nunes2017_printed"}))
    result = marched(machine, speed_range(load("nunes-hypocycloid").need("speeds")))
    theta = np.radians(result.theta_deg - 360.0)
    room = chamber(machine.chamber, machine.motion)
    force = piston_force(room, theta[:, None], result.omega[None, :], result.p).T
    loads = (force, journal_load_massless(force, theta), _with_separation(force, theta))
    assumed, plain, full = (float(load.max()) / 1e3 for load in loads)
    return against(assumed, full, plain=plain, full=full, assumed=assumed, half=assumed / 2)


def _with_separation(force: np.ndarray, theta: np.ndarray) -> np.ndarray:
    """Journal load with the teeth pushed apart: rod force along the cylinder, teeth across and along the crank."""
    teeth = tooth_load_printed(force, theta)
    apart = np.abs(teeth) * np.tan(_PRESSURE_ANGLE)
    sine, cosine = np.sin(theta), np.cos(theta)
    along = -force - teeth * sine - apart * cosine
    return np.hypot(along, teeth * cosine - apart * sine)


def journal_speed() -> Weighed:
    """Speed of the planet against its carrier, with the limit of table 4.16."""
    speed, limit = 2 * 8000, bearings.catalogue()["HN 1516"].limiting / RPM
    return weighed(speed <= limit, 8000 / speed - 1, speed=speed, limit=limit, crank=limit / 2)


def engine_mass() -> Weighed:
    """Sum of the printed masses."""
    return against(13406.6, right("mass of the engine [g]"), within=1e-5)


def chosen_parts() -> Weighed:
    """The checks of the printed parts with consistent masses and loads."""
    checks = [row for row in check_printed(load("nunes-hypocycloid")).rows if row["limit"] is not None]
    below = [row for row in checks if not row["holds"]]
    listed = ", ".join(
        f"{row['component']} ({row['quantity']}, {row['safety_factor']:.3g} for {row['wanted']:g})" for row in below
    )
    return weighed(not below, below=len(below), checks=len(checks), listed=listed)


def modules() -> Weighed:
    """The modules of the tooth numbers of table 4.8."""
    sizes = [printed.D_PINION * 1e3 / z for z in _TEETH]
    return weighed(False, 2 / sizes[1] - 1, sizes=sizes)


def centre_distance() -> Weighed:
    """Half the difference of the pitch diameters of an internal pair."""
    return against(26.0, (printed.D_RING - printed.D_PINION) / 2 * 1e3)


def dedenda() -> Weighed:
    """Whole depth less addendum."""
    pinion, ring = (right(f"dedendum of the {name}, table 4.13 [mm]") for name in ("pinion", "gear"))
    return against(0.5, pinion, ring=ring)


def load_distribution() -> Weighed:
    """K_m of the mesh."""
    mesh = printed.load_distribution_printed(1)
    return against(1.1349, mesh, more=100 * (mesh / 1.1349 - 1))


def dynamic_constant() -> Weighed:
    """K_v with 200 and with 196.85."""
    exact, rounded = (float(printed.dynamic_printed(2, 8000, c)) for c in (_FEET, 200.0))
    error = rounded / exact - 1
    return weighed(False, error, feet=_FEET, exact=exact, rounded=rounded, more=100 * error)


def mesh_speed_effect(verdict: Decision) -> str:
    """What the pinion's half speed costs in K_v and in the width of the pinion."""
    half, true = (float(printed.dynamic_printed(member, 8000, _FEET)) for member in (1, 2))
    speed = float(gears.mesh_speed(printed.D_PINION, 8000 * RPM))
    return (
        f"at 8000 rpm the teeth meet with {speed:.2f} m/s and not with {speed / 2:.2f} m/s, K_v is {true:.4f} for "
        f"{half:.4f}; the pinion of table 4.12 needs {_pinion_contact():.2f} mm in contact for the 39 mm chosen"
    )


def dynamic_members() -> Weighed:
    """K_v of the mesh."""
    return against(1.1073, right("K_v, pinion, 8000 rpm"))


def elastic_coefficient() -> Weighed:
    """Z_E of steel on steel."""
    pascal = float(gears.elastic_coefficient(200e9, 0.3, 200e9, 0.3))
    return against(1.8703e5, pascal / 1e3, pascal=pascal)


def ring_contact() -> Weighed:
    """The ring's face width with the pinion's diameter in (2.78), all else as printed."""
    width = computed(f"table 4.11: face width, contact, gear, x = {_SHIFT:g}, 26/52 teeth [mm]")
    return against(width, width * printed.D_RING / printed.D_PINION, width=width)


def face_width() -> Weighed:
    """The widths of the chosen pair with one mesh, and with the geometry of the internal pair."""
    peaks, own = chapter4().peaks, _pinion_contact()
    pinion, ring, contact = (1e3 * b for b in printed.widths_corrected(_SHIFT, 26, peaks.rpm, peaks.tooth))
    fits = max(pinion, ring, contact, own) <= _CHOSEN
    return weighed(fits, _CHOSEN / own - 1, own=own, contact=contact, pinion=pinion, ring=ring)


def maraging() -> Weighed:
    """Face width of the maraging steel over that of Nitralloy N."""
    claim = "maraging 350: face width over Nitralloy's, 'reduced in at least half'"
    chosen, anew = (f"{claim}, {which}" for which in ("the chosen pair", "shift chosen anew"))
    return against(0.5, computed(chosen), anew=computed(anew), internal=right(chosen))


def _pinion_contact() -> float:
    """Face width of the chosen pinion in contact, as table 4.12 but with the speed of the mesh [mm]."""
    own = chapter4().peaks
    load = 0.5 * np.max(own.tooth * printed.dynamic_printed(2, own.rpm, _FEET))
    factors = gears.LoadFactors(K_m=printed.load_distribution_printed(1))
    I = float(printed.GEOMETRY[_SHIFT, 26][0])
    return 1e3 * float(gears.face_width_contact(load, printed.D_PINION, I, 187030.0, 1300e6, factors))

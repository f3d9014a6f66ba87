"""What decides the claims of source 004 on parameters, torque, remainder, crossover, and on the engine's parts."""

import math
from functools import cache

import numpy as np

from mechsym.audit.hosts.sources import Decided
from mechsym.audit.read.algebra import FLOATS
from mechsym.audit.theory.catalogue import theory
from mechsym.audit.theory.record import complete
from mechsym.papers.nunes2017 import errata, sizing
from mechsym.papers.nunes2017.chapter4 import chapter4
from mechsym.papers.nunes2017.numbers import TIMINGS
from mechsym.papers.rows import Row
from mechsym.quantities import dimension
from mechsym.sizing.rules import crankshaft, piston


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


def against(claimed: float, correct: float, note: str, within: float = 5e-3) -> Decided:
    """Decide a claim that is a number [its unit]: it stands within a relative difference."""
    error = claimed / correct - 1
    return Decided(supported=abs(error) <= within, note=note, rel_error=error)


def displacement() -> Decided:
    """Bore and stroke against the displacement of the text."""
    volume = math.pi * 0.060**2 / 4 * 0.104
    return against(
        2.9405e-5,
        volume,
        f"{volume:.4e} m^3, the 294.05 cc beside it; the 2.86e-5 m^3 (286 cc) of section 3.1 have the same slip",
    )


def combustion_columns() -> Decided:
    """Lines through the columns of table 3.1: they are (3.2) and (3.1) the other way round."""
    speed, *columns = TIMINGS.T
    lines = [np.polyfit(speed, column, 1) for column in columns]
    shift = (lines[0][0] + 0.0004) * 8000
    return Decided(
        supported=False,
        note="the columns are exchanged: the one headed duration gives "
        f"{lines[0][1]:.2f} {lines[0][0]:+.3e} N, which is the start (3.1), the other {lines[1][1]:.2f} "
        f"{lines[1][0]:+.3e} N, the duration (3.2); rounding the first slope moves the start by {-shift:.2f} degrees "
        "at 8000 rpm",
    )


def heat_capacity_ratio() -> Decided:
    """The unit of a ratio of two heat capacities."""
    return Decided(supported=dimension("-") == dimension("J/kg/K"), note="a ratio has no unit, by (2.2)")


def peak_torque() -> Decided:
    """Both cranks' torque."""
    costs = errata.engine_torque()
    crank, hypo = costs["torque_max slider-crank"], costs["torque_max hypocycloid"]
    note = (
        "the peaks are those of one piston, the averages those of both; the pistons run in phase, so the engine's "
        f"peaks are {crank:.1f} and {hypo:.1f} N m"
    )
    return against(276.255, crank, note)


def unburnt() -> Decided:
    """The remainder of the shares against the fuel that is not released."""
    costs = errata.unburnt_share()
    closes = "closes" if costs["first_law_residual"] < 1e-12 else "does not close"
    note = (
        f"0.141 to 0.144 is what the other shares leave; 1 - Q_R/E_f is {costs['unburnt_min']:.4f} to "
        f"{costs['unburnt_max']:.4f} (the first law of the march {closes}); the rest, {costs['excess_min']:.4f} to "
        f"{costs['excess_max']:.4f}, is the internal energy that fuel vapour takes from the gas, "
        f"{costs['vapour_energy']:.4f} at most"
    )
    return against(costs["remainder_max"], costs["unburnt_max"], note)


def vapour_charge() -> Decided:
    """The march with vapour that brings its internal energy."""
    costs = errata.vapour_energy()
    crank, hypo = costs["p_max_mpa slider-crank"], costs["p_max_mpa hypocycloid"]
    note = (
        "by (3.4) with (3.8) the gas pays the latent heat and the vapour's internal energy; with the vapour charged "
        f"with c_v T_0 the largest pressures are {crank:.3f} MPa for 9.188 and {hypo:.3f} MPa for 9.604, the largest "
        f"torques rise by {100 * costs['torque_max_change hypocycloid']:.1f} %, the averages by less than 0.1 %"
    )
    return against(9.604, hypo, note)


def best_speeds() -> Decided:
    """Where the burn of the march ends at the published maxima."""
    costs = errata.lost_burn()
    return Decided(
        supported=False,
        note="the march burns to the last whole degree only and loses up to "
        f"{costs['largest_loss']:.4f} of the fuel's energy, a saw-tooth of {costs['period_rpm']:.0f} rpm; at 5400 and "
        f"6700 rpm the burn ends at {costs['end_of_burn_5400']:.2f} and {costs['end_of_burn_6700']:.2f} degrees and "
        "loses nothing; the converged maxima lie elsewhere (see `mechsym reproduce nunes2017`)",
    )


def crossover() -> Decided:
    """The crossover speed with the rod of table 3.2."""
    costs = errata.rod_length()
    note = (
        f"{costs['crossover_rpm 90 mm']:.0f} rpm with the 90 mm of table 3.2; 6436 rpm, and all curves of section "
        f"5.1.1, follow from a rod of 74 mm ({costs['crossover_rpm 74 mm']:.0f} rpm)"
    )
    return against(6436.0, costs["crossover_rpm 90 mm"], note)


def net_pressure() -> Decided:
    """Absolute pressure as net pressure. Returns decided: with the atmosphere on the piston's back."""
    costs = errata.back_pressure()
    surplus, force = costs["surplus_force"], chapter4().peaks.F
    note = (
        f"the atmosphere behind the piston takes {surplus:.1f} N; the largest torques are "
        f"{costs['torque_max slider-crank']:.2f} and {costs['torque_max hypocycloid']:.2f} N m for 276.26 and 243.58; "
        "the averages stay"
    )
    return against(force, force - surplus, note)


_B, _STROKES, _V_C, _AREA_PRINTED = 0.060, 104.0, 3.2673e-5, 0.02827
_ULTIMATE = 1250e6  # shear strength of Ferrium S53
_F_PRINTED = 27410.0


def piston_area() -> Decided:
    """The area of table 3.2 is ten times too large against the bore's; what chapter 4 made of it."""
    area = math.pi * _B**2 / 4
    gaps = [1e3 * piston.tdc_gap(_V_C, a) for a in (_AREA_PRINTED, area)]
    drawn = 1 + _STROKES / gaps[0]
    cylinder, rod_as_made = "length of the cylinder [mm]", "length of the rod [mm]"
    note = (
        f"the bore gives {area:.7f} m^2, a tenth; chapter 3 was computed with the right area, chapter 4 with the "
        f"printed one: heads {gaps[0]:.1f} mm apart for {gaps[1]:.1f} mm, "
        f"compression ratio {drawn:.0f} as drawn for 10, cylinder {computed(cylinder):.1f} mm long for "
        f"{right(cylinder):.1f} mm, rod {computed(rod_as_made):.1f} mm for {right(rod_as_made):.1f} mm"
    )
    return against(_AREA_PRINTED, area, note)


def disc_constant() -> Decided:
    """The constant of (4.3) from the conduction in a disc."""
    parts = theory("engine_parts")
    names = {k: letter.value for k, letter in parts.letters.items()} | {"pi": math.pi}
    complete(parts, names, ["head_heat"], FLOATS)
    constant = names["H"] / (names["k"] * (names["T_C"] - names["T_E"]) * names["head_heat"])
    return against(12.56, constant, f"4 pi = {constant:.4f}, cut after two digits", within=1e-3)


def head_for_heat() -> Decided:
    """The thickness by (4.3) and (4.4) with all the fuel."""
    half = computed("thickness of the head, heat [mm]")
    return Decided(
        supported=False,
        note=f"(4.3) and (4.4) with the fuel of the cylinder at 8000 rpm give {2 * half:.2f} mm; 13.74 mm takes half "
        f"of it ({half:.2f} mm), a half for each piston, which (4.4) does not say",
        rel_error=-0.5,
    )


def rod_diameter() -> Decided:
    """The diameter by (4.5) with the stress of the text."""
    force = chapter4().peaks.F
    text, used = (piston.rod_diameter(force, stress) * 1e3 for stress in (60e6, 75e6 / 1.5))
    note = (
        f"60 MPa give {text:.2f} mm; {used:.2f} mm follow from 75/1.5 = 50 MPa, the fatigue strength over the factor "
        "of safety, which the text means; the slip is in the text, the rod is safe"
    )
    return against(26.29, text, note)


def rod_length() -> Decided:
    """The length by (4.12) with the right gap."""
    length = right("length of the rod [mm]")
    gap = right("distance of the heads at TDC [mm]")
    note = (
        f"{length:.1f} mm with the gap of {gap:.2f} mm that V_c and the right area leave; the rod as drawn is "
        f"{88.6 - length:.1f} mm too long and takes that from either side of the gap"
    )
    return against(88.6, length, note)


def gap() -> Decided:
    """The gap by (4.15) with the right area."""
    correct = right("distance of the heads at TDC [mm]")
    return against(1.2, correct, f"{correct:.2f} mm: the area of table 3.2 is ten times too large")


def cylinder_length() -> Decided:
    """The length by (4.17) with the right gap."""
    correct = right("length of the cylinder [mm]")
    note = (
        f"{correct:.1f} mm: 169.4 mm follow from the area of table 3.2; the cylinder is {correct - 169.4:.1f} mm too "
        f"short, the 170 mm chosen {correct - 170:.1f} mm: at the bottom dead centre the pistons have "
        f"{(0.15 * 52 - (correct - 170) / 2):.1f} mm to spare at each end for the wanted {0.15 * 52:.1f} mm"
    )
    return against(169.4, correct, note)


def bolts() -> Decided:
    """The stress in the core of five M10 bolts. Returns decided: above the range of the rule."""
    pressure, root = chapter4().peaks.p, piston.root_diameter(10)
    stress = piston.bolt_stress(pressure, _B, 5, root) / 1e6
    cores = [piston.core_diameter(pressure, _B, 5, s) for s in (70e6, 35e6)]
    threads = [piston.thread_for(core) for core in cores]
    return Decided(
        supported=stress <= 70,
        note=f"(4.18) gives the core, at least {cores[0] * 1e3:.2f} mm; M10 has "
        f"{root * 1e3:.2f} mm and {stress:.0f} MPa in it for the 35 to 70 MPa of the rule, M{threads[0]} to "
        f"M{threads[1]} keep it; the other rule needs 0.75 of the flange of 10 mm, 7.5 mm, not 9 mm",
        rel_error=stress / 70 - 1,
    )


def crankpin_force() -> Decided:
    """The force of section 4.5 against the largest of chapter 3."""
    force = chapter4().peaks.F
    bearing, pin = right("load of a main bearing [N]"), right("diameter of the crankpin [mm]")
    note = (
        f"two digits exchanged: chapter 3 and section 4.8 have {force:.0f} N; the main bearing gets {bearing:.0f} N "
        f"for 13705 N, the crankpin {pin:.2f} mm for 23.63 mm; the 25 mm chosen hold"
    )
    return against(_F_PRINTED, force, note, within=1e-3)


def web_stress() -> Decided:
    """The stress by (4.34) with the right force and the width of (4.33): for a disc of 65 mm only."""
    force = chapter4().peaks.F
    disc, lean = (crankshaft.web_stress(force / 2, 0.043, 0.034, 0.015, w) / 1e6 for w in (0.065, 0.04082))
    note = (
        f"118.074 MPa take F = 27410 N and the disc of 65 mm; {disc:.1f} MPa with 27140 N, {lean:.1f} MPa with the "
        "width of (4.33), 40.82 mm; the printed mass of the crankshaft leaves webs of that lean kind; both are far "
        "below the 454.7 MPa allowed"
    )
    return against(118.074, lean, note)


def output_shaft() -> Decided:
    """The diameter by (4.35), and the stress of the shaft as chosen."""
    torque = chapter4().peaks.T
    one, both = (crankshaft.shaft_diameter(t, _ULTIMATE / 1.5) * 1e3 for t in (torque, 2 * torque))
    stress = crankshaft.torsion_stress(torque, 0.008) / 1e6
    would = math.pi * 0.00782**3 / 16 * _ULTIMATE / 1.5
    note = (
        f"(4.35) with {torque:.1f} N m and 1250/1.5 MPa gives {one:.2f} mm; no reading gives 7.82 mm, which carry "
        f"{would:.1f} N m; unsafe: the 8 mm shaft has {stress:.0f} MPa at the peak of one crank's torque, more than "
        f"the ultimate shear strength of 1250 MPa; with both cranks' torque it needs {both:.2f} mm"
    )
    return against(7.82, one, note)

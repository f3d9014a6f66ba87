"""What decides the claims of source 004 on piston, rod, cylinder, crankshaft and output shaft."""

import math

from mechsym.audit.algebra import FLOATS
from mechsym.audit.entries import Decided
from mechsym.audit.theory.catalogue import theory
from mechsym.audit.theory.record import complete
from mechsym.papers.nunes2017.claims_record import against, items, peaks, right
from mechsym.sizing.rules import bolts as bolt
from mechsym.sizing.rules import crankshaft, rod
from mechsym.sizing.rules.cylinder import tdc_gap

_B, _STROKES, _V_C, _AREA_PRINTED = 0.060, 104.0, 3.2673e-5, 0.02827
_ULTIMATE = 1250e6  # shear strength of Ferrium S53
_F_PRINTED = 27410.0


def piston_area() -> Decided:
    """The area of table 3.2 against the bore's.

    Returns
    -------
    decided : Decided
        Ten times too large, with what chapter 4 made of it
    """
    area = math.pi * _B**2 / 4
    drawn = 1 + _STROKES * 1e-3 / tdc_gap(_V_C, _AREA_PRINTED)
    cylinder, length = items()["length of the cylinder [mm]"], items()["length of the rod [mm]"]
    return against(_AREA_PRINTED, area, (
        f"the bore gives {area:.7f} m^2, a tenth; chapter 3 was computed with the right area, chapter 4 with the "
        f"printed one: heads {tdc_gap(_V_C, _AREA_PRINTED) * 1e3:.1f} mm apart for {tdc_gap(_V_C, area) * 1e3:.1f} mm, "
        f"compression ratio {drawn:.0f} as drawn for 10, cylinder {cylinder['computed']:.1f} mm long for "
        f"{cylinder['corrected']:.1f} mm, rod {length['computed']:.1f} mm for {length['corrected']:.1f} mm"
    ))  # fmt: skip


def disc_constant() -> Decided:
    """The constant of (4.3) from the conduction in a disc."""
    found = theory("engine_parts")
    names = {k: letter.value for k, letter in found.letters.items()} | {"pi": math.pi}
    complete(found, names, ["head_heat"], FLOATS)
    constant = names["H"] / (names["k"] * (names["T_C"] - names["T_E"]) * names["head_heat"])
    return against(12.56, constant, f"4 pi = {constant:.4f}, cut after two digits", within=1e-3)


def head_for_heat() -> Decided:
    """The thickness by (4.3) and (4.4) with all the fuel."""
    half = items()["thickness of the head, heat [mm]"]["computed"]
    return Decided(
        supported=False,
        note=f"(4.3) and (4.4) with the fuel of the cylinder at 8000 rpm give {2 * half:.2f} mm; 13.74 mm takes half "
        f"of it ({half:.2f} mm), a half for each piston, which (4.4) does not say",
        rel_error=-0.5,
    )


def rod_diameter() -> Decided:
    """The diameter by (4.5) with the stress of the text."""
    force = float(peaks()["F"])
    text, used = (rod.rod_diameter(force, stress) * 1e3 for stress in (60e6, 75e6 / 1.5))
    return against(26.29, text, (
        f"60 MPa give {text:.2f} mm; {used:.2f} mm follow from 75/1.5 = 50 MPa, the fatigue strength over the factor "
        "of safety, which the text means; the slip is in the text, the rod is safe"
    ))  # fmt: skip


def rod_length() -> Decided:
    """The length by (4.12) with the right gap."""
    length = right("length of the rod [mm]")
    gap = right("distance of the heads at TDC [mm]")
    return against(88.6, length, (
        f"{length:.1f} mm with the gap of {gap:.2f} mm that V_c and the right area leave; the rod as drawn is "
        f"{88.6 - length:.1f} mm too long and takes that from either side of the gap"
    ))  # fmt: skip


def gap() -> Decided:
    """The gap by (4.15) with the right area."""
    correct = right("distance of the heads at TDC [mm]")
    return against(1.2, correct, f"{correct:.2f} mm: the area of table 3.2 is ten times too large")


def cylinder_length() -> Decided:
    """The length by (4.17) with the right gap."""
    correct = right("length of the cylinder [mm]")
    return against(169.4, correct, (
        f"{correct:.1f} mm: 169.4 mm follow from the area of table 3.2; the cylinder is {correct - 169.4:.1f} mm too "
        f"short, the 170 mm chosen {correct - 170:.1f} mm: at the bottom dead centre the pistons have "
        f"{(0.15 * 52 - (correct - 170) / 2):.1f} mm to spare at each end for the wanted {0.15 * 52:.1f} mm"
    ))  # fmt: skip


def bolts() -> Decided:
    """The stress in the core of five M10 bolts.

    Returns
    -------
    decided : Decided
        Above the range of the rule
    """
    pressure = float(peaks()["p"])
    root = bolt.root_diameter(10)
    stress = bolt.bolt_stress(pressure, _B, 5, root) / 1e6
    threads = [bolt.thread_for(bolt.core_diameter(pressure, _B, 5, s)) for s in (70e6, 35e6)]
    return Decided(
        supported=stress <= 70,
        note=f"(4.18) gives the core, at least {bolt.core_diameter(pressure, _B, 5, 70e6) * 1e3:.2f} mm; M10 has "
        f"{root * 1e3:.2f} mm and {stress:.0f} MPa in it for the 35 to 70 MPa of the rule, M{threads[0]} to "
        f"M{threads[1]} keep it; the other rule needs 0.75 of the flange of 10 mm, 7.5 mm, not 9 mm",
        rel_error=stress / 70 - 1,
    )


def crankpin_force() -> Decided:
    """The force of section 4.5 against the largest of chapter 3."""
    force = float(peaks()["F"])
    bearing, pin = right("load of a main bearing [N]"), right("diameter of the crankpin [mm]")
    return against(_F_PRINTED, force, (
        f"two digits exchanged: chapter 3 and section 4.8 have {force:.0f} N; the main bearing gets {bearing:.0f} N "
        f"for 13705 N, the crankpin {pin:.2f} mm for 23.63 mm; the 25 mm chosen hold"
    ), within=1e-3)  # fmt: skip


def web_stress() -> Decided:
    """The stress by (4.34) with the right force, and with the width of (4.33).

    Returns
    -------
    decided : Decided
        For a disc of 65 mm only
    """
    force = float(peaks()["F"])
    disc, lean = (crankshaft.web_stress(force / 2, 0.043, 0.034, 0.015, w) / 1e6 for w in (0.065, 0.04082))
    return against(118.074, lean, (
        f"118.074 MPa take F = 27410 N and the disc of 65 mm; {disc:.1f} MPa with 27140 N, {lean:.1f} MPa with the "
        "width of (4.33), 40.82 mm; the printed mass of the crankshaft leaves webs of that lean kind; both are far "
        "below the 454.7 MPa allowed"
    ))  # fmt: skip


def output_shaft() -> Decided:
    """The diameter by (4.35), and the stress of the shaft as chosen."""
    torque = float(peaks()["T"])
    one, both = (crankshaft.shaft_diameter(t, _ULTIMATE / 1.5) * 1e3 for t in (torque, 2 * torque))
    stress = crankshaft.torsion_stress(torque, 0.008) / 1e6
    would = math.pi * 0.00782**3 / 16 * _ULTIMATE / 1.5
    return against(7.82, one, (
        f"(4.35) with {torque:.1f} N m and 1250/1.5 MPa gives {one:.2f} mm; no reading gives 7.82 mm, which carry "
        f"{would:.1f} N m; unsafe: the 8 mm shaft has {stress:.0f} MPa at the peak of one crank's torque, more than "
        f"the ultimate shear strength of 1250 MPa; with both cranks' torque it needs {both:.2f} mm"
    ))  # fmt: skip

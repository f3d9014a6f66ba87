"""Piston, rod, cylinder and bolts: sizes for given loads, and the checks of given sizes."""

import numpy as np

from mechsym.quantities import record
from mechsym.quantities.units import Metre
from mechsym.sizing.checks import Check, at_least, at_most, at_speed, round_up
from mechsym.sizing.rules import cylinder, piston
from mechsym.sizing.rules.fatigue import goodman_factor, stress_cycle
from mechsym.sizing.rules.materials import Material, need
from mechsym.sizing.wants import CylinderPart, PistonPart, Wants


@record
class CylinderLoads:
    """What acts on piston and cylinder."""

    omega: np.ndarray  #: shape (k,): Crank speeds [rad/s]
    dp_max: np.ndarray  #: shape (k,): Largest pressure above the surroundings [Pa]
    rod: np.ndarray  #: shape (k, n): Force in the rod, compression positive [N]
    head_heat: float  #: Heat through a piston head at the fastest speed [W]
    #: Bore, stroke of one piston, distance of the heads at top dead centre (0 under a fixed head) [m]
    bore: float
    stroke: float
    gap: float


def size_piston(loads: CylinderLoads, wants: Wants, material: Material, rod_length: Metre) -> PistonPart:
    """The piston that the loads ask for.

    rod_length: distance from the crank's side of the rod to the middle of the engine, less half the gap. Returns part:
    sizes, rounded up to half a millimetre (the head to a quarter).
    """
    B = loads.bore
    strong = piston.head_thickness_strength(loads.dp_max.max(), B, need(material, "hot_ultimate") / wants.head)
    cool = piston.head_thickness_heat(loads.head_heat, need(material, "conductivity"), wants.head_dT)
    head = round_up(max(strong, cool), 0.25e-3)
    axial = piston.ring_axial_thickness(B, round(wants.rings))
    land = 0.75 * axial
    diameter = piston.rod_diameter(np.abs(loads.rod).max(), need(material, "fatigue") / wants.rod)
    return PistonPart(
        head=head, barrel=piston.barrel_thickness(B, wants.ring_thickness), ring_radial=wants.ring_thickness,
        ring_axial=axial, land_top=head, land=land, height=piston.head_height(head, land, axial, round(wants.rings)),
        rod=round_up(diameter), rod_length=rod_length - head,
    )  # fmt: skip


def check_piston(part: PistonPart, loads: CylinderLoads, wants: Wants, material: Material) -> list[Check]:
    """The checks of a piston and its rod."""
    hottest = int(np.argmax(loads.dp_max))
    stress = piston.head_stress(loads.dp_max[hottest], loads.bore, part.head)
    cool = piston.head_thickness_heat(loads.head_heat, need(material, "conductivity"), wants.head_dT)
    thinnest = piston.ring_radial_thickness(loads.bore, 0.025e6, 110e6)
    return [
        at_most("piston head", "bending stress", stress, need(material, "hot_ultimate"), "Pa", wanted=wants.head,
                rule="Grashof", source="eq. 4.2", note=at_speed(loads.omega, hottest)),
        at_least("piston head", "thickness for heat", part.head, cool, "m", wanted=1.0, rule="heat conduction",
                 source="eqs. 4.3, 4.4", note="at the fastest speed"),
        at_least("piston ring", "radial thickness", part.ring_radial, thinnest, "m", wanted=1.0,
                 rule="ring in bending", source="eq. 4.6", note="against the least of the usual range"),
        *_check_rod(part, loads, wants, material),
    ]  # fmt: skip


def size_cylinder(loads: CylinderLoads, wants: Wants, material: Material, height: Metre) -> CylinderPart:
    """The cylinder that the loads ask for.

    height: height of a piston head. Returns part: sizes, rounded up to half a millimetre.
    """
    p = loads.dp_max.max()
    wall = round_up(cylinder.wall_thickness(p, loads.bore, need(material, "fatigue") / wants.wall, wants.reboring))
    core = cylinder.core_diameter(p, loads.bore, round(wants.bolts), wants.bolt_stress)
    return CylinderPart(
        wall=wall,
        flange=round_up(cylinder.flange_range(wall)[0]),
        bolts=wants.bolts,
        length=round_up(cylinder.cylinder_length(loads.gap, height, loads.stroke)),
        thread_mm=cylinder.thread_for(core),
    )


def check_cylinder(
    part: CylinderPart, loads: CylinderLoads, wants: Wants, material: Material, height: Metre
) -> list[Check]:
    """The checks of a cylinder and its bolts. height: height of a piston head."""
    k = int(np.argmax(loads.dp_max))
    p, note = loads.dp_max[k], at_speed(loads.omega, k)
    hoop = cylinder.hoop_stress(p, loads.bore, part.wall - wants.reboring)
    core = cylinder.root_diameter(round(part.thread_mm))
    stress = cylinder.bolt_stress(p, loads.bore, round(part.bolts), core)
    needed = cylinder.cylinder_length(loads.gap, height, loads.stroke)
    return [
        at_most("cylinder wall", "hoop stress", hoop, need(material, "fatigue"), "Pa", wanted=wants.wall,
                rule="thin cylinder", source="eq. 4.13", note=f"{note}, rebored"),
        at_least("cylinder flange", "thickness", part.flange, cylinder.flange_range(part.wall)[0], "m", wanted=1.0,
                 rule="1.2 times the wall", source="ch. 4.3"),
        at_least("cylinder", "length", part.length, needed, "m", wanted=1.0, rule="both pistons guided",
                 source="eq. 4.17"),
        at_most("cylinder bolts", f"stress in the core of M{part.thread_mm:.0f}", stress, wants.bolt_stress, "Pa",
                wanted=1.0, rule="bolt core", source="eq. 4.18, ISO 724", note=note),
    ]  # fmt: skip


def _check_rod(part: PistonPart, loads: CylinderLoads, wants: Wants, material: Material) -> list[Check]:
    area, fatigue = np.pi * part.rod**2 / 4, need(material, "fatigue")
    amplitude, _ = stress_cycle(loads.rod / area)
    k, j = np.unravel_index(int(np.argmax(np.abs(loads.rod))), loads.rod.shape)
    peak, worst = abs(float(loads.rod[k, j])), int(np.argmax(amplitude))
    factor = goodman_factor(amplitude[worst], 0.0, fatigue, material.ultimate)
    strength = material.yield_strength or material.ultimate
    buckling = piston.rod_buckling_load(part.rod, part.rod_length, material.youngs_modulus, strength)
    return [
        at_most("piston rod", "largest stress", peak / area, fatigue, "Pa", wanted=wants.rod, rule="axial stress",
                source="eq. 4.5", note=at_speed(loads.omega, int(k))),
        at_most("piston rod", "stress amplitude", float(amplitude[worst]), float(amplitude[worst] * factor), "Pa",
                wanted=wants.rod, rule="Goodman", source="Shigley eq. 6-46",
                note=f"{at_speed(loads.omega, worst)}; mean stress is compression"),
        at_most("piston rod", "load", peak, buckling, "N", wanted=wants.rod, rule="buckling (Johnson, Euler)",
                source="Shigley eq. 4-42", note=at_speed(loads.omega, int(k))),
    ]  # fmt: skip

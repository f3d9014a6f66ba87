"""Piston, rod, cylinder, bolts, crankpin, webs, shafts: sizes for the loads of every speed, and their checks."""

from collections.abc import Callable
from dataclasses import fields
from functools import partial
from typing import Any

import numpy as np

from mechsym.cycle.chamber import chamber
from mechsym.cycle.closed.model import ClosedEngine, closed_period
from mechsym.cycle.closed.run import dense, run
from mechsym.cycle.engine import over_speeds
from mechsym.quantities import record
from mechsym.quantities.units import Array, Metre, Pure, RadPerSecond
from mechsym.sizing.checks import Check, at_least, at_most, at_speed, round_up
from mechsym.sizing.loads import over_period
from mechsym.sizing.rules import crankshaft, piston
from mechsym.sizing.rules.materials import Material, need
from mechsym.sizing.rules.turning_shaft import (
    Section,
    endurance_limit,
    fatigue_factor,
    fillet_factor_bending,
    fillet_factor_torsion,
    goodman_factor,
    shaft_diameter_goodman,
    static_factor,
    stress_cycle,
)
from mechsym.sizing.wants import CrankPart, CylinderPart, PistonPart, Wants

_SHOULDER = 1.2  # the output shaft's largest shoulder over its diameter
_SHOULDER_FILLET = 0.1  # and its fillet over the diameter
_STEPS = 720  # angles over a period of 4 pi; divisible by 4 for the teeth's returns


@record
class OverSpeeds:
    """Speeds and angles at which loads are known, and the chamber that makes them."""

    #: shape (k,), (n,): Crank speeds [rad/s], crank angles from firing top dead centre [rad]
    omega: np.ndarray
    theta: np.ndarray
    dp_max: np.ndarray  #: shape (k,): Largest pressure above the surroundings [Pa]
    #: Bore, stroke of one piston, distance of the heads (0 under a fixed head) [m], heat through a head [W]
    bore: float
    stroke: float
    gap: float
    head_heat: float

    def shared(self) -> dict[str, Any]:
        """All of this by name, for loads that come of it."""
        return {field.name: getattr(self, field.name) for field in fields(OverSpeeds)}


@record
class Pressures(OverSpeeds):
    """Pressure over the period at every speed."""

    net: np.ndarray  #: shape (k, n): Gas force on a piston, the pressure behind it taken off [N]


def pressures_over(engine: ClosedEngine, omega: RadPerSecond[Array], heat_share: Pure) -> Pressures:
    """The cycle at every speed, gas exchange at the surroundings' pressure.

    omega: crank speeds, shape (k,); heat_share: share of the fuel's heat that goes through the two heads.
    """
    theta = np.arange(_STEPS) * 4 * np.pi / _STEPS
    phi, closed, _ = dense(run(partial(closed_period, engine), {"omega": omega}))
    around, room = engine.cycle.intake_pressure, chamber(engine.chamber, engine.motion)
    p = over_period(theta, phi, closed, around)
    top = over_speeds(engine, omega.max(keepdims=True))
    fuel = float(top.sfc[0] * top.power[0])  # in one cylinder, for the heads of both its pistons
    return Pressures(
        omega=omega,
        theta=theta,
        net=(p - engine.chamber.back_pressure) * float(room.area),
        dp_max=p.max(axis=1) - around,
        bore=float(room.bore),
        stroke=float(room.stroke),
        gap=piston.tdc_gap(float(room.clearance), float(room.area)),
        head_heat=piston.head_heat(fuel / 2, engine.cycle.heating_value, heat_share),
    )


@record
class CrankLoads:
    """What acts on the crank of one piston."""

    omega: np.ndarray  #: shape (k,): Crank speeds [rad/s]
    #: Distance from the middle of the crankpin [m] -> bending moment (2, k, n) in a frame that stands still [N*m]
    moment: Callable[[float], np.ndarray]
    turn: np.ndarray  #: shape (n,): Angle of the crankshaft (the planet turns backwards) in that frame [rad]
    along_web: np.ndarray  #: shape (k, n): Component of the force along the web, from pin to shaft [N]
    shaft_torque: np.ndarray  #: shape (k, n): Torque in one shaft between web and gear, or web and coupling [N*m]
    output_torque: np.ndarray  #: shape (k, n): Torque in the output shaft [N*m]
    arm: float  #: From the middle of the crankpin to the middle of the bearing beside the web [m]


def size_output(loads: CrankLoads, wants: Wants, material: Material, least: Metre) -> Metre:
    """Diameter of the output shaft for static torsion and fatigue, up to half a millimetre. least: smallest."""
    peak = np.abs(loads.output_torque).max()
    d = max(least, crankshaft.shaft_diameter(peak, _shear_strength(material) / wants.shaft_static))
    amplitude, mean = stress_cycle(loads.output_torque)
    K_fs = fillet_factor_torsion(_SHOULDER_FILLET, 1.0, _SHOULDER)
    for _ in range(20):
        S_e = endurance_limit(material.ultimate, d, wants.surface)
        needed = max(
            shaft_diameter_goodman((0.0, 0.0, a, abs(m)), S_e, material.ultimate, wants.fatigue, K_fs=K_fs)
            for a, m in zip(amplitude, mean, strict=True)
        )
        if needed <= d:
            break
        d = needed
    return round_up(d)


def check_crank(part: CrankPart, loads: CrankLoads, wants: Wants, material: Material) -> list[Check]:
    """The checks of crankpin, web and shaft. Returns checks: one for each section and rule."""
    strength = material.yield_strength or material.ultimate
    places = {
        "crankpin, middle": (part.pin, 0.0, False),
        "crankpin, fillet": (part.pin, part.pin_length / 2, True),
        "shaft, fillet at the web": (part.shaft, part.pin_length / 2 + part.web, True),
    }
    checks = []
    for name, (d, z, notched) in places.items():
        M_x, M_y = loads.moment(z)
        T = loads.shaft_torque if name.startswith("shaft") else np.zeros_like(M_x)
        bore = 0.0 if name.startswith("shaft") else part.pin_bore
        section = _section((d, bore), part, wants, material, notched)
        checks.append(_worst(name, "static factor", static_factor(section, M_x, M_y, T, strength), wants.shaft_static,
                             "bending and torsion", "eq. 4.32, von Mises", loads))  # fmt: skip
        checks.append(_worst(name, "fatigue factor", fatigue_factor(section, M_x, M_y, loads.turn, T), wants.fatigue,
                             "Goodman, fibre by fibre", "Shigley eq. 7-7", loads))  # fmt: skip
    return [*checks, *_check_web(part, loads, wants, material)]


def check_output(d: Metre, loads: CrankLoads, wants: Wants, material: Material) -> list[Check]:
    """The checks of the output shaft. d: diameter."""
    tau = crankshaft.torsion_stress(np.abs(loads.output_torque).max(axis=1), d)
    k = int(np.argmax(tau))
    K_fs = fillet_factor_torsion(_SHOULDER_FILLET, 1.0, _SHOULDER)
    S_e = endurance_limit(material.ultimate, d, wants.surface)
    section = Section(d=d, S_e=S_e, S_ut=material.ultimate, K_fs=K_fs)
    none = np.zeros_like(loads.output_torque)
    fatigue = fatigue_factor(section, none, none, loads.turn, loads.output_torque)
    return [
        at_most("output shaft", "shear stress", float(tau[k]), _shear_strength(material), "Pa",
                wanted=wants.shaft_static, rule="torsion", source="eq. 4.35", note=at_speed(loads.omega, k)),
        _worst("output shaft", "fatigue factor", fatigue, wants.fatigue, "Goodman", "Shigley eq. 7-7", loads),
    ]  # fmt: skip


def _section(size: tuple[float, float], part: CrankPart, wants: Wants, material: Material, notched: bool) -> Section:
    d, bore = size
    S_e = endurance_limit(material.ultimate, d, wants.surface)
    if not notched:
        return Section(d=d, bore=bore, S_e=S_e, S_ut=material.ultimate)
    wide = max(part.web_width, 2 * d)  # a web is a wide shoulder
    K_f, K_fs = fillet_factor_bending(wants.fillet, d, wide), fillet_factor_torsion(wants.fillet, d, wide)
    return Section(d=d, bore=bore, S_e=S_e, S_ut=material.ultimate, K_f=K_f, K_fs=K_fs)


def _check_web(part: CrankPart, loads: CrankLoads, wants: Wants, material: Material) -> list[Check]:
    per_load = crankshaft.web_stress(0.5, loads.arm, part.pin_length, part.web, part.web_width)
    stress = per_load * loads.along_web
    amplitude, mean = stress_cycle(stress)
    S_e = endurance_limit(material.ultimate, part.web, wants.surface)
    factor = goodman_factor(amplitude, np.abs(mean), S_e, material.ultimate)
    strength = material.yield_strength or material.ultimate
    k = int(np.argmax(np.abs(stress).max(axis=1)))
    return [
        at_most("crank web", "stress", float(np.abs(stress[k]).max()), strength, "Pa", wanted=wants.shaft_static,
                rule="bending and direct stress", source="eq. 4.34", note=at_speed(loads.omega, k)),
        _worst("crank web", "fatigue factor", factor, wants.fatigue, "Goodman", "Shigley eq. 6-46", loads),
    ]  # fmt: skip


def _worst(
    name: str, quantity: str, factor: np.ndarray, wanted: float, rule: str, source: str, loads: CrankLoads
) -> Check:
    k = int(np.argmin(factor))
    value = float(factor[k])
    return Check(component=name, quantity=quantity, value=value, limit=1.0, unit="-", safety_factor=value,
                 wanted=wanted, rule=rule, source=source, note=at_speed(loads.omega, k))  # fmt: skip


def _shear_strength(material: Material) -> float:
    return material.ultimate_shear or 0.577 * material.ultimate


@record
class CylinderLoads(OverSpeeds):
    """What acts on piston and cylinder."""

    rod: np.ndarray  #: shape (k, n): Force in the rod, compression positive [N]


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
    area, fatigue = np.pi * part.rod**2 / 4, need(material, "fatigue")
    amplitude, _ = stress_cycle(loads.rod / area)
    k, j = np.unravel_index(int(np.argmax(np.abs(loads.rod))), loads.rod.shape)
    peak, worst = abs(float(loads.rod[k, j])), int(np.argmax(amplitude))
    factor = goodman_factor(amplitude[worst], 0.0, fatigue, material.ultimate)
    strength = material.yield_strength or material.ultimate
    buckling = piston.rod_buckling_load(part.rod, part.rod_length, material.youngs_modulus, strength)
    return [
        at_most("piston head", "bending stress", stress, need(material, "hot_ultimate"), "Pa", wanted=wants.head,
                rule="Grashof", source="eq. 4.2", note=at_speed(loads.omega, hottest)),
        at_least("piston head", "thickness for heat", part.head, cool, "m", wanted=1.0, rule="heat conduction",
                 source="eqs. 4.3, 4.4", note="at the fastest speed"),
        at_least("piston ring", "radial thickness", part.ring_radial, thinnest, "m", wanted=1.0,
                 rule="ring in bending", source="eq. 4.6", note="against the least of the usual range"),
        *[
        at_most("piston rod", "largest stress", peak / area, fatigue, "Pa", wanted=wants.rod, rule="axial stress",
                source="eq. 4.5", note=at_speed(loads.omega, int(k))),
        at_most("piston rod", "stress amplitude", float(amplitude[worst]), float(amplitude[worst] * factor), "Pa",
                wanted=wants.rod, rule="Goodman", source="Shigley eq. 6-46",
                note=f"{at_speed(loads.omega, worst)}; mean stress is compression"),
        at_most("piston rod", "load", peak, buckling, "N", wanted=wants.rod, rule="buckling (Johnson, Euler)",
                source="Shigley eq. 4-42", note=at_speed(loads.omega, int(k))),
    ],
    ]  # fmt: skip


def size_cylinder(loads: CylinderLoads, wants: Wants, material: Material, height: Metre) -> CylinderPart:
    """The cylinder for the loads, sizes rounded up to half a millimetre. height: of a piston head."""
    p = loads.dp_max.max()
    wall = round_up(piston.wall_thickness(p, loads.bore, need(material, "fatigue") / wants.wall, wants.reboring))
    core = piston.core_diameter(p, loads.bore, round(wants.bolts), wants.bolt_stress)
    return CylinderPart(
        wall=wall,
        flange=round_up(piston.flange_range(wall)[0]),
        bolts=wants.bolts,
        length=round_up(piston.cylinder_length(loads.gap, height, loads.stroke)),
        thread_mm=piston.thread_for(core),
    )


def check_cylinder(
    part: CylinderPart, loads: CylinderLoads, wants: Wants, material: Material, height: Metre
) -> list[Check]:
    """The checks of a cylinder and its bolts. height: height of a piston head."""
    k = int(np.argmax(loads.dp_max))
    p, note = loads.dp_max[k], at_speed(loads.omega, k)
    hoop = piston.hoop_stress(p, loads.bore, part.wall - wants.reboring)
    core = piston.root_diameter(round(part.thread_mm))
    stress = piston.bolt_stress(p, loads.bore, round(part.bolts), core)
    needed = piston.cylinder_length(loads.gap, height, loads.stroke)
    return [
        at_most("cylinder wall", "hoop stress", hoop, need(material, "fatigue"), "Pa", wanted=wants.wall,
                rule="thin cylinder", source="eq. 4.13", note=f"{note}, rebored"),
        at_least("cylinder flange", "thickness", part.flange, piston.flange_range(part.wall)[0], "m", wanted=1.0,
                 rule="1.2 times the wall", source="ch. 4.3"),
        at_least("cylinder", "length", part.length, needed, "m", wanted=1.0, rule="both pistons guided",
                 source="eq. 4.17"),
        at_most("cylinder bolts", f"stress in the core of M{part.thread_mm:.0f}", stress, wants.bolt_stress, "Pa",
                wanted=1.0, rule="bolt core", source="eq. 4.18, ISO 724", note=note),
    ]  # fmt: skip

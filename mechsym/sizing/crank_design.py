"""Crankpin, webs, shaft and output shaft: sizes and checks with the load history of every speed."""

from collections.abc import Callable

import numpy as np

from mechsym.quantities import record
from mechsym.quantities.units import Metre
from mechsym.sizing.checks import Check, at_most, at_speed, round_up
from mechsym.sizing.rules import crankshaft
from mechsym.sizing.rules.fatigue import (
    endurance_limit,
    fillet_factor_bending,
    fillet_factor_torsion,
    goodman_factor,
    shaft_diameter_goodman,
    stress_cycle,
)
from mechsym.sizing.rules.materials import Material
from mechsym.sizing.rules.turning_shaft import Section, fatigue_factor, static_factor
from mechsym.sizing.wants import CrankPart, Wants

_SHOULDER = 1.2  # the output shaft's largest shoulder over its diameter
_SHOULDER_FILLET = 0.1  # and its fillet over the diameter


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
    """Diameter of the output shaft for static torsion and fatigue.

    least: smallest diameter to begin with. Returns d: diameter, rounded up to half a millimetre.
    """
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

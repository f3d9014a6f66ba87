r"""A crosshead drive held against its rules: pins, film, shoes, piston rod, web, and where it wears.

    piston rod --[crosshead pin, shoes on the guide]-- connecting rod --[crank pin]-- web -- main journal

The crosshead pin only swings, and in a two-stroke engine its load never turns round: what carries it is the film that
the load squeezes and the swing renews. The piston rod's buckling is in `rules.piston`.
"""

from collections.abc import Mapping

import numpy as np

from mechsym.quantities import quantity, record
from mechsym.sizing.checks import Check, at_least, at_most
from mechsym.sizing.rules.crankshaft import rectangle_stress, specific_pressure, squeeze_time, wear_index
from mechsym.sizing.rules.piston import rod_buckling_load

_MARINE = "Woodyard (2009), ch. 9"


@record
class CrossheadPart:
    """Section `[part_crosshead]`: sizes of a crosshead drive, and what its materials and oil stand."""

    pin_diameter: float = quantity("m", above=0, about="diameter of the crosshead pin")
    pin_length: float = quantity("m", above=0, about="carrying length of the crosshead pin")
    pin_arc: float = quantity("rad", default=2.0, above=0, below=np.pi, about="angle of the shell that carries")
    crank_pin_diameter: float = quantity("m", above=0, about="diameter of the crank pin")
    crank_pin_length: float = quantity("m", above=0, about="carrying length of the crank pin")
    shoe_width: float = quantity("m", above=0, about="width of the guide shoes of one side")
    shoe_length: float = quantity("m", above=0, about="length of the guide shoes")
    rod_diameter: float = quantity("m", above=0, about="diameter of the piston rod")
    rod_length: float = quantity("m", above=0, about="length of the piston rod between its ends")
    web_width: float = quantity("m", above=0, about="width of the crank web")
    web_thickness: float = quantity("m", above=0, about="thickness of the crank web along the shaft")
    web_arm: float = quantity("m", above=0, about="from the middle of the main journal to that of the web")
    oil: float = quantity("Pa*s", default=0.03, above=0, about="viscosity of the oil in the bearings")
    film_start: float = quantity("m", default=50e-6, above=0, about="film that the swing leaves at its turning points")
    film_least: float = quantity("m", default=3e-6, above=0, about="film that keeps the surfaces apart")
    pin_pressure: float = quantity("Pa", default=20e6, above=0, about="allowed on the crosshead pin")
    crank_pin_pressure: float = quantity("Pa", default=15e6, above=0, about="allowed on the crank pin")
    shoe_pressure: float = quantity("Pa", default=0.6e6, above=0, about="allowed on the guide shoes")
    web_fatigue: float = quantity("Pa", default=120e6, above=0, about="fatigue strength of the web's material")
    youngs_modulus: float = quantity("Pa", default=206e9, above=0, about="Young's modulus of the piston rod")
    yield_strength: float = quantity("Pa", default=350e6, above=0, about="yield strength of the piston rod")
    wanted: float = quantity("-", default=1.0, above=0, about="safety factor of pins, shoes and film")
    wanted_web: float = quantity("-", default=2.0, above=0, about="safety factor of the web, notches included")
    wanted_buckling: float = quantity("-", default=4.0, above=0, about="safety factor of the piston rod")


@record
class CrossheadLoads:
    """One cycle at constant speed; all arrays of shape (n,), the first angle again at the end."""

    phi: np.ndarray  #: Crank angle [rad]
    omega: float  #: Crank speed [rad/s]
    #: Along the piston rod, positive where it is pressed; at the crosshead pin; at the crank pin; on the guide [N]
    rod: np.ndarray
    pin: np.ndarray
    crank_pin: np.ndarray
    side: np.ndarray
    dx_dphi: np.ndarray  #: Travel of the crosshead by the angle [m/rad]
    dpsi_dphi: np.ndarray  #: Swing of the connecting rod by the angle [-]


def checks(part: CrossheadPart, loads: CrossheadLoads) -> list[Check]:
    """Every rule with its factor of safety."""
    pin, crank_pin, side = (float(np.abs(a).max()) for a in (loads.pin, loads.crank_pin, loads.side))
    thrust = float(loads.rod.max())
    # the swing turns round twice a turn: for half of it the film is squeezed by the mean load and not renewed
    half = np.pi / loads.omega
    mean = float(np.trapezoid(np.abs(loads.pin), loads.phi) / (loads.phi[-1] - loads.phi[0]))
    lasts = squeeze_time(
        mean, part.pin_length, part.pin_diameter, part.pin_arc, part.oil, part.film_start, part.film_least
    )
    return [
        _pressure(part, "crosshead pin", pin, (part.pin_length, part.pin_diameter), part.pin_pressure),
        _pressure(part, "crank pin", crank_pin, (part.crank_pin_length, part.crank_pin_diameter),
                  part.crank_pin_pressure),
        _pressure(part, "guide shoe", side, (part.shoe_length, part.shoe_width), part.shoe_pressure),
        at_least("crosshead pin", "time of the squeezed film", lasts, half, "s", wanted=part.wanted,
                    rule="squeeze film of parallel plates with open ends", source="Hays (1961)",
                    note="mean load over half a turn"),
        at_least("piston rod", "buckling load", rod_buckling_load(
            part.rod_diameter, part.rod_length, part.youngs_modulus, part.yield_strength), thrust, "N",
            wanted=part.wanted_buckling, rule="Euler or Johnson", source="Shigley, ch. 4"),
        at_most("crank web", "stress", rectangle_stress(thrust / 2 * part.web_arm, thrust / 2, part.web_width,
                part.web_thickness), part.web_fatigue, "Pa", wanted=part.wanted_web, rule="bending and pressure",
                source="Khurmi and Gupta (2005), ch. 32", note="at the largest thrust, half on each web"),
    ]  # fmt: skip


def wear(part: CrossheadPart, loads: CrossheadLoads) -> Mapping[str, float]:
    """Mean pressure times sliding speed of pin, crank pin and shoe [Pa*m/s]."""
    pin = loads.pin / (part.pin_length * part.pin_diameter)
    crank_pin = loads.crank_pin / (part.crank_pin_length * part.crank_pin_diameter)
    shoe = loads.side / (part.shoe_length * part.shoe_width)
    swing = loads.dpsi_dphi * part.pin_diameter / 2 * loads.omega
    turning = (1 + loads.dpsi_dphi) * part.crank_pin_diameter / 2 * loads.omega
    return {
        "crosshead pin": wear_index(pin, swing, loads.phi),
        "crank pin": wear_index(crank_pin, turning, loads.phi),
        "guide shoe": wear_index(shoe, loads.dx_dphi * loads.omega, loads.phi),
    }


def _pressure(part: CrossheadPart, name: str, F: float, sizes: tuple[float, float], limit: float) -> Check:
    return at_most(name, "specific pressure", specific_pressure(F, *sizes), limit, "Pa", wanted=part.wanted,
                   rule="load by projected area", source=_MARINE)  # fmt: skip

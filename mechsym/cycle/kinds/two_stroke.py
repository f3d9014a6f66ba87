r"""An algebraic two-stroke marine cycle: no differential equation, every phase a formula.

    p |            __
      |           /  \          EVC exhaust closes   SOC start of combustion   EOC nominal end of combustion
      |          /    \         EVO exhaust opens    SPO, SPC scavenge ports open, close
      |       .-'      `-.
      |______/            \_____
      -pi  EVC  0=SOC EOC EVO SPO  pi ... SPC ... EVC + 2 pi

    EVC..SOC  p = p_comp = p_evc (V_evc / V)^n_c
    SOC..EVO  p = (1 - f) p_comp + f p_exp,  p_exp = p_ref (V_c / V)^n_e,  f a double Wiebe function
    EVO..SPO  a straight line in phi from p(EVO) to p_evc
    SPO..EVC  p = p_evc

p_ref belongs to a temperature T_ref = T_comp(TDC) + dT at top dead centre. dT is not given: it is solved for the wanted
mean indicated pressure, which is linear in it. Pressures are absolute.

Source: Shen, Zhang, Yang, Jia (2020), J. Mar. Sci. Eng., from measurements on a MAN B&W 7S80ME-C9.2.

Read into it: f is not cut off at the nominal end of combustion (there it is about 0.99), so the pressure is smooth
there; the ports close at the mirror angle of their opening and, the exhaust being open, the pressure stays at p_evc.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from mechsym.cycle.chamber import Chamber, volume
from mechsym.cycle.pressure import ATMOSPHERE, periodic, wrapped
from mechsym.cycle.wiebe import double_wiebe
from mechsym.errors import BadInput
from mechsym.quantities import choice, quantity, record


@record
class TwoStrokeMarine:
    """Inputs of the cycle: `[cycle]` with `kind = "two-stroke-marine"`."""

    bore: float = quantity("m", low=1e-3, high=10, about="diameter of the piston")
    #: Geometric: (V_d + V_c) / V_c [-]
    compression_ratio: float = quantity("-", above=1, about="geometric compression ratio")
    mean_indicated_pressure: float = quantity("Pa", above=0, high=1e8, about="wanted mean indicated pressure")
    p_s: float = quantity("Pa", above=0.5e5, below=20e5, about="absolute scavenge pressure")
    T_evc: float = quantity("K", above=200, below=800, about="temperature when the exhaust closes")
    #: Exhaust closes (negative), combustion starts, exhaust opens, scavenge ports open; from TDC [rad]
    evc: float = quantity("rad", above=-math.pi, below=0, about="exhaust closes")
    soc: float = quantity("rad", default=0.0, above=-math.pi / 3, below=math.pi / 3, about="combustion starts")
    #: Duration of combustion, the scale of the Wiebe function [rad]
    duration: float = quantity("rad", above=0, below=math.pi, about="duration of combustion")
    evo: float = quantity("rad", above=math.pi / 6, below=math.pi, about="exhaust opens")
    spo: float = quantity("rad", above=0, below=math.pi, about="scavenge ports open")
    n_c: float = quantity("-", above=1, below=1.67, about="exponent of compression")
    n_e: float = quantity("-", above=1, below=1.67, about="exponent of expansion")
    a_p: float = quantity("-", above=0, high=1000, about="Wiebe completeness of the share 1 - b")
    m_p: float = quantity("-", low=0, high=20, about="Wiebe form of the share 1 - b")
    a_d: float = quantity("-", above=0, high=1000, about="Wiebe completeness of the share b")
    m_d: float = quantity("-", low=0, high=20, about="Wiebe form of the share b")
    b: float = quantity("-", low=0, high=1, about="share of the second Wiebe function")
    R: float = quantity("J/kg/K", default=287.0, above=0, about="gas constant")
    #: Mean specific heat of the gas [J/kg/K] and lower heating value of the fuel [J/kg]; for facts only
    c_v: float = quantity("J/kg/K", default=900.0, above=0, about="mean specific heat between 1000 and 2500 K")
    lhv: float = quantity("J/kg", default=42.7e6, above=0, about="lower heating value of the fuel")
    #: What is under the piston: `atmosphere` (p_back) or `scavenge` (p_s)
    crank_side: str = choice("atmosphere", "scavenge", default="atmosphere", about="what is under the piston")
    #: Absolute pressure under the piston for `crank_side = "atmosphere"` [Pa]
    p_back: float = quantity("Pa", default=ATMOSPHERE, low=0, high=1e8, about="absolute pressure under the piston")

    def __post_init__(self) -> None:
        burnt = ("soc + duration", self.soc + self.duration)
        order = (("evc", self.evc), ("soc", self.soc), burnt, ("evo", self.evo), ("spo", self.spo))
        for (name, angle), (later, limit) in zip(order, order[1:], strict=False):
            if not angle < limit:
                raise BadInput(
                    f"{name} = {math.degrees(angle):g} deg is not before {later} = {math.degrees(limit):g} deg; "
                    "the order is evc < soc < soc + duration < evo < spo"
                )


def scavenging_pressure(p_s: float) -> float:
    r"""Pressure while scavenging and when the exhaust closes.

    .. math:: p_{evc} = 0.9749\,p_s - 0.1029\ \mathrm{bar}

    Parameters
    ----------
    p_s : float
        Absolute scavenge pressure [Pa]

    Returns
    -------
    p_evc : float
        Absolute pressure in the cylinder [Pa]

    Notes
    -----
    Source: Shen et al. (2020), fitted to measurements with p_s up to about 4 bar.
    """
    return 0.9749 * p_s - 0.1029e5


def back_pressure(cycle: TwoStrokeMarine) -> float:
    """Absolute pressure under the piston.

    Returns
    -------
    p_back : float
        p_back, or p_s for `crank_side = "scavenge"` [Pa]
    """
    return cycle.p_s if cycle.crank_side == "scavenge" else cycle.p_back


def events(cycle: TwoStrokeMarine) -> dict[str, float]:
    """Names and angles of the cycle's events.

    Returns
    -------
    angles : dict of str to float
        In the order of the turn, from exhaust closing, in [evc, evc + 2 pi) [rad]
    """
    return {
        "exhaust closes": cycle.evc,
        "combustion starts": cycle.soc,
        "nominal end of combustion": cycle.soc + cycle.duration,
        "exhaust opens": cycle.evo,
        "scavenge ports open": cycle.spo,
        "scavenge ports close": 2 * math.pi - cycle.spo,
    }


def kinks(cycle: TwoStrokeMarine) -> tuple[float, ...]:
    """Crank angles where the pressure is not smooth.

    Returns
    -------
    angles : tuple of float
        Start of combustion, EVO, SPO and EVC, ascending in [0, 2 pi) [rad]

    Notes
    -----
    At the start of combustion the slope is continuous but not the curvature (m_d < 1 even makes it infinite). The
    nominal end of combustion and the closing of the ports leave no kink.
    """
    return tuple(sorted(float(wrapped(a, 2 * math.pi)) for a in (cycle.evc, cycle.soc, cycle.evo, cycle.spo)))


def absolute_pressure(cycle: TwoStrokeMarine, cylinder: Chamber, ratio: float) -> Callable[[Any], Any]:
    r"""The cycle's pressure for a given temperature ratio.

    .. math:: p = (1-f)\,p_{comp} + f\,\rho\,p_{comp}(0)\,(V_c/V)^{n_e}

    between EVC and EVO, then a straight line to p_evc at SPO, then p_evc.

    Parameters
    ----------
    ratio : float
        T_ref / T_comp at top dead centre, 1 without fuel [-]

    Returns
    -------
    absolute : callable
        ndarray of crank angles, any real [rad], to absolute pressure of the same shape [Pa]
    """
    v_c, p_evc = cylinder.clearance, scavenging_pressure(cycle.p_s)
    p_comp = p_evc * (float(volume(cylinder, cycle.evc)) / v_c) ** cycle.n_c
    shape = (cycle.a_p, cycle.m_p, cycle.a_d, cycle.m_d, cycle.b)

    def closed(phi: Any) -> Any:
        v = volume(cylinder, phi) / v_c
        f = double_wiebe((phi - cycle.soc) / cycle.duration, *shape)
        compression = p_comp * v**-cycle.n_c
        return compression + f * (ratio * p_comp * v**-cycle.n_e - compression)

    p_evo = float(closed(cycle.evo))

    def one_turn(phi: Any) -> Any:
        line = p_evo + (p_evc - p_evo) * (phi - cycle.evo) / (cycle.spo - cycle.evo)
        return np.where(phi <= cycle.evo, closed(phi), np.where(phi < cycle.spo, line, p_evc))[()]

    return periodic(one_turn, 2 * math.pi, start=cycle.evc)


def as_diagram(cycle: TwoStrokeMarine) -> dict[str, Any]:
    """What the cycle knows of an engine whose measured diagram takes its place: fields of `Diagram`."""
    # the compression line stands between the exhaust's closing and the start of combustion, with a margin
    return {
        "working_cycle": "two-stroke",
        "n_c": cycle.n_c,
        "pegging": "polytropic",
        "fit_from": max(cycle.evc + math.radians(15.0), math.radians(-90.0)),
        "fit_to": min(cycle.soc - math.radians(5.0), math.radians(-15.0)),
    }

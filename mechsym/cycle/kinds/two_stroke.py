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
from mechsym.cycle.pressure import ATMOSPHERE, Pressure, mean_indicated_pressure, periodic, pressure_over, wrapped
from mechsym.cycle.wiebe import BURNT, double_burnt_at, double_wiebe
from mechsym.errors import BadInput
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.display import quantity_text
from mechsym.quantities.units import Pascal, Pure, Radian, Scalar


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
    p_back: float = quantity(
        "Pa", default=ATMOSPHERE, low=0, high=1e8, about="absolute pressure under the piston",
        only=("crank_side", "atmosphere"),
    )  # fmt: skip

    def __post_init__(self) -> None:
        burnt = ("soc + duration", self.soc + self.duration)
        order = (("evc", self.evc), ("soc", self.soc), burnt, ("evo", self.evo), ("spo", self.spo))
        for (name, angle), (later, limit) in zip(order, order[1:], strict=False):
            if not angle < limit:
                raise BadInput(
                    f"{name} = {math.degrees(angle):g} deg is not before {later} = {math.degrees(limit):g} deg; "
                    "the order is evc < soc < soc + duration < evo < spo"
                )


def scavenging_pressure(p_s: Pascal) -> Pascal:
    r"""Pressure while scavenging and when the exhaust closes.

    .. math:: p_{evc} = 0.9749\,p_s - 0.1029\ \mathrm{bar}

    p_s: absolute scavenge pressure. Returns p_evc: absolute pressure in the cylinder.
    Source: Shen et al. (2020), fitted to measurements with p_s up to about 4 bar.
    """
    return 0.9749 * p_s - 0.1029e5


def blown_down(cycle: Any, p_evo: Pascal, phi: Scalar) -> Scalar:
    """Pressure from the opening of the exhaust, p_evo, to that of the ports: a straight line over the angle [Pa]."""
    return p_evo + (scavenging_pressure(cycle.p_s) - p_evo) * (phi - cycle.evo) / (cycle.spo - cycle.evo)


def back_pressure(cycle: TwoStrokeMarine) -> Pascal:
    """Absolute pressure under the piston. Returns p_back: p_back, or p_s for `crank_side = "scavenge"`."""
    return cycle.p_s if cycle.crank_side == "scavenge" else cycle.p_back


def events(cycle: TwoStrokeMarine) -> dict[str, Radian]:
    """Names and angles of the cycle's events, in the order of the turn from exhaust closing, below evc + 2 pi."""
    return {
        "exhaust closes": cycle.evc,
        "combustion starts": cycle.soc,
        "nominal end of combustion": cycle.soc + cycle.duration,
        "exhaust opens": cycle.evo,
        "scavenge ports open": cycle.spo,
        "scavenge ports close": 2 * math.pi - cycle.spo,
    }


def kinks(cycle: TwoStrokeMarine) -> tuple[Radian, ...]:
    """Crank angles where the pressure is not smooth.

    Returns angles: start of combustion, EVO, SPO and EVC, ascending in [0, 2 pi). At the start of combustion the slope
    is continuous but not the curvature (m_d < 1 even makes it infinite). The nominal end of combustion and the closing
    of the ports leave no kink.
    """
    return tuple(sorted(float(wrapped(a, 2 * math.pi)) for a in (cycle.evc, cycle.soc, cycle.evo, cycle.spo)))


def absolute_pressure(cycle: TwoStrokeMarine, cylinder: Chamber, ratio: Pure) -> Callable[[Scalar], Scalar]:
    """The cycle's pressure for a given temperature ratio, as `formulas` give it, over any real angles [rad]."""
    _, (_, _, closed), (evo, spo, line), (_, _, still) = formulas(cycle, cylinder, ratio)

    def one_turn(phi: Scalar) -> Scalar:
        return np.where(phi <= evo, closed(phi), np.where(phi < spo, line(phi), still(phi)))[()]

    return periodic(one_turn, 2 * math.pi, start=cycle.evc)


def formulas(
    cycle: TwoStrokeMarine, cylinder: Chamber, ratio: Pure
) -> tuple[tuple[float, float, Callable[[Any], Any]], ...]:
    r"""The cycle's pressure for a given temperature ratio, from angle to angle.

    .. math:: p = (1-f)\,p_{comp} + f\,\rho\,p_{comp}(0)\,(V_c/V)^{n_e}

    between EVC and EVO, then a straight line to p_evc at SPO, then p_evc. ratio: T_ref / T_comp at top dead centre, 1
    without fuel. Returns pieces: from and to an angle [rad], and the absolute pressure there [Pa] as a callable of
    numbers, arrays or a CasADi symbol.
    """
    v_c, p_evc = cylinder.clearance, scavenging_pressure(cycle.p_s)
    p_comp = p_evc * (float(volume(cylinder, cycle.evc)) / v_c) ** cycle.n_c
    shape = (cycle.a_p, cycle.m_p, cycle.a_d, cycle.m_d, cycle.b)

    def closed(phi: Scalar) -> Scalar:
        v = volume(cylinder, phi) / v_c
        f = double_wiebe((phi - cycle.soc) / cycle.duration, *shape)
        compression = p_comp * v**-cycle.n_c
        return compression + f * (ratio * p_comp * v**-cycle.n_e - compression)

    p_evo = float(closed(cycle.evo))

    return (
        (cycle.evc, cycle.soc, lambda phi: p_comp * (volume(cylinder, phi) / v_c) ** -cycle.n_c),
        (cycle.soc, cycle.evo, closed),
        (cycle.evo, cycle.spo, lambda phi: blown_down(cycle, p_evo, phi)),
        (cycle.spo, cycle.evc + 2 * math.pi, lambda phi: p_evc + 0 * phi),
    )


def as_diagram(cycle: TwoStrokeMarine) -> dict[str, str | float]:
    """What the cycle knows of an engine whose measured diagram takes its place: fields of `Diagram`."""
    # the compression line stands between the exhaust's closing and the start of combustion, with a margin
    return {
        "working_cycle": "two-stroke",
        "p_back": back_pressure(cycle),
        "n_c": cycle.n_c,
        "pegging": "polytropic",
        "fit_from": max(cycle.evc + math.radians(15.0), math.radians(-90.0)),
        "fit_to": min(cycle.soc - math.radians(5.0), math.radians(-15.0)),
    }


def burnt_angles(cycle: Any, end: Pure) -> dict[str, float]:
    """CA10, CA50 and CA90 from top dead centre [deg].

    cycle: with the double Wiebe function of a two-stroke engine; end: y where burning stops, infinite where nothing
    cuts it off.
    """
    shape = (cycle.a_p, cycle.m_p, cycle.a_d, cycle.m_d, cycle.b)
    return {
        name: math.degrees(cycle.soc + cycle.duration * double_burnt_at(share, shape, end))
        for name, share in BURNT.items()
    }


_CLOSED_POINTS = 881  # of the closed period, where the highest temperature is looked for
_AIR_BY_FUEL = 14.6  # stoichiometric, marine fuel oil


@record
class TwoStrokeState:
    """The cycle closed for the wanted mean pressure."""

    #: Scavenging; compression and expansion reference at TDC; exhaust opening [Pa]
    p_evc: float
    p_comp: float
    p_ref: float
    p_evo: float
    #: Compression temperature at TDC and the rise to the expansion's reference [K]
    T_comp: float
    dT: float
    mass: float  #: Trapped gas [kg]
    excess_air: float  #: Air-fuel ratio over the stoichiometric one that the rise would need [-]
    fuel: float  #: What the rise would need of it, without heat to the walls [kg]
    efficiency: float  #: Indicated work by the heat of that fuel [-]


def solve(cycle: TwoStrokeMarine, cylinder: Chamber) -> TwoStrokeState:
    r"""Close the cycle: the temperature rise that gives the wanted mean indicated pressure.

    .. math:: p_{mi}(\rho) = p_{mi}(1) + (\rho - 1)\,[p_{mi}(2) - p_{mi}(1)],\quad \rho = T_{ref}/T_{comp}

    cylinder: geometry, with the same bore and compression ratio. Returns state: pressures, temperatures and what they
    mean for the fuel. Raises BadInput: the wanted mean pressure is below that of the cycle without fuel.

    The pressure is linear in p_ref at every angle, so two evaluations close the cycle; a third one corrects round-off.
    """

    def mean(ratio: float) -> float:
        return mean_indicated_pressure(absolute_pressure(cycle, cylinder, ratio), 2 * math.pi, kinks(cycle), cylinder)

    without_fuel, slope = mean(1.0), mean(2.0) - mean(1.0)
    ratio = 1 + (cycle.mean_indicated_pressure - without_fuel) / slope
    ratio += (cycle.mean_indicated_pressure - mean(ratio)) / slope
    if ratio <= 1:
        raise BadInput(
            f"mean_indicated_pressure = {cycle.mean_indicated_pressure / 1e5:g} bar needs no fuel: without it there "
            f"are {without_fuel / 1e5:.3g} bar; give more, or a lower scavenge pressure p_s"
        )
    return _state(cycle, cylinder, ratio)


def _state(cycle: TwoStrokeMarine, cylinder: Chamber, ratio: float) -> TwoStrokeState:
    p_evc, v_evc = scavenging_pressure(cycle.p_s), float(volume(cylinder, cycle.evc))
    squeeze = v_evc / cylinder.clearance
    T_comp = cycle.T_evc * squeeze ** (cycle.n_c - 1)
    dT = T_comp * (ratio - 1)
    mass = p_evc * v_evc / (cycle.R * cycle.T_evc)
    # T_ref = T_comp + m_f lhv / (c_v (mass + m_f)), solved for the fuel m_f
    fuel = mass * cycle.c_v * dT / max(cycle.lhv - cycle.c_v * dT, 1.0)
    return TwoStrokeState(
        p_evc=p_evc,
        p_comp=p_evc * squeeze**cycle.n_c,
        p_ref=p_evc * squeeze**cycle.n_c * ratio,
        p_evo=float(absolute_pressure(cycle, cylinder, ratio)(cycle.evo)),
        T_comp=T_comp,
        dT=dT,
        mass=mass,
        excess_air=mass / fuel / _AIR_BY_FUEL,
        fuel=fuel,
        efficiency=cycle.mean_indicated_pressure * cylinder.displacement / (fuel * cycle.lhv),
    )


def two_stroke_pressure(cycle: TwoStrokeMarine, cylinder: Chamber) -> Pressure:
    """Pressure of the two-stroke marine cycle, by formulas in every phase, so to round-off."""
    state = solve(cycle, cylinder)
    absolute = absolute_pressure(cycle, cylinder, state.p_ref / state.p_comp)
    closed = np.linspace(cycle.evc, cycle.evo, _CLOSED_POINTS)
    hottest = float(np.max(absolute(closed) * volume(cylinder, closed))) / (state.mass * cycle.R)
    trapped = float(volume(cylinder, cycle.evc)) / cylinder.clearance
    burnt = double_wiebe(1.0, cycle.a_p, cycle.m_p, cycle.a_d, cycle.m_d, cycle.b)
    pieces = []
    if state.excess_air < 1.3:
        pieces.append(
            f"the mean pressure needs {state.excess_air:.2f} times the stoichiometric air; a diesel needs 1.3"
        )
    if state.T_comp + state.dT > 3000:
        pieces.append(
            f"reference temperature {state.T_comp + state.dT:.0f} K is above any flame of oil in air (3000 K)"
        )
    if state.efficiency > 0.65:
        pieces.append(f"indicated efficiency {state.efficiency:.2f} is above what marine engines reach (0.55)")
    if state.p_evo < state.p_evc:
        pieces.append("the pressure is below the scavenge pressure when the exhaust opens")
    facts = (
        f"compression ratio {cycle.compression_ratio:g} is read as geometric; from exhaust closing it is {trapped:.2f}",
        f"pressures at top dead centre, absolute: compression {_pressure(state.p_comp)}, "
        f"expansion reference {_pressure(state.p_ref)}; when the exhaust opens {_pressure(state.p_evo)}",
        f"temperature rise solved for the mean pressure: {state.dT:.0f} K on {state.T_comp:.0f} K; with heating "
        f"value and c_v it means {state.excess_air:.2f} times the air needed and an indicated efficiency of "
        f"{state.efficiency:.2f}",
        f"burnt at the nominal end of combustion: {burnt:.3f}; the rest burns on, there is no step",
        f"scavenge ports close at the mirror angle of opening (assumed); the pressure stays at "
        f"{_pressure(state.p_evc)} absolute until the exhaust closes",
        f"under the piston: {_pressure(back_pressure(cycle))} absolute ({cycle.crank_side})",
    )
    return pressure_over(
        "two-stroke-marine", absolute, 2 * math.pi, kinks(cycle), cylinder, t_max=hottest,
        phases=events(cycle), facts=facts, doubts=tuple(pieces),
        formulas=formulas(cycle, cylinder, state.p_ref / state.p_comp),
    )  # fmt: skip


def _pressure(value: float) -> str:
    return quantity_text(value, "Pa", 4)

"""The two-stroke marine cycle closed for a wanted mean pressure, and what the result means.

    inputs --solve--> temperature rise --two_stroke_pressure--> Pressure with facts and doubts

The phases and their formulas stand in `two_stroke`.
"""

import math

import numpy as np

from mechsym.cycle.chamber import Chamber, volume
from mechsym.cycle.kinds.two_stroke import (
    TwoStrokeMarine,
    absolute_pressure,
    back_pressure,
    events,
    kinks,
    scavenging_pressure,
)
from mechsym.cycle.pressure import Pressure, mean_indicated_pressure, pressure_over
from mechsym.cycle.wiebe import double_wiebe
from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.quantities.display import quantity_text

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
    efficiency: float  #: Indicated work by the heat of that fuel [-]


def solve(cycle: TwoStrokeMarine, cylinder: Chamber) -> TwoStrokeState:
    r"""Close the cycle: the temperature rise that gives the wanted mean indicated pressure.

    .. math:: p_{mi}(\rho) = p_{mi}(1) + (\rho - 1)\,[p_{mi}(2) - p_{mi}(1)],\quad \rho = T_{ref}/T_{comp}

    Parameters
    ----------
    cylinder : Chamber
        Geometry, with the same bore and compression ratio

    Returns
    -------
    state : TwoStrokeState
        Pressures, temperatures and what they mean for the fuel

    Raises
    ------
    BadInput
        The wanted mean pressure is below that of the cycle without fuel

    Notes
    -----
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
        efficiency=cycle.mean_indicated_pressure * cylinder.displacement / (fuel * cycle.lhv),
    )


def two_stroke_pressure(cycle: TwoStrokeMarine, cylinder: Chamber) -> Pressure:
    """Pressure of the two-stroke marine cycle.

    Returns
    -------
    pressure : Pressure
        Evaluated by formulas in every phase, so to round-off
    """
    state = solve(cycle, cylinder)
    absolute = absolute_pressure(cycle, cylinder, state.p_ref / state.p_comp)
    closed = np.linspace(cycle.evc, cycle.evo, _CLOSED_POINTS)
    hottest = float(np.max(absolute(closed) * volume(cylinder, closed))) / (state.mass * cycle.R)
    return pressure_over(
        "two-stroke-marine", absolute, 2 * math.pi, kinks(cycle), cylinder, t_max=hottest,
        phases=events(cycle), facts=_facts(cycle, cylinder, state), doubts=_doubts(cycle, state),
    )  # fmt: skip


def _pressure(value: float) -> str:
    return quantity_text(value, "Pa", 4)


def _facts(cycle: TwoStrokeMarine, cylinder: Chamber, state: TwoStrokeState) -> tuple[str, ...]:
    trapped = float(volume(cylinder, cycle.evc)) / cylinder.clearance
    burnt = double_wiebe(1.0, cycle.a_p, cycle.m_p, cycle.a_d, cycle.m_d, cycle.b)
    return (
        f"compression ratio {cycle.compression_ratio:g} is read as geometric; from exhaust closing it is {trapped:.2f}",
        f"pressures at top dead centre, absolute: compression {_pressure(state.p_comp)}, "
        f"expansion reference {_pressure(state.p_ref)}; when the exhaust opens {_pressure(state.p_evo)}",
        f"temperature rise solved for the mean pressure: {state.dT:.0f} K on {state.T_comp:.0f} K; with lhv and c_v it "
        f"means {state.excess_air:.2f} times the air needed and an indicated efficiency of {state.efficiency:.2f}",
        f"burnt at the nominal end of combustion: {burnt:.3f}; the rest burns on, there is no step",
        f"scavenge ports close at the mirror angle of opening (assumed); the pressure stays at "
        f"{_pressure(state.p_evc)} absolute until the exhaust closes",
        f"under the piston: {_pressure(back_pressure(cycle))} absolute ({cycle.crank_side})",
    )


def _doubts(cycle: TwoStrokeMarine, state: TwoStrokeState) -> tuple[str, ...]:
    found = []
    if state.excess_air < 1.3:
        found.append(f"the mean pressure needs {state.excess_air:.2f} times the stoichiometric air; a diesel needs 1.3")
    if state.T_comp + state.dT > 3000:
        found.append(f"reference temperature {state.T_comp + state.dT:.0f} K is above any flame of oil in air (3000 K)")
    if state.efficiency > 0.65:
        found.append(f"indicated efficiency {state.efficiency:.2f} is above what marine engines reach (0.55)")
    if state.p_evo < state.p_evc:
        found.append("the pressure is below the scavenge pressure when the exhaust opens")
    return tuple(found)


def at_speed(cycle: TwoStrokeMarine, cylinder: Chamber, omega: float) -> tuple[Pressure, dict[str, float]]:
    """Pressure and what is known of the fuel: nothing; no formula of the cycle knows the speed.

    Parameters
    ----------
    omega : float
        Crank speed [rad/s]
    """
    return two_stroke_pressure(cycle, cylinder), {}

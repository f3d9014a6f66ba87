r"""Stirling cycle of the second order: the adiabatic turn, at the gas temperatures that the films leave, minus losses.

.. math:: T_h = T_{wall,h} - \frac{\dot Q_h + \dot Q_{loss}}{\bar h_h A_h}, \qquad
          T_k = T_{wall,k} + \frac{-\dot Q_k + \dot Q_{loss}}{\bar h_k A_k}

Films and friction follow the flow of each instant; the regenerator's loss goes through both films. Work is lost in flow
friction, past the piston's seal and in the buffer behind it; heat is lost through the regenerator, by conduction and by
the shuttle of the hot piston. Losses do not act back on the turn but through the two temperatures.

Sources: I. Urieli, D. M. Berchowitz, Stirling Cycle Engine Analysis (1984), chapters 5 to 7; W. R. Martini, Stirling
Engine Design Manual, NASA CR-168088 (1983). Valid: one pressure in all spaces, flow friction small against it.
Of the GPU-3 engine the indicated power comes out 1.12 times as large as measured at 4.13 MPa and 1.26 to 1.29 times at
6.9 MPa: good for comparing designs, too high for a promise. No scatter of such models was found in the literature as a
number: J. M. Strauss, R. T. Dobson, J. Energy South. Afr. 21 (2010), find the trends of this engine followed and some
figures far off; R. C. Tew, NASA (1986), that a model calibrated on one type of engine does not foretell another.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from mechsym.cycle.chamber import piston_area
from mechsym.cycle.kinds import stirling_exchangers as duct_law
from mechsym.cycle.kinds import stirling_losses as loss
from mechsym.cycle.kinds.stirling_spaces import GASES, StirlingCylinders, WorkingGas, five_spaces
from mechsym.cycle.kinds.stirling_turn import StirlingTurn, solver
from mechsym.errors import BadInput
from mechsym.quantities import quantity, record

_ROUNDS, _SETTLED, _DAMPED = 80, 1e-9, 0.6
_ENTRANCE = 1.5  # velocity heads lost at the sharp entrance and exit of an exchanger


@record
class StirlingLosses:
    """Section `[stirling]`: exchangers, seal and buffer of a Stirling engine."""

    heater_diameter: float = quantity("m", above=0, about="inner diameter of the heater's tubes")
    heater_length: float = quantity("m", above=0, about="length of the heater's tubes")
    heater_heated: float = quantity("-", default=1.0, above=0, high=1, about="share of the length that is heated")
    cooler_diameter: float = quantity("m", above=0, about="inner diameter of the cooler's tubes")
    cooler_length: float = quantity("m", above=0, about="length of the cooler's tubes")
    cooler_cooled: float = quantity("-", default=1.0, above=0, high=1, about="share of the length that is cooled")
    wire: float = quantity("m", above=0, about="wire of the regenerator's screens")
    porosity: float = quantity("-", above=0.3, below=1, about="share of gas in the regenerator's volume")
    regenerator_length: float = quantity("m", above=0, about="length of the regenerator")
    conductance: float = quantity("W/K", low=0, about="walls between the hot and the cold end: sum of k A/L")
    shuttle_gap: float = quantity("m", above=0, about="radial gap around the hot piston's dome")
    shuttle_length: float = quantity("m", above=0, about="length of the hot piston's dome")
    seal_gap: float = quantity("m", low=0, about="radial gap of the piston's seal")
    seal_length: float = quantity("m", above=0, about="length of the piston's seal")
    buffer_volume: float = quantity("m^3", above=0, about="mean volume behind the piston")
    mechanical_efficiency: float = quantity("-", default=1.0, above=0, high=1, about="brake by indicated power")


@record
class SecondOrder:
    """A Stirling engine at one speed, with what it loses."""

    turn: StirlingTurn
    #: shaft speed [rad/s]
    omega: float
    #: temperatures of the gas in heater and cooler [K]
    T_h: float
    T_k: float
    #: share of its heat that the regenerator gives back [-]
    effectiveness: float
    #: mean Reynolds number of the regenerator's screens, and of the seal's gap [-]
    screen_reynolds: float
    seal_reynolds: float
    #: powers lost, by name [W]
    work_losses: dict[str, float]
    #: heats lost from the hot to the cold side, by name [W]
    heat_losses: dict[str, float]
    #: brake power [W]
    power: float
    #: heat from the hot side, losses included [W]
    heat_in: float

    @property
    def efficiency(self) -> float:
        """Brake power by heat from the hot side [-]."""
        return self.power / self.heat_in


@record
class _Duct:
    """An exchanger."""

    V: float  #: Volume of gas [m^3]
    #: Hydraulic diameter and length [m]
    d: float
    length: float
    A_w: float  #: Wetted area that exchanges heat [m^2]
    T: float  #: Temperature of the gas [K]

    @property
    def area(self) -> float:
        return self.V / self.length


def second_order(
    cycle: StirlingCylinders, losses: StirlingLosses, volumes: Callable[[Any], tuple[Any, Any]], omega: float
) -> SecondOrder:
    """The engine at a shaft speed [rad/s]; volumes of the angle as `stirling_spaces.swept` gives them."""
    _check(cycle)
    temperatures = np.array([cycle.T_e, cycle.T_c])
    solve = solver(lambda z: five_spaces(cycle, volumes, z[0], z[1]), temperatures)
    for _ in range(_ROUNDS):
        found = _at(cycle, losses, solve(temperatures), omega, temperatures)
        change = _wall_side(cycle, losses, found) - temperatures
        if float(np.abs(change).max()) < _SETTLED * cycle.T_e:
            return found
        temperatures = temperatures + _DAMPED * change
        if temperatures[0] < 1.02 * temperatures[1]:
            raise BadInput(
                f"the films leave no difference of temperature at {omega:.4g} rad/s: gas {temperatures[0]:.0f} K hot, "
                f"{temperatures[1]:.0f} K cold; take more or finer tubes in [stirling], or a lower speed"
            )
    raise BadInput(
        f"gas temperatures do not settle at {omega:.4g} rad/s: they still move by {np.abs(change).max():.2g} K"
    )


def _check(cycle: StirlingCylinders) -> None:
    for side, name, duct in (("hot", "T_e", "heater"), ("cold", "T_c", "cooler")):
        volume, share = getattr(cycle, f"dead_{side}"), getattr(cycle, f"clearance_share_{side}")
        if not volume * (1 - share) > 0:
            raise BadInput(
                f"dead_{side} = {volume:g} m^3 with clearance_share_{side} = {share:g} leaves the {duct} no volume, "
                f"and no heat passes at {name}; the second order needs dead_{side} above 0 and a share below 1"
            )


def _ducts(cycle: StirlingCylinders, losses: StirlingLosses, T: np.ndarray) -> tuple[_Duct, _Duct, _Duct]:
    hot = cycle.dead_hot * (1 - cycle.clearance_share_hot)
    cold = cycle.dead_cold * (1 - cycle.clearance_share_cold)
    pore = losses.wire * losses.porosity / (1 - losses.porosity)
    mean = (T[0] - T[1]) / math.log(T[0] / T[1])
    heater, cooler, matrix = losses.heater_diameter, losses.cooler_diameter, cycle.dead_regenerator
    return (
        _Duct(V=hot, d=heater, length=losses.heater_length, A_w=4 * hot / heater * losses.heater_heated, T=T[0]),
        _Duct(V=matrix, d=pore, length=losses.regenerator_length, A_w=4 * matrix / pore, T=mean),
        _Duct(V=cold, d=cooler, length=losses.cooler_length, A_w=4 * cold / cooler * losses.cooler_cooled, T=T[1]),
    )


def _flows(cycle: StirlingCylinders, turn: StirlingTurn, ducts: tuple[_Duct, ...], omega: float) -> list[np.ndarray]:
    """Mass flow in the middle of each exchanger, towards the hot end [kg/s]."""
    R = GASES[cycle.gas].R
    stored = [turn.dp_dphi * duct.V / (R * duct.T) for duct in ducts]
    hot, cold = turn.flow_e + stored[0] / 2, -turn.flow_c - stored[2] / 2
    return [hot * omega, (hot + stored[0] / 2 + cold - stored[2] / 2) / 2 * omega, cold * omega]


def _reynolds(gas: WorkingGas, duct: _Duct, flow: np.ndarray) -> np.ndarray:
    mu = duct_law.viscosity(gas.mu_0, 273.0, gas.sutherland, duct.T)
    return np.maximum(np.abs(flow) * duct.d / (duct.area * mu), 1e-3)


def _mean(turn: StirlingTurn, values: np.ndarray) -> float:
    return float(np.trapezoid(values, turn.phi) / (2 * math.pi))


def _friction(gas: WorkingGas, duct: _Duct, flow: np.ndarray, turn: StirlingTurn, screens: bool) -> float:
    Re = _reynolds(gas, duct, flow)
    rho = turn.p / (gas.R * duct.T)
    f = duct_law.screen_friction(Re) if screens else duct_law.tube_friction(Re)
    heads = f * duct.length / duct.d + (0.0 if screens else _ENTRANCE)
    return _mean(turn, heads * np.abs(flow) ** 3 / (2 * rho**2 * duct.area**2))


def _at(
    cycle: StirlingCylinders, losses: StirlingLosses, turn: StirlingTurn, omega: float, T: np.ndarray
) -> SecondOrder:
    gas, ducts = GASES[cycle.gas], _ducts(cycle, losses, T)
    flows = _flows(cycle, turn, ducts, omega)
    per_second = omega / (2 * math.pi)
    reynolds = _mean(turn, _reynolds(gas, ducts[1], flows[1]))
    stanton = float(duct_law.screen_stanton(reynolds, gas.Pr))
    effectiveness = duct_law.regenerator_effectiveness(stanton * ducts[1].A_w / (2 * ducts[1].area))
    heat = {
        "regenerator": (1 - effectiveness) * float(np.ptp(turn.stored)) * per_second,
        **_hot_end(cycle, losses, turn, T),
    }
    work = {
        f"flow_{name}": _friction(gas, duct, flow, turn, name == "regenerator")
        for name, duct, flow in zip(("heater", "regenerator", "cooler"), ducts, flows, strict=True)
    } | _piston(cycle, losses, turn, omega)
    left = turn.work * per_second - sum(work.values())
    power = left * losses.mechanical_efficiency
    work["mechanical"] = left - power
    return SecondOrder(
        turn=turn, omega=omega, T_h=float(T[0]), T_k=float(T[1]), effectiveness=effectiveness, work_losses=work,
        heat_losses=heat, power=power, heat_in=turn.heat_in * per_second + sum(heat.values()), screen_reynolds=reynolds,
        seal_reynolds=_seal_reynolds(cycle, losses, turn),
    )  # fmt: skip


def _wall_side(cycle: StirlingCylinders, losses: StirlingLosses, found: SecondOrder) -> np.ndarray:
    """Temperatures of the gas in heater and cooler, from the walls and what goes through the films [K]."""
    gas, T = GASES[cycle.gas], np.array([found.T_h, found.T_k])
    heater, _, cooler = ducts = _ducts(cycle, losses, T)
    flows = _flows(cycle, found.turn, ducts, found.omega)
    share, lost = found.omega / (2 * math.pi), found.heat_losses["regenerator"]
    hot = found.turn.sums["Q_h"] * share + lost
    cold = -found.turn.sums["Q_k"] * share + lost
    drops = [
        heat / (_film(gas, duct, flow, found.turn) * duct.A_w)
        for heat, duct, flow in ((hot, heater, flows[0]), (cold, cooler, flows[2]))
    ]
    return np.array([cycle.T_e - drops[0], cycle.T_c + drops[1]])


def _film(gas: WorkingGas, duct: _Duct, flow: np.ndarray, turn: StirlingTurn) -> float:
    k = duct_law.viscosity(gas.mu_0, 273.0, gas.sutherland, duct.T) * gas.cp / gas.Pr
    return _mean(turn, duct_law.tube_nusselt(_reynolds(gas, duct, flow), gas.Pr)) * k / duct.d


def _hot_end(cycle: StirlingCylinders, losses: StirlingLosses, turn: StirlingTurn, T: np.ndarray) -> dict[str, float]:
    gas, dT = GASES[cycle.gas], cycle.T_e - cycle.T_c
    k = duct_law.viscosity(gas.mu_0, 273.0, gas.sutherland, (T[0] + T[1]) / 2) * gas.cp / gas.Pr
    stroke = float(np.ptp(turn.V_e)) / piston_area(cycle.bore)
    shuttle = loss.shuttle_loss(stroke, losses.shuttle_gap, losses.shuttle_length, cycle.bore, k, dT)
    return {"conduction": losses.conductance * dT, "shuttle": shuttle}


def _seal_reynolds(cycle: StirlingCylinders, losses: StirlingLosses, turn: StirlingTurn) -> float:
    gas = GASES[cycle.gas]
    mu = duct_law.viscosity(gas.mu_0, 273.0, gas.sutherland, cycle.T_c)
    push = math.sqrt(_mean(turn, (turn.p - cycle.p_back) ** 2))
    return loss.seal_reynolds(push, losses.seal_gap, losses.seal_length, cycle.mean_pressure / (gas.R * cycle.T_c), mu)


def _piston(cycle: StirlingCylinders, losses: StirlingLosses, turn: StirlingTurn, omega: float) -> dict[str, float]:
    gas, bore = GASES[cycle.gas], cycle.piston_bore or cycle.bore
    mu = duct_law.viscosity(gas.mu_0, 273.0, gas.sutherland, cycle.T_c)
    push = _mean(turn, (turn.p - cycle.p_back) ** 2)
    swept, volume = float(np.ptp(turn.V_e + turn.V_c)), losses.buffer_volume
    wall = 2 * piston_area(bore) + 4 * volume / bore
    spring = loss.gas_spring_loss(
        omega, gas.gamma, cycle.T_c, cycle.p_back, mu * gas.cp / gas.Pr, swept / volume, wall
    )  # fmt: skip
    return {
        "leakage": loss.leakage_loss(push, losses.seal_gap, losses.seal_length, bore, mu),
        "gas_spring": spring,
    }

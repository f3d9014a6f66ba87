r"""Stirling cycle of the second order: the adiabatic turn, at the gas temperatures that the films leave, minus losses.

.. math:: T_h = T_{wall,h} - \frac{\dot Q_h + \dot Q_{loss}}{\bar h_h A_h}, \qquad
          T_k = T_{wall,k} + \frac{-\dot Q_k + \dot Q_{loss}}{\bar h_k A_k}

Films and friction follow the flow of each instant, laminar or turbulent over the whole turn. The mean pressure is
that of the compression space; the expansion space works at what the pressure drops leave, which takes the integral of
the drop over V_e from the work. Work is lost besides past both seals and in heat that comes too late in the two spaces
and behind the piston; heat is lost through and along the regenerator, along the walls, and in the gap around the hot
dome, by the shuttle, by pumping and by the enthalpy of what moves in it. What gas carries goes through both films.
Masses and temperatures of the turn itself are those of one pressure.

Sources: I. Urieli, D. M. Berchowitz, Stirling Cycle Engine Analysis (1984), chapters 5 to 7; each loss has its own.
Valid: pressure drops small against the pressure. docs/engine.md compares two measured points of the GPU-3 engine; no
number is fitted. No scatter of such models was found in the literature as a number: J. M. Strauss, R. T. Dobson, J.
Energy South. Afr. 21 (2010), find the trends of this engine followed and some figures far off; R. C. Tew, NASA (1986),
that a model calibrated on one type of engine does not foretell another.
"""

import math
from collections.abc import Callable

import numpy as np

from mechsym.cycle.chamber import piston_area
from mechsym.cycle.kinds import stirling_films as film
from mechsym.cycle.kinds import stirling_losses as loss
from mechsym.cycle.kinds.stirling_spaces import GASES, StirlingCylinders, WorkingGas, five_spaces
from mechsym.cycle.kinds.stirling_turn import StirlingTurn, solver
from mechsym.errors import BadInput
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Scalar

_ROUNDS, _SETTLED, _DAMPED = 80, 1e-9, 0.6


@record
class StirlingLosses:
    """Section `[stirling]`: exchangers, gaps, seals and buffer of a Stirling engine."""

    heater_diameter: float = quantity("m", above=0, about="inner diameter of the heater's tubes")
    heater_length: float = quantity("m", above=0, about="length of the heater's tubes")
    heater_heated: float = quantity("-", default=1.0, above=0, high=1, about="share of the length that is heated")
    heater_turn: float = quantity("rad", default=0.0, low=0, high=math.pi, about="by which a heater tube is bent")
    heater_turn_radius: float = quantity("-", default=5.0, low=1, about="radius of that bend by the tube's diameter")
    heater_resistance: float = quantity("K/W", default=0.0, low=0, about="from T_e to the inside of the heater's walls")
    hot_duct_area: float | None = quantity(
        "m^2", default=None, above=0, about="ducts between heater and expansion space; none where left out"
    )
    cooler_diameter: float = quantity("m", above=0, about="inner diameter of the cooler's tubes")
    cooler_length: float = quantity("m", above=0, about="length of the cooler's tubes")
    cooler_cooled: float = quantity("-", default=1.0, above=0, high=1, about="share of the length that is cooled")
    cooler_resistance: float = quantity("K/W", default=0.0, low=0, about="from the inside of the cooler's walls to T_c")
    cold_duct_area: float | None = quantity(
        "m^2", default=None, above=0, about="ducts between cooler and compression space; none where left out"
    )
    wire: float = quantity("m", above=0, about="wire of the regenerator's screens")
    wire_conductivity: float = quantity(
        "W/(m*K)", default=0.0, low=0, about="conductivity of that wire; 0 where `conductance` counts the screens"
    )
    porosity: float = quantity("-", above=0.3, below=1, about="share of gas in the regenerator's volume")
    regenerator_length: float = quantity("m", above=0, about="length of the regenerator")
    conductance: float = quantity("W/K", low=0, about="walls between the hot and the cold end: sum of k A/L")
    shuttle_gap: float = quantity("m", above=0, about="radial gap around the hot piston's dome")
    shuttle_length: float = quantity("m", above=0, about="length of the hot piston's dome")
    displacer_gap: float = quantity("m", default=0.0, low=0, about="radial gap of the seal between the two spaces")
    displacer_length: float = quantity("m", default=0.01, above=0, about="length of the seal between the two spaces")
    seal_gap: float = quantity("m", low=0, about="radial gap of the piston's seal")
    seal_length: float = quantity("m", above=0, about="length of the piston's seal")
    buffer_volume: float = quantity("m^3", above=0, about="mean volume behind the piston")
    mechanical_efficiency: float = quantity("-", default=1.0, above=0, high=1, about="brake by indicated power")


@record
class SecondOrder:
    """A Stirling engine at one speed, with what it loses."""

    turn: StirlingTurn
    omega: float  #: shaft speed [rad/s]
    #: temperatures of the gas in heater and cooler [K]
    T_h: float
    T_k: float
    effectiveness: float  #: share of its heat that the regenerator gives back [-]
    #: mean Reynolds number of the regenerator's screens, and of the seal's gap [-]
    screen_reynolds: float
    seal_reynolds: float
    work_losses: dict[str, float]  #: powers lost, by name [W]
    heat_losses: dict[str, float]  #: heats lost from the hot to the cold side, by name [W]
    power: float  #: brake power [W]
    heat_in: float  #: heat from the hot side, losses included [W]

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
    heads: float  #: Velocity heads lost at its ends and in bends [-]

    @property
    def area(self) -> float:
        return self.V / self.length


def second_order(
    cycle: StirlingCylinders, losses: StirlingLosses, volumes: Callable[[Scalar], tuple[Scalar, Scalar]], omega: float
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
    turn = film.bend_heads(losses.heater_turn, losses.heater_turn_radius)
    return (
        _Duct(V=hot, d=heater, length=losses.heater_length, A_w=4 * hot / heater * losses.heater_heated, T=T[0],
              heads=_heads(hot / losses.heater_length, losses.hot_duct_area) + turn),
        _Duct(V=matrix, d=pore, length=losses.regenerator_length, A_w=4 * matrix / pore, T=mean,
              heads=film.end_heads(losses.porosity)),
        _Duct(V=cold, d=cooler, length=losses.cooler_length, A_w=4 * cold / cooler * losses.cooler_cooled, T=T[1],
              heads=_heads(cold / losses.cooler_length, losses.cold_duct_area)),
    )  # fmt: skip


def _heads(area: float, duct: float | None) -> float:
    """Of the speed in tubes of so much area: their sharp ends, and those of the ducts that lead to them."""
    ends = film.end_heads(0.0)
    return ends if duct is None else ends * (1 + (area / duct) ** 2)


def _flows(cycle: StirlingCylinders, turn: StirlingTurn, ducts: tuple[_Duct, ...], omega: float) -> list[np.ndarray]:
    """Mass flow in the middle of each exchanger, towards the hot end [kg/s]."""
    R = GASES[cycle.gas].R
    stored = [turn.dp_dphi * duct.V / (R * duct.T) for duct in ducts]
    hot, cold = turn.flow_e + stored[0] / 2, -turn.flow_c - stored[2] / 2
    return [hot * omega, (hot + stored[0] / 2 + cold - stored[2] / 2) / 2 * omega, cold * omega]


def _conductivity(gas: WorkingGas, T: float) -> float:
    return film.viscosity(gas.mu_0, 273.0, gas.sutherland, T) * gas.cp / gas.Pr


def _reynolds(gas: WorkingGas, duct: _Duct, flow: np.ndarray) -> np.ndarray:
    mu = film.viscosity(gas.mu_0, 273.0, gas.sutherland, duct.T)
    return np.maximum(np.abs(flow) * duct.d / (duct.area * mu), 1e-3)


def _valensi(gas: WorkingGas, duct: _Duct, p: float, omega: float) -> float:
    mu = film.viscosity(gas.mu_0, 273.0, gas.sutherland, duct.T)
    return film.valensi(omega, duct.d, p / (gas.R * duct.T), mu)


def _mean(turn: StirlingTurn, values: np.ndarray) -> float:
    return float(np.trapezoid(values, turn.phi) / (2 * math.pi))


def _pressure_drop(
    cycle: StirlingCylinders, duct: _Duct, flow: np.ndarray, turn: StirlingTurn, f: np.ndarray
) -> np.ndarray:
    """By how much the pressure falls towards the hot end [Pa]."""
    rho = turn.p / (GASES[cycle.gas].R * duct.T)
    return (f * duct.length / duct.d + duct.heads) * flow * np.abs(flow) / (2 * rho * duct.area**2)


def _at(
    cycle: StirlingCylinders, losses: StirlingLosses, turn: StirlingTurn, omega: float, T: np.ndarray
) -> SecondOrder:
    gas, ducts = GASES[cycle.gas], _ducts(cycle, losses, T)
    flows = _flows(cycle, turn, ducts, omega)
    per_second = omega / (2 * math.pi)
    reynolds = [_reynolds(gas, duct, flow) for duct, flow in zip(ducts, flows, strict=True)]
    frictions = [film.tube_friction(Re, _valensi(gas, duct, cycle.mean_pressure, omega))
                 for Re, duct in zip(reynolds, ducts, strict=True)]  # fmt: skip
    frictions[1] = film.screen_friction(reynolds[1])
    drops = np.array(
        [_pressure_drop(cycle, duct, flow, turn, f) for duct, flow, f in zip(ducts, flows, frictions, strict=True)]
    )
    screens = _mean(turn, reynolds[1])
    nusselt = float(film.screen_nusselt(screens, gas.Pr, losses.porosity))
    effectiveness = film.regenerator_effectiveness(nusselt / (screens * gas.Pr) * ducts[1].A_w / (2 * ducts[1].area))
    heat = {
        "regenerator": (1 - effectiveness) * float(np.ptp(turn.stored)) * per_second,
        "matrix": _along(gas, losses, ducts[1], screens, T[0] - T[1]),
        **_gap(cycle, losses, turn, omega, T),
        "conduction": losses.conductance * (cycle.T_e - cycle.T_c),
    }
    # the mean pressure is that of the compression space, so the expansion space works at what the drops leave
    work = (
        {
            f"flow_{name}": float(np.trapezoid(drop, turn.V_e)) * per_second
            for name, drop in zip(("heater", "regenerator", "cooler"), drops, strict=True)
        }
        | _walls(cycle, losses, turn, omega)
        | _piston(cycle, losses, turn)
    )
    work["leakage_displacer"], heat["leakage_displacer"] = _past_displacer(cycle, losses, turn, drops.sum(axis=0), T)
    left = turn.work * per_second - sum(work.values())
    power = left * losses.mechanical_efficiency
    work["mechanical"] = left - power
    return SecondOrder(
        turn=turn, omega=omega, T_h=float(T[0]), T_k=float(T[1]), effectiveness=effectiveness, work_losses=work,
        heat_losses=heat, power=power, heat_in=turn.heat_in * per_second + sum(heat.values()), screen_reynolds=screens,
        seal_reynolds=_seal_reynolds(cycle, losses, turn),
    )  # fmt: skip


def _wall_side(cycle: StirlingCylinders, losses: StirlingLosses, found: SecondOrder) -> np.ndarray:
    """Temperatures of the gas in heater and cooler, from the walls and what goes through the films [K]."""
    T = np.array([found.T_h, found.T_k])
    heater, _, cooler = ducts = _ducts(cycle, losses, T)
    flows = _flows(cycle, found.turn, ducts, found.omega)
    share = found.omega / (2 * math.pi)
    by_gas = sum(found.heat_losses[name] for name in ("regenerator", "matrix", "pumping", "gap", "leakage_displacer"))
    hot = found.turn.sums["Q_h"] * share + by_gas
    cold = -found.turn.sums["Q_k"] * share + by_gas
    drops = [
        heat * (1 / (_film(cycle, duct, flow, found) * duct.A_w) + beyond)
        for heat, duct, flow, beyond in (
            (hot, heater, flows[0], losses.heater_resistance),
            (cold, cooler, flows[2], losses.cooler_resistance),
        )
    ]
    return np.array([cycle.T_e - drops[0], cycle.T_c + drops[1]])


def _film(cycle: StirlingCylinders, duct: _Duct, flow: np.ndarray, found: SecondOrder) -> float:
    gas = GASES[cycle.gas]
    Va = _valensi(gas, duct, cycle.mean_pressure, found.omega)
    nusselt = film.tube_nusselt(_reynolds(gas, duct, flow), gas.Pr, Va)
    return _mean(found.turn, nusselt) * _conductivity(gas, duct.T) / duct.d


def _along(gas: WorkingGas, losses: StirlingLosses, matrix: _Duct, Re: float, dT: float) -> float:
    """Heat along the matrix: by eddies of the gas, and by the wire where it is told [W]."""
    k, length = _conductivity(gas, matrix.T), matrix.length
    mixed = film.along_matrix(k * float(film.screen_mixing(Re, gas.Pr, losses.porosity)), matrix.area, length, dT)
    if not losses.wire_conductivity:
        return mixed
    still = film.screen_conductivity(k, losses.wire_conductivity, losses.porosity)
    return mixed + film.along_matrix(still, matrix.area / losses.porosity, length, dT)


def _gap(
    cycle: StirlingCylinders, losses: StirlingLosses, turn: StirlingTurn, omega: float, T: np.ndarray
) -> dict[str, float]:
    """Heats in the gap around the hot piston's dome [W]."""
    gas, gap, length, bore = GASES[cycle.gas], losses.shuttle_gap, losses.shuttle_length, cycle.bore
    k, per_second = _conductivity(gas, (T[0] + T[1]) / 2), omega / (2 * math.pi)
    stroke, swing = float(np.ptp(turn.V_e)) / piston_area(bore), float(np.ptp(turn.p))
    work = turn.sums["W_e"] * per_second / piston_area(bore)
    return {
        "shuttle": loss.shuttle_loss(stroke, gap, length, bore, k, cycle.T_e - cycle.T_c),
        "gap": loss.gap_enthalpy_loss(work, gap, bore, gas.gamma, T[0], T[1]),
        "pumping": loss.pumping_loss(swing, per_second, gap, length, bore, k, gas.gamma, T[0], T[1]),
    }


def _past_displacer(
    cycle: StirlingCylinders, losses: StirlingLosses, turn: StirlingTurn, drop: np.ndarray, T: np.ndarray
) -> tuple[float, float]:
    """Work and heat that leak from one space to the other [W]."""
    gas, mean = GASES[cycle.gas], (T[0] + T[1]) / 2
    mu, rho = film.viscosity(gas.mu_0, 273.0, gas.sutherland, mean), cycle.mean_pressure / (gas.R * mean)
    seal = losses.displacer_gap, losses.displacer_length, cycle.bore
    flow = loss.seal_flow(_mean(turn, np.abs(drop)), *seal, rho, mu)
    return loss.leakage_loss(_mean(turn, drop**2), *seal, mu), loss.bypass_loss(flow, gas.cp, T[0] - T[1])


def _seal_reynolds(cycle: StirlingCylinders, losses: StirlingLosses, turn: StirlingTurn) -> float:
    gas = GASES[cycle.gas]
    mu = film.viscosity(gas.mu_0, 273.0, gas.sutherland, cycle.T_c)
    push = math.sqrt(_mean(turn, (turn.p - cycle.p_back) ** 2))
    return loss.seal_reynolds(push, losses.seal_gap, losses.seal_length, cycle.mean_pressure / (gas.R * cycle.T_c), mu)


def _walls(cycle: StirlingCylinders, losses: StirlingLosses, turn: StirlingTurn, omega: float) -> dict[str, float]:
    """Power lost in heat that comes too late, in the two working spaces and behind the piston [W]."""
    gas, swing = GASES[cycle.gas], float(np.ptp(turn.p)) / 2
    pumped, volume = float(np.ptp(turn.V_e + turn.V_c)), losses.buffer_volume
    spaces = {
        "hysteresis_hot": (_mean(turn, turn.V_e), cycle.bore, _mean(turn, turn.T_e), cycle.mean_pressure, swing),
        "hysteresis_cold": (_mean(turn, turn.V_c), cycle.bore, _mean(turn, turn.T_c), cycle.mean_pressure, swing),
        "gas_spring": (volume, cycle.piston_bore or cycle.bore, cycle.T_c, cycle.p_back,
                       gas.gamma * cycle.p_back * pumped / (2 * volume)),
    }  # fmt: skip
    return {
        name: loss.hysteresis_loss(
            omega, p, amplitude, V, 2 * piston_area(bore) + 4 * V / bore, gas.gamma,
            _conductivity(gas, T) * gas.R * T / (p * gas.cp),
        )
        for name, (V, bore, T, p, amplitude) in spaces.items()
    }  # fmt: skip


def _piston(cycle: StirlingCylinders, losses: StirlingLosses, turn: StirlingTurn) -> dict[str, float]:
    gas, bore = GASES[cycle.gas], cycle.piston_bore or cycle.bore
    mu = film.viscosity(gas.mu_0, 273.0, gas.sutherland, cycle.T_c)
    push = _mean(turn, (turn.p - cycle.p_back) ** 2)
    return {"leakage": loss.leakage_loss(push, losses.seal_gap, losses.seal_length, bore, mu)}

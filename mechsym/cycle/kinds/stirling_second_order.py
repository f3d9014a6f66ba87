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

import numpy as np

from mechsym.cycle.chamber import piston_area
from mechsym.cycle.kinds import stirling_films as film
from mechsym.cycle.kinds import stirling_losses as loss
from mechsym.cycle.kinds.stirling_spaces import GASES, StirlingCylinders, Volumes, five_spaces
from mechsym.cycle.kinds.stirling_turn import StirlingTurn, solver
from mechsym.errors import BadInput
from mechsym.quantities import quantity, record

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


def second_order(cycle: StirlingCylinders, losses: StirlingLosses, volumes: Volumes, omega: float) -> SecondOrder:
    """The engine at a shaft speed [rad/s]; volumes of the angle as `stirling_spaces.swept` gives them."""
    for side, name, duct in (("hot", "T_e", "heater"), ("cold", "T_c", "cooler")):
        volume, share = getattr(cycle, f"dead_{side}"), getattr(cycle, f"clearance_share_{side}")
        if not volume * (1 - share) > 0:
            raise BadInput(
                f"dead_{side} = {volume:g} m^3 with clearance_share_{side} = {share:g} leaves the {duct} no volume, "
                f"and no heat passes at {name}; the second order needs dead_{side} above 0 and a share below 1"
            )
    temperatures = np.array([cycle.T_e, cycle.T_c])
    solve = solver(lambda z: five_spaces(cycle, volumes, z[0], z[1]), temperatures)
    for _ in range(_ROUNDS):
        tried = _Tried(cycle, losses, solve(temperatures), omega, temperatures)
        order = tried.with_losses()
        change = tried.wall_side(order) - temperatures
        if float(np.abs(change).max()) < _SETTLED * cycle.T_e:
            return order
        temperatures = temperatures + _DAMPED * change
        if temperatures[0] < 1.02 * temperatures[1]:
            raise BadInput(
                f"the films leave no difference of temperature at {omega:.4g} rad/s: gas {temperatures[0]:.0f} K hot, "
                f"{temperatures[1]:.0f} K cold; take more or finer tubes in [stirling], or a lower speed"
            )
    raise BadInput(
        f"gas temperatures do not settle at {omega:.4g} rad/s: they still move by {np.abs(change).max():.2g} K"
    )


class _Tried:
    """A turn at temperatures of the gas in heater and cooler that are tried: flows through its ducts, what is lost."""

    def __init__(
        self, cycle: StirlingCylinders, losses: StirlingLosses, turn: StirlingTurn, omega: float, T: np.ndarray
    ) -> None:
        self.cycle, self.losses, self.turn, self.omega, self.T = cycle, losses, turn, omega, T
        self.gas, self.per_second = GASES[cycle.gas], omega / (2 * math.pi)
        hot = cycle.dead_hot * (1 - cycle.clearance_share_hot)
        cold = cycle.dead_cold * (1 - cycle.clearance_share_cold)
        pore = losses.wire * losses.porosity / (1 - losses.porosity)
        mean = (T[0] - T[1]) / math.log(T[0] / T[1])
        heater, cooler, matrix = losses.heater_diameter, losses.cooler_diameter, cycle.dead_regenerator
        turn_heads = film.bend_heads(losses.heater_turn, losses.heater_turn_radius)
        self.ducts = (
            _Duct(V=hot, d=heater, length=losses.heater_length, A_w=4 * hot / heater * losses.heater_heated, T=T[0],
                  heads=_heads(hot / losses.heater_length, losses.hot_duct_area) + turn_heads),
            _Duct(V=matrix, d=pore, length=losses.regenerator_length, A_w=4 * matrix / pore, T=mean,
                  heads=film.end_heads(losses.porosity)),
            _Duct(V=cold, d=cooler, length=losses.cooler_length, A_w=4 * cold / cooler * losses.cooler_cooled, T=T[1],
                  heads=_heads(cold / losses.cooler_length, losses.cold_duct_area)),
        )  # fmt: skip
        # mass flow in the middle of each exchanger, towards the hot end [kg/s]
        stored = [turn.dp_dphi * duct.V / (self.gas.R * duct.T) for duct in self.ducts]
        first, last = turn.flow_e + stored[0] / 2, -turn.flow_c - stored[2] / 2
        self.flows = [first * omega, (first + stored[0] / 2 + last - stored[2] / 2) / 2 * omega, last * omega]
        self.reynolds = [
            np.maximum(np.abs(flow) * duct.d / (duct.area * self.viscosity(duct.T)), 1e-3)
            for duct, flow in zip(self.ducts, self.flows, strict=True)
        ]

    def viscosity(self, T: float) -> float:
        return film.viscosity(self.gas.mu_0, 273.0, self.gas.sutherland, T)

    def conductivity(self, T: float) -> float:
        return self.viscosity(T) * self.gas.cp / self.gas.Pr

    def valensi(self, duct: _Duct) -> float:
        return film.valensi(
            self.omega, duct.d, self.cycle.mean_pressure / (self.gas.R * duct.T), self.viscosity(duct.T)
        )

    def mean(self, values: np.ndarray) -> float:
        return float(np.trapezoid(values, self.turn.phi) / (2 * math.pi))

    def with_losses(self) -> SecondOrder:
        cycle, losses, turn, T, ducts = self.cycle, self.losses, self.turn, self.T, self.ducts
        frictions = [film.tube_friction(Re, self.valensi(duct)) for Re, duct in zip(self.reynolds, ducts, strict=True)]
        frictions[1] = film.screen_friction(self.reynolds[1])
        # by how much the pressure falls towards the hot end [Pa]
        drops = np.array([
            (f * duct.length / duct.d + duct.heads) * flow * np.abs(flow)
            / (2 * (turn.p / (self.gas.R * duct.T)) * duct.area**2)
            for duct, flow, f in zip(ducts, self.flows, frictions, strict=True)
        ])  # fmt: skip
        screens = self.mean(self.reynolds[1])
        nusselt = float(film.screen_nusselt(screens, self.gas.Pr, losses.porosity))
        units = nusselt / (screens * self.gas.Pr) * ducts[1].A_w / (2 * ducts[1].area)
        effectiveness = film.regenerator_effectiveness(units)
        heat = {
            "regenerator": (1 - effectiveness) * float(np.ptp(turn.stored)) * self.per_second,
            "matrix": self._along(screens),
            **self._gap(),
            "conduction": losses.conductance * (cycle.T_e - cycle.T_c),
        }
        # the mean pressure is that of the compression space, so the expansion space works at what the drops leave
        work = {
            f"flow_{name}": float(np.trapezoid(drop, turn.V_e)) * self.per_second
            for name, drop in zip(("heater", "regenerator", "cooler"), drops, strict=True)
        } | self._walls()
        push, seal = self.mean((turn.p - cycle.p_back) ** 2), (losses.seal_gap, losses.seal_length)
        mu, rho = self.viscosity(cycle.T_c), cycle.mean_pressure / (self.gas.R * cycle.T_c)
        work["leakage"] = loss.leakage_loss(push, *seal, cycle.piston_bore or cycle.bore, mu)
        work["leakage_displacer"], heat["leakage_displacer"] = self._past_displacer(drops.sum(axis=0))
        left = turn.work * self.per_second - sum(work.values())
        power = left * losses.mechanical_efficiency
        work["mechanical"] = left - power
        return SecondOrder(
            turn=turn, omega=self.omega, T_h=float(T[0]), T_k=float(T[1]), effectiveness=effectiveness,
            work_losses=work, heat_losses=heat, power=power, screen_reynolds=screens,
            heat_in=turn.heat_in * self.per_second + sum(heat.values()),
            seal_reynolds=loss.seal_reynolds(math.sqrt(push), *seal, rho, mu),
        )  # fmt: skip

    def wall_side(self, order: SecondOrder) -> np.ndarray:
        """Temperatures of the gas in heater and cooler, from the walls and what goes through the films [K]."""
        names = ("regenerator", "matrix", "pumping", "gap", "leakage_displacer")
        by_gas = sum(order.heat_losses[name] for name in names)
        drops = []
        for place, heat, beyond in (
            (0, self.turn.sums["Q_h"], self.losses.heater_resistance),
            (2, -self.turn.sums["Q_k"], self.losses.cooler_resistance),
        ):
            duct = self.ducts[place]
            nusselt = film.tube_nusselt(self.reynolds[place], self.gas.Pr, self.valensi(duct))
            conductance = self.mean(nusselt) * self.conductivity(duct.T) / duct.d * duct.A_w
            drops.append((heat * self.per_second + by_gas) * (1 / conductance + beyond))
        return np.array([self.cycle.T_e - drops[0], self.cycle.T_c + drops[1]])

    def _along(self, Re: float) -> float:
        """Heat along the matrix: by eddies of the gas, and by the wire where it is told [W]."""
        matrix, losses, dT = self.ducts[1], self.losses, self.T[0] - self.T[1]
        k, length = self.conductivity(matrix.T), matrix.length
        eddies = k * float(film.screen_mixing(Re, self.gas.Pr, losses.porosity))
        mixed = film.along_matrix(eddies, matrix.area, length, dT)
        if not losses.wire_conductivity:
            return mixed
        still = film.screen_conductivity(k, losses.wire_conductivity, losses.porosity)
        return mixed + film.along_matrix(still, matrix.area / losses.porosity, length, dT)

    def _gap(self) -> dict[str, float]:
        """Heats in the gap around the hot piston's dome [W]."""
        cycle, turn, (hot, cold), gamma = self.cycle, self.turn, self.T, self.gas.gamma
        gap, length, bore = self.losses.shuttle_gap, self.losses.shuttle_length, cycle.bore
        k = self.conductivity((hot + cold) / 2)
        stroke, swing = float(np.ptp(turn.V_e)) / piston_area(bore), float(np.ptp(turn.p))
        work = turn.sums["W_e"] * self.per_second / piston_area(bore)
        return {
            "shuttle": loss.shuttle_loss(stroke, gap, length, bore, k, cycle.T_e - cycle.T_c),
            "gap": loss.gap_enthalpy_loss(work, gap, bore, gamma, hot, cold),
            "pumping": loss.pumping_loss(swing, self.per_second, gap, length, bore, k, gamma, hot, cold),
        }

    def _past_displacer(self, drop: np.ndarray) -> tuple[float, float]:
        """Work and heat that leak from one space to the other [W]."""
        mean = (self.T[0] + self.T[1]) / 2
        mu, rho = self.viscosity(mean), self.cycle.mean_pressure / (self.gas.R * mean)
        seal = self.losses.displacer_gap, self.losses.displacer_length, self.cycle.bore
        flow = loss.seal_flow(self.mean(np.abs(drop)), *seal, rho, mu)
        heat = loss.bypass_loss(flow, self.gas.cp, self.T[0] - self.T[1])
        return loss.leakage_loss(self.mean(drop**2), *seal, mu), heat

    def _walls(self) -> dict[str, float]:
        """Power lost in heat that comes too late, in the two working spaces and behind the piston [W]."""
        cycle, turn, gas, swing = self.cycle, self.turn, self.gas, float(np.ptp(self.turn.p)) / 2
        pumped, volume = float(np.ptp(turn.V_e + turn.V_c)), self.losses.buffer_volume
        spaces = {
            "hysteresis_hot": (self.mean(turn.V_e), cycle.bore, self.mean(turn.T_e), cycle.mean_pressure, swing),
            "hysteresis_cold": (self.mean(turn.V_c), cycle.bore, self.mean(turn.T_c), cycle.mean_pressure, swing),
            "gas_spring": (volume, cycle.piston_bore or cycle.bore, cycle.T_c, cycle.p_back,
                           gas.gamma * cycle.p_back * pumped / (2 * volume)),
        }  # fmt: skip
        return {
            name: loss.hysteresis_loss(
                self.omega, p, amplitude, V, 2 * piston_area(bore) + 4 * V / bore, gas.gamma,
                self.conductivity(T) * gas.R * T / (p * gas.cp),
            )
            for name, (V, bore, T, p, amplitude) in spaces.items()
        }  # fmt: skip


def _heads(area: float, duct: float | None) -> float:
    """Of the speed in tubes of so much area: their sharp ends, and those of the ducts that lead to them."""
    ends = film.end_heads(0.0)
    return ends if duct is None else ends * (1 + (area / duct) ** 2)

r"""The two-stroke compression-ignition cycle integrated: one zone, first law, heat to the walls, NASA properties.

    EVC..EVO  integrated (`closed`): compression, injected fuel that burns by a double Wiebe function, expansion
    EVO..SPO  a straight line in phi down to p_evc
    SPO..EVC  p = p_evc

Beside the algebraic cycle of `two_stroke` it needs no exponents and no reference temperature; what it needs instead is
a law for the heat that goes into the walls, `[heat_transfer]` as for every other engine. The fuel is found for the
wanted mean indicated pressure. The Wiebe function stops at its nominal end; what it leaves unburnt there (1 to 3 % for
the sets of Shen et al.) stays unburnt.
"""

import math
from collections.abc import Callable, Mapping
from functools import partial

import numpy as np

from mechsym.cycle.chamber import Chamber, volume
from mechsym.cycle.closed.equations import Closed
from mechsym.cycle.closed.run import ClosedRun, run
from mechsym.cycle.heat import T_REFERENCE, ConstantGamma, Law, NasaMixture, Woschni, properties
from mechsym.cycle.kinds.two_stroke import blown_down, burnt_angles, scavenging_pressure
from mechsym.cycle.pressure import ATMOSPHERE, Pressure, mean_indicated_pressure, peak, periodic, wrapped
from mechsym.cycle.source import CylinderGas
from mechsym.errors import BadInput
from mechsym.periodic.pieces import PPoly
from mechsym.periodic.roots import root
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.units import Pure, Scalar

_TURN = 2 * math.pi
_STOICHIOMETRIC = 14.6  # air over fuel, marine fuel oil
_ASSUMED = Woschni(wall_temperature=550.0)  # of a case without [heat_transfer]


@record
class TwoStrokeZone:
    """Inputs: `[cycle]` with `kind = "two-stroke-zone"`."""

    bore: float = quantity("m", above=0, about="diameter of the piston")
    compression_ratio: float = quantity("-", above=1, high=60, about="geometric compression ratio")
    mean_indicated_pressure: float = quantity("Pa", above=0, about="wanted mean indicated pressure")
    p_s: float = quantity("Pa", above=0.5e5, below=20e5, about="absolute scavenge pressure")
    T_evc: float = quantity("K", above=200, below=800, about="temperature when the exhaust closes")
    #: Exhaust closes (negative), combustion starts, exhaust opens, scavenge ports open; from TDC [rad]
    evc: float = quantity("rad", above=-math.pi, below=0, about="exhaust closes")
    soc: float = quantity("rad", default=0.0, above=-math.pi / 3, below=math.pi / 3, about="combustion starts")
    duration: float = quantity("rad", above=0, below=math.pi, about="duration of combustion")
    evo: float = quantity("rad", above=0, below=math.pi, about="exhaust opens")
    spo: float = quantity("rad", above=0, below=math.pi, about="scavenge ports open")
    a_p: float = quantity("-", above=0, about="Wiebe completeness of the share 1 - b")
    m_p: float = quantity("-", low=0, about="Wiebe form of the share 1 - b")
    a_d: float = quantity("-", above=0, about="Wiebe completeness of the share b")
    m_d: float = quantity("-", low=0, about="Wiebe form of the share b")
    b: float = quantity("-", low=0, high=1, about="share of the second Wiebe function")
    lhv: float = quantity("J/kg", default=42.7e6, above=0, about="lower heating value of the fuel")
    speed: float | None = quantity("rad/s", default=None, above=0, about="of older files", moved="operation.speed")
    #: `nasa` (temperature dependent) or `constant_gamma` (1.35)
    properties: str = choice("nasa", "constant_gamma", default="nasa", about="gas properties")
    p_back: float = quantity("Pa", default=ATMOSPHERE, low=0, about="absolute pressure under the piston")

    def __post_init__(self) -> None:
        order = (self.evc, self.soc, self.soc + self.duration, self.evo, self.spo)
        if not all(a < b for a, b in zip(order, order[1:], strict=False)):
            raise BadInput(
                "the order must be evc < soc < soc + duration < evo < spo; got "
                + ", ".join(f"{math.degrees(a):g}" for a in order)
                + " deg"
            )


@record
class Zone:
    """The integrated cycle with the fuel that gives the wanted mean pressure."""

    result: ClosedRun
    fuel: float  #: Fuel of a cycle [kg]
    absolute: Callable[[Scalar], Scalar]  #: Crank angle [rad] to absolute pressure over the whole turn [Pa]
    kinks: tuple[float, ...]  #: Where it is not smooth, in [0, 2 pi) [rad]
    mean_indicated: float  #: Mean indicated pressure [Pa]
    cylinder: Chamber
    walls: Law | None  #: Heat to the walls; None where it is assumed


def two_stroke_zone(cycle: TwoStrokeZone, cylinder: Chamber, omega: float, walls: Law | None = None) -> Zone:
    """Integrate the cycle at a speed [rad/s] and find its fuel; without a law of heat to the walls one is assumed."""
    if not omega > 0:
        raise BadInput(f"a cycle of kind two-stroke-zone loses heat to its walls: speed = {omega:g} rad/s must be > 0")
    events = (cycle.evc, cycle.soc, cycle.soc + cycle.duration, cycle.evo, cycle.spo)
    kinks = tuple(sorted(float(wrapped(a, _TURN)) for a in events))
    build = partial(closed_period, cycle, cylinder, walls or _ASSUMED)

    def made(fuel: float) -> Zone:
        result = run(build, {"omega": omega, "fuel": fuel})
        absolute = _absolute(cycle, result)
        mean = mean_indicated_pressure(absolute, _TURN, kinks, cylinder)
        return Zone(
            result=result, fuel=fuel, absolute=absolute, kinks=kinks, mean_indicated=mean, cylinder=cylinder,
            walls=walls,
        )  # fmt: skip

    air = float(build({"omega": omega, "fuel": 0.0}).mass)
    return made(_fuel(cycle, air, lambda fuel: made(fuel).mean_indicated))


class ZoneGas(CylinderGas):
    """Gas of the integrated cycle, with the heat that goes into the walls at its speed."""

    def pressure(self, room: Chamber, omega: float) -> tuple[Pressure, dict[str, float]]:
        """Pressure at a speed [rad/s], with the fuel for the wanted mean pressure, and the figures of that fuel."""
        zone = two_stroke_zone(self.cycle, room, omega, self.parts.section("heat_transfer"))
        parts = shares(self.cycle, zone)
        fuel = {
            "sfc_g_kwh": 3.6e9 / (parts["work"] * self.cycle.lhv), "efficiency": parts["work"],
            "energy_residual": float(zone.result.residual[0]), **burnt_angles(self.cycle, 1.0),
        }  # fmt: skip
        return _pressure(self.cycle, zone), fuel | parts


def as_diagram(cycle: TwoStrokeZone) -> dict[str, str | float]:
    """What the cycle knows of an engine whose measured diagram takes its place: fields of `Diagram`."""
    return {"working_cycle": "two-stroke", "p_back": cycle.p_back}


def _pressure(cycle: TwoStrokeZone, zone: Zone) -> Pressure:
    p_max, phi_p_max = peak(zone.absolute, _TURN, zone.kinks)
    parts, result = shares(cycle, zone), zone.result
    excess = result.scalars["mass"][0] / zone.fuel / _STOICHIOMETRIC
    facts = (
        f"fuel {zone.fuel * 1e3:.4g} g a cycle, excess air {excess:.2f}, indicated efficiency {parts['work']:.3f}",
        f"heat to the walls {100 * parts['heat']:.1f} % of the fuel ({_of_walls(zone.walls)}), highest mean "
        f"temperature {result.t.max():.0f} K",
        f"first law closed to {abs(result.residual[0]):.1g} of the heat released",
    )
    return Pressure(
        kind="two-stroke-zone", period=_TURN, kinks=zone.kinks, absolute=zone.absolute, p_max=p_max,
        phi_p_max=phi_p_max, mean_indicated=zone.mean_indicated,
        t_max=float(zone.result.t.max()), facts=facts,
        phases={"exhaust closes": cycle.evc, "combustion starts": cycle.soc, "end of combustion":
                cycle.soc + cycle.duration, "exhaust opens": cycle.evo, "scavenge ports open": cycle.spo},
    )  # fmt: skip


def closed_period(cycle: TwoStrokeZone, cylinder: Chamber, walls: Law, design: Mapping[str, Scalar]) -> Closed:
    """The closed period at `omega` [rad/s] and `fuel` [kg] of the design, numbers or CasADi symbols."""
    gas = NasaMixture() if cycle.properties == "nasa" else ConstantGamma(gamma=1.35)
    pressure, fuel = scavenging_pressure(cycle.p_s), design["fuel"]
    gas_constant = properties(gas, cycle.T_evc, 0.0).gas_constant
    return Closed(
        chamber=cylinder, gas=gas, law=walls, omega=design["omega"],
        closes=cycle.evc, starts=cycle.soc, duration=cycle.duration, opens=cycle.evo, pressure=pressure,
        temperature=cycle.T_evc, mass=pressure * volume(cylinder, cycle.evc) / (gas_constant * cycle.T_evc), fuel=fuel,
        heat=fuel * cycle.lhv, fuel_heat=fuel * cycle.lhv, latent_heat=0.0, fuel_entry="injected",
        # the heating value is counted at the reference temperature, so the fuel comes in with the energy of gas there
        fuel_energy=properties(gas, T_REFERENCE, 0.0).energy,
        wiebe=(cycle.a_p, cycle.m_p, cycle.a_d, cycle.m_d, cycle.b),
    )  # fmt: skip


def _fuel(cycle: TwoStrokeZone, air: float, mean: Callable[[float], float]) -> float:
    most = air / _STOICHIOMETRIC
    wanted, least = cycle.mean_indicated_pressure, 1e-4 * most
    low, high = mean(least), mean(most)
    if not low < wanted < high:
        raise BadInput(
            f"mean_indicated_pressure = {wanted / 1e5:g} bar cannot be had: without fuel there are {low / 1e5:.3g} "
            f"bar, with all the air burnt {high / 1e5:.3g} bar; change it or the scavenge pressure p_s"
        )
    return root(lambda fuel: mean(fuel) - wanted, least, most, xtol=1e-13 * most, rtol=1e-13)


def _absolute(cycle: TwoStrokeZone, result: ClosedRun) -> Callable[[Scalar], Scalar]:
    once = np.append(np.diff(result.phi[0]) > 1e-12, True)
    nodes, p = result.phi[0, once], result.p[0, once]
    closed = PPoly.hermite(nodes, p, result.dp_dphi[0, once])
    p_evo, p_evc = float(p[-1]), scavenging_pressure(cycle.p_s)

    def one_turn(phi: Scalar) -> Scalar:
        open_ = np.where(phi < cycle.spo, blown_down(cycle, p_evo, phi), p_evc)
        return np.where(phi <= cycle.evo, closed(phi), open_)[()]

    return periodic(one_turn, _TURN, start=cycle.evc)


def shares(cycle: TwoStrokeZone, zone: Zone) -> dict[str, Pure]:
    """Where the fuel's heating value goes: heat (walls), work (of the turn), exhaust (what is left), unburnt."""
    heat, scalars = zone.fuel * cycle.lhv, zone.result.scalars
    work = zone.mean_indicated * zone.cylinder.displacement / heat
    lost, unburnt = float(scalars["wall_heat"][0]) / heat, 1 - float(scalars["heat_released"][0]) / heat
    return {"heat": lost, "work": work, "exhaust": 1 - lost - work - unburnt, "unburnt": unburnt}


def _of_walls(law: Law | None) -> str:
    if law is None:
        return f"Woschni, walls {_ASSUMED.wall_temperature:g} K, assumed; [heat_transfer] tells it"
    wall = getattr(law, "wall_temperature", None)
    return type(law).__name__ + ("" if wall is None else f", walls {wall:g} K")

r"""Gas exchange by filling and emptying: its records, and flow between volumes of one pressure each.

    ambient --throttle-- [plenum] --inlet valve-- [cylinder] --exhaust valve-- [manifold] --tail pipe-- ambient

A valve is known by its lift, a polynomial of the cam angle; a port by the piston that uncovers it. Pressures are
absolute; flow is positive from the first volume to the second.

A turbocharged two-stroke engine is scavenged from receiver to receiver:

    ambient -[compressor]-[cooler]-[blower]- p_s, T_s -ports, valve- p_r, T_r -[turbine]- ambient

Pressures are absolute; areas, masses and powers are of one cylinder. `marine` holds the balance.
"""

import math
from typing import Annotated

import casadi as ca
import numpy as np

from mechsym.cycle.chamber import Chamber, travel
from mechsym.cycle.heat import Adiabatic, Law
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.units import Area, Array, Kelvin, MassFlow, Metre, Pascal, Pure, Radian, Scalar

PERIOD = 4 * math.pi


@record
class Breathing:
    """Section `[breathing]`: valves, plenum and manifold of a four-stroke cylinder."""

    inlet_diameter: float = quantity("m", above=0, about="inner diameter of the inlet valve's seat")
    inlet_lift: float = quantity("m", above=0, about="largest lift of the inlet valve")
    inlet_opens: float = quantity(
        "rad", default=math.radians(345), above=math.pi, below=5 * math.pi / 2, about="from firing TDC"
    )
    inlet_closes: float = quantity(
        "rad", default=math.radians(590), above=5 * math.pi / 2, below=PERIOD, about="from firing TDC"
    )
    exhaust_diameter: float = quantity("m", above=0, about="inner diameter of the exhaust valve's seat")
    exhaust_lift: float = quantity("m", above=0, about="largest lift of the exhaust valve")
    exhaust_opens: float = quantity(
        "rad", default=math.radians(130), above=0, below=3 * math.pi / 2, about="from firing TDC"
    )
    exhaust_closes: float = quantity(
        "rad", default=math.radians(375), above=3 * math.pi / 2, below=3 * math.pi, about="from firing TDC"
    )
    valves: float = quantity("-", default=1.0, low=1, high=4, about="valves of each kind")
    discharge: float = quantity("-", default=0.7, above=0, high=1, about="discharge coefficient of valves and throats")
    throttle_diameter: float = quantity("m", above=0, about="throat between the surroundings and the plenum")
    plenum_volume: float = quantity("m^3", above=0, about="volume between throttle and inlet valve")
    tailpipe_diameter: float = quantity("m", above=0, about="throat between the manifold and the surroundings")
    manifold_volume: float = quantity("m^3", above=0, about="volume behind the exhaust valve")
    altitude: float = quantity("m", default=0.0, low=-500, high=11000, about="height above the sea (ISA)")
    inlet_pressure: float | None = quantity(
        "Pa", default=None, above=0, about="absolute, before the throttle; else the atmosphere's or the turbocharger's"
    )
    inlet_temperature: float | None = quantity(
        "K", default=None, above=0, about="before the throttle; else the atmosphere's or the turbocharger's"
    )
    exhaust_pressure: float | None = quantity(
        "Pa", default=None, above=0, about="absolute, behind the tail pipe; else the atmosphere's or the turbocharger's"
    )


@record
class FreshCharge:
    """The gas and how it burns: Wiebe's function with the factor a and the exponent m + 1."""

    gamma: float = quantity("-", default=1.4, above=1, below=2, about="ratio of the heat capacities")
    R: float = quantity("J/(kg*K)", default=287.0, above=0, about="gas constant")
    #: Heat released by each kilogram of fresh charge that is trapped [J/kg]
    heat: float = quantity("J/kg", low=0, about="heat of a kilogram of fresh charge")
    #: Start [rad] from firing top dead centre, and duration of combustion [rad]
    ignition: float = quantity("rad", about="start of combustion")
    duration: float = quantity("rad", above=0, about="duration of combustion")
    a: float = quantity("-", default=5.0, above=0, about="completeness factor")
    m: float = quantity("-", default=2.0, low=0, about="form factor")


@record
class HeatSink:
    """What the heat of the gas goes into."""

    law: Law = Adiabatic()
    #: Bore and stroke of one piston [m], swept volume of the cylinder [m^3]
    bore: float = 1.0
    stroke: float = 1.0
    displacement: float = 1.0


@record
class Surroundings:
    """State before the throttle and behind the tail pipe, one value or one for each speed."""

    #: Absolute pressure [Pa] and temperature [K] before the throttle
    p_in: np.ndarray | float = 101325.0
    T_in: np.ndarray | float = 288.15
    p_out: np.ndarray | float = 101325.0  #: Absolute pressure behind the tail pipe [Pa]


@record
class Breath:
    """A periodic cycle; curves run from the closing of the inlet over 4 pi."""

    omega: float  #: Crank speed [rad/s]
    phi: np.ndarray  #: Crank angle from firing top dead centre [rad]
    marks: tuple[int, ...]  #: Where of these something begins or ends: the pressure may have a corner there [-]
    #: Absolute pressures of plenum, cylinder, manifold [Pa], temperature in the cylinder [K], volume of it [m^3]
    pressures: dict[str, np.ndarray]
    temperature: np.ndarray
    room: np.ndarray
    trapped: float  #: Mass of gas when the inlet closes [kg]
    residual: float  #: Its burnt share [-]
    drawn: float  #: Fresh gas that comes in at the throttle, less what is blown back there [kg]
    volumetric_efficiency: float  #: Fresh gas drawn by the mass of the swept volume at inlet conditions [-]
    trapping_efficiency: float  #: Fresh gas in the cylinder when the inlet closes by that drawn; the rest is lost [-]
    T_exhaust: float  #: Mean temperature of the gas that leaves, by energy [K]
    #: Works of the gas on the piston over the cycle, and over the two strokes of gas exchange [J]
    work: float
    pumping: float
    #: Heat released, and heat that goes into the walls [J]
    heat: float
    wall_heat: float
    closure: float  #: Largest change of a state from cycle to cycle, by its size [-]
    #: What the balances of mass and energy leave over, by what is trapped and by the energy in the cylinder [-]
    mass_residual: float
    energy_residual: float


@record
class GasExchange:
    """Section `[cycle]`, `kind = "gas-exchange"`; `[breathing]` has the valves, `[boost]` perhaps a turbocharger."""

    air_fuel_ratio: float = quantity("-", above=1, about="air over fuel by mass, mixed before the throttle")
    heating_value: float = quantity("J/kg", above=0, about="lower heating value")
    combustion_efficiency: float = quantity("-", default=0.95, above=0, high=1, about="share that combustion releases")
    #: Angles from firing top dead centre [rad]
    ignition: float = quantity("rad", above=-math.pi / 2, below=math.pi / 4, about="start of combustion")
    duration: float = quantity("rad", above=0, below=math.pi, about="duration of combustion")
    #: X = (1 - exp(-a y^(m + 1)))/(1 - exp(-a)) [-]
    wiebe_a: float = quantity("-", default=5.0, above=0, about="completeness factor")
    wiebe_m: float = quantity("-", default=2.0, low=0, about="form factor")
    octane: float = quantity("-", default=95.0, low=60, high=130, about="octane number of the fuel, for knock")
    gamma: float = quantity("-", default=1.32, above=1, below=2, about="ratio of the heat capacities, fresh and burnt")
    gas_constant: float = quantity("J/(kg*K)", default=287.0, above=0, about="of fresh and burnt gas")


def charge(cycle: GasExchange) -> FreshCharge:
    """The mixture of air and fuel that the cylinder draws in."""
    heat = cycle.combustion_efficiency * cycle.heating_value / (1 + cycle.air_fuel_ratio)
    return FreshCharge(
        gamma=cycle.gamma, R=cycle.gas_constant, heat=heat, ignition=cycle.ignition, duration=cycle.duration,
        a=cycle.wiebe_a, m=cycle.wiebe_m,
    )  # fmt: skip


_SOFT = 1e-3  # relative difference of pressure below which the root is a straight line, so that a flow can turn round


def critical_ratio(gamma: Pure) -> Pure:
    r"""Ratio of the pressures at and below which the flow is choked.

    .. math:: \left(\frac{2}{\gamma + 1}\right)^{\gamma/(\gamma - 1)}

    gamma: ratio of the heat capacities. Returns ratio: pressure behind the throat by the pressure before it.
    Source: ideal gas, isentropic to the throat; Heywood (1988), eq. (C.7). Valid: constant heat capacities.

    >>> round(critical_ratio(1.4), 4)
    0.5283
    """
    return (2 / (gamma + 1)) ** (gamma / (gamma - 1))


def orifice_flow(
    area: Area[Scalar],
    up: tuple[Scalar, Scalar],
    down: tuple[Scalar, Scalar],
    gamma: Pure,
    R: Annotated[float, "J/(kg*K)"],
) -> MassFlow[Scalar]:
    r"""Mass flow through a throat between two volumes.

    .. math:: \dot m = \frac{A\,p_0}{\sqrt{R T_0}}\sqrt{\frac{2\gamma}{\gamma - 1}
              \left(r^{2/\gamma} - r^{(\gamma + 1)/\gamma}\right)}, \qquad r = \max(p_1/p_0, r_{crit})

    area: effective area, discharge coefficient included; up, down: pressure and temperature of the first and the second
    volume [Pa, K]; gamma: ratio of the heat capacities; R: gas constant. Returns flow: from the first to the second
    volume; the volume of the higher pressure gives p_0 and T_0. Source: Heywood (1988), eqs. (C.8), (C.9). Valid:
    quasi-steady; within 1e-3 of equal pressures a straight line stands for the root.

    >>> round(float(orifice_flow(1e-4, (2e5, 300.0), (1e5, 300.0), 1.4, 287.0)), 5)  # choked
    0.04667
    """
    forward = up[0] >= down[0]
    p_0, p_1 = ca.fmax(up[0], down[0]), ca.fmin(up[0], down[0])
    T_0 = ca.if_else(forward, up[1], down[1])
    ratio = ca.fmax(p_1 / p_0, critical_ratio(gamma))
    return area * p_0 / ca.sqrt(R * T_0) * _root(ratio, gamma) * ca.if_else(forward, 1.0, -1.0)


def _root(ratio: Scalar, gamma: float) -> Scalar:
    def exact(r: Scalar) -> Scalar:
        return ca.sqrt(2 * gamma / (gamma - 1) * (r ** (2 / gamma) - r ** ((gamma + 1) / gamma)))

    near = 1 - _SOFT
    straight = exact(near) * (1 - ratio) / _SOFT
    return ca.if_else(ratio < near, exact(ca.fmin(ratio, near)), straight)


def valve_lift(
    phi: Radian[Scalar], opens: Radian, closes: Radian, lift: Metre, period: Radian = 4 * math.pi
) -> Metre[Scalar]:
    r"""Lift of a valve on a polynomial cam.

    .. math:: h = h_{max}\,(1 - u^2)^3, \qquad u = \frac{2\varphi - \varphi_o - \varphi_c}{\varphi_c - \varphi_o}

    opens, closes: crank angles between which it is open, closes above opens; lift: largest lift; period: of the cycle.
    Returns h: lift, 0 while closed; velocity and acceleration have no jump.
    Source: polynomial cam of the 6th degree with two free derivatives at its ends. Valid: closes - opens below period.

    >>> [round(float(valve_lift(a, 0.0, 4.0, 0.01)), 5) for a in (0.0, 1.0, 2.0)]
    [0.0, 0.00422, 0.01]
    """
    along = phi - opens - period * ca.floor((phi - opens) / period)
    u = ca.fmin(2 * along / (closes - opens) - 1, 1.0)
    return lift * (1 - u**2) ** 3


def curtain_area(lift: Metre[Scalar], diameter: Metre, discharge: Pure) -> Area[Scalar]:
    r"""Effective area of a poppet valve.

    .. math:: A = C_d \min(\pi d h,\ \pi d^2/4)

    diameter: inner diameter of the seat d; discharge: discharge coefficient.
    Source: Heywood (1988), section 6.3.2, without the seat's angle. Valid: stem thin against the seat.

    >>> round(float(curtain_area(0.005, 0.02, 1.0)) * 1e6, 2)
    314.16
    """
    return discharge * ca.fmin(math.pi * diameter * lift, math.pi / 4 * diameter**2)


def port_area(x: Metre[Scalar], uncovered_from: Metre, height: Metre, width: Metre, discharge: Pure) -> Area[Scalar]:
    r"""Effective area of ports that the piston uncovers.

    .. math:: A = C_d\, w\,\min(\max(x - x_p, 0), h)

    x: travel of the piston from top dead centre; uncovered_from, height, width: travel x_p at the upper edge, height h
    and total width w of the ports; discharge: discharge coefficient.
    Source: geometry of rectangular ports. Valid: piston crown flat, ports of equal height.

    >>> round(float(port_area(0.09, 0.08, 0.02, 0.1, 0.7)) * 1e4, 6)
    7.0
    """
    return discharge * width * ca.fmin(ca.fmax(x - uncovered_from, 0.0), height)


_TURN = 2 * math.pi
_POINTS = 7200


@record
class Scavenging:
    """Section `[scavenging]`: what gives a two-stroke engine the scavenge pressure p_s and the temperature T_evc."""

    #: `given`: both as `[cycle]` has them; `turbocharger`: the balance of the turbocharger, which replaces them
    source: str = choice("given", "turbocharger", default="turbocharger", about="where p_s and T_evc come from")
    turbine_area: float = quantity("m^2", above=0, below=1, about="effective nozzle area, by cylinder")
    port_width: float = quantity("m", above=0, below=30, about="width of all scavenge ports")
    valve_diameter: float = quantity("m", above=0, below=5, about="seat of the exhaust valve")
    valve_lift: float = quantity(
        "m", above=0, below=2, about="largest lift, between opening and closing of the exhaust"
    )
    discharge: float = quantity("-", default=0.7, above=0, high=1, about="discharge coefficient of ports and valve")
    compressor_efficiency: float = quantity("-", default=0.8, above=0, high=1, about="isentropic")
    turbine_efficiency: float = quantity("-", default=0.8, above=0, high=1, about="isentropic")
    shaft_efficiency: float = quantity("-", default=0.98, above=0, high=1, about="mechanical, of the turbocharger")
    intercooler: float = quantity("-", default=0.9, low=0, high=1, about="effectiveness of the charge air cooler")
    coolant_temperature: float = quantity("K", default=305.0, above=250, below=400, about="water into the cooler")
    cooler_loss: float = quantity("Pa", default=0.0, low=0, below=1e5, about="pressure lost in the cooler")
    blower_pressure: float = quantity("Pa", default=0.0, low=0, below=1e5, about="rise in the auxiliary blower")
    blower_efficiency: float = quantity("-", default=0.6, above=0, high=1, about="isentropic, of the blower")
    displaced: float = quantity("-", default=0.0, low=0, high=1, about="delivery ratio up to which nothing mixes")
    warming: float = quantity("K", default=0.0, low=0, below=200, about="of fresh air by the walls")
    heat_share: float = quantity("-", default=0.15, low=0, below=0.6, about="of the fuel's heat into the coolant")
    altitude: float = quantity("m", default=0.0, low=-500, high=11000, about="height above the sea (ISA)")
    ambient_temperature: float | None = quantity("K", default=None, above=200, below=350, about="else that of the ISA")
    humidity: float = quantity("-", default=0.6, low=0, high=1, about="relative, of the ambient air")
    stack_loss: float = quantity("Pa", default=0.0, low=0, below=1e5, about="pressure behind the turbine over ambient")


def flow_area(s: Scavenging, opened: tuple[Radian, Radian, Radian], room: Chamber) -> Area:
    r"""Mean effective area of scavenge ports and exhaust valve one behind the other.

    .. math:: A = \frac{1}{2\pi}\oint \left(A_{port}^{-2} + A_{valve}^{-2}\right)^{-1/2} d\varphi

    opened: exhaust opens and closes, ports open; from top dead centre, exhaust closing negative. Returns area:
    discharge coefficient included. Source: two throats in series without recovery between them, small pressure
    differences. Valid: quasi-steady, box and receiver at one pressure each; the ports close at the mirror angle of
    their opening. Throats of 3 and 4 cm^2 in series let through what one of 2.4 cm^2 does:

    >>> round(float(in_series(3e-4, 4e-4)) * 1e4, 12)
    2.4
    """
    evo, evc, spo = opened
    phi = np.linspace(0.0, _TURN, _POINTS, endpoint=False)
    x, top = travel(room.motion, phi)[0], float(travel(room.motion, spo)[0])
    a, open_to = ca.SX.sym("a"), ca.SX.sym("x")
    lift = valve_lift(a, evo, evc + _TURN, s.valve_lift, _TURN)
    valve = curtain_area(lift, s.valve_diameter, s.discharge)
    ports = port_area(open_to, top, float(room.stroke) - top, s.port_width, s.discharge)
    both = ca.Function("areas", [a, open_to], [ports, valve])
    return float(np.mean(in_series(*(np.asarray(v).ravel() for v in both(phi.reshape(1, -1), x.reshape(1, -1))))))


def in_series(first: Area[Array], second: Area[Array]) -> Area[Array]:
    """Area that lets through as much as two areas one behind the other."""
    size = np.hypot(first, second)
    return np.asarray(first * second / np.where(size > 0, size, 1.0))


def remaining(delivery: Pure, displaced: Pure = 0.0) -> Pure:
    r"""Volume share of the gas that stays behind: displacement first, perfect mixing then.

    .. math:: x = 1 - \Lambda \quad (\Lambda \le y), \qquad x = (1 - y)\,e^{y - \Lambda} \quad (\Lambda > y)

    delivery: delivery ratio: volume of fresh air at cylinder pressure by the cylinder's. displaced: delivery ratio y up
    to which nothing mixes, 0 to 1. Returns x: share of residual gas.
    Source: R. S. Benson, P. C. Brandham, Int. J. Mech. Sci. 11 (1969) 299, without short circuit; y = 0 is the perfect
    mixing of B. Hopkinson, NEC Inst. Trans. 30 (1914), as in Heywood (1988), section 6.6. Valid: one pressure.

    >>> round(remaining(1.0), 4), remaining(0.4, 0.6), round(remaining(1.0, 0.6), 4)
    (0.3679, 0.6, 0.2681)
    """
    return 1 - delivery if delivery <= displaced else (1 - displaced) * math.exp(displaced - delivery)


def trapped_temperature(fresh: Kelvin, share: Pure, rise: Pure) -> Kelvin:
    r"""Temperature when the exhaust closes, of fresh air with the gas that stayed behind from the cycle before.

    .. math:: \frac{1}{T} = \frac{1 - x}{T_f} + \frac{x}{\tau T} \quad\Rightarrow\quad
              T = T_f\,\frac{1 - x/\tau}{1 - x}

    fresh: temperature of the fresh air T_f, warmed; share: volume share x of the gas that stays; rise: temperature of
    burnt gas at scavenge pressure by that of the charge it was made from, tau. Returns T: temperature of the mixture.
    Source: volumes of ideal gases with one heat capacity add up at constant pressure. Valid: a periodic cycle.

    >>> round(trapped_temperature(320.0, 0.1, 2.5), 2)
    341.33
    """
    return fresh * (1 - share / rise) / (1 - share)


def dew_point(p: Pascal, ambient: tuple[float, float], humidity: Pure) -> Kelvin:
    r"""Temperature at which the water of ambient air condenses after its compression.

    .. math:: e = \varphi\,e_s(T_1)\,\frac{p}{p_1}, \qquad
              e_s = 611.2\,\mathrm{Pa}\,\exp\frac{17.62\,\vartheta}{243.12 + \vartheta}

    p: absolute pressure after compression; ambient: pressure [Pa] and temperature [K] of the ambient air; humidity:
    relative humidity, above 0. Returns T: dew point. Source: Magnus formula over water, WMO-No. 8 (2008), annex 4.B;
    theta in degrees Celsius. Valid: -45 to 60 degrees, used above as well.

    >>> round(dew_point(3.6e5, (1e5, 303.15), 0.6), 1)
    317.3
    """
    warm = ambient[1] - 273.15
    saturated = 17.62 * warm / (243.12 + warm)
    y = math.log(humidity * p / ambient[0]) + saturated
    return 273.15 + 243.12 * y / (17.62 - y)

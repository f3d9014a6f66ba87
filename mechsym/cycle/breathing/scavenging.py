r"""Scavenging of a turbocharged two-stroke engine: its section, areas, charge air and the gas that stays behind.

    ambient -[compressor]-[cooler]-[blower]- p_s, T_s -ports, valve- p_r, T_r -[turbine]- ambient

Pressures are absolute; areas, masses and powers are of one cylinder. `marine` holds the balance.
"""

import math

import casadi as ca
import numpy as np

from mechsym.cycle.breathing.flow import curtain_area, port_area, valve_lift
from mechsym.cycle.chamber import Chamber, travel
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.units import Area, Array, Kelvin, Pascal, Pure, Radian

_TURN = 2 * math.pi
_POINTS = 7200


@record
class Scavenging:
    """Section `[scavenging]`: what gives a two-stroke engine the scavenge pressure p_s and the temperature T_evc."""

    #: `given`: both as `[cycle]` has them; `turbocharger`: the balance of the turbocharger, which replaces them
    source: str = choice("given", "turbocharger", default="turbocharger", about="where p_s and T_evc come from")
    turbine_area: float = quantity("m^2", above=0, below=1, about="effective nozzle area, by cylinder")
    port_width: float = quantity("m", above=0, below=30, about="width of all scavenge ports; they open at cycle.spo")
    valve_diameter: float = quantity("m", above=0, below=5, about="seat of the exhaust valve")
    valve_lift: float = quantity("m", above=0, below=2, about="largest lift, open from cycle.evo to cycle.evc")
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

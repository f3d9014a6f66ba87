r"""The closed period of a cycle as a differential equation in the crank angle, one zone, first law closed.

    m c_v dT/dphi = dQ_R/dphi - dQ_L/dphi - p dV/dphi + (e_f - u) dm/dphi - m (du/dX) dX/dphi,    p = m R T/V

Q_R is the heat released (Wiebe), Q_L the heat lost to the walls, dm the fuel that turns into gas, which brings the
specific internal energy e_f along. The closed period falls into three phases with smooth equations: before, during
and after combustion. Each is integrated over its own variable s from 0 to 1; during combustion phi = phi_s + dphi s^4,
because a Wiebe function with a broken exponent is not smooth at its start in phi, but is nearly so in s.

Every attribute of `Closed` may be a number or a CasADi expression of the design: `closed_function` integrates at
numbers, differentiates and feeds the optimiser with the same operations.
"""

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import casadi as ca

from mechsym.engine.chamber import Chamber, volume, wall_area
from mechsym.engine.gas import ConstantGamma, NasaMixture, properties
from mechsym.engine.heat import GasState, Law, heat_flux, motored_swirl
from mechsym.engine.runge_kutta import fold
from mechsym.engine.wiebe import ddouble_wiebe_dy, double_wiebe

_SHARES = {"before": 0.3, "during": 0.4, "after": 0.3}  # shares of the steps; combustion is short but steep
PHASES = tuple(_SHARES)
_GRADING = {"before": 1, "during": 4, "after": 1}
_MOTORED_EXPONENT = 1.35  # polytropic exponent of the motored cycle in Woschni's term
NODES = ("phi", "t", "p", "dt_dphi", "dp_dphi")
# energies in J (exchange_work: of the ideal gas exchange), masses in kg, angles in rad, omega in rad/s, m^3, m
SCALARS = ("heat_released", "fuel_heat", "latent_heat", "fuel_energy", "energy_start", "energy_end", "exchange_work",
           "mass", "fuel", "omega", "closes", "starts", "ends", "opens", "displacement", "stroke")  # fmt: skip


@dataclasses.dataclass(frozen=True, kw_only=True)
class Closed:
    """Everything that the closed period needs; attributes are numbers or CasADi expressions.

    Parameters
    ----------
    chamber, gas, law : Chamber, ConstantGamma or NasaMixture, Annand or Woschni or Hohenberg or Adiabatic
        Volume, gas properties and heat transfer
    omega : float
        Crank speed [rad/s]
    closes, starts, duration, opens : float
        Inlet closing, start and duration of combustion, exhaust opening [rad]
    pressure, temperature, mass : float
        State when the inlet closes [Pa], [K], [kg]
    fuel : float
        Mass of fuel [kg]
    heat, fuel_heat, latent_heat : float
        Heat that combustion releases when the Wiebe function has reached 1, heating value of the fuel, and latent heat
        charged to the gas [J]
    fuel_energy : float
        Internal energy that fuel brings along when it turns into gas [J/kg]
    fuel_entry : str
        `vaporised`: evenly before ignition; `injected`: as it burns; `premixed`: in the charge from the start
    wiebe : tuple of float
        a_p, m_p, a_d, m_d, b of the double Wiebe function; b = 0 leaves the first alone [-]
    """

    chamber: Chamber
    gas: ConstantGamma | NasaMixture
    law: Law
    omega: Any
    closes: Any
    starts: Any
    duration: Any
    opens: Any
    pressure: Any
    temperature: Any
    mass: Any
    fuel: Any
    heat: Any
    fuel_heat: Any
    latent_heat: Any
    fuel_energy: Any
    fuel_entry: str
    wiebe: tuple[Any, ...]


class Contents(NamedTuple):
    """Burnt share, mass [kg] and their slopes in phi at one crank angle."""

    burnt: Any
    burnt_slope: Any
    mass: Any
    mass_slope: Any


def contents(closed: Closed, phase: str, phi: Any) -> Contents:
    """What the chamber holds at a crank angle.

    Parameters
    ----------
    closed : Closed
        The closed period
    phase : str
        `before`, `during` or `after` combustion
    phi : CasADi scalar
        Crank angle from firing top dead centre [rad]

    Returns
    -------
    contents : Contents
        burnt [-], burnt_slope [1/rad], mass [kg], mass_slope [kg/rad]
    """
    y = {"before": 0.0, "during": (phi - closed.starts) / closed.duration, "after": 1.0}[phase]
    burnt = 0.0 if phase == "before" else double_wiebe(y, *closed.wiebe)
    slope = ddouble_wiebe_dy(y, *closed.wiebe) / closed.duration if phase == "during" else 0.0
    match closed.fuel_entry:
        case "injected":
            return Contents(burnt, slope, closed.mass + closed.fuel * burnt, closed.fuel * slope)
        case "vaporised" if phase == "before":
            rate = closed.fuel / (closed.starts - closed.closes)
            return Contents(burnt, slope, closed.mass + rate * (phi - closed.closes), rate)
        case "vaporised":
            return Contents(burnt, slope, closed.mass + closed.fuel, 0.0)
    return Contents(burnt, slope, closed.mass, 0.0)


def pressure(closed: Closed, phase: str, phi: Any, t: Any) -> Any:
    """Pressure of the gas.

    Parameters
    ----------
    closed : Closed
        The closed period
    phase : str
        `before`, `during` or `after` combustion
    phi : CasADi scalar
        Crank angle from firing top dead centre [rad]
    t : CasADi scalar
        Temperature [K]

    Returns
    -------
    p : CasADi scalar
        Absolute pressure [Pa]
    """
    now = contents(closed, phase, phi)
    return now.mass * properties(closed.gas, t, now.burnt).gas_constant * t / volume(closed.chamber, phi)[0]


def rates(closed: Closed, phase: str, phi: Any, t: Any) -> tuple[Any, Any, Any]:
    """Slopes of temperature, work and heat loss with the crank angle.

    Parameters
    ----------
    closed : Closed
        The closed period
    phase : str
        `before`, `during` or `after` combustion
    phi : CasADi scalar
        Crank angle from firing top dead centre [rad]
    t : CasADi scalar
        Temperature [K]

    Returns
    -------
    dt_dphi : CasADi scalar
        Temperature [K/rad]
    dw_dphi : CasADi scalar
        Work p dV [J/rad]
    dq_dphi : CasADi scalar
        Heat to the walls [J/rad]
    """
    v, dv = volume(closed.chamber, phi)
    now = contents(closed, phase, phi)
    gas = properties(closed.gas, t, now.burnt)
    p = now.mass * gas.gas_constant * t / v
    loss = _heat_loss(closed, phase, p, t, v, gas.gas_constant)
    released = closed.heat * now.burnt_slope
    brought = (closed.fuel_energy - gas.energy) * now.mass_slope
    gain = released - loss - p * dv + brought - now.mass * gas.energy_slope * now.burnt_slope
    return gain / (now.mass * gas.heat_capacity), p * dv, loss


def closed_function(build: Callable[[Any], Closed], names: Sequence[str], steps: int) -> ca.Function:
    """The closed period as a function of a design.

    Parameters
    ----------
    build : callable
        Mapping of the design's names to CasADi symbols -> Closed
    names : sequence of str
        Names of the design variables
    steps : int
        Steps of the integration in all; a multiple of 10

    Returns
    -------
    function : casadi.Function
        (design (k,)) -> the nodes `phi` [rad], `t` [K], `p` [Pa], `dt_dphi` [K/rad], `dp_dphi` [Pa/rad], each
        (1, steps + 3), the two angles where phases meet standing twice; and the scalars `work`, `wall_heat` [J] and
        the entries of `SCALARS`
    """
    z = ca.SX.sym("z", len(names))
    closed = build({name: z[k] for k, name in enumerate(names)})
    design = ca.MX.sym("design", len(names))
    state: Any = ca.Function("start", [z], [ca.vertcat(closed.temperature, 0.0, 0.0)])(design)
    nodes = []
    for phase, share in _SHARES.items():
        n = round(share * steps)
        history = ca.horzcat(state, fold(_rate(closed, phase, z), 3, len(names), n)(state, design))
        s = ca.DM([k / n for k in range(n + 1)]).T
        nodes.append(_node(closed, phase, z)(ca.repmat(design, 1, n + 1), s, history))
        state = history[:, -1]
    t = ca.SX.sym("t")
    books = ca.Function("scalars", [z, t], [ca.vertcat(*scalars(closed, t))])(design, state[0])
    outputs = [*ca.vertsplit(ca.horzcat(*nodes)), state[1], state[2], *ca.vertsplit(books)]
    return ca.Function("closed", [design], outputs, ["design"], [*NODES, "work", "wall_heat", *SCALARS])


def _span(closed: Closed, phase: str, s: Any) -> tuple[Any, Any]:
    ends = closed.starts + closed.duration
    first, last = {
        "before": (closed.closes, closed.starts),
        "during": (closed.starts, ends),
        "after": (ends, closed.opens),
    }[phase]
    power = _GRADING[phase]
    return first + (last - first) * s**power, (last - first) * power * s ** (power - 1)


def _rate(closed: Closed, phase: str, z: Any) -> Callable[[Any, Any, Any], Any]:
    phi, y = ca.SX.sym("phi"), ca.SX.sym("y", 3)
    slope = ca.Function("rate", [phi, y, z], [ca.vertcat(*rates(closed, phase, phi, y[0]))])
    span = ca.Function("span", [y, z], [ca.vertcat(*_span(closed, phase, y[0]))])

    def rate(s: Any, y: Any, z: Any) -> Any:
        here = span(ca.vertcat(s, 0, 0), z)
        return slope(here[0], y, z) * here[1]

    return rate


def _node(closed: Closed, phase: str, z: Any) -> ca.Function:
    s, y, phi = ca.SX.sym("s"), ca.SX.sym("y", 3), ca.SX.sym("phi")
    p = pressure(closed, phase, phi, y[0])
    dt = rates(closed, phase, phi, y[0])[0]
    dp = ca.jacobian(p, phi) + ca.jacobian(p, y[0]) * dt
    at_phi = ca.Function("at_phi", [z, phi, y], [ca.vertcat(phi, y[0], p, dt, dp)])
    return ca.Function("node", [z, s, y], [at_phi(z, _span(closed, phase, s)[0], y)])


def scalars(closed: Closed, t_end: Any) -> tuple[Any, ...]:
    """Energies, masses and angles of the closed period.

    Parameters
    ----------
    closed : Closed
        The closed period
    t_end : CasADi scalar
        Temperature when the exhaust opens [K]

    Returns
    -------
    values : tuple of CasADi scalar
        In the order and the units of `SCALARS` [-]
    """
    first, last = contents(closed, "before", closed.closes), contents(closed, "after", closed.opens)
    v_closes, v_opens = (volume(closed.chamber, angle)[0] for angle in (closed.closes, closed.opens))
    values = {
        "heat_released": closed.heat * last.burnt,
        "fuel_heat": closed.fuel_heat,
        "latent_heat": closed.latent_heat,
        "fuel_energy": closed.fuel_energy * (last.mass - first.mass),
        "energy_start": first.mass * properties(closed.gas, closed.temperature, first.burnt).energy,
        "energy_end": last.mass * properties(closed.gas, t_end, last.burnt).energy,
        "exchange_work": closed.pressure * (v_closes - v_opens),
        "mass": closed.mass,
        "fuel": closed.fuel,
        "omega": closed.omega,
        "closes": closed.closes,
        "starts": closed.starts,
        "ends": closed.starts + closed.duration,
        "opens": closed.opens,
        "displacement": closed.chamber.displacement,
        "stroke": closed.chamber.stroke,
    }
    return tuple(values[name] for name in SCALARS)


def _heat_loss(closed: Closed, phase: str, p: Any, t: Any, v: Any, gas_constant: Any) -> Any:
    chamber = closed.chamber
    swirl: Any = 0.0
    if phase != "before":
        v_ref = volume(chamber, closed.closes)[0]
        motored = closed.pressure * (v_ref / v) ** _MOTORED_EXPONENT
        scale = chamber.displacement * closed.temperature / (closed.pressure * v_ref)
        swirl = motored_swirl(closed.law, p, motored, scale)
    speed = chamber.stroke * closed.omega / ca.pi
    state = GasState(p, t, v, gas_constant, chamber.bore, speed, swirl)
    return heat_flux(closed.law, state) * wall_area(chamber, v) / closed.omega

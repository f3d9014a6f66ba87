r"""A four-stroke cylinder that breathes: plenum, cylinder and manifold, each of one pressure, over whole cycles.

.. math:: m_i' = \sum \dot m/\omega, \qquad E_i' = \sum \dot m\,c_p T_{up}/\omega - p V_i' + Q_i', \qquad
          p_i = (\gamma - 1) E_i/V_i

A cycle runs from one closing of the inlet to the next, and cycles follow each other until one repeats. The gas is ideal
with constant heat capacities and exchanges no heat with the walls; burnt gas is told from fresh by its mass alone.
Crank angles count from firing top dead centre, so gas exchange lies around 2 pi.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import casadi as ca
import numpy as np

from mechsym.cycle.closed.runge_kutta import METHOD
from mechsym.cycle.gas_exchange import curtain_area, orifice_flow, valve_lift
from mechsym.errors import BadInput
from mechsym.native.fold import folder
from mechsym.quantities import quantity, record

_PERIOD = 4 * math.pi
_STEPS, _CYCLES, _SETTLED = 1440, 120, 1e-10
_SLOW = 200.0  # below this speed pressures settle within fewer degrees, and steps are finer in proportion [rad/s]
_SIZES = [0, 1, 0, 3, 4, 3, 6, 7, 6]  # the state by which each is measured: burnt masses by whole ones
_VOLUMES = ("plenum", "cylinder", "manifold")
# mass [kg], internal energy [J] and burnt mass [kg] of each volume, then what has crossed the borders [kg, J]
STATES = (*(f"{q}_{v}" for v in _VOLUMES for q in ("m", "E", "b")),
          "work", "pumping", "m_in", "H_in", "m_out", "H_out", "heat")  # fmt: skip


@record
class Breathing:
    """Section `[breathing]`: valves, plenum and manifold of a four-stroke cylinder."""

    inlet_diameter: float = quantity("m", above=0, about="inner diameter of the inlet valve's seat")
    inlet_lift: float = quantity("m", above=0, about="largest lift of the inlet valve")
    inlet_opens: float = quantity("rad", default=math.radians(345), above=math.pi, below=5 * math.pi / 2,
                                  about="from firing TDC")  # fmt: skip
    inlet_closes: float = quantity("rad", default=math.radians(590), above=5 * math.pi / 2, below=_PERIOD,
                                   about="from firing TDC")  # fmt: skip
    exhaust_diameter: float = quantity("m", above=0, about="inner diameter of the exhaust valve's seat")
    exhaust_lift: float = quantity("m", above=0, about="largest lift of the exhaust valve")
    exhaust_opens: float = quantity("rad", default=math.radians(130), above=0, below=3 * math.pi / 2,
                                    about="from firing TDC")  # fmt: skip
    exhaust_closes: float = quantity("rad", default=math.radians(375), above=3 * math.pi / 2, below=3 * math.pi,
                                     about="from firing TDC")  # fmt: skip
    valves: float = quantity("-", default=1.0, low=1, high=4, about="valves of each kind")
    discharge: float = quantity("-", default=0.7, above=0, high=1, about="discharge coefficient of valves and throats")
    throttle_diameter: float = quantity("m", above=0, about="throat between the ambient and the plenum")
    plenum_volume: float = quantity("m^3", above=0, about="volume between throttle and inlet valve")
    tailpipe_diameter: float = quantity("m", above=0, about="throat between the manifold and the ambient")
    manifold_volume: float = quantity("m^3", above=0, about="volume behind the exhaust valve")
    inlet_pressure: float = quantity("Pa", default=101325.0, above=0, about="absolute pressure before the throttle")
    inlet_temperature: float = quantity("K", default=288.15, above=0, about="temperature before the throttle")
    exhaust_pressure: float = quantity("Pa", default=101325.0, above=0, about="absolute pressure behind the tail pipe")


@record
class FreshCharge:
    """The gas and how it burns; y^m of Wiebe with the factor a."""

    gamma: float = quantity("-", default=1.4, above=1, below=2, about="ratio of the heat capacities")
    R: float = quantity("J/(kg*K)", default=287.0, above=0, about="gas constant")
    #: Heat released by each kilogram of fresh air that is trapped [J/kg]
    heat: float = quantity("J/kg", low=0, about="heat of a kilogram of fresh air")
    #: Start [rad] from firing top dead centre, and duration of combustion [rad]
    ignition: float = quantity("rad", about="start of combustion")
    duration: float = quantity("rad", above=0, about="duration of combustion")
    a: float = quantity("-", default=5.0, above=0, about="completeness factor")
    m: float = quantity("-", default=2.0, low=0, about="form factor")


@record
class Breath:
    """A periodic cycle; curves run from the closing of the inlet over 4 pi."""

    omega: float  #: Crank speed [rad/s]
    phi: np.ndarray  #: Crank angle from firing top dead centre [rad]
    #: Absolute pressures of plenum, cylinder, manifold [Pa]
    pressures: dict[str, np.ndarray]
    #: Mass of gas when the inlet closes [kg], its burnt share [-], its pressure [Pa] and temperature [K]
    trapped: float
    residual: float
    p_trapped: float
    T_trapped: float
    volumetric_efficiency: float  #: Fresh gas trapped by the mass of the swept volume at inlet conditions [-]
    #: Works of the gas on the piston over the cycle, and over the two strokes of gas exchange [J]
    work: float
    pumping: float
    heat: float  #: Heat released [J]
    closure: float  #: Largest change of a state from cycle to cycle, by its size [-]
    #: What the balances of mass and energy leave over, by what is trapped and by the energy in the cylinder [-]
    mass_residual: float
    energy_residual: float


def breathe(
    breathing: Breathing, charge: FreshCharge, volume: Callable[[Any], Any], omega: Sequence[float]
) -> list[Breath]:
    """Follow cycles until one repeats, at all speeds side by side.

    Parameters
    ----------
    volume : callable
        Crank angle, number or CasADi symbol [rad], to the cylinder's volume [m^3]
    omega : sequence of float
        Crank speeds [rad/s]
    """
    speeds = np.asarray(omega, float)
    steps = _STEPS * max(1, math.ceil(_SLOW / float(speeds.min())))
    phi = breathing.inlet_closes + np.arange(steps + 1) * _PERIOD / steps
    fold = folder(_rate(breathing, charge, volume), METHOD)
    state = np.repeat(_start(breathing, charge, float(volume(breathing.inlet_closes)))[:, None], len(speeds), axis=1)
    past: list[tuple[np.ndarray, np.ndarray]] = []
    for _ in range(_CYCLES):
        history = fold(state, np.vstack([speeds, state[3] - state[5]]), steps)
        if not np.isfinite(history[-1]).all():
            raise BadInput("gas exchange is too fast for its steps; widen the plenum or the manifold of [breathing]")
        gain = history[-1, :9] - state[:9]
        closure = np.max(np.abs(gain) / history[-1, _SIZES], axis=0)
        if np.all(closure < _SETTLED):
            break
        past = [*past[-4:], (state[:9], gain)]
        state = np.vstack([_ahead(past), np.zeros((7, len(speeds)))])
    else:
        raise BadInput(f"gas exchange does not settle in {_CYCLES} cycles: a relative {np.max(closure):.2g} is left")
    whole = np.concatenate([state[None], history])
    return [
        _summed(breathing, charge, volume, float(speed), (phi, whole[:, :, k], float(closure[k])))
        for k, speed in enumerate(speeds)
    ]


def _ahead(past: list[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """State to try next: the mixture of the last ones whose gain is least (Anderson), lane by lane."""
    (last, gain), following = past[-1], past[-1][0] + past[-1][1]
    if len(past) < 3:
        return following
    found = following.copy()
    scale = np.abs(last) + 1e-12
    for k in range(last.shape[1]):
        steps = np.array([(x[:, k] - last[:, k]) / scale[:, k] for x, _ in past[:-1]]).T
        turns = np.array([(g[:, k] - gain[:, k]) / scale[:, k] for _, g in past[:-1]]).T
        weights = np.linalg.lstsq(turns, gain[:, k] / scale[:, k], rcond=1e-8)[0]
        ahead = following[:, k] - (steps + turns) @ weights * scale[:, k]
        if np.all(ahead[[0, 1, 3, 4, 6, 7]] > 0.3 * last[[0, 1, 3, 4, 6, 7], k]) and np.all(ahead[[2, 5, 8]] >= 0):
            found[:, k] = ahead
    return found


def _summed(
    b: Breathing, c: FreshCharge, volume: Callable[[Any], Any], omega: float, run: tuple[np.ndarray, np.ndarray, float]
) -> Breath:
    phi, history, closure = run
    first, last = history[0], history[-1]
    room = np.array([float(volume(angle)) for angle in phi])
    sizes: dict[str, Any] = dict(zip(_VOLUMES, (b.plenum_volume, room, b.manifold_volume), strict=True))
    pressures: dict[str, np.ndarray] = {
        name: (c.gamma - 1) * history[:, 3 * i + 1] / sizes[name] for i, name in enumerate(_VOLUMES)
    }
    gain = (last[:9] - first[:9]).reshape(3, 3).sum(axis=0)
    work, pumping, m_in, H_in, m_out, H_out, heat = last[9:]
    swept = float(room.max() - room.min())
    trapped, cv = float(first[3]), c.R / (c.gamma - 1)
    return Breath(
        omega=omega, phi=phi, pressures=pressures, trapped=trapped, residual=float(first[5] / first[3]),
        p_trapped=float(pressures["cylinder"][0]), T_trapped=float(first[4] / (first[3] * cv)),
        volumetric_efficiency=float(first[3] - first[5]) / (b.inlet_pressure * swept / (c.R * b.inlet_temperature)),
        work=float(work), pumping=float(pumping), heat=float(heat), closure=closure,
        mass_residual=float(abs(gain[0] - m_in + m_out)) / trapped,
        energy_residual=float(abs(gain[1] - H_in + H_out - heat + work)) / float(first[4]),
    )  # fmt: skip


def _start(breathing: Breathing, charge: FreshCharge, room: float) -> np.ndarray:
    b, cv = breathing, charge.R / (charge.gamma - 1)
    mass = [
        p * v / (charge.R * T)
        for p, v, T in (
            (b.inlet_pressure, b.plenum_volume, b.inlet_temperature),
            (b.inlet_pressure, room, b.inlet_temperature),
            (b.exhaust_pressure, b.manifold_volume, 3 * b.inlet_temperature),
        )
    ]
    T = (b.inlet_temperature, b.inlet_temperature, 3 * b.inlet_temperature)
    burnt = (0.0, 0.0, mass[2])
    rows = [[m, m * cv * t, x] for m, t, x in zip(mass, T, burnt, strict=True)]
    return np.concatenate([np.ravel(rows), np.zeros(7)])


def _rate(breathing: Breathing, charge: FreshCharge, volume: Callable[[Any], Any]) -> ca.Function:
    s, y, z = ca.SX.sym("s"), ca.SX.sym("y", len(STATES)), ca.SX.sym("z", 2)
    angle, (omega, fresh) = ca.SX.sym("phi"), (z[0], z[1])
    slope = ca.Function("slope", [angle, y, z], [_slopes(breathing, charge, volume(angle), angle, y, omega, fresh)])
    return ca.Function("rate", [s, y, z], [slope(breathing.inlet_closes + _PERIOD * s, y, z) * _PERIOD], list("syz"),
                       ["ds"])  # fmt: skip


def _slopes(b: Breathing, c: FreshCharge, room: Any, phi: Any, y: Any, omega: Any, fresh: Any) -> Any:
    cv, dV = c.R / (c.gamma - 1), ca.jacobian(room, phi)
    size = (b.plenum_volume, room, b.manifold_volume)
    inside = [((c.gamma - 1) * y[3 * i + 1] / size[i], y[3 * i + 1] / (y[3 * i] * cv)) for i in range(3)]
    burnt = [0.0, *(y[3 * i + 2] / y[3 * i] for i in range(3)), y[8] / y[6]]
    states = [(b.inlet_pressure, b.inlet_temperature), *inside, (b.exhaust_pressure, b.inlet_temperature)]
    flows, heats, shares = [], [], []
    for i, area in enumerate(_areas(b, phi)):
        flow = orifice_flow(area, states[i], states[i + 1], c.gamma, c.R) / omega
        from_first = flow >= 0
        flows.append(flow)
        heats.append(flow * cv * c.gamma * ca.if_else(from_first, states[i][1], states[i + 1][1]))
        shares.append(flow * ca.if_else(from_first, burnt[i], burnt[i + 1]))
    release = fresh * _burning(c, phi)
    rows = [[flows[i] - flows[i + 1], heats[i] - heats[i + 1], shares[i] - shares[i + 1]] for i in range(3)]
    work = inside[1][0] * dV
    rows[1][1] += c.heat * release - work
    rows[1][2] += release
    exchange = ca.if_else(
        ca.fabs(phi - 6 * math.pi) < math.pi, work, 0.0
    )  # the two strokes about the dead centre of exchange
    last = [work, exchange, flows[0], heats[0], flows[3], heats[3], c.heat * release]
    return ca.vertcat(*(value for row in rows for value in row), *last)


def _areas(b: Breathing, phi: Any) -> list[Any]:
    def valve(opens: float, closes: float, lift: float, diameter: float) -> Any:
        return b.valves * curtain_area(valve_lift(phi, opens, closes, lift), diameter, b.discharge)

    def throat(diameter: float) -> float:
        return b.discharge * math.pi / 4 * diameter**2

    return [
        throat(b.throttle_diameter),
        valve(b.inlet_opens, b.inlet_closes, b.inlet_lift, b.inlet_diameter),
        valve(b.exhaust_opens, b.exhaust_closes, b.exhaust_lift, b.exhaust_diameter),
        throat(b.tailpipe_diameter),
    ]


def _burning(c: FreshCharge, phi: Any) -> Any:
    # the turn begins where the inlet closes, so its firing dead centre is at 4 pi; the rest of Wiebe burns at the end
    y = ca.fmin(ca.fmax((phi - _PERIOD - c.ignition) / c.duration, 0.0), 1.0)
    slope = c.a * (c.m + 1) * y**c.m * ca.exp(-c.a * y ** (c.m + 1)) / c.duration
    inside = ca.logic_and(y > 0, y < 1)
    return ca.if_else(inside, slope / (1 - math.exp(-c.a)), 0.0)

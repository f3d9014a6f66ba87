r"""Slopes of masses and energies of plenum, cylinder and manifold over the crank angle.

.. math:: m_i' = \sum \dot m/\omega, \qquad E_i' = \sum \dot m\,c_p T_{up}/\omega - p V_i' + Q_i', \qquad
          p_i = (\gamma - 1) E_i/V_i

The gas is ideal with constant heat capacities; burnt gas is told from fresh by its mass alone.

Whole cycles of a cylinder that breathes, one after the other until one repeats, at all speeds side by side.

Where volumes are so large that none repeats for long, Newton looks for the one that does.

A cycle runs from one closing of the inlet to the next. Crank angles count from firing top dead centre, so gas exchange
lies around 2 pi.

The cycle that repeats, by Newton, where volumes are so large that following cycle after cycle takes too long.

.. math:: F(x) = g(x) - x = 0, \qquad x \leftarrow x - (g' - 1)^{-1} F

g takes the state over one cycle; its slopes come from cycles of neighbours that run side by side. A cycle whose
neighbours run away from it, so that |eigenvalue of g'| > 1, is none that an engine shows, and none is returned.
"""

import functools
import itertools
import math
from collections.abc import Callable, Sequence

import casadi as ca
import numpy as np

from mechsym.cycle.breathing.flow import (
    PERIOD,
    Breath,
    Breathing,
    FreshCharge,
    HeatSink,
    Surroundings,
    curtain_area,
    orifice_flow,
    valve_lift,
)
from mechsym.cycle.chamber import piston_area
from mechsym.cycle.closed.run import METHOD
from mechsym.cycle.heat import MOTORED_EXPONENT, Adiabatic, GasAtWall, heat_flux, motored_swirl
from mechsym.errors import BadInput
from mechsym.native.march import Fold, folder
from mechsym.quantities import record
from mechsym.quantities.units import RPM, Pure, RadPerSecond, Scalar

VOLUMES = ("plenum", "cylinder", "manifold")
# mass [kg], internal energy [J] and burnt mass [kg] of each volume, then what has crossed the borders [kg, J]
STATES = (*(f"{q}_{v}" for v in VOLUMES for q in ("m", "E", "b")),
          "work", "pumping", "m_in", "b_in", "H_in", "m_out", "H_out", "heat", "wall_heat")  # fmt: skip
# speed [rad/s], fresh mass [kg] and state [Pa, K] when the inlet closes, state of the surroundings [Pa, K, Pa]
GIVEN = ("omega", "fresh", "p_closed", "T_closed", "p_in", "T_in", "p_out")
# a stretch between two events: where it begins and how long it is [rad]; 1 where gas burns, where burning stirs it,
# and in the two strokes about the dead centre of exchange [-]
STRETCH = ("begins", "length", "burns", "stirs", "exchanges")


@record
class Cylinder:
    """A cylinder that breathes."""

    breathing: Breathing
    charge: FreshCharge
    volume: Callable[[Scalar], Scalar]  #: Crank angle, number or symbol [rad], to the volume of the cylinder [m^3]
    walls: HeatSink = HeatSink()

    # a cylinder is itself: its volume is a function
    __hash__ = object.__hash__


def rate(cylinder: Cylinder) -> ca.Function:
    """Slope of the states over s, which runs from 0 to 1 over a stretch."""
    names = (*GIVEN, *STRETCH)
    s, y, z = ca.SX.sym("s"), ca.SX.sym("y", len(STATES)), ca.SX.sym("z", len(names))
    angle, held = ca.SX.sym("phi"), dict(zip(names, ca.vertsplit(z), strict=True))
    slope = ca.Function("slope", [angle, y, z], [_slopes(cylinder, angle, y, held)])
    here = held["begins"] + held["length"] * s
    return ca.Function("rate", [s, y, z], [slope(here, y, z) * held["length"]], list("syz"), ["ds"])


def _slopes(cylinder: Cylinder, phi: Scalar, y: Scalar, z: dict[str, ca.SX]) -> Scalar:
    b, c, room = cylinder.breathing, cylinder.charge, cylinder.volume(phi)
    cv, size = c.R / (c.gamma - 1), (b.plenum_volume, room, b.manifold_volume)
    inside = [((c.gamma - 1) * y[3 * i + 1] / size[i], y[3 * i + 1] / (y[3 * i] * cv)) for i in range(3)]
    flows, heats, shares = _exchanged(cylinder, phi, y, inside, z)
    release, work = z["fresh"] * z["burns"] * _burning(c, phi), inside[1][0] * ca.jacobian(room, phi)
    lost = _to_walls(cylinder, inside[1], room, z)
    rows = [[flows[i] - flows[i + 1], heats[i] - heats[i + 1], shares[i] - shares[i + 1]] for i in range(3)]
    rows[1][1] += c.heat * release - work - lost
    rows[1][2] += release
    last = [work, z["exchanges"] * work, flows[0], shares[0], heats[0], flows[3], heats[3], c.heat * release, lost]
    return ca.vertcat(*(value for row in rows for value in row), *last)


def _exchanged(
    cylinder: Cylinder, phi: Scalar, y: Scalar, inside: list[tuple[ca.SX, ca.SX]], z: dict[str, ca.SX]
) -> tuple[list[ca.SX], list[ca.SX], list[ca.SX]]:
    """Mass [kg/rad], energy [J/rad] and burnt mass [kg/rad] through the four throats, positive towards the exhaust."""
    c = cylinder.charge
    cp = c.gamma * c.R / (c.gamma - 1)
    burnt = [0.0, *(y[3 * i + 2] / y[3 * i] for i in range(3)), y[8] / y[6]]
    states = [(z["p_in"], z["T_in"]), *inside, (z["p_out"], z["T_in"])]
    flows, heats, shares = [], [], []
    for i, area in enumerate(_areas(cylinder.breathing, phi)):
        flow = orifice_flow(area, states[i], states[i + 1], c.gamma, c.R) / z["omega"]
        from_first = flow >= 0
        flows.append(flow)
        heats.append(flow * cp * ca.if_else(from_first, states[i][1], states[i + 1][1]))
        shares.append(flow * ca.if_else(from_first, burnt[i], burnt[i + 1]))
    return flows, heats, shares


def _to_walls(cylinder: Cylinder, inside: tuple[ca.SX, ca.SX], room: ca.SX, z: dict[str, ca.SX]) -> Scalar:
    """Heat from the gas to the walls [J/rad]; Woschni's term of combustion counts while the valves are closed."""
    walls = cylinder.walls
    if isinstance(walls.law, Adiabatic):
        return 0.0
    closed = cylinder.volume(cylinder.breathing.inlet_closes)
    scale = walls.displacement * z["T_closed"] / (z["p_closed"] * closed)
    motored = z["p_closed"] * (closed / room) ** MOTORED_EXPONENT
    swirl = z["stirs"] * motored_swirl(walls.law, inside[0], motored, scale)
    state = GasAtWall(
        p=inside[0], t=inside[1], v=room, gas_constant=cylinder.charge.R, bore=walls.bore,
        piston_speed=walls.stroke * z["omega"] / math.pi, swirl=swirl,
    )  # fmt: skip
    area = 2 * piston_area(walls.bore) + 4 * room / walls.bore  # `chamber.wall_area` without a chamber
    return heat_flux(walls.law, state) * area / z["omega"]


def _areas(b: Breathing, phi: Scalar) -> list[Scalar]:
    def valve(opens: float, closes: float, lift: float, diameter: float) -> Scalar:
        return b.valves * curtain_area(valve_lift(phi, opens, closes, lift), diameter, b.discharge)

    def throat(diameter: float) -> float:
        return b.discharge * math.pi / 4 * diameter**2

    return [
        throat(b.throttle_diameter),
        valve(b.inlet_opens, b.inlet_closes, b.inlet_lift, b.inlet_diameter),
        valve(b.exhaust_opens, b.exhaust_closes, b.exhaust_lift, b.exhaust_diameter),
        throat(b.tailpipe_diameter),
    ]


def _burning(c: FreshCharge, phi: Scalar) -> Scalar:
    # the turn begins where the inlet closes, so its firing dead centre is at 4 pi
    y = ca.fmin(ca.fmax((phi - PERIOD - c.ignition) / c.duration, 0.0), 1.0)
    slope = c.a * (c.m + 1) * y**c.m * ca.exp(-c.a * y ** (c.m + 1)) / c.duration
    # the share that Wiebe's function leaves at its end burns along with the rest
    return slope / (1 - math.exp(-c.a))


@record
class _Stretch:
    """A part of the cycle in which nothing begins or ends, so that the steps keep their order."""

    held: tuple[float, ...]  #: In the order and the units of `STRETCH` [rad, rad, -, -, -]
    steps: int  #: Of equal length [-]

    @property
    def phi(self) -> np.ndarray:
        """Ends of its steps [rad]."""
        begins, length, *_ = self.held
        return begins + length * np.arange(1, self.steps + 1) / self.steps


def _stretches(cylinder: Cylinder, steps: int) -> list[_Stretch]:
    b, c = cylinder.breathing, cylinder.charge
    begins = b.inlet_closes
    fires, ends, opens = PERIOD + c.ignition, PERIOD + c.ignition + c.duration, PERIOD + b.exhaust_opens
    events = (fires, ends, opens, b.exhaust_closes, b.inlet_opens, 5 * math.pi, 7 * math.pi)
    inner = sorted(begins + float(np.remainder(angle - begins, PERIOD)) for angle in events)
    marks = [begins]
    for mark in (*inner, begins + PERIOD):
        if mark - marks[-1] > _APART:
            marks.append(mark)
    marks[-1] = begins + PERIOD
    stretches = []
    for low, high in itertools.pairwise(marks):
        middle = (low + high) / 2
        flags = (fires < middle < ends, fires < middle < opens, abs(middle - 6 * math.pi) < math.pi)
        count = math.ceil((high - low) / PERIOD * steps - 1e-9)
        stretches.append(_Stretch(held=(low, high - low, *map(float, flags)), steps=count))
    return stretches


def _followed(fold: Fold, state: np.ndarray, given: np.ndarray, stretches: Sequence[_Stretch]) -> np.ndarray:
    """States at the ends of all steps of a cycle, shape (steps, states, speeds)."""
    history = []
    for stretch in stretches:
        held = np.repeat(np.array(stretch.held)[:, None], given.shape[1], axis=1)
        history.append(fold(state, np.vstack([given, held]), stretch.steps))
        state = history[-1][-1]
    return np.concatenate(history)


_STEPS, _CYCLES, _SETTLED = 1440, 40, 1e-10
_APART = 1e-6  # events that are nearer are one [rad]
_FINER = (1, 4)  # times as many steps, where small volumes behind wide throats ask for it
_SLOW = 200.0  # below this speed pressures settle within fewer degrees, and steps are finer in proportion [rad/s]
_SLOWEST = 3.0  # below this a cycle would take minutes, and no engine turns [rad/s]
_SIZES = [0, 1, 0, 3, 4, 3, 6, 7, 6]  # the state by which each is measured: burnt masses by whole ones
_SUMS = len(STATES) - 9
_HOT = 3.0  # temperature of the first guess in the manifold, by that of the surroundings [-]


def breathe(cylinder: Cylinder, around: Surroundings, omega: Sequence[RadPerSecond]) -> list[Breath]:
    """Follow cycles until one repeats."""
    speeds = np.asarray(omega, float)
    if (slowest := float(speeds.min())) < _SLOWEST:
        raise BadInput(f"gas exchange at {slowest / RPM:.3g} rpm is not computed: pressures settle in so small a "
                       f"part of a turn that a cycle takes minutes; {_SLOWEST / RPM:.0f} rpm is the least")  # fmt: skip
    outside = np.array([np.broadcast_to(v, speeds.shape) for v in (around.p_in, around.T_in, around.p_out)])
    steps = _STEPS * max(1, math.ceil(_SLOW / float(speeds.min())))
    for finer in _FINER:
        breaths = _breathed(cylinder, outside, speeds, finer * steps)
        if breaths is not None:
            return breaths
    raise BadInput("gas exchange is too fast for its steps, or swings from cycle to cycle; widen the plenum or the "
                   "manifold of [breathing], or narrow the throttle or the tail pipe")  # fmt: skip


def _breathed(cylinder: Cylinder, outside: np.ndarray, speeds: np.ndarray, steps: int) -> list[Breath] | None:
    """The periodic cycles; None where the steps are too wide for the volumes, or no cycle repeats."""
    stretches = _stretches(cylinder, steps)
    phi = np.concatenate([[cylinder.breathing.inlet_closes], *(stretch.phi for stretch in stretches)])
    marks = tuple(np.cumsum([0, *(stretch.steps for stretch in stretches)]).tolist())
    fold, room = _fold(cylinder), _rooms(cylinder, phi)
    closed = float(room[0])
    # first guess of all states, shape (states, speeds)
    b, c, (p_in, T_in, p_out) = cylinder.breathing, cylinder.charge, outside
    rows: list[np.ndarray] = []
    for p, V, T, burnt in (
        (p_in, b.plenum_volume, T_in, 0.0), (p_in, closed, T_in, 0.0), (p_out, b.manifold_volume, _HOT * T_in, 1.0)
    ):  # fmt: skip
        mass = p * V / (c.R * T)
        rows += [mass, p * V / (c.gamma - 1), burnt * mass]
    state = np.vstack([*rows, np.zeros((_SUMS, outside.shape[1]))])
    past: list[tuple[np.ndarray, np.ndarray]] = []
    for count in range(_CYCLES + 1):
        history = _followed(fold, state, _given(cylinder, state, closed, speeds, outside), stretches)
        if not np.isfinite(history[-1]).all():
            return None
        gain = history[-1, :9] - state[:9]
        closure = np.max(np.abs(gain) / history[-1, _SIZES], axis=0)
        if np.all(closure < _SETTLED):
            break
        past = [*past[-4:], (state[:9], gain)]
        late = count == _CYCLES - 1
        ahead = _repeating(cylinder, state[:9], closed, speeds, outside, stretches) if late else _ahead(past)
        if ahead is None:
            return None
        state = np.vstack([ahead, np.zeros((_SUMS, len(speeds)))])
    else:
        return None
    whole = np.concatenate([state[None], history])
    return [
        _summed(cylinder, float(speed), (phi, room, marks), outside[:, k], whole[:, :, k], float(closure[k]))
        for k, speed in enumerate(speeds)
    ]


def _repeating(
    cylinder: Cylinder,
    state: np.ndarray,
    closed: float,
    speeds: np.ndarray,
    outside: np.ndarray,
    stretches: Sequence[_Stretch],
) -> np.ndarray | None:
    fold = _fold(cylinder)

    def cycle(states: np.ndarray, lane: np.ndarray) -> np.ndarray:
        whole = np.vstack([states, np.zeros((_SUMS, len(lane)))])
        given = _given(cylinder, whole, closed, speeds[lane], outside[:, lane])
        return np.asarray(_followed(fold, whole, given, stretches)[-1, :9])

    return repeating(cycle, state, _SIZES, _SETTLED)


@functools.lru_cache(maxsize=4)
def _fold(cylinder: Cylinder) -> Fold:
    return folder(rate(cylinder), METHOD)


def _rooms(cylinder: Cylinder, phi: np.ndarray) -> np.ndarray:
    angle = ca.SX.sym("phi")
    return np.asarray(ca.Function("room", [angle], [cylinder.volume(angle)])(phi.reshape(1, -1))).ravel()


def _given(cylinder: Cylinder, state: np.ndarray, closed: float, speeds: np.ndarray, outside: np.ndarray) -> np.ndarray:
    """What stays the same over a cycle, in the order of `GIVEN`, shape (values, speeds)."""
    c = cylinder.charge
    p, T = (c.gamma - 1) * state[4] / closed, state[4] * (c.gamma - 1) / (c.R * state[3])
    given = np.vstack([speeds, state[3] - state[5], p, T, outside])
    assert given.shape[0] == len(GIVEN)
    return given


def _ahead(past: list[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """State to try next: the mixture of the last ones whose gain is least (Anderson), lane by lane."""
    (last, gain), following = past[-1], past[-1][0] + past[-1][1]
    if len(past) < 3:
        return following
    leading = following.copy()
    scale = np.abs(last) + 1e-12
    for k in range(last.shape[1]):
        steps = np.array([(x[:, k] - last[:, k]) / scale[:, k] for x, _ in past[:-1]]).T
        turns = np.array([(g[:, k] - gain[:, k]) / scale[:, k] for _, g in past[:-1]]).T
        weights = np.linalg.lstsq(turns, gain[:, k] / scale[:, k], rcond=1e-8)[0]
        ahead = following[:, k] - (steps + turns) @ weights * scale[:, k]
        if np.all(ahead[[0, 1, 3, 4, 6, 7]] > 0.3 * last[[0, 1, 3, 4, 6, 7], k]) and np.all(ahead[[2, 5, 8]] >= 0):
            leading[:, k] = ahead
    return leading


def _summed(
    cylinder: Cylinder,
    omega: float,
    along: tuple[np.ndarray, np.ndarray, tuple[int, ...]],
    outside: np.ndarray,
    history: np.ndarray,
    closure: float,
) -> Breath:
    b, c, (p_in, T_in, _), (phi, room, marks) = cylinder.breathing, cylinder.charge, outside, along
    cv = c.R / (c.gamma - 1)
    sizes: dict[str, Scalar] = dict(zip(VOLUMES, (b.plenum_volume, room, b.manifold_volume), strict=True))
    pressures = {name: (c.gamma - 1) * history[:, 3 * i + 1] / sizes[name] for i, name in enumerate(VOLUMES)}
    temperature = history[:, 4] / (history[:, 3] * cv)
    sums, trapped = dict(zip(STATES[9:], history[-1, 9:].tolist(), strict=True)), float(history[0, 3])
    fresh, drawn = trapped - float(history[0, 5]), sums["m_in"] - sums["b_in"]
    leaving = _leaving(cylinder, outside, phi, pressures["manifold"], history[:, 7] / (history[:, 6] * cv))
    first, last = history[0], history[-1]
    mass, energy, _ = (last[:9] - first[:9]).reshape(3, 3).sum(axis=0)
    left = energy - sums["H_in"] + sums["H_out"] - sums["heat"] + sums["wall_heat"] + sums["work"]
    return Breath(
        omega=omega, phi=phi, marks=marks, pressures=pressures, temperature=temperature, room=room, trapped=trapped,
        residual=1 - fresh / trapped,
        volumetric_efficiency=drawn / (p_in * float(np.ptp(room)) / (c.R * T_in)), drawn=drawn,
        trapping_efficiency=fresh / drawn, T_exhaust=leaving, work=sums["work"], pumping=sums["pumping"],
        heat=sums["heat"], wall_heat=sums["wall_heat"], closure=closure,
        mass_residual=float(abs(mass - sums["m_in"] + sums["m_out"])) / float(first[3]),
        energy_residual=float(abs(left)) / float(first[4]),
    )  # fmt: skip


def _leaving(cylinder: Cylinder, outside: np.ndarray, phi: np.ndarray, p: np.ndarray, T: np.ndarray) -> float:
    """Mean temperature of the gas that leaves the manifold, what flows back not counted [K]."""
    state, c = ca.SX.sym("state", 2), cylinder.charge
    behind = (float(outside[2]), float(outside[1]))
    flow = ca.Function("flow", [state], [orifice_flow(1.0, (state[0], state[1]), behind, c.gamma, c.R)])
    out = np.maximum(np.asarray(flow(np.vstack([p, T]))).ravel(), 0.0)
    return float(np.trapezoid(out * T, phi) / np.trapezoid(out, phi))


_ROUNDS, _BESIDE, _WORTH = 12, 1e-6, 0.5


def repeating(
    cycle: Callable[[np.ndarray, np.ndarray], np.ndarray], state: np.ndarray, sizes: list[int], settled: Pure
) -> np.ndarray | None:
    """States that repeat, lane by lane, or None where Newton finds none or none that is stable [kg, J].

    cycle: states, shape (n, k), and the lane of each, shape (k,), to the states one cycle later; state: where to start
    [kg, J], shape (n, lanes); sizes: for each state the one by which it is measured; settled: relative change over a
    cycle that is none.
    """
    n, lanes = state.shape
    lane = np.tile(np.arange(lanes), n + 1)
    for _ in range(_ROUNDS):
        scale = np.abs(state[sizes])
        steps = np.eye(n)[:, :, None] * (_BESIDE * scale)[:, None, :]  # state, neighbour, lane
        tried = np.concatenate([state[:, None], state[:, None] + steps], axis=1).reshape(n, -1)
        gain = (cycle(tried, lane) - tried).reshape(n, n + 1, lanes)
        if not np.isfinite(gain).all():
            return None
        rest = gain[:, 0] / scale
        slopes = (gain[:, 1:] - gain[:, :1]) / scale[:, None, :] / _BESIDE
        if np.abs(rest).max() < settled:
            stable = all(np.abs(np.linalg.eigvals(slopes[:, :, k] + np.eye(n))).max() < 1 for k in range(lanes))
            return state if stable else None
        try:
            move = np.stack([np.linalg.solve(slopes[:, :, k], -rest[:, k]) for k in range(lanes)], axis=1)
        except np.linalg.LinAlgError:  # a state that no longer answers, as in a plenum of next to nothing
            return None
        # no mass or energy may fall, or rise, by more than its half at once
        share = np.minimum(1.0, _WORTH / np.maximum(np.abs(move).max(axis=0), 1e-300))
        state = state + share * move * scale
    return None

"""One periodic turn of the adiabatic Stirling cycle: cut where a flow turns round, closed by Newton, differentiable.

A short march from the isothermal state shows in which order the two flows turn round. After that the state at the start
and the angles of the cuts are unknowns of one system: the turn closes, the mean pressure is the one wanted, and each
flow is nothing at its cut. Between the cuts the order of the method holds, so twenty steps reach round-off.
"""

import dataclasses
import math
from collections.abc import Callable, Iterator

import casadi as ca
import numpy as np

from mechsym.cycle.closed.run import fold
from mechsym.cycle.kinds.stirling_spaces import STATES, TALLIES, FiveSpaces, evaluated, exchanger_capacity, rates
from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.quantities.units import Scalar

_STEPS, _TURNS = 720, 12
_CLEARANCE = 1e-3  # of the largest volume, in this march alone: nothing is divided by nothing


@record
class Order:
    """Directions of the flows from cut to cut."""

    start: float  #: shaft angle where the turn starts, in the middle of the longest stretch [rad]
    inward: tuple[tuple[bool, bool], ...]  #: for each stretch whether gas flows into expansion and compression space
    turning: tuple[int, ...]  #: for each cut the space whose flow turns round: 0 expansion, 1 compression


def first_guess(spaces: FiveSpaces) -> tuple[Order, np.ndarray]:
    """Order of the flows and state at the start: p by its mean, masses by p_mean K/R [-], angles of the cuts [rad]."""
    grid = np.arange(2 * _STEPS) * math.pi / _STEPS
    volume, slope = (part.T for part in evaluated(spaces.volumes, grid))
    capacity = float(exchanger_capacity(spaces))
    scale = float(spaces.mean_pressure)  # the march has mean pressures near 1
    films = (float(spaces.film_e) / scale, float(spaces.film_c) / scale)
    numbers = (float(spaces.T_h), float(spaces.T_k), float(spaces.gamma), capacity, *films)
    curve = _march(volume + _CLEARANCE * volume.max(axis=0), slope, numbers)
    order, cuts, first = _order(curve[:, 3:] > 0.5, grid[::2])
    state = curve[first, :3] / np.array([curve[:, 0].mean()] * 3)
    state[1:] /= capacity
    return order, np.concatenate([state, cuts])


def _march(volume: np.ndarray, slope: np.ndarray, numbers: tuple[float, ...]) -> np.ndarray:
    """Last turn: pressure [-], masses times R, and the directions, one row a step; midpoint rule."""
    hot, cold = numbers[:2]
    state = (1.0, volume[0, 0] / hot, volume[0, 1] / cold)
    h, rows = 2 * math.pi / _STEPS, np.zeros((_STEPS, 5))
    table = np.column_stack([volume, slope]).tolist()
    for step in range(_TURNS * _STEPS):
        k = 2 * step % (2 * _STEPS)
        slopes, inward = _slopes(state, table[k], numbers)
        rows[step % _STEPS] = (*state, *inward)
        middle = tuple(y + h / 2 * s for y, s in zip(state, slopes, strict=True))
        slopes, _ = _slopes(middle, table[k + 1], numbers)
        state = tuple(y + h * s for y, s in zip(state, slopes, strict=True))
    return rows


def _slopes(
    state: tuple[float, ...], row: list[float], numbers: tuple[float, ...]
) -> tuple[tuple[float, ...], tuple[bool, bool]]:
    (p, *m), (hot, cold, gamma, capacity, *films) = state, numbers
    volume, walls = row[:2], (hot, cold)
    own = [p * volume[j] / m[j] for j in (0, 1)]
    push = [p * row[2 + j] - _film_heat(films[j], m[j], gamma) * (walls[j] - own[j]) for j in (0, 1)]

    def passing(j: int, inward: bool) -> float:
        return walls[j] if inward else own[j]

    inward = []
    for j, other in ((0, 1), (1, 0)):
        # the balance of masses grows with dp, so its sign where this flow is nothing tells on which side dp lies
        dp = -gamma * push[j] / volume[j]
        flow = push[other] + volume[other] * dp / gamma
        inward.append(flow / passing(other, flow > 0) + capacity * dp < 0)
    border = [passing(j, inward[j]) for j in (0, 1)]
    dp = -sum(push[j] / border[j] for j in (0, 1))
    dp /= capacity + sum(volume[j] / (gamma * border[j]) for j in (0, 1))
    return (dp, *((push[j] + volume[j] * dp / gamma) / border[j] for j in (0, 1))), (inward[0], inward[1])


def _film_heat(film: float, mass: float, gamma: float) -> float:
    # heat by kelvin, as much of it as a step can bear (mass counts times R, so its heat capacity is 1/(gamma - 1))
    kappa, step = (gamma - 1) / gamma, 2 * math.pi / _STEPS
    return kappa * film / (1 + film * step * (gamma - 1) / mass)


def _order(inward: np.ndarray, phi: np.ndarray) -> tuple[Order, np.ndarray, int]:
    cuts = list(_cuts(inward, phi))
    angles = np.array([angle for angle, _ in cuts])
    gaps = np.diff(np.append(angles, angles[0] + 2 * math.pi))
    longest = int(np.argmax(gaps))
    start = float(angles[longest] + gaps[longest] / 2)
    first = round(start / (2 * math.pi) * _STEPS)
    ordered = [cuts[(longest + 1 + i) % len(cuts)] for i in range(len(cuts))]
    in_order = tuple(start + (angle - start) % (2 * math.pi) for angle, _ in ordered)
    directions = [(bool(inward[first % _STEPS, 0]), bool(inward[first % _STEPS, 1]))]
    for _, j in ordered:
        e, c = directions[-1]
        directions.append((not e, c) if j == 0 else (e, not c))
    start = first * 2 * math.pi / _STEPS
    order = Order(start=start, inward=tuple(directions), turning=tuple(j for _, j in ordered))
    return order, np.array(in_order), first % _STEPS


def _cuts(inward: np.ndarray, phi: np.ndarray) -> Iterator[tuple[float, int]]:
    h = 2 * math.pi / len(phi)
    for i in range(len(phi)):
        changed = [j for j in (0, 1) if inward[i, j] != inward[i - 1, j]]
        for place, j in enumerate(changed):
            yield float(phi[i] - h * (len(changed) - place) / (len(changed) + 1)), j


STEPS = 32  # between two cuts
_NEWTON, _CLOSED = 30, 1e-11
Build = Callable[[Scalar], FiveSpaces]  # design (k,), symbols or numbers, to spaces


@record
class StirlingTurn:
    """A periodic turn; curves have one entry a node, and a node at each cut twice."""

    phi: np.ndarray  #: shaft angle of the nodes, over one turn from where the integration starts [rad]
    #: absolute pressure [Pa] and its slope [Pa/rad]
    p: np.ndarray
    dp_dphi: np.ndarray
    #: volumes of the working spaces [m^3]
    V_e: np.ndarray
    V_c: np.ndarray
    #: temperatures of the working spaces [K]
    T_e: np.ndarray
    T_c: np.ndarray
    #: flows from the heater and from the cooler into the working spaces, by angle [kg/rad]
    flow_e: np.ndarray
    flow_c: np.ndarray
    stored: np.ndarray  #: heat that the gas has got from the matrix since the start [J]
    mass: float  #: mass of gas in all spaces [kg]
    cuts: np.ndarray  #: angles where a flow turns round [rad]
    sums: dict[str, float]  #: heats into the gas and works of the gas over the turn, by the names of `TALLIES` [J]
    closure: float  #: largest remainder of the closing conditions, each by its size [-]

    @property
    def work(self) -> float:
        """Work of the gas over the turn [J]."""
        return self.sums["W_e"] + self.sums["W_c"]

    @property
    def heat_in(self) -> float:
        """Heat from the hot side over the turn: heater and wall of the expansion space [J]."""
        return self.sums["Q_h"] + self.sums["Q_e"]

    @property
    def mean_indicated(self) -> float:
        """Work by the sum of the swept volumes [Pa]."""
        return self.work / float(np.ptp(self.V_e) + np.ptp(self.V_c))

    @property
    def residual(self) -> float:
        """What the first law leaves over, by the heat from the hot side, or by p V where there is none [-]."""
        heat = sum(self.sums[name] for name in ("Q_h", "Q_r", "Q_k", "Q_e", "Q_c"))
        return (heat - self.work) / (abs(self.heat_in) or float(self.p.max() * np.ptp(self.V_e)))


def turn(spaces: FiveSpaces, steps: int = STEPS) -> StirlingTurn:
    """Solve a periodic turn of numbers; BadInput where none is found."""
    return solver(lambda z: spaces, np.zeros(0), steps)(np.zeros(0))


def solver(build: Build, design: np.ndarray, steps: int = STEPS) -> Callable[[np.ndarray], StirlingTurn]:
    """A function of the design to its turn, each started from the one before. design: where it starts [any]."""
    spaces = build(ca.DM(design))
    names = [f.name for f in dataclasses.fields(FiveSpaces) if f.name != "volumes"]
    numbers: dict[str, Scalar] = {name: float(getattr(spaces, name)) for name in names}
    order, unknown = first_guess(dataclasses.replace(spaces, **numbers))
    parts = _functions(build, len(design), order, steps)
    last = [unknown]

    def solve(values: np.ndarray) -> StirlingTurn:
        last[0], closure = _newton(parts.residual, parts.slope, last[0], values)
        return _turn(parts, last[0], values, closure)

    return solve


@record
class _Solved:
    """Functions of (unknowns, design): remainder, its Jacobian, sums over the turn, nodes."""

    residual: ca.Function
    slope: ca.Function
    sums: ca.Function
    nodes: ca.Function


def _newton(
    residual: ca.Function, slope: ca.Function, unknown: np.ndarray, design: np.ndarray
) -> tuple[np.ndarray, float]:
    size = np.inf
    for _ in range(_NEWTON):
        rest = np.asarray(residual(unknown, design)).ravel()
        before, size = size, float(np.abs(rest).max())
        if not math.isfinite(size) or (size < _CLOSED and size >= before / 4):
            break
        unknown = unknown - np.linalg.solve(np.asarray(slope(unknown, design)), rest)
    if not size < 1e-8:
        raise BadInput(
            f"the Stirling cycle finds no periodic turn (remainder {size:.2g} after {_NEWTON} steps of Newton); check "
            "the volumes and temperatures of [cycle]"
        )
    return unknown, size


def _turn(parts: _Solved, unknown: np.ndarray, design: np.ndarray, closure: float) -> StirlingTurn:
    nodes = np.asarray(parts.nodes(unknown, design))
    names = ("phi", "p", "dp_dphi", "V_e", "V_c", "T_e", "T_c", "flow_e", "flow_c", "stored", "mass")
    curves = dict(zip(names, nodes, strict=True))
    sums = dict(zip(TALLIES, np.asarray(parts.sums(unknown, design)).ravel().tolist(), strict=True))
    mass = float(curves.pop("mass")[0])
    return StirlingTurn(**curves, mass=mass, cuts=np.remainder(unknown[3:], 2 * math.pi), sums=sums, closure=closure)


def _functions(build: Build, size: int, order: Order, steps: int) -> _Solved:
    u, z = ca.MX.sym("u", 3 + len(order.turning)), ca.MX.sym("z", size)
    basis, rest = _Basis(build, size), []
    state, start = basis.start(order)(u, z), u[:3]
    angles = [ca.MX(order.start), *ca.vertsplit(u[3:]), ca.MX(order.start + 2 * math.pi)]
    nodes = []
    for i, inward in enumerate(order.inward):
        ends = ca.vertcat(angles[i], angles[i + 1], z)
        history = ca.horzcat(state, fold(basis.rate(inward), steps)(state, ends))
        along = ca.DM(np.arange(steps + 1) / steps).T
        nodes.append(basis.node(inward).map(steps + 1)(history, along, ca.repmat(ends, 1, steps + 1)))
        state = history[:, -1]
        if i < len(order.turning):
            flows, state = basis.cut(inward, order.turning[i])(state, angles[i + 1], z)
            rest.append(flows)
    residual = ca.vertcat(basis.closing(state, start, z), *rest)
    return _Solved(
        residual=ca.Function("residual", [u, z], [residual]),
        slope=ca.Function("slope", [u, z], [ca.jacobian(residual, u)]),
        sums=ca.Function("sums", [u, z], [state[len(STATES) - len(TALLIES) :]]),
        nodes=ca.Function("nodes", [u, z], [ca.horzcat(*nodes)]),
    )


class _Basis:
    """CasADi functions of one stretch, of the design."""

    def __init__(self, build: Build, size: int) -> None:
        self.z, self.phi, self.y = ca.SX.sym("z", size), ca.SX.sym("phi"), ca.SX.sym("y", len(STATES))
        self.spaces = build(self.z)
        s = self.spaces
        self.kappa = (s.gamma - 1) / s.gamma
        self.mass = s.mean_pressure * exchanger_capacity(s) / s.R
        self.volume = s.V_h + s.V_r + s.V_k

    def kept(self, j: int, state: ca.SX) -> ca.SX:
        """Temperature of a space by p^kappa, from its mass."""
        s = self.spaces
        return state[0] * s.volumes(self.phi)[j] / (s.R * state[1 + j]) / state[0] ** self.kappa

    def start(self, order: Order) -> ca.Function:
        u = ca.SX.sym("u", 3 + len(order.turning))
        s = self.spaces
        state = ca.vertcat(u[0] * s.mean_pressure, u[1:3] * self.mass)
        theta = [
            wall / state[0] ** self.kappa if inward else self.kept(j, state)
            for j, (inward, wall) in enumerate(zip(order.inward[0], (s.T_h, s.T_k), strict=True))
        ]
        y = ca.vertcat(state, *theta, ca.SX.zeros(len(TALLIES)))
        return ca.Function("start", [u, self.z], [ca.substitute(y, self.phi, order.start)])

    def rate(self, inward: tuple[bool, bool]) -> ca.Function:
        slope = ca.Function("slope", [self.phi, self.y, self.z], [rates(self.spaces, inward, self.phi, self.y)[0]])
        s, y, ends = ca.SX.sym("s"), ca.SX.sym("y", len(STATES)), ca.SX.sym("ends", 2 + self.z.numel())
        span = ends[1] - ends[0]
        return ca.Function("rate", [s, y, ends], [slope(ends[0] + s * span, y, ends[2:]) * span])

    def node(self, inward: tuple[bool, bool]) -> ca.Function:
        s, y, phi = self.spaces, self.y, self.phi
        slopes, _ = rates(s, inward, phi, y)
        nothing = 1e-14 * s.R * self.mass  # an empty space has the temperature of what comes in
        own = [
            (y[0] * s.volumes(phi)[j] + nothing * wall) / (s.R * y[1 + j] + nothing)
            if inward[j]
            else y[3 + j] * y[0] ** self.kappa
            for j, wall in enumerate((s.T_h, s.T_k))
        ]
        total = y[1] + y[2] + y[0] * exchanger_capacity(s) / s.R
        here = ca.Function("here", [phi, y, self.z], [
            ca.vertcat(phi, y[0], slopes[0], *s.volumes(phi), *own, slopes[1], slopes[2], y[6], total)
        ])  # fmt: skip
        along, ends = ca.SX.sym("s"), ca.SX.sym("ends", 2 + self.z.numel())
        return ca.Function("node", [y, along, ends], [here(ends[0] + along * (ends[1] - ends[0]), y, ends[2:])])

    def cut(self, inward: tuple[bool, bool], j: int) -> ca.Function:
        """State and angle at the end of a stretch to the flow that must be nothing [-] and the state beyond."""
        s, y = self.spaces, self.y
        flow = rates(s, inward, self.phi, y)[1][j] / (s.mean_pressure * self.volume)
        beyond = ca.vertcat(y[: 3 + j], self.kept(j, y), y[4 + j :]) if inward[j] else y
        return ca.Function("cut", [y, self.phi, self.z], [flow, beyond])

    def closing(self, state: ca.MX, start: ca.MX, z: ca.MX) -> ca.MX:
        """Both masses and the mean pressure, against what they were and should be."""
        s = self.spaces
        scale = ca.Function("scale", [self.z], [ca.vertcat(self.mass, s.mean_pressure)])(z)
        masses = state[1:3] / scale[0] - start[1:3]
        return ca.vertcat(masses, state[len(STATES) - 1] / scale[1] - 1)

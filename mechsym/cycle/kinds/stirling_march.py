"""A short march through the adiabatic Stirling cycle: in which order the flows turn round, and a first guess."""

import math
from collections.abc import Iterator

import numpy as np

from mechsym.cycle.kinds.stirling_equations import FiveSpaces, evaluated, exchanger_capacity
from mechsym.quantities import record

_STEPS, _TURNS = 720, 12
_CLEARANCE = 1e-3  # of the largest volume, in this march alone: nothing is divided by nothing


@record
class Order:
    """Directions of the flows from cut to cut."""

    #: shaft angle where the turn starts, in the middle of the longest stretch [rad]
    start: float
    #: for each stretch whether gas flows into expansion and compression space
    inward: tuple[tuple[bool, bool], ...]
    #: for each cut the space whose flow turns round: 0 expansion, 1 compression
    turning: tuple[int, ...]


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
    found = tuple(start + (angle - start) % (2 * math.pi) for angle, _ in ordered)
    directions = [(bool(inward[first % _STEPS, 0]), bool(inward[first % _STEPS, 1]))]
    for _, j in ordered:
        e, c = directions[-1]
        directions.append((not e, c) if j == 0 else (e, not c))
    start = first * 2 * math.pi / _STEPS
    order = Order(start=start, inward=tuple(directions), turning=tuple(j for _, j in ordered))
    return order, np.array(found), first % _STEPS


def _cuts(inward: np.ndarray, phi: np.ndarray) -> Iterator[tuple[float, int]]:
    h = 2 * math.pi / len(phi)
    for i in range(len(phi)):
        changed = [j for j in (0, 1) if inward[i, j] != inward[i - 1, j]]
        for place, j in enumerate(changed):
            yield float(phi[i] - h * (len(changed) - place) / (len(changed) + 1)), j

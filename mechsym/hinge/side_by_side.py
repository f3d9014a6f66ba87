"""Verdicts on the guides of many springs for one torque: the numbers of `cut` and `judge`, computed side by side.

Every guide has its own pieces, halved as in `periodic.fit`; what differs from one guide after the other is the order
of sums, so the numbers agree to about 1e-10 of theirs.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import GuideParameters, Limits, refuse_open_track
from mechsym.hinge.limits import Verdict, station_of, verdict
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.springs.face import Lettered, Spring, lettered
from mechsym.hinge.springs.law_path import FULL, can_be_given, work_range
from mechsym.periodic import DEGREE, first_edges, halved
from mechsym.quantities import record

_SHARES = (1 - np.cos(np.linspace(0, np.pi, 65))) / 2  # of a piece, as in `contact.at_pieces`
_CACHED = 30_000  # points of all guides at once that stay in the cache
_POWERS = np.arange(DEGREE + 1, -1, -1)
_TO_VALUES = [_SHARES[:, None] ** _POWERS[k:] for k in range(3)]


@record
class GuideDesign:
    """What decides a guide beside the torque."""

    spring: Spring
    choices: GuideParameters
    rollers: RollerParameters
    limits: Limits


@record
class _Tracks:
    """Pieces of the paths, those of one guide after those of the other, by the share of a piece."""

    who: np.ndarray  #: shape (pieces,): Which guide [-]
    theta: np.ndarray  #: shape (pieces, 65): Angles, as in `contact.at_pieces` [rad]
    values: tuple[np.ndarray, ...]  #: Path [m] and its two derivatives [m/rad], [m/rad^2] there
    closure: np.ndarray  #: shape (guides,): Gap of each path after a period, before it is closed [m]


def verdicts(wanted: Balance, designs: Sequence[GuideDesign]) -> list[Verdict | None]:
    """Verdicts on guides for one torque; None where no guide can be cut, `judge` of `cut` says why."""
    groups: dict[tuple[object, ...], list[int]] = {}
    for i, d in enumerate(designs):
        if d.spring.state:  # its path is no function of the work alone
            continue
        key = type(d.spring), d.choices.arrangement, d.choices.start, d.choices.shaft_ratio
        groups.setdefault(key, []).append(i)
    results: list[Verdict | None] = [None] * len(designs)
    block = max(1, _CACHED // (len(_SHARES) * len(wanted.torque.x)))
    for members in groups.values() if can_be_given(wanted) else ():
        for k in range(0, len(members), block):
            some = members[k : k + block]
            for i, one in zip(some, _alike(wanted, [designs[i] for i in some]), strict=True):
                results[i] = one
    return results


def _alike(wanted: Balance, designs: list[GuideDesign]) -> list[Verdict | None]:
    """The same for springs of one law in guides that differ in numbers only."""
    choices = designs[0].choices
    refuse_open_track(choices, wanted.period)
    good = _can_be_cut(wanted, designs)
    results: list[Verdict | None] = [None] * len(designs)
    if good.any():
        kept = [d for d, fine in zip(designs, good, strict=True) if fine]
        for i, one in zip(np.flatnonzero(good).tolist(), _judged(wanted, kept), strict=True):
            results[i] = one
    return results


def _stacked(records: Sequence[Lettered]) -> Lettered:
    """Many records of one kind as one, its numbers arrays of shape (n,), anything else as the first has it."""
    first = vars(records[0])
    numbers = [name for name, value in first.items() if not isinstance(value, str)]
    return lettered(records[0], {name: np.array([getattr(r, name) for r in records]) for name in numbers})


def _chosen(springs: Spring, who: np.ndarray) -> Spring:
    return lettered(springs, {name: values[who] for name, values in vars(springs).items()})


def _energies(wanted: Balance, springs: Spring, choices: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Stored energy at the start, the smallest, the largest [J]."""
    low, high = work_range(wanted)
    at_start = 0.0 * choices.rho0
    if choices.start != "as_printed":
        at_start = springs.energy(choices.z_margin) + high
    return at_start, at_start - high, at_start - low


def _can_be_cut(wanted: Balance, designs: list[GuideDesign]) -> np.ndarray:
    """As `law_path.status`, for the springs of a group."""
    springs, choices = _stacked([d.spring for d in designs]), _stacked([d.choices for d in designs])
    with np.errstate(all="ignore"):  # what cannot be cut need not have a closing
        _, least, most = _energies(wanted, springs, choices)
        held = (choices.z_margin < springs.H) & (most < springs.energy_high) & (least > springs.energy_low)
        z_max = springs.closing(np.where(held, most, 0.0))
    return held & (z_max < FULL * springs.H) & (choices.rho0 - z_max / choices.rollers > 0)


def _judged(wanted: Balance, designs: list[GuideDesign]) -> list[Verdict]:
    """Verdicts on guides that can be cut."""
    springs, choices = _stacked([d.spring for d in designs]), _stacked([d.choices for d in designs])
    _, least, most = _energies(wanted, springs, choices)
    z = np.stack([springs.closing(least), springs.closing(most)])
    extremes = choices.rho0 - z / choices.rollers
    tracks = _tracks(wanted, springs, choices, designs[0].choices.shaft_ratio)
    cuts = np.append(np.flatnonzero(np.diff(tracks.who, prepend=-1)), len(tracks.who))
    judged = []
    for i, d in enumerate(designs):
        a, b = cuts[i : i + 2]
        values = [column[a:b].ravel() for column in tracks.values]
        along = station_of(d.spring, d.choices, d.rollers, wanted.omega, values)
        gap = float(tracks.closure[i])
        judged.append(verdict(along, extremes[:, i], tracks.theta[a:b].ravel(), gap, d.choices, d.limits))
    return judged


def _tracks(wanted: Balance, springs: Spring, choices: Any, ratio: float) -> _Tracks:
    """Paths as `law_path`: the slope is fitted, the path is its exact integral and closed."""
    c, count, period = choices.rollers, len(choices.rho0), wanted.period * ratio
    at_start = _energies(wanted, springs, choices)[0]

    def z(theta: np.ndarray, who: np.ndarray) -> np.ndarray:
        return np.asarray(_chosen(springs, who).closing(at_start[who] - wanted.work(theta / ratio)))

    def slope(theta: np.ndarray, who: np.ndarray) -> np.ndarray:
        force = _chosen(springs, who).force(z(theta, who))
        return np.asarray(wanted.torque(theta / ratio) / (ratio * c * force))

    pieces = halved(slope, first_edges(wanted.torque.x * ratio, period), count)
    order = np.lexsort((pieces[1], pieces[0]))
    who, left, width = (p[order] for p in pieces[:3])
    rows = pieces[3][:, order]
    whole = width * rows / _POWERS[:-1, None]
    mean = np.bincount(who, whole.sum(axis=0)) / period
    rows[-1] -= mean[who]
    whole[-1] -= width * mean[who]
    before = np.cumsum(whole.sum(axis=0)) - whole.sum(axis=0)
    # the sums of one guide end at 0, where those of the next begin
    before -= before[np.flatnonzero(np.diff(who, prepend=-1))][who]
    placed = np.bincount(who, choices.rho0[who] - z(left, who) / c - before) / np.bincount(who)
    powers = [np.vstack([whole, before + placed[who]]), rows, rows[:-1] * _POWERS[1:-1, None] / width]
    return _Tracks(
        who=who,
        theta=left[:, None] + width[:, None] * _SHARES,
        values=tuple(row.T @ to.T for row, to in zip(powers, _TO_VALUES, strict=True)),
        closure=np.abs(mean) * period,
    )

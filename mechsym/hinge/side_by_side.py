"""Verdicts on the guides of many springs for one torque: the numbers of `cut` and `judge`, computed side by side.

Every guide has its own pieces, halved as in `periodic.fit`; what differs from one guide after the other is the order
of sums, so the numbers agree to about 1e-10 of theirs.
"""

import dataclasses
from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np

from mechsym.hinge import rollers as _rollers
from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import ROLLERS, GuideParameters, Limits, refuse_open_track
from mechsym.hinge.law_path import FULL, LawSpring, can_be_given, work_range
from mechsym.hinge.limits import Verdict, highest, undercut_radius, verdict
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.springs import LAWS, SpringLaw
from mechsym.periodic.halving import DEGREE, first_edges, halved
from mechsym.quantities import record

contact: Any = _rollers  # its formulas take parameters that are arrays too
_SHARES = (1 - np.cos(np.linspace(0, np.pi, 65))) / 2  # of a piece, as in `contact.at_pieces`
_CACHED = 30_000  # points of all guides at once that stay in the cache
_POWERS = np.arange(DEGREE + 1, -1, -1)
_TO_VALUES = [_SHARES[:, None] ** _POWERS[k:] for k in range(3)]


@record
class GuideDesign:
    """What decides a guide beside the torque."""

    spring: LawSpring
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
    groups: dict[Any, list[int]] = {}
    for i, d in enumerate(designs):
        key = type(d.spring), d.choices.arrangement, d.choices.start, d.choices.shaft_ratio
        groups.setdefault(key, []).append(i)
    found: list[Verdict | None] = [None] * len(designs)
    block = max(1, _CACHED // (len(_SHARES) * len(wanted.torque.x)))
    for members in groups.values() if can_be_given(wanted) else ():
        for k in range(0, len(members), block):
            some = members[k : k + block]
            for i, one in zip(some, _alike(wanted, [designs[i] for i in some]), strict=True):
                found[i] = one
    return found


def _alike(wanted: Balance, designs: list[GuideDesign]) -> list[Verdict | None]:
    """The same for springs of one law in guides that differ in numbers only."""
    choices = designs[0].choices
    refuse_open_track(choices, wanted.period)
    good = _can_be_cut(wanted, designs)
    found: list[Verdict | None] = [None] * len(designs)
    if good.any():
        kept = [d for d, fine in zip(designs, good, strict=True) if fine]
        for i, numbers in zip(np.flatnonzero(good).tolist(), _numbers(wanted, kept), strict=True):
            d = designs[i]
            found[i] = verdict(numbers, d.spring, d.choices, d.rollers, d.limits)
    return found


def _columns(records: Sequence[Any]) -> SimpleNamespace:
    """The numbers of records of one kind as arrays of shape (n,), anything else as the first has it."""
    first = records[0]
    return SimpleNamespace(**{
        f.name: np.array([getattr(r, f.name) for r in records]) if isinstance(getattr(first, f.name), float)
        else getattr(first, f.name) for f in dataclasses.fields(first)
    })  # fmt: skip


def _law(kind: type, spring: SimpleNamespace, who: Any = slice(None)) -> SpringLaw:
    return LAWS[kind](SimpleNamespace(**{name: values[who] for name, values in vars(spring).items()}))


def _energies(wanted: Balance, law: SpringLaw, choices: SimpleNamespace) -> tuple[Any, Any, Any]:
    """Stored energy at the start, the smallest, the largest [J]."""
    low, high = work_range(wanted)
    at_start = 0.0 * choices.rho0
    if choices.start != "as_printed":
        at_start = law.energy(choices.z_margin) + high
    return at_start, at_start - high, at_start - low


def _can_be_cut(wanted: Balance, designs: list[GuideDesign]) -> np.ndarray:
    """As `law_path.status`, for the springs of a group."""
    spring, choices = _columns([d.spring for d in designs]), _columns([d.choices for d in designs])
    law = _law(type(designs[0].spring), spring)
    with np.errstate(all="ignore"):  # what cannot be cut need not have a closing
        _, least, most = _energies(wanted, law, choices)
        held = (choices.z_margin < spring.H) & (most < law.energy_high) & (least > law.energy_low)
        z_max = law.closing(np.where(held, most, 0.0))
    return held & (z_max < FULL * law.z_high) & (choices.rho0 - z_max / ROLLERS[choices.arrangement] > 0)


def _numbers(wanted: Balance, designs: list[GuideDesign]) -> list[dict[str, Any]]:
    """Numbers of guides that can be cut, by the names of `Verdict`."""
    spring, choices, rollers = (_columns([getattr(d, n) for d in designs]) for n in ("spring", "choices", "rollers"))
    kind, c = type(designs[0].spring), ROLLERS[choices.arrangement]
    law = _law(kind, spring)
    _, least, most = _energies(wanted, law, choices)
    z_min, z_max = law.closing(least), law.closing(most)
    tracks = _tracks(wanted, kind, spring, choices, designs[0].choices.shaft_ratio)
    ends = np.append(np.flatnonzero(np.diff(tracks.who, prepend=-1)), len(tracks.who))
    curves = _contact(wanted, _law(kind, spring, tracks.who[:, None]), choices, rollers, tracks)
    found = []
    for i, (a, b) in enumerate(zip(ends, ends[1:], strict=False)):
        theta = tracks.theta[a:b].ravel()
        top = {name: highest(theta, values[a:b].ravel()) for name, values in curves.items() if name != "curvature"}
        couple = top["reaction"] * (rollers.plane_offset[i] if choices.arrangement == "two_tracks" else 0.0)
        found.append({
            "rho_min": float(choices.rho0[i] - z_max[i] / c), "rho_max": float(choices.rho0[i] - z_min[i] / c),
            "z_min": float(z_min[i]), "z_max": float(z_max[i]),
            "spring_force_max": float(law.force(z_max)[i]),
            "spring_pressure_max": None if law.pressure is None else float(law.pressure(z_max)[i]),
            "pressure_angle_max": top["angle"], "curvature_radius_min": 1 / top["bend"],
            "undercut_radius": undercut_radius(curves["curvature"][a:b]), "roller_reaction_max": top["reaction"],
            "hertz_stress_max": top["stress"], "tilting_couple_max": float(couple),
            "closure": float(tracks.closure[i]),
        })  # fmt: skip
    return found


def _contact(
    wanted: Balance, law: SpringLaw, choices: SimpleNamespace, rollers: SimpleNamespace, tracks: _Tracks
) -> dict[str, np.ndarray]:
    """What is largest somewhere, at the points of all pieces; as `contact.at_pieces`."""
    rho, drho, d2rho = tracks.values
    at = SimpleNamespace(**{
        name: values[tracks.who][:, None] if isinstance(values, np.ndarray) else values
        for name, values in vars(rollers).items()
    })  # fmt: skip
    rho0, c = choices.rho0[tracks.who][:, None], ROLLERS[choices.arrangement]
    kappa = contact.curvature(rho, drho, d2rho)
    outwards = law.force(c * (rho0 - rho))
    if rollers.moving_mass.any():
        outwards = outwards + at.moving_mass * contact.inertia_force(rho, d2rho, wanted.omega * choices.shaft_ratio[0])
    N = contact.reaction(outwards, rho, drho)
    return {
        "angle": np.abs(contact.pressure_angle(rho, drho)), "bend": np.abs(kappa), "curvature": kappa, "reaction": N,
        "stress": contact.hertz_stress(N, kappa, at),
    }  # fmt: skip


def _tracks(wanted: Balance, kind: type, spring: SimpleNamespace, choices: SimpleNamespace, ratio: float) -> _Tracks:
    """Paths as `law_path`: the slope is fitted, the path is its exact integral and closed."""
    c, count, period = ROLLERS[choices.arrangement], len(choices.rho0), wanted.period * ratio
    at_start = _energies(wanted, _law(kind, spring), choices)[0]

    def z(theta: np.ndarray, who: np.ndarray) -> np.ndarray:
        return np.asarray(_law(kind, spring, who).closing(at_start[who] - wanted.work(theta / ratio)))

    def slope(theta: np.ndarray, who: np.ndarray) -> np.ndarray:
        force = _law(kind, spring, who).force(z(theta, who))
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

r"""The limits of many guides at once: one compiled function of whatever is free about spring, guide, rollers, limits.

    kernel = design_kernel(wanted, spring, choices, rollers, limits, ["spring.p0", "spring.A"])
    kernel.margins(values)      values (n, 2) -> margins (n, m), the share of each limit that is left
    kernel.gradients(values)    -> (n, m, 2)

The formulas are those of `springs`, `rollers` and `limits`, written out once for symbols. No path is fitted: closing,
force and slope follow from the work at each angle, and the torque's own slope gives the second derivative,

.. math:: \rho' = \frac{M}{c F}, \qquad \rho'' = \frac{M'}{c F} + \frac{M^2 F_z}{c F^3}

with M the torque on the guide's shaft. Largest values are those of a parabola through three neighbours, as in `judge`;
margins differ from its own by less than 1e-4, so what is kept has to be judged once more.
"""

import dataclasses
import warnings
from collections.abc import Callable, Sequence
from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np

from mechsym import periodic
from mechsym.errors import BadInput, suggest
from mechsym.hinge import rollers as _rollers
from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import ROLLERS, GuideParameters
from mechsym.hinge.kernel_spring import coordinate
from mechsym.hinge.law_path import FULL, LawSpring
from mechsym.hinge.limits import Limits
from mechsym.hinge.rollers import RollerParameters
from mechsym.native import compiled, marcher
from mechsym.quantities import record

_POINTS, _WIDE = 33, 0.5  # angles on a piece of the torque, and the width from which it has so many [rad]
_BLOCK = 4096  # designs at once
track: Any = _rollers  # its formulas take symbols too
_PEAKS = 4  # tangent of the pressure angle, curvature inwards, reaction, contact pressure


@record
class DesignKernel:
    """Margins of many designs."""

    free: tuple[str, ...]  #: What may differ between designs, as section.field
    limits: tuple[str, ...]  #: Limits that have a margin, named as the checks of `judge`
    #: Values (n, free) [SI] -> share of each limit that is left (n, limits) [-]; -1 throughout where no guide can be
    #: cut, infinite where a limit asks nothing
    margins: Callable[[np.ndarray], np.ndarray]
    #: Values (n, free) [SI] -> derivatives of the margins (n, limits, free) [1/SI]; 0 where there is no guide
    gradients: Callable[[np.ndarray], np.ndarray]


@record
class _KernelParts:
    angles: np.ndarray  #: shape (k,): Of the guide's shaft; an angle that stands twice is a kink [rad]
    stages: np.ndarray  #: shape (k, 3): Torque on that shaft [N*m], its slope [N*m/rad], work [J]
    march: Callable[[np.ndarray], np.ndarray]  #: Values (free, n) to the index of each peak (4, n)
    values: Any  #: Stage and values to the four quantities there
    slopes: Any  #: The same to their derivatives
    finish: Any  #: Values and peaks to margins, the last is above 0 where there is a guide
    finish_slopes: Any
    names: tuple[str, ...]


def design_kernel(
    wanted: Balance, spring: LawSpring, choices: GuideParameters, rollers: RollerParameters, limits: Limits,
    free: Sequence[str],
) -> DesignKernel:  # fmt: skip
    """Compile the limits of guides for one torque.

    Parameters
    ----------
    free : sequence of str
        Fields that differ between designs: `spring.p0`, `guide.rho0`, `rollers.radius`, `limits.closing_share`, ..

    Raises
    ------
    BadInput
        A name is no number of these sections
    """
    if not isinstance(spring, LawSpring):
        raise BadInput("the limits of many guides at once take springs whose force follows from the closing alone")
    given = {"spring": spring, "guide": choices, "rollers": rollers, "limits": limits}
    symbols = {name: ca.SX.sym(name.replace(".", "_")) for name in _checked(free, given)}
    letters = {
        section: SimpleNamespace(**{
            f.name: symbols.get(f"{section}.{f.name}", getattr(values, f.name)) for f in dataclasses.fields(values)
        })
        for section, values in given.items()
    }  # fmt: skip
    with warnings.catch_warnings():
        # numpy's functions take symbols; casadi announces that it may do so otherwise one day
        warnings.simplefilter("ignore", FutureWarning)
        parts = _parts(wanted, type(spring), choices, letters, list(symbols.values()))
    return DesignKernel(
        free=tuple(symbols),
        limits=parts.names,
        margins=lambda values: _in_blocks(lambda v: _margins(parts, v)[0], _columns(values, symbols)),
        gradients=lambda values: _in_blocks(lambda v: _gradients(parts, v), _columns(values, symbols)),
    )


def _checked(free: Sequence[str], given: dict[str, Any]) -> list[str]:
    known = [
        f"{section}.{f.name}"
        for section, values in given.items()
        for f in dataclasses.fields(values)
        if isinstance(getattr(values, f.name), float) and f"{section}.{f.name}" != "guide.shaft_ratio"
    ]
    for name in free:
        if name not in known:
            raise BadInput(f"{name} cannot be free in a map of guides; {suggest(name, known)}")
    if len(set(free)) < len(free) or not free:
        raise BadInput("name what is free, each of it once")
    return list(free)


def _columns(values: np.ndarray, symbols: dict[str, Any]) -> np.ndarray:
    columns = np.ascontiguousarray(np.asarray(values, dtype=float).T)
    if columns.ndim != 2 or len(columns) != len(symbols):
        raise BadInput(f"values have shape {np.shape(values)}; it must be (n, {len(symbols)}): {', '.join(symbols)}")
    return columns


def _in_blocks(function: Callable[[np.ndarray], np.ndarray], columns: np.ndarray) -> np.ndarray:
    parts = [columns[:, k : k + _BLOCK] for k in range(0, columns.shape[1], _BLOCK)]
    return np.concatenate([function(np.ascontiguousarray(p)) for p in parts])


def _parts(
    wanted: Balance,
    kind: type[LawSpring],
    choices: GuideParameters,
    letters: dict[str, SimpleNamespace],
    p: list[ca.SX],
) -> _KernelParts:
    ratio = choices.shaft_ratio
    phi, stages = _stages(wanted, ratio)
    low, _, high, _ = periodic.extremes(wanted.work)
    air = coordinate(kind, letters["spring"])
    zm = letters["guide"].z_margin
    at_start = 0.0 if choices.start == "as_printed" else air.energy(air.of_closing(zm)) + high
    stage, lane, c = ca.SX.sym("stage", 3), ca.vertcat(*p), ROLLERS[choices.arrangement]
    found = ca.vertcat(*_over_the_turn(stage, air, at_start, c, wanted.omega * ratio, letters))
    peaks = ca.SX.sym("peaks", _PEAKS)
    margins = _of_limits(kind, c, air, at_start - low, at_start - high, peaks, letters)
    values = ca.vertcat(*margins.values())
    return _KernelParts(
        angles=phi * ratio,
        stages=stages,
        march=_march(stage, lane, found, stages),
        values=compiled(ca.Function("design_values", [stage, lane], [found])),
        slopes=compiled(ca.Function("design_slopes", [stage, lane], [ca.jacobian(found, lane)])),
        finish=compiled(ca.Function("design_margins", [lane, peaks], [values])),
        finish_slopes=compiled(ca.Function(
            "design_margin_slopes", [lane, peaks], [ca.jacobian(values, lane), ca.jacobian(values, peaks)]
        )),
        names=tuple(name for name in margins if name != "cut"),
    )  # fmt: skip


def _stages(wanted: Balance, ratio: float) -> tuple[np.ndarray, np.ndarray]:
    """Crank angles (k,) [rad], both ends of every piece among them, and what is the same for all designs there."""
    edges, functions = wanted.torque.x, (wanted.torque, wanted.torque.derivative(), wanted.work)
    phi, rows = [], []
    for i, (a, b) in enumerate(zip(edges, edges[1:], strict=False)):
        count = int(np.clip(np.ceil(_POINTS * (b - a) / _WIDE), 7, _POINTS))
        u = (b - a) * (1 - np.cos(np.linspace(0, np.pi, count))) / 2
        phi.append(a + u)
        rows.append(np.stack([np.polyval(f.c[:, i], u) for f in functions], axis=1))
    return np.concatenate(phi), np.concatenate(rows) / [ratio, ratio**2, 1.0]


def _march(stage: ca.SX, lane: ca.SX, found: ca.SX, stages: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Where around the turn each quantity is largest."""
    state, number = ca.SX.sym("state", 2 * _PEAKS), ca.SX.sym("number")
    best, place = state[:_PEAKS], state[_PEAKS:]
    larger = found > best
    step = ca.vertcat(ca.fmax(best, found), *[ca.if_else(larger[i], number, place[i]) for i in range(_PEAKS)])
    run = marcher(ca.Function("design_turn", [state, ca.vertcat(stage, number), lane], [step]))
    numbered = np.column_stack([stages, np.arange(len(stages), dtype=float)])

    def places(columns: np.ndarray) -> np.ndarray:
        start = np.zeros((2 * _PEAKS, columns.shape[1]))
        start[:_PEAKS] = -np.inf
        return run(start, numbered, columns)[0][_PEAKS:].astype(int)

    return places


def _over_the_turn(
    stage: ca.SX, air: SimpleNamespace, at_start: Any, c: int, omega: float, letters: dict[str, SimpleNamespace]
) -> list[Any]:
    """What has its largest value somewhere around the turn."""
    M, dM, W = stage[0], stage[1], stage[2]
    z, at = ca.SX.sym("z"), air.z(air.at(at_start - W))
    law = air.force(z)
    F, F_z = (ca.substitute(of, z, at) for of in (law, ca.gradient(law, z)))
    rho, drho = letters["guide"].rho0 - at / c, M / (c * F)
    d2rho = dM / (c * F) + M * F_z * drho / F**2
    rollers: Any = letters["rollers"]
    kappa = track.curvature(rho, drho, d2rho)
    N = track.reaction(F + rollers.moving_mass * track.inertia_force(rho, d2rho, omega), rho, drho)
    return [np.abs(drho) / rho, -kappa, N, track.hertz_stress(N, kappa, rollers)]


def _of_limits(
    kind: type[LawSpring], c: int, air: SimpleNamespace, most: Any, least: Any, peaks: ca.SX,
    letters: dict[str, SimpleNamespace],
) -> dict[str, Any]:  # fmt: skip
    """Margins by the names of the checks, and under `cut` a number above 0 where there is a guide."""
    s, guide, rollers, limits = (letters[name] for name in ("spring", "guide", "rollers", "limits"))
    z_max, z_min = air.z(air.at(most)), air.z(air.at(least))
    rho_min = guide.rho0 - z_max / c

    def left(value: Any, limit: Any) -> Any:
        return (limit - value) / ca.if_else(limit > 0, limit, value)

    found = {
        "free_height": ca.if_else(z_min < -1e-12 * s.H, z_min / s.H, ca.inf),
        "closing": left(z_max / s.H, limits.closing_share),
        "pressure_angle": left(track.pressure_angle(1.0, peaks[0]), limits.pressure_angle),
        "undercut": ca.if_else(peaks[1] > 0, 1 - (rollers.radius + limits.profile_radius) * peaks[1], ca.inf),
        "roller_reaction": left(peaks[2], limits.roller_reaction),
        "centre": left(rollers.radius, rho_min),
        "hertz_stress": left(peaks[3], limits.hertz_stress),
        "cut": ca.fmin(ca.fmin(air.force(z_min), FULL * s.H - z_max), rho_min),
    }
    if air.pressure is not None:
        found["spring_pressure"] = left(air.pressure(z_max), limits.spring_pressure)
        if c == 2:
            found["room"] = left(rollers.radius, guide.rho0 - s.H / 2)
    return {name: ca.SX(value) for name, value in sorted(found.items(), key=lambda pair: pair[0] == "cut")}


def _margins(parts: _KernelParts, columns: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Margins (n, m); peaks (4, n), the weights (4, 3, n) of three neighbours, and the place (4, n) of the middle."""
    places = parts.march(columns)
    tops = [_highest(parts, columns, k, places[k]) for k in range(_PEAKS)]
    peaks, weights, middle = (np.stack([t[i] for t in tops]) for i in range(3))
    with np.errstate(all="ignore"):
        found = parts.finish.batch(*columns, *peaks)
    good = found[-1] > 0  # not a number counts as no guide
    margins = np.where(good, found[:-1], -1.0).T
    margins[good & np.isinf(peaks[3]), parts.names.index("hertz_stress")] = np.inf
    return margins, peaks, weights, middle


def _highest(
    parts: _KernelParts, columns: np.ndarray, k: int, i: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Tops of the parabolas around the highest points of a quantity, as `limits.highest`, with their weights."""
    middle = np.clip(i, 1, len(parts.angles) - 2)
    around = np.stack([middle - 1, middle, middle + 1])
    before, after = np.diff(parts.angles[around], axis=0)
    q = np.stack([parts.values.batch(*np.ascontiguousarray(parts.stages[at].T), *columns)[k] for at in around])
    plain = np.zeros_like(q)
    plain[1 + i - middle, np.arange(len(i))] = 1.0
    with np.errstate(all="ignore"):
        rise, fall = np.stack([-1 / before, 1 / before, 0 * before]), np.stack([0 * after, -1 / after, 1 / after])
        bend, tilt = (fall - rise) / (before + after), rise + (fall - rise) / (before + after) * before
        b, t = (bend * q).sum(axis=0), (tilt * q).sum(axis=0)
        top, weights = q[1] - t**2 / (4 * b), plain - t / (2 * b) * tilt + (t / (2 * b)) ** 2 * bend
    smooth = (i == middle) & (before > 0) & (after > 0) & (b < 0) & np.isfinite(q).all(axis=0)
    return np.where(smooth, top, q[1 + i - middle, np.arange(len(i))]), np.where(smooth, weights, plain), middle


def _gradients(parts: _KernelParts, columns: np.ndarray) -> np.ndarray:
    margins, peaks, weights, places = _margins(parts, columns)
    (k, n), m, stages = columns.shape, margins.shape[1], parts.stages
    of_peaks = np.zeros((_PEAKS, k, n))
    for peak in range(_PEAKS):
        for shift in (-1, 0, 1):
            here = stages[places[peak] + shift].T
            jacobian = parts.slopes.batch(*np.ascontiguousarray(here), *columns).reshape(k, _PEAKS, n)[:, peak]
            of_peaks[peak] += np.where(weights[peak, shift + 1] != 0, weights[peak, shift + 1] * jacobian, 0.0)
    found = parts.finish_slopes.batch(*columns, *peaks)
    direct, through = found[: k * (m + 1)].reshape(k, m + 1, n), found[k * (m + 1) :].reshape(_PEAKS, m + 1, n)
    total = direct + np.einsum("pmn,pkn->kmn", through, of_peaks)
    total = np.moveaxis(total[:, :m], (2, 1, 0), (0, 1, 2))
    return np.where(np.isfinite(margins)[..., None] & ~(margins == -1.0).all(axis=1)[:, None, None], total, 0.0)

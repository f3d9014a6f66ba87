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
import functools
import warnings
from collections.abc import Callable, Sequence
from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np

from mechsym import periodic
from mechsym.errors import BadInput, suggest
from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import ROLLERS, GuideParameters, Limits
from mechsym.hinge.kernel_formulas import coordinate, of_limits, over_the_turn
from mechsym.hinge.law_path import LawSpring
from mechsym.hinge.rollers import RollerParameters
from mechsym.native import compiled, compiled_all, marcher
from mechsym.quantities import record

_POINTS, _WIDE = 33, 0.5  # angles on a piece of the torque, and the width from which it has so many [rad]
_BLOCK = 4096  # designs at once
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
    march: Callable[[np.ndarray], np.ndarray]  #: Lanes (all, n) to the index of each peak (4, n)
    values: Any  #: Stage and lanes to the four quantities there
    finish: Any  #: Lanes and peaks to margins, the last is above 0 where there is a guide
    slopes: Callable[[], tuple[Any, Any]]  #: Derivatives of both by what is free
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
    chosen, numbers = _checked(free, given), _numbers_of(given)
    # all numbers come as lanes, so that one compiled function serves every case of a kind
    low, _, high, _ = periodic.extremes(wanted.work)
    lanes = numbers | {"low": low, "high": high, "omega": wanted.omega * choices.shaft_ratio}
    symbols = {name: ca.SX.sym(name.replace(".", "_")) for name in lanes}
    letters = {
        section: SimpleNamespace(
            **{f.name: symbols.get(f"{section}.{f.name}", getattr(values, f.name)) for f in dataclasses.fields(values)}
        )
        for section, values in given.items()
    } | {"torque": SimpleNamespace(low=symbols["low"], high=symbols["high"], omega=symbols["omega"])}
    with warnings.catch_warnings():
        # numpy's functions take symbols; casadi announces that it may do so otherwise one day
        warnings.simplefilter("ignore", FutureWarning)
        parts = _parts(wanted, type(spring), choices, letters, list(symbols.values()), [symbols[n] for n in chosen])
    return DesignKernel(
        free=tuple(chosen),
        limits=parts.names,
        margins=lambda values: _in_blocks(lambda v: _margins(parts, v)[0], values, lanes, chosen),
        gradients=lambda values: _in_blocks(lambda v: _gradients(parts, v), values, lanes, chosen),
    )


def _numbers_of(given: dict[str, Any]) -> dict[str, float]:
    return {
        f"{section}.{f.name}": getattr(values, f.name)
        for section, values in given.items()
        for f in dataclasses.fields(values)
        if isinstance(getattr(values, f.name), float) and f"{section}.{f.name}" != "guide.shaft_ratio"
    }


def _checked(free: Sequence[str], given: dict[str, Any]) -> list[str]:
    known = _numbers_of(given)
    for name in free:
        if name not in known:
            raise BadInput(f"{name} cannot be free in a map of guides; {suggest(name, known)}")
    if len(set(free)) < len(free) or not free:
        raise BadInput("name what is free, each of it once")
    return list(free)


def _in_blocks(
    function: Callable[[np.ndarray], np.ndarray], values: np.ndarray, lanes: dict[str, float], names: list[str]
) -> np.ndarray:
    """A function of lanes (all, n) for designs (n, free), a block after the other."""
    given = np.asarray(values, dtype=float)
    if given.ndim != 2 or given.shape[1] != len(names):
        raise BadInput(f"values have shape {np.shape(values)}; it must be (n, {len(names)}): {', '.join(names)}")
    at, found = [list(lanes).index(name) for name in names], []
    for k in range(0, max(len(given), 1), _BLOCK):
        block = given[k : k + _BLOCK]
        columns = np.repeat(np.array([*lanes.values()])[:, None], len(block), axis=1)
        columns[at] = block.T
        found.append(function(columns))
    return np.concatenate(found)


def _parts(
    wanted: Balance,
    kind: type[LawSpring],
    choices: GuideParameters,
    letters: dict[str, SimpleNamespace],
    p: list[ca.SX],
    free: list[ca.SX],
) -> _KernelParts:
    ratio = choices.shaft_ratio
    phi, stages = _stages(wanted, ratio)
    air, of = coordinate(kind, letters["spring"]), letters["torque"]
    zm = letters["guide"].z_margin
    at_start = 0.0 if choices.start == "as_printed" else air.energy(air.of_closing(zm)) + of.high
    stage, lane, c = ca.SX.sym("stage", 3), ca.vertcat(*p), ROLLERS[choices.arrangement]
    found = ca.vertcat(*over_the_turn(stage, air, at_start, c, letters))
    peaks = ca.SX.sym("peaks", _PEAKS)
    margins = of_limits(kind, c, air, at_start - of.low, at_start - of.high, peaks, letters)
    values, chosen = ca.vertcat(*margins.values()), ca.vertcat(*free)

    def slopes() -> tuple[Any, Any]:
        by = [ca.jacobian(values, chosen), ca.jacobian(values, peaks)]
        made = compiled_all({
            "slopes": ca.Function("design_slopes", [stage, lane], [ca.jacobian(found, chosen)]),
            "ends": ca.Function("design_margin_slopes", [lane, peaks], by),
        })  # fmt: skip
        return made["slopes"], made["ends"]

    return _KernelParts(
        angles=phi * ratio,
        stages=stages,
        march=_march(stage, lane, found, stages),
        values=compiled(ca.Function("design_values", [stage, lane], [found])),
        finish=compiled(ca.Function("design_margins", [lane, peaks], [values])),
        slopes=functools.cache(slopes),
        names=tuple(name for name in margins if name != "cut"),
    )


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
    of_values, of_margins = parts.slopes()
    n, m, stages = columns.shape[1], margins.shape[1], parts.stages
    found = of_margins.batch(*columns, *peaks)
    k = len(found) // (m + 1) - _PEAKS
    of_peaks = np.zeros((_PEAKS, k, n))
    for peak in range(_PEAKS):
        for shift in (-1, 0, 1):
            here = stages[places[peak] + shift].T
            jacobian = of_values.batch(*np.ascontiguousarray(here), *columns).reshape(k, _PEAKS, n)[:, peak]
            of_peaks[peak] += np.where(weights[peak, shift + 1] != 0, weights[peak, shift + 1] * jacobian, 0.0)
    direct, through = found[: k * (m + 1)].reshape(k, m + 1, n), found[k * (m + 1) :].reshape(_PEAKS, m + 1, n)
    total = direct + np.einsum("pmn,pkn->kmn", through, of_peaks)
    total = np.moveaxis(total[:, :m], (2, 1, 0), (0, 1, 2))
    return np.where(np.isfinite(margins)[..., None] & ~(margins == -1.0).all(axis=1)[:, None, None], total, 0.0)

r"""The limits of many guides at once: one compiled function of whatever is free about spring, guide, rollers, limits.

    kernel = design_kernel(wanted, spring, choices, rollers, limits, ["spring.p0", "spring.A"])
    kernel.margins(values)      values (n, 2) -> margins (n, m), the share of each limit that is left
    kernel.gradients(values)    -> (n, m, 2)

The formulas are those of `springs`, `rollers` and `bounds`, which take symbols. No path is fitted: closing,
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

import casadi as ca
import numpy as np

from mechsym import periodic
from mechsym.errors import BadInput, suggest
from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import CENTRE, ROOM, GuideLimit, GuideParameters, Limits, Station, asked
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.springs.face import Formulas, Spring, lettered
from mechsym.hinge.springs.law_path import FULL
from mechsym.native import compiled, compiled_all, marcher
from mechsym.native.evaluate import Compiled
from mechsym.quantities import record
from mechsym.quantities.records import Record
from mechsym.quantities.units import Scalar

_POINTS, _WIDE = 33, 0.5  # angles on a piece of the torque, and the width from which it has so many [rad]
_BLOCK = 4096  # designs at once
_Asked = Sequence[tuple[str, GuideLimit, Scalar]]  # key, limit and the symbol of its setting


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
    #: What is compiled: (stage, lanes) to the shares around the turn, and (lanes, peaks) to the margins
    functions: tuple[ca.Function, ca.Function]
    around: tuple[str, ...]  #: Limits that have shares around the turn
    stages: np.ndarray  #: shape (k, 3): Torque [N*m], its slope [N*m/rad], work [J] at ascending angles
    angles: np.ndarray  #: shape (k,): Of the guide's shaft [rad]
    lanes: dict[str, float]  #: All numbers that the functions take [SI]


@record
class _KernelParts:
    angles: np.ndarray  #: shape (k,): Of the guide's shaft; an angle that stands twice is a kink [rad]
    stages: np.ndarray  #: shape (k, 3): Torque on that shaft [N*m], its slope [N*m/rad], work [J]
    march: Callable[[np.ndarray], np.ndarray]  #: Lanes (all, n) to the index of each peak (peaks, n)
    values: Compiled  #: Stage and lanes to the shares of the limits there
    finish: Compiled  #: Lanes and peaks to margins, the last is above 0 where there is a guide
    functions: tuple[ca.Function, ca.Function]  #: Of both
    slopes: Callable[[], tuple[Compiled, Compiled]]  #: Derivatives of both by what is free
    names: tuple[str, ...]
    peaks: tuple[int, ...]  #: Place among the names of each limit that has its peak somewhere around the turn


def design_kernel(
    wanted: Balance, spring: Spring, choices: GuideParameters, rollers: RollerParameters, limits: Limits,
    free: Sequence[str],
) -> DesignKernel:  # fmt: skip
    """Compile the limits of guides for one torque.

    free: fields that differ between designs: `spring.p0`, `guide.rho0`, `rollers.radius`, `limits.closing_share`, .
    Raises BadInput: a name is no number of these sections.
    """
    if spring.state:
        raise BadInput("the limits of many guides at once take springs whose force follows from the closing alone")
    given: dict[str, Record] = {"spring": spring, "guide": choices, "rollers": rollers, "limits": limits}
    known = {
        f"{section}.{f.name}": getattr(values, f.name)
        for section, values in given.items()
        for f in dataclasses.fields(values)
        if isinstance(getattr(values, f.name), float) and f"{section}.{f.name}" != "guide.shaft_ratio"
    }
    for name in free:
        if name not in known:
            raise BadInput(f"{name} cannot be free in a map of guides; {suggest(name, known)}")
    if len(set(free)) < len(free) or not free:
        raise BadInput("name what is free, each of it once")
    chosen, numbers = list(free), known
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
        law, of = lettered(spring, vars(letters["spring"])), [symbols[name] for name in chosen]
        parts = _parts(wanted, law, choices, limits, letters, list(symbols.values()), of)
    return DesignKernel(
        free=tuple(chosen),
        limits=parts.names,
        margins=lambda values: _in_blocks(lambda v: _margins(parts, v)[0], values, lanes, chosen),
        gradients=lambda values: _in_blocks(lambda v: _gradients(parts, v), values, lanes, chosen),
        functions=parts.functions,
        around=tuple(parts.names[i] for i in parts.peaks),
        stages=parts.stages,
        angles=parts.angles,
        lanes=lanes,
    )


def _in_blocks(
    function: Callable[[np.ndarray], np.ndarray], values: np.ndarray, lanes: dict[str, float], names: list[str]
) -> np.ndarray:
    """A function of lanes (all, n) for designs (n, free), a block after the other."""
    given = np.asarray(values, dtype=float)
    if given.ndim != 2 or given.shape[1] != len(names):
        raise BadInput(f"values have shape {np.shape(values)}; it must be (n, {len(names)}): {', '.join(names)}")
    at, blocks = [list(lanes).index(name) for name in names], []
    for k in range(0, max(len(given), 1), _BLOCK):
        block = given[k : k + _BLOCK]
        columns = np.repeat(np.array([*lanes.values()])[:, None], len(block), axis=1)
        columns[at] = block.T
        blocks.append(function(columns))
    return np.concatenate(blocks)


def _parts(
    wanted: Balance,
    spring: Spring,
    choices: GuideParameters,
    limits: Limits,
    letters: dict[str, SimpleNamespace],
    p: list[ca.SX],
    free: list[ca.SX],
) -> _KernelParts:
    ratio, c = choices.shaft_ratio, choices.rollers
    phi, stages = _stages(wanted, ratio)
    law, of = spring.symbolic(), letters["torque"]
    zm = letters["guide"].z_margin
    at_start = 0.0 if choices.start == "as_printed" else law.energy(zm) + of.high
    stage, lane = ca.SX.sym("stage", 3), ca.vertcat(*p)
    rows = [(key, limit, getattr(letters["limits"], key, None))
            for key, limit, _ in asked(limits, CENTRE, ROOM) if limit.holds(spring, c)]  # fmt: skip
    turn = ca.vertcat(*_over_the_turn(stage, spring, law, at_start, c, letters, rows))
    peaks = ca.SX.sym("peaks", turn.numel())
    margins = _of_limits(c, spring, at_start - of.low, at_start - of.high, peaks, letters, rows)
    names = tuple(name for name in margins if name != "cut")
    values, chosen = ca.vertcat(*margins.values()), ca.vertcat(*free)

    def slopes() -> tuple[Compiled, Compiled]:
        by = [ca.jacobian(values, chosen), ca.jacobian(values, peaks)]
        compiled = compiled_all({
            "slopes": ca.Function("design_slopes", [stage, lane], [ca.jacobian(turn, chosen)]),
            "ends": ca.Function("design_margin_slopes", [lane, peaks], by),
        })  # fmt: skip
        return compiled["slopes"], compiled["ends"]

    functions = (
        ca.Function("design_values", [stage, lane], [turn], ["stage", "lane"], ["shares"]),
        ca.Function("design_margins", [lane, peaks], [values], ["lane", "peaks"], ["margins"]),
    )
    return _KernelParts(
        angles=phi * ratio,
        stages=stages,
        march=_march(stage, lane, turn, stages),
        values=compiled(functions[0]),
        finish=compiled(functions[1]),
        functions=functions,
        slopes=functools.cache(slopes),
        names=names,
        peaks=tuple(names.index(limit.name) for _, limit, _ in rows if not limit.by_closing),
    )


def _over_the_turn(
    stage: ca.SX,
    spring: Spring,
    law: Formulas,
    at_start: Scalar,
    c: int,
    letters: dict[str, SimpleNamespace],
    rows: _Asked,
) -> list[ca.SX]:
    """Shares of the limits that have their largest value somewhere around the turn."""
    M, dM, W = stage[0], stage[1], stage[2]
    z, F, F_z = law.along(at_start - W)
    rho0 = letters["guide"].rho0
    rho, drho = rho0 - z / c, M / (c * F)
    at = Station(
        spring=spring, rollers=letters["rollers"], count=c, rho0=rho0, omega=letters["torque"].omega, rho=rho,
        drho=drho, d2rho=dM / (c * F) + M * F_z * drho / F**2, z=z, force=F,
    )  # fmt: skip
    return [(limit.rising or limit.share)(at, setting) for _, limit, setting in rows if not limit.by_closing]


def _of_limits(
    c: int, spring: Spring, most: Scalar, least: Scalar, peaks: ca.SX, letters: dict[str, SimpleNamespace], rows: _Asked
) -> dict[str, ca.SX]:
    """Margins by the names of the checks, and under `cut` a number above 0 where there is a guide."""
    guide, H = letters["guide"], spring.H
    closing = spring.symbolic().closing
    z_max, z_min = closing(most), closing(least)
    rho_min = guide.rho0 - z_max / c
    end = Station(
        spring=spring, rollers=letters["rollers"], count=c, rho0=guide.rho0, omega=letters["torque"].omega, rho=rho_min,
        z=z_max, force=spring.force(z_max),
    )  # fmt: skip
    along = iter(ca.vertsplit(peaks))
    margins = {"free_height": ca.if_else(z_min < -1e-12 * H, z_min / H, ca.inf)}
    for _, limit, setting in rows:
        share = limit.share(end, setting) if limit.by_closing else limit.of_rising(next(along), setting)
        margins[limit.name] = ca.if_else(share > 0, 1 - share, ca.inf) if limit.signed else 1 - share
    margins["cut"] = ca.fmin(ca.fmin(spring.force(z_min), FULL * H - z_max), rho_min)
    return {name: ca.SX(value) for name, value in margins.items()}


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


def _march(stage: ca.SX, lane: ca.SX, rows: ca.SX, stages: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Where around the turn each quantity is largest."""
    count = rows.numel()
    state, number = ca.SX.sym("state", 2 * count), ca.SX.sym("number")
    best, place = state[:count], state[count:]
    larger = rows > best
    step = ca.vertcat(ca.fmax(best, rows), *[ca.if_else(larger[i], number, place[i]) for i in range(count)])
    run = marcher(ca.Function("design_turn", [state, ca.vertcat(stage, number), lane], [step]))
    numbered = np.column_stack([stages, np.arange(len(stages), dtype=float)])

    def places(columns: np.ndarray) -> np.ndarray:
        start = np.zeros((2 * count, columns.shape[1]))
        start[:count] = -np.inf
        return run(start, numbered, columns)[0][count:].astype(int)

    return places


def _margins(parts: _KernelParts, columns: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Margins (n, m); peaks (k, n), the weights (k, 3, n) of three neighbours, and the place (k, n) of the middle."""
    places = parts.march(columns)
    tops = [_highest(parts, columns, k, places[k]) for k in range(len(parts.peaks))]
    peaks, weights, middle = (np.stack([t[i] for t in tops]) for i in range(3))
    with np.errstate(all="ignore"):
        batch = parts.finish.batch(*columns, *peaks)
    good = batch[-1] > 0  # not a number counts as no guide
    margins = np.where(good, batch[:-1], -1.0).T
    for name, peak in zip(parts.peaks, peaks, strict=True):  # infinite where an undercut leaves nothing to ask
        margins[good & np.isinf(peak), name] = np.inf
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
    gradients = of_margins.batch(*columns, *peaks)
    count = len(parts.peaks)
    k = len(gradients) // (m + 1) - count
    of_peaks = np.zeros((count, k, n))
    for peak in range(count):
        for shift in (-1, 0, 1):
            here = stages[places[peak] + shift].T
            jacobian = of_values.batch(*np.ascontiguousarray(here), *columns).reshape(k, count, n)[:, peak]
            of_peaks[peak] += np.where(weights[peak, shift + 1] != 0, weights[peak, shift + 1] * jacobian, 0.0)
    direct, through = gradients[: k * (m + 1)].reshape(k, m + 1, n), gradients[k * (m + 1) :].reshape(count, m + 1, n)
    total = direct + np.einsum("pmn,pkn->kmn", through, of_peaks)
    total = np.moveaxis(total[:, :m], (2, 1, 0), (0, 1, 2))
    return np.where(np.isfinite(margins)[..., None] & ~(margins == -1.0).all(axis=1)[:, None, None], total, 0.0)

"""A sweep as one labelled data set: numbers by name over the axes, gaps with their reasons, CSV and netCDF."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mechsym import files
from mechsym.files import Json
from mechsym.quantities import results
from mechsym.quantities.results import Columns, part, quantity, result
from mechsym.quantities.units import Array, Pure
from mechsym.sweep.axes import Axis, Value, along
from mechsym.sweep.outcomes import asked
from mechsym.sweep.run import Sweep

if TYPE_CHECKING:
    import xarray

MAIN = {
    "simulate": ("speed_mean", "speed_min", "speed_max", "twist_peak", "torque_peak", "t_end"),
    "hinge": (
        "guide.margin", "guide.z_max", "guide.roller_reaction_max", "hinge_torque_max", "hinge_torque_min",
        "flywheel_inertia_saved",
    ),
    "guides": ("margin", "feasible"),
    "cycle": ("torque_avg", "power_kw", "efficiency", "p_max_mpa"),
    "forces": ("max.crank_pin_load", "max.main_bearing_load", "max.side_force", "max.torque", "power_residual"),
    "size": ("failing",),
    "codesign": ("flywheel_inertia", "flywheel_inertia_bare", "speed_ripple.max", "misfire_speed_share.min"),
}  # fmt: skip


def failures(result: Sweep) -> dict[int, str]:
    """Points without a result. Returns failures: index of the point and the reason."""
    return {i: gap.reason for i, gap in result.outcomes.gaps.items()}


def columns(result: Sweep) -> dict[str, np.ndarray]:
    """Results by name over the points; not a number in a gap, empty for words [SI, or as the name says]."""
    return dict(result.by_name)


def main_results(result: Sweep) -> dict[str, np.ndarray]:
    """The few numbers looked at first, asked for or the analysis' main ones [SI, or as the name says]."""
    candidates = columns(result)
    wanted = MAIN[result.analysis] if not result.show or "all" in result.show else result.show
    numbers = {n: candidates[n] for w in wanted for n in candidates if asked(n, w) and candidates[n].dtype.kind == "f"}
    # a limit that is never reached is as far away as a gap
    return {n: np.where(np.isfinite(v), v, math.nan) for n, v in numbers.items() if np.isfinite(v).any()}


def dataset(result: Sweep) -> "xarray.Dataset":
    """The sweep as an xarray.Dataset.

    Returns data: axes as coordinates and results as variables, with their units; `failure` holds the reasons of the
    gaps. A result that has the name of an axis and other values is called `result.<name>`.
    """
    try:
        import xarray as xr
    except ImportError as error:
        raise files.without_netcdf(error) from None
    shape, names = tuple(result.dims.values()), list(result.dims)
    sampled, place = "sample" in result.dims, {a.key: i for i, a in enumerate(result.axes)}
    coordinates = {
        a.key: ("sample" if sampled else a.key, along(result.points, i) if sampled else list(a.values), _units(a.unit))
        for i, a in enumerate(result.axes)
    }
    variables = {}
    for name, values in columns(result).items():
        if name in place and _same(values, along(result.points, place[name])):
            continue
        label = f"result.{name}" if name in place else name
        variables[label] = (names, values.reshape(shape), _units(result.units[name]))
    reasons = failures(result)
    texts = np.full(len(result.points), "", dtype=f"U{max(map(len, reasons.values()), default=1)}")
    for i, reason in reasons.items():
        texts[i] = reason
    variables["failure"] = (names, texts.reshape(shape), {"long_name": "why there is no result"})
    attributes = {"case": result.case, "analysis": result.analysis, "failed": len(reasons)}
    return xr.Dataset(variables, coords=coordinates, attrs=attributes | {"interrupted": int(result.interrupted)})


def _units(unit: str) -> dict[str, str]:
    # a pure number has the unit 1 in netCDF
    return {"units": "1" if unit == "-" else unit} if unit else {}


def _same(values: np.ndarray, axis: np.ndarray) -> bool:
    if values.dtype.kind != "f" or axis.dtype.kind != "f":
        return False
    there = np.isfinite(values)
    return bool(np.allclose(values[there], axis[there], rtol=1e-9, atol=0))


def write_table(result: Sweep, folder: Path) -> Path:
    """Write the sweep as CSV, one line a point; the cells of a gap are empty."""
    # the unit keeps an axis apart from a result of the same name
    table: dict[str, Any] = {
        f"{a.key} [{a.unit}]" if a.unit else f"{a.key} [word]": along(result.points, i)
        for i, a in enumerate(result.axes)
    }
    reasons = failures(result)
    table |= {name: column for name, column in columns(result).items()
              if result.units[name] or column.dtype.kind != "f" or not np.isnan(column).all()}  # fmt: skip
    count = len(result.points)
    # the same empty word at every point takes no memory
    table["failure"] = [reasons.get(i, "") for i in range(count)] if reasons else np.broadcast_to(np.array(""), count)
    return files.write_quantities(
        folder / "sweep.csv", table, {n: result.units.get(n, "") for n in table if " [" not in n}
    )


def write_netcdf(result: Sweep, folder: Path) -> Path:
    """Write the sweep as netCDF. Raises MissingExtra: xarray or h5netcdf is not installed."""
    return files.write_netcdf(folder / "sweep.nc", dataset(result))


@result
class SweptAxis:
    """A value of the case and what it takes on."""

    unit: str = part()
    values: tuple[Value, ...] = quantity("@unit")  #: Of a grid its values, of samples one for each point


@result
class FailedPoint:
    """A point without a result."""

    index: int = quantity("-")  #: Number of the point, the last axis fastest
    at: Columns = part()  #: Values of the axes there
    reason: str = part()


@results.result
class SobolIndex:
    """How much of a result's variance one value brings."""

    result: str = part()
    key: str = part()
    first: float = quantity("-")  #: By itself, the others averaged
    first_low: float = quantity("-")  #: Lower end of its 95 % interval
    first_high: float = quantity("-")  #: Upper end of its 95 % interval
    total: float = quantity("-")  #: With all that it does together with others
    total_low: float = quantity("-")  #: Lower end of its 95 % interval
    total_high: float = quantity("-")  #: Upper end of its 95 % interval
    left_out: int = quantity("-")  #: Base samples that a gap takes away


@result
class SweepNumbers:
    """A sweep with the results of all its points."""

    case: str = part()
    analysis: str = part()
    dims: Mapping[str, int] = quantity("-")  #: Points along each dimension
    shape: tuple[int, ...] = quantity("-")  #: The same as a list
    axes: Mapping[str, SweptAxis] = part()
    units: Mapping[str, str] = part()
    data: Columns = part()  #: Each result at all points, the last axis fastest
    failed: tuple[FailedPoint, ...] = part()
    sobol: tuple[SobolIndex, ...] = part()
    interrupted: bool = part()
    kept: int = quantity("-")  #: Points that were finished before
    set_aside: str | None = part()
    files: tuple[str, ...] = part()


@result
class StudiedSweep:
    """A sweep of a study."""

    name: str = part()
    about: str = part()
    over: tuple[str, ...] = part()
    tied: tuple[str, ...] = part()
    points: int = quantity("-")  #: How many there are
    numbers: SweepNumbers = part(inline=True)
    picture: str  # as SVG
    see: str  # what it shows
    rows: list[Json]  # smallest and largest of the main results


@result
class StudyNumbers:
    """The sweeps of a study."""

    study: str = part()
    sweeps: tuple[StudiedSweep, ...] = part()
    interrupted: bool = part()
    files: tuple[str, ...] = part()


def numbers(sweep: Sweep, files: list[Path]) -> SweepNumbers:
    """The numbers of a sweep, and the files that were written of it."""
    data, axis_units = columns(sweep), {a.key: a.unit for a in sweep.axes}
    every = zip(*sweep.points, strict=True) if "sample" in sweep.dims else (a.values for a in sweep.axes)
    failed = tuple(
        FailedPoint(index=i, at=Columns(dict(zip(axis_units, sweep.points[i], strict=True)), axis_units), reason=reason)
        for i, reason in failures(sweep).items()
    )
    # a word that is not there is null, as a number
    values = {name: column if column.dtype.kind == "f" else [v or None for v in column.tolist()]
            for name, column in data.items()}  # fmt: skip
    return SweepNumbers(
        case=sweep.case,
        analysis=sweep.analysis,
        dims=dict(sweep.dims),
        shape=tuple(sweep.dims.values()),
        axes={a.key: SweptAxis(unit=a.unit, values=tuple(v)) for a, v in zip(sweep.axes, every, strict=True)},
        units={name: sweep.units[name] for name in data},
        data=Columns(values, sweep.units),
        failed=failed,
        sobol=tuple(indices(sweep)) if sweep.sobol else (),
        interrupted=sweep.interrupted,
        kept=sweep.kept,
        set_aside=sweep.aside or None,
        files=tuple(map(str, files)),
    )


_AGAIN = 1000  # resamplings of the confidence
_SHARE = (2.5, 97.5)  # percentiles of an interval that holds the truth 19 times in 20


def indices(result: Sweep) -> list[SobolIndex]:
    """Sobol indices of the main results, or of those that are shown, with their confidence.

    Returns rows: one for each result that varies and each axis; none where fewer than two base samples are whole.
    """
    count, d = result.sobol, len(result.axes)
    rows = []
    for name, values in main_results(result).items():
        blocks = values.reshape(d + 2, count)
        whole = np.isfinite(blocks).all(axis=0)
        if whole.sum() > 1 and np.ptp(blocks[:, whole]) > 1e-12 * np.abs(blocks[:, whole]).max():
            rows += _of_one(name, result.axes, blocks[:, whole], int(count - whole.sum()))
    return rows


def _of_one(name: str, axes: Sequence[Axis], blocks: np.ndarray, left_out: int) -> list[SobolIndex]:
    here = estimates(blocks)
    rng = np.random.default_rng(0)
    rows = rng.integers(blocks.shape[1], size=(_AGAIN, blocks.shape[1]))
    again = estimates(blocks[:, rows])
    (low_1, high_1), (low_t, high_t) = (np.nanpercentile(a, _SHARE, axis=-1) for a in again)
    return [
        SobolIndex(
            result=name, key=axis.key, first=float(here[0][i]), first_low=float(low_1[i]),
            first_high=float(high_1[i]), total=float(here[1][i]), total_low=float(low_t[i]),
            total_high=float(high_t[i]), left_out=left_out,
        )
        for i, axis in enumerate(axes)
    ]  # fmt: skip


def estimates(blocks: np.ndarray) -> tuple[Pure[Array], Pure[Array]]:
    r"""First-order and total indices out of samples A, B, and A with one column of B after the other.

    .. math:: S_i = \frac{\overline{f_B (f_{AB_i} - f_A)}}{V}, \quad T_i = \frac{\overline{(f_A - f_{AB_i})^2}}{2 V}

    blocks: results of A, B, AB_1 .. AB_d, shape (d + 2, .., n) [unit of the result]. Returns first, total: indices,
    shape (d, ..).
    Source: Saltelli et al., Computer Physics Communications 181 (2010), table 2, (b) and (f), the latter of Jansen.
    Valid: independent values. V is the variance of A and B together.

    >>> a, b = np.array([1.0, 2.0, 3.0, 4.0]), np.array([2.0, 4.0, 1.0, 3.0])
    >>> [s.round(3).tolist() for s in estimates(np.array([a, b, b]))]  # one value: it is all of the variance
    [[1.0], [1.0]]
    """
    a, b, both = blocks[0], blocks[1], np.concatenate([blocks[0], blocks[1]], axis=-1)
    mean, variance = both.mean(axis=-1, keepdims=True), both.var(axis=-1)
    change = blocks[2:] - a
    with np.errstate(invalid="ignore", divide="ignore"):
        return ((b - mean) * change).mean(axis=-1) / variance, (change**2).mean(axis=-1) / 2 / variance

"""A sweep as one labelled data set: numbers by name over the axes, gaps with their reasons, CSV and netCDF."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mechsym import files
from mechsym.sweep.outcomes import Gap, asked
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
    return {i: outcome.reason for i, outcome in enumerate(result.outcomes) if isinstance(outcome, Gap)}


def columns(result: Sweep) -> dict[str, np.ndarray]:
    """Results by name over the points; not a number in a gap, empty for words [SI, or as the name says]."""
    return dict(result.by_name)


def main_results(result: Sweep) -> dict[str, np.ndarray]:
    """The few numbers looked at first, asked for or the analysis' main ones [SI, or as the name says]."""
    found = columns(result)
    wanted = MAIN[result.analysis] if not result.show or "all" in result.show else result.show
    numbers = {n: found[n] for w in wanted for n in found if asked(n, w) and found[n].dtype.kind == "f"}
    # a limit that is never reached is as far away as a gap
    return {n: np.where(np.isfinite(v), v, math.nan) for n, v in numbers.items() if np.isfinite(v).any()}


def dataset(result: Sweep) -> "xarray.Dataset":
    """The sweep as an xarray.Dataset.

    Returns
    -------
    data : xarray.Dataset
        Axes as coordinates and results as variables, with their units; `failure` holds the reasons of the gaps. A
        result that has the name of an axis and other values is called `result.<name>`
    """
    try:
        import xarray as xr
    except ImportError as error:
        raise files.without_netcdf(error) from None
    shape, names = tuple(result.dims.values()), list(result.dims)
    along = {a.key: np.array([p[i] for p in result.points]) for i, a in enumerate(result.axes)}
    sampled = "sample" in result.dims
    coordinates = {
        a.key: ("sample" if sampled else a.key, along[a.key] if sampled else list(a.values), _units(a.unit))
        for a in result.axes
    }
    variables = {}
    for name, values in columns(result).items():
        if name in along and _same(values, along[name]):
            continue
        label = f"result.{name}" if name in along else name
        variables[label] = (names, values.reshape(shape), _units(result.units[name]))
    reasons = failures(result)
    texts = np.array([reasons.get(i, "") for i in range(len(result.points))])
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
        f"{a.key} [{a.unit}]" if a.unit else f"{a.key} [word]": [p[i] for p in result.points]
        for i, a in enumerate(result.axes)
    }
    reasons = failures(result)
    table |= {name: [None if v != v else v for v in column.tolist()] for name, column in columns(result).items()
              if result.units[name] or column.dtype.kind != "f" or not np.isnan(column).all()}  # fmt: skip
    table["failure"] = [reasons.get(i, "") for i in range(len(result.points))]
    return files.write_quantities(
        folder / "sweep.csv", table, {n: result.units.get(n, "") for n in table if " [" not in n}
    )


def write_netcdf(result: Sweep, folder: Path) -> Path:
    """Write the sweep as netCDF. Raises MissingExtra: xarray or h5netcdf is not installed."""
    return files.write_netcdf(folder / "sweep.nc", dataset(result))

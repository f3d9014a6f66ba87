"""A sweep as one labelled data set: numbers by name over the axes, gaps with their reasons, CSV and netCDF."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from mechsym.errors import BadInput, MissingExtra
from mechsym.files import write_csv
from mechsym.sweep import Sweep

# results that are words worth keeping, and words that mean failure
_WORDS, _BAD = ("status", "end"), ("failed", "not converged")


def flat(result: Mapping[str, Any], prefix: str = "") -> dict[str, float | str]:
    """The numbers of a nested result by dotted names.

    Parameters
    ----------
    result : mapping
        Numbers, words, lists of one number, and mappings of these
    prefix : str
        Of the names

    Returns
    -------
    numbers : dict of str to float or str
        None becomes not a number; longer lists and most words are left out
    """
    found: dict[str, float | str] = {}
    for key, value in result.items():
        name = f"{prefix}{key}"
        if isinstance(value, Mapping):
            found |= flat(value, f"{name}.")
        elif isinstance(value, str):
            found |= {name: value} if key in _WORDS else {}
        elif value is None:
            found[name] = math.nan
        elif np.size(value) == 1 and np.asarray(value).dtype.kind in "bif":
            found[name] = float(np.ravel(value)[0])
    return found


def failures(result: Sweep) -> dict[int, str]:
    """Points without a result, or with one that did not converge.

    Parameters
    ----------
    result : Sweep
        A sweep

    Returns
    -------
    failures : dict of int to str
        Index of the point and the reason
    """
    found = {}
    for i, outcome in enumerate(result.outcomes):
        if isinstance(outcome, BadInput):
            found[i] = " ".join(str(outcome).split())
        elif outcome.get("status") in _BAD:
            found[i] = str(outcome["reason"])
    return found


def columns(result: Sweep) -> dict[str, np.ndarray]:
    """Numbers by name, one for each point.

    Parameters
    ----------
    result : Sweep
        A sweep

    Returns
    -------
    columns : dict of str to ndarray, shape (n,)
        Not a number in a gap, texts for words [SI, or as the name says]
    """
    rows = [{} if isinstance(o, BadInput) else flat(o) for o in result.outcomes]
    found = {}
    for name in dict.fromkeys(name for row in rows for name in row):
        gap = "" if any(isinstance(row.get(name), str) for row in rows) else math.nan
        # a result that one point has not reached is not a number there even where others are words
        found[name] = np.array([row.get(name, gap) for row in rows])
    return found


def dataset(result: Sweep) -> Any:
    """The sweep as an xarray.Dataset.

    Parameters
    ----------
    result : Sweep
        A sweep

    Returns
    -------
    data : xarray.Dataset
        Axes as coordinates with their units; variables by name

    Raises
    ------
    MissingExtra
        xarray is not installed
    """
    try:
        import xarray as xr
    except ImportError:
        raise MissingExtra("a data set needs xarray; install it with pip install 'mechsym[netcdf]'") from None
    shape, names = tuple(result.dims.values()), list(result.dims)
    sampled = "sample" in result.dims
    coordinates = {
        a.key: (
            "sample" if sampled else a.key,
            [p[i] for p in result.points] if sampled else list(a.values),
            {"units": a.unit or "SI"},
        )
        for i, a in enumerate(result.axes)
    }
    # an axis whose name is also a result, such as speed_rpm, keeps its place as the axis
    variables = {n: (names, v.reshape(shape)) for n, v in columns(result).items() if n not in coordinates}
    attributes = {"case": result.case, "analysis": result.analysis, "failed": len(failures(result))}
    return xr.Dataset(variables, coords=coordinates, attrs=attributes)


def write(result: Sweep, folder: Path) -> list[Path]:
    """Write the sweep as CSV, one line a point, and as netCDF where xarray is installed.

    Parameters
    ----------
    result : Sweep
        A sweep
    folder : Path
        Where to

    Returns
    -------
    files : list of Path
        Written
    """
    # the unit keeps an axis apart from a result of the same name
    table: dict[str, Any] = {
        f"{a.key} [{a.unit or 'SI'}]": [p[i] for p in result.points] for i, a in enumerate(result.axes)
    }
    reasons = failures(result)
    table |= columns(result) | {"failure": [reasons.get(i, "") for i in range(len(result.points))]}
    files = [write_csv(folder / "sweep.csv", table)]
    try:
        found = dataset(result)
        target = folder / "sweep.nc"
        found.to_netcdf(target, engine="h5netcdf")
    except (MissingExtra, ImportError):
        return files
    return [*files, target]

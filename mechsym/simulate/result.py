"""The result of a run: labelled columns with units, energy audit, convergence, event; written as CSV and netCDF."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mechsym.errors import MissingExtra
from mechsym.files import write_csv


@dataclass(frozen=True, kw_only=True)
class Event:
    """A stop that was met.

    Parameters
    ----------
    name : str
        Name of the stop
    t : float
        When [s]
    state : mapping of str to float
        Coordinates and velocities there [rad, rad/s]
    """

    name: str
    t: float
    state: Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class Energy:
    r"""Energy audit of a run.

    .. math:: \text{residual} = (W - D - \Delta E) / W_\text{in}

    Parameters
    ----------
    work : mapping of str to float
        Work that each part does on the mechanism; a braking load's is negative [J]
    work_in : float
        Sum over the parts with the role `drive` [J]
    dissipation : float
        Taken by the mechanism's dampers [J]
    change : float or None
        Kinetic and potential energy at the end minus at the start; None for a model without energies [J]
    reference : float
        What the residual is relative to: work_in, or the largest energy when the drive brings in less than
        a thousandth of that [J]
    residual : float or None
        (All work - dissipation - change) / reference; None for a model without energies [-]
    """

    work: Mapping[str, float]
    work_in: float
    dissipation: float
    change: float | None
    reference: float
    residual: float | None


@dataclass(frozen=True, kw_only=True)
class Result:
    """A finished run.

    Parameters
    ----------
    status : str
        `converged`, `not converged`, `chaotic`, `unchecked` or `failed`
    reason : str
        Why, in one line
    t : ndarray, shape (n,)
        Times [s]
    columns : mapping of str to ndarray, shape (n,)
        Coordinates, velocities, `work_<part>`, `dissipation` and the energies at these times
    units : mapping of str to str
        Unit of each column
    end : str
        What ended it: `t_end`, `turns`, the event's name, or `failure`
    event : Event or None
        The stop that was met
    energy : Energy
        Audit over the whole run
    tolerance_difference : float or None
        Largest difference of a speed to the run at the tighter tolerance, relative to its peak; None unchecked [-]
    steps : int
        Accepted steps
    wall_s : float
        Time that the run took, without the check [s]
    """

    status: str
    reason: str
    t: np.ndarray
    columns: Mapping[str, np.ndarray]
    units: Mapping[str, str]
    end: str
    event: Event | None
    energy: Energy
    tolerance_difference: float | None
    steps: int
    wall_s: float


def write_series(result: Result, path: Path) -> Path:
    """Write the time series as CSV; the first column is t, all SI.

    Parameters
    ----------
    result : Result
        A run
    path : Path
        File to write

    Returns
    -------
    path : Path
        The same path
    """
    return write_csv(path, {"t": result.t, **result.columns})


def write_netcdf(result: Result, path: Path) -> Path:
    """Write the time series as netCDF, each variable with its unit.

    Parameters
    ----------
    result : Result
        A run
    path : Path
        File to write

    Returns
    -------
    path : Path
        The same path

    Raises
    ------
    MissingExtra
        xarray or h5netcdf is not installed
    """
    data = dataset(result)
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.name}.part")
    try:
        data.to_netcdf(part, engine="h5netcdf")
    except (ImportError, ValueError) as error:
        raise _missing(error) from None
    part.replace(path)
    return path


def dataset(result: Result) -> Any:
    """The time series as an xarray data set with unit attributes.

    Parameters
    ----------
    result : Result
        A run

    Returns
    -------
    data : xarray.Dataset
        One variable a column over the coordinate `t`; the audit's numbers as attributes

    Raises
    ------
    MissingExtra
        xarray is not installed
    """
    try:
        import xarray as xr
    except ImportError as error:
        raise _missing(error) from None
    variables = {n: ("t", v, {"units": result.units[n]}) for n, v in result.columns.items()}
    facts = {"status": result.status, "end": result.end, "steps": result.steps}
    numbers = {"energy_residual": result.energy.residual, "tolerance_difference": result.tolerance_difference}
    facts |= {k: v for k, v in numbers.items() if v is not None}
    return xr.Dataset(variables, coords={"t": ("t", result.t, {"units": "s"})}, attrs=facts)


def _missing(error: Exception) -> MissingExtra:
    return MissingExtra(f"netCDF needs xarray and h5netcdf ({error}); install them with pip install 'mechsym[netcdf]'")

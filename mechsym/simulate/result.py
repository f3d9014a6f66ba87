"""The result of a run: labelled columns with units, energy audit, convergence, event; written as CSV and netCDF."""

from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from typing import Any

import numpy as np

from mechsym.errors import BadInput, MissingExtra
from mechsym.files import write_quantities, write_with
from mechsym.quantities import record


@record
class Event:
    """A stop that was met."""

    name: str
    t: float  #: When [s]
    state: Mapping[str, float]  #: Coordinates and velocities there [rad, rad/s]


@record
class Energy:
    r"""Energy audit of a run.

    .. math:: \text{residual} = (W - D - \Delta E) / W_\text{in}
    """

    work: Mapping[str, float]  #: Work that each part does on the mechanism; a braking load's is negative [J]
    work_in: float  #: Sum over the parts with the role `drive` [J]
    dissipation: float  #: Taken by the mechanism's dampers [J]
    #: Kinetic and potential energy at the end minus at the start; None for a model without energies [J]
    change: float | None
    #: What the residual is relative to: work_in, or the largest energy when the drive brings in less than a thousandth
    #: of that [J]
    reference: float
    residual: float | None  #: (All work - dissipation - change) / reference; None for a model without energies [-]
    losses: Mapping[str, float] = field(default_factory=dict)  #: Of the parts with the role `loss`, heat of stores [J]


@record
class Result:
    """A finished run."""

    status: str  #: `converged`, `not converged`, `chaotic`, `unchecked` or `failed`
    reason: str
    t: np.ndarray  #: shape (n,): Times [s]
    #: shape (n,): Coordinates, velocities, `work_<part>`, `dissipation` and the energies at these times
    columns: Mapping[str, np.ndarray]
    units: Mapping[str, str]
    end: str  #: What ended it: `t_end`, `turns`, the event's name, or `failure`
    event: Event | None
    energy: Energy
    #: Largest difference of a speed to the run at the tighter tolerance, relative to its peak; None unchecked [-]
    tolerance_difference: float | None
    steps: int
    wall_s: float  #: Time that the run took, without the check [s]


def write_series(result: Result, path: Path) -> Path:
    """Write the time series as CSV; the first column is t, units in the headings."""
    return write_quantities(path, {"t": result.t, **result.columns}, {"t": "s", **result.units})


def write_netcdf(result: Result, path: Path) -> Path:
    """Write the time series as netCDF, each variable with its unit.

    Raises
    ------
    MissingExtra
        xarray or h5netcdf is not installed
    """
    data = dataset(result)
    try:
        return write_with(path, lambda part: data.to_netcdf(part, engine="h5netcdf"))
    except BadInput:
        raise
    except (ImportError, ValueError) as error:
        raise _missing(error) from None


def dataset(result: Result) -> Any:
    """The time series as an xarray data set with unit attributes.

    Returns
    -------
    data : xarray.Dataset
        One variable a column over the coordinate `t`; the audit's numbers as attributes
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

"""The result of a run: labelled columns with units, energy audit, convergence, event; written as CSV and netCDF.

`summary` makes the reported numbers of it: speeds over a window at the end, audit, convergence, event.
"""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mechsym import files
from mechsym.quantities import record, results
from mechsym.quantities.results import Columns, part, quantity
from mechsym.quantities.units import Array, Pure, Radian, Second
from mechsym.simulate import speed
from mechsym.simulate.between import between
from mechsym.simulate.speed import Speed, before_last_period, extremes, speeds

if TYPE_CHECKING:
    import xarray


@record
class Event:
    """A stop that was met."""

    name: str
    t: float  #: When [s]
    state: Mapping[str, float]  #: Coordinates and velocities there [rad, rad/s]


@results.result
class RunEvent:
    """What happened at a stop, a contact or a friction."""

    t: float = quantity("s")  #: When
    name: str = part()  #: Of which, or of those that are hit at once
    #: `hit`, `rest` (a bounce is over), `touch`, `release`; `stick`, `slip`, `turn` (it slides the other way)
    kind: str = part()
    lost: float = quantity("J", default=0.0)  #: Energy that the blow takes


@record
class Happened:
    """What a run tells of its stops, contacts and friction."""

    events: tuple[RunEvent, ...] = ()  #: In time
    #: Largest rate at which normal forces and friction converge to each other; None without friction of joints [-]
    contraction: float | None = None


@record
class Energy:
    r"""Energy audit of a run.

    .. math:: \text{residual} = (W - D - \Delta E) / W_\text{in}
    """

    work: Mapping[str, float]  #: Work that each part does on the mechanism; a braking load's is negative [J]
    work_in: float  #: Sum over the parts with the role `drive` [J]
    #: Taken by dampers and friction of the mechanism; below 0 where a motor of it gives more than they take [J]
    dissipation: float
    #: Kinetic and potential energy at the end minus at the start; None for a model without energies [J]
    change: float | None
    #: What the residual is relative to: work_in, or the largest energy when the drive brings in less than a thousandth
    #: of that [J]
    reference: float
    residual: float | None  #: (All work - dissipation - change) / reference; None for a model without energies [-]
    losses: Mapping[str, float] = field(default_factory=dict)  #: Of the parts with the role `loss`, heat of stores [J]
    friction: Mapping[str, float] = field(default_factory=dict)  #: Heat of each friction of the declaration [J]


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
    #: Largest difference of a speed to the run at a hundredth of the tolerance, relative to its peak; None unchecked.
    #: An error grows as the tolerance to the power p/(p+1), p >= 1 the order, so that run is off by a tenth of this
    #: one's error at most, and the error by at most 10/9 of this [-]
    tolerance_difference: float | None
    steps: int
    wall_s: float  #: Time that the run took, without the check [s]
    happened: Happened = field(default_factory=Happened)
    tolerance: float | None = None  #: Of its steps, where the settings' was not enough [-]
    #: Coordinates and velocities at any ascending times within the run; None where only the samples are known
    dense: Callable[[np.ndarray], Mapping[str, np.ndarray]] | None = field(default=None, repr=False, compare=False)

    @property
    def as_planned(self) -> bool:
        """Whether it went on to the end that it was made for."""
        return self.end in ("turns", "t_end")


def write_series(result: Result, path: Path) -> Path:
    """Write the time series as CSV; the first column is t, units in the headings."""
    return files.write_quantities(path, {"t": result.t, **result.columns}, {"t": "s", **result.units})


def write_netcdf(result: Result, path: Path) -> Path:
    """Write the time series as netCDF with units. Raises MissingExtra: xarray or h5netcdf is not installed."""
    return files.write_netcdf(path, dataset(result))


def dataset(result: Result) -> "xarray.Dataset":
    """The time series as an xarray data set with unit attributes.

    Returns data: xarray.Dataset, one variable a column over the coordinate `t`; the audit's numbers as attributes.
    """
    try:
        import xarray as xr
    except ImportError as error:
        raise files.without_netcdf(error) from None
    variables = {n: ("t", v, {"units": result.units[n]}) for n, v in result.columns.items()}
    facts = {"status": result.status, "end": result.end, "steps": result.steps}
    numbers = {"energy_residual": result.energy.residual, "tolerance_difference": result.tolerance_difference}
    facts |= {k: v for k, v in numbers.items() if v is not None}
    return xr.Dataset(variables, coords={"t": ("t", result.t, {"units": "s"})}, attrs=facts)


_A_STEP = 16  # looks at each step of the integrator, whose formulas of high order swing within one
_ENOUGH, _ASKED, _MISSED = 50, 2000, 0.02  # samples that may tell each other, those asked, by what share of the swing
_ROUNDING = 1e-12  # of what is constant
_FINER = 129  # looks between two samples, one of which is before the last period
_NEAR_WHOLE = 1e-6  # of a period, that a run which was to end with it may lack
_LEAST, _MOST = 720, 10_000  # looks at a stretch


@results.result
class RunEnergy:
    """Where the energy of a run came from and went."""

    work: Mapping[str, float] = quantity("J")  #: Work that each part does on the mechanism
    work_in: float = quantity("J")  #: Sum over the parts that drive
    #: Taken by dampers and friction of the mechanism, and blows; below 0 where a motor of it gives more than they take
    dissipation: float = quantity("J")
    friction: Mapping[str, float] = quantity("J")  #: Heat of each friction of the declaration
    change: float | None = quantity("J")  #: Kinetic and potential energy at the end less that at the start


@results.result
class RunNumbers:
    """The numbers of a run, in the units of its coordinates."""

    t_end: float = quantity("s")  #: When it ended
    speed_mean: float = quantity("@rate")  #: Mean speed of the first coordinate at the end
    speed_min: float = quantity("@rate")  #: Least speed of the first coordinate at the end
    speed_max: float = quantity("@rate")  #: Greatest speed of the first coordinate at the end
    energy_residual: float | None = quantity("-")  #: Work less dissipation less change of energy, by the work
    tolerance_difference: float | None = quantity("-")  #: Of a speed to the run at a hundredth of the tolerance
    steps: int = quantity("-")  #: Steps of the integrator
    wall_s: float = quantity("s")  #: Time that the run took
    events: tuple[RunEvent, ...] = part()  #: At stops, contacts and friction, in time
    event: Columns | None = part()  #: What stopped it: name, time, state
    end: str = part()
    status: str = part()
    reason: str = part()
    window: float = quantity("s")  #: Stretch at the end over which speeds are summed up
    speeds: Mapping[str, Columns] = part()  #: Mean, least and greatest speed of each coordinate over the window
    energy: RunEnergy = part()
    rate: str  # unit of the first coordinate's speed


def summary(
    result: Result, coordinates: tuple[str, ...], window: Second | None, period: Radian = 2 * np.pi
) -> RunNumbers:
    """The reported numbers of a run.

    coordinates: names of the coordinates; `speed_mean` and the others are those of the first. window: stretch at the
    end over which speeds are summed up; None takes the last period of the first coordinate. period: a turn, or two for
    a four-stroke engine.
    """
    since = last_period(result, coordinates[0], period) if window is None else max(result.t[-1] - window, result.t[0])
    over_window = speeds_over(result, coordinates, since)
    first, event, units, audit = over_window[coordinates[0]], result.event, result.units, result.energy
    stop = None
    if event is not None:
        stop = Columns({"name": event.name, "t": event.t, **event.state}, {"name": "", "t": "s", **units})
    return RunNumbers(
        t_end=float(result.t[-1]),
        speed_mean=first.mean,
        speed_min=first.min,
        speed_max=first.max,
        energy_residual=audit.residual,
        tolerance_difference=result.tolerance_difference,
        steps=result.steps,
        wall_s=result.wall_s,
        event=stop,
        events=result.happened.events,
        end=result.end,
        status=result.status,
        reason=result.reason,
        window=float(result.t[-1] - since),
        speeds={
            c: Columns(asdict(s), dict.fromkeys(("mean", "min", "max"), units[f"{c}d"])) for c, s in over_window.items()
        },
        energy=RunEnergy(
            work=dict(audit.work),
            work_in=audit.work_in,
            dissipation=audit.dissipation,
            friction=dict(audit.friction),
            change=audit.change,
        ),  # fmt: skip
        rate=units[f"{coordinates[0]}d"],
    )


def final_state(result: Result, coordinates: Iterable[str]) -> Columns:
    """Coordinates and velocities at the end of a run, under the names of `[start]`, where another may go on from."""
    return Columns({n: float(result.columns[n][-1]) for q in coordinates for n in (q, f"{q}d")}, result.units)


def speeds_over(result: Result, coordinates: tuple[str, ...], since: Second) -> dict[str, Speed]:
    """Speed of each coordinate from a time to the end, with the extremes of the dense solution."""
    since = max(since, float(result.t[0]))
    if result.t[-1] <= since:
        now = {c: float(result.columns[f"{c}d"][-1]) for c in coordinates}
        return {c: Speed(mean=u, min=u, max=u) for c, u in now.items()}

    def motion(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        at: Mapping[str, np.ndarray]
        if result.dense is None:
            at = {n: np.interp(t, result.t, result.columns[n]) for c in coordinates for n in (c, f"{c}d")}
        else:
            at = result.dense(t)
        return np.array([at[c] for c in coordinates]), np.array([at[f"{c}d"] for c in coordinates])

    if result.dense is None:
        times = np.append(since, result.t[result.t > since])
    else:  # as fine as the steps of the run, so that no peak is missed
        share = (result.t[-1] - since) / (result.t[-1] - result.t[0])
        times = np.linspace(since, result.t[-1], int(np.clip(_A_STEP * result.steps * share, _LEAST, _MOST)))
    return dict(zip(coordinates, speeds(motion, times), strict=True))


def extremes_of(
    result: Result, values: Callable[[Mapping[str, Array]], np.ndarray], since: Second = -math.inf
) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest of values from a time to the end, between the samples too.

    values: coordinates and velocities by name, each (n,) -> values (k, n). Returns least, greatest: shape (k,) [unit of
    the values]. Where the samples tell each other, what is between them follows from them, by estimate to 6e-4 of the
    swing or better; else the run is looked into.
    """
    after = result.t >= since
    t = np.unique(result.t[after])  # a blow has two samples
    columns = {name: column[after] for name, column in result.columns.items()}
    rows = values(columns)
    at, inner = (t, rows), between(t, columns)
    if len(t) < rows.shape[1] or not _close(t, columns, values):
        if result.dense is None or len(t) < 2:
            return rows.min(axis=1), rows.max(axis=1)
        inner, share = result.dense, (t[-1] - t[0]) / (result.t[-1] - result.t[0])
        times = np.linspace(t[0], t[-1], int(np.clip(_A_STEP * result.steps * share, _LEAST, 10 * _MOST)))
        at = times, values(inner(times))
    least, greatest = extremes(lambda times: values(inner(times)), *at)
    return np.minimum(least, rows.min(axis=1)), np.maximum(greatest, rows.max(axis=1))


def _close(
    t: np.ndarray, columns: Mapping[str, np.ndarray], values: Callable[[Mapping[str, np.ndarray]], np.ndarray]
) -> bool:
    """Whether every second sample tells those between: half the distance leaves 1/64 of the error, 1/32 of a rate's."""
    if len(t) < _ENOUGH:
        return False
    half = between(t[::2], {name: column[::2] for name, column in columns.items()})
    asked = np.arange(1, len(t) - 1, 2 * (len(t) // _ASKED + 1))
    missed = np.abs(values(half(t[asked])) - values({n: column[asked] for n, column in columns.items()})).max(axis=1)
    rows = values(columns)
    return bool((missed <= _MISSED * np.ptp(rows, axis=1) + _ROUNDING * np.abs(rows).max(axis=1)).all())


def last_period(result: Result, coordinate: str, period: Radian = 2 * np.pi) -> Second:
    """When the last period of a coordinate began: a turn, two for a four-stroke engine, or a shorter run."""
    q, rate = result.columns[coordinate], f"{coordinate}d"
    i = before_last_period(q, period)
    if i is None or result.dense is None:
        return speed.last_period(result.t, q, result.columns[rate], period)
    t = np.linspace(result.t[i], result.t[i + 1], _FINER)
    at = result.dense(t)
    return speed.last_period(t, at[coordinate], at[rate], period, float(q[-1]))


def period_means(result: Result, coordinate: str, period: Radian) -> np.ndarray:
    """Mean speed of a coordinate that turns, over each whole period from the start (k,) [rad/s]."""
    return period / np.diff(period_ends(result, coordinate, period))


def period_ends(result: Result, coordinate: str, period: Radian) -> np.ndarray:
    """When each whole period of a coordinate that turns is over, the start among them (k,) [s]."""
    q = np.maximum.accumulate(result.columns[coordinate])
    whole = math.floor((q[-1] - q[0]) / period + _NEAR_WHOLE)
    return np.interp(q[0] + period * np.arange(whole + 1), q, result.t)


def speed_ripple(result: Result, coordinate: str, period: Radian = 2 * np.pi) -> Pure | None:
    """Ripple of the last period, see `mechsym.simulate.speed`.

    result: a run of at least a period, in steady state for the number to mean what it says; period: period of the
    torques. Returns ripple: (max - min) / |mean|; None where nothing advances.
    """
    return speeds_over(result, (coordinate,), last_period(result, coordinate, period))[coordinate].ripple

"""What `mechsym sweep` and `mechsym study` tell of a sweep."""

from collections.abc import Mapping
from pathlib import Path

from mechsym.files import Json
from mechsym.quantities.results import Columns, part, quantity, result
from mechsym.sweep.axes import Value
from mechsym.sweep.data import columns, failures
from mechsym.sweep.run import Sweep
from mechsym.sweep.sensitivity import SobolIndex, indices


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
    along = zip(*sweep.points, strict=True) if "sample" in sweep.dims else (a.values for a in sweep.axes)
    failed = tuple(
        FailedPoint(index=i, at=Columns(dict(zip(axis_units, sweep.points[i], strict=True)), axis_units), reason=reason)
        for i, reason in failures(sweep).items()
    )
    # a word that is not there is null, as a number
    told = {name: [v if v != "" else None for v in column.tolist()] for name, column in data.items()}
    return SweepNumbers(
        case=sweep.case,
        analysis=sweep.analysis,
        dims=dict(sweep.dims),
        shape=tuple(sweep.dims.values()),
        axes={a.key: SweptAxis(unit=a.unit, values=tuple(v)) for a, v in zip(sweep.axes, along, strict=True)},
        units={name: sweep.units[name] for name in data},
        data=Columns(told, sweep.units),
        failed=failed,
        sobol=tuple(indices(sweep)) if sweep.sobol else (),
        interrupted=sweep.interrupted,
        kept=sweep.kept,
        set_aside=sweep.aside or None,
        files=tuple(map(str, files)),
    )

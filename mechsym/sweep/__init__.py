"""Many runs of a case over ranges of its values, or over samples of them, as one labelled data set.

    result = sweep(Plan(case="zotov-89", over=("spring.p0=3..8 MPa:11", "speed_rpm=80,89")))
    dataset(result)["guide.z_max"].sel(speed_rpm=89)

What runs is what the case is for: a driven machine is simulated (side by side in compiled code), an engine with a
spring gets its hinge designed, an engine without one runs its cycle (as one map). A point that cannot be computed is a
gap with a reason, not the end of the sweep.

axes.py      what to run over: ranges, lists, distributions, values that follow from these
run.py       the points in chunks, from the store or computed
work.py      chunks on processes; a worker that dies takes one point with it
cluster.py   chunks on a dask cluster
store.py     finished points in a file: the same command goes on where it stopped
points.py    how a chunk is computed: simulations, hinges, cycles; those that differ in numbers only as one map
hinges.py    hinges whose guides are judged side by side; which guides can be built, many at once
outcomes.py  a result, or a gap with a reason; what the other commands say of one case
data.py      labelled columns with units, CSV, netCDF, Sobol indices; what the commands tell of a sweep
plots.py     the picture
study.py     several sweeps of a file, one report
"""

from mechsym.sweep.axes import Axis
from mechsym.sweep.data import columns, dataset, failures, main_results, write_netcdf, write_table
from mechsym.sweep.outcomes import Gap
from mechsym.sweep.run import Means, Plan, Sweep, ends, forecast, layout, sweep

__all__ = [
    "Axis",
    "Gap",
    "Means",
    "Plan",
    "Sweep",
    "columns",
    "dataset",
    "ends",
    "failures",
    "forecast",
    "layout",
    "main_results",
    "sweep",
    "write_netcdf",
    "write_table",
]


def __dir__() -> list[str]:
    return __all__

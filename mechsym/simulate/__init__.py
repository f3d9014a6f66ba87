"""Time simulation with an honest error figure: energy audit and tolerance check in every result.

problem.py    what to run: mechanism, parts on its inputs, start, splits, stops
equations.py  first-order equations with the work of every part
run.py        smooth phases one after another, then the checks
many.py       problems of one form side by side
backends.py   integrators by name
result.py     columns with units, CSV and netCDF
"""

from mechsym.simulate.many import simulate_many
from mechsym.simulate.problem import Formula, Kinks, Part, Periodic, Problem, Steps, Stop
from mechsym.simulate.result import Energy, Event, Result, dataset, write_netcdf, write_series
from mechsym.simulate.run import simulate
from mechsym.simulate.settings import Settings

__all__ = [
    "Energy",
    "Event",
    "Formula",
    "Kinks",
    "Part",
    "Periodic",
    "Problem",
    "Result",
    "Settings",
    "Steps",
    "Stop",
    "dataset",
    "simulate",
    "simulate_many",
    "write_netcdf",
    "write_series",
]

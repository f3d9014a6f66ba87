"""Time simulation with an honest error figure: energy audit and tolerance check in every result.

problem      what to run: mechanism, parts on its inputs, start, splits, stops
equations    first-order equations with the work of every part
run, many    smooth phases one after another, then the checks; problems of one form side by side
backends     integrators by name
result       columns with units, CSV and netCDF; summary sums a run up
engine       a Machine over time (`problem`) or over its angle (`reduced`)
angle, angle_turn, steady    one turn over the angle, the periodic motion, flywheels
loop         the engine cycle integrated together with the motion
"""

from mechsym.simulate.engine import problem, reduced
from mechsym.simulate.many import simulate_many
from mechsym.simulate.problem import Part, Periodic, Problem, Steps
from mechsym.simulate.result import Result, write_netcdf, write_series
from mechsym.simulate.run import simulate
from mechsym.simulate.settings import Settings
from mechsym.simulate.steady import steady_state

__all__ = [
    "Part", "Periodic", "Problem", "Result", "Settings", "Steps", "problem", "reduced", "simulate", "simulate_many",
    "steady_state", "write_netcdf", "write_series",
]  # fmt: skip


def __dir__() -> list[str]:
    return __all__

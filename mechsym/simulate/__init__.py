"""Time simulation with an honest error figure: energy audit and tolerance check in every result.

problem      what to run: mechanism, parts on its inputs, start, splits, stops
equations    first-order equations with the work of every part
run, many    smooth phases one after another, then the checks; problems of one form side by side
backends     integrators by name
result       columns with units, CSV and netCDF; summary sums a run up
speed, between               least and greatest of a motion, also between its samples
engine       a Machine over time (`problem`) or over its angle (`reduced`)
angle, angle_turn, steady    one turn over the angle, the periodic motion, flywheels
loop         the engine cycle integrated together with the motion
"""

from mechsym.quantities import lazily

_NAMES = {
    "Part": "mechsym.simulate.problem:Part",
    "Periodic": "mechsym.simulate.problem:Periodic",
    "Problem": "mechsym.simulate.problem:Problem",
    "problem": "mechsym.simulate.engine:problem",
    "reduced": "mechsym.simulate.engine:reduced",
    "Result": "mechsym.simulate.result:Result",
    "Settings": "mechsym.simulate.settings:Settings",
    "simulate": "mechsym.simulate.run:simulate",
    "simulate_many": "mechsym.simulate.many:simulate_many",
    "steady_state": "mechsym.simulate.steady:steady_state",
    "Steps": "mechsym.simulate.problem:Steps",
    "write_netcdf": "mechsym.simulate.result:write_netcdf",
    "write_series": "mechsym.simulate.result:write_series",
}
__all__ = sorted(_NAMES)
__getattr__ = lazily(__name__, _NAMES)

"""Design of an engine by optimisation.

solver    what may change and what must hold, as numbers; solved with IPOPT, its limits explained
trace     a measured run      identify   parameters out of it, with intervals      fit   the closest motion
"""

from mechsym.optimise.solver import Limit, Optimise, Optimum, Programme, pareto, problem, solve

__all__ = ["Limit", "Optimise", "Optimum", "Programme", "pareto", "problem", "solve"]


def __dir__() -> list[str]:
    return __all__

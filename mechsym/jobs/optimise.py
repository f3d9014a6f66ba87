"""Case -> optimum: the design problem of `[optimise]`, solved once, and against a second aim where one is named."""

from dataclasses import replace

from mechsym.cases import Case
from mechsym.jobs.cycle import engine
from mechsym.optimise.problem import Optimise, problem
from mechsym.optimise.solver import Optimum, pareto, solve
from mechsym.page import Shown
from mechsym.quantities import record


@record
class Optimised(Shown):
    """The best design, and the front against the second aim."""

    best: Optimum
    front: tuple[Optimum, ...] = ()  #: Empty where no second aim is named; its first point is the best design


_LIMITS = {"peak_pressure": "p_max", "peak_temperature": "t_max", "knock": "knock"}


def _limited(case: Case) -> Optimise:
    """`[optimise]` with the limits of `[gas_limits]` that it does not name itself."""
    section: Optimise = case.need("optimise")
    limits = case.sections.get("gas_limits")
    known = {figure: getattr(limits, key, None) for key, figure in _LIMITS.items()}
    asked = {figure: {"high": value} for figure, value in known.items() if value is not None}
    return replace(section, constraints=asked | section.constraints)


def optimise(case: Case) -> Optimised:
    """Best design of a case under its limits.

    Parameters
    ----------
    case : Case
        With `[optimise]` and a spark-ignition cycle

    Returns
    -------
    found : Optimised
        Status, variables, active limits and multipliers
    """
    section = _limited(case)
    task = problem(engine(case), case.need("operation").speed, section)
    if not section.against:
        return Optimised(best=solve(task))
    front = pareto(task, section.against, section.against_goal, int(section.points))
    return Optimised(best=front[0], front=tuple(front))

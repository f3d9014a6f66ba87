"""Case -> optimum: the design problem of `[optimise]`, solved once, and against a second aim where one is named."""

from mechsym.cases import Case
from mechsym.jobs.cycle import engine
from mechsym.optimise.problem import problem
from mechsym.optimise.solver import Optimum, pareto, solve
from mechsym.quantities import record


@record
class Optimised:
    """The best design, and the front against the second aim."""

    best: Optimum
    front: tuple[Optimum, ...] = ()  #: Empty where no second aim is named; its first point is the best design


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
    section = case.need("optimise")
    task = problem(engine(case), case.need("operation").speed, section)
    if not section.against:
        return Optimised(best=solve(task))
    front = pareto(task, section.against, section.against_goal, int(section.points))
    return Optimised(best=front[0], front=tuple(front))

"""The best design, the front against a second aim, and what other words give."""

from collections.abc import Mapping

from mechsym.optimise.solver import Optimum
from mechsym.page import Shown
from mechsym.quantities.results import Columns, part, quantity, result


@result
class ParetoPoint:
    """A best design for a given value of the second figure."""

    status: str = part()
    figures: Columns = part(inline=True)  #: Objective and second figure
    variables: Columns = part()  #: The design


@result
class TriedWords:
    """What one combination of words gives."""

    words: Mapping[str, str] = part(inline=True)
    status: str = part()
    objective: float = quantity("@unit")  #: Figure that is as large or small as can be
    variables: Columns = part()  #: The design
    unit: str  # of the objective


@result
class Optimised(Shown):
    """The best design, and the front against the second aim."""

    best: Optimum = part(inline=True)
    goal: str = part()
    objective_name: str = part()
    #: Best designs for values of the second aim, the best of all first
    pareto: tuple[ParetoPoint, ...] = part(default=(), optional=True)
    chosen: Mapping[str, str] | None = part(default=None, optional=True)  #: Words of the best design
    choices: tuple[TriedWords, ...] = part(default=(), optional=True)  #: What each combination of words gives
    front: tuple[Optimum, ...] = ()  # of `pareto`

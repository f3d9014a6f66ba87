"""IPOPT, called in one place: how it ends, and what its errors mean for the machine."""

from collections.abc import Mapping
from typing import Any

import casadi as ca

from mechsym import interrupts
from mechsym.errors import BadInput
from mechsym.quantities import record

#: What IPOPT's ways to end mean
_MEANS = {
    "Infeasible_Problem_Detected": "no design near it keeps all limits",
    "Restoration_Failed": "no step comes nearer to the limits",
    "Maximum_Iterations_Exceeded": "it was still on its way",
    "Diverging_Iterates": "nothing bounds the design",
    "Search_Direction_Becomes_Too_Small": "limits contradict one another, or one value does nothing",
    "Not_Enough_Degrees_Of_Freedom": "there are more equations than values to choose",
    "Invalid_Number_Detected": "a formula has no value there: a loop that opens, or a root of a negative number",
    "Error_In_Step_Computation": "the equations determine no step: a value that no equation holds",
}
_STATUS = {"Solve_Succeeded": "optimal", "Infeasible_Problem_Detected": "infeasible"}
_NEARLY = "Solved_To_Acceptable_Level"


@record
class Solved:
    """What IPOPT gives, and how it ended."""

    values: Mapping[str, Any]  #: `x`, and the prices of bounds, rows and parameters
    status: str  #: `optimal`, `infeasible` or `not converged`
    reason: str  #: The solver's own words, and what they mean
    iterations: int


def ipopt(solver: ca.Function, given: Mapping[str, Any], nearly: bool = False) -> Solved:
    """Call IPOPT.

    given: start, bounds and parameters, as CasADi calls them. nearly: whether its acceptable level is good enough.
    Raises BadInput: it cannot begin: what CasADi has thrown.
    """
    try:
        values = solver(**given)
        stats = solver.stats()
    except RuntimeError as error:
        interrupts.check()  # which CasADi makes an error of
        said = str(error).strip().splitlines()[-1]
        raise BadInput(f"the design problem cannot be solved ({said}): {_MEANS['Invalid_Number_Detected']}") from error
    status = stats["return_status"]
    means = f": {_MEANS[status]}" if status in _MEANS else ""
    reached = "optimal" if nearly and status == _NEARLY else _STATUS.get(status, "not converged")
    reason = status.replace("_", " ").lower() + means
    return Solved(values=values, status=reached, reason=reason, iterations=int(stats["iter_count"]))

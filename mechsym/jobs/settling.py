"""Case -> where its engine settles after a start on an elastic crank train."""

from mechsym.cases import Case
from mechsym.jobs.flywheel import shaft
from mechsym.machine import ConstantLoad
from mechsym.mechanisms.traits import is_train
from mechsym.simulate import Result
from mechsym.simulate.angle import tabulate
from mechsym.simulate.engine import reduced
from mechsym.simulate.steady import steady_state
from mechsym.torsion.settling import Settling, settling
from mechsym.torsion.twist import natural_frequencies

_PERIODS = 20.0  # a shorter run tells nothing of where it settles


def settled(case: Case, result: Result) -> Settling | None:
    """Where the engine of a case settles; None for a run that is no start of an engine against a load.

    A start has `simulation.speed_start`, a cycle, and a load that grows with speed.
    """
    wanted = case.sections.get("simulation")
    has = is_train(case.mechanism) and "cycle" in case.sections and "load" in case.sections
    if not has or wanted is None or wanted.speed_start is None or isinstance(case.need("load"), ConstantLoad):
        return None
    rigid, turned = shaft(case, 0.0), float(result.columns["phi_f"][-1] - result.columns["phi_f"][0])
    if result.end not in ("turns", "t_end") or turned < _PERIODS * rigid.period:
        return None
    steady = steady_state(tabulate(reduced(rigid)), rigid.omega)
    return settling(result, "phi_f", rigid.period, natural_frequencies(case.need("parameters")), steady.speed_mean)

"""The hinge cut for the cycle at one load, run at others: what is left of the steady speed.

The guide stays as it was cut. At another load the gas torque has another shape, so the hinge misses it; a spring set
anew for that load takes part of the rest away.
"""

import dataclasses
from collections.abc import Sequence

from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.hinge import balance, guide
from mechsym.hinge import torque as hinge
from mechsym.hinge.retune import retune
from mechsym.hinge.setting import setting_of, with_setting
from mechsym.hinge.steady import with_spring
from mechsym.jobs.machine import assemble, load_of
from mechsym.quantities import record
from mechsym.simulate.steady import Steady


@record
class AtLoad:
    """The hinge at one load."""

    share: float  #: Load over that of the design [-]
    mean_indicated_pressure: float  #: Load [Pa]
    as_cut: Steady
    reset: Steady  #: With the spring setting that fits this load's work best
    #: That setting, p0 [Pa] or F0 of a coil [N], and over that of the design [-]
    setting: float
    ratio: float


def design_load(case: Case) -> float:
    """The load that a case is designed for.

    Returns
    -------
    mean_indicated_pressure : float
        Of its cycle [Pa]

    Raises
    ------
    BadInput
        The cycle has no mean indicated pressure to change
    """
    cycle = case.need("cycle")
    if not hasattr(cycle, "mean_indicated_pressure"):
        raise BadInput(f"{case.file}: [cycle] has no mean_indicated_pressure that could be changed; it has one load")
    return float(cycle.mean_indicated_pressure)


def hinge_at_loads(case: Case, loads: Sequence[float]) -> list[AtLoad]:
    """Steady running of the hinge of a case at other loads, at the speed of operation.

    Parameters
    ----------
    case : Case
        As for `design`; its cycle must have a `mean_indicated_pressure`
    loads : sequence of float
        Mean indicated pressures to try [Pa]

    Raises
    ------
    BadInput
        The cycle has no mean indicated pressure to change, or the guide cannot be cut
    """
    design_load(case)
    engine = assemble(case)
    part = balance.build(hinge.build(engine.torques, engine.omega), case.need("guide").balance)
    cut = guide.build(part, case.need("spring"), case.need("guide"))
    if cut.rho is None:
        raise BadInput(f"{case.file}: the guide cannot be cut; see 'mechsym hinge'")
    return guide_at_loads(case, cut, loads)


def guide_at_loads(case: Case, cut: guide.Guide, loads: Sequence[float]) -> list[AtLoad]:
    """Steady running of a guide at other loads, at the speed of operation.

    Parameters
    ----------
    cut : Guide
        Guide of its hinge, status `cut`
    loads : sequence of float
        Mean indicated pressures to try [Pa]
    """
    return [_at(case, cut, load) for load in loads]


def _at(case: Case, cut: guide.Guide, load: float) -> AtLoad:
    cycle = dataclasses.replace(case.need("cycle"), mean_indicated_pressure=load)
    other = assemble(dataclasses.replace(case, sections={**case.sections, "cycle": cycle}))
    wanted = hinge.build(other.torques, other.omega)
    setting = retune(cut, wanted, "least_squares_work").setting
    springs = (cut.spring, with_setting(cut.spring, setting))
    as_cut, reset = (with_spring(other, wanted, cut, load_of(case), spring) for spring in springs)
    return AtLoad(
        share=load / design_load(case),
        mean_indicated_pressure=load,
        as_cut=as_cut,
        reset=reset,
        setting=setting,
        ratio=setting / setting_of(cut.spring),
    )

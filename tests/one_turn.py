"""One turn of a case as tests look at it: its table, its numbers."""

from types import SimpleNamespace

from mechsym.forces.loads import power_residual
from mechsym.forces.result import forces
from mechsym.jobs.machine import turn
from mechsym.quantities.results import tell


def turned(case):
    """A case over one cycle at constant speed."""
    found = forces(turn(case), case.sections.get("friction"))
    one = found.turn
    return SimpleNamespace(
        forces=found, columns=found.columns, phi=one.phi, omega=one.omega,
        power_residual=power_residual(one, found.loads),
    )  # fmt: skip


def numbers(case):
    """What `mechsym forces` tells of it."""
    from mechsym.jobs.forces import reported

    return tell(reported(case, turned(case).forces))

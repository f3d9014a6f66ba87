"""A case over one cycle at constant speed, and the friction of its mechanism over the speeds."""

from collections.abc import Sequence
from dataclasses import replace

from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.forces.friction_law import FittedLaw, fit
from mechsym.forces.rings import NoRings
from mechsym.forces.turn import CrankDrive, Turn, crank_drive
from mechsym.forces.turn import turn as turn_of
from mechsym.jobs.gas import gas, of
from mechsym.mechanisms.traits import traits_of


def turn(case: Case) -> Turn:
    """One cycle of a case.

    Parameters
    ----------
    case : Case
        With `[operation]`; `[cycle]` gives the gas, `[faces]` and `[closing]` belong to a rodless engine
    """
    drive, omega = drive_of(case), case.need("operation").speed
    return turn_of(drive, gas(case), omega)


def drive_of(case: Case) -> CrankDrive:
    """The mechanism of a case with every reaction determined."""
    parameters, known = case.need("parameters"), traits_of(case.mechanism)
    undetermined = known is not None and known.chain is not None and known.chain.overconstrained
    closing = case.need("closing") if undetermined else None
    faces = case.need("faces") if closing and "cycle" in case.sections else case.sections.get("faces")
    with of(case):
        return crank_drive(case.mechanism, parameters, faces, closing)


def fitted_law(case: Case, omega: Sequence[float]) -> FittedLaw:
    """The friction of a case's joints and rings as a law of the cycle.

    Parameters
    ----------
    case : Case
        With `[cycle]` and `[friction]`, perhaps `[rings]`
    omega : sequence of float
        Crank speeds; a single one gives a constant [rad/s]

    Raises
    ------
    BadInput
        The case has no cycle
    """
    if "cycle" not in case.sections:
        raise BadInput(f"{case.file}: a friction mean pressure needs a [cycle]")
    operation = case.need("operation")
    cases = [replace(case, sections={**case.sections, "operation": replace(operation, speed=w)}) for w in omega]
    return fit([turn(one) for one in cases], case.need("friction"), case.sections.get("rings", NoRings()))

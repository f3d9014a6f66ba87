"""Crankshaft and flywheel on a torsional spring: their numbers (Chmielewski et al. 2015)."""

from mechsym import mechanisms
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities.records import Record

NAME = "crankshaft_flywheel"
#: Two discs, one slider crank
CrankshaftFlywheelParameters = mechanisms.parameters_class(NAME)


def build(parameters: Record) -> Mechanism:
    """The exact mechanism. Returns mechanism: coordinates phi0, phi2; inputs M, F."""
    return mechanisms.build(NAME, parameters)

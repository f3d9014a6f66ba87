"""One throw of a crank train: its numbers. Drawing and letters: derivations/crank_throw.py."""

from mechsym import mechanisms
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities.records import Record

NAME = "crank_throw"
#: Crank, rod with its own inertia, piston on an offset axis
CrankThrowParameters = mechanisms.parameters_class(NAME)


def build(parameters: Record) -> Mechanism:
    """A single throw on its own shaft: coordinate phi; inputs F, M (torque of the shaft on the throw)."""
    return mechanisms.build(NAME, parameters)

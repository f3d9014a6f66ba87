"""Torsional vibration of shafts.

modes      natural frequencies, orders of excitation, critical speeds
twist      twist of every section of a shaft in a run
train      criticals of a crank train at its speed of operation
startup    a start-up by a weak drive: which critical speeds held it; findings says it in sentences
plots      Campbell diagram, start-up, twist
"""

from mechsym.torsion.modes import critical_speeds, matrices, orders
from mechsym.torsion.startup import start_up
from mechsym.torsion.twist import natural_frequencies, sections

__all__ = ["critical_speeds", "matrices", "natural_frequencies", "orders", "sections", "start_up"]


def __dir__() -> list[str]:
    return __all__

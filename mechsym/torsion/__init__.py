"""Torsional vibration of shafts.

modes      natural frequencies, orders of excitation, critical speeds, stiffness that keeps major orders away
twist      twist of every section of a shaft in a run, where an engine settles, criticals of a crank train
startup    a start-up by a weak drive: which critical speeds held it, in sentences and numbers; a finished run
shown      Campbell diagram, start-up, twist, and what has to be known first
"""

from mechsym.quantities import lazily

_NAMES = {
    "critical_speeds": "mechsym.torsion.modes:critical_speeds",
    "matrices": "mechsym.torsion.modes:matrices",
    "natural_frequencies": "mechsym.torsion.twist:natural_frequencies",
    "orders": "mechsym.torsion.modes:orders",
    "sections": "mechsym.torsion.twist:sections",
    "start_up": "mechsym.torsion.startup:start_up",
}
__all__ = sorted(_NAMES)
__getattr__ = lazily(__name__, _NAMES)

"""From the torque wanted to the verdict, in the order of the work.

torque      the torque M_h that keeps the crank at constant speed     balance, ways   which part of it is taken
springs     force, energy and closing of each law                     choices         arrangement, start, shaft
guide       the track cut for a spring                                rollers, contact  forces around a turn
limits      can it be built?                                          setting, retune   another speed or load
fitted      the machine with its hinge                                ripple, steady, trials  how it turns
result      a finished design                                         summary, plots, report
"""

from mechsym.hinge.contact import at_angles
from mechsym.hinge.fitted import fitted
from mechsym.hinge.guide import crank_torque, cut, refit
from mechsym.hinge.limits import judge
from mechsym.hinge.retune import retune
from mechsym.hinge.rollers import parallel
from mechsym.hinge.springs import AirAbsolute, AirGauge, Coil
from mechsym.hinge.torque import torque

__all__ = [
    "AirAbsolute", "AirGauge", "Coil", "at_angles", "crank_torque", "cut", "fitted", "judge", "parallel", "refit",
    "retune", "torque",
]  # fmt: skip


def __dir__() -> list[str]:
    return __all__

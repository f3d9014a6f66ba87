"""From the torque wanted to the verdict, in the order of the work.

torque      the torque M_h that keeps the crank at constant speed     balance         what of it is taken, what is left
springs     force, energy and closing of each law                     choices         arrangement, start, shaft, limits
guide       the track cut for a spring, its setting, its machine      rollers         forces around a turn
limits      can it be built?                                          steady, trials    how it turns, also elsewhere
result      a finished design                                         summary, plots, shown
"""

from mechsym.quantities import lazily

_NAMES = {
    "AirAbsolute": "mechsym.hinge.springs.air:AirAbsolute",
    "AirGauge": "mechsym.hinge.springs.air:AirGauge",
    "at_angles": "mechsym.hinge.limits:at_angles",
    "Coil": "mechsym.hinge.springs.coil:Coil",
    "crank_torque": "mechsym.hinge.guide:crank_torque",
    "cut": "mechsym.hinge.guide:cut",
    "fitted": "mechsym.hinge.guide:fitted",
    "judge": "mechsym.hinge.limits:judge",
    "Limits": "mechsym.hinge.choices:Limits",
    "parallel": "mechsym.hinge.rollers:parallel",
    "refit": "mechsym.hinge.guide:refit",
    "retune": "mechsym.hinge.steady:retune",
    "torque": "mechsym.hinge.torque:torque",
}
__all__ = sorted(_NAMES)
__getattr__ = lazily(__name__, _NAMES)

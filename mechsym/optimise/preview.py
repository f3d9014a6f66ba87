r"""A trace beside the machine that is told to have made it, before anything is fitted.

.. math:: \Delta T = \left[\tfrac12 u^T M u\right], \qquad \Delta W = \int u^T Q\,dt, \qquad \Delta T = \Delta W

A wrong unit of the speeds by s multiplies the first by s^2 and the second by s; times in ms under [s] multiply the
second alone. Elastic parts take their energy and give it back, so that the whole trace shows the sum.
"""

import math

import numpy as np

from mechsym.errors import BadInput
from mechsym.optimise.fit import TracedMotion, followed
from mechsym.optimise.trace import Trace
from mechsym.quantities.units import Second

_OFF = 6.0  # between energy and work, beyond which a unit is wrong; a parameter at the start is seldom so far off
_CHANGED = 0.3  # of its largest kinetic energy that a machine gains or loses on a trace that tells of its forces
_END = 0.05  # of the samples at each end that are averaged
_SLIPS = {
    57.29578: "deg/s under [rad/s]",
    1 / 57.29578: "rad/s under [deg/s]",
    9.549297: "rpm under [rad/s]",
    1 / 9.549297: "rad/s under [rpm]",
    1e-3: "ms under [s]",
    1e3: "s under [ms]",
}


def require_plausible(model: TracedMotion, trace: Trace, angles: list[float], longest: Second) -> None:
    """Refuse a trace that the machine cannot have made: too few samples for its motion, energy from nowhere.

    angles: how far beyond its pose the machine may have started [rad]; longest: interval of the collocation. Raises
    BadInput: with the slip of the unit that would explain it.
    """
    period = 4 * math.pi * longest
    step = float(np.median(np.diff(trace.t)))
    if step > period:
        raise BadInput(
            f"{trace.file}: a sample every {step:.3g} s, and by this model and these speeds it turns or swings once in "
            f"{period:.3g} s: ms under [s], or a speed in another unit? sample faster where both are right"
        )
    if {model.turning[model.velocities.index(name)] for name in trace.speeds} != set(model.turning):
        return  # what slides was not measured
    if not np.isfinite(model.low).all():
        return  # work whose sign is not known tells nothing
    ratios = (_ratio(model, trace, angle) for angle in angles)
    ratio = min(ratios, key=lambda r: (r < 0, abs(math.log(abs(r)))))
    if ratio < 0:
        raise BadInput(
            f"{trace.file}: its kinetic energy grows where all known forces take work, or falls where they give it: a "
            "speed or a torque with the other sign?"
        )
    if not 1 / _OFF <= ratio <= _OFF:
        slip = min(_SLIPS, key=lambda s: abs(math.log(ratio / s)))
        hint = f": {_SLIPS[slip]}?" if 0.5 < ratio / slip < 2 else ": another machine, or a wrong unit?"
        raise BadInput(
            f"{trace.file}: its kinetic energy changes by {ratio:.3g} times the work of all known forces{hint} Mend "
            "the head of the column, or set values nearer to the machine with --set"
        )


def _ratio(model: TracedMotion, trace: Trace, angle: float) -> float:
    """Change of kinetic energy by the work of what is known, both signs told; 1 where the trace does not tell it."""
    states = followed(model, trace, trace.t, angle)
    known = model.known(trace.t)
    kinetic, power = (
        np.asarray(v)[0] for v in model.energy(states, known, np.tile(model.start[:, None], trace.t.size))
    )
    if not (np.isfinite(kinetic).all() and np.isfinite(power).all()):
        return 1.0
    end = max(1, round(_END * trace.t.size))
    gained = float(kinetic[-end:].mean() - kinetic[:end].mean())
    work = float(np.sum(np.diff(trace.t) * (power[1:] + power[:-1]) / 2))
    enough = _CHANGED * float(np.abs(kinetic).max())
    if model.lossy:  # what is looked for takes as much of the work as it likes, and gives none
        return gained / max(work, enough / 10) if gained > max(enough, _OFF * work) else 1.0
    if max(abs(gained), abs(work)) < enough or not enough:
        return 1.0
    ratio = max(abs(gained), 1e-12 * enough) / max(abs(work), 1e-12 * enough)
    return math.copysign(ratio, gained * work) if min(abs(gained), abs(work)) >= enough else ratio

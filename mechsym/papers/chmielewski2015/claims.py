"""What decides the claims of source 002, and what its mixed model costs in torque and energy."""

import numpy as np

from mechsym.audit.hosts.sources import Turn
from mechsym.audit.judge.question import Question, turn, value
from mechsym.audit.read.reader import read
from mechsym.audit.theory.catalogue import theory
from mechsym.audit.theory.record import known
from mechsym.audit.verdict import Decision
from mechsym.papers.chmielewski2015 import rows as computed
from mechsym.papers.sources import Weighed, against, weighed
from mechsym.quantities import dimension

_LEVER = "sin(phi0) + lam*sin(phi0)*cos(phi0)/sqrt(1 - lam**2*sin(phi0)**2)"
_MIXED = f"({_LEVER})*r*m0*r*phi0d**2*(cos(phi0) + lam*cos(2*phi0))"
_STEADY = {"phi0dd": 0.0, "c1": 0.0, "F": 0.0, "k1": 0.0}


def steady() -> Turn:
    """A turn at constant speed without twist. Returns turn: phi2 and phi0dd of the crank angle."""
    return {"phi2": np.copy, "phi0dd": np.zeros_like}


def mixed_model_effect(verdict: Decision) -> str:
    """Peak torque mismatch against the exact equation at 194 rad/s, and the energy that the start-up gains or loses."""
    energy = computed.mixed_model_energy()
    worst = float(energy[np.argmax(np.abs(energy))])
    return (
        f"{_mismatch('crankshaft_flywheel')}; over the start-up of 100 s the model's energy drifts by up to "
        f"{abs(worst):.1e} of the work of the drive ({float(energy[-1]):+.1e} at the end)"
    )


def mixed_model_truncated_effect(verdict: Decision) -> str:
    """Peak torque mismatch against the Lagrange equation of the truncated travel at 194 rad/s."""
    return _mismatch("crankshaft_flywheel_truncated")


def _mismatch(name: str) -> str:
    shaft = theory(name)
    hold = {k: v for k, v in _STEADY.items() if k in shaft.letters}
    question = Question(formula=read(_MIXED, known(shaft)), theory=shaft, quantity="driving_torque", hold=hold)
    asked = turn(question)
    difference = float(np.max(np.abs(value(asked, question.formula.tree) - asked.expected)))
    peak = float(np.max(np.abs(asked.expected)))
    return (
        f"at 194 rad/s the inertia torque is up to {difference:.2f} N m off, {100 * difference / peak:.1f} % of its "
        "peak, with a drive of 1.5 N m"
    )


def settles() -> Weighed:
    """The mean speed after 90 s from two integrators, and from a rigid drive."""
    means = []
    for backend in ("auto", "sundials"):
        result = computed.run("crankshaft_flywheel_printed", backend=backend)
        means.append(float(result.columns["phi0d"][result.t >= result.t[-1] - 2].mean()))
    rigid = computed.rigid_speed(computed.CLAIMED_TIME)
    exact = abs(computed.run("crankshaft_flywheel").energy.residual or 0.0)
    residual = "below 1e-8" if exact < 1e-8 else f"{exact:.0e}"
    return against(means[0], computed.CLAIMED_SPEED, 0.01, rigid=rigid, means=means, residual=residual)


def constant_speed() -> Weighed:
    """The rate of the mean speed of a rigid drive without losses."""
    return weighed(False, rate=computed.rigid_speed(2.0))


def unit_of_stiffness() -> Weighed:
    """The unit that makes k1 (phi0 - phi2) a torque."""
    return weighed(dimension("N/m") == dimension("N*m"))

"""Chmielewski et al. (2015): the start-up of section 2.2, run and looked at.

The paper solved (6) with (11) and (2) and reports a speed of 194 rad/s from 90 s on. Here: the printed model and the
exact one, adaptive or with a fixed step; a rigid shaft as a hand check; the speeds and the motion of the piston. What
the runs say about convergence stands in chmielewski2015_studies.py.
"""

import dataclasses
from functools import cache

import numpy as np

from mechsym import cases, mechanisms
from mechsym.jobs.problem import problem_of
from mechsym.mechanisms.record import acceleration_function
from mechsym.quantities import record
from mechsym.simulate import Problem, Result, Settings, simulate
from mechsym.simulate.fixed_step import fixed_step
from mechsym.torsion import modes as torsion

CASE = "chmielewski"
CLAIMED_SPEED, CLAIMED_TIME = 194.0, 90.0  # section 2.2 [rad/s, s]
EXACT, PRINTED = "crankshaft_flywheel", "crankshaft_flywheel_printed"
# integrator and tolerance, from rough to fine, the last by a second integrator
SWEEP = (("scipy-dop853", 1e-8), ("scipy-dop853", 1e-10), ("sundials", 1e-11))
FINEST = SWEEP[-1]


@record
class WindowSpeeds:
    """Crank speed of a run after the time that the paper names."""

    name: str  #: Model, integrator and tolerance or step
    #: Over the last two seconds [rad/s]
    mean: float
    lowest: float
    highest: float
    peak_at_claim: float  #: Largest speed in the two seconds from 90 s on [rad/s]
    #: Share of the drive's work that is not in the energy at the end; None where it is not known [-]
    energy_residual: float | None


def problem(model: str) -> Problem:
    """The start-up of the case with one of its two models.

    Returns
    -------
    problem : Problem
        0 to 100 s, torque step at 1 s
    """
    case = cases.load(CASE)
    return dataclasses.replace(problem_of(case), mechanism=mechanisms.build(model, case.need("parameters")))


@cache
def run(model: str, tolerance: float = 1e-11, backend: str = "auto") -> Result:
    """One start-up without a second run for comparison.

    Parameters
    ----------
    tolerance : float
        Of a step [-]
    """
    return simulate(problem(model), Settings(tolerance=tolerance, backend=backend, check="none"))


def rigid_speed(t: float) -> float:
    r"""Speed that a rigid drive has at most, :math:`M (t - 1) / (I_0 + I_2)`.

    Parameters
    ----------
    t : float
        Time [s]

    Returns
    -------
    speed : float
        Without the piston's inertia, which lowers it [rad/s]
    """
    case = cases.load(CASE)
    p, drive = case.need("parameters"), case.need("drive")
    return float(drive.torque * (t - drive.time) / (p.I0 + p.I2))


def rigid_speed_with_piston(t: float) -> float:
    r"""Speed of a rigid drive that also carries the piston's mean inertia: the hand check.

    .. math:: \omega = \frac{M\,(t - 1)}{I_0 + I_2 + \overline{m_0 x_0'^2}}

    Parameters
    ----------
    t : float
        Time [s]

    Returns
    -------
    speed : float
        What the work of the drive allows as a mean speed [rad/s]
    """
    case = cases.load(CASE)
    linear = torsion.matrices(mechanisms.build(EXACT, case.need("parameters")))
    drive = case.need("drive")
    return float(drive.torque * (t - drive.time) / linear.mass.sum())


def mean_speed(t: np.ndarray, angle: np.ndarray, since: float, until: float = np.inf) -> float:
    """Mean in time of a crank's speed.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Times [s]
    angle : ndarray, shape (n,)
        Crank angle [rad]
    since, until : float
        Stretch; its ends are moved to the next times inside [s]

    Returns
    -------
    mean : float
        Angle over time [rad/s]
    """
    inside = (t >= since) & (t <= until)
    return float(np.ptp(angle[inside]) / np.ptp(t[inside]))


def speeds(name: str, t: np.ndarray, speed: np.ndarray, residual: float | None) -> WindowSpeeds:
    """What a run says about the paper's claim.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Times [s]
    speed : ndarray, shape (n,)
        Crank speed [rad/s]
    residual : float or None
        Energy residual [-]
    """
    end, claim = speed[t >= t[-1] - 2], speed[(t >= CLAIMED_TIME) & (t < CLAIMED_TIME + 2)]
    return WindowSpeeds(
        name=name,
        mean=float(end.mean()),
        lowest=float(end.min()),
        highest=float(end.max()),
        peak_at_claim=float(claim.max()),
        energy_residual=residual,
    )


@cache
def fixed(model: str, step: float, order: int) -> tuple[np.ndarray, np.ndarray]:
    """A start-up with a fixed step.

    Parameters
    ----------
    step : float
        Step [s]

    Returns
    -------
    t : ndarray, shape (n,)
        Times [s]
    y : ndarray, shape (n, m)
        phi0, phi2, their speeds, and the energy columns [SI]
    """
    with np.errstate(all="ignore"):
        return fixed_step(problem(model), step, order)


@cache
def piston() -> dict[str, np.ndarray]:
    """Motion of the piston and the crank's acceleration along the finest run of the exact model.

    Returns
    -------
    columns : dict of str to ndarray, shape (n,)
        `x0` [m], `v` [m/s], `a` [m/s^2], `epsilon` [rad/s^2], in SI [-]
    """
    found, mechanism = run(EXACT, FINEST[1], FINEST[0]), problem(EXACT).mechanism
    drive = cases.load(CASE).need("drive")
    given = {name: column[None, :] for name, column in found.columns.items()}
    given |= {"M": np.where(found.t > drive.time, drive.torque, 0.0)[None, :], "F": np.zeros_like(given["phi0"])}
    accelerations, kinematics = acceleration_function(mechanism), mechanism.functions["kinematics"]
    epsilon = np.asarray(accelerations.call([given[n] for n in accelerations.name_in()])[0])[0]
    values = kinematics.call([given[n] for n in kinematics.name_in()])
    x = dict(zip(kinematics.name_out(), (np.asarray(v).ravel() for v in values), strict=True))
    speed = found.columns["phi0d"]
    return {
        "x0": x["x0"],
        "v": x["dx0_dphi0"] * speed,
        "a": x["dx0_dphi0"] * epsilon + x["d2x0_dphi0_dphi0"] * speed**2,
        "epsilon": epsilon,
    }

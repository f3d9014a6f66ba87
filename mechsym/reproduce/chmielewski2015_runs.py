"""Chmielewski et al. (2015): the start-up of section 2.2, converged, and what a fixed step makes of it.

The paper solved (6) with (11) and (2), reports a speed of 194 rad/s from 90 s on, and warns that its curves depend on
the step. Here: the printed model and the exact one, each to convergence; a rigid shaft as a hand check; and runs with
a fixed step, because those end where the paper's do.
"""

import dataclasses
from functools import cache

import numpy as np

from mechsym import cases, mechanisms, torsion
from mechsym.mechanism import acceleration_function
from mechsym.runs import problem_of
from mechsym.simulate import Problem, Result, Settings, simulate
from mechsym.simulate.audit import energies
from mechsym.simulate.fixed_step import fixed_step

CASE = "chmielewski"
CLAIMED_SPEED, CLAIMED_TIME = 194.0, 90.0  # section 2.2 [rad/s, s]
# steps with which classical Runge-Kutta and the third-order formula of Bogacki and Shampine hold the shaft at resonance
# with a peak speed of about the paper's; the paper prints neither formula nor step [s]
TELLING_STEP, TELLING_STEP_3 = 2.57e-3, 0.88e-3
EXACT, PRINTED = "crankshaft_flywheel", "crankshaft_flywheel_printed"
# integrator and tolerance, from rough to fine, the last by a second integrator
SWEEP = (("scipy-dop853", 1e-8), ("scipy-dop853", 1e-10), ("sundials", 1e-11))
FINEST = SWEEP[-1]


@dataclasses.dataclass(frozen=True, kw_only=True)
class Speeds:
    """Crank speed of a run after the time that the paper names.

    Parameters
    ----------
    name : str
        Model, integrator and tolerance or step
    mean, lowest, highest : float
        Over the last two seconds [rad/s]
    peak_at_claim : float
        Largest speed in the two seconds from 90 s on [rad/s]
    energy_residual : float or None
        Share of the drive's work that is not in the energy at the end; None where it is not known [-]
    """

    name: str
    mean: float
    lowest: float
    highest: float
    peak_at_claim: float
    energy_residual: float | None


@dataclasses.dataclass(frozen=True, kw_only=True)
class Reached:
    """What a run reaches from 90 s on.

    Parameters
    ----------
    name : str
        Integrator with its tolerance or step
    mean : float
        Angle over time until the end [rad/s]
    peak : float
        Largest momentary speed within two seconds [rad/s]
    energy_residual : float or None
        Share of the drive's work that is not in the energy at the end; None where it is not known [-]
    """

    name: str
    mean: float
    peak: float
    energy_residual: float | None


def problem(model: str) -> Problem:
    """The start-up of the case with one of its two models.

    Parameters
    ----------
    model : str
        `crankshaft_flywheel` or `crankshaft_flywheel_printed`

    Returns
    -------
    problem : Problem
        0 to 100 s, torque step at 1 s
    """
    case = cases.load(CASE)
    return dataclasses.replace(problem_of(case), mechanism=mechanisms.build(model, case.need("parameters")))


@cache
def run(model: str, tolerance: float = 1e-10, backend: str = "scipy-dop853") -> Result:
    """One start-up without a second run for comparison.

    Parameters
    ----------
    model : str
        Name of the mechanism
    tolerance : float
        Of a step [-]
    backend : str
        Integrator

    Returns
    -------
    result : Result
        Made once
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


def _reached(name: str, t: np.ndarray, angle: np.ndarray, speed: np.ndarray, residual: float | None) -> Reached:
    claim = (t >= CLAIMED_TIME) & (t < CLAIMED_TIME + 2)
    mean = mean_speed(t, angle, CLAIMED_TIME)
    return Reached(name=name, mean=mean, peak=float(speed[claim].max()), energy_residual=residual)


def speeds(name: str, t: np.ndarray, speed: np.ndarray, residual: float | None) -> Speeds:
    """What a run says about the paper's claim.

    Parameters
    ----------
    name : str
        Name of the run
    t : ndarray, shape (n,)
        Times [s]
    speed : ndarray, shape (n,)
        Crank speed [rad/s]
    residual : float or None
        Energy residual [-]

    Returns
    -------
    speeds : Speeds
        Mean and extremes
    """
    end, claim = speed[t >= t[-1] - 2], speed[(t >= CLAIMED_TIME) & (t < CLAIMED_TIME + 2)]
    return Speeds(
        name=name,
        mean=float(end.mean()),
        lowest=float(end.min()),
        highest=float(end.max()),
        peak_at_claim=float(claim.max()),
        energy_residual=residual,
    )


def energy_gained(model: str, t: np.ndarray, q: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Energy of the exact mechanism minus the work of the torque, along a run of any model.

    Parameters
    ----------
    model : str
        Mechanism that has energies
    t : ndarray, shape (n,)
        Times [s]
    q, u : ndarray, shape (2, n)
        Angles [rad] and speeds [rad/s]

    Returns
    -------
    share : ndarray, shape (n,)
        As a share of the work done by the end [-]
    """
    case = cases.load(CASE)
    drive = case.need("drive")
    found = energies(mechanisms.build(model, case.need("parameters")), q, u)
    assert found is not None
    work = drive.torque * (q[0] - np.interp(drive.time, t, q[0]))
    return np.where(t < drive.time, 0.0, (found[0] + found[1] - work) / work[-1])


def mixed_model_energy() -> np.ndarray:
    """Energy that the printed model makes or loses over the start-up.

    Returns
    -------
    share : ndarray, shape (n,)
        As a share of the work done by the end [-]
    """
    result = run("crankshaft_flywheel_printed")
    q, u = (np.array([result.columns[f"{a}{d}"] for a in ("phi0", "phi2")]) for d in ("", "d"))
    return energy_gained("crankshaft_flywheel", result.t, q, u)


@cache
def fixed(model: str, step: float, order: int) -> tuple[np.ndarray, np.ndarray]:
    """A start-up with a fixed step.

    Parameters
    ----------
    model : str
        Name of the mechanism
    step : float
        Step [s]
    order : int
        3 or 4

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
def convergence() -> dict[str, tuple[Reached, ...]]:
    """Both models along `SWEEP`.

    Returns
    -------
    study : dict of str to tuple of Reached
        Model to one entry per run
    """
    return {model: tuple(_adaptive(model, tol, backend) for backend, tol in SWEEP) for model in (EXACT, PRINTED)}


def _adaptive(model: str, tolerance: float, backend: str) -> Reached:
    result = run(model, tolerance, backend)
    columns, name = result.columns, f"{backend} at {tolerance:g}"
    return _reached(name, result.t, columns["phi0"], columns["phi0d"], result.energy.residual)


@cache
def step_study() -> tuple[Reached, ...]:
    """The printed model with fixed steps; the energy residual is what the formula loses of the work.

    Returns
    -------
    study : tuple of Reached
        One per order and step
    """
    found = []
    for order, step in ((4, 5e-3), (4, TELLING_STEP), (3, TELLING_STEP_3)):
        t, y = fixed(PRINTED, step, order)
        gained = energy_gained(EXACT, t, y[:, :2].T, y[:, 2:4].T)
        name = f"Runge-Kutta {order}, {1000 * step:g} ms"
        found.append(_reached(name, t, y[:, 0], y[:, 2], -float(gained[-1])))
    return tuple(found)


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

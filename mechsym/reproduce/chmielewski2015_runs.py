"""The start-up of Chmielewski et al. (2015), section 2.2: converged runs, and what a fixed step makes of it.

The paper solved (6) with (11) and (2), reports a speed of 194 rad/s from 90 s on, and warns that its curves depend on
the step. Here: the printed model and the exact one, each to convergence; a rigid shaft as a hand check; and runs with
a fixed step, because those end where the paper's do.
"""

import dataclasses
from functools import cache

import numpy as np

from mechsym import cases, mechanisms
from mechsym.mechanism import acceleration_function
from mechsym.runs import problem_of
from mechsym.simulate import Problem, Result, Settings, simulate
from mechsym.simulate.audit import energies
from mechsym.simulate.fixed_step import fixed_step

CASE = "chmielewski"
CLAIMED_SPEED, CLAIMED_TIME = 194.0, 90.0  # section 2.2 [rad/s, s]
# fitted: classical Runge-Kutta with this step holds the shaft at resonance with a peak speed of the paper's [s]
TELLING_STEP = 2.57e-3


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


def crank_acceleration(result: Result) -> np.ndarray:
    """Acceleration of the crank along a run of the printed model.

    Parameters
    ----------
    result : Result
        Of `run`

    Returns
    -------
    acceleration : ndarray, shape (n,)
        From its equations, not by differences [rad/s^2]
    """
    function = acceleration_function(problem("crankshaft_flywheel_printed").mechanism)
    drive = cases.load(CASE).need("drive")
    torque = np.where(result.t < drive.time, 0.0, drive.torque)
    known = {**result.columns, "M": torque}
    rows = [np.broadcast_to(known.get(n, 0.0), result.t.shape)[None, :] for n in function.name_in()]
    return np.asarray(function(*rows))[0]


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
def convergence() -> tuple[Speeds, ...]:
    """Both models at three tolerances, and by a second integrator.

    Returns
    -------
    study : tuple of Speeds
        One per run
    """
    found = []
    for model in ("crankshaft_flywheel", "crankshaft_flywheel_printed"):
        for tolerance in (1e-8, 1e-10, 1e-12):
            found.append(_adaptive(model, tolerance, "scipy-dop853"))
        found.append(_adaptive(model, 1e-12, "sundials"))
    return tuple(found)


def _adaptive(model: str, tolerance: float, backend: str) -> Speeds:
    result = run(model, tolerance, backend)
    name = f"{model}, {backend}, tolerance {tolerance:g}"
    return speeds(name, result.t, result.columns["phi0d"], result.energy.residual)


@cache
def step_study() -> tuple[Speeds, ...]:
    """The printed model with fixed steps.

    Returns
    -------
    study : tuple of Speeds
        One per step and order
    """
    found = []
    for order, step in ((4, 5e-3), (4, TELLING_STEP), (4, 1e-3), (3, 5e-3), (3, 1e-3)):
        t, y = fixed("crankshaft_flywheel_printed", step, order)
        gained = energy_gained("crankshaft_flywheel", t, y[:, :2].T, y[:, 2:4].T)
        name = f"crankshaft_flywheel_printed, Runge-Kutta {order}, step {1000 * step:g} ms"
        found.append(speeds(name, t, y[:, 2], -float(gained[-1])))
    return tuple(found)

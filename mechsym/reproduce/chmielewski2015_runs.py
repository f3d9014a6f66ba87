"""Runs of the start-up of Chmielewski et al. (2015): exact and printed model, converged and with fixed steps."""

import dataclasses
from dataclasses import dataclass
from functools import cache

import numpy as np

from mechsym import cases, mechanisms
from mechsym.cases import Case
from mechsym.mechanism import Mechanism, acceleration_function
from mechsym.runs import StepTorque, problem_of
from mechsym.simulate import Problem, Result, Settings, simulate
from mechsym.simulate.fixed_step import fixed_step

CLAIM_TIME = 90.0  # section 2.2 [s]
# backend and tolerance of the exact model, from rough to fine; the third is a second integrator
SWEEP = (("scipy-dop853", 1e-8), ("scipy-dop853", 1e-10), ("sundials", 1e-11))
FIXED_ORDER = 3  # Bogacki-Shampine, "ode3" of the program that the source used
FIXED_STEP = 0.88e-3  # gives the printed speed as a peak; the source prints no step [s]


@dataclass(frozen=True, kw_only=True)
class Runs:
    """Everything that the source's section 2.2 can be compared with.

    Parameters
    ----------
    case : Case
        Data
    exact : Result
        Exact equations, the finest of the sweep
    printed : Result
        Equation (6) with (11), the same settings
    sweep : tuple of tuple
        Backend, tolerance, mean speed of the crank from 90 s on, energy residual
    t_fixed, speed_fixed : ndarray, shape (m,)
        Printed model with a fixed step [s], [rad/s]
    """

    case: Case
    exact: Result
    printed: Result
    sweep: tuple[tuple[str, float, float, float | None], ...]
    t_fixed: np.ndarray
    speed_fixed: np.ndarray


@cache
def runs() -> Runs:
    """Run all of them, once in a program.

    Returns
    -------
    runs : Runs
        Some ten seconds of computing
    """
    case = cases.load("chmielewski")
    problem = problem_of(case)
    results = [(b, tol, simulate(problem, Settings(backend=b, tolerance=tol, check="none"))) for b, tol in SWEEP]
    printed = dataclasses.replace(problem, mechanism=printed_model(case))
    backend, tolerance, exact = results[-1]
    t, y = fixed_step(printed, FIXED_STEP, FIXED_ORDER)
    return Runs(
        case=case,
        exact=exact,
        printed=simulate(printed, Settings(backend=backend, tolerance=tolerance, check="none")),
        sweep=tuple((b, tol, mean_speed(r, CLAIM_TIME), r.energy.residual) for b, tol, r in results),
        t_fixed=t,
        speed_fixed=y[:, 2],
    )


def printed_model(case: Case) -> Mechanism:
    """Equation (6) with (11), as printed.

    Parameters
    ----------
    case : Case
        Data

    Returns
    -------
    mechanism : Mechanism
        Without energies
    """
    return mechanisms.build("crankshaft_flywheel_printed", case.need("parameters"))


def mean_speed(result: Result, since: float, until: float = np.inf) -> float:
    """Mean speed of the crank over a stretch of time.

    Parameters
    ----------
    result : Result
        A run
    since, until : float
        Stretch; its ends are moved to the next times of the result inside [s]

    Returns
    -------
    speed : float
        Angle over time [rad/s]
    """
    inside = (result.t >= since) & (result.t <= until)
    return float(np.ptp(result.columns["phi0"][inside]) / np.ptp(result.t[inside]))


def piston(found: Runs) -> dict[str, np.ndarray]:
    """Motion of the piston and the crank's acceleration along the exact run.

    Parameters
    ----------
    found : Runs
        Runs

    Returns
    -------
    columns : dict of str to ndarray, shape (n,)
        `x0` [m], `v` [m/s], `a` [m/s^2], `epsilon` [rad/s^2]
    """
    problem: Problem = problem_of(found.case)
    mechanism, columns = problem.mechanism, found.exact.columns
    phi0, phi2, phi0d, phi2d = (columns[n][None, :] for n in ("phi0", "phi2", "phi0d", "phi2d"))
    drive: StepTorque = found.case.need("drive")
    torque = np.where(found.exact.t > drive.time, drive.torque, 0.0)[None, :]
    given = {"phi0": phi0, "phi2": phi2, "phi0d": phi0d, "phi2d": phi2d, "M": torque}
    function = acceleration_function(mechanism)
    epsilon = np.asarray(function.call([given.get(n, np.zeros_like(phi0)) for n in function.name_in()])[0])[0]
    kinematics = mechanism.functions["kinematics"]
    found_values = kinematics.call([given[n] for n in kinematics.name_in()])
    x = dict(zip(kinematics.name_out(), (np.asarray(v).ravel() for v in found_values), strict=True))
    speed = columns["phi0d"]
    return {
        "x0": x["x0"],
        "v": x["dx0_dphi0"] * speed,
        "a": x["dx0_dphi0"] * epsilon + x["d2x0_dphi0_dphi0"] * speed**2,
        "epsilon": epsilon,
    }

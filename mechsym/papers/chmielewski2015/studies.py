"""Chmielewski et al. (2015): does the start-up converge, what does a fixed step make of it, where does energy go.

The paper warns that its curves depend on the step. Both models are run to convergence by two integrators; runs with a
fixed step are shown because those end where the paper's do; the mixed model is held against the exact energy.
"""

from functools import cache

import numpy as np

from mechsym import cases, mechanisms
from mechsym.papers.chmielewski2015.computed import CASE, CLAIMED_TIME, EXACT, PRINTED, SWEEP, fixed, mean_speed, run
from mechsym.quantities import record
from mechsym.simulate.audit import energies

# steps with which classical Runge-Kutta and the third-order formula of Bogacki and Shampine hold the shaft at resonance
# with a peak speed of about the paper's; the paper prints neither formula nor step [s]
TELLING_STEP, TELLING_STEP_3 = 2.57e-3, 0.88e-3


@record
class Reached:
    """What a run reaches from 90 s on."""

    name: str  #: Integrator with its tolerance or step
    mean: float  #: Angle over time until the end [rad/s]
    peak: float  #: Largest momentary speed within two seconds [rad/s]
    #: Share of the drive's work that is not in the energy at the end; None where it is not known [-]
    energy_residual: float | None


def _reached(name: str, t: np.ndarray, angle: np.ndarray, speed: np.ndarray, residual: float | None) -> Reached:
    claim = (t >= CLAIMED_TIME) & (t < CLAIMED_TIME + 2)
    mean = mean_speed(t, angle, CLAIMED_TIME)
    return Reached(name=name, mean=mean, peak=float(speed[claim].max()), energy_residual=residual)


def energy_gained(model: str, t: np.ndarray, q: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Energy of the exact mechanism minus the work of the torque, along a run of any model.

    Parameters
    ----------
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
    """The printed model with fixed steps; the energy residual is what the formula loses of the work."""
    found = []
    for order, step in ((4, 5e-3), (4, TELLING_STEP), (3, TELLING_STEP_3)):
        t, y = fixed(PRINTED, step, order)
        gained = energy_gained(EXACT, t, y[:, :2].T, y[:, 2:4].T)
        name = f"Runge-Kutta {order}, {1000 * step:g} ms"
        found.append(_reached(name, t, y[:, 0], y[:, 2], -float(gained[-1])))
    return tuple(found)

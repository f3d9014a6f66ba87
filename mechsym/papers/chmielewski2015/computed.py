"""Chmielewski et al. (2015): the start-up of section 2.2, run and looked at.

The paper solved (6) with (11) and (2) and reports a speed of 194 rad/s from 90 s on. Here: the printed model and the
exact one, adaptive or with a fixed step; a rigid shaft as a hand check; the speeds and the motion of the piston. Both
models are run to convergence by two integrators; runs with a fixed step are shown because those end where the paper's
do; the mixed model is held against the exact energy.
"""

import dataclasses
from functools import cache

import numpy as np

from mechsym import cases, mechanisms
from mechsym.jobs.problem import problem_of
from mechsym.mechanisms.record import acceleration_function
from mechsym.quantities import record
from mechsym.simulate import Problem, Result, Settings, simulate
from mechsym.simulate.audit import energies
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
    """Crank speed of a run at its end."""

    name: str  #: Model, integrator and tolerance or step
    #: Over the last two seconds [rad/s]
    mean: float
    lowest: float
    highest: float
    #: Share of the drive's work that is not in the energy at the end; None where it is not known [-]
    energy_residual: float | None


def problem(model: str) -> Problem:
    """The start-up of the case with one of its two models. Returns problem: 0 to 100 s, torque step at 1 s."""
    case = cases.load(CASE)
    return dataclasses.replace(problem_of(case), mechanism=mechanisms.build(model, case.need("parameters")))


@cache
def run(model: str, tolerance: float = 1e-11, backend: str = "auto") -> Result:
    """One start-up without a second run for comparison. tolerance: of a step [-]."""
    return simulate(problem(model), Settings(tolerance=tolerance, backend=backend, check="none"))


def rigid_speed(t: float) -> float:
    r"""Speed that a rigid drive has at most, :math:`M (t - 1) / (I_0 + I_2)`.

    t: time [s]. Returns speed: without the piston's inertia, which lowers it [rad/s].
    """
    case = cases.load(CASE)
    p, drive = case.need("parameters"), case.need("drive")
    return float(drive.torque * (t - drive.time) / (p.I0 + p.I2))


def rigid_speed_with_piston(t: float) -> float:
    r"""Speed of a rigid drive that also carries the piston's mean inertia: the hand check.

    .. math:: \omega = \frac{M\,(t - 1)}{I_0 + I_2 + \overline{m_0 x_0'^2}}

    t: time [s]. Returns speed: what the work of the drive allows as a mean speed [rad/s].
    """
    case = cases.load(CASE)
    linear = torsion.matrices(mechanisms.build(EXACT, case.need("parameters")))
    drive = case.need("drive")
    return float(drive.torque * (t - drive.time) / linear.mass.sum())


def mean_speed(t: np.ndarray, angle: np.ndarray, since: float, until: float = np.inf) -> float:
    """Mean in time of a crank's speed.

    t: times [s]; angle: crank angle [rad]; since, until: stretch; its ends are moved to the next times inside [s].
    Returns mean: angle over time [rad/s].
    """
    inside = (t >= since) & (t <= until)
    return float(np.ptp(angle[inside]) / np.ptp(t[inside]))


def speeds(name: str, t: np.ndarray, speed: np.ndarray, residual: float | None) -> WindowSpeeds:
    """How fast a run turns at its end. t: times [s]; speed: crank speed [rad/s]; residual: energy residual [-]."""
    end = speed[t >= t[-1] - 2]
    return WindowSpeeds(
        name=name, mean=float(end.mean()), lowest=float(end.min()), highest=float(end.max()), energy_residual=residual
    )


@cache
def fixed(model: str, step: float, order: int) -> tuple[np.ndarray, np.ndarray]:
    """A start-up with a fixed step [s]: times [s]; phi0, phi2, their speeds, and the energy columns [SI]."""
    with np.errstate(all="ignore"):
        return fixed_step(problem(model), step, order)


@cache
def piston() -> dict[str, np.ndarray]:
    """Motion of the piston and the crank's acceleration along the finest run of the exact model.

    Returns columns: `x0` [m], `v` [m/s], `a` [m/s^2], `epsilon` [rad/s^2], in SI [-].
    """
    result, mechanism = run(EXACT, FINEST[1], FINEST[0]), problem(EXACT).mechanism
    drive = cases.load(CASE).need("drive")
    given = {name: column[None, :] for name, column in result.columns.items()}
    given |= {"M": np.where(result.t > drive.time, drive.torque, 0.0)[None, :], "F": np.zeros_like(given["phi0"])}
    accelerations, kinematics = acceleration_function(mechanism), mechanism.functions["kinematics"]
    epsilon = np.asarray(accelerations.call([given[n] for n in accelerations.name_in()])[0])[0]
    values = kinematics.call([given[n] for n in kinematics.name_in()])
    x = dict(zip(kinematics.name_out(), (np.asarray(v).ravel() for v in values), strict=True))
    speed = result.columns["phi0d"]
    return {
        "x0": x["x0"],
        "v": x["dx0_dphi0"] * speed,
        "a": x["dx0_dphi0"] * epsilon + x["d2x0_dphi0_dphi0"] * speed**2,
        "epsilon": epsilon,
    }


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

    t: times [s]; q, u: angles [rad] and speeds [rad/s]. Returns share: as a share of the work done by the end [-].
    """
    case = cases.load(CASE)
    drive = case.need("drive")
    both = energies(mechanisms.build(model, case.need("parameters")), q, u)
    assert both is not None
    work = drive.torque * (q[0] - np.interp(drive.time, t, q[0]))
    return np.where(t < drive.time, 0.0, (both[0] + both[1] - work) / work[-1])


def mixed_model_energy() -> np.ndarray:
    """Energy that the printed model makes or loses over the start-up, by the work done by the end [-]."""
    result = run("crankshaft_flywheel_printed")
    q, u = (np.array([result.columns[f"{a}{d}"] for a in ("phi0", "phi2")]) for d in ("", "d"))
    return energy_gained("crankshaft_flywheel", result.t, q, u)


@cache
def convergence() -> dict[str, tuple[Reached, ...]]:
    """Both models along `SWEEP`. Returns study: model to one entry per run."""
    return {model: tuple(_adaptive(model, tol, backend) for backend, tol in SWEEP) for model in (EXACT, PRINTED)}


def _adaptive(model: str, tolerance: float, backend: str) -> Reached:
    result = run(model, tolerance, backend)
    columns, name = result.columns, f"{backend} at {tolerance:g}"
    return _reached(name, result.t, columns["phi0"], columns["phi0d"], result.energy.residual)


@cache
def step_study() -> tuple[Reached, ...]:
    """The printed model with fixed steps; the energy residual is what the formula loses of the work."""
    reached = []
    for order, step in ((4, 5e-3), (4, TELLING_STEP), (3, TELLING_STEP_3)):
        t, y = fixed(PRINTED, step, order)
        gained = energy_gained(EXACT, t, y[:, :2].T, y[:, 2:4].T)
        name = f"Runge-Kutta {order}, {1000 * step:g} ms"
        reached.append(_reached(name, t, y[:, 0], y[:, 2], -float(gained[-1])))
    return tuple(reached)

"""Numbers and claims of Chmielewski et al. (2015) beside the converged start-up.

The paper reports that the crank settles at 194 rad/s after 90 s. Neither the exact equations nor the printed ones do
that, however finely they are integrated, and the work of the drive does not allow it.
"""

import dataclasses
from functools import cache, partial

import numpy as np

from mechsym import cases, jobs, mechanisms
from mechsym.cases import load
from mechsym.jobs.problem import problem_of
from mechsym.mechanisms.record import acceleration_function
from mechsym.papers.rows import NOT_COMPUTABLE, REPRODUCED, Row, by_digits, listed
from mechsym.quantities import record
from mechsym.simulate import Problem, Result, Settings, simulate
from mechsym.simulate.audit import energies
from mechsym.simulate.fixed_step import fixed_step
from mechsym.torsion import modes as torsion

CASE = "chmielewski"
CLAIMED_SPEED, CLAIMED_TIME = 194.0, 90.0  # section 2.2 [rad/s, s]
_row = partial(listed, "chmielewski2015")
EXACT, PRINTED = "crankshaft_flywheel", "crankshaft_flywheel_printed"
# integrator and tolerance, from rough to fine, the last by a second integrator
SWEEP = (("auto", 1e-8), ("auto", 1e-10), ("sundials", 1e-11))
FINEST = SWEEP[-1]


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
    columns, name = result.columns, f"{'mechsym' if backend == 'auto' else backend} at {tolerance:g}"
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


_CONSTANT = 0.01  # what the eye takes for constant in a figure [-]


def rows() -> list[Row]:
    """Every number and claim of section 2.2, and what the conclusions announce."""
    result = run(EXACT, FINEST[1], FINEST[0])
    announced = [_in_time("schmidt"), _in_time("stirling-adiabatic"), _second_order()]
    return [_torque(result), *_speed(result), *_shape(result), *_amplitudes(result), *_steps(), *announced]


def _torque(result: Result) -> Row:
    work, angle = result.columns["work_drive"], float(result.columns["phi0"][-1])
    onset, torque = float(result.t[int(np.argmax(work > 0)) - 1]), float(work[-1]) / angle
    holds = onset == 1.0 and by_digits("1.5", torque) == REPRODUCED
    return _row("torque", torque, holds)


def _speed(result: Result) -> list[Row]:
    t_end = float(result.t[-1])
    exact, printed = (convergence()[model][-1].mean for model in (EXACT, PRINTED))
    rigid = rigid_speed_with_piston(t_end)
    return [
        _row("exact", exact, by_digits("194", exact), runs=_in_words(EXACT)),
        _row("printed", printed, by_digits("194", printed), runs=_in_words(PRINTED)),
        _row("allowed", rigid, rigid >= 194, claimed=rigid_speed_with_piston(CLAIMED_TIME)),
    ]


def _in_words(model: str) -> str:
    """The convergence of the mean speed, one clause for each run."""
    clauses = []
    for one in convergence()[model]:
        residual = "" if one.energy_residual is None else f", energy residual {one.energy_residual:.0e}"
        clauses.append(f"{one.name}: {one.mean:.5f} rad/s{residual}")
    return "; ".join(clauses)


def _shape(result: Result) -> list[Row]:
    t, angle = result.t, result.columns["phi0"]
    late = mean_speed(t, angle, 99.0) - mean_speed(t, angle, 90.0, 91.0)
    risen = mean_speed(t, angle, 84.0, 85.0) - mean_speed(t, angle, 55.0, 56.0)
    since = t >= CLAIMED_TIME
    chord = np.interp(t[since], t[since][[0, -1]], angle[since][[0, -1]])
    bent = float(np.abs(angle[since] - chord).max() / np.ptp(angle[since]))
    return [
        _row("constant_speed", late, abs(late) < 1.0),
        _row("rises", risen, risen > 1.0),
        _row("linear", bent, bent < _CONSTANT),
    ]


def _amplitudes(result: Result) -> list[Row]:
    t, moved = result.t, piston()

    def largest(key: str, since: float) -> float:
        return float(np.abs(moved[key][(t >= since) & (t <= since + 5.0)]).max())

    lines = [_row("displacement", float(moved["x0"].max()), NOT_COMPUTABLE)]
    for figure, key, name in (
        ("7", "v", "piston velocity"),
        ("8", "a", "piston acceleration"),
        ("11", "epsilon", "angular acceleration"),
    ):
        end = largest(key, 95.0)
        growth = end / largest(key, 90.0) - 1
        lines.append(_row("amplitude", growth, abs(growth) < _CONSTANT, figure=figure, name=name, end=end))
    until, after = largest("epsilon", 45.0), largest("epsilon", 85.0) - largest("epsilon", 45.0)
    return [*lines, _row("growth", after / until, after < until)]


def _steps() -> list[Row]:
    converged = convergence()[PRINTED][-1].mean
    apart = max(abs(s.mean / converged - 1) for s in step_study())
    peaks = ", ".join(f"{s.name} {s.peak:.0f}" for s in step_study()[1:])
    telling, runs = step_study()[1], "; ".join(f"{s.name}: {s.mean:.2f} rad/s" for s in step_study())
    lost = 100 * (telling.energy_residual or 0)
    return [
        _row("steps", apart, apart > _CONSTANT, runs=runs),
        _row("own_step", telling.peak, NOT_COMPUTABLE, peaks=peaks, lost=lost, mean=telling.mean),
    ]


_CASE = "alpha-stirling"
_RESIDUAL = 1e-8  # of the energy of a run [-]


def _in_time(kind: str) -> Row:
    turning = jobs.run(load(_CASE, {"cycle.kind": kind}), check="none")
    speed, residual = turning.result.columns["phi_fd"], abs(turning.result.energy.residual or 0.0)
    mean = float(np.mean(speed[-len(speed) // 10 :]))
    critical = next((line for line in turning.findings if "critical" in line), "no critical near the speed")
    return _row(kind, mean, residual < _RESIDUAL, residual=residual, critical=critical)


def _second_order() -> Row:
    ideal, real = (
        jobs.cycle(load(_CASE, {"cycle.kind": kind})) for kind in ("stirling-adiabatic", "stirling-second-order")
    )
    before, after = (float(figures["efficiency"][0]) for figures in (ideal, real))
    lost = ", ".join(f"{name.replace('_', ' ')} {values[0]:.0f} W" for name, values in real["losses"].items())
    power = float(real["power_kw"][0]) * 1e3
    return _row("second_order", after, 0 < after < before, before=before, power=power, lost=lost)

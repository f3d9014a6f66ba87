"""Numbers and claims of Chmielewski et al. (2015) beside the converged start-up.

The paper reports that the crank settles at 194 rad/s after 90 s. Neither the exact equations nor the printed ones do
that, however finely they are integrated, and the work of the drive does not allow it.
"""

import dataclasses
from functools import cache

import numpy as np

from mechsym import cases, jobs, mechanisms
from mechsym.cases import load
from mechsym.jobs.problem import problem_of
from mechsym.mechanisms.record import acceleration_function
from mechsym.papers.rows import NOT_COMPUTABLE, NOT_REPRODUCED, REPRODUCED, Row, by_digits, claim, row
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


_CONSTANT = 0.01  # what the eye takes for constant in a figure [-]


def rows() -> list[Row]:
    """Every number and claim of section 2.2, and what the conclusions announce."""
    result = run(EXACT, FINEST[1], FINEST[0])
    announced = [_in_time("schmidt", _TWO), _in_time("stirling-adiabatic", _HEAT), _second_order()]
    return [_torque(result), *_speed(result), *_shape(result), *_amplitudes(result), *_steps(), *announced]


def _torque(result: Result) -> Row:
    work, angle = result.columns["work_drive"], float(result.columns["phi0"][-1])
    onset, torque = float(result.t[int(np.argmax(work > 0)) - 1]), float(work[-1]) / angle
    holds = onset == 1.0 and by_digits("1.5", torque) == REPRODUCED
    return claim("Fig. 5: torque stepped on at 1 s, work over angle [N*m]", "1.5", torque, holds)


def _speed(result: Result) -> list[Row]:
    t_end = float(result.t[-1])
    exact, printed = (convergence()[model][-1].mean for model in (EXACT, PRINTED))
    rigid = rigid_speed_with_piston(t_end)
    return [
        row("Fig. 10: mean crank speed from 90 s on [rad/s]", "194", exact, by_digits("194", exact), _in_words(EXACT)),
        row(
            "Fig. 10: the same with (6) and (11) as printed [rad/s]", "194", printed, by_digits("194", printed),
            f"the misprint of the equation does not explain it; {_in_words(PRINTED)}",
        ),
        claim(
            "Fig. 10: mean speed that the drive's work allows at 100 s [rad/s]", "194", rigid, rigid >= 194,
            f"hand check, M (t - 1)/(I0 + I2 + mean of m0 x0'^2); {rigid_speed_with_piston(CLAIMED_TIME):.1f} at 90 s",
        ),
    ]  # fmt: skip


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
        claim(
            "Fig. 10: speed above 90 s, its gain until 100 s [rad/s]", "constant", late, abs(late) < 1.0,
            "constant torque without dissipation: no steady speed exists",
        ),
        claim(
            "speed up to 85 s, its gain from 55 to 85 s [rad/s]", "rises", risen, risen > 1.0,
            "the second order of the piston's inertia meets the natural frequency there and holds the shaft at half of "
            "it until about 90 s; the drive feeds the vibration",
        ),
        claim(
            "Fig. 9: angle above 90 s, largest departure from a line over the angle turned", "linear", bent,
            bent < _CONSTANT, "the speed goes on growing",
        ),
    ]  # fmt: skip


def _amplitudes(result: Result) -> list[Row]:
    t, moved = result.t, piston()

    def largest(key: str, since: float) -> float:
        return float(np.abs(moved[key][(t >= since) & (t <= since + 5.0)]).max())

    highest = float(moved["x0"].max())
    lines = [row("Fig. 6: largest piston displacement [m]", None, highest, NOT_COMPUTABLE, "no value printed")]
    for figure, key, name in (
        ("7", "v", "piston velocity"),
        ("8", "a", "piston acceleration"),
        ("11", "epsilon", "angular acceleration"),
    ):
        growth = largest(key, 95.0) / largest(key, 90.0) - 1
        item = f"Fig. {figure}: amplitude of the {name} above 90 s, its growth until 100 s"
        note = f"amplitude {largest(key, 95.0):.4g} at the end"
        lines.append(claim(item, "constant", growth, abs(growth) < _CONSTANT, note))
    until, after = largest("epsilon", 45.0), largest("epsilon", 85.0) - largest("epsilon", 45.0)
    item = "Fig. 11: amplitude grows fast to 50 s and slower from 50 to 90 s, second gain over first"
    note = "the other way round: the shaft is caught by the resonance at 53 s"
    return [*lines, claim(item, "< 1", after / until, after < until, note)]


def _steps() -> list[Row]:
    converged = convergence()[PRINTED][-1].mean
    apart = max(abs(s.mean / converged - 1) for s in step_study())
    peaks = ", ".join(f"{s.name} {s.peak:.0f}" for s in step_study()[1:])
    telling = step_study()[1]
    return [
        claim(
            "the result depends on the step, largest change of the mean speed from 90 s on",
            "depends",
            apart,
            apart > _CONSTANT,
            "; ".join(f"{s.name}: {s.mean:.2f} rad/s" for s in step_study()),
        ),
        row(
            "Fig. 10: 194 rad/s with the source's integrator and step [rad/s]",
            "194",
            telling.peak,
            NOT_COMPUTABLE,
            "the source prints neither; several fixed steps give it as a peak of the speed from 90 s on "
            f"({peaks} rad/s): they lose work, {100 * (telling.energy_residual or 0):.0f} % with the first, so that "
            f"the shaft is held at a mean of {telling.mean:.1f} rad/s for ever, with the source's constant amplitudes",
        ),
    ]


_CASE = "alpha-stirling"
_RESIDUAL = 1e-8  # of the energy of a run [-]
_TWO = "a model with two pistons offset by a predetermined phase angle"
_HEAT = "the dynamic model of the Stirling engine including the thermodynamic processes"


def _in_time(kind: str, words: str) -> Row:
    turning = jobs.run(load(_CASE, {"cycle.kind": kind}), check="none")
    speed, residual = turning.result.columns["phi_fd"], abs(turning.result.energy.residual or 0.0)
    mean = float(np.mean(speed[-len(speed) // 10 :]))
    critical = next((line for line in turning.findings if "critical" in line), "no critical near the speed")
    item = f"conclusions: flywheel of the alpha engine after 30 turns, kind {kind} [rad/s]"
    note = f"announced, no value printed; energy residual {residual:.0e}; {critical}"
    return row(item, words, mean, REPRODUCED if residual < _RESIDUAL else NOT_REPRODUCED, note)


def _second_order() -> Row:
    ideal, real = (
        jobs.cycle(load(_CASE, {"cycle.kind": kind})) for kind in ("stirling-adiabatic", "stirling-second-order")
    )
    before, after = (float(figures["efficiency"][0]) for figures in (ideal, real))
    lost = ", ".join(f"{name.replace('_', ' ')} {values[0]:.0f} W" for name, values in real["losses"].items())
    item = "conclusions: efficiency of the second order at 600 rpm [-]"
    note = (
        f"announced, no value printed; {before:.3f} without losses; {float(real['power_kw'][0]) * 1e3:.0f} W left, "
        f"lost: {lost}"
    )
    words = "the thermodynamic model of the II order, which considers the losses"
    return row(item, words, after, REPRODUCED if 0 < after < before else NOT_REPRODUCED, note)

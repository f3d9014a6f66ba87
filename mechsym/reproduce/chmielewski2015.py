"""Numbers and claims of Chmielewski et al. (2015) beside the converged start-up.

The paper reports that the crank settles at 194 rad/s after 90 s. Neither the exact equations nor the printed ones do
that, however finely they are integrated, and the work of the drive does not allow it.
"""

from typing import Any

import numpy as np

from mechsym import mechanisms, torsion
from mechsym.cases import Case
from mechsym.reproduce.chmielewski2015_runs import CLAIM_TIME, FIXED_STEP, Runs, mean_speed, piston, runs
from mechsym.reproduce.record import NOT_COMPUTABLE, NOT_REPRODUCED, REPRODUCED, by_digits, row

SOURCE = "002_d7297926d6c52225"
_CONSTANT = 0.01  # what the eye takes for constant in a figure [-]


def rows() -> list[dict[str, Any]]:
    """Every number and claim of section 2.2.

    Returns
    -------
    rows : list of dict
        Keys as in `record.row`
    """
    found = runs()
    return [_torque(found), *_speed(found), *_amplitudes(found), *_steps(found)]


def rigid_speed(case: Case, t: float) -> float:
    r"""Speed that the drive reaches at most: the hand check.

    .. math:: \omega \le \frac{M\,(t - t_0)}{I_0 + I_2 + \overline{m_0 x_0'^2}}

    Parameters
    ----------
    case : Case
        Data
    t : float
        Time [s]

    Returns
    -------
    omega : float
        Speed of a rigid shaft under the driving torque [rad/s]
    """
    drive = case.need("drive")
    linear = torsion.matrices(mechanisms.build(case.mechanism, case.need("parameters")))
    return float(drive.torque * max(t - drive.time, 0.0) / linear.mass.sum())


def convergence(found: Runs) -> str:
    """The convergence of the mean speed in words.

    Parameters
    ----------
    found : Runs
        Runs

    Returns
    -------
    text : str
        One clause for each run
    """
    return "; ".join(
        f"{backend} at {tolerance:g}: {speed:.5f} rad/s, energy residual {residual:.0e}"
        for backend, tolerance, speed, residual in found.sweep
    )


def _row(item: str, published: str | None, computed: float | None, verdict: str, note: str = "") -> dict[str, Any]:
    return row(SOURCE, item, published, computed, verdict, note)


def _claim(item: str, published: str, computed: float, holds: bool, note: str = "") -> dict[str, Any]:
    return _row(item, published, computed, REPRODUCED if holds else NOT_REPRODUCED, note)


def _torque(found: Runs) -> dict[str, Any]:
    work = found.exact.columns["work_drive"]
    onset = float(found.exact.t[int(np.argmax(work > 0)) - 1])
    angle = float(found.exact.columns["phi0"][-1])
    return _claim(
        "Fig. 5: torque stepped on at 1 s, work over angle [N*m]", "1.5", float(work[-1]) / angle,
        onset == 1.0 and by_digits("1.5", float(work[-1]) / angle) == REPRODUCED,
    )  # fmt: skip


def _speed(found: Runs) -> list[dict[str, Any]]:
    t_end = float(found.exact.t[-1])
    exact, printed = mean_speed(found.exact, CLAIM_TIME), mean_speed(found.printed, CLAIM_TIME)
    rigid = rigid_speed(found.case, t_end)
    late = mean_speed(found.exact, 99.0) - mean_speed(found.exact, 90.0, 91.0)
    risen = mean_speed(found.exact, 84.0, 85.0) - mean_speed(found.exact, 55.0, 56.0)
    bent = _bent(found.exact.t[found.exact.t >= CLAIM_TIME], found.exact.columns["phi0"][found.exact.t >= CLAIM_TIME])
    return [
        _row("Fig. 10: crank speed from 90 s on [rad/s]", "194", exact, by_digits("194", exact), convergence(found)),
        _row(
            "Fig. 10: the same with (6) and (11) as printed [rad/s]", "194", printed, by_digits("194", printed),
            "the misprints of the equation do not explain it",
        ),
        _claim(
            "Fig. 10: speed that the drive's work allows at 100 s [rad/s]", "194", rigid, rigid >= 194,
            f"hand check, M (t - 1)/(I0 + I2 + mean of m0 x0'^2); {rigid_speed(found.case, CLAIM_TIME):.1f} at 90 s",
        ),
        _claim(
            "Fig. 10: speed constant above 90 s, its gain until 100 s [rad/s]", "0", late,
            abs(late) < _CONSTANT * exact, "constant torque without dissipation: no steady speed exists",
        ),
        _claim(
            "speed rises up to 85 s, its gain from 55 to 85 s [rad/s]", "rises", risen, risen > _CONSTANT * exact,
            "the second order of the piston's inertia meets the natural frequency there and holds the shaft at "
            "94.9 rad/s until about 90 s; the drive feeds the vibration",
        ),
        _claim(
            "Fig. 9: angle linear above 90 s, largest departure over the angle turned", "0", bent, bent < _CONSTANT,
            "the speed goes on growing",
        ),
    ]  # fmt: skip


def _bent(t: np.ndarray, angle: np.ndarray) -> float:
    """Largest departure from the straight line through both ends, over the angle turned."""
    line = np.interp(t, t[[0, -1]], angle[[0, -1]])
    return float(np.abs(angle - line).max() / np.ptp(angle))


def _amplitudes(found: Runs) -> list[dict[str, Any]]:
    t, moved = found.exact.t, piston(found)

    def largest(key: str, since: float) -> float:
        return float(np.abs(moved[key][(t >= since) & (t <= since + 5.0)]).max())

    lines = [
        _row(
            "Fig. 6: largest piston displacement [m]",
            None,
            float(moved["x0"].max()),
            NOT_COMPUTABLE,
            "no value printed",
        )
    ]
    for figure, key, name in (
        ("7", "v", "piston velocity"), ("8", "a", "piston acceleration"), ("11", "epsilon", "angular acceleration"),
    ):  # fmt: skip
        growth = largest(key, 95.0) / largest(key, 90.0) - 1
        lines.append(
            _claim(
                f"Fig. {figure}: amplitude of the {name} constant above 90 s, its growth until 100 s", "0", growth,
                abs(growth) < _CONSTANT, f"amplitude {largest(key, 95.0):.4g} at the end",
            )
        )  # fmt: skip
    until, after = largest("epsilon", 45.0), largest("epsilon", 85.0) - largest("epsilon", 45.0)
    lines.append(
        _claim(
            "Fig. 11: amplitude grows fast to 50 s and slower from 50 to 90 s, second gain over first", "< 1",
            after / until, after < until, "the other way round: the shaft is caught by the resonance at 53 s",
        )
    )  # fmt: skip
    return lines


def _steps(found: Runs) -> list[dict[str, Any]]:
    late = found.t_fixed >= CLAIM_TIME
    mean = float(found.speed_fixed[late].mean())
    apart = mean / mean_speed(found.printed, CLAIM_TIME) - 1
    return [
        _claim(
            "the result depends on the step, change of the mean speed from 90 s on", "depends", apart,
            abs(apart) > _CONSTANT, f"printed model, third order with a fixed step of {1e3 * FIXED_STEP:g} ms: "
            f"{mean:.2f} rad/s; the step damps the resonance, which then holds for ever",
        ),
        _row(
            "Fig. 10: 194 rad/s with the source's integrator and step [rad/s]", "194",
            float(found.speed_fixed[late].max()), NOT_COMPUTABLE,
            f"the source prints neither; computed: largest momentary speed of the printed model with the fixed step of "
            f"{1e3 * FIXED_STEP:g} ms, chosen to come near: perhaps the envelope of a plot",
        ),
    ]  # fmt: skip

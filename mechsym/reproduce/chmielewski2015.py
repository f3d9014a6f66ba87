"""Chmielewski et al. (2015): the numbers of section 2.2 beside the converged start-up."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from mechsym.reproduce.chmielewski2015_runs import (
    CLAIMED_SPEED,
    CLAIMED_TIME,
    TELLING_STEP,
    Speeds,
    convergence,
    crank_acceleration,
    rigid_speed,
    run,
    step_study,
)
from mechsym.reproduce.rows import row

SOURCE = "002_d7297926d6c52225"


def rows() -> list[dict[str, Any]]:
    """The numbers of section 2.2 beside the converged start-up.

    Returns
    -------
    rows : list of dict
        Keys source, item, published, computed, rel_error, verdict, note
    """
    study, steps = convergence(), step_study()
    mixed = next(s for s in study if "printed" in s.name and "1e-12" in s.name)
    exact = next(s for s in study if "printed" not in s.name and "1e-12" in s.name)
    telling = next(s for s in steps if f"{1000 * TELLING_STEP:g} ms" in s.name)
    spread = _spread([s.mean for s in study if "printed" in s.name])
    return [
        _row("speed that is settled at after 90 s, printed model [rad/s]", CLAIMED_SPEED, mixed.mean, "not reproduced",
             f"mean over 98 to 100 s, converged to {spread:.1e} over three tolerances and two integrators; the crank "
             f"swings between {mixed.lowest:.0f} and {mixed.highest:.0f} rad/s and the mean still grows"),
        _row("the same, exact model [rad/s]", CLAIMED_SPEED, exact.mean, "not reproduced",
             f"energy residual {exact.energy_residual:.1e}: held at half the torsional natural frequency until 91 s"),
        _row("hand check: rigid drive at 90 s [rad/s]", CLAIMED_SPEED, rigid_speed(CLAIMED_TIME), "not reproduced",
             "M (t - 1)/(I0 + I2) bounds the mean speed of any model without losses; 194 rad/s would take until "
             f"{1 + CLAIMED_SPEED / rigid_speed(2.0):.0f} s"),
        _row("peak of the crank's speed at 90 s with a fixed step [rad/s]", CLAIMED_SPEED, telling.peak_at_claim,
             "not reproduced",
             f"classical Runge-Kutta with {1000 * TELLING_STEP:g} ms, a step fitted to the paper's number, loses "
             f"{100 * (telling.energy_residual or 0):.0f} % of the work and so holds the shaft at a mean of "
             f"{telling.mean:.1f} rad/s for ever: 194 rad/s may be the peak of such a run; method and step are not "
             "printed"),
        _row("Fig. 11: amplitude of the crank's acceleration at 98 s over that at 90 s", 1.0, _settled_amplitude(),
             "reproduced", "the converged run leaves the resonance at 91 s: the amplitude grows until then, as the "
             "paper says, and is constant afterwards; only the speed is not"),
        *[_study_row(s) for s in (*study, *steps)],
    ]  # fmt: skip


def _settled_amplitude() -> float:
    result = run("crankshaft_flywheel_printed")
    size = np.abs(crank_acceleration(result))
    early, late = (size[(result.t >= t) & (result.t <= t + 2)].max() for t in (CLAIMED_TIME, 98.0))
    return float(late / early)


def _spread(values: Sequence[float]) -> float:
    return (max(values) - min(values)) / abs(float(np.mean(values)))


def _study_row(found: Speeds) -> dict[str, Any]:
    residual = "" if found.energy_residual is None else f", energy residual {found.energy_residual:.1e}"
    note = f"crank between {found.lowest:.0f} and {found.highest:.0f} rad/s at the end{residual}"
    return _row(f"mean speed 98 to 100 s: {found.name} [rad/s]", CLAIMED_SPEED, found.mean, "not reproduced", note)


def _row(item: str, published: float, computed: float, verdict: str, note: str) -> dict[str, Any]:
    return row(SOURCE, item, published, computed, verdict, note)

"""What the conclusions of Chmielewski et al. (2015) announce, done: two pistons, a heat cycle, its losses, in time.

The paper prints no gas and no number for it; gas, bore and load are those assumed in the case `alpha-stirling`.
"""

from typing import Any

import numpy as np

from mechsym.cases import load
from mechsym.jobs.cycle import cycle
from mechsym.jobs.run import run
from mechsym.papers.chmielewski2015 import SOURCE
from mechsym.papers.rows import NOT_REPRODUCED, REPRODUCED, row

_CASE = "alpha-stirling"
_RESIDUAL = 1e-8  # of the energy of a run [-]


def rows() -> list[dict[str, Any]]:
    """Sentences of the conclusions."""
    return [_in_time("schmidt", _TWO), _in_time("stirling-adiabatic", _HEAT), _second_order()]


_TWO = "a model with two pistons offset by a predetermined phase angle"
_HEAT = "the dynamic model of the Stirling engine including the thermodynamic processes"


def _in_time(kind: str, words: str) -> dict[str, Any]:
    found = run(load(_CASE, {"cycle.kind": kind}), check="none")
    speed, residual = found.result.columns["phi_fd"], abs(found.result.energy.residual or 0.0)
    mean = float(np.mean(speed[-len(speed) // 10 :]))
    critical = next((line for line in found.findings if "critical" in line), "no critical near the speed")
    return row(
        SOURCE.stem, f"conclusions: flywheel of the alpha engine after 30 turns, kind {kind} [rad/s]", words, mean,
        REPRODUCED if residual < _RESIDUAL else NOT_REPRODUCED,
        f"announced, no value printed; energy residual {residual:.0e}; {critical}",
    )  # fmt: skip


def _second_order() -> dict[str, Any]:
    ideal, real = (cycle(load(_CASE, {"cycle.kind": kind})) for kind in ("stirling-adiabatic", "stirling-second-order"))
    before, after = (float(found["efficiency"][0]) for found in (ideal, real))
    lost = ", ".join(f"{name.replace('_', ' ')} {values[0]:.0f} W" for name, values in real["losses"].items())
    return row(
        SOURCE.stem, "conclusions: efficiency of the second order at 600 rpm [-]",
        "the thermodynamic model of the II order, which considers the losses", after,
        REPRODUCED if 0 < after < before else NOT_REPRODUCED,
        f"announced, no value printed; {before:.3f} without losses; {float(real['power_kw'][0]) * 1e3:.0f} W left, "
        f"lost: {lost}",
    )  # fmt: skip

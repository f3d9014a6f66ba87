"""Numbers and claims of Prymak on rodless mechanisms beside the derived mechanism.

The source prints no data. What follows from geometry needs none: four rod journals of equal mass, two to an axis.
"""

from typing import Any

import numpy as np

from mechsym import mechanisms
from mechsym.cases import load
from mechsym.mechanisms import constraints
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.rodless_clearance import Clearances, redundant_force
from mechsym.papers.prymak import SOURCE
from mechsym.papers.prymak.computed import MASS, PARAMETERS, RADIUS, SPEED, inertia_resultant
from mechsym.papers.rows import NOT_COMPUTABLE, NOT_REPRODUCED, REPRODUCED, SLIP, row

_ROUNDING = 1e-12
_CASE, _ERROR = "balandin", 10e-6  # sizes assumed there, and a small error of a crank's radius [m]


def rows() -> list[dict[str, Any]]:
    """Every number and claim of the source."""
    alpha = np.linspace(0, 2 * np.pi, 721)
    return [*_resultant_rows(alpha), *_reaction_rows(), *_accuracy_rows(), *_claims_without_data()]


def _row(item: str, published: str | None, computed: float | None, verdict: str, note: str = "") -> dict[str, Any]:
    return row(SOURCE.stem, item, published, computed, verdict, note)


def _resultant_rows(alpha: np.ndarray) -> list[dict[str, Any]]:
    along_x, along_y = inertia_resultant(alpha) / (MASS * RADIUS * SPEED**2)
    size = np.hypot(along_x, along_y)
    # as printed: each of the four journals' forces squared, then summed
    printed = np.sqrt(2 * (along_x / 2) ** 2 + 2 * (along_y / 2) ** 2)
    constant = np.ptp(size) < _ROUNDING and abs(size.mean() - 4) < _ROUNDING
    off = float(max(np.abs(along_x - 4 * np.cos(alpha)).max(), np.abs(along_y - 4 * np.sin(alpha)).max()))
    turned = float(np.abs(np.exp(1j * alpha) - (along_x + 1j * along_y) / size).max())
    to_rod = np.degrees(np.arctan2(np.abs(along_y), np.abs(along_x)))
    return [
        _row(
            "(4): resultant inertia force over m r omega^2, constant", "4", float(size.mean()),
            SLIP if constant else NOT_REPRODUCED,
            f"under the root the sums must be squared; the terms squared, as printed, give {printed.max():.3f}",
        ),
        _row(
            "(5): sums by axis over m r omega^2, largest difference", "-4 cos alpha, -4 sin alpha", off,
            REPRODUCED if off < _ROUNDING else NOT_REPRODUCED, "harmonic, no second order; the print counts inwards",
        ),
        _row(
            "(5): direction of the resultant, largest difference [rad]", "tan phi = tan alpha", turned,
            REPRODUCED if turned < _ROUNDING else NOT_REPRODUCED, "the resultant turns with the crank",
        ),
        _row(
            "conclusion 3: direction of the inertia force, largest angle to the rod of axis a [deg]", "along the rod",
            float(to_rod.max()), REPRODUCED if to_rod.max() < 1e-6 else NOT_REPRODUCED,
            "contradicts (5): the rods stay on their axes while the resultant turns",
        ),
    ]  # fmt: skip


def _reaction_rows() -> list[dict[str, Any]]:
    rank, count = _rank(mechanisms.build("rodless_constraints", PARAMETERS))
    closed = f"rank {rank} of {count}, determined are X_a cos alpha - X_b sin alpha and the tangential pin force"
    return [
        _row(
            "(1), Fig. 2: guide reactions X_i as functions of alpha", None, None, NOT_COMPUTABLE,
            f"no closed form is printed, and the rigid mechanism does not determine them: {closed}; mechsym gives them "
            "with a named closing rule",
        ),
        _row(
            "conclusion 2: side force on the pistons", "none", None, NOT_COMPUTABLE,
            "the guides of the sliders take the side force instead, so its size on the piston depends on clearances",
        ),
    ]  # fmt: skip


def _accuracy_rows() -> list[dict[str, Any]]:
    """What the introduction says of accuracy, the reason for another kinematic scheme, and of that scheme."""
    closing = load(_CASE).need("closing")
    play, tight = (_radial_force(closing, gap) for gap in (_ERROR, 0.0))
    return [
        _row(
            "introduction: pin force of a crank 10 um too long, case balandin without play [N]",
            "high accuracy cannot be reached", tight, NOT_COMPUTABLE,
            f"no tolerance, size or stiffness is printed; with stiffnesses assumed, all positions alike; {play:.0f} N "
            "with as much radial play of the pin",
        ),
        _row(
            "introduction: kinematic scheme that A. Vul proposed in place of Balandin's", "changed", None,
            NOT_COMPUTABLE, "the text says that it was changed and why, and neither draws nor describes it",
        ),
        _row(
            "introduction: experimental engines built under A. Vul", "surpass those that exist", None, NOT_COMPUTABLE,
            "no engine and no figure of one is printed",
        ),
    ]  # fmt: skip


def _radial_force(closing: Any, play: float) -> float:
    """Largest radial force on the pin, with a crank too long by the error and no load [N]."""
    rule = Clearances(k_a=closing.k_a, k_b=closing.k_b, k_c=closing.k_c, gap_c=play, radius_error=_ERROR)
    angles = np.linspace(0, 2 * np.pi, 73)
    return max(float(redundant_force(rule, 0.0, 0.0, float(np.sin(a)), float(np.cos(a)))) for a in angles)


def _rank(mechanism: Mechanism) -> tuple[int, int]:
    solution = constraints.solve(mechanism, constraints.close(mechanism, {mechanism.coordinates[0]: 0.7}))
    return solution.rank, solution.count


def _claims_without_data() -> list[dict[str, Any]]:
    return [
        _row(
            "conclusion 1: smaller losses by friction and inertia than with rods", None, None, NOT_COMPUTABLE,
            "neither masses nor friction coefficients are printed",
        )
    ]  # fmt: skip

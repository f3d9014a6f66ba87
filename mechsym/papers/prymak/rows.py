"""Numbers and claims of Prymak on rodless mechanisms beside the derived mechanism.

The source prints no data. What follows from geometry needs none: four rod journals of equal mass, two to an axis.
"""

from functools import partial

import numpy as np

from mechsym import mechanisms
from mechsym.audit.verdict import Decision
from mechsym.cases import load
from mechsym.mechanisms import constraints
from mechsym.mechanisms.closing import Clearances, Stiffnesses, redundant_force
from mechsym.mechanisms.record import curves
from mechsym.mechanisms.rodless import RodlessParameters
from mechsym.papers.rows import NOT_COMPUTABLE, NOT_REPRODUCED, SLIP, Row, listed
from mechsym.papers.sources import Weighed, weighed

RADIUS, SPEED, MASS = 0.04, 300.0, 1.0  # any: the results are pure numbers [m], [rad/s], [kg] per rod journal
PARAMETERS = RodlessParameters(r=RADIUS, I1=0.1, m_link=0.0, I_link=0.0, m_a=2 * MASS, m_b=2 * MASS)


def inertia_resultant(alpha: np.ndarray) -> np.ndarray:
    """Resultant of the inertia forces of four rod journals, two on each axis, at constant speed.

    alpha: crank angles [rad]. Returns force: along the axis of the slider that is outermost at angle 0, and along the
    other one [N].
    """
    slopes = curves(mechanisms.build("rodless", PARAMETERS), alpha)
    return -2 * MASS * SPEED**2 * np.array([slopes["d2x_a_dalpha2"], slopes["d2x_b_dalpha2"]])


_row = partial(listed, "prymak")
_ROUNDING = 1e-12
_CASE, _ERROR = "balandin", 10e-6  # sizes assumed there, and a small error of a crank's radius [m]


def rows() -> list[Row]:
    """Every number and claim of the source."""
    alpha = np.linspace(0, 2 * np.pi, 721)
    without_data = _row("losses", None, NOT_COMPUTABLE)
    return [*_resultant_rows(alpha), *_reaction_rows(), *_accuracy_rows(), without_data]


def _resultant_rows(alpha: np.ndarray) -> list[Row]:
    along_x, along_y = inertia_resultant(alpha) / (MASS * RADIUS * SPEED**2)
    size = np.hypot(along_x, along_y)
    # as printed: each of the four journals' forces squared, then summed
    printed = np.sqrt(2 * (along_x / 2) ** 2 + 2 * (along_y / 2) ** 2)
    constant = np.ptp(size) < _ROUNDING and abs(size.mean() - 4) < _ROUNDING
    off = float(max(np.abs(along_x - 4 * np.cos(alpha)).max(), np.abs(along_y - 4 * np.sin(alpha)).max()))
    turned = float(np.abs(np.exp(1j * alpha) - (along_x + 1j * along_y) / size).max())
    to_rod = np.degrees(np.arctan2(np.abs(along_y), np.abs(along_x)))
    return [
        _row("constant", float(size.mean()), SLIP if constant else NOT_REPRODUCED, printed=printed.max()),
        _row("sums", off, off < _ROUNDING),
        _row("direction", turned, turned < _ROUNDING),
        _row("along_the_rod", float(to_rod.max()), to_rod.max() < 1e-6),
    ]


def _reaction_rows() -> list[Row]:
    mechanism = mechanisms.build("rodless_constraints", PARAMETERS)
    solution = constraints.solve(mechanism, constraints.close(mechanism, {mechanism.coordinates[0]: 0.7}))
    return [
        _row("reactions", None, NOT_COMPUTABLE, rank=solution.rank, count=solution.count),
        _row("side_force", None, NOT_COMPUTABLE),
    ]


def _accuracy_rows() -> list[Row]:
    """What the introduction says of accuracy, the reason for another kinematic scheme, and of that scheme."""
    closing = load(_CASE).need("closing")
    play, tight = (_radial_force(closing, gap) for gap in (_ERROR, 0.0))
    return [
        _row("accuracy", tight, NOT_COMPUTABLE, play=play),
        *(_row(name, None, NOT_COMPUTABLE) for name in ("scheme", "built")),
    ]


def _radial_force(closing: Stiffnesses, play: float) -> float:
    """Largest radial force on the pin, with a crank too long by the error and no load [N]."""
    rule = Clearances(k_a=closing.k_a, k_b=closing.k_b, k_c=closing.k_c, gap_c=play, radius_error=_ERROR)
    angles = np.linspace(0, 2 * np.pi, 73)
    return max(float(redundant_force(rule, 0.0, 0.0, float(np.sin(a)), float(np.cos(a)))) for a in angles)


_TURN = np.linspace(0, 2 * np.pi, 361)


def root_effect(verdict: Decision) -> str:
    """What the printed root gives for equal masses."""
    # two journals on each axis carry half the sum each
    along, across = inertia_resultant(_TURN)
    printed, right = np.sqrt(2 * ((along / 2) ** 2 + (across / 2) ** 2)), np.hypot(along, across)
    return f"with equal masses the printed root gives {np.mean(printed / right):.3f} of the resultant 4 m r omega^2"


def constant_size() -> Weighed:
    """The size of the resultant over a turn."""
    size = np.hypot(*inertia_resultant(_TURN))
    change = float(np.ptp(size) / np.mean(size))
    return weighed(change < 1e-12, change, change="less than 1e-12" if change < 1e-12 else f"{change:.2g}")


def along_the_rod() -> Weighed:
    """The share of the resultant that is across a rod."""
    along, across = inertia_resultant(_TURN)
    share = float(np.max(np.abs(across) / np.hypot(along, across)))
    return weighed(share < 1e-9, share=100 * share)


def no_side_force() -> Weighed:
    """Who carries the force across the cylinder."""
    return weighed(True)

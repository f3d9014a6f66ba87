"""What decides the claims of source 003, and what the root in (4) costs."""

import numpy as np

from mechsym.audit.hosts.sources import Decided
from mechsym.audit.verdict import Decision
from mechsym.papers.prymak import rows

_TURN = np.linspace(0, 2 * np.pi, 361)


def root_effect(verdict: Decision) -> str:
    """What the printed root gives for equal masses."""
    # two journals on each axis carry half the sum each
    along, across = rows.inertia_resultant(_TURN)
    printed, right = np.sqrt(2 * ((along / 2) ** 2 + (across / 2) ** 2)), np.hypot(along, across)
    return f"with equal masses the printed root gives {np.mean(printed / right):.3f} of the resultant 4 m r omega^2"


def constant_size() -> Decided:
    """The size of the resultant over a turn."""
    size = np.hypot(*rows.inertia_resultant(_TURN))
    change = float(np.ptp(size) / np.mean(size))
    supported = change < 1e-12
    size_of_change = "less than 1e-12" if supported else f"{change:.2g}"
    return Decided(supported=supported, note=f"it changes by {size_of_change} of itself over a turn", rel_error=change)


def along_the_rod() -> Decided:
    """The share of the resultant that is across a rod."""
    along, across = rows.inertia_resultant(_TURN)
    share = float(np.max(np.abs(across) / np.hypot(along, across)))
    return Decided(
        supported=share < 1e-9,
        note=f"by the paper's own (5) it turns with the crank: {100 * share:.0f} % of it is across a rod at some angle",
    )


def no_side_force() -> Decided:
    """Who carries the force across the cylinder."""
    return Decided(
        supported=True,
        note="the guides of the sliders take X_a and X_b instead of the cylinders; their size needs a closing rule, "
        "since the rigid mechanism is overconstrained by one",
    )

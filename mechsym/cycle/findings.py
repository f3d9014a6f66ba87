"""What a reader of a cycle has to know first: a model that reaches the ceiling of thermodynamics."""

from collections.abc import Iterator

import numpy as np

from mechsym.cycle.figures import CycleFigures
from mechsym.page.finding import LOOK_AT, Finding
from mechsym.quantities.display import figure, quantity_text

_SAME = 1e-6  # of an efficiency: nearer to Carnot's no model with losses comes
_TEMPERATURES = ("T_e_max_k", "T_c_min_k")


def of_cycle(found: CycleFigures) -> Iterator[Finding]:
    r"""A cycle that has Carnot's efficiency :math:`1 - T_c/T_e`, whose power is therefore an upper bound."""
    if not all(name in found for name in (*_TEMPERATURES, "efficiency")):
        return
    hot, cold = (np.asarray(found[name], dtype=float) for name in _TEMPERATURES)
    ceiling = 1.0 - cold / hot
    at = int(np.argmax(found["efficiency"]))
    if abs(float(np.asarray(found["efficiency"])[at] - ceiling[at])) <= _SAME:
        power = quantity_text(1e3 * float(np.max(found["power_kw"])), "W", 4)
        words = (
            f"{figure(100 * ceiling[at], 4)} % is Carnot's efficiency between {figure(cold[at], 4)} and "
            f"{figure(hot[at], 4)} K: the model has no losses, and {power} is an upper bound"
        )
        yield Finding(rank=LOOK_AT, words=words, value=float(ceiling[at]))

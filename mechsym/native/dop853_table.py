"""Numbers of the explicit Runge-Kutta method DOP853 of order 8 with error estimates of orders 5 and 3.

Source: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed., Springer 1993,
section II.5, and the program dop853.f that goes with it. Stages count from 1; stage 13 is the derivative at the end of
the step, stages 14 to 16 are made only for dense output. The numbers are
in `dop853.toml`; `tests/native/test_integrate.py` checks the conditions of order.
"""

import tomllib
from collections.abc import Mapping
from importlib import resources

_TABLE = tomllib.loads(resources.files("mechsym.native").joinpath("dop853.toml").read_text("utf-8"))


def _row(numbers: Mapping[str, float]) -> dict[int, float]:
    """Coefficients by earlier stage."""
    return {int(stage): number for stage, number in numbers.items()}


NODES: tuple[float, ...] = tuple(_TABLE["nodes"])
A = {int(stage): _row(row) for stage, row in _TABLE["stages"].items()}
ERROR_5, WEIGHTS_3 = _row(_TABLE["error_5"]), _row(_TABLE["weights_3"])
DENSE = tuple(map(_row, _TABLE["dense"]))

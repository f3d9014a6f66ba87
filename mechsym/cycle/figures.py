"""Figures of an engine's cycle."""

from mechsym.cycle.columns import UNITS
from mechsym.cycle.source import GasSource
from mechsym.page import ShownFigures


class CycleFigures(ShownFigures):
    """Figures of an engine over the speeds, under the names of `mechsym cycle`."""

    units = UNITS
    source: GasSource | None = None  #: What answers for its gas; None where pistons move differently
    apart: float = 0.0  #: By how much strokes differ from that of the cylinder that stands for all [-]

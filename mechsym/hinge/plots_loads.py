"""Picture of a hinge at other loads."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from mechsym.hinge.result import AtLoad
from mechsym.simulate.steady import Steady
from mechsym.style import BLUE, GREY, RED, legend, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def loads(rows: Sequence[AtLoad]) -> "Figure":
    """Ripple of a guide over the load, with the spring as designed and set anew, and that setting.

    Returns
    -------
    figure : Figure
        Two panels; a cross at the top marks a load at which the crank does not turn steadily
    """
    figure, (left, right) = panels(9, 3.6, 1, 2, "Speed ripple and setting of the spring over the load")
    ordered = sorted(rows, key=lambda row: row.share)
    shares = [100 * row.share for row in ordered]
    for found, color, name in (
        ([row.as_cut for row in ordered], RED, "spring as designed"),
        ([row.reset for row in ordered], BLUE, "setting of that load"),
    ):
        # no line between the points: at the design's own load, which may lie between, there is no ripple
        left.plot(shares, [_per_cent(s) for s in found], "o", color=color, markersize=5, label=name)
        stopped = [share for share, s in zip(shares, found, strict=True) if s.speed_ripple is None]
        left.plot(stopped, [1.0] * len(stopped), "x", color=color, transform=left.get_xaxis_transform(), clip_on=False)
    left.set(xlabel="load over that of the design [%]", ylabel="speed ripple [%]")
    left.set_ylim(bottom=0)
    legend(left)
    right.plot(shares, [row.ratio for row in ordered], "o-", color=BLUE, markersize=4)
    right.axhline(1.0, color=GREY, linewidth=0.8)
    right.set(xlabel="load over that of the design [%]", ylabel="setting over that of the design [-]")
    return figure


def _per_cent(steady: Steady) -> float:
    return float("nan") if steady.speed_ripple is None else 100 * steady.speed_ripple

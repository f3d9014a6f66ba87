"""The nine curves of Moroianu (2017) as the source drew them, with the assumed data of the case `moroianu`."""

import numpy as np
from matplotlib.figure import Figure

from mechsym.papers.moroianu2017.rows import FIGURES, curves
from mechsym.papers.page import turn_axis
from mechsym.style import BLUE, INK, panels


def figures() -> dict[str, Figure]:
    """All figures with curves."""
    one, chain = curves()
    drawn = {}
    for number, (field, name, unit) in FIGURES.items():
        figure, (axis,) = panels(6.4, 3.4)
        axis.plot(np.degrees(one.phi), getattr(chain, field) / 1e3, color=BLUE)
        axis.axhline(0, color=INK, linewidth=0.6)
        letter, _, index = field.partition("_")
        symbol = f"${letter}_{{{index}}}$" if index else letter
        axis.set_ylabel(f"{name} {symbol} [k{unit.replace('*', ' ')}]")
        axis.set_title(f"Fig. {number}, assumed data", loc="left", fontsize=10)
        turn_axis(axis)
        drawn[f"figure_{number}"] = figure
    return drawn

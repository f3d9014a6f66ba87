"""Fig. 3 of Prymak: the inertia forces of the two rods and their resultant, in units of m r omega^2."""

import numpy as np
from matplotlib.figure import Figure

from mechsym.papers.page import turn_axis
from mechsym.papers.prymak.rows import MASS, RADIUS, SPEED, inertia_resultant
from mechsym.style import BLUE, GREEN, INK, RED, legend, panels


def figures() -> dict[str, Figure]:
    """The only figure with forces that no data are needed for."""
    alpha = np.linspace(0, 2 * np.pi, 721)
    x, y = inertia_resultant(alpha) / (MASS * RADIUS * SPEED**2)
    figure, (left, right) = panels(9.5, 4.2, 1, 2)
    left.plot(x, y, color=GREEN, label="end of the resultant")
    k = 80
    for at, color, label in (((x[k], 0), BLUE, "rod a"), ((0, y[k]), RED, "rod b"), ((x[k], y[k]), GREEN, "resultant")):
        left.annotate("", at, (0, 0), arrowprops={"arrowstyle": "-|>", "color": color, "lw": 1.8})
        left.text(1.08 * at[0] + 0.1, 1.08 * at[1] + 0.1, label, color=color)
    left.plot([x[k], x[k], 0], [0, y[k], y[k]], ":", color=INK, linewidth=0.8)
    left.set_aspect("equal")
    left.set(xlabel="along axis a [-]", ylabel="along axis b [-]", xlim=(-5, 6.2), ylim=(-5, 5.4))
    left.set_title("Fig. 3, inertia forces at one angle, over $m r \\omega^2$", fontsize=10)
    right.plot(np.degrees(alpha), x, color=BLUE, label="rod a")
    right.plot(np.degrees(alpha), y, color=RED, ls="--", label="rod b")
    right.plot(np.degrees(alpha), np.hypot(x, y), color=GREEN, label="resultant")
    legend(right)
    turn_axis(right)
    return {"figure_3": figure}

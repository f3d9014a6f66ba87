"""Figs. 3 to 6 of Zotov et al. (2024) as the source drew them, with the stated cycle for the gas force."""

import numpy as np
from matplotlib.figure import Figure

from mechsym.hinge import guide
from mechsym.hinge.guide import with_setting
from mechsym.machine.record import gas_of
from mechsym.papers.page import turn_axis
from mechsym.papers.zotov2024.rows import PRESSURES, Engines, best_pressure, distances, engines, guides, printed_torque
from mechsym.style import BLUE, GREEN, GREY, INK, RED, legend, panels

_PHI = np.linspace(0, 2 * np.pi, 1441)
_DEG = np.degrees(_PHI)
_LINES = ((BLUE, "-"), (RED, "--"), (GREEN, "-."))


def figures() -> dict[str, Figure]:
    """All figures with curves."""
    both = engines()
    figure, (axis,) = panels(7.2, 4.2)
    for engine, (color, line), name in zip(both.machines, _LINES, ("1: 89 rpm", "2: 142 rpm"), strict=False):
        axis.plot(_DEG, gas_of(engine).force(_PHI) / 1e3, color=color, linestyle=line, label=name)
    axis.set_ylabel("force on the piston [kN]")
    axis.set_title("Fig. 3, stated cycle")
    legend(axis)
    turn_axis(axis)
    return {"figure_3": figure, "figure_4": _torques(both), "figure_5": _guides(), "figure_6": _fit(both)}


def _torques(both: Engines) -> Figure:
    figure, axes = panels(10, 4, 1, 2, sharey=True)
    for index, (axis, name) in enumerate(zip(axes, ("a: 89 rpm", "b: 142 rpm"), strict=True)):
        axis.plot(_DEG, both.hinges[index].torque(_PHI) / 1e3, color=BLUE, label="exact equation")
        axis.plot(_DEG, printed_torque(index, _PHI) / 1e3, color=RED, ls="--", label="(8) as printed")
        axis.axhline(0, color=INK, linewidth=0.6)
        axis.set_title(f"Fig. 4 {name}, stated cycle")
        turn_axis(axis)
    axes[0].set_ylabel("hinge torque $M_h$ [kN m]")
    legend(axes[0])
    return figure


def _guides() -> Figure:
    cut = {m.label: m.guide for m in guides() if m.start == "as_printed"}
    about = {"a": "89 rpm, H = 1 m", "b": "142 rpm, H = 1 m", "c": "89 rpm, H = 0.4 m", "d": "142 rpm, H = 0.4 m"}
    figure, axes = panels(9, 8.6, 2, 2)
    for axis, (letter, words) in zip(axes, about.items(), strict=True):
        for number, p0, (color, line) in zip("123", (3, 5, 8), _LINES, strict=True):
            rho = distances(cut[letter + number])
            x, y = rho * np.cos(_PHI), rho * np.sin(_PHI)
            axis.plot(x, y, color=color, linestyle=line, label=f"{number}: p0 = {p0} MPa")
        axis.plot(0, 0, "+", color=INK)
        axis.set_aspect("equal")
        axis.set_title(f"Fig. 5 {letter}: {words}, stated cycle", fontsize=10)
        axis.set(xlabel="x [m]", ylabel="y [m]")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _fit(both: Engines) -> Figure:
    cut, best = both.cut, best_pressure().setting
    figure, (axis,) = panels(7.2, 4.2)
    curves = (
        ("1: wanted at 89 rpm", both.hinges[0].torque(_PHI), GREY, "-"),
        ("2: same guide, p0 times 1.9", _torque_at(cut, PRESSURES[1]), RED, "--"),
        ("3: wanted at 142 rpm", both.hinges[1].torque(_PHI), BLUE, "-"),
        (f"not in the source: p0 times {best / PRESSURES[0]:.2f}", _torque_at(cut, best), GREEN, ":"),
    )
    for name, torque, color, line in curves:
        axis.plot(_DEG, torque / 1e3, color=color, linestyle=line, label=name)
    axis.axhline(0, color=INK, linewidth=0.6)
    axis.set_ylabel("hinge torque [kN m]")
    axis.set_title("Fig. 6, stated cycle")
    legend(axis)
    turn_axis(axis)
    return figure


def _torque_at(cut: guide.Guide, p0: float) -> np.ndarray:
    return guide.crank_torque(guide.refit(cut, with_setting(cut.spring, p0)), _PHI)

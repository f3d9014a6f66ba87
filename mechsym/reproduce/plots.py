"""The figures of the sources, drawn as the sources drew them. matplotlib is imported in plot modules only."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from mechsym.reproduce import chmielewski2015_runs as shaft
from mechsym.reproduce import prymak as rodless
from mechsym.reproduce import zotov2024 as engine

_STYLES = ("-", "--", ":")
_BLACK = "#222222"


def _figure(width: float, height: float, columns: int = 1, **options: Any) -> tuple[Figure, np.ndarray]:
    figure = Figure(figsize=(width, height), layout="constrained")
    axes = np.atleast_1d(figure.subplots(options.pop("rows", 1), columns, **options)).ravel()
    for axis in axes:
        axis.grid(True, color="#dddddd", linewidth=0.6)
    return figure, axes


def zotov2024() -> dict[str, Figure]:
    """Figures 3 to 6: piston forces, hinge torques, guides, torques of the retuned guide.

    Returns
    -------
    figures : dict of str to Figure
        By file stem
    """
    return {"zotov2024-fig3": _forces(), "zotov2024-fig4": _hinges(), "zotov2024-fig5": _guides(),
            "zotov2024-fig6": _retuned()}  # fmt: skip


def _forces() -> Figure:
    figure, (axis,) = _figure(6, 4)
    phi = np.linspace(0, 2 * np.pi, 721)
    for style, number, assembly in zip(_STYLES, (1, 2), engine.engines().assemblies, strict=False):
        rpm = assembly.omega * 30 / np.pi
        axis.plot(phi, assembly.force(phi) / 1e3, style, color=_BLACK, label=f"{number}: n = {rpm:.0f} rpm")
    axis.set(xlabel="φ [rad]", ylabel="F [kN]", title="Fig. 3, with the cycle of the built-in cases")
    axis.legend()
    return figure


def _hinges() -> Figure:
    figure, axes = _figure(9, 3.6, 2)
    phi = np.linspace(0, 2 * np.pi, 721)
    for axis, letter, wanted in zip(axes, "ab", engine.engines().hinges, strict=True):
        axis.plot(phi, wanted.torque(phi) / 1e3, color=_BLACK)
        axis.set(xlabel="φ [rad]", ylabel="M$_h$ [kN m]", title=f"Fig. 4 {letter})")
    return figure


def _guides() -> Figure:
    figure, axes = _figure(10, 10.5, 2, rows=2, subplot_kw={"projection": "polar"})
    theta = np.linspace(0, 2 * np.pi, 721)
    printed = [m for m in engine.guides() if m.start == "as_printed" and m.guide.rho is not None]
    for axis, letter in zip(axes, "abcd", strict=True):
        for style, member in zip(_STYLES, (m for m in printed if m.label[0] == letter), strict=True):
            assert member.guide.rho is not None
            axis.plot(theta, member.guide.rho(theta), style, color=_BLACK, label=member.label[1])
        axis.set_title(f"Fig. 5 {letter}): ρ [m]")
        axis.set_rmin(0)
        axis.legend(loc="upper left", bbox_to_anchor=(-0.12, 1.1))
    return figure


def _retuned() -> Figure:
    from mechsym.guide import crank_torque
    from mechsym.setting import with_setting

    figure, (axis,) = _figure(6, 4)
    phi = np.linspace(0, 2 * np.pi, 721)
    found = engine.engines()
    stronger = with_setting(found.cut.spring, engine.PRESSURES[1])
    best = engine.best_pressure()
    axis.plot(phi, found.hinges[0].torque(phi) / 1e3, "-", color=_BLACK, label="1: 89 rpm, 5 MPa")
    axis.plot(phi, crank_torque(found.cut, stronger, phi) / 1e3, "--", color=_BLACK, label="2: same guide, 9.5 MPa")
    axis.plot(phi, found.hinges[1].torque(phi) / 1e3, ":", color=_BLACK, label="3: needed at 142 rpm")
    label = f"same guide, {best.setting / 1e6:.1f} MPa (least squares)"
    axis.plot(phi, crank_torque(found.cut, best.spring, phi) / 1e3, "-", color="#b5342b", linewidth=0.9, label=label)
    axis.set(xlabel="φ [rad]", ylabel="M$_h$ [kN m]", title="Fig. 6, with the cycle of the built-in cases")
    axis.legend()
    return figure


def chmielewski2015() -> dict[str, Figure]:
    """Figures 6 to 11: motion of piston and crankshaft over 100 s, converged.

    Returns
    -------
    figures : dict of str to Figure
        By file stem; the crank's speed also with the fixed step that ends like the paper's
    """
    result = shaft.run("crankshaft_flywheel_printed")
    phi, speed = result.columns["phi0"], result.columns["phi0d"]
    acceleration = shaft.crank_acceleration(result)
    x, v, a = _piston(phi, speed, acceleration)
    curves = {
        "fig6": (x, "x$_0$ [m]"), "fig7": (v, "v [m/s]"), "fig8": (a, "a [m/s$^2$]"), "fig9": (phi, "φ$_0$ [rad]"),
        "fig10": (speed, "ω [rad/s]"), "fig11": (acceleration, "ε [rad/s$^2$]"),
    }  # fmt: skip
    figures = {f"chmielewski2015-{n}": _start_up(result.t, y, label, n) for n, (y, label) in curves.items()}
    t, y = shaft.fixed("crankshaft_flywheel_printed", shaft.TELLING_STEP, 4)
    title = f"fig10 with a fixed step of {1000 * shaft.TELLING_STEP:g} ms"
    figures["chmielewski2015-fig10-fixed-step"] = _start_up(t, y[:, 2], "ω [rad/s]", title)
    return figures


def _piston(phi: np.ndarray, speed: np.ndarray, acceleration: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    # equations (9) to (11) of the paper
    p = shaft.problem("crankshaft_flywheel_printed").mechanism.parameters
    r, lam = p["r"], p["r"] / p["l"]
    slope = np.sin(phi) + lam / 2 * np.sin(2 * phi)
    x = r * ((1 - np.cos(phi)) + lam / 4 * (1 - np.cos(2 * phi)))
    return x, r * speed * slope, r * (acceleration * slope + speed**2 * (np.cos(phi) + lam * np.cos(2 * phi)))


def _start_up(t: np.ndarray, y: np.ndarray, label: str, title: str) -> Figure:
    figure, (axis,) = _figure(7, 3.4)
    axis.plot(t, y, color=_BLACK, linewidth=0.4, rasterized=True)
    axis.set(xlabel="t [s]", ylabel=label, title=title.replace("fig", "Fig. "), xlim=(0, 100))
    return figure


def prymak() -> dict[str, Figure]:
    """Figure 3: the resultant inertia force of the rodless mechanism turns with the crank.

    Returns
    -------
    figures : dict of str to Figure
        By file stem
    """
    figure, (axis,) = _figure(5, 5)
    alpha = np.linspace(0, 2 * np.pi, 361)
    scale = rodless.MASS * rodless.RADIUS * rodless.SPEED**2
    along, across = rodless.inertia_resultant(alpha) / scale
    axis.plot(along, across, color=_BLACK)
    for i in range(0, 360, 45):
        axis.annotate("", (along[i], across[i]), (0, 0), arrowprops={"arrowstyle": "->", "color": "#1f5fa8"})
        axis.text(1.08 * along[i], 1.08 * across[i], f"{i}°", ha="center", va="center")
    axis.set(xlabel="along rod a, over m r ω²", ylabel="along rod b, over m r ω²", aspect="equal",
             title="Fig. 3: inertia resultant by crank angle", xlim=(-5, 5), ylim=(-5, 5))  # fmt: skip
    return {"prymak-fig3": figure}

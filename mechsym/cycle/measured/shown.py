"""What of a measured diagram is worth seeing."""

import math
from typing import TYPE_CHECKING

import numpy as np

from mechsym.cycle.chamber import dvolume_dphi, volume
from mechsym.cycle.measured.combustion import DiagramCombustion
from mechsym.cycle.measured.heat_release import CombustionFigures, burnt_fraction, heat_release
from mechsym.cycle.measured.measure import around_compression, cycle_work
from mechsym.cycle.plots import both_logarithmic
from mechsym.page import Card, Picture, View, shows
from mechsym.quantities.display import chosen, figure, per_cent, quantity_text, shown_in
from mechsym.quantities.results import Columns

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_FROM, _TO = math.radians(-60.0), math.radians(120.0)
_READ = 12  # cycles whose curves are read one by one
_FAINT = 0.35


_CLOUD = 8  # cycles below which points are no scatter


@shows(DiagramCombustion)
def combustion_view(result: DiagramCombustion) -> View:
    """Answer first: mean pressures, variation, burn angles; then pressure, heat, loop and scatter."""
    burns = result.wiebe is not None
    pictures = [
        Picture(name="pressure", see="Every measured cycle and, in colour, their mean.",
                draw=lambda: _pressure(result)),
        Picture(name="loop", see="Straight lines are polytropes; a bend before burning points at dead centre, "
                "offset or compression ratio.", draw=lambda: _loop(result)),
    ]  # fmt: skip
    if burns:
        see = "Burnt share of the mean cycle with its Wiebe function, and the net heat that is released."
        pictures.insert(1, Picture(name="burning", see=see, draw=lambda: _burning(result)))
    if len(result.cycles) >= _CLOUD:
        pictures.append(Picture(name="cycles", see="Every point is a cycle: what varies from one to the next.",
                                draw=lambda: _cloud(result)))  # fmt: skip
    return View(
        title="Measured diagram", cards=figure_cards(result.figures), pictures=tuple(pictures),
        columns=lambda: _columns(result),
    )  # fmt: skip


def figure_cards(figures: CombustionFigures) -> tuple[Card, ...]:
    """Cards of a combustion analysis, each with its interval in one notation."""
    cycles = f"{figures.cycles_counted} cycle{'s' * (figures.cycles_counted != 1)}"
    cards = [
        Card(name="IMEP net", value=bars(figures.imep_bar), about=f"95 %: {bars(*figures.imep_interval_bar)}"),
        Card(
            name="IMEP gross",
            value=bars(figures.imep_gross_bar),
            about=f"95 %: {bars(*figures.imep_gross_interval_bar)}",
        ),
        Card(name="PMEP", value=bars(figures.pmep_bar), about="net less gross"),
    ]
    for name, value, ends in (
        ("COV of net IMEP", figures.cov_imep, figures.cov_imep_interval),
        ("COV of largest pressure", figures.cov_p_max, figures.cov_p_max_interval),
    ):
        if value is not None and ends is not None:
            low, high = (figure(100 * end, 2) for end in ends)
            cards.append(Card(name=name, value=per_cent(value, 3), about=f"95 %: {low} to {high} %, of {cycles}"))
    for name, value in (("CA10", figures.ca10_deg), ("CA50", figures.ca50_deg), ("CA90", figures.ca90_deg)):
        if value is not None:
            about = "behind firing dead centre"
            if name == "CA50" and figures.ca50_interval_deg is not None:
                about = f"95 %: {degrees(*figures.ca50_interval_deg)}"
            cards.append(Card(name=name, value=degrees(value), about=about))
    cards += [
        Card(
            name="largest pressure",
            value=bars(figures.p_max_bar),
            about=f"mean of {cycles}, highest {bars(figures.p_max_highest_bar)}",
        ),
        Card(name="angle of largest pressure", value=degrees(figures.p_max_deg), about="behind firing dead centre"),
        Card(
            name="rate of rise",
            value=f"{figure(figures.rise_bar_deg, 3)} bar/deg",
            about="steepest of each cycle, mean",
        ),
    ]
    if figures.wall_heat_j is not None:
        heat = quantity_text(figures.wall_heat_j, "J", 3)
        cards.append(Card(name="wall heat", value=heat, about="Hohenberg's law, walls at an assumed temperature"))
    return tuple(cards)


def bars(*values: float) -> str:
    """Pressures [bar] as text, or in the unit that was chosen, as `low to high` where there are two."""
    shown, unit = shown_in([value * 1e5 for value in values], "Pa") if chosen() else (values, "bar")
    return f"{' to '.join(figure(float(value), 3) for value in shown)} {unit}"


def degrees(*values: float) -> str:
    """Angles [deg] as text, or in the unit that was chosen, as `low to high` where there are two."""
    shown, unit = shown_in([math.radians(value) for value in values], "rad")
    return f"{' to '.join(figure(float(value), 3) for value in shown)} {unit}"


def _rows(result: DiagramCombustion) -> tuple[np.ndarray, np.ndarray]:
    measured = result.measured
    return around_compression(measured.phi, measured.cycles, measured.period)


def _columns(result: DiagramCombustion) -> Columns:
    phi, rows = _rows(result)
    columns = {"phi": phi, "volume": volume(result.cylinder, phi), "pressure": rows.mean(axis=0)}
    columns |= {"pressure_low": rows.min(axis=0), "pressure_high": rows.max(axis=0)}
    units = {"phi": "rad", "volume": "m^3"} | dict.fromkeys(("pressure", "pressure_low", "pressure_high"), "Pa")
    return Columns(columns, units)


def _pressure_unit(values: np.ndarray) -> tuple[float, str]:
    from mechsym.style import axis_unit

    return axis_unit("Pa", values) if chosen() else (1e-5, "bar")


def _angles(axis: "Axes") -> float:
    from mechsym.style import over_angle

    return over_angle(axis, _TO, "angle from firing dead centre", start=_FROM, steps=6)


def _pressure(result: DiagramCombustion) -> "Figure":
    from matplotlib.collections import LineCollection

    from mechsym.style import BLUE, GREY, panels

    figure, (axis,) = panels(8, 3.6, title="Pressure of every cycle over the crank angle")
    phi, rows = _rows(result)
    inside = (phi >= _FROM) & (phi <= _TO)
    (factor, unit), angle = _pressure_unit(rows), _angles(axis)
    if len(rows) <= _READ:
        for number, row in enumerate(rows, 1):
            axis.plot(
                phi[inside] * angle, row[inside] * factor, color=GREY, linewidth=0.6, alpha=_FAINT,
                label=f"cycle {number}",
            )  # fmt: skip
    else:
        curves = [np.column_stack([phi[inside] * angle, row[inside] * factor]) for row in rows]
        axis.add_collection(LineCollection(curves, colors=GREY, linewidths=0.6, alpha=_FAINT))
    axis.plot(phi[inside] * angle, rows.mean(axis=0)[inside] * factor, color=BLUE, label="mean")
    axis.set_ylabel(f"absolute pressure [{unit}]")
    return figure


def _loop(result: DiagramCombustion) -> "Figure":
    from mechsym.style import BLUE, GREY, axis_unit, panels

    figure, (axis,) = panels(5.5, 4.4, title="Pressure over volume, both logarithmic")
    phi, rows = _rows(result)
    v, mean = volume(result.cylinder, phi), rows.mean(axis=0)
    (factor, unit), (room, room_unit) = _pressure_unit(mean), axis_unit("m^3", v)
    seen = np.where(mean > 0, mean, math.nan)
    axis.loglog(v * room, seen * factor, color=GREY, linewidth=0.8)
    closed = (phi >= result.analysis.inlet_closes) & (phi <= result.analysis.exhaust_opens)
    axis.loglog(v[closed] * room, seen[closed] * factor, color=BLUE)
    axis.set(xlabel=f"volume [{room_unit}]", ylabel=f"absolute pressure [{unit}]")
    both_logarithmic(axis)
    return figure


def _burning(result: DiagramCombustion) -> "Figure":
    from mechsym.cycle.wiebe import wiebe
    from mechsym.style import BLUE, INK, RED, axis_unit, legend, panels

    figure, (left, right) = panels(9, 3.4, 1, 2, "Burnt share and heat released over the crank angle")
    phi, rows = _rows(result)
    inside = (phi >= result.analysis.inlet_closes) & (phi <= result.analysis.exhaust_opens)
    at, p, gamma = phi[inside], rows.mean(axis=0)[inside], result.analysis.gamma
    q = heat_release(at, p, result.cylinder, gamma)
    angle = _angles(left)
    left.plot(at * angle, 100 * burnt_fraction(at, q), color=BLUE, label="measured")
    if result.wiebe is not None:
        start, duration, m = result.wiebe.values
        y = np.clip((at - start) / duration, 0.0, 1.0)
        share = np.asarray(wiebe(y, 5.0, m), dtype=float).ravel() / (1 - math.exp(-5.0))
        left.plot(at * angle, 100 * share, "--", color=RED, label="Wiebe")
    left.set_ylabel("burnt share [%]")
    legend(left)
    _angles(right)
    slope = np.gradient(p, at)
    v, v_slope = volume(result.cylinder, at), dvolume_dphi(result.cylinder, at)
    rate = gamma / (gamma - 1) * p * v_slope + v * slope / (gamma - 1)
    smooth = np.convolve(rate, np.ones(3) / 3, mode="same")
    right.plot(at * angle, smooth / angle, color=BLUE)
    right.axhline(0, color=INK, linewidth=0.6)
    right.set_ylabel(f"net heat released [J/{axis_unit('rad', _TO)[1]}]")
    return figure


def _cloud(result: DiagramCombustion) -> "Figure":
    from mechsym.style import BLUE, axis_unit, panels

    figure, (left, right) = panels(9, 3.4, 1, 2, "Net mean pressure, largest pressure and half-burnt angle by cycle")
    work = cycle_work(result.measured, result.cylinder)
    peaks, half = np.array([c.p_max for c in result.cycles]), np.array([c.burn_angles[1] for c in result.cycles])
    (factor, unit), (of_peak, peak_unit), (angle, angle_unit) = (
        _pressure_unit(work), _pressure_unit(peaks), axis_unit("rad", half),
    )  # fmt: skip
    left.plot(peaks * of_peak, work * factor, "o", color=BLUE, markersize=4, alpha=0.7)
    left.set(xlabel=f"largest pressure [{peak_unit}]", ylabel=f"IMEP net [{unit}]")
    if np.isfinite(half).any():
        right.plot(half * angle, work * factor, "o", color=BLUE, markersize=4, alpha=0.7)
        right.set(xlabel=f"angle of half burnt, CA50 [{angle_unit}]", ylabel=f"IMEP net [{unit}]")
    else:
        right.plot(np.arange(1, work.size + 1), work * factor, "o", color=BLUE, markersize=4, alpha=0.7)
        right.set(xlabel="cycle", ylabel=f"IMEP net [{unit}]")
    return figure

"""A dimensioned sheet of the guide, A3: profile in a scale of ISO 5455, table of angle and radius, tolerances, loads.

The title block has the fields of ISO 7200; owner, persons and date of issue are left to whoever signs.
"""

import dataclasses
import math
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

import mechsym
from mechsym import periodic
from mechsym.files import write_bytes
from mechsym.hinge.guide import path as centre_path
from mechsym.hinge.springs.face import Spring
from mechsym.jobs.hinge import Workshop
from mechsym.out.cad.curve import Groove, hermite
from mechsym.quantities import RPM
from mechsym.quantities.display import quantity_text
from mechsym.sizing.rules.bearings import equivalent_load, required_rating

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MM = 1e3
_ALONG = 0.53  # of the way to the inner wall, where the words of an arrow stand
_EVERY = 10  # degrees between the rows of the table
_LIFE = 20_000.0  # hours that the rollers are asked for
_PAPER = (420.0, 297.0)  # A3 [mm]
_SCALES = tuple(step * 10.0**power for power in range(-2, 4) for step in (1, 2, 5))  # ISO 5455, model by paper
_RIPPLE = 1e-3  # what each tolerance may cost by itself: assumed
_GENERAL = "ISO 2768-mK"
_ROUGHNESS = "Ra 0.8 µm, rolling tracks (assumed)"


def roller_life(shop: Workshop) -> tuple[float, float, float]:
    """Equivalent load of a roller [N], its mean speed [rad/s], and the rating that it needs for 20 000 h [N]."""
    c = shop.contact
    # a roller turns by the way its centre goes over its radius
    turning = np.hypot(c.rho, c.drho) * np.gradient(c.theta) / shop.rollers.radius
    speed = float(np.sum(turning)) / float(c.phi[-1]) * shop.machine.omega
    load = float(equivalent_load(c.reaction_1, "roller", turning))
    return load, speed, required_rating(load, speed * 3600 * _LIFE / (2 * math.pi), "roller")


def write(shop: Workshop, track: Groove, path: Path, bore: float) -> Path:
    """Write the sheet as SVG or PDF, by the ending of the file; `bore` is the diameter of the hole [m]."""
    import io

    import matplotlib

    kind, buffer = path.suffix.lower(), io.BytesIO()
    dates: dict[str, dict[str, None]] = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    with matplotlib.rc_context({"svg.hashsalt": "mechsym", "svg.fonttype": "path"}):
        sheet(shop, track, bore).savefig(buffer, format=kind[1:], metadata=dates[kind])
    return write_bytes(path, buffer.getvalue())


def sheet(shop: Workshop, track: Groove, bore: float) -> Figure:
    """The sheet as a figure of A3; `bore` is the diameter of the hole [m]."""
    figure = Figure(figsize=(_PAPER[0] / 25.4, _PAPER[1] / 25.4))
    frame = figure.add_axes(_box(20, 10, 390, 277))
    frame.set(xticks=[], yticks=[])
    scale = _profile(figure, shop, track, bore)
    _table(figure.add_axes(_box(258, 62, 147, 220)), shop)
    _said(figure.add_axes(_box(20, 10, 210, 46)), shop, track, bore)
    _title(figure.add_axes(_box(230, 10, 180, 46)), shop, scale)
    return figure


def _box(x: float, y: float, wide: float, high: float) -> tuple[float, float, float, float]:
    """A place on the paper [mm], as shares of it."""
    return x / _PAPER[0], y / _PAPER[1], wide / _PAPER[0], high / _PAPER[1]


def _profile(figure: Figure, shop: Workshop, track: Groove, bore: float) -> float:
    """Draw the track; returns millimetres of the guide by millimetre of paper."""
    wide, high = 228.0, 222.0
    axis = figure.add_axes(_box(25, 60, wide, high))
    axis.axis("off")
    outside = _MM * float(np.max(np.hypot(*track.outer.points.T)))
    scale = next(step for step in _SCALES if 2.1 * outside <= step * min(wide, high))
    axis.set(xlim=(-scale * wide / 2, scale * wide / 2), ylim=(-scale * high / 2, scale * high / 2))
    theta = np.linspace(0, 2 * math.pi, 1441)
    for curve, style, width in ((track.centre, "-.", 0.8), (track.inner, "-", 1.3), (track.outer, "-", 1.3)):
        width_of = np.diff(curve.theta)[:, None]  # eight points in each piece
        ways = width_of * curve.tangents[:-1], width_of * curve.tangents[1:]
        parts = [hermite(curve.points[:-1], curve.points[1:], *ways, u) for u in np.arange(8) / 8]
        points = _MM * np.concatenate([np.stack(parts, 1).reshape(-1, 2), curve.points[-1:]])
        axis.plot(*points.T, style, color="black" if width > 1 else "#1f5fa8", linewidth=width)
    hole = _MM * bore / 2
    axis.plot(hole * np.cos(theta), hole * np.sin(theta), "-", color="black", linewidth=1.3)
    start, r = _MM * track.centre.points[0], _MM * track.roller_radius
    axis.plot(start[0] + r * np.cos(theta), start[1] + r * np.sin(theta), "-", color="#2f7d4f", linewidth=1.0)
    reach = 1.04 * outside
    axis.plot([-reach, reach], [0, 0], "-.", [0, 0], [-reach, reach], "-.", color="#8a8f98", linewidth=0.7)
    inside = _MM * float(np.min(np.hypot(*track.inner.points.T)))
    _radii(axis, shop, scale, _ALONG * inside)
    # outside of the track and inside of it, where no line is
    corner, arrow = (0.96 * scale * wide / 2, 0.96 * scale * high / 2), {"arrowstyle": "->"}
    axis.annotate(f"roller ⌀{2 * r:.6g}", (start[0], start[1] + r), corner, arrowprops=arrow, ha="right", va="top")
    if bore:
        axis.annotate(f"bore ⌀{_MM * bore:.6g}", (0, -hole), (0.15 * inside, -0.5 * inside), arrowprops=arrow)
    return scale


def _radii(axis: "Axes", shop: Workshop, scale: float, along: float) -> None:
    """Smallest and largest radius of the centre path, their words between shaft and track, beside their arrows."""
    low, at_low, high, at_high = periodic.extremes(centre_path(shop.guide))
    for rho, angle, word, side in ((low, at_low, "smallest", "bottom"), (high, at_high, "largest", "top")):
        end = _MM * rho * np.array([math.cos(angle), math.sin(angle)])
        axis.annotate("", (end[0], end[1]), (0, 0), arrowprops={"arrowstyle": "<->", "color": "#b5342b"})
        turned = (math.degrees(angle) + 90) % 180 - 90
        # two millimetres of paper off the arrow, one above and one below, so that neither stands on the other
        away = 2.0 * scale * (1 if side == "bottom" else -1)
        normal = away * np.array([-math.sin(math.radians(turned)), math.cos(math.radians(turned))])
        x, y = along * end / (_MM * rho) + normal
        label = f"{word} rho {_MM * rho:.3f} at {math.degrees(angle):.2f}°"
        axis.text(x, y, label, rotation=turned, rotation_mode="anchor", ha="center", va=side, color="#b5342b",
                  fontsize=7.5, bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0}, zorder=2.5)  # fmt: skip


def _table(axis: "Axes", shop: Workshop) -> None:
    axis.axis("off")
    angles = np.arange(0, 360, _EVERY)
    rho = _MM * centre_path(shop.guide)(np.radians(angles))
    half = len(angles) // 2
    rows = [[f"{angles[i]}", f"{rho[i]:.3f}", f"{angles[i + half]}", f"{rho[i + half]:.3f}"] for i in range(half)]
    titles = ["theta [deg]", "rho [mm]"] * 2
    table = axis.table(
        cellText=rows, colLabels=titles, loc="upper center", cellLoc="center", bbox=Bbox.from_bounds(0, 0.33, 1, 0.67)
    )
    table.auto_set_font_size(False)
    table.set_fontsize(9)
    notes = [row for note in _notes(shop) for row in textwrap.wrap(note.replace("± ", "±\u00a0"), 90)]
    axis.text(0, 0.31, "\n".join(notes), va="top", fontsize=8.5, linespacing=1.5)


def _notes(shop: Workshop) -> list[str]:
    load, speed, rating = roller_life(shop)
    rollers, c = shop.rollers, shop.contact

    def share(value: float | None) -> str:
        return "no steady motion" if value is None else f"{100 * value:.3g} %"

    return [
        "rho: shaft axis to roller centre; theta: angle of the guide's shaft, counter-clockwise",
        *(f"{by.name} {by.words}: ripple {share(by.low)}, {share(by.high)}" for by in shop.tolerances),
        f"so that each by itself costs {100 * _RIPPLE:g} % of ripple at most: {', '.join(tolerances(shop))}",
        f"material: E = {rollers.E / 1e9:.4g} GPa, nu = {rollers.nu:g}; contact stress up to "
        f"{np.max(c.hertz_stress) / 1e6:.4g} MPa",
        f"roller force {np.min(c.reaction_1) / 1e3:.4g} to {np.max(c.reaction_1) / 1e3:.4g} kN at "
        f"{speed / RPM:.5g} rpm; equivalent over a turn {load / 1e3:.4g} kN (ISO 281)",
        f"rating C of the roller's bearing for {_LIFE:,.0f} h: at least {rating / 1e3:.4g} kN".replace(",", " "),
        f"limits: {shop.verdict.reason}",
    ]


def tolerances(shop: Workshop) -> list[str]:
    """What may be off, by proportion to the ripple that a known error costs; none of what has no steady motion."""
    rows = []
    for by in shop.tolerances:
        worst = max(math.inf if ripple is None else ripple for ripple in (by.low, by.high))
        if 0 < worst < math.inf:
            rows.append(f"{by.name} ± {quantity_text(by.size * _RIPPLE / worst, by.unit, 2)}")
    return rows


def spring_text(spring: Spring) -> str:
    """A spring in words: its kind and its numbers with units."""
    fields = dataclasses.fields(spring)
    numbers = [f"{f.name} = {quantity_text(getattr(spring, f.name), f.metadata['unit'], 6)}" for f in fields]
    return f"{spring.words}, {', '.join(numbers)}"


def plain(text: str) -> str:
    """Powers as signs: a caret begins a control character in a DXF text."""
    return text.replace("^2", "²").replace("^3", "³").replace("^", "")


def _said(axis: "Axes", shop: Workshop, track: Groove, bore: float) -> None:
    axis.set(xticks=[], yticks=[])
    g = shop.guide.parameters
    tracks = f"{len(track.turned)} tracks, the second turned by 180°" if len(track.turned) > 1 else "one track"
    lines = [
        f"Guide of {shop.name}: {shop.about}",
        f"{shop.guide.omega / RPM:.5g} rpm of the crank, shaft ratio {g.shaft_ratio:g}, "
        f"rho0 {_MM * g.rho0:.6g} mm, {tracks}, bore {_MM * bore:.6g} mm",
        f"spring: {plain(spring_text(shop.guide.spring))}",
        f"dimensions in mm; curves of the DXF within {1e6 * track.tolerance:.3g} µm; rigid, no clearance, no friction "
        "in the rollers' bearings",
    ]
    wrapped = [row for line in lines for row in textwrap.wrap(line, 125)]
    axis.text(0.012, 0.93, "\n".join(wrapped), va="top", fontsize=8, linespacing=1.5)


def _title(axis: "Axes", shop: Workshop, scale: float) -> None:
    """Title block of ISO 7200, 180 mm wide."""
    axis.set(xticks=[], yticks=[], xlim=(0, 180), ylim=(0, 46))
    ratio = f"1:{scale:g}" if scale >= 1 else f"{1 / scale:g}:1"
    rows = (
        (("scale", ratio, 30), ("general tolerance", _GENERAL, 50), ("surface of the track", _ROUGHNESS, 100)),
        (("legal owner", "", 60), ("created by", "", 60), ("approved by", "", 60)),
        (("title", f"Guide of {shop.name}", 90), ("document type", "workshop drawing", 45),
         ("made with", f"mechsym {mechsym.__version__}", 45)),
        (("identification number", shop.name, 60), ("revision", "", 20), ("date of issue", "", 50),
         ("language", "en", 20), ("sheet", "1/1", 30)),
    )  # fmt: skip
    high = 46 / len(rows)
    for row, cells in enumerate(rows):
        top, left = 46 - row * high, 0.0
        axis.plot([0, 180], [top - high] * 2, color="black", linewidth=0.6)
        for name, value, wide in cells:
            axis.plot([left + wide] * 2, [top, top - high], color="black", linewidth=0.6)
            axis.text(left + 1, top - 1, name, va="top", fontsize=5.5, color="#505660")
            axis.text(left + 1.5, top - high + 1.8, value, va="bottom", fontsize=9)
            left += wide

"""A dimensioned sheet of the guide: profile to scale, table of angle and radius, tolerances, loads, title block."""

import dataclasses
import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from mechsym import periodic
from mechsym.errors import BadInput
from mechsym.files import write_bytes
from mechsym.hinge.guide import path as centre_path
from mechsym.hinge.springs.face import Spring
from mechsym.jobs.hinge import Workshop
from mechsym.out.cad.curve import CubicPath, Groove, hermite
from mechsym.quantities import RPM
from mechsym.quantities.display import quantity_text
from mechsym.sizing.rules.bearings import equivalent_load, required_rating

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MM = 1e3
_ALONG = 0.55  # of an arrow, where its words stand
_EVERY = 10  # degrees between the rows of the table
_LIFE = 20_000.0  # hours that the rollers are asked for
_FORMATS = (".svg", ".pdf")


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

    if path.suffix not in _FORMATS:
        raise BadInput(f"--sheet {str(path)!r} has an ending that is not allowed; allowed are {', '.join(_FORMATS)}")
    buffer = io.BytesIO()
    dates: dict[str, dict[str, None]] = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    with matplotlib.rc_context({"svg.hashsalt": "mechsym", "svg.fonttype": "path"}):
        sheet(shop, track, bore).savefig(buffer, format=path.suffix[1:], metadata=dates[path.suffix])
    return write_bytes(path, buffer.getvalue())


def sheet(shop: Workshop, track: Groove, bore: float) -> Figure:
    """The sheet as a figure of A3; `bore` is the diameter of the hole [m]."""
    figure = Figure(figsize=(16.5, 11.7))
    _profile(figure.add_axes((0.03, 0.2, 0.55, 0.77)), shop, track, bore)
    _table(figure.add_axes((0.6, 0.2, 0.37, 0.77)), shop)
    _title(figure.add_axes((0.03, 0.03, 0.94, 0.15)), shop, track, bore)
    return figure


def _profile(axis: "Axes", shop: Workshop, track: Groove, bore: float) -> None:
    theta = np.linspace(0, 2 * math.pi, 1441)
    axis.set_aspect("equal")
    axis.axis("off")
    for curve, style, width in ((track.centre, "-.", 0.8), (track.inner, "-", 1.3), (track.outer, "-", 1.3)):
        points = _MM * _dense(curve)
        axis.plot(*points.T, style, color="black" if width > 1 else "#1f5fa8", linewidth=width)
    hole = _MM * bore / 2
    axis.plot(hole * np.cos(theta), hole * np.sin(theta), "-", color="black", linewidth=1.3)
    start, r = _MM * track.centre.points[0], _MM * track.roller_radius
    axis.plot(start[0] + r * np.cos(theta), start[1] + r * np.sin(theta), "-", color="#2f7d4f", linewidth=1.0)
    axis.annotate(
        f"roller ⌀{2 * r:.6g}", start, (start[0] + 1.2 * r, start[1] + 2.2 * r), arrowprops={"arrowstyle": "->"}
    )
    axis.annotate(f"bore ⌀{_MM * bore:.6g}", (0, 0), (0.6 * r, -1.5 * r), arrowprops={"arrowstyle": "->"})
    reach = 1.15 * _MM * float(np.max(np.hypot(*track.outer.points.T)))
    axis.plot([-reach, reach], [0, 0], "-.", [0, 0], [-reach, reach], "-.", color="#8a8f98", linewidth=0.7)
    low, at_low, high, at_high = periodic.extremes(centre_path(shop.guide))
    for rho, angle, word, side in ((low, at_low, "smallest", "bottom"), (high, at_high, "largest", "top")):
        end = _MM * rho * np.array([math.cos(angle), math.sin(angle)])
        axis.annotate("", (end[0], end[1]), (0, 0), arrowprops={"arrowstyle": "<->", "color": "#b5342b"})
        told = f"{word} rho {_MM * rho:.4f} mm\nat {math.degrees(angle):.3f}°"
        # along its own arrow, one above and one below, so that neither stands on the other
        turned = (math.degrees(angle) + 90) % 180 - 90
        x, y = _ALONG * end
        axis.text(x, y, told, rotation=turned, rotation_mode="anchor", ha="center", va=side, color="#b5342b",
                  bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0}, zorder=2.5)  # fmt: skip


def _dense(curve: CubicPath) -> np.ndarray:
    """Points along a cubic path, eight in each piece, shape (k, 2) [m]."""
    width = np.diff(curve.theta)[:, None]
    parts = [
        hermite(curve.points[:-1], curve.points[1:], width * curve.tangents[:-1], width * curve.tangents[1:], u)
        for u in np.arange(8) / 8
    ]
    return np.concatenate([np.stack(parts, 1).reshape(-1, 2), curve.points[-1:]])


def _table(axis: "Axes", shop: Workshop) -> None:
    axis.axis("off")
    angles = np.arange(0, 360, _EVERY)
    rho = _MM * centre_path(shop.guide)(np.radians(angles))
    half = len(angles) // 2
    rows = [[f"{angles[i]}", f"{rho[i]:.4f}", f"{angles[i + half]}", f"{rho[i + half]:.4f}"] for i in range(half)]
    titles = ["theta [deg]", "rho [mm]"] * 2
    table = axis.table(
        cellText=rows, colLabels=titles, loc="upper center", cellLoc="center", bbox=Bbox.from_bounds(0, 0.33, 1, 0.67)
    )
    table.auto_set_font_size(False)
    table.set_fontsize(9)
    axis.text(0, 0.29, "\n".join(_notes(shop)), va="top", fontsize=9, linespacing=1.5)


def _notes(shop: Workshop) -> list[str]:
    load, speed, rating = roller_life(shop)
    rollers, c = shop.rollers, shop.contact
    told = [f"{what}: ripple {_share(low)}, {_share(high)}" for what, low, high in shop.tolerances]
    return [
        "rho: shaft axis to roller centre; theta: angle of the guide's shaft, counter-clockwise",
        *told,
        f"material: E = {rollers.E / 1e9:.4g} GPa, nu = {rollers.nu:g}; contact stress up to "
        f"{np.max(c.hertz_stress) / 1e6:.4g} MPa",
        f"roller force {np.min(c.reaction_1) / 1e3:.4g} to {np.max(c.reaction_1) / 1e3:.4g} kN at "
        f"{speed / RPM:.5g} rpm; equivalent over a turn {load / 1e3:.4g} kN (ISO 281)",
        f"rating C of the roller's bearing for {_LIFE:,.0f} h: at least {rating / 1e3:.4g} kN".replace(",", " "),
        f"limits: {shop.verdict.reason}",
    ]


def spring_text(spring: Spring) -> str:
    """A spring in words: its kind and its numbers with units."""
    fields = dataclasses.fields(spring)
    numbers = [f"{f.name} = {quantity_text(getattr(spring, f.name), f.metadata['unit'], 6)}" for f in fields]
    return f"{spring.words}, {', '.join(numbers)}"


def _share(value: float | None) -> str:
    return "no steady motion" if value is None else f"{100 * value:.3g} %"


def _title(axis: "Axes", shop: Workshop, track: Groove, bore: float) -> None:
    axis.set_xticks([])
    axis.set_yticks([])
    g = shop.guide.parameters
    tracks = f"{len(track.turned)} tracks, the second turned by 180°" if len(track.turned) > 1 else "one track"
    lines = [
        f"Guide of {shop.name}: {shop.about}",
        f"{shop.guide.omega / RPM:.5g} rpm of the crank, shaft ratio {g.shaft_ratio:g}, "
        f"rho0 {_MM * g.rho0:.6g} mm, {tracks}, bore {_MM * bore:.6g} mm",
        f"spring: {spring_text(shop.guide.spring)}",
        f"dimensions in mm; curves of the DXF within {1e6 * track.tolerance:.3g} µm; rigid, no clearance, no friction "
        "in the rollers' bearings",
    ]
    axis.text(0.01, 0.92, "\n".join(lines), va="top", fontsize=10, linespacing=1.7)

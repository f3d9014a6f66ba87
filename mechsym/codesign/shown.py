"""What of a co-design is worth seeing and has to be known first, and its files: one HTML page, tables, pictures."""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from mechsym.codesign import plots
from mechsym.codesign.result import CoDesignNumbers, CoDesignResult, bound_words, prices
from mechsym.codesign.task import Track, fine_path
from mechsym.files import Json, to_json, write_quantities, write_text
from mechsym.hinge.shown import lost_combustion
from mechsym.page import Card, Picture, View, grid, page, ranked, shows, title_mark
from mechsym.page.finding import LEAST_SURE, NOT_MET, Finding
from mechsym.quantities.display import figure, quantity_text, ratio_text, residual_text
from mechsym.style import svg


@shows(CoDesignResult)
def codesign_view(result: CoDesignResult) -> View:
    """The flywheel beside what it would be otherwise, the ripple that is kept, what is lost."""
    design, broken = result.design, result.verified.broken
    bare = f"added; without a hinge {quantity_text(result.bare, 'kg*m^2', 4)}"
    shares = [at.total / abs(p.load_torque) for at, p in zip(result.losses, design.task.points, strict=True)]
    target = result.target
    cards = (
        Card(name="flywheel", value=quantity_text(design.flywheel, "kg*m^2", 4), about=bare),
        Card(name="speed ripple", value=ratio_text(float(max(design.ripple))),
             about=f"largest of all points, {'with' if design.task.losses else 'without'} losses"),
        Card(name="target", value="kept" if target.met else "missed" if target.held else "no design",
             about=result.answer, mark="yes" if target.met else "no"),
        Card(name="limits", value="kept" if target.held else "NOT kept", about="; ".join(broken) or design.reason,
             mark="" if target.held else "no"),
        Card(name="losses of the hinge", value=f"{figure(100 * float(max(shares)), 3)} %",
             about="of the load's torque at the worst point, with assumed friction"),
    )  # fmt: skip
    return View(
        title=f"Co-design of {result.name}", cards=cards, pictures=_pictures(result),
        columns=lambda: point_columns(result), findings=lambda: of_codesign(result),
    )  # fmt: skip


def _pictures(result: CoDesignResult) -> tuple[Picture, ...]:
    """All that there is something to draw for."""
    design, bound, checked = result.design, result.bound, result.verified
    torques = [abs(p.load_torque) for p in design.task.points]
    shares = [at.total / torque for at, torque in zip(result.losses, torques, strict=True)]
    ripple = float(np.max([checked.programme_ripple, checked.steady_ripple, checked.time_ripple]))
    closings = [v for c in checked.contacts for v in (c.z_min, c.z_max)]
    radii = [v for c in checked.contacts for v in (c.rho_min, c.rho_max)]
    pressures = _span([float(p) for track in design.tracks for p in track.p0], "Pa")
    wanted, left = (quantity_text(v, "kg*m^2", 4) for v in (np.ptp(bound.wanted, axis=1).max(), bound.best[0].swing))
    added, bare = (quantity_text(v, "kg*m^2", 4) for v in (design.flywheel, result.bare))
    works = "Works that the points want, by the square of their speeds, which swing by up to " + wanted
    if len(torques) > 1:
        works = f"Left: {works[0].lower()}{works[1:]}. Right: what the best single shape leaves, a swing of {left}"
    rows = [
        ("guides", plots.guides, f"Paths of the roller centres to scale, {_span(radii, 'm')} from the shaft; the "
         f"springs close by {_span(closings, 'm')}."),
        ("front", plots.front, f"Flywheel over the ripple: {added} is added with the hinge and {bare} without. The "
         "dotted line is an estimate that knows no guide: massless rollers, weak ripple."),
        ("works", plots.works, f"{works}."),
        ("losses", plots.losses, f"Friction and heat take {_percent(min(shares))} to {_percent(max(shares))} of the "
         "load's torque."),
    ]  # fmt: skip
    if len(torques) > 1:
        see = f"Ripple by the programme, over the angle and by a run in time, at most {_percent(ripple)} at "
        rows.insert(0, ("points", plots.points, f"{see}{len(torques)} points, and the pressures to set, {pressures}."))
    if any(s.run is not None for s in result.scenarios):
        see = "Speed by the mean before, over turns, at the slowest and the fastest point. In a turn without "
        see += "combustion the gas goes back along the compression line and the load brakes on."
        rows.append(("scenarios", plots.scenarios, see))
    if result.spread is not None:
        see = f"Left: largest ripple of all points; 19 of 20 machines keep {_percent(result.spread.p95)}. Right: each "
        see += "error alone, at two sigma to either side (shares; of n the index itself)."
        rows.append(("spread", plots.spread, see))
    if result.map is not None:
        see = "Ripple, and the pressure with the least ripple, over speed and load; the line joins the points of the "
        see += "design. Ripple above 30 % or a shaft that stops is drawn as 30 %."
        rows.append(("map", plots.ripple_map, see))
    return tuple(Picture(name=name, see=see, draw=partial(draw, result)) for name, draw, see in rows)


def _percent(share: float) -> str:
    return f"{figure(100 * share, 3)} %"


def _span(values: Sequence[float], unit: str) -> str:
    return " to ".join(quantity_text(end, unit, 4) for end in dict.fromkeys((min(values), max(values))))


def of_codesign(result: CoDesignResult) -> Iterator[Finding]:
    """What of a co-design has to be known first."""
    if not result.target.met:
        worst = [ripple for ripple in result.target.with_losses if ripple is not None]
        yield Finding(rank=NOT_MET, words=result.answer, value=max(worst, default=None))
    points = result.design.task.points
    known = [(share, k) for k, share in enumerate(result.misfire) if share is not None]
    if known:
        share, k = min(known)
        where = f" at {quantity_text(points[k].omega, 'rad/s', 4)}" if len(points) > 1 else ""
        yield from lost_combustion(share, where)
    if result.taken != "none":
        shares = [at.total / abs(p.load_torque) for at, p in zip(result.losses, points, strict=True)]
        words = f"friction in the hinge is assumed: {figure(100 * max(shares), 3)} % of the torque at the worst point"
        yield Finding(rank=LEAST_SURE, words=words, value=max(shares))


#: what a guide is made with, and what it bears: words, SI unit, keys of `guides` in the summary
_SIZES = (
    ("piston area", "m^2", ("A",)),
    ("gas column H", "m", ("H",)),
    ("roller centre to shaft axis", "m", ("rho_min", "rho_max")),
    ("closing", "m", ("z_min", "z_max")),
    ("roller radius", "m", ("roller_radius",)),
    ("roller width", "m", ("roller_width",)),
    ("mass on a roller", "kg", ("moving_mass",)),
    ("highest pressure in the spring", "Pa", ("spring_pressure_max",)),
    ("roller force", "N", ("roller_reaction_min", "roller_reaction_max")),
    ("side force", "N", ("side_force_max",)),
    ("contact stress", "Pa", ("hertz_stress_max",)),
    ("pressure angle", "rad", ("pressure_angle_max",)),
)

_DANGERS = ("misfire", "burst", "leak", "astern")  # what a builder asks about first


def write(result: CoDesignResult, numbers: CoDesignNumbers, summary: Json, folder: Path) -> list[Path]:
    """Write page, summary as it is `told`, tables and pictures into a folder, which is made when missing."""
    pictures = {picture.name: svg(picture.draw()) for picture in result.view.pictures}
    files = [
        write_text(folder / "report.html", html(result, numbers, pictures)),
        write_text(folder / "summary.json", to_json(summary) + "\n"),
        _table(folder / "points.csv", point_columns(result)),
    ]
    for s, track in enumerate(result.design.tracks):
        name = "guide.csv" if len(result.design.tracks) == 1 else f"guide_{s + 1}.csv"
        files.append(_table(folder / name, guide_columns(result, track)))
    return files + [write_text(folder / f"{name}.svg", text) for name, text in pictures.items()]


def _table(path: Path, columns: Mapping[str, Sequence[float] | np.ndarray]) -> Path:
    """Columns with their units in the headings, in the units that were chosen."""
    named = {heading: heading.removesuffix("]").partition(" [") for heading in columns}
    units = {name: unit for name, _, unit in named.values()}
    return write_quantities(path, {named[heading][0]: values for heading, values in columns.items()}, units)


def html(result: CoDesignResult, numbers: CoDesignNumbers, pictures: dict[str, str]) -> str:
    """The page as text."""
    findings = ranked(of_codesign(result))
    # what the first page of a builder says beside the numbers: dangers, ripple with losses, share of the heat
    ripples, residuals = [at.ripple for at in result.lossy], np.abs(result.verified.energy_residual)
    points = result.design.task.points
    speeds = [p.omega for p in points]
    # what the design holds at each point
    tracks, checked = result.design.tracks, result.verified
    springs = ["p0"] if len(tracks) == 1 else [f"p0 of spring {s + 1}" for s in range(len(tracks))]
    rows = [
        {"speed": p.omega, "mean pressure": p.load,
         **{name: float(track.p0[k]) for name, track in zip(springs, tracks, strict=True)},
         "ripple, programme [%]": 100 * float(result.design.ripple[k]),
         "over the angle [%]": 100 * float(checked.steady_ripple[k]),
         "run in time [%]": 100 * float(checked.time_ripple[k]),
         "energy residual": residual_text(float(checked.energy_residual[k]), 2),
         "losses [%]": 100 * float(numbers.losses.share[k]),
         "speed after a misfire [%]": _share(numbers.misfire_speed_share[k])}
        for k, p in enumerate(result.design.task.points)
    ]  # fmt: skip
    units = {"speed": "rad/s", "mean pressure": "Pa", **dict.fromkeys(springs, "Pa")}
    return page(
        "codesign.html", result=result, numbers=numbers, findings=findings,
        mark=title_mark(findings), figures=pictures,
        see={picture.name: picture.see for picture in result.view.pictures}, sizes=_SIZES,
        points=grid("Points", rows, list(rows[0]), units), prices=prices(numbers), bound=bound_words(numbers),
        dangers=[s for name in _DANGERS for s in result.scenarios if s.name == name],
        lossy_ripple=None if None in ripples else max(r for r in ripples if r is not None),
        gas_share=max(at.gas / abs(p.load_torque) for at, p in zip(result.losses, points, strict=True)),
        residual=residual_text(float(np.nanmax(residuals)), 1) if np.isfinite(residuals).any() else "–",
        index=result.design.tracks[0].hardware.spring.index, gamma=result.assumed.gamma,
        speeds=(min(speeds), max(speeds)),
    )  # fmt: skip


def _share(value: float | None) -> float | None:
    return None if value is None else 100 * value


def point_columns(result: CoDesignResult) -> dict[str, Sequence[float] | np.ndarray]:
    """The points as columns, SI."""
    design = result.design
    columns: dict[str, Sequence[float] | np.ndarray] = {
        "omega [rad/s]": [p.omega for p in design.task.points],
        "load [Pa]": [p.load for p in design.task.points],
        "load_torque [N*m]": [p.load_torque for p in design.task.points],
        "ripple [-]": design.ripple,
    }
    for s, track in enumerate(design.tracks):
        columns[f"p0_{s + 1} [Pa]"] = track.p0
    return columns


def guide_columns(result: CoDesignResult, track: Track) -> dict[str, np.ndarray]:
    """One guide over the angle of its shaft as columns, SI; forces at the last point."""
    h, last = track.hardware, result.design.task.points[-1]
    phi, path = fine_path(track, last.period)
    at = h.station(path, h.charged(float(track.p0[-1])), last.omega)
    pressed = {} if at.pressure is None else {"pressure [Pa]": at.pressure}
    return {
        "theta [rad]": phi * h.shaft_ratio, "rho [m]": at.rho, "drho [m/rad]": at.drho, "d2rho [m/rad^2]": at.d2rho,
        "z [m]": at.z, **pressed, "reaction [N]": at.reaction,
    }  # fmt: skip

"""Files of a co-design: one HTML page for a builder that opens offline, tables of guides and points, pictures."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from mechsym.codesign import plots
from mechsym.codesign.contact_block import fine_path
from mechsym.codesign.findings import of_codesign
from mechsym.codesign.result import CoDesignResult
from mechsym.codesign.summary import CoDesignNumbers, bound_words, prices
from mechsym.codesign.task import Track
from mechsym.files import Json, to_json, write_quantities, write_text
from mechsym.page import Grid, grid, page, ranked, title_mark
from mechsym.quantities.display import ratio_text
from mechsym.style import svg

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


def write(result: CoDesignResult, numbers: CoDesignNumbers, told: Json, folder: Path) -> list[Path]:
    """Write page, summary as it is `told`, tables and pictures into a folder, which is made when missing."""
    pictures = figures(result)
    files = [
        write_text(folder / "report.html", html(result, numbers, pictures)),
        write_text(folder / "summary.json", to_json(told) + "\n"),
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
    return page(
        "codesign.html", result=result, numbers=numbers, findings=findings,
        mark=title_mark(findings), figures=pictures, sizes=_SIZES,
        points=_points(result, numbers), prices=prices(numbers), bound=bound_words(numbers), **_first_page(result),
    )  # fmt: skip


def _first_page(result: CoDesignResult) -> dict[str, object]:
    """What the first page of a builder says beside the numbers: dangers, ripple with losses, share of the heat."""
    ripples, residuals = [at.ripple for at in result.lossy], np.abs(result.verified.energy_residual)
    points = result.design.task.points
    speeds = [p.omega for p in points]
    return {
        "dangers": [s for name in _DANGERS for s in result.scenarios if s.name == name],
        "lossy_ripple": None if None in ripples else max(r for r in ripples if r is not None),
        "gas_share": max(at.gas / abs(p.load_torque) for at, p in zip(result.losses, points, strict=True)),
        "residual": ratio_text(float(np.nanmax(residuals)), 1) if np.isfinite(residuals).any() else "–",
        "index": result.design.tracks[0].hardware.spring.index, "gamma": result.assumed.gamma,
        "speeds": (min(speeds), max(speeds)),
    }  # fmt: skip


def _share(value: float | None) -> float | None:
    return None if value is None else 100 * value


def _points(result: CoDesignResult, numbers: CoDesignNumbers) -> Grid:
    """What the design holds at each point."""
    tracks, checked = result.design.tracks, result.verified
    springs = ["p0"] if len(tracks) == 1 else [f"p0 of spring {s + 1}" for s in range(len(tracks))]
    rows = [
        {"speed": p.omega, "mean pressure": p.load,
         **{name: float(track.p0[k]) for name, track in zip(springs, tracks, strict=True)},
         "ripple, programme [%]": 100 * float(result.design.ripple[k]),
         "over the angle [%]": 100 * float(checked.steady_ripple[k]),
         "run in time [%]": 100 * float(checked.time_ripple[k]),
         "energy residual": ratio_text(float(checked.energy_residual[k]), 2),
         "losses [%]": 100 * float(numbers.losses.share[k]),
         "speed after a misfire [%]": _share(numbers.misfire_speed_share[k])}
        for k, p in enumerate(result.design.task.points)
    ]  # fmt: skip
    units = {"speed": "rad/s", "mean pressure": "Pa", **dict.fromkeys(springs, "Pa")}
    return grid("Points", rows, list(rows[0]), units)


def figures(result: CoDesignResult) -> dict[str, str]:
    """All pictures that there is something to draw for, as SVG."""
    made = {
        "points": plots.points(result),
        "front": plots.front(result),
        "works": plots.works(result),
        "guides": plots.guides(result),
        "losses": plots.losses(result),
        "scenarios": plots.scenarios(result),
        "spread": plots.spread(result),
        "map": plots.ripple_map(result),
    }
    return {name: svg(figure) for name, figure in made.items() if figure is not None}


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

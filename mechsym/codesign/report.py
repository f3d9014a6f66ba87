"""Files of a co-design: one HTML page for a builder that opens offline, tables of guides and points, pictures."""

from pathlib import Path
from typing import Any

import numpy as np

from mechsym.codesign import plots
from mechsym.codesign.contact_block import contact_force
from mechsym.codesign.hardware import gas_pressure, outside
from mechsym.codesign.result import CoDesignResult
from mechsym.codesign.task import Track
from mechsym.codesign.verify import fine_path
from mechsym.files import to_json, write_csv, write_text
from mechsym.page import page
from mechsym.style import svg


def write(result: CoDesignResult, numbers: dict[str, Any], folder: Path) -> list[Path]:
    """Write page, summary, tables and pictures into a folder, which is made when missing."""
    pictures = figures(result)
    files = [
        write_text(folder / "report.html", html(result, numbers, pictures)),
        write_text(folder / "summary.json", to_json(numbers) + "\n"),
        write_csv(folder / "points.csv", point_columns(result)),
    ]
    for s, track in enumerate(result.design.tracks):
        name = "guide.csv" if len(result.design.tracks) == 1 else f"guide_{s + 1}.csv"
        files.append(write_csv(folder / name, guide_columns(result, track)))
    return files + [write_text(folder / f"{name}.svg", text) for name, text in pictures.items()]


def html(result: CoDesignResult, numbers: dict[str, Any], pictures: dict[str, str]) -> str:
    """The page as text."""
    return page("codesign.html", result=result, numbers=numbers, figures=pictures, degrees=180 / np.pi)


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


def point_columns(result: CoDesignResult) -> dict[str, Any]:
    """The points as columns of a CSV file, SI."""
    design = result.design
    columns: dict[str, Any] = {
        "omega [rad/s]": [p.omega for p in design.task.points],
        "load [Pa]": [p.load for p in design.task.points],
        "load_torque [N*m]": [p.load_torque for p in design.task.points],
        "ripple [-]": design.ripple,
    }
    for s, track in enumerate(design.tracks):
        columns[f"p0_{s + 1} [Pa]"] = track.p0
    return columns


def guide_columns(result: CoDesignResult, track: Track) -> dict[str, np.ndarray]:
    """One guide over the angle of its shaft as columns of a CSV file, SI; forces at the last point."""
    h, last = track.hardware, result.design.task.points[-1]
    phi, path = fine_path(track, last.period)
    pressure = gas_pressure(path.z, track.p0[-1], h.H, h.n, outside(h))
    return {
        "theta [rad]": phi * h.shaft_ratio, "rho [m]": path.rho, "drho [m/rad]": path.drho,
        "d2rho [m/rad^2]": path.d2rho, "z [m]": path.z, "pressure [Pa]": pressure,
        "reaction [N]": contact_force(path, h.A * pressure, h.moving_mass, h.shaft_ratio * last.omega),
    }  # fmt: skip

"""A DXF file read again and measured against the path of the guide: `python -m mechsym.out.cad.check FILE CASE`.

Nothing here comes from the writer: the file is read by ezdxf, its splines are evaluated by ezdxf, and each point's
distance to the true path is found by Newton's method. A curve within a tolerance has length and area within it too, so
the file also states those of the exact curve, which are compared with the path to the last digits.
"""

import math
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mechsym.errors import BadInput, MissingExtra
from mechsym.hinge.guide import path as path_of
from mechsym.jobs.export import guide_named
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import record

if TYPE_CHECKING:
    from ezdxf.entities import Spline

_POINTS = 4000  # of each spline
_DIGITS = 1e-5  # of the length and area that the text states to the micrometre
_STATED = re.compile(r"(\w+): exact length (\S+) mm, area (\S+) mm²")
_LAYERS = {"CENTRES": 0.0, "INNER": -1.0, "OUTER": 1.0}


@record
class DrawnCurve:
    """A spline of the file, measured."""

    layer: str
    points: int  #: control points
    gap: float  #: between its ends [m]
    deviation: float  #: largest distance from the true curve [m]
    length: float  #: [m]
    area: float  #: inside [m^2]
    length_error: float  #: as a share of the true length [-]
    area_error: float  #: as a share of the true area [-]
    stated_error: float  #: of the length and area that the text states, the larger; nan where it states none [-]


def measured(path: Path, rho: PPoly, radius: float) -> tuple[list[DrawnCurve], int]:
    """Each spline of a file against the path and the roller radius [m]; and how many errors ezdxf's audit finds."""
    try:
        import ezdxf
        import ezdxf.units
    except ImportError:
        raise MissingExtra("reading a DXF file needs the extra cad: pip install 'mechsym[cad]'") from None
    document = ezdxf.readfile(path)
    if document.units != ezdxf.units.MM:
        raise BadInput(f"{path}: units are not millimetres")
    exact = stated([e.dxf.text for e in document.modelspace().query("TEXT")])
    rows = [_curve(e, rho, radius, exact) for e in document.modelspace().query("SPLINE")]
    return rows, len(document.audit().errors)


def stated(texts: list[str]) -> dict[str, tuple[float, float]]:
    """Length [m] and area [m^2] of the exact curve by layer, as the text states them."""
    lines = [_STATED.fullmatch(text) for text in texts]
    return {line[1]: (1e-3 * float(line[2]), 1e-6 * float(line[3])) for line in lines if line}


def _curve(entity: "Spline", rho: PPoly, radius: float, stated: dict[str, tuple[float, float]]) -> DrawnCurve:
    layer = entity.dxf.layer
    side, turned = _LAYERS[layer.removesuffix("_2")], math.pi if layer.endswith("_2") else 0.0
    tool = entity.construction_tool()
    knots = np.unique(entity.knots)
    x, w = np.polynomial.legendre.leggauss(max(8, _POINTS // len(knots)))  # in each piece of the spline
    half = np.diff(knots)[:, None] / 2
    places, weights = (knots[:-1, None] + half * (x + 1)).ravel(), (half * w).ravel()
    at = [tool.derivatives([t], 1) for t in places]
    rows = np.array([[(d.x, d.y) for d in next(iter(points))] for points in at]) * 1e-3
    z, dz = (rows[:, k, 0] + 1j * rows[:, k, 1] for k in (0, 1))
    z, dz = z * np.exp(-1j * turned), dz * np.exp(-1j * turned)
    ends = [complex(p.x, p.y) * 1e-3 for p in tool.points([0.0, tool.max_t])]
    length, area = np.sum(weights * np.abs(dz)), np.sum(weights * np.imag(np.conj(z) * dz)) / 2
    true_length, true_area = true_size(rho, side * radius)
    claimed = stated.get(layer.removesuffix("_2"), (math.nan, math.nan))
    return DrawnCurve(
        layer=layer, points=len(entity.control_points), gap=abs(ends[1] - ends[0]),
        deviation=float(np.max(np.abs(distance(z, rho) - side * radius))), length=float(length), area=float(area),
        length_error=abs(float(length) / true_length - 1), area_error=abs(float(area) / true_area - 1),
        stated_error=max(abs(claimed[0] / true_length - 1), abs(claimed[1] / true_area - 1)),
    )  # fmt: skip


def distance(z: np.ndarray, rho: PPoly) -> np.ndarray:
    """Signed distance of points to the path, positive outside [m]."""
    first, second = rho.derivative(), rho.derivative(2)
    theta = np.angle(z)
    for _ in range(30):
        r, dr, d2r, turn = rho(theta), first(theta), second(theta), np.exp(1j * theta)
        gap, along = z - r * turn, (dr + 1j * r) * turn
        bend = (d2r - r + 2j * dr) * turn
        slope = np.real(np.conj(along) * gap)
        theta = theta + slope / (np.abs(along) ** 2 - np.real(np.conj(bend) * gap))
    r, dr, turn = rho(theta), first(theta), np.exp(1j * theta)
    outward = -1j * (dr + 1j * r) * turn
    return np.real(np.conj(outward) * (z - r * turn)) / np.abs(outward)


def true_size(rho: PPoly, distance: float) -> tuple[float, float]:
    """Length [m] and area [m^2] of the parallel curve at a distance [m], by Gauss points in the pieces of the path."""
    turns = round(2 * math.pi / float(rho.x[-1]))
    edges = np.concatenate([rho.x[:-1] + k * rho.x[-1] for k in range(turns)] + [[2 * math.pi]])
    x, w = np.polynomial.legendre.leggauss(20)
    half = np.diff(edges)[:, None] / 2
    theta, weight = (edges[:-1, None] + half * (x + 1)).ravel(), (half * w).ravel()
    r, dr = rho(theta), rho.derivative()(theta)
    # Steiner: a parallel curve of a closed path that turns once is 2 pi d longer
    length, area = float(np.sum(weight * np.hypot(r, dr))), float(np.sum(weight * r**2) / 2)
    return length + 2 * math.pi * distance, area + length * distance + math.pi * distance**2


def main(arguments: list[str]) -> int:
    """Measure the file of the first argument against the guide of the case of the second."""
    path, name, *settings = arguments
    guide, rollers = guide_named(name, dict(text.split("=", 1) for text in settings))
    rows, errors = measured(Path(path), path_of(guide), rollers.radius)
    print(f"audit: {errors} errors")
    for row in rows:
        print(
            f"{row.layer}: {row.points} points, gap {row.gap:.2g} m, deviation {row.deviation:.3g} m, length error "
            f"{row.length_error:.2g}, area error {row.area_error:.2g}, as stated {row.stated_error:.2g}"
        )
    return int(errors > 0 or not all(row.stated_error <= _DIGITS for row in rows))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

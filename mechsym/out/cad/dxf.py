"""The guide as DXF: splines within a stated tolerance, layers, millimetres.

Layers: CENTRES (paths of the roller centres), INNER and OUTER (walls), HOLES (bore), ROLLERS, AXES, TEXT; the track of
the second roller has layers of its own with the ending _2.
"""

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from mechsym.errors import MissingExtra
from mechsym.files import write_text
from mechsym.out.cad.curve import Groove, nurbs, rotation
from mechsym.quantities.units import Metre

_MM = 1e3
_COLOURS = {"CENTRES": 5, "INNER": 1, "OUTER": 3, "HOLES": 6, "ROLLERS": 4, "AXES": 8, "TEXT": 7}


def text(track: Groove, bore: Metre, lines: Sequence[str]) -> str:
    """The text of a DXF file.

    bore: diameter of the hole for the shaft, 0 for none. lines: what the drawing says, case, spring, tolerance; below
    it stand length and area of the exact curves, by which whoever reads the file sees that nothing was lost on the way.
    """
    try:
        import ezdxf
        import ezdxf.units
    except ImportError:
        raise MissingExtra("a DXF file needs the extra cad: pip install 'mechsym[cad]'") from None
    ezdxf.options.write_fixed_meta_data_for_testing = True  # no time and no random identifier, from the first line on
    document = ezdxf.new("R2010", units=ezdxf.units.MM)
    space = document.modelspace()
    for name, colour in _COLOURS.items():
        document.layers.add(name, color=colour)
    curves = {"CENTRES": track.centre, "INNER": track.inner, "OUTER": track.outer}
    for number, angle in enumerate(track.turned):
        ending = "" if number == 0 else f"_{number + 1}"
        for layer, path in curves.items():
            points, knots = nurbs(path)
            flat, attributes = [(x, y, 0.0) for x, y in _MM * points @ rotation(angle)], {"layer": layer + ending}
            spline = space.add_open_spline(flat, degree=3, knots=[float(k) for k in knots], dxfattribs=attributes)
            spline.dxf.flags = 8  # planar, not closed: ends are clamped and meet
        start = _MM * track.centre.points[0] @ rotation(angle)
        space.add_circle(start, _MM * track.roller_radius, dxfattribs={"layer": "ROLLERS"})
    if bore:
        space.add_circle((0, 0), _MM * bore / 2, dxfattribs={"layer": "HOLES"})
    sizes = ((layer, _MM * c.length, _MM**2 * c.area) for layer, c in curves.items())
    exact = [f"{layer}: exact length {length:.3f} mm, area {area:.3f} mm²" for layer, length, area in sizes]
    reach = 1.1 * _MM * float(np.max(np.hypot(*track.outer.points.T)))
    for ends in (((-reach, 0), (reach, 0)), ((0, -reach), (0, reach))):
        space.add_line(*ends, dxfattribs={"layer": "AXES"})
    height = reach / 40
    for row, line in enumerate([*lines, *exact]):
        place = (-reach, -reach - 1.6 * height * (row + 1))
        space.add_text(line, height=height, dxfattribs={"layer": "TEXT"}).set_placement(place)
    # classes are listed by name: ezdxf takes them from a set in any order
    for name in sorted(document.entitydb.dxf_types_in_use()):
        document.classes.add_class(name)
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue()


def write(track: Groove, path: Path, bore: float, lines: Sequence[str]) -> Path:
    """Write a guide as DXF, with a bore of that diameter [m]."""
    return write_text(path, text(track, bore, lines))

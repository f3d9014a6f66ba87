"""Bodies as STEP: the disc with its grooves, rollers, turned parts and plates; millimetres, by the kernel OCP.

The walls of a groove are the curves of the DXF, so they keep its tolerance; each wall is one face.
"""

import math
import re
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mechsym.errors import BadInput, MissingExtra
from mechsym.files import write_text
from mechsym.hinge.rollers import RollerParameters
from mechsym.out.cad.curve import CubicPath, Groove, nurbs, rotation
from mechsym.out.cad.solids import AXES, Body, Circle, Plate, Point, Turned, tangents, tube
from mechsym.quantities import record
from mechsym.quantities.units import Metre

if TYPE_CHECKING:
    from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Shape, TopoDS_Wire

_MM = 1e3
_TIME = re.compile(r"'\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d'")


@record
class Disc:
    """The disc of a guide; its tracks are cut from both faces where there are two."""

    name: str
    track: Groove
    radius: float  #: of the disc [m]
    bore: float  #: diameter of the hole, 0 for none [m]
    thickness: float  #: [m]
    depth: float  #: of a groove [m]


def guide_bodies(
    track: Groove, count: int, bore: Metre, rollers: RollerParameters, thickness: Metre | None = None
) -> tuple[Disc | Turned, ...]:
    """The disc and its rollers where the crank stands at dead centre; a groove is as deep as a roller is wide.

    count: rollers, which share the tracks; two on one track stand opposite each other. bore: diameter of the hole for
    the shaft. thickness: of the disc; by default the planes of its tracks stand as `rollers.plane_offset` says, or a
    roller's width of the disc is left between two grooves.
    """
    tracks, width = len(track.turned), rollers.width
    usual = rollers.plane_offset + width if tracks > 1 and rollers.plane_offset > width else (tracks + 1) * width
    thickness = usual if thickness is None else thickness
    if thickness <= tracks * width:
        way = f"grooves of {tracks} x {1e3 * width:g} mm must leave something of the disc"
        raise BadInput(f"--thickness = {1e3 * thickness:g} mm is not allowed; {way}")
    # a whole millimetre, so that the tolerance of the curves does not show in it
    radius = math.ceil(_MM * (float(np.max(np.hypot(*track.outer.points.T))) + rollers.radius)) / _MM
    disc = Disc(name="guide", track=track, radius=radius, bore=bore, thickness=thickness, depth=width)
    rollers_made = []
    for number in range(count):
        angle = track.turned[number] if tracks == count else 2 * math.pi * number / count
        x, y = (float(v) for v in track.centre.points[0] @ rotation(angle))
        ends = (0.0, width) if tracks > 1 and number > 0 else (thickness - width, thickness)
        rollers_made.append(tube(f"roller {number + 1}", (0.0, track.roller_radius), ends, (x, y, 0.0), "z"))
    return disc, *rollers_made


def write(path: Path, bodies: Sequence[Disc | Body]) -> Path:
    """Write bodies as one assembly, each under its name."""
    return write_text(path, text({body.name: shape(body) for body in bodies}))


def text(shapes: "Mapping[str, TopoDS_Shape]") -> str:
    """The text of a STEP file: no time in it, so the same bodies give the same text."""
    kernel()
    from OCP.Interface import Interface_Static
    from OCP.STEPCAFControl import STEPCAFControl_Writer
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDataStd import TDataStd_Name
    from OCP.TDocStd import TDocStd_Document
    from OCP.XCAFDoc import XCAFDoc_DocumentTool

    document = TDocStd_Document(TCollection_ExtendedString("mechsym"))
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    for name, solid in shapes.items():
        TDataStd_Name.Set_s(tool.AddShape(solid, False), TCollection_ExtendedString(name))
    writer = STEPCAFControl_Writer()
    Interface_Static.SetCVal_s("write.step.unit", "MM")
    writer.Transfer(document)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "bodies.step"
        writer.Write(str(file))
        written = file.read_text(encoding="utf-8")
    return _TIME.sub("'2000-01-01T00:00:00'", written).replace(str(file), "mechsym")


def shape(body: Disc | Body) -> "TopoDS_Shape":
    """A body as a shape of the kernel, in millimetres."""
    kernel()
    match body:
        case Disc():
            return _disc(body)
        case Turned():
            return _turned(body)
        case Plate():
            rings = [_hull(body.ends, body.low), *(_ring(hole, body.low) for hole in body.holes)]
            return _prism(_face(rings), (0.0, body.high - body.low, 0.0))


def _disc(disc: Disc) -> "TopoDS_Shape":
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut

    hole = disc.bore / 2
    solid = _turned(tube(disc.name, (hole, disc.radius), (0.0, disc.thickness), (0.0, 0.0, 0.0), "z"))
    for number, angle in enumerate(disc.track.turned):
        # the tool stands out of the face, so that no two faces lie in one plane
        low = disc.thickness - disc.depth if number == 0 else -disc.depth
        face = _face([_closed(path, angle, low) for path in (disc.track.outer, disc.track.inner)])
        cut = BRepAlgoAPI_Cut(solid, _prism(face, (0.0, 0.0, 2 * disc.depth)))
        if not cut.IsDone():
            raise BadInput("the groove could not be cut from the disc; give another --tolerance")
        solid = cut.Shape()
    return solid


def _closed(path: CubicPath, angle: float, z: float) -> "TopoDS_Wire":
    """A closed wire of one edge: the very curve of the DXF, at a height [m]."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
    from OCP.collections import Array1_double, Array1_gp_Pnt, Array1_int
    from OCP.Geom import Geom_BSplineCurve

    points, knots = nurbs(path)
    places, counts = np.unique(knots, return_counts=True)
    poles, at, times = Array1_gp_Pnt(1, len(points)), Array1_double(1, len(places)), Array1_int(1, len(places))
    for i, (x, y) in enumerate(points @ rotation(angle), 1):
        poles.SetValue(i, _point((x, y, z)))
    for i, (knot, count) in enumerate(zip(places, counts, strict=True), 1):
        at.SetValue(i, float(knot))
        times.SetValue(i, int(count))
    return _wire([BRepBuilderAPI_MakeEdge(Geom_BSplineCurve(poles, at, times, 3)).Edge()])


def _turned(body: Turned) -> "TopoDS_Shape":
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakePolygon
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeRevol
    from OCP.gp import gp_Ax1, gp_Dir

    along = np.array(AXES[body.axis])
    across = np.array(AXES["y" if body.axis == "x" else "x"])
    polygon = BRepBuilderAPI_MakePolygon()
    for r, z in body.profile:
        polygon.Add(_point(tuple(np.array(body.place) + r * across + z * along)))
    polygon.Close()
    axis = gp_Ax1(_point(body.place), gp_Dir(*AXES[body.axis]))
    return BRepPrimAPI_MakeRevol(_face([polygon.Wire()]), axis).Shape()


def _hull(ends: tuple[Circle, Circle], y: float) -> "TopoDS_Wire":
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
    from OCP.GC import GC_MakeArcOfCircle

    a, b, c, d = (_point((x, y, z)) for x, z in tangents(*ends))
    (x, z, p), (u, w, q) = ends
    away = np.array([x - u, z - w]) / np.hypot(x - u, z - w)
    near, far = (_point((x + p * away[0], y, z + p * away[1])), _point((u - q * away[0], y, w - q * away[1])))
    parts = (a, b), (b, far, c), (c, d), (d, near, a)
    curves = [p if len(p) == 2 else (GC_MakeArcOfCircle(*p).Value(),) for p in parts]
    return _wire([BRepBuilderAPI_MakeEdge(*curve).Edge() for curve in curves])


def _ring(circle: Circle, y: float) -> "TopoDS_Wire":
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
    from OCP.gp import gp_Ax2, gp_Circ, gp_Dir

    x, z, radius = circle
    return _wire([BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(_point((x, y, z)), gp_Dir(0, 1, 0)), _MM * radius)).Edge()])


def _wire(edges: "Sequence[TopoDS_Edge]") -> "TopoDS_Wire":
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeWire

    wire = BRepBuilderAPI_MakeWire()
    for edge in edges:
        wire.Add(edge)
    return wire.Wire()


def _face(wires: "Sequence[TopoDS_Wire]") -> "TopoDS_Face":
    """A plane face inside its first wire and outside of the others."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
    from OCP.ShapeFix import ShapeFix_Face

    face = BRepBuilderAPI_MakeFace(wires[0], True)
    for wire in wires[1:]:
        face.Add(wire)
    mended = ShapeFix_Face(face.Face())
    mended.FixOrientation()
    return mended.Face()


def _prism(face: "TopoDS_Face", way: Point) -> "TopoDS_Shape":
    from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
    from OCP.gp import gp_Vec

    return BRepPrimAPI_MakePrism(face, gp_Vec(*(_MM * w for w in way))).Shape()


def _point(place: Sequence[float]) -> object:
    from OCP.gp import gp_Pnt

    return gp_Pnt(*(_MM * float(v) for v in place))


def kernel() -> None:
    """Load the kernel, quiet; without it the extra is named."""
    try:
        import OCP.gp  # noqa: F401
    except ImportError:
        raise MissingExtra("a STEP file needs the extra step: pip install 'mechsym[step]'") from None
    from OCP.Message import Message, Message_Gravity

    for printer in Message.DefaultMessenger_s().Printers():
        printer.SetTraceLevel(Message_Gravity.Message_Fail)

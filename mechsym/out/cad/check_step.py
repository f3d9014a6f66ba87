"""A STEP file of a guide read again and measured: `python -m mechsym.out.cad.check_step FILE CASE`.

Volumes come from the kernel's own adaptive integration, walls from points on its surfaces; nothing from the writer.
"""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mechsym.errors import BadInput
from mechsym.hinge.guide import path as centre_path
from mechsym.jobs.export import guide_named
from mechsym.out.cad.check import distance
from mechsym.out.cad.curve import tracks_of
from mechsym.out.cad.step import kernel
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import record
from mechsym.quantities.units import Metre, Radian

if TYPE_CHECKING:
    from OCP import TDocStd
    from OCP.TopoDS import TopoDS_Shape

_POINTS = 4000  # along each wall
_MM = 1e-3
_EPS = 1e-11  # asked of the kernel's volumes


@record
class StepBody:
    """A solid of a STEP file, measured."""

    name: str
    valid: bool
    volume: float  #: [m^3]
    low: tuple[float, float, float]  #: corner of its box [m]
    high: tuple[float, float, float]  #: the other corner [m]
    shape: "TopoDS_Shape"


def read(path: Path) -> list[StepBody]:
    """The solids of a file under their names, in its order."""
    kernel()
    from OCP.IFSelect import IFSelect_ReturnStatus
    from OCP.STEPCAFControl import STEPCAFControl_Reader
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDocStd import TDocStd_Document

    document = TDocStd_Document(TCollection_ExtendedString("read"))
    reader = STEPCAFControl_Reader()
    if reader.ReadFile(str(path)) != IFSelect_ReturnStatus.IFSelect_RetDone or not reader.Transfer(document):
        raise BadInput(f"{path}: not a STEP file that can be read")
    return [_measured(name, shape) for name, shape in _named(document)]


def _named(document: "TDocStd.TDocStd_Document") -> "Iterator[tuple[str, TopoDS_Shape]]":
    from OCP.collections import Sequence_TDF_Label
    from OCP.TDataStd import TDataStd_Name
    from OCP.XCAFDoc import XCAFDoc_DocumentTool

    tool, labels = XCAFDoc_DocumentTool.ShapeTool_s(document.Main()), Sequence_TDF_Label()
    tool.GetFreeShapes(labels)
    for i in range(1, labels.Length() + 1):
        label, name = labels.Value(i), TDataStd_Name()
        attribute = label.FindAttribute(TDataStd_Name.GetID_s(), name)
        yield name.Get().ToExtString() if attribute else "", tool.GetShape_s(label)


def _measured(name: str, shape: object) -> StepBody:
    from OCP.Bnd import Bnd_Box
    from OCP.BRepBndLib import BRepBndLib
    from OCP.BRepCheck import BRepCheck_Analyzer
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    inside, box = GProp_GProps(), Bnd_Box()
    BRepGProp.VolumePropertiesGK_s(shape, inside, _EPS)
    BRepBndLib.AddOptimal_s(shape, box, False, False)
    low, high = box.CornerMin(), box.CornerMax()
    corners = [(_MM * corner.X(), _MM * corner.Y(), _MM * corner.Z()) for corner in (low, high)]
    valid, volume = BRepCheck_Analyzer(shape).IsValid(), _MM**3 * inside.Mass()
    return StepBody(name=name, valid=valid, volume=volume, low=corners[0], high=corners[1], shape=shape)


def wall_deviation(body: StepBody, rho: PPoly, radius: Metre, turned: tuple[Radian, ...]) -> tuple[int, float]:
    """How many walls of grooves the disc has, and their largest distance from the true ones [m].

    radius: of the rollers; turned: angles of the tracks, that in the upper face first.
    """
    errors, middle = [], (body.low[2] + body.high[2]) / 2
    for points, height in _walls(body.shape):
        z = (points[:, 0] + 1j * points[:, 1]) * np.exp(-1j * turned[0 if height > middle else -1])
        away = distance(z, rho)
        errors.append(float(np.max(np.abs(away - np.sign(away[0]) * radius))))
    return len(errors), max(errors, default=float("inf"))


def _walls(shape: object) -> Iterator[tuple[np.ndarray, float]]:
    """Points along each extruded curve of a solid, shape (n, 2), and the height of its middle [m]."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.GeomAbs import GeomAbs_SurfaceType
    from OCP.TopAbs import TopAbs_ShapeEnum
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopoDS import TopoDS

    faces = TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_FACE)
    while faces.More():
        surface = BRepAdaptor_Surface(TopoDS.Face(faces.Current()))
        if surface.GetType() == GeomAbs_SurfaceType.GeomAbs_SurfaceOfExtrusion:
            middle = (surface.FirstVParameter() + surface.LastVParameter()) / 2
            along = np.linspace(surface.FirstUParameter(), surface.LastUParameter(), _POINTS)
            points = [surface.Value(float(u), middle) for u in along]
            yield _MM * np.array([(p.X(), p.Y()) for p in points]), _MM * points[0].Z()
        faces.Next()


def main(arguments: list[str]) -> int:
    """Measure the file of the first argument against the guide of the case of the second."""
    path, name, *settings = arguments
    guide, rollers = guide_named(name, dict(text.split("=", 1) for text in settings))
    bodies = read(Path(path))
    for body in bodies:
        box = " x ".join(f"{1e3 * (high - low):.6g}" for low, high in zip(body.low, body.high, strict=True))
        print(f"{body.name}: {'valid' if body.valid else 'NOT valid'}, {body.volume:.10g} m^3, {box} mm")
    walls, deviation = wall_deviation(bodies[0], centre_path(guide), rollers.radius, tracks_of(guide))
    print(f"{walls} walls, at most {1e6 * deviation:.3g} um from exact")
    return int(not all(body.valid for body in bodies))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""`mechsym guide`: the guide of a case as DXF, as STEP and as a dimensioned sheet."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mechsym.cli.common import case_of, emit, json_option, pairs, set_option, tried
from mechsym.errors import BadInput
from mechsym.quantities import RPM, parse

if TYPE_CHECKING:
    from mechsym.jobs.hinge import Workshop
    from mechsym.out.cad.curve import Groove
    from mechsym.out.cad.solids import Turned
    from mechsym.out.cad.step import Disc

_FILE = click.Path(path_type=Path, dir_okay=False)


@click.command(short_help="Draw the guide for the workshop: DXF, STEP, sheet.")
@click.argument("case")
@click.option("--dxf", type=_FILE, callback=tried, help="DXF file to write (extra cad).")
@click.option("--step", type=_FILE, callback=tried, help="STEP file to write: disc and rollers (extra step).")
@click.option("--sheet", type=_FILE, callback=tried, help="Dimensioned sheet to write, .svg or .pdf.")
@click.option("--tolerance", default="1 um", help="Largest distance of the curves from the exact ones.")
@click.option("--bore", default="60 mm", help="Diameter of the hole for the shaft, 0 for none.")
@click.option("--thickness", metavar="LENGTH", help="Of the disc; a roller's width more than its grooves by default.")
@click.option("--diagram", type=click.Path(), help="CSV file of a measured diagram in place of the cycle.")
@set_option
@json_option
def guide(
    case: str,
    dxf: Path | None,
    step: Path | None,
    sheet: Path | None,
    tolerance: str,
    bore: str,
    thickness: str | None,
    diagram: str | None,
    overrides: tuple[str, ...],
    as_json: bool,
) -> None:
    """Draw the guide of CASE: centre path and walls with exact tangents, roller, bore, axes; millimetres.

    The walls stand at the roller radius from the path; a wall that would cross itself is refused with its angle. The
    sheet has angle and radius in a table, what errors of spring and track cost, loads and roller life. The bodies are
    the disc with a groove for each track, cut from both faces where there are two, and its rollers.

    \b
    Example: mechsym guide zotov-89 --dxf guide.dxf --sheet guide.pdf --tolerance "0.1 um"
             mechsym guide zotov-89 --step guide.step --bore "80 mm" --thickness "250 mm"
    """
    from mechsym.jobs.hinge import workshop
    from mechsym.out.cad import track
    from mechsym.out.cad.curve import GrooveChecks, GrooveDrawings

    if dxf is None and sheet is None and step is None:
        raise BadInput("nothing to write: give --dxf FILE, --step FILE or --sheet FILE, or several")
    hole = parse(bore, "m", "--bore")
    shop = workshop(case_of(case, pairs(overrides)), diagram)
    curves = track(shop.guide, shop.rollers, parse(tolerance, "m", "--tolerance"), shop.kinks)
    _refuse_bore(hole, curves)
    bodies = _bodies(step, shop, curves, hole, thickness)
    written = [*_dxf(dxf, shop, curves, hole), *_step(step, bodies), *_sheet(sheet, shop, curves, hole)]
    paths = (curves.centre, curves.inner, curves.outer)
    numbers: dict[str, Any] = {f"deviation_{path.name}": path.deviation for path in paths}
    numbers |= {f"points_{path.name}": len(path.theta) for path in paths}
    checks = GrooveChecks(feasible=shop.verdict.feasible, tolerance=curves.tolerance, **numbers)
    lines = [
        *(f"{path.name}: {len(path.theta)} points, {1e6 * path.deviation:.3g} um from exact" for path in paths),
        f"limits: {shop.verdict.reason}",
    ]
    emit(GrooveDrawings(written=written, checks=checks), as_json, lambda: "\n".join(lines), files=written)


def _refuse_bore(hole: float, curves: "Groove") -> None:
    import numpy as np

    nearest = float(np.min(np.hypot(*curves.inner.points.T)))
    if hole < 0 or hole / 2 >= nearest:
        raise BadInput(f"--bore = {1e3 * hole:g} mm is not allowed; the track leaves a hole of {2e3 * nearest:.4g} mm")


def _dxf(path: Path | None, shop: "Workshop", curves: "Groove", hole: float) -> list[str]:
    from mechsym.out.cad.dxf import write
    from mechsym.out.cad.sheet import plain, spring_text

    lines = [
        f"guide of {shop.name}, {shop.guide.omega / RPM:.5g} rpm, mm",
        f"spring {plain(spring_text(shop.guide.spring))}",
        f"within {1e6 * curves.tolerance:.3g} um of the exact curves; roller {2e3 * curves.roller_radius:.6g} mm",
    ]
    return [] if path is None else [str(write(curves, path, hole, lines))]


def _bodies(
    path: Path | None, shop: "Workshop", curves: "Groove", hole: float, thickness: str | None
) -> "tuple[Disc | Turned, ...]":
    from mechsym.out.cad.step import guide_bodies

    if path is None:
        return ()
    deep = None if thickness is None else parse(thickness, "m", "--thickness")
    return guide_bodies(curves, shop.guide.rollers, hole, shop.rollers, deep)


def _step(path: Path | None, bodies: "tuple[Disc | Turned, ...]") -> list[str]:
    from mechsym.out.cad.step import write

    return [] if path is None else [str(write(path, bodies))]


def _sheet(path: Path | None, shop: "Workshop", curves: "Groove", hole: float) -> list[str]:
    from mechsym.out.cad.sheet import write

    return [] if path is None else [str(write(shop, curves, path, hole))]

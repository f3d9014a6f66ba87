"""`mechsym guide`: the guide of a case as DXF, as STEP and as a dimensioned sheet."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mechsym.cases import Case
from mechsym.cli.common import case_command, diagram_option, emit, ending, refuse_idle
from mechsym.errors import BadInput
from mechsym.quantities import RPM, parse

if TYPE_CHECKING:
    from mechsym.out.cad.solids import Turned
    from mechsym.out.cad.step import Disc

_FILE = click.Path(path_type=Path, dir_okay=False)


@case_command("Draw the guide for the workshop: DXF, STEP, sheet.")
@click.option("--dxf", type=_FILE, callback=ending(".dxf"), help="DXF file to write (extra cad).")
@click.option(
    "--step", type=_FILE, callback=ending(".step", ".stp"), help="STEP file to write: disc and rollers (extra step)."
)
@click.option("--sheet", type=_FILE, callback=ending(".svg", ".pdf"), help="Dimensioned sheet to write, .svg or .pdf.")
@click.option("--tolerance", default="1 um", help="Largest distance of the curves from the exact ones.")
@click.option("--bore", default="60 mm", help="Diameter of the hole for the shaft, 0 for none.")
@click.option("--thickness", metavar="LENGTH", help="Of the disc; a roller's width more than its grooves by default.")
@diagram_option
def guide(
    case: Case, dxf: Path | None, step: Path | None, sheet: Path | None, tolerance: str, bore: str,
    thickness: str | None, diagram: str | None,
) -> None:  # fmt: skip
    """Draw the guide of CASE: centre path and walls with exact tangents, roller, bore, axes; millimetres.

    The walls stand at the roller radius from the path; a wall that would cross itself is refused with its angle. The
    sheet has angle and radius in a table, what errors of spring and track cost, loads and roller life. The bodies are
    the disc with a groove for each track, cut from both faces where there are two, and its rollers.

    \b
    Example: mechsym guide zotov-89 --dxf guide.dxf --sheet guide.pdf --tolerance "0.1 um"
             mechsym guide zotov-89 --step guide.step --bore "80 mm" --thickness "250 mm"
    """
    import numpy as np

    from mechsym.jobs.hinge import workshop
    from mechsym.out.cad import track
    from mechsym.out.cad.curve import GrooveChecks, GrooveDrawings

    if dxf is None and sheet is None and step is None:
        raise BadInput("nothing to write: give --dxf FILE, --step FILE or --sheet FILE, or several")
    if step is None:
        refuse_idle("without --step", "thickness")
    hole = parse(bore, "m", "--bore")
    shop = workshop(case, diagram)
    curves = track(shop.guide, shop.rollers, parse(tolerance, "m", "--tolerance"), shop.kinks)
    nearest = float(np.min(np.hypot(*curves.inner.points.T)))
    if hole < 0 or hole / 2 >= nearest:
        raise BadInput(f"--bore = {1e3 * hole:g} mm is not allowed; the track leaves a hole of {2e3 * nearest:.4g} mm")
    bodies: tuple[Disc | Turned, ...] = ()
    if step is not None:
        from mechsym.out.cad.step import guide_bodies

        deep = None if thickness is None else parse(thickness, "m", "--thickness")
        bodies = guide_bodies(curves, shop.guide.rollers, hole, shop.rollers, deep)
    written = []
    if dxf is not None:
        from mechsym.out.cad.dxf import write
        from mechsym.out.cad.sheet import plain, spring_text

        head = [
            f"guide of {shop.name}, {shop.guide.omega / RPM:.5g} rpm, mm",
            f"spring {plain(spring_text(shop.guide.spring))}",
            f"within {1e6 * curves.tolerance:.3g} um of the exact curves; roller {2e3 * curves.roller_radius:.6g} mm",
        ]
        written.append(str(write(curves, dxf, hole, head)))
    if step is not None:
        from mechsym.out.cad.step import write as write_step

        written.append(str(write_step(step, bodies)))
    if sheet is not None:
        from mechsym.out.cad.sheet import write as write_sheet

        written.append(str(write_sheet(shop, curves, sheet, hole)))
    paths = (curves.centre, curves.inner, curves.outer)
    numbers: dict[str, Any] = {f"deviation_{path.name}": path.deviation for path in paths}
    numbers |= {f"points_{path.name}": len(path.theta) for path in paths}
    checks = GrooveChecks(feasible=shop.verdict.feasible, tolerance=curves.tolerance, **numbers)
    lines = [
        *(f"{path.name}: {len(path.theta)} points, {1e6 * path.deviation:.3g} um from exact" for path in paths),
        f"limits: {shop.verdict.reason}",
    ]
    emit(GrooveDrawings(written=written, checks=checks), lambda: "\n".join(lines), files=written)

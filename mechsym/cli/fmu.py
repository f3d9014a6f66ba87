"""`mechsym fmu`: the machine of a case as a functional mock-up unit."""

from pathlib import Path
from typing import Any

import click

from mechsym.cli.common import case_of, emit, file_option, json_option, pairs, set_option
from mechsym.errors import BadInput


@click.command(short_help="Write a functional mock-up unit (FMI 2.0 or 3.0).")
@click.argument("case")
@click.option("--fmi", "version", type=click.Choice(["2", "3"]), default="2", help="Version of the standard.")
@click.option(
    "--part", type=click.Choice(["machine", "controller"]), default="machine",
    help="The machine, or the controller that sets its spring.",
)  # fmt: skip
@click.option("--platforms", default="linux64", metavar="NAMES", help="Binaries for linux64, win64; or none.")
@click.option("--diagram", type=click.Path(), help="CSV file of a measured diagram in place of the cycle.")
@click.option("--compare", "compared", is_flag=True, help="Run it and compare with the simulation (extra fmu).")
@file_option("CASE.fmu by default.")
@set_option
@json_option
@click.pass_context
def fmu(
    ctx: click.Context,
    case: str,
    version: str,
    part: str,
    platforms: str,
    diagram: str | None,
    compared: bool,
    out: Path | None,
    overrides: tuple[str, ...],
    as_json: bool,
) -> None:
    """Write the machine of CASE as an FMU for model exchange and co-simulation, sources inside.

    Parameters of mechanism, spring and load are tunable; an input adds to what acts on an input of the mechanism.
    Kinks of the gas force are event indicators, a torque that is switched on is a time event, a stall ends the run.
    The controller is a unit of its own for co-simulation: from crank angle and speed it sets the pressure once in a
    period. Without a compiler for a platform the FMU has the sources only. Exit status 1 when --compare finds more
    than 1e-9.

    \b
    Example: mechsym fmu zotov-89 --fmi 3 --out engine.fmu --compare
             mechsym fmu zotov-89 --part controller --out controller.fmu
             mechsym fmu generator --diagram half-load.csv --platforms linux64,win64
    """
    from mechsym.jobs.export import controlled, ready
    from mechsym.out.fmi import controller, write
    from mechsym.out.fmi import fmu as make
    from mechsym.out.laws import block_of

    found = case_of(case, pairs(overrides))
    wanted = [] if platforms == "none" else platforms.split(",")
    if part == "controller":
        if compared:
            raise BadInput("--compare is for the machine; a controller has no run of its own")
        block, code = controller(found.name, *controlled(found, diagram))
        unit, problem = make(block, int(version), wanted, code), None
    else:
        run = ready(found, diagram)
        unit, problem = make(block_of(found.name, found.about, run), int(version), wanted), run.problem
    path = write(unit, out or Path(f"{unit.name}.fmu"))
    differences = _differences(path, problem) if compared else {}
    checks: dict[str, Any] = {"token": unit.token, "binaries": unit.binaries, "missing": unit.missing, **differences}
    emit({"written": [str(path)], "checks": checks}, as_json, lambda: _text(path, checks))
    ctx.exit(0 if all(v <= 1e-9 for v in differences.values()) else 1)


def _differences(path: Path, problem: Any) -> dict[str, float]:
    from mechsym.out.fmi.compare import compare

    return {f"difference_{d.kind}": d.largest for d in compare(path, problem)}


def _text(path: Path, checks: dict[str, Any]) -> str:
    lines = [f"wrote {path}", *(f"inside: {name}" for name in checks["binaries"])]
    lines += [f"no binary for {name}: {why}" for name, why in checks["missing"].items()]
    return "\n".join(lines + [f"{k}: {v:.2g}" for k, v in checks.items() if k.startswith("difference")])

"""`mechsym fmu`: the machine of a case as a functional mock-up unit."""

from pathlib import Path

import click

from mechsym.cli.common import budget_option, case_of, emit, file_in, file_option, json_option, pairs, set_option
from mechsym.errors import BadInput
from mechsym.quantities.display import ratio_text

_WAYS = {"me": "model exchange", "cs": "co-simulation"}


@click.command(short_help="Write a functional mock-up unit (FMI 2.0 or 3.0).")
@click.argument("case")
@click.option("--fmi", "version", type=click.Choice(["2", "3"]), default="2", help="Version of the standard.")
@click.option(
    "--part", type=click.Choice(["machine", "controller"]), default="machine",
    help="The machine, or the controller that sets its spring.",
)  # fmt: skip
@click.option(
    "--platforms", metavar="NAMES", help="Binaries for linux64, win64, or none; all for which there is a compiler."
)
@click.option("--diagram", type=click.Path(), help="CSV file of a measured diagram in place of the cycle.")
@click.option("--compare", "compared", is_flag=True, help="Run it and compare with the simulation (extra fmu).")
@file_option("CASE.fmu", ".fmu")
@set_option
@budget_option
@json_option
@click.pass_context
def fmu(
    ctx: click.Context,
    case: str,
    version: str,
    part: str,
    platforms: str | None,
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
    period. It runs on Linux and, with the extra web, on Windows; a platform without a compiler compiles the sources.
    Exit status 1 when --compare finds more than 1e-9, or 1e-6 where two motions of a linkage meet on the way.

    \b
    Example: mechsym fmu zotov-89 --fmi 3 --out engine.fmu --compare
             mechsym fmu zotov-89 --part controller --out controller.fmu
             mechsym fmu generator --diagram half-load.csv --platforms linux64
    """
    from mechsym.jobs.export import controlled, ready
    from mechsym.out.fmi import controller, write
    from mechsym.out.fmi import fmu as make
    from mechsym.out.fmi.build import PLATFORMS, SYSTEMS, UnitChecks, UnitFile
    from mechsym.out.laws import block_of

    if ctx.meta.get("mechsym.units"):
        raise BadInput("--units: an FMU is in SI, as FMI has it, and tells its units itself; leave it away")
    found = case_of(case, pairs(overrides))
    wanted = PLATFORMS if platforms is None else () if platforms == "none" else tuple(platforms.split(","))
    if part == "controller":
        if compared:
            raise BadInput("--compare is for the machine; a controller has no run of its own")
        block, code = controller(found.name, *controlled(found, diagram))
        unit, problem = make(block, int(version), wanted, code), None
    else:
        run = ready(found, diagram)
        unit, problem = make(block_of(found.name, found.about, run), int(version), wanted), run.problem
    if compared and "linux64" not in unit.platforms:
        why = unit.missing.get("linux64", "--platforms leaves it out")
        raise BadInput(f"--compare runs the binary for {SYSTEMS['linux64']}, which is missing: {why}; leave it out")
    path = write(unit, file_in(out, f"{unit.name}.fmu", ".fmu"))
    differences, apart = dict[str, float](), False
    if compared:
        from mechsym.files import publish
        from mechsym.out.fmi.compare import compare

        publish()  # it is run from where it lies
        both = compare(path, problem)
        differences, apart = {d.kind: d.largest for d in both}, any(d.largest > d.allowed for d in both)
    checks = UnitChecks(
        token=unit.token,
        binaries=unit.binaries,
        missing=unit.missing,
        **{f"difference_{kind}": d for kind, d in differences.items()},
    )
    lines = [f"binary inside for {SYSTEMS[name]}" for name in unit.platforms]
    lines += [f"no binary for {SYSTEMS[name]}: {why}" for name, why in unit.missing.items()]
    lines += ["no binary inside: a tool that imports it compiles its sources"] if not unit.platforms else []
    lines += [f"{_WAYS[kind]} differs from the simulation by {ratio_text(d, 2)}" for kind, d in differences.items()]
    emit(UnitFile(written=[str(path)], checks=checks), as_json, lambda: "\n".join(lines), files=[path])
    ctx.exit(int(apart))

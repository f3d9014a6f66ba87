"""`mechsym export`: a mechanism or the machine of a case as text for other programs."""

import sys
from pathlib import Path

import click

from mechsym import cases
from mechsym.cases import Case
from mechsym.cli import common
from mechsym.cli.common import case_of, emit, file_in, listed, pairs, refuse_idle
from mechsym.errors import BadInput
from mechsym.files import make_folder, together, write_text
from mechsym.files.inputs import reads
from mechsym.quantities.display import residual_text


@click.command(short_help="Write C, Modelica, Julia, MATLAB or JAX.")
@click.argument("name")
@click.option("--to", "languages", required=True, metavar="NAMES", help="c, modelica, julia, matlab, jax; or several.")
@common.diagram_option
@common.set_option
@common.out_option
@common.json_option
def export(name: str, languages: str, diagram: str | None, overrides: tuple[str, ...], out: Path | None) -> None:
    """Write NAME, a mechanism or a case, as text: all languages from the one program that mechsym itself compiles.

    A mechanism gives its functions with parameters as arguments; a case gives a machine with its curves, numbers and
    starts. The C of a machine also integrates it, with events and without allocation.

    \b
    Example: mechsym export zotov-89 --to c,modelica --out engine
             mechsym export hypocycloid --to julia
    """
    from mechsym.jobs.export import ready
    from mechsym.mechanisms import names, own
    from mechsym.out.block import block_of
    from mechsym.out.text.dialects import of_block, of_mechanism
    from mechsym.out.text.files import files

    folder = make_folder(out or Path("."))
    with reads(), together(folder):  # what is read is not written over, in the working folder neither
        if own.is_file(name) or (name in names() and name not in cases.names()):
            refuse_idle(f"for {name}, which is a mechanism: it is written with letters", "diagram", "overrides")
            written = of_mechanism(name)
        else:
            case = case_of(name, pairs(overrides))
            written = of_block(block_of(case.name, case.about, ready(case, diagram)))
        texts = [files(written, word) for word in listed(languages, "--to")]
        paths = [str(write_text(folder / file, text)) for made in texts for file, text in made.items()]
    emit({"written": paths, "checks": {}}, lambda: "", files=paths)


@common.case_command("Write a page that simulates, without a server.", common.file_option("CASE.html", ".html"))
@common.diagram_option
@common.budget_option
def page(case: Case, out: Path | None, diagram: str | None) -> None:
    """Write the machine of CASE as one HTML file with sliders, which simulates in the browser and asks nobody.

    The equations are the C of `mechsym fmu`, compiled to WebAssembly (extra web); the numbers are those of
    `mechsym simulate`.

    \b
    Example: mechsym page zotov-89 --out engine.html
    """
    from mechsym.jobs.export import ready, turning
    from mechsym.out.block import block_of
    from mechsym.out.web import page as make
    from mechsym.out.web.build import PageChecks, WrittenPage

    run = ready(case, diagram, "page")
    text = make(block_of(case.name, case.about, run), turning(case, run.guide))
    path = write_text(file_in(out, f"{case.name}.html", ".html"), text)
    answer = WrittenPage(written=[str(path)], checks=PageChecks(bytes=len(text.encode())))
    emit(answer, lambda: "", files=[path])


_WAYS = {"me": "model exchange", "cs": "co-simulation"}


@common.case_command("Write a functional mock-up unit (FMI 2.0 or 3.0).", common.file_option("CASE.fmu", ".fmu"))
@click.option("--fmi", "version", type=click.Choice(["2", "3"]), default="2", help="Version of the standard.")
@click.option(
    "--part", type=click.Choice(["machine", "controller"]), default="machine",
    help="The machine, or the controller that sets its spring.",
)  # fmt: skip
@click.option(
    "--platforms", metavar="NAMES", help="Binaries for linux64, win64, or none; all for which there is a compiler."
)
@common.diagram_option
@click.option("--compare", "compared", is_flag=True, help="Run it and compare with the simulation (extra fmu).")
@common.budget_option
def fmu(
    case: Case, version: str, part: str, platforms: str | None, diagram: str | None, compared: bool, out: Path | None
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
    from mechsym.out.block import block_of
    from mechsym.out.fmi import controller, write
    from mechsym.out.fmi import fmu as make
    from mechsym.out.fmi.build import PLATFORMS, SYSTEMS, UnitChecks, UnitFile

    if click.get_current_context().meta.get("mechsym.units"):
        raise BadInput("--units: an FMU is in SI, as FMI has it, and tells its units itself; leave it away")
    wanted = PLATFORMS if platforms is None else () if platforms == "none" else tuple(listed(platforms, "--platforms"))
    if part == "controller":
        if compared:
            raise BadInput("--compare is for the machine; a controller has no run of its own")
        block, code = controller(case.name, *controlled(case, diagram))
        unit, problem = make(block, int(version), wanted, code), None
    else:
        run = ready(case, diagram, "fmu")
        unit, problem = make(block_of(case.name, case.about, run), int(version), wanted), run.problem
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
    apart_by = {f"difference_{kind}": d for kind, d in differences.items()}
    checks = UnitChecks(token=unit.token, binaries=unit.binaries, missing=unit.missing, **apart_by)
    lines = [f"binary inside for {SYSTEMS[name]}" for name in unit.platforms]
    lines += [f"no binary for {SYSTEMS[name]}: {why}" for name, why in unit.missing.items()]
    lines += ["no binary inside: a tool that imports it compiles its sources"] if not unit.platforms else []
    lines += [f"{_WAYS[kind]} differs from the simulation by {residual_text(d, 2)}" for kind, d in differences.items()]
    emit(UnitFile(written=[str(path)], checks=checks), lambda: "\n".join(lines), files=[path])
    if apart:
        sys.exit(1)

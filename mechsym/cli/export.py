"""`mechsym export`: a mechanism or the machine of a case as text for other programs."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym import cases
from mechsym.cli.common import case_of, emit, json_option, out_option, pairs, set_option
from mechsym.files import make_folder, together, write_text
from mechsym.inputs import reads

if TYPE_CHECKING:
    from mechsym.out.text.programs import Written


@click.command(short_help="Write C, Modelica, Julia, MATLAB or JAX.")
@click.argument("name")
@click.option("--to", "languages", required=True, metavar="NAMES", help="c, modelica, julia, matlab, jax; or several.")
@click.option("--diagram", type=click.Path(), help="CSV file of a measured diagram in place of the cycle.")
@set_option
@out_option
@json_option
def export(
    name: str, languages: str, diagram: str | None, overrides: tuple[str, ...], out: Path | None, as_json: bool
) -> None:
    """Write NAME, a mechanism or a case, as text: all languages from the one program that mechsym itself compiles.

    A mechanism gives its functions with parameters as arguments; a case gives a machine with its curves, numbers and
    starts. The C of a machine also integrates it, with events and without allocation.

    \b
    Example: mechsym export zotov-89 --to c,modelica --out engine
             mechsym export hypocycloid --to julia
    """
    from mechsym.out.text.files import files

    folder = make_folder(out or Path("."))
    with reads(), together(folder):  # what is read is not written over, in the working folder neither
        written = _written(name, diagram, overrides)
        texts = [files(written, word.strip()) for word in languages.split(",")]
        paths = [str(write_text(folder / file, text)) for made in texts for file, text in made.items()]
    emit({"written": paths, "checks": {}}, as_json, lambda: "", files=paths)


def _written(name: str, diagram: str | None, overrides: tuple[str, ...]) -> "Written":
    from mechsym.jobs.export import ready
    from mechsym.mechanisms import names, own
    from mechsym.out.laws import block_of
    from mechsym.out.text.programs import of_block, of_mechanism

    if own.is_file(name) or (name in names() and name not in cases.names()):
        return of_mechanism(name)
    case = case_of(name, pairs(overrides))
    return of_block(block_of(case.name, case.about, ready(case, diagram)))

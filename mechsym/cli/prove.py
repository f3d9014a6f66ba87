"""`mechsym prove`: numbers that come with a theorem."""

from typing import TYPE_CHECKING

import click

from mechsym.cli.common import (
    budget_option,
    case_of,
    emit,
    in_rows,
    json_option,
    only_of,
    pairs,
    progress,
    set_option,
    table,
)
from mechsym.errors import BadInput

if TYPE_CHECKING:
    from mechsym.proof.outputs import ProvenRounding


@click.command(short_help="Prove what the machine code of a mechanism can lose to rounding.")
@click.argument("name")
@click.option("--case", "case_name", help="Case that gives parameters, speeds and forces; a built-in one without.")
@click.option("--range", "given", multiple=True, metavar="KEY=A..B", help="Range of a letter, e.g. --range phid=0..20.")
@click.option("--samples", default=10_000, show_default=True, help="Random points that the bounds are held against.")
@click.option(
    "--mode", type=click.Choice(["strict", "fast"]), default="strict", help="Build of the code; fast is refused."
)
@set_option
@budget_option
@json_option
@click.pass_context
def prove(
    ctx: click.Context, name: str, case_name: str | None, given: tuple[str, ...], samples: int, mode: str,
    overrides: tuple[str, ...], as_json: bool,
) -> None:  # fmt: skip
    """Bound the rounding of every output of the generated C of the mechanism NAME, or of the limits of guides (hinge).

    Parameters at the case's values +-1 %, a full turn of each angle, speeds and inputs within the case's extremes. The
    bound is proven in balls; samples of the compiled code against 60 digits show how near it is. Exit status 1 when a
    sample is beyond its bound: the code is not what was proven.

    \b
    Example: mechsym prove crosshead --case zotov-89 --samples 1000
    """
    from mechsym import mechanisms
    from mechsym.jobs.prove import GUIDES, of_guides_at, of_mechanism_at, usual_case
    from mechsym.quantities.results import tell

    if mode == "fast":
        raise BadInput("--mode fast contracts products and shares reciprocals: no bound is proven of it; use strict")
    if name != GUIDES:
        mechanisms.parameters_class(name)  # refuses what is none
    case = only_of(case_of(case_name or usual_case(name), pairs(overrides)), "prove")
    with progress(0, name) as bar:
        if name == GUIDES:
            found = of_guides_at(case, samples, bar.update)
        else:
            found = of_mechanism_at(name, case, _ranges(given), samples, bar.update)
    emit(tell(found), as_json, lambda: _text(found))
    ctx.exit(0 if found.holds else 1)


def _ranges(texts: tuple[str, ...]) -> dict[str, tuple[float, float]]:
    from mechsym.quantities.ranges import read_range

    ranges = {}
    for key, text in pairs(texts, "--range").items():
        found = read_range(text, "--range", key=key)
        if found.kind != "even" or found.unit or not found.values[0] <= found.values[1]:
            raise BadInput(f"--range {key}={text}: two ascending SI numbers with two dots between, such as phid=0..20")
        ranges[key] = (found.values[0], found.values[1])
    return ranges


def _text(found: "ProvenRounding") -> str:
    from mechsym.quantities.results import tell

    rows = in_rows([tell(row) for row in found.outputs], ("absolute", "seen"))
    columns = ["name", "absolute", "seen", "unit", "relative", "factor", "where"]
    singular = [f"no bound of {row.name} at {', '.join(row.singular)}" for row in found.outputs if row.singular]
    return "\n".join(
        [found.statement, "", table(rows, columns), *singular, "", *(f"trusted: {one}" for one in found.trusted)]
    )

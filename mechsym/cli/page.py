"""`mechsym page`: one HTML file that simulates the machine of a case."""

from pathlib import Path

import click

from mechsym.cli.common import case_of, emit, file_option, json_option, pairs, set_option
from mechsym.files import write_text


@click.command(short_help="Write a page that simulates, without a server.")
@click.argument("case")
@file_option("CASE.html by default.")
@click.option("--diagram", type=click.Path(), help="CSV file of a measured diagram in place of the cycle.")
@set_option
@json_option
def page(case: str, out: Path | None, diagram: str | None, overrides: tuple[str, ...], as_json: bool) -> None:
    """Write the machine of CASE as one HTML file with sliders, which simulates in the browser and asks nobody.

    The equations are the C of `mechsym fmu`, compiled to WebAssembly (extra web); the numbers are those of
    `mechsym simulate`.

    \b
    Example: mechsym page zotov-89 --out engine.html
    """
    from mechsym.jobs.export import ready
    from mechsym.out.laws import block_of
    from mechsym.out.web import page as make

    found = case_of(case, pairs(overrides))
    text = make(block_of(found.name, found.about, ready(found, diagram)))
    path = write_text(out or Path(f"{found.name}.html"), text)
    emit({"written": [str(path)], "checks": {"bytes": len(text.encode())}}, as_json, lambda: f"wrote {path}")

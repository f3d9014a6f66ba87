"""`mechsym page`: one HTML file that simulates the machine of a case."""

from pathlib import Path

import click

from mechsym.cli.common import budget_option, case_of, emit, file_in, file_option, json_option, pairs, set_option
from mechsym.files import write_text


@click.command(short_help="Write a page that simulates, without a server.")
@click.argument("case")
@file_option("CASE.html", ".html")
@click.option("--diagram", type=click.Path(), help="CSV file of a measured diagram in place of the cycle.")
@set_option
@budget_option
@json_option
def page(case: str, out: Path | None, diagram: str | None, overrides: tuple[str, ...], as_json: bool) -> None:
    """Write the machine of CASE as one HTML file with sliders, which simulates in the browser and asks nobody.

    The equations are the C of `mechsym fmu`, compiled to WebAssembly (extra web); the numbers are those of
    `mechsym simulate`.

    \b
    Example: mechsym page zotov-89 --out engine.html
    """
    from mechsym.jobs.export import ready, turning
    from mechsym.out.laws import block_of
    from mechsym.out.web import page as make
    from mechsym.out.web.build import PageChecks, WrittenPage

    found = case_of(case, pairs(overrides))
    run = ready(found, diagram)
    text = make(block_of(found.name, found.about, run), turning(found, run.guide))
    path = write_text(file_in(out, f"{found.name}.html", ".html"), text)
    answer = WrittenPage(written=[str(path)], checks=PageChecks(bytes=len(text.encode())))
    emit(answer, as_json, lambda: "", files=[path])

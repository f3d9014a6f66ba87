"""`mechsym cite`: what to cite for the data, formulas and methods of a case, a mechanism or a source."""

import click

from mechsym.cli.common import emit, json_option


@click.command(short_help="What to cite for a case, a mechanism or a source, as text and BibTeX.")
@click.argument("name")
@json_option
def cite(name: str) -> None:
    """What to cite for NAME: a case (its data, laws and methods), a derived mechanism, or a source.

    \b
    Examples: mechsym cite zotov-89
              mechsym cite generator-breathing --json
    """
    from mechsym.papers.cite import cited

    rows = cited(name)
    said = [f"{row['key']}: {row['what']}" for row in rows]
    emit(rows, lambda: "\n".join([*said, "", *("\n" + row["bibtex"] for row in rows)]))

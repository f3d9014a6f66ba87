"""`mechsym new`: a commented start for something of one's own."""

from pathlib import Path

import click

from mechsym.cli.common import emit, json_option


@click.command(short_help="Write a commented start for something of your own.")
@click.argument("kind", type=click.Choice(["mechanism"]))
@click.argument("name")
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), default=Path("."), help="Folder to write to.")
@json_option
def new(kind: str, name: str, out: Path, as_json: bool) -> None:
    """Write declaration, case and test of a new mechanism.

    \b
    Example: mechsym new mechanism toggle_press
    """
    from mechsym.cases import new_mechanism

    files = [str(path) for path in new_mechanism.write(name, out)]
    emit({"written": files}, as_json, lambda: "\n".join(f"wrote {file}" for file in files))

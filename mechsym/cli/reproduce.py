"""`mechsym reproduce`: published numbers computed again."""

from pathlib import Path

import click

from mechsym.cli.common import emit, json_option, out_option, progress, table
from mechsym.errors import BadInput


@click.command()
@click.argument("source", required=False)
@click.option("--write", is_flag=True, help="Record the verdicts of all sources, to be compared with from then on.")
@out_option
@json_option
@click.pass_context
def reproduce(ctx: click.Context, source: str | None, write: bool, out: Path | None, as_json: bool) -> None:
    """Compute the numbers of SOURCE again, or of all sources: published value, computed value, verdict, note.

    SOURCE is a file stem or a short name. With --out the figures are drawn as the source drew them, and the rows are
    written as JSON. Exit status 1 when a verdict differs from the recorded one.

    \b
    Example: mechsym reproduce chmielewski2015 --out figures
    """
    from mechsym import recorded
    from mechsym.reproduce import catalogue

    if write and source:
        raise BadInput("--write records the verdicts of all sources; leave out SOURCE")
    chosen = [catalogue.short_name(source)] if source else catalogue.names()
    rows = []
    with progress(len(chosen), "reproducing") as bar:
        for name in chosen:
            rows += catalogue.rows(name)
            bar.update(1)
    if out is not None:
        for path in _write(rows, chosen, out):
            click.echo(str(path), err=True)
    columns = ["source", "item", "published", "computed", "rel_error", "verdict"]
    emit(rows, as_json, lambda: table(rows, columns))
    package, identity = "mechsym.reproduce", ("source", "item")
    if write:
        recorded.write(package, rows, (*identity, "verdict"))
    differences = recorded.differences(package, rows, identity, ("verdict",))
    for line in differences:
        click.echo(f"differs from the record: {line}", err=True)
    ctx.exit(1 if differences else 0)


def _write(rows: list[dict], chosen: list[str], out: Path) -> list[Path]:
    from mechsym.files import to_json, write_text
    from mechsym.plots import svg
    from mechsym.reproduce import catalogue

    written = [write_text(out / "reproduce.json", to_json(rows) + "\n")]
    for name in chosen:
        draw = catalogue.figures(name)
        for stem, figure in draw().items() if draw else []:
            written.append(write_text(out / f"{stem}.svg", svg(figure)))
    return written

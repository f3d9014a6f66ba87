"""`mechsym reproduce`: published numbers and figures beside what the models give."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym.cli.common import emit, json_option, out_option, progress, table
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.papers.rows import ARITHMETIC, REPRODUCED

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechsym.papers.sources import Source


@click.command(short_help="Compute every published number again.")
@click.argument("source", required=False)
@click.option(
    "--write", is_flag=True, help="Record verdicts and values of all sources, to be compared with from then on."
)
@json_option
@out_option
@click.pass_context
def reproduce(ctx: click.Context, source: str | None, write: bool, out: Path | None) -> None:
    """Recompute every published number of SOURCE, or of all; --out draws the figures too.

    SOURCE is a short name or a file's stem: zotov2024, moroianu2017, chmielewski2015, prymak, nunes2017. Findings are
    results; exit status 1 only when the outcome differs from the recorded one.

    \b
    Example: mechsym reproduce chmielewski2015 --out reproduction
    """
    from mechsym.papers import rows as record
    from mechsym.papers import sources

    if write and source:
        raise BadInput(f"--write records all sources, not {source} alone; leave the name out")
    chosen, results = sources(source), {}
    with progress(len(chosen), "sources") as bar:
        for one in chosen:
            results[one.stem] = one.rows()
            bar.update(1)
    flat = [row for one in results.values() for row in one]
    files = [record.write(_PACKAGE, flat, (*_NAME, "printed", "verdict", "computed", "tolerance"))] if write else []
    changed = record.differences(_PACKAGE, flat, _NAME, ("printed", "verdict", "computed"))
    if out is not None:
        from mechsym.papers import page

        files += page.write(out, chosen, results, changed)
    emit(flat, lambda: _text(chosen, results, changed, files))
    ctx.exit(1 if changed else 0)


def _text(sources: "Sequence[Source]", data: Json, changed: list[str], files: list[Path]) -> str:
    from mechsym.papers.page import counts, round_off

    lines = []
    for source in sources:
        rows, notes = [], []
        for row in data[source.stem]:
            error = row["rel_error"]
            away = None if error is None else "0" if error == 0 or round_off(error) else f"{error:+.1e}"
            rows.append(row | {"rel_error": away, "computed": "0" if round_off(row["computed"]) else row["computed"]})
            if row["verdict"] not in (REPRODUCED, ARITHMETIC) and row["note"]:
                notes.append(f"  {row['item']}: {row['note']}")
        summed = ", ".join(f"{count} {verdict}" for verdict, count in counts(rows).items() if count)
        # notes of what is not plainly reproduced stand behind the table, since they are long
        shown = table(rows, ["item", "printed", "computed", "rel_error", "verdict"], digits=6)
        lines += [f"{source.name}: {source.title}", shown, "\n".join(notes), f"  {summed}", ""]
    lines += ["differs from the recorded outcome:", *changed] if changed else ["the outcome is the recorded one"]
    if files:
        lines.append(f"written: {len(files)} files, {files[0]} first")
    return "\n".join(lines)


_PACKAGE, _NAME = "mechsym.papers", ("source", "item")

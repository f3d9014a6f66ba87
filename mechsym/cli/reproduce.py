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
def reproduce(ctx: click.Context, source: str | None, write: bool, as_json: bool, out: Path | None) -> None:
    """Recompute every published number of SOURCE, or of all; --out draws the figures too.

    SOURCE is a short name or a file's stem: zotov2024, moroianu2017, chmielewski2015, prymak, nunes2017. Findings are
    results; exit status 1 only when the outcome differs from the recorded one.

    \b
    Example: mechsym reproduce chmielewski2015 --out reproduction
    """
    from mechsym.papers import record, sources

    if write and source:
        raise BadInput(f"--write records all sources, not {source} alone; leave the name out")
    chosen, found = sources(source), {}
    with progress(len(chosen), "sources") as bar:
        for one in chosen:
            found[one.stem] = one.rows()
            bar.update(1)
    flat = [row for one in found.values() for row in one]
    files = [record.write(_PACKAGE, flat, (*_NAME, "printed", "verdict", "computed", "tolerance"))] if write else []
    changed = record.differences(_PACKAGE, flat, _NAME, ("printed", "verdict", "computed"))
    if out is not None:
        from mechsym.papers import page

        files += page.write(out, chosen, found, changed)
    emit(flat, as_json, lambda: _text(chosen, found, changed, files))
    ctx.exit(1 if changed else 0)


def _text(sources: "Sequence[Source]", found: Json, changed: list[str], files: list[Path]) -> str:
    from mechsym.papers.page import counts

    lines = []
    for source in sources:
        own = found[source.stem]
        summed = ", ".join(f"{count} {verdict}" for verdict, count in counts(own).items() if count)
        lines += [
            f"{source.name}: {source.title}",
            table(_shown(own), [*_COLUMNS], digits=6),
            _notes(own),
            f"  {summed}",
            "",
        ]
    lines += ["differs from the recorded outcome:", *changed] if changed else ["the outcome is the recorded one"]
    if files:
        lines.append(f"written: {len(files)} files, {files[0]} first")
    return "\n".join(lines)


_PACKAGE, _NAME = "mechsym.papers", ("source", "item")
_COLUMNS = ("item", "printed", "computed", "rel_error", "verdict")


def _shown(rows: list[Json]) -> list[Json]:
    from mechsym.papers.page import round_off

    return [
        row | {"rel_error": _away(row["rel_error"]),
               "computed": "0" if round_off(row["computed"]) else row["computed"]} for row in rows
    ]  # fmt: skip


def _away(error: float | None) -> str | None:
    from mechsym.papers.page import round_off

    return None if error is None else "0" if error == 0 or round_off(error) else f"{error:+.1e}"


def _notes(rows: list[Json]) -> str:
    """Notes of everything that is not plainly reproduced, after the table since they are long."""
    told = [
        f"  {row['item']}: {row['note']}"
        for row in rows
        if row["verdict"] not in (REPRODUCED, ARITHMETIC) and row["note"]
    ]
    return "\n".join(told)

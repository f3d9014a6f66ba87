"""`mechsym mechanisms` and `mechsym cases`: what there is."""

import tomllib

import click

from mechsym.cli.common import emit, json_option, table
from mechsym.errors import BadInput
from mechsym.files import Json


@click.command()
@json_option
def mechanisms(as_json: bool) -> None:
    """List the derived mechanisms with their letters.

    \b
    Example: mechsym mechanisms --json
    """
    from mechsym import mechanisms as known

    rows = []
    for name in known.names():
        found = known.listing(name)
        letters = {k: list(found[k]) for k in ("coordinates", "parameters", "inputs", "outputs")}
        rows.append({"name": name, **letters, "source": found["source"], "about": found["about"]})
    emit(rows, as_json, lambda: table(_cited(rows), ["name", "coordinates", "inputs", "source", "about"]))


@click.command()
@click.argument("name", required=False)
@json_option
def cases(name: str | None, as_json: bool) -> None:
    """List the built-in cases, or print one to copy and edit.

    \b
    Example: mechsym cases zotov-89 > mine.toml
    """
    from mechsym import cases as known

    if name is not None:
        known.load(name)
        text = known.text(name)
        emit({"name": name, **tomllib.loads(text)}, as_json, lambda: text.rstrip("\n"))
        return
    rows = []
    for case in known.names():
        head = tomllib.loads(known.text(case))
        rows.append({"name": case, **{k: head.get(k) for k in ("mechanism", "source", "about")}})
    if not rows:
        raise BadInput("no built-in case was found; the installation is damaged, install mechsym again")
    emit(rows, as_json, lambda: table(_cited(rows), ["name", "mechanism", "source", "about"]))


def _cited(rows: list[Json]) -> list[Json]:
    from mechsym.papers.sources import short_name

    return [row | {"source": short_name(row["source"])} for row in rows]

"""What there is: `mechsym cases`, `mechanisms`, `sections`, what to cite, and the native route."""

import dataclasses
import tomllib

import click

from mechsym.cli.common import emit, json_option, table
from mechsym.errors import BadInput
from mechsym.files import Json


@click.command()
@json_option
def mechanisms() -> None:
    """List the derived mechanisms with their letters.

    \b
    Example: mechsym mechanisms --json
    """
    from mechsym import mechanisms as known

    rows = []
    for name in known.names():
        listing = known.listing(name)
        letters = {k: list(listing[k]) for k in ("coordinates", "parameters", "inputs", "outputs")}
        rows.append({"name": name, **letters, "source": listing["source"], "about": listing["about"]})
    emit(rows, lambda: table(_cited(rows), ["name", "coordinates", "inputs", "source", "about"]))


@click.command()
@click.argument("name", required=False)
@json_option
def cases(name: str | None) -> None:
    """List the built-in cases, or print one to copy and edit.

    \b
    Example: mechsym cases zotov-89 > mine.toml
    """
    from mechsym import cases as known

    if name is not None:
        known.load(name)
        text = known.text(name)
        emit({"name": name, **tomllib.loads(text)}, lambda: text.rstrip("\n"))
        return
    rows = []
    for case in known.names():
        head = tomllib.loads(known.text(case))
        rows.append({"name": case, **{k: head.get(k) for k in ("mechanism", "source", "about")}})
    if not rows:
        raise BadInput("no built-in case was found; the installation is damaged, install mechsym again")
    emit(rows, lambda: table(_cited(rows), ["name", "mechanism", "source", "about"]))


def _cited(rows: list[Json]) -> list[Json]:
    from mechsym.papers.sources import short_name

    return [row | {"source": short_name(row["source"])} for row in rows]


@click.command()
@click.option("--info", "wanted", is_flag=True, help="Show compiler, options, processor and cache (the default).")
@click.option("--clear", is_flag=True, help="Empty the cache of compiled files first.")
@json_option
def native(wanted: bool, clear: bool) -> None:
    """Compiler and cache of the native route.

    \b
    Example: mechsym native --info
    """
    from mechsym.native.cache import clear as empty
    from mechsym.native.cache import info

    removed = empty() if clear else 0
    facts = dataclasses.asdict(info())
    emit({**facts, "removed": removed}, lambda: _text(facts, removed if clear else None))


def _text(listing: Json, removed: int | None) -> str:
    rows = [
        ("route", listing["route"] + (f" ({listing['reason']})" if listing["reason"] else "")),
        ("compiler", f"{listing['compiler']}: {listing['version']}" if listing["compiler"] else "none"),
        *((f"mode {mode}", " ".join(flags)) for mode, flags in listing["flags"].items()),
        ("processor", listing["processor"]),
        ("Python.h", listing["python_header"] or "not there; scalar calls go through ctypes"),
        ("cache", f"{listing['cache']}: {listing['files']} files, {listing['size'] / 1e6:.1f} MB"),
    ]
    if removed is not None:
        rows.append(("removed", f"{removed} files"))
    return "\n".join(f"{name:<12} {value}" for name, value in rows)


@click.command(short_help="Every section and key of a case, or a schema for editors.")
@click.argument("name", required=False)
@click.option(
    "--schema",
    "as_schema",
    is_flag=True,
    help="Print the JSON Schema of case files; with --results that of what commands tell.",
)
@click.option("--results", "of_results", is_flag=True, help="What commands tell: with NAME the numbers of one command.")
@json_option
def sections(name: str | None, as_schema: bool, of_results: bool) -> None:
    """Sections of case files; with NAME the keys of one: unit, range, default, meaning, commands that read it.

    \b
    Examples: mechsym sections
              mechsym sections spring
              mechsym sections --schema > mechsym.schema.json
              mechsym sections --results flywheel
              mechsym sections --results --schema flywheel
    """
    from mechsym.cases.keys import json_schema, keys
    from mechsym.cli.results import RESULTS, WORDS, rows, schema

    if as_schema:
        from mechsym.files import to_json

        commands = [name] if name else sorted([*RESULTS, *WORDS])
        schemas = {one: schema(one) for one in commands} if of_results else {}
        click.echo(to_json((schemas[name] if name else schemas) if of_results else json_schema()))
        return
    if of_results:
        numbers, columns = rows(name), [*(["command"] if name is None else []), "path", "unit", "about"]
        emit(numbers, lambda: table(numbers, columns))
        return
    listed = keys(name)
    emit(listed, lambda: _keys(listed) if name else _sections(listed))


def _sections(rows: list[Json]) -> str:
    lines = []
    for section in dict.fromkeys(row["section"] for row in rows):
        own = [row for row in rows if row["section"] == section]
        needed, kinds = sum(row["required"] for row in own), len({row["variant"] for row in own})
        count = f"{len(own)} keys" + (f" in {kinds} kinds" if kinds > 1 else f", {needed} needed")
        lines.append(f"{section:18}{count:26}{', '.join(own[0]['commands'])}".rstrip())
    return "\n".join([*lines, "", "keys of one: mechsym sections NAME"])


def _keys(rows: list[Json]) -> str:
    lines = [f"read by {', '.join(rows[0]['commands']) or 'what refers to it'}"] if rows else []
    for variant in dict.fromkeys(row["variant"] for row in rows):
        own = [row for row in rows if row["variant"] == variant]
        widths = [max(len(cells[i]) for cells in map(_cells, own)) for i in range(3)]
        lines += ["", f"with {variant}" if variant else "keys"]
        for row in own:
            cells = "  ".join(cell.ljust(width) for cell, width in zip(_cells(row), widths, strict=True))
            lines.append(f"  {cells}  {row['about']}".rstrip())
    return "\n".join(lines)


def _cells(row: Json) -> tuple[str, str, str]:
    bounds = (("above", ">"), ("low", ">="), ("below", "<"), ("high", "<="))
    limits = " and ".join(f"{sign} {row[name]:g}" for name, sign in bounds if row[name] is not None)
    kind = row["kind"] if row["unit"] is None and row["kind"] != "word" else ""
    options = " | ".join([*(row["options"] or ()), *filter(None, [kind])])
    if row["required"]:
        usual = "needed"
    else:
        usual = "optional" if row["default"] in (None, [], "") else f"usual {row['default']}"
    return row["key"], " ".join(filter(None, (f"[{row['unit']}]" * (row["unit"] is not None), limits, options))), usual


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

"""`mechsym mechanisms` and `mechsym cases`: what there is."""

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
        found = known.listing(name)
        letters = {k: list(found[k]) for k in ("coordinates", "parameters", "inputs", "outputs")}
        rows.append({"name": name, **letters, "source": found["source"], "about": found["about"]})
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
    found = dataclasses.asdict(info())
    emit({**found, "removed": removed}, lambda: _text(found, removed if clear else None))


def _text(found: Json, removed: int | None) -> str:
    rows = [
        ("route", found["route"] + (f" ({found['reason']})" if found["reason"] else "")),
        ("compiler", f"{found['compiler']}: {found['version']}" if found["compiler"] else "none"),
        *((f"mode {mode}", " ".join(flags)) for mode, flags in found["flags"].items()),
        ("processor", found["processor"]),
        ("Python.h", found["python_header"] or "not there; scalar calls go through ctypes"),
        ("cache", f"{found['cache']}: {found['files']} files, {found['size'] / 1e6:.1f} MB"),
    ]
    if removed is not None:
        rows.append(("removed", f"{removed} files"))
    return "\n".join(f"{name:<12} {value}" for name, value in rows)

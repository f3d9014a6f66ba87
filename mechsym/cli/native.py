"""`mechsym native`: which compiler is used, for which processor, and where compiled files are kept."""

import dataclasses

import click

from mechsym.cli.common import emit, json_option
from mechsym.files import Json


@click.command()
@click.option("--info", "wanted", is_flag=True, help="Show compiler, options, processor and cache (the default).")
@click.option("--clear", is_flag=True, help="Empty the cache of compiled files first.")
@json_option
def native(wanted: bool, clear: bool, as_json: bool) -> None:
    """Compiler and cache of the native route.

    \b
    Example: mechsym native --info
    """
    from mechsym.native.cache import clear as empty
    from mechsym.native.cache import info

    removed = empty() if clear else 0
    found = dataclasses.asdict(info())
    emit({**found, "removed": removed}, as_json, lambda: _text(found, removed if clear else None))


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

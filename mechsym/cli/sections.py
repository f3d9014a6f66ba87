"""`mechsym sections`: every section and key of a case file."""

import click

from mechsym.cli.common import emit, json_option, table
from mechsym.files import Json


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
        told = {one: schema(one) for one in commands} if of_results else {}
        click.echo(to_json((told[name] if name else told) if of_results else json_schema()))
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
    options = " | ".join(row["options"]) if row["options"] else row["kind"] if row["unit"] is None else ""
    if row["required"]:
        usual = "needed"
    else:
        usual = "optional" if row["default"] in (None, [], "") else f"usual {row['default']}"
    return row["key"], " ".join(filter(None, (f"[{row['unit']}]" * (row["unit"] is not None), limits, options))), usual

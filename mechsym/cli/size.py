"""`mechsym size`: the parts of an engine for the loads of its cycle, or a check of the parts that a source printed."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym.cases import Case
from mechsym.cli.common import case_command, emit, ending, in_rows, out_option, table
from mechsym.files import Json
from mechsym.quantities.display import without_rounding

if TYPE_CHECKING:
    from mechsym.sizing.rows import Sizing

_FILE = click.Path(path_type=Path, dir_okay=False)
_SHOWN = ("component", "quantity", "value", "limit", "unit", "safety_factor", "wanted", "rule", "source", "note")
_FIRST = ["component", "quantity", "value", "unit", "note"]


@case_command("Component sizing with safety factors.", out_option)
@click.option("--as-printed", is_flag=True, help="Check the parts of the case instead of sizing new ones.")
@click.option(
    "--step", type=_FILE, callback=ending(".step", ".stp"), help="STEP file of the parts to write (extra step)."
)
def size(case: Case, as_printed: bool, step: Path | None, out: Path | None) -> None:
    """Size the engine of CASE for its loads over the speed range, with the factor of every rule.

    Exit status 1 when a factor is below the wanted one. Loads come from the case's cycle with the settings of its
    section [sizing]; the masses in the loads are those of the sized parts.

    \b
    Examples: mechsym size nunes-hypocycloid --out parts --step parts.step
              mechsym size nunes-hypocycloid --as-printed --json
              mechsym size nunes-slider-crank --set sizing.life="500 h"
    """
    from mechsym.jobs.size import check_printed
    from mechsym.jobs.size import size as sized

    sizes = check_printed(case) if as_printed else sized(case)
    files = []
    if step is not None:
        from mechsym.out.cad.solids import bodies
        from mechsym.out.cad.step import write

        files.append(write(step, bodies(sizes)))
    files += _write(out, sizes) if out else []
    emit(sizes.checked, lambda: _text(sizes), files=files, findings=sizes.view.findings())
    if sizes.failing or not sizes.converged:
        raise click.exceptions.Exit(1)


def _text(sizing: "Sizing") -> str:
    sizes = [row for row in sizing.rows if row["limit"] is None]
    checks = [row for row in sizing.rows if row["limit"] is not None]
    if not checks:
        rows = _together(without_rounding(sizes, ("value",)))
        columns = [_FIRST[0], *(["of"] if any(row["of"] for row in rows) else []), *_FIRST[1:]]
        shown = table(in_rows(rows, ("value",)), columns, named=["component"])
        return "\n".join(["Loads, of a joint the resultant (--json has its components)", shown])
    # a margin against nought has no factor
    plain = {"safety_factor": None, "wanted": None}
    marked = [row | {"": "" if row["holds"] else "BELOW"} | (plain if row["limit"] == 0 else {}) for row in checks]
    sizes, marked = in_rows(sizes, ("value",)), in_rows(marked, ("value", "limit"))
    tables = table(sizes, _FIRST, named=["component"]), table(marked, ["", *_SHOWN], named=["component"])
    lines = ["Sizes and figures", tables[0], "", "Checks", tables[1], ""]
    state = "masses and loads agree" if sizing.converged else "masses and loads do NOT agree"
    below = f"{len(sizing.failing)} of {len(checks)} factors are below the wanted ones"
    return "\n".join([*lines, f"{below if sizing.failing else 'every factor holds'}; {state} ({sizing.rounds} rounds)"])


def _together(rows: Sequence[Json]) -> list[Json]:
    """Loads that are the same at several cylinders or throws in one row, with their numbers."""
    from mechsym.forces.plots import as_throw
    from mechsym.forces.shown import BESIDE_THROW
    from mechsym.mechanisms.roles import resultants

    alike: dict[tuple[str, ...], Json] = {}
    shared = any(row["component"] == "main_bearing_force_2" for row in rows)
    components = {part for parts in resultants(row["component"] for row in rows).values() for part in parts}
    for row in rows:
        if row["component"] in components:
            continue
        name, _, number = row["component"].rpartition("_")
        row = row | ({"component": name, "of": number} if number.isdigit() else {"of": ""})
        if shared and name.startswith("main_bearing_force"):  # a bearing carries shares of the throws beside it
            row |= {"component": as_throw(name), "note": BESIDE_THROW}
        first = alike.setdefault((row["component"], row["quantity"], f"{row['value']:.6g}"), row)
        first["of"] += f", {number}" if first is not row else ""
    return list(alike.values())


def _write(out: Path, sizing: "Sizing") -> list[Path]:
    from mechsym.files import to_json, write_csv, write_text
    from mechsym.sizing.drawing import section_view
    from mechsym.sizing.rows import COLUMNS

    columns = {name: [row[name] if row[name] is not None else "" for row in sizing.rows] for name in COLUMNS}
    files = [
        write_csv(out / "parts.csv", columns),
        write_text(out / "parts.json", to_json(sizing.rows) + "\n"),
    ]
    if sizing.stock is None:
        return files
    return [*files, section_view(out / "section.svg", sizing.parts, sizing.forces, sizing.stock)]

"""`mechsym compare`: two engines side by side over the speeds."""

from pathlib import Path
from typing import Any

import click

from mechsym.cli.common import case_of, emit, json_option, judge_ends, out_option, pairs, set_option, table
from mechsym.cli.speeds import parse_speeds


@click.command(short_help="Two engines side by side over the speeds.")
@click.argument("case_a", metavar="CASE")
@click.argument("case_b", metavar="CASE")
@click.option("--speeds", metavar="A:B:STEP", help="Speeds in rpm; without it the first case's [speeds].")
@json_option
@out_option
@set_option
def compare(
    case_a: str, case_b: str, speeds: str | None, as_json: bool, out: Path | None, overrides: tuple[str, ...]
) -> None:
    """Two engines over the speeds: crossover of the mean torque, table, curves. --set acts on both.

    \b
    Example: mechsym compare nunes-slider-crank nunes-hypocycloid --out comparison
    """
    import numpy as np

    from mechsym.cycle.engine import columns, over_speeds
    from mechsym.jobs.compare import compare as side_by_side
    from mechsym.jobs.cycle import engine, speed_range

    cases = [case_of(name, pairs(overrides)) for name in (case_a, case_b)]
    omega = np.asarray(parse_speeds(speeds)) if speeds is not None else speed_range(cases[0].need("speeds"))
    for case in cases:
        judge_ends(case, "operation.speed", omega.tolist())
    found = {case.name: columns(over_speeds(engine(case), omega)) for case in cases}
    a, b = found.values() if len(found) == 2 else [*found.values()] * 2
    result = {"cases": [case.name for case in cases], **side_by_side(a, b)}
    files = _write(out, found, result) if out else []
    emit(result, as_json, lambda: "\n".join([_text(result), *(f"written: {file}" for file in files)]))


def _text(result: dict[str, Any]) -> str:
    from mechsym.jobs.compare import unit_of

    a, b = result["cases"]
    found = [f"{speed:.1f} rpm" for speed in result["crossover_rpm"]]
    rows = [row | {"at rpm": _speeds(row), "unit": unit_of(row["quantity"]), "b/a - 1 %": _percent(row["difference"])}
            for row in result["table"]]  # fmt: skip
    lines = [f"a = {a}, b = {b}", f"mean torque crosses at {', '.join(found) or 'no speed'}"]
    return "\n".join([*lines, table(rows, ["quantity", "at rpm", "a", "b", "unit", "b/a - 1 %"])])


def _speeds(row: dict[str, Any]) -> str:
    if row["speed_rpm"] is None:
        return f"{row['speed_a_rpm']:.0f} | {row['speed_b_rpm']:.0f}"
    return f"{row['speed_rpm']:.0f}"


def _percent(value: float | None) -> str:
    return "-" if value is None else f"{100 * value:+.2f}"


def _write(out: Path, found: dict[str, Any], result: dict[str, Any]) -> list[Path]:
    from mechsym.cycle.plots import performance_picture
    from mechsym.files import to_json, write_quantities, write_text
    from mechsym.jobs.compare import unit_of

    rows = result["table"]
    columns = {k: [row[k] for row in rows] for k in ("quantity", "speed_rpm", "a", "b")}
    columns |= {"unit": [unit_of(row["quantity"]) for row in rows], "difference": [row["difference"] for row in rows]}
    return [
        write_quantities(out / "comparison.csv", columns),
        write_text(out / "comparison.json", to_json(result) + "\n"),
        performance_picture(out / "comparison.svg", found),
    ]

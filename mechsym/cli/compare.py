"""`mechsym compare`: two engines side by side over the speeds."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym.cases import told_apart
from mechsym.cli import common
from mechsym.cli.common import case_of, emit, judge_ends, pairs, parse_speeds, table
from mechsym.files import Json
from mechsym.quantities.display import key_words

if TYPE_CHECKING:
    from mechsym.cycle.columns import EngineComparison


@click.command(short_help="Two engines side by side over the speeds.")
@click.argument("case_a", metavar="CASE")
@click.argument("case_b", metavar="CASE")
@click.option("--speeds", metavar="A:B:STEP", help="Speeds in rpm; without it the first case's [speeds].")
@common.json_option
@common.out_option
@common.set_option
def compare(case_a: str, case_b: str, speeds: str | None, out: Path | None, overrides: tuple[str, ...]) -> None:
    """Two engines over the speeds: crossover of the mean torque, table, curves. --set acts on both.

    \b
    Example: mechsym compare nunes-slider-crank nunes-hypocycloid --out comparison
    """
    import numpy as np

    from mechsym.cases.needs import SPEEDS, require
    from mechsym.cycle.columns import compare as side_by_side
    from mechsym.cycle.engine import columns, over_speeds
    from mechsym.jobs.cycle import engine, speed_range

    cases = told_apart([case_of(name, pairs(overrides)) for name in (case_a, case_b)])
    for case, given in zip(cases, (speeds is not None, True), strict=True):  # the second runs at the first one's speeds
        require(case, "compare", SPEEDS if given else "")
    omega = np.asarray(parse_speeds(speeds)) if speeds is not None else speed_range(cases[0].need("speeds"))
    for case in cases:
        judge_ends(case, "operation.speed", omega.tolist())
    figures = {case.name: columns(over_speeds(engine(case), omega)) for case in cases}
    a, b = figures.values() if len(figures) == 2 else [*figures.values()] * 2
    result = side_by_side(a, b, tuple(case.name for case in cases))
    files = _write(out, figures, result) if out else []
    emit(result, lambda: _text(result), files=files)


def _text(result: "EngineComparison") -> str:
    from mechsym.cycle.columns import WORDS

    a, b = result.cases
    crossings = [f"{speed:.1f} rpm" for speed in result.numbers.crossover_rpm]
    rows = []
    for row in result.numbers.table:
        name = row.quantity.removeprefix("largest ")
        words = key_words(name, WORDS)
        at = [getattr(row, f"speed_{one}rpm", None) for one in ("", "a_", "b_")]
        rows.append({
            **vars(row),
            "quantity": words if name == row.quantity else f"highest {words.removeprefix('largest ')}",
            "at rpm": " | ".join(f"{speed:.0f}" for speed in at if speed is not None),
            "b/a - 1 %": "-" if row.difference is None else f"{100 * row.difference:+.2f}",
        })  # fmt: skip
    lines = [f"a = {a}, b = {b}", f"mean torque crosses at {', '.join(crossings) or 'no speed'}"]
    return "\n".join([*lines, table(rows, ["quantity", "at rpm", "a", "b", "unit", "b/a - 1 %"])])


def _write(out: Path, data: Json, result: "EngineComparison") -> list[Path]:
    from mechsym.cycle.plots import performance_picture
    from mechsym.files import to_json, write_quantities, write_text

    names = ("quantity", "speed_rpm", "a", "b", "unit", "difference")
    columns = {name: [getattr(row, name) for row in result.numbers.table] for name in names}
    return [
        write_quantities(out / "comparison.csv", columns, {"difference": "-"}),
        write_text(out / "comparison.json", to_json(result) + "\n"),
        performance_picture(out / "comparison.svg", data),
    ]

"""`mechsym study`: several sweeps of one file, and one report of them."""

from pathlib import Path
from typing import Any

import click

from mechsym.cli.common import emit, json_option, out_option, progress, table
from mechsym.cli.swept import INTERRUPTED, judge, kept_or_short, picture_of, report_of, rows_of, write
from mechsym.errors import BadInput, suggest


@click.command(short_help="Several sweeps of a file, one report.")
@click.argument("study", metavar="FILE")
@click.option("--only", multiple=True, metavar="NAME", help="Run only this sweep (repeatable).")
@click.option("--jobs", type=click.IntRange(min=1), help="Processes; as many as pay off where left away.")
@click.option("--fresh", is_flag=True, help="Compute all points again, whatever --out keeps.")
@out_option
@json_option
@click.pass_context
def study(ctx: click.Context, study: str, only: tuple[str, ...], jobs: int | None, fresh: bool, out: Path | None,
          as_json: bool) -> None:  # fmt: skip
    """Run the sweeps of FILE, a TOML file or the name of a study that comes with the program.

    \b
    title = "Compression"
    case = "nunes-hypocycloid"
    [[sweep]]
    name = "compression"
    over = ["chamber.compression_ratio=8..14:13"]
    show = ["efficiency", "p_max_mpa"]

    A sweep takes what the command takes: case, over, set, tied, of, samples, sobol, seed, show; what stands above the
    sweeps holds for all. With --out: report.html with a picture and a table of each, and a folder for each with its
    data; the same command goes on where it stopped. Exit status 1 when a sweep has gaps only.

    \b
    Examples: mechsym study nunes2017-chapter-6 --out chapter6
              mechsym study mine.toml --only compression
    """
    from mechsym import sweep as sweeps
    from mechsym.files import make_folder
    from mechsym.sweep.study import read

    asked = read(study)
    wanted = _wanted(asked, only)
    layouts = [sweeps.layout(one.plan) for one in wanted]
    counts = [len(points.points) for points in layouts]
    for one, points in zip(wanted, layouts, strict=True):
        judge(one.plan, points)
    seconds = sum(sweeps.forecast(one.plan, n) for one, n in zip(wanted, counts, strict=True))
    kept_or_short(sum(counts), seconds, out)
    told: list[dict[str, Any]] = []
    with progress(sum(counts), f"{len(wanted)} sweeps, about {max(seconds, 1):.0f} s of a processor") as bar:
        for one in wanted:
            folder = None if out is None else make_folder(out / one.name)
            means = sweeps.Means(jobs=jobs or 0, folder=folder, fresh=fresh)
            found = sweeps.sweep(one.plan, bar.update, means)
            told.append(_told(one, found, folder))
            if found.interrupted:
                break
    files = [] if out is None else [str(_page(asked, told, out))]
    report = {
        "study": asked.title,
        "sweeps": [{k: v for k, v in one.items() if k not in ("picture", "rows")} for one in told],
        "interrupted": told[-1]["interrupted"],
        "files": files,
    }
    emit(report, as_json, lambda: _text(told, files), leave_out=("sweeps",))
    empty = any(len(one["failed"]) == one["points"] for one in told)
    ctx.exit(INTERRUPTED if report["interrupted"] else int(empty))


def _wanted(asked: Any, only: tuple[str, ...]) -> list[Any]:
    names = [one.name for one in asked.sweeps]
    for name in only:
        if name not in names:
            raise BadInput(f"--only {name} is no sweep of the study; {suggest(name, names)}")
    return [one for one in asked.sweeps if not only or one.name in only]


def _told(one: Any, found: Any, folder: Path | None) -> dict[str, Any]:
    """What a sweep gave, as numbers and as text, its files written."""
    picture = "" if folder is None else picture_of(found, one.name)
    files = [] if folder is None else write(found, folder, picture)
    return {
        "name": one.name, "about": one.about, "over": list(one.plan.over), "tied": list(one.plan.tied),
        "points": len(found.points), "picture": picture, "rows": rows_of(found), **report_of(found, files),
    }  # fmt: skip


def _page(asked: Any, told: list[dict[str, Any]], out: Path) -> Path:
    from mechsym.files import write_text
    from mechsym.page import page

    return write_text(out / "report.html", page("study.html", title=asked.title, about=asked.about, sweeps=told))


def _text(told: list[dict[str, Any]], files: list[str]) -> str:
    lines = []
    for one in told:
        lines += [f"{one['name']}: {one['points']} points, {len(one['failed'])} failed. {one['about']}".rstrip()]
        lines += [table(one["rows"], ["name", "unit", "min", "at min", "max", "at max"])] if one["rows"] else []
        lines += [f"failed: {gap['reason']}" for gap in one["failed"][:3]] + [""]
    return "\n".join([*lines, *(f"wrote {file}" for file in files)])

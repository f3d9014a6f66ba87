"""`mechsym study`: several sweeps of one file, and one report of them."""

import contextlib
from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym.cli.common import emit, json_option, out_option, progress, table
from mechsym.cli.sweep import INTERRUPTED, gaps, judge, kept_or_short, picture_of, rows_of, write
from mechsym.errors import BadInput, suggest
from mechsym.interrupts import whole
from mechsym.plausible import Doubt

if TYPE_CHECKING:
    from mechsym.sweep.data import StudiedSweep
    from mechsym.sweep.run import Sweep
    from mechsym.sweep.study import StudySweep


@click.command(short_help="Several sweeps of a file, one report.")
@click.argument("study", metavar="FILE")
@click.option("--only", multiple=True, metavar="NAME", help="Run only this sweep (repeatable).")
@click.option("--jobs", type=click.IntRange(min=1), help="Processes; as many as pay off where left away.")
@click.option("--fresh", is_flag=True, help="Compute all points again, whatever --out keeps.")
@out_option
@json_option
@click.pass_context
def study(
    ctx: click.Context, study: str, only: tuple[str, ...], jobs: int | None, fresh: bool, out: Path | None
) -> None:
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
    from mechsym.files import make_folder, write_text
    from mechsym.page import page
    from mechsym.sweep.data import StudiedSweep, StudyNumbers
    from mechsym.sweep.study import read

    asked = read(study)
    names = [one.name for one in asked.sweeps]
    for name in only:
        if name not in names:
            raise BadInput(f"--only {name} is no sweep of the study; {suggest(name, names)}")
    wanted = [one for one in asked.sweeps if not only or one.name in only]
    layouts = [sweeps.layout(one.plan) for one in wanted]
    counts = [len(points.points) for points in layouts]
    for one, points in zip(wanted, layouts, strict=True):
        judge(one.plan, points)
    seconds = sum(sweeps.forecast(one.plan, n) for one, n in zip(wanted, counts, strict=True))
    kept_or_short(sum(counts), seconds, out)
    studied: list[StudiedSweep] = []
    refused: list[Doubt] = []
    label = f"{len(wanted)} sweeps, about {max(seconds, 1):.0f} s of a processor"
    with contextlib.ExitStack() as last, progress(sum(counts), label) as bar:
        for one in wanted:
            folder = None if out is None else make_folder(out / one.name)
            means = sweeps.Means(jobs=jobs or 0, folder=folder, fresh=fresh)
            result = sweeps.sweep(one.plan, bar.update, means)
            if result.interrupted:
                last.enter_context(whole())
            studied.append(_told(one, result, folder))
            refused += gaps(result)
            if result.interrupted:
                break
        files = []
        if out is not None:
            from mechsym.sweep.plots import said

            text = page("study.html", title=asked.title, about=asked.about, sweeps=studied, said=said)
            files = [str(write_text(out / "report.html", text))]
        interrupted = studied[-1].numbers.interrupted
        done = StudyNumbers(study=asked.title, sweeps=tuple(studied), interrupted=interrupted, files=tuple(files))
        emit(done, lambda: _text(studied), beside={"doubts": refused}, leave_out=("sweeps",), files=files)
    empty = any(len(one.numbers.failed) == one.points for one in studied)
    ctx.exit(INTERRUPTED if interrupted else int(empty))


def _told(one: "StudySweep", result: "Sweep", folder: Path | None) -> "StudiedSweep":
    """What a sweep gave, as numbers and as text, its files written."""
    from mechsym.sweep.data import StudiedSweep, numbers
    from mechsym.sweep.plots import caption

    picture = "" if folder is None else picture_of(result, one.name)
    files = [] if folder is None else write(result, folder, picture)
    return StudiedSweep(
        name=one.name, about=one.about, over=one.plan.over, tied=one.plan.tied, points=len(result.points),
        numbers=numbers(result, files), picture=picture, see=caption(result) if picture else "", rows=rows_of(result),
    )  # fmt: skip


def _text(studied: list["StudiedSweep"]) -> str:
    lines, columns = [], ["name", "unit", "min", "at min", "max", "at max"]
    for one in studied:
        failed = one.numbers.failed
        lines += [f"{one.name}: {one.points} points, {len(failed)} failed. {one.about}".rstrip()]
        lines += [table(one.rows, columns, named=["name"])] if one.rows else []
        lines += [f"failed: {gap.reason}" for gap in failed[:3]] + [""]
    return "\n".join(lines)

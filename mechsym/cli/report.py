"""`mechsym report`: everything that is known of a case, or of several side by side, as one page."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym.cases import told_apart
from mechsym.cli.common import case_of, emit, file_in, file_option, json_option, listed, pairs, progress, set_option
from mechsym.errors import BadInput, suggest

if TYPE_CHECKING:
    from mechsym.report.build import CaseReport


@click.command(short_help="Cycle, hinge, forces, sizes and run of a case as one report.")
@click.argument("cases", metavar="CASE..", nargs=-1, required=True)
@click.option("--parts", metavar="A,B..", help="Only these: cycle, hinge, forces, size, simulate.")
@click.option("--date", default="", metavar="TEXT", help="Date for the title block; without it there is none.")
@click.option("--pdf", is_flag=True, help="Print the report to PDF as well; needs a Chromium.")
@file_option("CASE-report.html", ".html", ".htm")
@set_option
@json_option
@click.pass_context
def report(ctx: click.Context, cases: tuple[str, ...], parts: str | None, date: str, pdf: bool, out: Path | None,
           overrides: tuple[str, ...]) -> None:  # fmt: skip
    """Report of CASE, or of several side by side: the answer on the first page, then figures, tables, data with origin.

    Parts that the case has no sections for are named and left out; one that fails is named on the first page, and the
    rest is there. With the extra web the page simulates the engine at its end; without, it says so. [report] project,
    engine, author, date and units go into the title block. Exit status 1 when a design is infeasible or a run did not
    converge, 2 when a part was refused; the report is written all the same.

    \b
    Examples: mechsym report zotov-89
              mechsym report nunes-slider-crank nunes-hypocycloid --parts cycle,forces --out both
              mechsym report mine.toml --pdf --date 2026-11-22 --units "bar, kN, mm"
    """
    from mechsym.files import write_text
    from mechsym.jobs.export import ready
    from mechsym.out.pdf import chromium, to_pdf
    from mechsym.out.web import LiveRun, with_live
    from mechsym.papers.sources import sources
    from mechsym.report import case_report, html
    from mechsym.report.build import called
    from mechsym.report.numbers import numbers
    from mechsym.report.parts import PARTS, doubts_of

    wanted = listed(parts, "--parts") if parts is not None else list(PARTS)
    for word in wanted:
        if word not in PARTS:
            raise BadInput(f"--parts {parts}: {word!r} is no part of a report; {suggest(word, tuple(PARTS))}")
    wanted = [name for name in PARTS if name in wanted]
    if pdf:
        chromium()  # said before the work begins
    titles = {one.stem: one.title for one in sources()}
    loaded = told_apart([case_of(name, pairs(overrides)) for name in cases])
    with progress(len(loaded) * len(wanted) + 1, "report") as bar:
        reports = []
        for case in loaded:
            title = f"own {called(case)}" if case.source == "own" else case.source
            reports.append(case_report(case, tuple(wanted), titles.get(title, title), lambda: bar.update(1)))
        usual = "-".join([*(case.name.replace("/", "-") for case in loaded), "report.html"])
        path = file_in(out, usual, ".html", ".htm")
        text = html(reports, date)
        live = [
            LiveRun(name=case.name, about=case.about, ready=partial(ready, case, command="page")) for case in loaded
        ]
        files = [write_text(path, with_live(text, live))]
        if pdf:
            files.append(to_pdf(text, path.with_suffix(".pdf")))
        bar.update(1)
    doubts = [doubt for one in reports for p in one.parts for doubt in doubts_of(p)]
    emit(numbers(reports, files), lambda: _text(reports), beside={"doubts": doubts}, files=files)
    refused, infeasible = (any(getattr(one, kind) for one in reports) for kind in ("refused", "infeasible"))
    ctx.exit(2 if refused else 1 if infeasible else 0)


def _text(reports: "list[CaseReport]") -> str:
    from mechsym.report.parts import answer

    lines = []
    for one in reports:
        first = answer(one.case, one.parts)
        lines += [f"{one.case.name} ({one.source})"]
        lines += [f"  {finding.line}" for finding in first.findings]
        lines += [f"  {'! ' if mark else ''}{sentence}" for mark, sentence in first.verdicts]
        lines += [f"  limits: {text}" for text in first.limits]
        lines += [f"  left out: {text}" for text in first.absent]
    return "\n".join(lines)

"""The page that simulates inside a report: a section of its own, or a sentence that says why there is none."""

import html
from collections.abc import Sequence
from pathlib import Path

from mechsym.cases import Case
from mechsym.errors import BadInput, MissingExtra
from mechsym.files import write_text
from mechsym.jobs.export import ready
from mechsym.native.compiler import NoCompiler
from mechsym.out.laws import block_of
from mechsym.out.web.build import page

_END = "</body>"


def with_live(text: str, cases: Sequence[Case], diagram: str | None = None) -> str:
    """The text of a report with a section for each case at its end."""
    head, end, tail = text.rpartition(_END)
    return "".join([head, *(section(case, diagram) for case in cases), end, tail])


def add_live(report: Path, case: Case, diagram: str | None = None) -> None:
    """Add the section to the file of a report, where there is one."""
    if report.exists():
        write_text(report, with_live(report.read_text(encoding="utf-8"), [case], diagram))


def section(case: Case, diagram: str | None = None) -> str:
    """A section in which the machine of a case simulates; where it cannot, what is missing."""
    title = f'<h2 id="live-{html.escape(case.name)}">Try it: {html.escape(case.name)} simulates here</h2>'
    try:
        made = page(block_of(case.name, case.about, ready(case, diagram)))
    except (MissingExtra, NoCompiler, BadInput) as missing:
        return f'{title}<p class="note">Not in this report: {html.escape(str(missing))}</p>\n'
    frame = f'<iframe title="{html.escape(case.name)} simulates" srcdoc="{html.escape(made)}"'
    return f'{title}{frame} style="width:100%;height:56rem;border:0;background:#fff"></iframe>\n'

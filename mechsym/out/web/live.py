"""The page that simulates inside a report: a section of its own, or a sentence that says why there is none."""

import html
from collections.abc import Callable, Sequence

from mechsym.errors import BadInput, MissingExtra
from mechsym.jobs.problem import Ready
from mechsym.out.laws import block_of
from mechsym.out.web.build import page
from mechsym.quantities import record

_END = "</body>"
# as high as what it shows, which changes with the width of the page
_FIT = "const b=this.contentDocument.body;new ResizeObserver(()=>{this.style.height=b.scrollHeight+48+'px'}).observe(b)"


@record
class LiveRun:
    """A run that a report is to carry."""

    name: str
    about: str
    ready: Callable[[], Ready]  #: makes it ready, or refuses


def with_live(text: str, runs: Sequence[LiveRun]) -> str:
    """The text of a report with a section for each run at its end."""
    head, end, tail = text.rpartition(_END)
    return "".join([head, *map(section, runs), end, tail])


def section(run: LiveRun) -> str:
    """A section in which a machine simulates; where it cannot, what is missing."""
    name = html.escape(run.name)
    title = f'<h2 id="live-{name}">Try it: {name} simulates here</h2>'
    try:
        made = page(block_of(run.name, run.about, run.ready()))
    except (MissingExtra, BadInput) as missing:
        return f'{title}<p class="note">Not in this report: {html.escape(str(missing))}</p>\n'
    frame = f'<iframe title="{name} simulates" srcdoc="{html.escape(made)}"'
    return f'{title}{frame} style="width:100%;height:56rem;border:0" onload="{_FIT}"></iframe>\n'

"""One HTML page of formulas that were audited; it opens offline."""

from collections.abc import Sequence

from mechsym.audit.findings import Row
from mechsym.page import page
from mechsym.quantities.display import ratio_text


def html(title: str, summary: str, rows: Sequence[Row]) -> str:
    """The page as text: what is printed, what it was compared with, verdict, correction and note."""
    return page("audit.html", title=title, summary=summary, rows=rows, ratio=ratio_text)

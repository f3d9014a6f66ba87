"""One HTML page of formulas that were audited; it opens offline."""

from collections.abc import Sequence

from mechsym.audit.findings import Row
<<<<<<< HEAD
from mechsym.style import page
=======
from mechsym.page import page
>>>>>>> 42f4cc5 (mechsym report: cases on one page, the answer first; results show themselves; one template for all pages)


def html(title: str, summary: str, rows: Sequence[Row]) -> str:
    """The page as text: what is printed, what it was compared with, verdict, correction and note."""
<<<<<<< HEAD
    return page("audit.html", missing="Chainable", title=title, summary=summary, rows=rows)
=======
    return page("audit.html", title=title, summary=summary, rows=rows)
>>>>>>> 42f4cc5 (mechsym report: cases on one page, the answer first; results show themselves; one template for all pages)

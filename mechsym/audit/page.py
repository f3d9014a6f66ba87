"""One HTML page of formulas that were audited; it opens offline."""

from collections.abc import Sequence
from importlib import resources

from mechsym.audit.findings import Row


def html(title: str, summary: str, rows: Sequence[Row]) -> str:
    """The page as text: what is printed, what it was compared with, verdict, correction and note."""
    import jinja2

    source = (resources.files("mechsym") / "templates" / "audit.html").read_text(encoding="utf-8")
    environment = jinja2.Environment(undefined=jinja2.ChainableUndefined, autoescape=True, trim_blocks=True)
    return environment.from_string(source).render(title=title, summary=summary, rows=rows)

"""The papers: every formula as printed, and every published number and figure beside what the models give.

sources.py   the papers by name; a paper is a folder here, and nothing else lists it
rows.py      a row of a reproduction: published, computed, verdict, note; the recorded verdicts and values: a finding
             is a result, only a changed one is a failure
page.py      CSV, HTML and pictures of a run, the angle axis of its figures

A paper's folder:

__init__.py  SOURCE: stem, name, title, tolerance of its record
printed.toml its formulas and claims in the order of the text, for the auditor
numbers.toml its published numbers: what they are, as printed, and a note
rows.py      rows(): what is computed for them; what decides a claim (or in claims.py beside it)
figures.py   figures(): its figures by name, drawn from the computation
"""

from mechsym.papers.rows import KEYS, VERDICTS, Row, by_digits, claim, row
from mechsym.papers.sources import Source, sources

__all__ = ["KEYS", "VERDICTS", "Row", "Source", "by_digits", "claim", "row", "sources"]


def __dir__() -> list[str]:
    return __all__

"""What pages and notebooks share: one template, and how a result shows itself.

template    pages from `mechsym/templates`, all with one head, light, dark and for print
view        cards, pictures and columns of a result; `Shown` gives a result `_repr_html_`, `plot` and `table`
finding     what a reader has to know before any figure, the worst first
table       a table of a page; columns with units, for pandas and xarray where they are installed
"""

from mechsym.page.finding import Finding, ranked, title_mark
from mechsym.page.table import Grid, ResultTable, grid
from mechsym.page.template import page
from mechsym.page.view import Card, Picture, Shown, ShownFigures, View, card, cards, shows

__all__ = [
    "Card", "Finding", "Grid", "Picture", "ResultTable", "Shown", "ShownFigures", "View", "card", "cards", "grid",
    "page", "ranked", "shows", "title_mark",
]  # fmt: skip


def __dir__() -> list[str]:
    return __all__

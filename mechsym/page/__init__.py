"""What pages and notebooks share: one template, and how a result shows itself.

template    pages from `mechsym/templates`, all with one head, light, dark and for print
view        cards, pictures and columns of a result; `Shown` gives a result `_repr_html_`, `plot` and `table`
grid        a table of a page
table       columns with units, for pandas and xarray where they are installed
"""

from mechsym.page.grid import Grid, grid
from mechsym.page.table import ResultTable
from mechsym.page.template import page
from mechsym.page.view import Card, Picture, Shown, ShownFigures, View, shows

__all__ = ["Card", "Grid", "Picture", "ResultTable", "Shown", "ShownFigures", "View", "grid", "page", "shows"]


def __dir__() -> list[str]:
    return __all__

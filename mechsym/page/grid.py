"""A table of a page: headings with units, cells as text."""

from collections.abc import Mapping, Sequence
from typing import Any

from mechsym.quantities import record
from mechsym.quantities.display import column_text, heading

_PHONE = 40  # characters of a row on a phone


@record
class Grid:
    """A table of a page, all text."""

    title: str
    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numbers: tuple[bool, ...]  #: Columns that are set to the right

    @property
    def stacked(self) -> bool:
        """Whether a phone shows each row as a block: where columns beside each other would be cut."""
        return sum(max((len(row[i]) for row in self.rows), default=0) for i in range(len(self.headings))) > _PHONE


def grid(
    title: str, rows: Sequence[Mapping[str, Any]], columns: Sequence[str], units: Mapping[str, str] | None = None
) -> Grid:
    """Rows as a table, each column in the unit that suits it.

    Parameters
    ----------
    units : mapping of str to str, optional
        SI unit of columns whose name does not tell it

    Examples
    --------
    >>> grid("Loads", [{"force": 2000.0}], ["force"]).headings
    ('force [kN]',)
    """
    headed = [heading(c, [row.get(c) for row in rows], unit=(units or {}).get(c)) for c in columns]
    shown = [["–" if text == "-" else text for text in column_text(values)] for _, values in headed]
    cells = [tuple(column[i] for column in shown) for i in range(len(rows))]
    number = tuple(any(isinstance(v, (int, float)) for v in values) for _, values in headed)
    names = tuple(name.replace("_", " ") for name, _ in headed)
    return Grid(title=title, headings=names, rows=tuple(cells), numbers=number)

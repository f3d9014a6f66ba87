"""Columns of a result with their units, and the way to pandas and xarray.

A table of a page: headings with units, cells as text.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from mechsym.errors import MissingExtra
from mechsym.quantities import record
from mechsym.quantities.display import column_text, heading, key_words, shown_in, stem_and_unit, without_unit

if TYPE_CHECKING:
    import pandas
    import xarray

Column: TypeAlias = Sequence[float] | np.ndarray
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
        words = (max(map(len, heading.split()), default=0) for heading in self.headings)  # between which it breaks
        cells = (max((len(row[i]) for row in self.rows), default=0) for i in range(len(self.headings)))
        return sum(map(max, words, cells)) > _PHONE


def grid(
    title: str, rows: Sequence[Mapping[str, object]], columns: Sequence[str], units: Mapping[str, str] | None = None
) -> Grid:
    """Rows as a table, each column in the unit that suits it.

    units: SI unit of columns whose name does not tell it.

    >>> grid("Loads", [{"force": 2000.0}], ["force"], {"force": "N"}).headings
    ('force [kN]',)
    """
    headed = [heading(c, [row.get(c) for row in rows], unit=(units or {}).get(c)) for c in columns]
    shown = [["–" if text == "-" else text for text in column_text(values)] for _, values in headed]
    cells = [tuple(column[i] for column in shown) for i in range(len(rows))]
    number = tuple(any(isinstance(v, (int, float)) for v in values) for _, values in headed)
    named = (name.partition(" [") for name, _ in headed)
    names = tuple(key_words(stem) + bracket + unit for stem, bracket, unit in named)
    return Grid(title=title, headings=names, rows=tuple(cells), numbers=number)


_FIRST = 8  # rows that a notebook shows


class ResultTable(Mapping[str, np.ndarray]):
    """Columns by heading, `force [N]`, in SI unless units were chosen."""

    def __init__(self, columns: Mapping[str, Column]) -> None:
        units = getattr(columns, "units", {})
        headed = (_headed(name, values, units.get(name, "")) for name, values in columns.items())
        self._columns = {name: np.asarray(values) for name, values in headed}

    def __getitem__(self, name: str) -> np.ndarray:
        """A column by its heading, or by its name without the unit."""
        if name in self._columns:
            return self._columns[name]
        keys = [key for key in self._columns if key.partition(" [")[0] == name]
        if not keys:
            raise KeyError(name)
        return self._columns[keys[0]]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        names = ", ".join(self._columns)
        text = f"ResultTable of {self._rows} rows: {names}"
        return text if len(text) < 400 else f"{text[:394]} ..."

    @property
    def _rows(self) -> int:
        return max((len(v) for v in self._columns.values() if v.ndim), default=0)

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{name}</th>" for name in self._columns)
        cells = zip(*(_cells(v, min(self._rows, _FIRST)) for v in self._columns.values()), strict=True)
        body = "".join(f"<tr>{''.join(f'<td>{cell}</td>' for cell in row)}</tr>" for row in cells)
        rest = f"<p>{_FIRST} of {self._rows} rows</p>" if self._rows > _FIRST else ""
        return f"<table><tr>{head}</tr>{body}</table>{rest}"

    def to_pandas(self) -> "pandas.DataFrame":
        """A pandas.DataFrame with these headings."""
        try:
            import pandas
        except ImportError:
            raise MissingExtra("pandas is not installed; python -m pip install pandas") from None
        return pandas.DataFrame(self._columns)

    def to_xarray(self) -> "xarray.Dataset":
        """An xarray.Dataset over the rows, units as attributes."""
        try:
            import xarray
        except ImportError:
            raise MissingExtra("xarray is not installed; python -m pip install 'mechsym[netcdf]'") from None
        named = {key: key.partition(" [") for key in self._columns}
        return xarray.Dataset(
            {name: ("row", self._columns[key], {"units": unit.rstrip("]")}) for key, (name, _, unit) in named.items()}
        )


def _headed(name: str, values: Column, unit: str) -> tuple[str, Column]:
    """Name with its unit in brackets, and the values in it."""
    if "[" in name:
        return name, values
    stem, unit = (without_unit(name, unit), unit) if unit else stem_and_unit(name)
    if not unit or any(isinstance(v, str) for v in values):
        return name, values
    shown, chosen = shown_in(values, unit, asked=True)
    return f"{stem} [{chosen}]", shown


def _cells(values: np.ndarray, rows: int) -> list[str]:
    """The first cells of a column, empty where it is shorter."""
    shown = column_text(list(values[:rows]) if values.ndim else [])
    return shown + [""] * (rows - len(shown))

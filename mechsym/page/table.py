"""Columns of a result with their units, and the way to pandas and xarray."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from mechsym.errors import MissingExtra
from mechsym.quantities.display import column_text, shown_in
from mechsym.quantities.names import stem_and_unit

_FIRST = 8  # rows that a notebook shows


class ResultTable(Mapping[str, Any]):
    """Columns by heading, `force [N]`, in SI unless units were chosen."""

    def __init__(self, columns: Mapping[str, Any]) -> None:
        headed = (_headed(name, values) for name, values in columns.items())
        self._columns = {name: np.asarray(values) for name, values in headed}

    def __getitem__(self, name: str) -> Any:
        """A column by its heading, or by its name without the unit."""
        if name in self._columns:
            return self._columns[name]
        found = [key for key in self._columns if key.partition(" [")[0] == name]
        if not found:
            raise KeyError(name)
        return self._columns[found[0]]

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

    def to_pandas(self) -> Any:
        """A pandas.DataFrame with these headings."""
        try:
            import pandas
        except ImportError:
            raise MissingExtra("pandas is not installed; python -m pip install pandas") from None
        return pandas.DataFrame(self._columns)

    def to_xarray(self) -> Any:
        """An xarray.Dataset over the rows, units as attributes."""
        try:
            import xarray
        except ImportError:
            raise MissingExtra("xarray is not installed; python -m pip install 'mechsym[netcdf]'") from None
        named = {key: key.partition(" [") for key in self._columns}
        return xarray.Dataset({
            name: ("row", self._columns[key], {"units": unit.rstrip("]")}) for key, (name, _, unit) in named.items()
        })  # fmt: skip


def _headed(name: str, values: Any) -> tuple[str, Any]:
    """Name with its unit in brackets, and the values in it."""
    if "[" in name:
        return name, values
    stem, unit = stem_and_unit(name)
    if not unit or any(isinstance(v, str) for v in values):
        return name, values
    shown, found = shown_in(values, unit, asked=True)
    return f"{stem} [{found}]", shown


def _cells(values: np.ndarray, rows: int) -> list[str]:
    """The first cells of a column, empty where it is shorter."""
    shown = column_text(list(values[:rows]) if values.ndim else [])
    return shown + [""] * (rows - len(shown))

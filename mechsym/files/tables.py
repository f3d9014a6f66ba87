"""Tables in text files of the user's: comments, a header with units, rows of numbers; refused with their line."""

import csv
import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from mechsym.errors import BadInput, suggest
from mechsym.files.inputs import read_text
from mechsym.quantities import parse

_DELIMITERS = (";", "\t", ",")
_COMMA = re.compile(r"^[+-]?\d+,\d+([eE][+-]?\d+)?$")
BEYOND = 1e30  #: no sensor reads it in any unit: a logger's mark of a value that is not there


def text_of(path: str | Path) -> str:
    """Text of a table's file."""
    return read_text(path, way_out="give the path of a CSV text file", encoding="utf-8-sig")


def split_table(file: str, text: str) -> tuple[list[str], tuple[int, list[str]], list[tuple[int, list[str]]]]:
    """Comments, header and rows of a table, the last two with their lines in the file."""
    comments, table = [], []
    for line, content in enumerate(text.splitlines(), start=1):
        if content.lstrip().startswith("#"):
            comments.append(content.lstrip().lstrip("#").strip())
        elif content.strip():
            table.append((line, content))
    if not table:
        raise BadInput(
            f"{file}: holds no data; it needs a header like crank_angle_deg,pressure_bar and one row a sample"
        )
    delimiter = next((d for d in _DELIMITERS if d in table[0][1]), ",")
    # one reader a line: an unbalanced quotation mark must not swallow the rows below it
    cells = [next(csv.reader([content], delimiter=delimiter)) for _, content in table]
    rows = [(line, [cell.strip() for cell in row]) for (line, _), row in zip(table, cells, strict=True)]
    if delimiter != ",":  # a comma stands for the point where it divides no columns
        rows = [(line, [cell.replace(",", ".") if _COMMA.match(cell) else cell for cell in row]) for line, row in rows]
    if len(rows) > 2 and len(rows[1][1]) == len(rows[0][1]) and not any(map(_is_number, rows[1][1])):
        # a second line of units, as loggers write it
        named = [f"{name} [{unit.strip('[]()')}]" for name, unit in zip(rows[0][1], rows[1][1], strict=True)]
        rows = [(rows[0][0], named), *rows[2:]]
    if all(_is_number(cell) for cell in rows[0][1]):
        raise BadInput(
            f"{file}, line {rows[0][0]}: numbers where the header should be; "
            "write a first line that names the columns and their units, for example crank_angle_deg,pressure_bar"
        )
    if len(rows) < 2:
        raise BadInput(f"{file}: no row follows the header in line {rows[0][0]}; one row a sample is needed")
    return comments, rows[0], rows[1:]


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def numbers_of(file: str, rows: list[tuple[int, list[str]]], names: list[str], at: tuple[int, ...]) -> np.ndarray:
    """Columns of a table as numbers, shape (rows, columns), in the units of its header [as headed]."""
    values = np.empty((len(rows), len(at)))
    for row, (line, cells) in enumerate(rows):
        if len(cells) != len(names):
            raise BadInput(
                f"{file}, line {line}: {len(cells)} values for {len(names)} columns; mend or delete the line "
                "(a decimal comma needs ';' between the columns and a point in the numbers)"
            )
        for k, column in enumerate(at):
            if not _is_number(cells[column]):
                raise BadInput(
                    f"{file}, line {line}: {names[column]} = {cells[column]!r} is not a number; mend the line"
                )
            values[row, k] = float(cells[column])
            if not abs(values[row, k]) < BEYOND:
                raise BadInput(
                    f"{file}, line {line}: {names[column]} = {cells[column]} is not finite, or no measured value; "
                    "cut the record so that no sample is missing"
                )
    return values


def columns_of(file: str, units: Mapping[str, str], what: str) -> tuple[dict[str, np.ndarray], list[int]]:
    """Columns of a file in SI by name, headed `name [unit]`, and the line of each row.

    units: of the names that it may have [SI]; what: other names are, for the message.
    """
    _, (line, names), rows = split_table(file, text_of(file))
    values, columns = numbers_of(file, rows, names, tuple(range(len(names)))), {}
    for name, column in zip(names, values.T, strict=True):
        head, _, unit = (part.strip() for part in name.rstrip("] ").partition("["))
        if head not in units or head in columns:
            why = "stands twice" if head in columns else what
            raise BadInput(f"{file}, line {line}: column {name!r} {why}; {suggest(head, list(units))}")
        columns[head] = column * parse(f"1 {unit or units[head]}", units[head], f"{file}, line {line}: unit of {head}")
    return columns, [at for at, _ in rows]

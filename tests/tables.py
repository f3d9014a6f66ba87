"""Tables as the program writes them, read by the names of their columns without the units."""

import csv

import numpy as np


def read_table(path):
    """Columns by name, and the unit of each."""
    with open(path, encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    names, units = zip(*(_parts(cell) for cell in header), strict=True)
    values = np.array([[float(cell) if cell else np.nan for cell in row] for row in rows])
    return dict(zip(names, values.T, strict=True)), dict(zip(names, units, strict=True))


def _parts(cell):
    stem, bracket, rest = cell.partition(" [")
    return stem, rest.rstrip("]") if bracket else ""

"""Functions of a mechanism at many points: numpy's where there are many, CasADi's interpreter for a few."""

from collections.abc import Callable, Mapping, Sequence

import casadi as ca
import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities.units import Scalar

_MANY = 100  # points from which on numpy is quicker than CasADi, which takes ten microseconds for each


def along(function: ca.Function, letters: Mapping[str, Scalar]) -> dict[str, np.ndarray]:
    """A function of scalars at many points.

    letters: mapping of str to float or ndarray, shape (n,), by input name; what is not named is 0 [SI]. Returns values:
    by output name [SI].
    """
    names = function.name_in()
    if unknown := sorted(set(letters) - set(names)):
        raise BadInput(f"{function.name()} takes no {', '.join(unknown)}; it takes {', '.join(names)}")
    rows = {n: np.atleast_1d(np.asarray(v, dtype=float))[None, :] for n, v in letters.items()}
    count = max((row.shape[1] for row in rows.values()), default=1)
    sizes = [(function.size1_out(i), function.size2_out(i)) for i in range(function.n_out())]
    if batch := over_arrays(function, count):
        return dict(zip(function.name_out(), _split(batch(*(rows.get(n, 0.0) for n in names)), sizes), strict=True))
    found = function.call([ca.DM(rows[n]) if n in rows else 0.0 for n in names])
    shaped = [_angle_last(np.asarray(v), size, count) for v, size in zip(found, sizes, strict=True)]
    return dict(zip(function.name_out(), shaped, strict=True))


def over_arrays(function: ca.Function, count: int) -> Callable[..., np.ndarray] | None:
    """A function as numpy's, where that is quicker: arrays (n,) and numbers to an array (outputs, n); else None."""
    if count < _MANY:
        return None
    from mechsym.native.evaluate import arrays  # who asks for one state does not load it

    return arrays(function)


def _split(table: np.ndarray, sizes: Sequence[tuple[int, int]]) -> list[np.ndarray]:
    """Outputs from the rows of a table, the elements of each column by column."""
    ends = np.cumsum([rows * columns for rows, columns in sizes])[:-1]
    shaped = []
    for part, (rows, columns) in zip(np.split(table, ends), sizes, strict=True):
        shape = tuple(n for n in (rows, columns) if n > 1)
        shaped.append(part.reshape(columns, rows, -1).transpose(1, 0, 2).reshape(*shape, part.shape[1]))
    return shaped


def _angle_last(values: np.ndarray, size: tuple[int, int], count: int) -> np.ndarray:
    """What CasADi lays side by side, point by point, with the points as the last axis."""
    rows, columns = size
    points = values.reshape(rows, -1, columns).transpose(0, 2, 1)
    shape = tuple(n for n in size if n > 1)
    return np.broadcast_to(points, (*size, count)).reshape(*shape, count)


_FEW = 8  # equations up to which blocks are not worth the while


def solved(A: ca.SX, b: ca.SX) -> ca.SX:
    """The solution of linear equations; of many, block after block of those that do not wait for one another."""
    if A.shape[0] <= _FEW:
        return ca.solve(A, b)
    A, x = ca.sparsify(A), ca.SX(*b.shape)
    count, rows, columns, at, *_ = A.sparsity().btf()
    for k in range(count):
        row, column = rows[at[k] : at[k + 1]], columns[at[k] : at[k + 1]]
        before = columns[: at[k]]
        right = b[row, :] - ca.mtimes(A[row, before], x[before, :]) if before else b[row, :]
        x[column, :] = ca.solve(ca.densify(A[row, column]), right)
    return x

r"""Functions of a mechanism at many points: numpy's where there are many, CasADi's interpreter for a few.

Reactions of the joints that close loops: the multipliers of the constraints, from the dependent rows.

.. math:: J_d^T \mu = (M \ddot q + h - Q)_d
"""

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
    values = function.call([ca.DM(rows[n]) if n in rows else 0.0 for n in names])
    shaped = [_angle_last(np.asarray(v), size, count) for v, size in zip(values, sizes, strict=True)]
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


def with_multipliers(functions: Mapping[str, ca.Function], dependents: Sequence[str]) -> ca.Function:
    """Reactions whose multipliers are worked out from the dependent rows, with the driving force of each other row.

    functions: of a mechanism; `joints` are its reactions with the multipliers as inputs. dependents: as many
    coordinates as there are constraints. Returns reactions: same inputs without the multipliers; outputs also
    `driving_<coordinate>` [N*m] or [N].
    """
    raw, dynamics, constraints = (functions[n] for n in ("joints", "dynamics", "constraints"))
    q = constraints.name_in()[: dynamics.size1_out(0)]
    multipliers = [n for n in raw.name_in() if n not in {*dynamics.name_in(), *(f"{name}dd" for name in q)}]
    names = [n for n in raw.name_in() if n not in multipliers]
    letters = {n: ca.SX.sym(n) for n in names}
    mass, bias, force = dynamics(*(letters[n] for n in dynamics.name_in()))
    held, rest = [i for i, n in enumerate(q) if n in dependents], [i for i, n in enumerate(q) if n not in dependents]
    _, jacobian, _ = constraints(*(letters[n] for n in constraints.name_in()))
    needed = ca.mtimes(mass, ca.vertcat(*(letters[f"{n}dd"] for n in q))) + bias - force
    mu = solved(jacobian[:, held].T, needed[held])
    values = raw(**letters, **dict(zip(multipliers, ca.vertsplit(mu), strict=True)))
    values |= {f"driving_{q[i]}": needed[i] - ca.mtimes(jacobian[:, [i]].T, mu) for i in rest}
    return ca.Function("reactions", list(letters.values()), list(values.values()), names, list(values))

r"""Reactions of the joints that close loops: the multipliers of the constraints, from the dependent rows.

.. math:: J_d^T \mu = (M \ddot q + h - Q)_d
"""

from collections.abc import Mapping, Sequence

import casadi as ca

from mechsym.mechanisms.arrays import solved


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
    found = raw(**letters, **dict(zip(multipliers, ca.vertsplit(mu), strict=True)))
    found |= {f"driving_{q[i]}": needed[i] - ca.mtimes(jacobian[:, [i]].T, mu) for i in rest}
    return ca.Function("reactions", list(letters.values()), list(found.values()), names, list(found))

"""Theories of mechanisms: the tape that a derivation makes, with its joints closed, and what follows from it."""

from collections.abc import Mapping
from typing import Any

from sympy import Expr, Integer, Matrix, Symbol

from mechsym.audit.theory.conversion import tape_of
from mechsym.audit.theory.record import Letter, Theory
from mechsym.derive import Equations, Mechanism, velocities
from mechsym.derive.rates import accelerations

_SIGNED = ("offset",)  # lengths that may lie on either side

Results = Mapping[str, tuple[Any, str]]  # name: (expression, unit)


def mechanism_theory(
    equations: Equations, values: Mapping[str, float], rods: tuple[str, ...], data: str, more: Results
) -> Theory:
    """The theory of a derived mechanism.

    Parameters
    ----------
    values : mapping of str to float
        Values of parameters, coordinates, velocities, accelerations and inputs; 1 where none is given
    rods : tuple of str
        Lengths that grow without limit when lambda goes to zero
    more : mapping of str to (Expr, str)
        Further results in the names of the tape, with their units

    Returns
    -------
    theory : Theory
        Kinematics, energies, dynamics, reactions and further results
    """
    m = equations.mechanism
    results = _results(equations) | {name: expression for name, (expression, _) in more.items()}
    closed = dict.fromkeys(m.joint_list, Integer(0))
    entries = {s.name: m.tape.entries[s].xreplace(closed) for s in m.tape.needed(results.values())}
    own = {n: e.xreplace(closed) for n, e in results.items() if n not in entries}
    return Theory(
        name=m.name,
        letters=_letters(m, values),
        tape=tape_of(entries | own),
        results=tuple(results),
        units=m.units | _units(m) | {name: unit for name, (_, unit) in more.items()},
        angle=m.q[0].name,
        rods=rods,
        data=data,
    )


def _letters(m: Mechanism, values: Mapping[str, float]) -> dict[str, Letter]:
    free = [*m.q, *velocities(m), *accelerations(m), *m.parameter_list, *m.input_list]
    units = m.units | _units(m)
    return {
        s.name: Letter(
            unit=units[s.name], value=float(values.get(s.name, 1.0)), sign="any" if s.name in _SIGNED else ""
        )
        for s in free
    }


def _units(m: Mechanism) -> dict[str, str]:
    rates = {s.name: "rad/s" for s in velocities(m)} | {s.name: "rad/s^2" for s in accelerations(m)}
    return rates | {"kinetic_energy": "J", "potential_energy": "J"}


def _results(equations: Equations) -> dict[str, Expr]:
    m = equations.mechanism
    found = dict(equations.kinematics) | dict(equations.reactions)
    if equations.kinetic_energy is not None and equations.potential_energy is not None:
        found |= {"kinetic_energy": equations.kinetic_energy, "potential_energy": equations.potential_energy}
    for q, bias, force in zip(m.q, equations.bias, equations.generalized_force, strict=True):
        found |= {f"bias_{q.name}": bias, f"force_{q.name}": force}
    if len(m.q) == 1:
        found |= {"bias": equations.bias[0], "generalized_force": equations.generalized_force[0]}
        found |= {"acceleration": solved_accelerations(equations)[0]}
    return found | residuals(equations)


def solved_accelerations(equations: Equations) -> list[Expr]:
    r"""Accelerations :math:`\ddot q = M^{-1}(Q - h)`.

    Returns
    -------
    accelerations : list of Expr
        In the order of the coordinates
    """
    right = [f - b for f, b in zip(equations.generalized_force, equations.bias, strict=True)]
    return list(Matrix(equations.mass_matrix).LUsolve(Matrix(right)))


def residuals(equations: Equations) -> dict[str, Expr]:
    r"""The equations of motion as sums that vanish, :math:`Q - M \ddot q - h`."""
    m = equations.mechanism
    qdd = accelerations(m)
    rows = zip(m.q, equations.mass_matrix, equations.bias, equations.generalized_force, strict=True)
    return {
        f"residual_{q.name}": force - bias - sum((a * b for a, b in zip(row, qdd, strict=True)), Integer(0))
        for q, row, bias, force in rows
    }


def without(expression: Expr, *letters: str) -> Expr:
    """An expression with some letters left out."""
    return expression.xreplace({Symbol(n, real=True): Integer(0) for n in letters})

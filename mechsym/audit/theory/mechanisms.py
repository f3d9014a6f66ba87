"""Theories of the mechanisms: the tapes that their derivations make, with joints closed, and what follows from them."""

from collections.abc import Mapping

from sympy import Expr, Integer, Matrix

from mechsym.audit.theory.record import Letter, Theory, tape_of
from mechsym.derive import Equations, Mechanism, derive


def mechanism_theory(declared: Mechanism, values: Mapping[str, float], rods: tuple[str, ...], data: str) -> Theory:
    """The theory of a declared mechanism.

    Parameters
    ----------
    declared : Mechanism
        Declaration of a derivation script
    values : mapping of str to float
        Values of parameters, coordinates, velocities, accelerations and inputs; 1 where none is given
    rods : tuple of str
        Lengths that grow without limit when lambda goes to zero
    data : str
        Where the values come from

    Returns
    -------
    theory : Theory
        Kinematics, energies, dynamics and reactions
    """
    equations = derive(declared)
    results = _results(equations)
    closed = dict.fromkeys(declared.joint_list, Integer(0))
    needed = declared.tape.needed(results.values())
    entries = {s.name: declared.tape.entries[s].xreplace(closed) for s in needed}
    own = {n: e.xreplace(closed) for n, e in results.items() if n not in entries}
    return Theory(
        name=declared.name,
        letters=_letters(declared, values),
        tape=tape_of(entries | own),
        results=tuple(results),
        units=declared.units | _units(declared),
        angle=declared.q[0].name,
        rods=rods,
        data=data,
    )


def _letters(m: Mechanism, values: Mapping[str, float]) -> dict[str, Letter]:
    free = [*m.q, *m.velocities(), *m.accelerations(), *m.parameter_list, *m.input_list]
    units = m.units | _units(m)
    return {s.name: Letter(unit=units[s.name], value=float(values.get(s.name, 1.0))) for s in free}


def _units(m: Mechanism) -> dict[str, str]:
    rates = {s.name: "rad/s" for s in m.velocities()} | {s.name: "rad/s^2" for s in m.accelerations()}
    return rates | {"kinetic_energy": "J", "potential_energy": "J"}


def _results(equations: Equations) -> dict[str, Expr]:
    m = equations.mechanism
    found = dict(equations.kinematics) | dict(equations.reactions)
    if equations.kinetic_energy is not None and equations.potential_energy is not None:
        found |= {"kinetic_energy": equations.kinetic_energy, "potential_energy": equations.potential_energy}
    rows = zip(m.q, equations.bias, equations.generalized_force, strict=True)
    for q, bias, force in rows:
        found |= {f"bias_{q.name}": bias, f"force_{q.name}": force}
    if len(m.q) == 1:
        found |= {"bias": equations.bias[0], "generalized_force": equations.generalized_force[0]}
    return found | _accelerations(equations)


def _accelerations(equations: Equations) -> dict[str, Expr]:
    mass, m = Matrix(equations.mass_matrix), equations.mechanism
    right = Matrix([f - b for f, b in zip(equations.generalized_force, equations.bias, strict=True)])
    solved = mass.LUsolve(right)
    return {f"acceleration_{q.name}": solved[i] for i, q in enumerate(m.q)} | (
        {"acceleration": solved[0]} if len(m.q) == 1 else {}
    )

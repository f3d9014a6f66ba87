"""Theory of the rodless mechanism of source 003: inertia forces on the four rod journals, two on each axis."""

from collections.abc import Mapping
from dataclasses import replace

from mechsym.audit.theory.mechanisms import mechanism_theory
from mechsym.audit.theory.record import Letter, Theory, extended
from mechsym.audit.tree import Node, name, number
from mechsym.derive import derive
from mechsym.derive.build import declared


def rodless(values: Mapping[str, float], data: str) -> Theory:
    """Inertia forces of the reciprocating masses and the load of one journal.

    Returns
    -------
    theory : Theory
        `P_jx` and `P_jy` have one value per journal, the masses may differ; in the names that end in `_equal` all are
        m. The source's y is the axis of the slider at angle 0, its x the other one
    """
    known = {"r": 0.04, "alpha": 1.0, "alphad": 300.0, "alphadd": 0.0} | dict(values)
    base = mechanism_theory(derive(declared("rodless")), known, (), data, {})
    masses = {f"m_{i}": Letter(unit="kg", value=1.0 + 0.1 * i) for i in range(1, 5)}
    loads = {k: Letter(unit="N", value=v) for k, v in (("P_g", 20000.0), ("P_j", -3000.0), ("X_i", 2500.0))}
    accelerations = {
        "a_a": ("dx_a_dalpha*alphadd + d2x_a_dalpha2*alphad**2", "m/s^2"),
        "a_b": ("dx_b_dalpha*alphadd + d2x_b_dalpha2*alphad**2", "m/s^2"),
    }
    theory = extended(base, "rodless", {"m": Letter(unit="kg", value=1.0), **masses, **loads}, accelerations)
    # journals 1 and 3 run along y with slider a, 2 and 4 along x with slider b
    forces = {f"P_{i}": (f"-m_{i}*a_{'b' if i % 2 == 0 else 'a'}", "N") for i in range(1, 5)}
    theory = extended(theory, "rodless", {}, forces)
    along = {"P_jx": _journals((0, 2, 0, 4)), "P_jy": _journals((1, 0, 3, 0))}
    theory = replace(theory, tape={**theory.tape, **along}, units={**theory.units, "P_jx": "N", "P_jy": "N"})
    resultants = {
        "inertia_resultant": ("sqrt(sum(P_jx)**2 + sum(P_jy)**2)", "N"),
        "direction": ("sum(P_jx)/sum(P_jy)", "-"),
        "inertia_resultant_equal": ("sqrt((2*m*a_a)**2 + (2*m*a_b)**2)", "N"),
        "direction_equal": ("(2*m*a_b)/(2*m*a_a)", "-"),
        "journal_load": ("sqrt((P_g + P_j)**2 + X_i**2)", "N"),
    }
    return extended(theory, "rodless", {}, resultants)


def _journals(indices: tuple[int, ...]) -> tuple[Node, ...]:
    return tuple(name(f"P_{i}") if i else number(0) for i in indices)

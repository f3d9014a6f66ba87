"""The equations of a mechanism as LaTeX and MathML, stored beside the generated code so that reports need no sympy."""

from typing import Any

from sympy import Derivative, Eq, Expr, Symbol, cos, latex, mathml, sin

from mechsym.derive.declare import Mechanism
from mechsym.derive.emit import groups
from mechsym.derive.lagrange import Equations
from mechsym.derive.rates import accelerations, velocities

_DOT, _TWO_DOTS = "\u0307", "\u0308"
_LATEX = {"lam": r"\lambda", "phi": r"\varphi"}
_GREEK = {
    "phi": "\u03c6", "psi": "\u03c8", "theta": "\u03b8", "alpha": "\u03b1", "gamma": "\u03b3", "lam": "\u03bb",
    "rho": "\u03c1", "omega": "\u03c9",
}  # fmt: skip


def listing(equations: Equations) -> dict[str, Any]:
    """Letters, units, source and equations of a mechanism, ready for JSON.

    Parameters
    ----------
    equations : Equations
        Derived equations

    Returns
    -------
    listing : dict
        Keys name, about, source, coordinates, parameters, inputs, outputs, reactions, equations
    """
    m = equations.mechanism
    outputs = [name for g in groups(equations) if g.name in ("kinematics", "reactions") for name in g.outputs]
    return {
        "name": m.name,
        "about": m.about,
        "source": m.source,
        "coordinates": {s.name: m.units[s.name] for s in m.q},
        "parameters": {s.name: m.units[s.name] for s in m.parameter_list},
        "inputs": {s.name: m.units[s.name] for s in m.input_list},
        "outputs": {name: _unit(m, name) for name in outputs},
        "reactions": {m.reaction_of[s].name: about for s, about in m.joint_about.items()},
        "constraints": list(m.constraints),
        "equations": [_equation(m, *row) for row in _rows(equations)],
    }


def _unit(m: Mechanism, name: str) -> str:
    if name in m.units:
        return m.units[name]
    root, by = m.tape.derived_from(Symbol(name, real=True))
    bottom = "*".join(m.units[v.name] for v in by)
    top = m.units.get(root.name, "")
    return f"{top}/{bottom}" if len(by) == 1 else f"{top}/({bottom})"


def _rows(equations: Equations) -> list[tuple[str, Expr, Expr]]:
    m, rows = equations.mechanism, []
    held = dict.fromkeys(m.joint_list, 0)
    wanted = [*equations.kinematics.values(), *equations.generalized_force, *equations.bias]
    for symbol in m.tape.needed(wanted):
        if not symbol.name.startswith(("sin_", "cos_")) or symbol.name[4:] not in {v.name for v in m.tape.variables}:
            rows.append(("kinematics", symbol, m.tape.entries[symbol].xreplace(held)))
    for i, a in enumerate(m.q):
        row = sum(e * x for e, x in zip(equations.mass_matrix[i], accelerations(m), strict=True))
        rows.append((f"motion of {a.name}", row + equations.bias[i], equations.generalized_force[i].xreplace(held)))
    if equations.kinetic_energy is not None and equations.potential_energy is not None:
        rows.append(("kinetic energy", Symbol("T"), equations.kinetic_energy))
        rows.append(("potential energy", Symbol("V"), equations.potential_energy.xreplace(held)))
    return rows


def _equation(m: Mechanism, title: str, left: Expr, right: Expr) -> dict[str, str]:
    equation = Eq(_physical(m, left), _physical(m, right), evaluate=False)
    names = {s: _latex_name(m, s) for s in equation.free_symbols}
    letters = {s: Symbol(_math_name(m, s)) for s in equation.free_symbols}
    return {
        "title": title,
        "latex": latex(equation, symbol_names=names),
        "mathml": mathml(equation.xreplace(letters), printer="presentation"),
    }


def _physical(m: Mechanism, expression: Expr) -> Expr:
    """Names such as sin_phi and dx_dphi turned back into sin(phi) and a derivative."""
    values: dict[Symbol, Expr] = {}
    for symbol in sorted(expression.free_symbols, key=lambda s: s.name):
        root, by = m.tape.derived_from(symbol)
        kind, _, angle = root.name.partition("_")
        inner = Symbol(angle, real=True)
        circular = kind in ("sin", "cos") and inner in (*m.tape.variables, *m.tape.entries)
        base = {"sin": sin, "cos": cos}[kind](inner) if circular else root
        values[symbol] = Derivative(base, *by, evaluate=False) if by else base
    return expression.xreplace(values)


def _stem(m: Mechanism, symbol: Symbol) -> tuple[str, int]:
    for order, found in enumerate((velocities(m), accelerations(m)), 1):
        names = [s.name for s in found]
        if symbol.name in names:
            return m.q[names.index(symbol.name)].name, order
    return symbol.name, 0


def _split(name: str) -> tuple[str, str]:
    letters, _, index = name.partition("_")
    stem = letters.rstrip("0123456789")
    return stem, ", ".join(part for part in (letters[len(stem) :], index) if part)


def _latex_name(m: Mechanism, symbol: Symbol) -> str:
    name, dots = _stem(m, symbol)
    stem, index = _split(name)
    greek = _LATEX.get(stem, f"\\{stem}" if stem in _GREEK else stem)
    body = ("", r"\dot", r"\ddot")[dots] + (f"{{{greek}}}" if dots else greek)
    return f"{body}_{{{index}}}" if index else body


def _math_name(m: Mechanism, symbol: Symbol) -> str:
    name, dots = _stem(m, symbol)
    stem, index = _split(name)
    body = _GREEK.get(stem, stem) + ("", _DOT, _TWO_DOTS)[dots]
    return f"{body}_{index}" if index else body

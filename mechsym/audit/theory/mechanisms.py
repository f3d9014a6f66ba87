"""Theories of mechanisms: the tape that a derivation makes, as trees; those of files and of sources."""

import ast
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache, reduce
from pathlib import Path

import sympy
from sympy import Expr, Integer, Matrix, Rational, Symbol, cos, sin, solve

from mechsym.audit.read.tree import MEANINGS, Node, binary, call, name, number
from mechsym.audit.theory.record import Letter, Theory, extended
from mechsym.cases.numbers import numbers, usual
from mechsym.derive import Equations, Mechanism, acceleration, derive, output, velocities, velocity
from mechsym.derive.build import declared
from mechsym.derive.files import chosen
from mechsym.derive.rates import accelerations
from mechsym.errors import BadInput
from mechsym.mechanisms.own import content, file_of, permit

_FUNCTIONS = {
    sympy.sin: "sin", sympy.cos: "cos", sympy.tan: "tan", sympy.asin: "asin", sympy.acos: "acos", sympy.atan: "atan",
    sympy.exp: "exp", sympy.log: "log", sympy.Abs: "abs",
}  # fmt: skip
_MEANT = {sympy.atan2: "atan2", sympy.Max: "max", sympy.Min: "min"}


def tree_of(expression: object) -> Node:
    """A sympy expression as a tree; TypeError for what formulas do not have."""
    e = sympy.sympify(expression, strict=True)
    if isinstance(e, sympy.Symbol) or e is sympy.pi:
        return name(str(e))
    if e.is_Rational:
        return number(Fraction(int(e.p), int(e.q)))
    if e.is_Add:
        return reduce(_plus, e.args[1:], tree_of(e.args[0]))
    if e.is_Mul:
        return reduce(lambda t, a: binary(ast.Mult, t, tree_of(a)), e.args[1:], tree_of(e.args[0]))
    if e.is_Pow:
        return _power(*e.args)
    if e.func in _FUNCTIONS:
        return call(_FUNCTIONS[e.func], tree_of(e.args[0]))
    if e.func in _MEANT:
        return reduce(MEANINGS[_MEANT[e.func]][1], map(tree_of, e.args))
    raise TypeError(f"{e.func.__name__} has no place in a formula: {e}")


def _plus(left: Node, term: Expr) -> Node:
    if term.could_extract_minus_sign():
        return binary(ast.Sub, left, tree_of(-term))
    return binary(ast.Add, left, tree_of(term))


def _power(base: Expr, exponent: Expr) -> Node:
    if base is sympy.E:
        return call("exp", tree_of(exponent))
    if exponent == sympy.Rational(1, 2):
        return call("sqrt", tree_of(base))
    if exponent.could_extract_minus_sign():
        return binary(ast.Div, number(1), tree_of(base**-exponent))
    return binary(ast.Pow, tree_of(base), tree_of(exponent))


def tape_of(expressions: Mapping[str, Expr | tuple[Expr, ...]]) -> dict[str, Node | tuple[Node, ...]]:
    """Named sympy expressions as trees."""
    return {n: tuple(map(tree_of, e)) if isinstance(e, tuple) else tree_of(e) for n, e in expressions.items()}


def expressed(
    name: str, letters: Mapping[str, Letter], expressions: Mapping[str, Expr], units: Mapping[str, str], data: str
) -> Theory:
    """A theory of sympy expressions in its letters, in which nothing turns."""
    tape = tape_of(expressions)
    return Theory(name=name, letters=letters, tape=tape, results=tuple(expressions), units=units, data=data)


_SIGNED = ("offset",)  # lengths that may lie on either side

Results = Mapping[str, tuple[Expr, str]]  # name: (expression, unit)


def mechanism_theory(
    equations: Equations, values: Mapping[str, float], rods: tuple[str, ...], data: str, more: Results
) -> Theory:
    """Kinematics, energies, dynamics, reactions and `more` of a derived mechanism; a letter without a value is 1."""
    m = equations.mechanism
    units = m.units | _units(m)
    quantities = dict(equations.kinematics) | dict(equations.reactions)
    if equations.kinetic_energy is not None and equations.potential_energy is not None:
        quantities |= {"kinetic_energy": equations.kinetic_energy, "potential_energy": equations.potential_energy}
    for q, bias, force in zip(m.q, equations.bias, equations.generalized_force, strict=True):
        quantities |= {f"bias_{q.name}": bias, f"force_{q.name}": force}
    if len(m.q) == 1:
        quantities |= {"bias": equations.bias[0], "generalized_force": equations.generalized_force[0]}
        quantities |= {"acceleration": solved_accelerations(equations)[0]}
    results = (quantities | residuals(equations)) | {name: expression for name, (expression, _) in more.items()}
    letters = {}
    held = {f"{q.name}{d}" for q in m.dependent_list for d in ("", "d", "dd")}  # of loops: by no formula of the letters
    for symbol in (*m.q, *velocities(m), *accelerations(m), *m.parameter_list, *m.input_list):
        if symbol.name in held:
            continue
        k, sign = symbol.name, "any" if symbol.name in _SIGNED else ""
        letters[k] = Letter(unit=units[k], value=float(values.get(k, 1.0)), sign=sign)
    closed = dict.fromkeys(m.joint_list, Integer(0))
    entries = {s.name: m.tape.entries[s].xreplace(closed) for s in m.tape.needed(results.values())}
    own = {n: e.xreplace(closed) for n, e in results.items() if n not in entries}
    kept = _determined(entries | own, letters)
    return Theory(
        name=m.name,
        letters=letters,
        tape=tape_of(kept),
        results=tuple(n for n in results if n in kept),
        units=units | {name: unit for name, (_, unit) in more.items()},
        angle=m.q[0].name,
        rods=rods,
        data=data,
    )


def _determined(steps: dict[str, Expr], letters: Mapping[str, Letter]) -> dict[str, Expr]:
    """Steps that letters determine: none of what hangs on coordinates or multipliers of loops closed by constraint."""
    held = {n: {s.name for s in e.free_symbols} for n, e in steps.items()}
    lost = {s for n, inner in held.items() for s in inner if s not in letters and (s not in steps or s == n)}
    while more := {n for n, inner in held.items() if n not in lost and inner & lost}:
        lost |= more
    return {n: e for n, e in steps.items() if n not in lost}


def _units(m: Mechanism) -> dict[str, str]:
    rates = {s.name: "rad/s" for s in velocities(m)} | {s.name: "rad/s^2" for s in accelerations(m)}
    return rates | {"kinetic_energy": "J", "potential_energy": "J"}


def solved_accelerations(equations: Equations) -> list[Expr]:
    r"""Accelerations :math:`\ddot q = M^{-1}(Q - h)`, in the order of the coordinates."""
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


def mechanism(name: str, values: Mapping[str, float], data: str) -> Theory:
    """A derived mechanism, without results of its own; lengths that begin with l count as rods."""
    return equations_theory(derive(declared(name)), values, data)


def equations_theory(
    equations: Equations, values: Mapping[str, float], data: str, more: Results | None = None
) -> Theory:
    """The theory of derived equations, with further results or none; arguments as for `mechanism`."""
    m = equations.mechanism
    rods = tuple(p.name for p in m.parameter_list if p.name.startswith("l") and m.units[p.name] == "m")
    speeds = {u.name: values.get("speed", 10.0) for u in velocities(m)}
    return mechanism_theory(equations, dict.fromkeys(rods, 4.0) | speeds | dict(values), rods, data, more or {})


def own_theory(name: str, case: str) -> Theory:
    """The theory of the declaration in `./FILE.py`, `./FILE.py:NAME` or a package, with the data of a case."""
    path, which = file_of(name)
    if not path.is_file():
        raise BadInput(f"--against {name}: there is no file {path}")
    permit(path.resolve())
    data = case or usual(name)
    values = numbers(data, name) if data else {}
    return _theory(path.resolve(), which, data, tuple(values.items()), content(name))


@lru_cache(maxsize=8)
def _theory(path: Path, which: str, data: str, values: tuple[tuple[str, float], ...], _content: str) -> Theory:
    try:
        equations = derive(chosen(path, which))
        m = equations.mechanism
        # all that the declaration names, links' angles and points included, besides what it puts out
        named = {symbol.name: (symbol, m.units[symbol.name]) for symbol in m.tape.entries if symbol.name in m.units}
        return equations_theory(equations, dict(values), data, named)
    except TypeError as error:
        raise BadInput(f"{path.name} cannot be a theory of the auditor: {error}") from None


# no source prints these; they only set the scale of an error
_LOADS = {"F": 1e5, "M_r": 9000.0, "M_h": -20000.0, "phi": 1.0, "phidd": 0.5}
_SHAFT = {"phi0": 1.0, "phi2": 0.99, "phi0d": 194.0, "phi2d": 194.0, "phi0dd": 3.0, "phi2dd": 1.5, "M": 1.5, "F": 30.0}


def crosshead(values: Mapping[str, float], data: str) -> Theory:
    """Crank, rod and crosshead with elastic hinge: its torque for constant speed, parts of the generalised force."""
    equations = derive(declared("crosshead"))
    m, (force,), (bias,) = equations.mechanism, equations.generalized_force, equations.bias
    inertia = equations.mass_matrix[0][0]
    more = {
        "hinge_torque": (bias - without(force, "M_h"), "N*m"),
        "gravity_torque": (without(force, "F", "M_r", "M_h"), "N*m"),
        "gas_torque": (without(force, "g", "M_r", "M_h"), "N*m"),
        "inertia_rate": (velocity(m, inertia), "kg*m^2/s"),
        "inertia_torque": (m.tape.diff(inertia, m.q[0]) * velocities(m)[0] ** 2 / 2, "N*m"),
    }
    known = _LOADS | {"phid": values.get("speed", 10.0)} | dict(values)
    return mechanism_theory(equations, known, ("l1", "l2"), data, more)


def crankshaft_flywheel(values: Mapping[str, float], data: str) -> Theory:
    """Crankshaft and flywheel on a torsional spring: motion, its equations as sums, the torque that drives it."""
    return _shaft(derive(declared("crankshaft_flywheel")), values, data)


def crankshaft_flywheel_truncated(values: Mapping[str, float], data: str) -> Theory:
    """The Lagrange equation of the truncated travel (9) of source 002, in the names of the exact one."""
    m = Mechanism("crankshaft_flywheel_truncated", source="002_d7297926d6c52225")
    phi0, phi2 = m.coordinates("phi0 phi2")
    I0, I2 = m.parameters("I0 I2", "kg*m^2")
    r, l = m.parameters("r l", "m")
    m0, k1 = m.parameters("m0", "kg"), m.parameters("k1", "N*m/rad")
    M = m.inputs("M", "N*m")
    lam = m.let("lam", r / l, "-")
    x0 = m.let("x0", r * ((1 - cos(phi0)) + lam * Rational(1, 4) * (1 - cos(2 * phi0))), "m")
    m.body("crank", turns=phi0, inertia=I0)
    m.body("flywheel", turns=phi2, inertia=I2)
    m.body("piston", mass=m0, at=(-x0, 0))
    m.spring(k1, stretch=m.let("twist", phi0 - phi2, "rad"))
    m.torque(M, along=phi0)
    output(m, x0, order=2)
    return _shaft(derive(m), values, data)


def _shaft(equations: Equations, values: Mapping[str, float], data: str) -> Theory:
    m = equations.mechanism
    x0 = next(s for s in m.kinematic_outputs if s.name == "x0")
    solved = solved_accelerations(equations)
    x0dd = acceleration(m, x0)
    torque = next(s for s in m.input_list if s.name == "M") - residuals(equations)["residual_phi0"]
    more = {
        "x0d": (velocity(m, x0), "m/s"),
        "x0dd": (x0dd, "m/s^2"),
        "x0dd_solved": (x0dd.xreplace(dict(zip(accelerations(m), solved, strict=True))), "m/s^2"),
        "acceleration_phi0": (solved[0], "rad/s^2"),
        "acceleration_phi2": (solved[1], "rad/s^2"),
        "driving_torque": (torque, "N*m"),
    }
    return mechanism_theory(equations, _SHAFT | dict(values), ("l",), data, more)


def slider_crank(values: Mapping[str, float], data: str) -> Theory:
    """A crank, a massless rod and a reciprocating mass, with the joint forces that the derivation gives: the rod's in
    compression, the radial one towards the shaft."""
    m = Mechanism("slider_crank", source="001_a140ef4f7e005dde")
    phi = m.coordinates("phi")
    r, l = m.parameters("r l", "m")
    mass: Expr = m.parameters("m", "kg")
    F = m.inputs("F", "N")
    x_A, y_A = m.joints("x_A y_A", "crank on rod")
    y_G = m.joints("y_G", "guide on piston")
    lam = m.let("lam", r / l, "-")
    beta = m.angle("beta", sine=lam * sin(phi) + (y_A - y_G) / l)
    x = m.let("x", r * (1 - cos(phi)) + l * (1 - cos(beta)) - x_A, "m")
    m.body("piston", mass=mass, at=(r + l - x, y_G))
    m.force(F, along=x)
    output(m, x, order=2)
    output(m, beta)
    equations = derive(m)
    pin_x, pin_y, guide = (equations.reactions[f"R_{j}"] for j in ("x_A", "y_A", "y_G"))
    s, c = sin(phi), cos(phi)
    piston = acceleration(m, x)
    more = {
        "piston_acceleration": (piston, "m/s^2"),
        "inertia_force": (-mass * piston, "N"),
        "total_force": (F - mass * piston, "N"),
        "rod_force": (pin_x * cos(beta) - pin_y * sin(beta), "N"),
        "normal_force": (guide, "N"),
        "tangential_force": (pin_x * s - pin_y * c, "N"),
        "radial_force": (pin_x * c + pin_y * s, "N"),
        "torque": ((F - mass * piston) * m.tape.diff(x, phi), "N*m"),
    }
    named = {k: (m.tape.named(e), unit) for k, (e, unit) in more.items()}
    known = {"r": 0.5, "l": 1.55, "m": 460.0, "F": 1e5, "phi": 1.0, "phid": values.get("speed", 10.0), "phidd": 0.5}
    return mechanism_theory(equations, known, ("l",), data, named)


def two_mass_rod(values: Mapping[str, float], data: str) -> Theory:
    """A rod replaced by two masses at its ends, with the same mass and centre of mass; its inertia is another one."""
    m_b, L, L_m, I_C = (Symbol(k, positive=True) for k in ("m_b", "L", "L_m", "I_C"))
    piston, crank = sympy.symbols("piston crank", positive=True)
    # same mass; same moment about the crank pin, L_m from there to the centre of mass
    masses = solve([piston + crank - m_b, piston * L - m_b * L_m], [piston, crank], dict=True)[0]
    missing = I_C - (masses[piston] * (L - L_m) ** 2 + masses[crank] * L_m**2)
    expressions = {
        "mass_on_piston": masses[piston],
        "mass_on_crank": masses[crank],
        "inertia_missing": sympy.factor(missing),
    }
    l1, l2 = values.get("l1", 0.8), values.get("l2", 0.75)
    letters = {
        "m_b": Letter(unit="kg", value=values.get("m2", 150.0)),
        "L": Letter(unit="m", value=l1 + l2),
        "L_m": Letter(unit="m", value=l1),
        "I_C": Letter(unit="kg*m^2", value=values.get("IC2", 50.0)),
    }
    units = {"mass_on_piston": "kg", "mass_on_crank": "kg", "inertia_missing": "kg*m^2"}
    return expressed("two_mass_rod", letters, expressions, units, data)


def rodless(values: Mapping[str, float], data: str) -> Theory:
    """Inertia forces of the reciprocating masses and the load of one journal.

    `P_jx` and `P_jy` have one value per journal, the masses may differ; in the names that end in `_equal` all are m.
    The source's y is the axis of the slider at angle 0, its x the other one.
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

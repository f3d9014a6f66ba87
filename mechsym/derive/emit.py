"""One readable module of Python per mechanism: header, tables of names, one function per group of equations."""

import hashlib
import textwrap
from collections.abc import Mapping
from dataclasses import dataclass

import sympy
from sympy import Expr, Integer, Symbol

from mechsym.derive.lagrange import Equations, multiplier
from mechsym.derive.printer import casadi_text
from mechsym.derive.rates import accelerations, velocities
from mechsym.derive.refuse import refuse


def header(script: str, source_hash: str, body_hash: str) -> str:
    """The stamp of a generated file: what it came from and that it is not to be edited.

    script: path of the derivation; source_hash, body_hash: 16 hex digits each. Returns text: comment lines.
    """
    return (
        f"# Generated from {script} by mechsym.derive. Do NOT edit: run `make derive`.\n"
        f"# source sha256: {source_hash}   ({script} + mechsym/derive/*.py, newlines normalised)\n"
        f"# body   sha256: {body_hash}   (everything below this header)\n"
        f"# sympy {sympy.__version__}\n"
    )


def digest(text: str) -> str:
    """First 16 hex digits of the SHA-256 of a text with newlines normalised.

    text: any text.
    """
    return hashlib.sha256(text.replace("\r\n", "\n").encode()).hexdigest()[:16]


@dataclass(frozen=True, kw_only=True)
class Group:
    """One generated function.

    Parameters
    ----------
    name, about : str
        Function name and first line of its docstring
    outputs : mapping of str to Expr
        What it returns, in order
    """

    name: str
    about: str
    outputs: Mapping[str, Expr]


def groups(equations: Equations) -> list[Group]:
    """The functions that are generated for a mechanism.

    Returns groups: flat list, in the order of the module.
    """
    m = equations.mechanism
    q = [v.name for v in m.q]
    mass = {f"mass_{a}_{b}": equations.mass_matrix[i][j] for i, a in enumerate(q) for j, b in enumerate(q)}
    bias = {f"bias_{a}": e for a, e in zip(q, equations.bias, strict=True)}
    force = {f"force_{a}": e for a, e in zip(q, equations.generalized_force, strict=True)}
    functions = [
        Group(name="kinematics", about="Kinematics at given coordinates.", outputs=equations.kinematics),
        Group(
            name="dynamics",
            about="Equations of motion: mass * qdd + bias = force (gravity, springs, dampers, inputs).",
            outputs=mass | bias | force,
        ),
    ]
    if equations.kinetic_energy is not None and equations.potential_energy is not None:
        energy = {"kinetic_energy": equations.kinetic_energy, "potential_energy": equations.potential_energy}
        functions.append(Group(name="energy", about="Energies; the potential is zero at the origin.", outputs=energy))
    if equations.reactions:
        about = "Joint reactions (first body on second) and other outputs that need accelerations."
        functions.append(Group(name="reactions", about=about, outputs=equations.reactions))
    if equations.momentum:
        about = "Rates of momentum, and of angular momentum about the origin, of all bodies: the sum of outer forces."
        functions.append(Group(name="momentum", about=about, outputs=equations.momentum))
    if equations.constraint_jacobian:
        names = list(equations.mechanism.constraints)
        rows = zip(names, equations.constraint_jacobian, strict=True)
        jacobian = {f"jacobian_{c}_{a}": e for c, row in rows for a, e in zip(q, row, strict=True)}
        velocity_terms = {f"bias_{c}": e for c, e in zip(names, equations.constraint_bias, strict=True)}
        closure = {f"closure_{c}": e for c, e in equations.mechanism.constraints.items()}
        about = "Constraints: closure = 0, jacobian * qdd + bias = 0."
        functions.append(Group(name="constraints", about=about, outputs=closure | jacobian | velocity_terms))
    if m.roots:
        turns = {f"turn_{k.name}": k.turns for k in m.links if not k.given and k.turns is not None}
        roots = {f"root_{i}": root for i, root in enumerate(m.roots)}
        about = "Angles of links, and what is 0 where the two ways to close a loop meet."
        functions.append(Group(name="sides", about=about, outputs=turns | roots))
    if points := equations.mechanism.shape_points:
        functions.append(Group(name="drawing", about="Points and sizes that a drawing needs.", outputs=points))
    return functions


def assignments(equations: Equations, outputs: Mapping[str, Expr]) -> tuple[list[tuple[Symbol, Expr]], dict[str, Expr]]:
    """The needed part of the tape in order, joints held at zero, repeated terms named `_t0, _t1, ...`.

    outputs: what is wanted. Returns steps: assignments in order; results: the outputs in terms of them.
    """
    tape = equations.mechanism.tape
    held: dict[Symbol, Expr] = dict.fromkeys(equations.mechanism.joint_list, Integer(0))
    trivial, lines = dict(held), {}
    names_of: dict[Expr, Expr] = {}
    for symbol in tape.needed(outputs.values()):
        value = tape.entries[symbol].xreplace(trivial)
        if value.is_Number or value.is_Symbol or (-value).is_Symbol:
            trivial[symbol] = value
        elif value in names_of:
            trivial[symbol] = names_of[value]
        else:
            lines[symbol] = value
            names_of |= {value: symbol, -value: -symbol}
    results = {name: e.xreplace(trivial) for name, e in outputs.items()}
    names = _reachable(lines, results.values())
    common, reduced = tape.common([*(lines[n] for n in names), *results.values()])
    ordered = _interleave(names, reduced[: len(names)], dict(common))
    placed = {s for s, _ in ordered}
    tail = _interleave([], [], {s: e for s, e in common if s not in placed}, reduced[len(names) :])
    return ordered + tail, dict(zip(results, reduced[len(names) :], strict=True))


def _reachable(lines: Mapping[Symbol, Expr], wanted: object) -> list[Symbol]:
    todo, seen = list(wanted), set()  # type: ignore[call-overload]
    while todo:
        for symbol in todo.pop().free_symbols & lines.keys():
            if symbol not in seen:
                seen.add(symbol)
                todo.append(lines[symbol])
    return [s for s in lines if s in seen]


def _interleave(
    names: list[Symbol], values: list[Expr], common: dict[Symbol, Expr], extra: list[Expr] | None = None
) -> list[tuple[Symbol, Expr]]:
    steps: list[tuple[Symbol, Expr]] = []
    placed: set[Symbol] = set()

    def require(expression: Expr) -> None:
        for symbol in sorted(expression.free_symbols & common.keys(), key=lambda s: int(s.name[2:])):
            if symbol not in placed:
                placed.add(symbol)
                require(common[symbol])
                steps.append((symbol, common[symbol]))

    for name, value in zip(names, values, strict=True):
        require(value)
        steps.append((name, value))
    for value in extra or []:
        require(value)
    return steps


def arguments(equations: Equations, steps: list[tuple[Symbol, Expr]], results: Mapping[str, Expr]) -> list[str]:
    """Letters that a function needs, in the order coordinates, velocities, accelerations, inputs, parameters.

    steps: assignments; results: outputs. Returns names: argument names.

    Raises
    ------
    ValueError
        A letter that was never declared
    """
    m = equations.mechanism
    used = {s.name for e in [*(v for _, v in steps), *results.values()] for s in e.free_symbols}
    order = [*m.q, *velocities(m), *accelerations(m), *m.input_list, *_multipliers(equations), *m.parameter_list]
    known = [s.name for s in order]
    unknown = used - set(known) - {s.name for s, _ in steps}
    if unknown:
        refuse(f"undeclared letters {sorted(unknown)}; declare them as parameters or inputs", m.where[m.name])
    return [name for name in known if name in used]


def _multipliers(equations: Equations) -> list[Symbol]:
    return [multiplier(equations.mechanism, c) for c in equations.mechanism.constraints]


def function_text(equations: Equations, group: Group) -> tuple[str, list[str]]:
    """Text of one generated function and its arguments.

    group: what to generate. Returns text: Python source of the function.
    """
    steps, results = assignments(equations, group.outputs)
    names = arguments(equations, steps, results)
    m = equations.mechanism
    units = m.units | {v.name: f"{m.units[q.name]}/s" for q, v in zip(m.q, velocities(m), strict=True)}
    units |= {a.name: f"{m.units[q.name]}/s^2" for q, a in zip(m.q, accelerations(m), strict=True)}
    units |= {s.name: m.units.get(s.name, "-") for s in _multipliers(equations)}
    taken = ", ".join(f"{n} [{units[n]}]" for n in names)
    body = [f"{s.name} = {casadi_text(e)}" for s, e in steps]
    body += [f"{n} = {casadi_text(e)}" for n, e in results.items() if e != Symbol(n, real=True)]
    doc = _wrapped(f"Takes {taken or 'nothing'}.") + _wrapped(f"Returns {', '.join(results)}.")
    lines = [f"def {group.name}({', '.join(names)}):", f'    """{group.about}', "", *doc, '    """']
    lines += [f"    {line}" for line in body]
    returned = f"{', '.join(results)}{',' if len(results) == 1 else ''}" or "()"
    return "\n".join([*lines, f"    return {returned}"]), names


def _wrapped(text: str) -> list[str]:
    return textwrap.wrap(text, 114, initial_indent="    ", subsequent_indent="        ")


def module_text(equations: Equations, script: str, source_hash: str) -> str:
    """Text of the generated module with its header.

    script: path of the derivation from the project's top, for the header; source_hash: hash of the derivation and of
    `mechsym/derive`. Returns text: Python source.
    """
    m = equations.mechanism
    parts, table = [], []
    for group in groups(equations):
        text, names = function_text(equations, group)
        parts.append(text)
        table.append(f'    "{group.name}": (\n        {tuple(names)!r},\n        {tuple(group.outputs)!r},\n    ),')
    head = [
        f'"""{m.about or m.name} Source: {m.source}."""',
        "",
        "import casadi as ca",
        "",
        f'NAME = "{m.name}"',
        f'SOURCE = "{m.source}"',
        f"COORDINATES = {tuple(s.name for s in m.q)!r}",
        f"INPUTS = {tuple(s.name for s in m.input_list)!r}",
        f"PARAMETERS = {tuple(s.name for s in m.parameter_list)!r}",
        *_closing(equations),
        "# function: (arguments, outputs)",
        "FUNCTIONS = {",
        *table,
        "}",
    ]
    body = "\n".join(head) + "\n\n\n" + "\n\n\n".join(parts) + "\n"
    return header(script, source_hash, digest(body)) + body


def _closing(equations: Equations) -> list[str]:
    """Tables of a mechanism that closes by constraint."""
    m = equations.mechanism
    if not m.dependent_list:
        return []
    names = tuple(s.name for s in _multipliers(equations))
    return ["# dependent coordinates and where they start", f"DEPENDENTS = {m.guesses!r}", f"MULTIPLIERS = {names!r}"]

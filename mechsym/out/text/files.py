"""Whole files in each language: functions of one array, and for a machine its curves and its rates in one call.

c         NAME.h, NAME.c: no allocation; a machine also starts, advances (DOP853 with events), sets and gets
julia     NAME.jl, a module          matlab   NAME.m, one function file, runs in Octave too
jax       NAME.py, jax.numpy         modelica NAME.mo, flat equations
"""

import re
from collections.abc import Callable, Mapping
from importlib import resources

from mechsym.errors import BadInput
from mechsym.out.block import Block, Curve, Port
from mechsym.out.fmi.describe import identifier
from mechsym.out.text import language_c
from mechsym.out.text.dialects import JAX, JULIA, MATLAB, MODELICA, Dialect, Written, number, statements, told


def files(written: Written, language: str) -> dict[str, str]:
    """Texts by file name, in `c`, `modelica`, `julia`, `matlab` or `jax`."""
    if language not in _LANGUAGES:
        raise BadInput(f"--to {language!r} is not known; allowed are {', '.join(_LANGUAGES)}")
    return _LANGUAGES[language](written)


def _head(written: Written, dialect: Dialect) -> list[str]:
    return [dialect.says(f"{written.name}: {written.about}"), dialect.says("SI units, angles in rad")]


def _functions(written: Written, dialect: Dialect, shape: Callable[[str, list[str]], list[str]]) -> list[str]:
    """Every function of one array; it counts from 0 in JAX and from 1 elsewhere."""
    lines: list[str] = []
    bracket, first = "v({})" if dialect is MATLAB else "v[{}]", 0 if dialect is JAX else 1
    for name, tape in written.tapes.items():
        body, results = statements(tape, dialect, lambda i: bracket.format(i + first))
        comments = [dialect.says(line) for line in told(written, name)]
        lines += ["", *comments, *shape(name, [*body, *_result(dialect, results)])]
    return lines


def _result(dialect: Dialect, results: list[str]) -> list[str]:
    joined = ", ".join(results)
    return {
        "julia": [f"    return [{joined}]"],
        "matlab": [f"    y = [{joined.replace(', ', '; ')}];"],
        "jax": [f"    return jnp.stack(jnp.broadcast_arrays({joined}))"],
    }[dialect.name]


def _listed(dialect: Dialect, values: object, ends: str = "[]") -> str:
    return ends[0] + ", ".join(number(dialect, float(v)) for v in values) + ends[1]  # type: ignore[attr-defined]


def _machine(file: str) -> list[str]:
    """What every machine in a language has: its curves, and its rates and outputs from time, states and inputs."""
    return (resources.files("mechsym.out.text") / "machines" / file).read_text(encoding="utf-8").splitlines()


def _julia(written: Written) -> dict[str, str]:
    name, block = identifier(written.name), written.block
    lines = [*_head(written, JULIA), f"module {name}"]
    lines += _functions(written, JULIA, lambda f, body: [f"function {f}(v)", *body, "end"])
    if block is not None:
        lines += ["", f"const x_start = {_listed(JULIA, [s.start for s in block.states])}"]
        lines += [f"const p_start = {_listed(JULIA, [p.start for p in block.parameters])}"]
        rows = [
            f"    ({c.state + 1}, {c.ratio!r}, {str(c.periodic).lower()}, {_listed(JULIA, c.poly.x)}, "
            f"reshape({_listed(JULIA, c.poly.c.T.ravel())}, {len(c.poly.c)}, :)),"
            for c in block.curves
        ]
        times = [[p.name for p in block.parameters].index(s) + 1 for s in block.switches]
        lines += ["const curves = (", *rows, ")", f"const switches = {times}", "", *_machine("julia.jl"), ""]
    return {f"{name}.jl": "\n".join([*lines, "end", ""])}


def _matlab(written: Written) -> dict[str, str]:
    name, block = identifier(written.name), written.block
    lines = [f"function varargout = {name}(what, varargin)"]
    lines += _head(written, MATLAB)
    if block is None:
        choice = ", ".join(f"'{f}'" for f in written.tapes)
        lines += [f"% y = {name}(what, v); what: {choice}", "    varargout{1} = feval(what, varargin{:});", "end"]
    else:
        lines += [
            f"% dx = {name}('derivative', t, x, u, p); y = {name}('outputs', t, x, u, p)",
            f"% [x, p] = {name}('start')",
        ]
        lines += ["    [varargout{1:max(nargout, 1)}] = feval(what, varargin{:});", "end"]
    lines += _functions(written, MATLAB, lambda f, body: [f"function y = {f}(v)", *body, "end"])
    lines += ["", "function y = pick(condition, value)", "    y = 0.0;", "    if condition, y = value; end", "end"]
    if block is not None:
        times = [[p.name for p in block.parameters].index(s) + 1 for s in block.switches]
        lines += ["", "function [x, p] = start()", f"    x = {_listed(MATLAB, [s.start for s in block.states])}';",
                  f"    p = {_listed(MATLAB, [p.start for p in block.parameters])}';", "end",
                  "", "function v = values(t, x, u, p)", "    w = [];"]  # fmt: skip
        for c in block.curves:
            rows = "; ".join(" ".join(number(MATLAB, v) for v in row) for row in c.poly.c.T)
            head = f"    w = [w; curve({c.ratio!r} * x({c.state + 1}), {int(c.periodic)}, "
            lines.append(f"{head}{_listed(MATLAB, c.poly.x)}, [{rows}])];")
        lines += [f"    s = double(t >= p({times}));" if times else "    s = [];"]
        lines += ["    v = [t; x(:); u(:); p(:); w; s(:)];", "end", "", *_machine("matlab.m")]
    return {f"{name}.m": "\n".join([*lines, ""])}


def _jax(written: Written) -> dict[str, str]:
    name, block = identifier(written.name), written.block
    lines = [*_head(written, JAX), "import jax", "import jax.numpy as jnp", "",
             'jax.config.update("jax_enable_x64", True)', ""]  # fmt: skip
    lines += _functions(written, JAX, lambda f, body: [f"def {f}(v):", *body, ""])
    if block is not None:
        times = [[p.name for p in block.parameters].index(s) for s in block.switches]
        lines += [
            "",
            f"x_start = jnp.array({_listed(JAX, [s.start for s in block.states])})",
            f"p_start = jnp.array({_listed(JAX, [p.start for p in block.parameters])})",
            f"switches = {times}",
            "curves = [",
        ]
        for c in block.curves:
            rows = f"jnp.array({_listed(JAX, c.poly.c.T.ravel())}).reshape(-1, {len(c.poly.c)})"
            lines += [f"    ({c.state}, {c.ratio!r}, {c.periodic}, jnp.array({_listed(JAX, c.poly.x)}), {rows}),"]
        lines += ["]", "", "", *_machine("jax.txt")]
    return {f"{name}.py": "\n".join([*lines, ""])}


def _modelica(written: Written) -> dict[str, str]:
    """NAME.mo: a model of a machine, or a package with one function for each function of a mechanism."""
    name = identifier(written.name)
    name = name[0].upper() + name[1:]  # as the language writes the names of classes
    lines = _package(written, name) if written.block is None else _model(written, written.block, name)
    return {f"{name}.mo": "\n".join([*lines, f"end {name};", ""])}


def _quoted(text: str) -> str:
    """A text of Modelica; nothing in it ends it, or needs to be escaped."""
    return '"' + re.sub(r'[\s"\\]+', " ", text) + '"'


def _package(written: Written, name: str) -> list[str]:
    lines = [f"package {name} {_quoted(written.about)}"]
    for group, tape in written.tapes.items():
        names = written.inputs[group]
        body, results = statements(tape, MODELICA, names.__getitem__)
        outputs = [identifier(o) for o in written.outputs[group]]
        lines += ["", f"function {group}"]
        lines += [f"  input Real {n}{_unit(written.units.get(n, ''))};" for n in written.inputs[group]]
        lines += [f"  output Real {n};" for n in outputs]
        lines += ["protected", *(f"  Real {line.split()[0]};" for line in body)] if body else []
        lines += [
            "algorithm",
            *body,
            *(f"  {o} := {r};" for o, r in zip(outputs, results, strict=True)),
            f"end {group};",
        ]
    return lines


def _unit(unit: str) -> str:
    return f'(unit="{unit}")' if unit not in ("", "-") and "(" not in unit else ""


def _model(written: Written, block: Block, name: str) -> list[str]:
    lines = [f"model {name} {_quoted(written.about)}"]
    lines += [_port("parameter", p, f" = {number(MODELICA, p.start)}") for p in block.parameters]
    lines += [_port("input", p, "(start=0.0)") for p in block.inputs]
    lines += [f"  Real {s.name}(start={number(MODELICA, s.start)}, fixed=true);" for s in block.states]
    lines += [f"  Real {p.name};" for p in block.outputs]
    # what rates and outputs share is computed once: the tapes are written with names of their own
    names, results = {"rates": "a", "observed": "b"}, {}
    body: list[str] = []
    for key, letter in names.items():
        rows, results[key] = statements(written.tapes[key], MODELICA, lambda i: identifier(written.inputs["rates"][i]))
        body += [_own(row.replace(":=", "=", 1), letter) for row in rows]
        results[key] = [_own(r, letter) for r in results[key]]
    lines += ["protected", *(f"  Real {row.split()[0]};" for row in body)]
    lines += [f"  Real {c.name}_{w};" for c in block.curves for w in ("value", "slope")]
    lines += [f"  Real switch_{i + 1};" for i in range(len(block.switches))]
    lines += [line for c in block.curves for line in _modelica_curve(c)]
    lines += ["equation", *body]
    lines += [_curve_call(block, c, w) for c in block.curves for w in ("value", "slope")]
    lines += [f"  switch_{i + 1} = if time >= {s} then 1.0 else 0.0;" for i, s in enumerate(block.switches)]
    lines += [f"  der({s.name}) = {r};" for s, r in zip(block.states, results["rates"], strict=True)]
    lines += [f"  {p.name} = {r};" for p, r in zip(block.outputs, results["observed"], strict=True)]
    return lines


def _port(kind: str, port: Port, end: str) -> str:
    about = f" {_quoted(port.about)}" if port.about else ""
    return f"  {kind} Real {port.name}{_unit(port.unit) if kind == 'parameter' else ''}{end}{about};"


def _own(text: str, letter: str) -> str:
    return re.sub(r"\bt(\d+)\b", rf"{letter}\1", text)


def _curve_call(block: Block, curve: Curve, what: str) -> str:
    state = block.states[curve.state].name
    return f"  {curve.name}_{what} = {curve.name}_{what}_of({number(MODELICA, curve.ratio)} * {state});"


def _modelica_curve(curve: Curve) -> list[str]:
    breaks = ", ".join(number(MODELICA, v) for v in curve.poly.x)
    rows = ", ".join("{" + ", ".join(number(MODELICA, v) for v in row) + "}" for row in curve.poly.c.T)
    first, last = number(MODELICA, curve.poly.x[0]), number(MODELICA, curve.poly.x[-1])
    period = number(MODELICA, float(curve.poly.x[-1] - curve.poly.x[0]))
    inside = f"at - floor((at - {first}) / {period}) * {period}" if curve.periodic else f"min(max(at, {first}), {last})"
    lines, pieces = [], curve.poly.c.shape[1]
    for what in ("value", "slope"):
        held = "" if curve.periodic or what == "value" else " * (if at == inside then 1.0 else 0.0)"
        lines += [
            f"  function {curve.name}_{what}_of", "    input Real at;", "    output Real y;", "  protected",
            f"    constant Real breaks[{len(curve.poly.x)}] = {{{breaks}}};",
            f"    constant Real rows[{curve.poly.c.shape[1]}, {len(curve.poly.c)}] = {{{rows}}};",
            "    Real inside;", "    Real value;", "    Real slope;", "    Integer i;", "  algorithm",
            f"    inside := {inside};", "    i := 1;", f"    while i < {pieces} and breaks[i + 1] <= inside loop",
            "      i := i + 1;", "    end while;", "    value := 0.0;", "    slope := 0.0;",
            f"    for k in 1:{len(curve.poly.c)} loop", "      slope := slope * (inside - breaks[i]) + value;",
            "      value := value * (inside - breaks[i]) + rows[i, k];", "    end for;", f"    y := {what}{held};",
            f"  end {curve.name}_{what}_of;",
        ]  # fmt: skip
    return lines


_LANGUAGES: Mapping[str, Callable[[Written], dict[str, str]]] = {
    "c": language_c.files, "modelica": _modelica, "julia": _julia, "matlab": _matlab, "jax": _jax,
}  # fmt: skip

"""Modelica: flat equations; a curve is a function."""

import re

from mechsym.out.block import Block, Curve, Port
from mechsym.out.fmi.describe import identifier
from mechsym.out.text.dialects import MODELICA, number, statements
from mechsym.out.text.programs import Written


def files(written: Written) -> dict[str, str]:
    """NAME.mo: a model of a machine, or a package with one function for each function of a mechanism."""
    name = identifier(written.name)
    name = name[0].upper() + name[1:]  # as the language writes the names of classes
    lines = _package(written, name) if written.block is None else _model(written, written.block, name)
    return {f"{name}.mo": "\n".join([*lines, f"end {name};", ""])}


def _about(written: Written) -> str:
    return '"' + re.sub(r'[\s"]+', " ", written.about) + '"'


def _package(written: Written, name: str) -> list[str]:
    lines = [f"package {name} {_about(written)}"]
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
    lines = [f"model {name} {_about(written)}"]
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
    lines += [line for c in block.curves for line in _curve(c)]
    lines += ["equation", *body]
    lines += [_curve_call(block, c, w) for c in block.curves for w in ("value", "slope")]
    lines += [f"  switch_{i + 1} = if time >= {s} then 1.0 else 0.0;" for i, s in enumerate(block.switches)]
    lines += [f"  der({s.name}) = {r};" for s, r in zip(block.states, results["rates"], strict=True)]
    lines += [f"  {p.name} = {r};" for p, r in zip(block.outputs, results["observed"], strict=True)]
    return lines


def _port(kind: str, port: Port, end: str) -> str:
    about = f' "{port.about}"' if port.about else ""
    return f"  {kind} Real {port.name}{_unit(port.unit) if kind == 'parameter' else ''}{end}{about};"


def _own(text: str, letter: str) -> str:
    return re.sub(r"\bt(\d+)\b", rf"{letter}\1", text)


def _curve_call(block: Block, curve: Curve, what: str) -> str:
    state = block.states[curve.state].name
    return f"  {curve.name}_{what} = {curve.name}_{what}_of({number(MODELICA, curve.ratio)} * {state});"


def _curve(curve: Curve) -> list[str]:
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

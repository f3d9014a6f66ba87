"""`mechsym optimise`: design optimisation declared in a case."""

import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

import click

from mechsym.cli.common import case_of, emit, json_option, out_option, pairs, set_option, table
from mechsym.quantities.display import quantity_text


@click.command(short_help="Best design of a case under its limits.")
@click.argument("case")
@json_option
@out_option
@set_option
def optimise(case: str, as_json: bool, out: Path | None, overrides: tuple[str, ...]) -> None:
    """Best design of CASE under its limits, as its section [optimise] declares it; what each active limit costs.

    \b
    Examples: mechsym optimise nunes-hypocycloid
              mechsym optimise nunes-hypocycloid --set optimise.against=p_max --out front
              mechsym optimise mine.toml, with phase, dead volumes and gas of a Stirling engine in [optimise]
    Exit status 1: no feasible design, or the solver did not converge.
    """
    from mechsym.jobs.optimise import optimise

    loaded = case_of(case, pairs(overrides))
    section = loaded.need("optimise")
    done = optimise(loaded)
    found, front = done.best, done.front
    result = asdict(found) | {"goal": section.goal, "objective_name": section.objective}
    result |= {"pareto": [_point(p, section) for p in front]} if front else {}
    result |= {"chosen": dict(done.chosen), "choices": list(done.choices)} if done.choices else {}
    units = dict(done.units)
    files = _write(out, result, section, units) if out else []
    emit(result, as_json, lambda: "\n".join([_text(result, units), *(f"written: {file}" for file in files)]))
    if any(point.status != "optimal" for point in (found, *front)):
        sys.exit(1)


def _point(optimum: Any, section: Any) -> dict[str, Any]:
    figures = {name: optimum.figures[name] for name in (section.objective, section.against)}
    return {"status": optimum.status, **figures, "variables": dict(optimum.variables)}


def _text(result: dict[str, Any], units: dict[str, str]) -> str:
    lines = [
        f"{result['status']} ({result['reason']}) after {result['iterations']} iterations: "
        f"{result['objective_name']} = {result['objective']:.6g}",
        *(f"{name} = {quantity_text(value, units.get(name, '-'), 6)}" for name, value in result["variables"].items()),
    ]
    for row in result.get("choices", ()):
        words = ", ".join(f"{key} = {row[key]}" for key in result["chosen"])
        best = " (best)" if all(row[key] == word for key, word in result["chosen"].items()) else ""
        lines.append(f"{words}: {row['status']}, {result['objective_name']} = {row['objective']:.6g}{best}")
    lines += ["active limits:" if result["active"] else "no limit is active"]
    lines += [
        f"  {row['name']} {row['side']} {quantity_text(row['limit'], row['unit'], 6)}: {row['meaning']}"
        for row in result["active"]
    ]
    if "pareto" in result:
        rows = [{k: v for k, v in p.items() if k != "variables"} | p["variables"] for p in result["pareto"]]
        lines += ["Pareto front:", table(rows, list(rows[0]), units)]
    return "\n".join(lines)


def _write(out: Path, result: dict[str, Any], section: Any, units: dict[str, str]) -> list[Path]:
    from mechsym.files import to_json, write_quantities, write_text

    files = [write_text(out / "optimum.json", to_json(result) + "\n")]
    if "pareto" in result:
        from mechsym.cycle.plots import pareto_picture

        points = result["pareto"]
        columns = {name: [p[name] for p in points] for name in (section.objective, section.against)}
        columns |= {name: [p["variables"][name] for p in points] for name in points[0]["variables"]}
        files.append(write_quantities(out / "pareto.csv", columns, units))
        files.append(pareto_picture(out / "pareto.svg", columns, section.objective, section.against, units))
    return files

"""`mechsym optimise`: design optimisation declared in a case."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from mechsym.cases import Case
from mechsym.cli.common import budget_option, case_command, emit, out_option, table
from mechsym.quantities.display import key_words, quantity_text

if TYPE_CHECKING:
    from mechsym.optimise.solver import Optimised


@case_command("Best design of a case under its limits.", out_option)
@budget_option
def optimise(case: Case, out: Path | None) -> None:
    """Best design of CASE under its limits, as its section [optimise] declares it; what each active limit costs.

    \b
    Examples: mechsym optimise nunes-hypocycloid
              mechsym optimise nunes-hypocycloid --set optimise.against=p_max --out front
              mechsym optimise mine.toml, with phase, dead volumes and gas of a Stirling engine in [optimise]
    Exit status 1: no feasible design, or the solver did not converge.
    """
    from mechsym.jobs.optimise import optimise as solve

    done = solve(case)
    files = _write(out, done) if out else []
    emit(done, lambda: _text(done), files=files)
    if any(point.status != "optimal" for point in (done.best, *done.front)):
        sys.exit(1)


def _text(done: "Optimised") -> str:
    from mechsym.optimise.shown import SIDES

    best, name = done.best, done.objective_name
    lines = [
        f"{best.status} ({best.reason}) after {best.iterations} iterations: {name} = {best.objective:.6g}",
        *(f"{key_words(n)} = {quantity_text(v, best.variables.units[n], 6)}" for n, v in best.variables.items()),
    ]
    for row in done.choices:
        words = ", ".join(f"{key} = {word}" for key, word in row.words.items())
        mark = " (best)" if row.words == done.chosen else ""
        lines.append(f"{words}: {row.status}, {name} = {row.objective:.6g}{mark}")
    lines += ["active limits:" if best.active else "no limit is active"]
    lines += [
        f"  {key_words(row.name)} {SIDES[row.side]} {quantity_text(row.limit, row.unit, 6)}: {row.meaning}"
        for row in best.active
    ]
    if done.pareto:
        rows = [{"status": p.status, **p.figures, **p.variables} for p in done.pareto]
        lines += ["Pareto front:", table(rows, list(rows[0]), _units(done))]
    return "\n".join(lines)


def _units(done: "Optimised") -> dict[str, str]:
    return {**done.pareto[0].figures.units, **done.pareto[0].variables.units}


def _write(out: Path, done: "Optimised") -> list[Path]:
    from mechsym.files import to_json, write_quantities, write_text

    files = [write_text(out / "optimum.json", to_json(done) + "\n")]
    if done.pareto:
        from mechsym.cycle.plots import pareto_picture

        points, aims = [{**p.figures, **p.variables} for p in done.pareto], tuple(done.pareto[0].figures)
        columns = {name: [p[name] for p in points] for name in points[0]}
        files.append(write_quantities(out / "pareto.csv", columns, _units(done)))
        files.append(pareto_picture(out / "pareto.svg", columns, aims[0], aims[-1], _units(done)))
    return files

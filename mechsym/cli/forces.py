"""`mechsym forces`: the force chain over one cycle."""

from pathlib import Path
from typing import Any

import click

from mechsym.cli.common import emit, json_option, out_option, pairs, set_option, table


@click.command()
@click.argument("case")
@click.option("--comparison", is_flag=True, help="Put slider crank, hypocycloid and rodless side by side.")
@set_option
@out_option
@json_option
@click.pass_context
def forces(
    ctx: click.Context,
    case: str,
    comparison: bool,
    overrides: tuple[str, ...],
    out: Path | None,
    as_json: bool,
) -> None:
    """Forces of CASE over one cycle at constant speed: pins, bearings, guides, teeth, shaking, friction.

    Exit status 1 when the balance that the case asks for in [shaking] is not reached.

    \b
    Example: mechsym forces moroianu --comparison --out forces
    """
    from mechsym import cases
    from mechsym.forces.result import forces as run
    from mechsym.forces.result import summary

    found = run(cases.load(case, pairs(overrides)), comparison)
    report = summary(found)
    report["files"] = [] if out is None else [str(file) for file in _write(found, report, out)]
    emit(report, as_json, lambda: _text(report))
    ctx.exit(1 if found.unbalanced else 0)


def _write(found: Any, report: dict[str, Any], out: Path) -> list[Path]:
    from mechsym import plots_forces, plots_mechanism
    from mechsym.files import to_json, write_csv, write_text
    from mechsym.plots import svg

    figures = {"forces": plots_forces.chain(found), "polar": plots_forces.polar_diagrams(found)}
    figures["orders"] = plots_forces.orders(found)
    case = found.turn.case
    figures["mechanism"] = plots_mechanism.figure(case.mechanism, case.need("parameters"), 0.8)
    if found.losses is not None:
        figures["friction"] = plots_forces.friction(found)
    files = [write_csv(out / "forces.csv", found.columns), write_text(out / "summary.json", to_json(report) + "\n")]
    page = plots_mechanism.animation(case.mechanism, case.need("parameters"), case.about)
    files.append(write_text(out / "mechanism.html", page))
    if found.comparison is not None:
        figures["comparison"] = plots_forces.comparison(found.comparison)
        rows = [{k: v for k, v in row.items() if not isinstance(v, dict)} for row in found.comparison]
        columns: dict[str, Any] = {k: ["" if row[k] is None else row[k] for row in rows] for k in rows[0]}
        files.append(write_csv(out / "comparison.csv", columns))
    return files + [write_text(out / f"{name}.svg", svg(figure)) for name, figure in figures.items()]


def _text(report: dict[str, Any]) -> str:
    names = [n for n in report["max"] if not n.startswith(("phi", "x", "psi", "R_", "two_mass", "terskih"))]
    rows = [{"quantity": n, "max": report["max"][n], "min": report["min"][n]} for n in names]
    lines = [f"{report['case']}: {report['mechanism']} at {report['speed_rpm']:.6g} rpm, SI units", ""]
    lines += [table(rows, ["quantity", "max", "min"]), "", f"power residual {report['power_residual']:.2g}"]
    weight = report["shaking"]["counterweight"]
    lines.append(
        f"counterweight {weight['unbalance']:.4g} kg m at {weight['angle_deg']:.4g} deg: "
        f"shaking force {weight['rms_before']:.4g} -> {weight['rms_after']:.4g} N rms"
    )
    for name, errors in (report["two_mass"] or {}).items():
        found = ", ".join(f"{k} {100 * v:.3g} %" for k, v in errors.items())
        lines.append(f"rod as two masses ({name.replace('_', ' ')}), error of the peak: {found}")
    lines += _friction(report["friction"]) + _rodless(report["rodless"])
    lines += [f"balance not reached: {reason}" for reason in report["balance"]["reasons"]]
    if report["comparison"]:
        shown = ["mechanism", "side_force_max", "crank_pin_max", "friction_per_piston", "mechanical_efficiency"]
        lines += ["", table(report["comparison"], shown)]
    return "\n".join(lines + [f"written: {file}" for file in report["files"]])


def _friction(found: dict[str, Any] | None) -> list[str]:
    if found is None:
        return []
    places = ", ".join(f"{name.replace('_', ' ')} {power:.4g}" for name, power in found["places"].items())
    efficiency = found["mechanical_efficiency"]
    share = "" if efficiency is None else f", mechanical efficiency {100 * efficiency:.4g} %"
    return [f"friction {found['power']:.4g} W{share} ({places})"]


def _rodless(found: dict[str, Any] | None) -> list[str]:
    if found is None:
        return []
    return [
        f"constraints: rank {found['constraint_rank']} of {found['constraint_count']}; guide and pin forces hold for "
        f"the closing rule {found['closing_rule']}",
        f"inertia resultant {found['inertia_resultant_min']:.6g} to {found['inertia_resultant_max']:.6g} N, at most "
        f"{found['resultant_off_crank_deg']:.2g} deg off the crank",
    ]

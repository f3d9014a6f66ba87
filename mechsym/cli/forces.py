"""`mechsym forces`: the force chain over one cycle."""

import dataclasses
from pathlib import Path
from typing import Any

import click

from mechsym.cli.common import case_of, emit, json_option, pairs, run_option, set_option, table
from mechsym.cli.speeds import parse_speeds
from mechsym.files import SUMMARY

_SHOWN = ("friction", "natural", "order", "no order")  # facts for the terminal; the page has them all


@click.command(short_help="Force chain over one cycle at constant speed.")
@click.argument("case")
@click.option("--diagram", type=click.Path(dir_okay=False), help="CSV of a measured diagram in place of the cycle.")
@click.option("--comparison", is_flag=True, help="Put slider crank, hypocycloid and rodless side by side.")
@click.option("--law", metavar="A:B:STEP", help="Fit the friction over these speeds (rpm) for [friction_pressure].")
@set_option
@run_option
@json_option
@click.pass_context
def forces(
    ctx: click.Context,
    case: str,
    diagram: str | None,
    comparison: bool,
    law: str | None,
    overrides: tuple[str, ...],
    out: Path | None,
    as_json: bool,
) -> None:
    """Forces of CASE over one cycle at constant speed: pins, bearings, guides, teeth, shaking, friction.

    Exit status 1 when the balance that the case asks for in [shaking] is not reached.

    \b
    Examples: mechsym forces moroianu --comparison --out forces
              mechsym forces generator --diagram measured.csv
              mechsym forces nunes-hypocycloid --law 1000:8000:1000
    """
    from mechsym.forces.summary import summary
    from mechsym.jobs.forces import forces as run
    from mechsym.jobs.forces import write
    from mechsym.jobs.gas import measured
    from mechsym.jobs.judged import of_forces
    from mechsym.jobs.own import is_own
    from mechsym.jobs.vibration import vibration
    from mechsym.torsion import train

    loaded = case_of(case, pairs(overrides))
    if is_own(loaded.mechanism):
        _own(loaded, out, as_json)
        return
    loaded = loaded if diagram is None else measured(loaded, diagram)
    found = run(loaded, comparison)
    report = summary(found, loaded.name, loaded.source)
    shaking = vibration(loaded, found.turn)
    report["vibration"] = None if shaking is None else dataclasses.asdict(shaking)
    report["doubts"] = of_forces(found) + (train.doubts(shaking) if shaking else ())
    report["facts"] += train.words(shaking) if shaking else ()
    report["friction_law"] = _law(loaded, law) if law else None
    report["files"] = [] if out is None else [str(file) for file in write(loaded, found, report, out)]
    emit(report, as_json, lambda: _text(report))
    ctx.exit(1 if found.unbalanced else 0)


def _own(case: Any, out: Path | None, as_json: bool) -> None:
    from mechsym.jobs import own_turn

    found = own_turn.turn(case)
    report = own_turn.summary(found, case)
    files = [] if out is None else [*own_turn.write(found, case, out), out / SUMMARY]
    report["files"] = [str(file) for file in files]
    emit(report, as_json, lambda: _own_text(report))


def _own_text(report: dict[str, Any]) -> str:
    acts = {name: who for name, who in report["reactions"].items()}
    rows = [{"quantity": n, "max": v, "min": report["min"][n], "of": acts.get(n, "")} for n, v in report["max"].items()]
    lines = [f"{report['case']}: {report['mechanism']} at {report['speed_rpm']:.6g} rpm, SI units", ""]
    lines += [table(rows, ["quantity", "max", "min", "of"]), "", f"power residual {report['power_residual']:.2g}"]
    return "\n".join(lines + [f"written: {file}" for file in report["files"]])


def _law(case: Any, speeds: str) -> dict[str, Any]:
    from mechsym.jobs.turn import fitted_law

    found = fitted_law(case, parse_speeds(speeds, "--law"))
    return {"law": "chen_flynn", **dataclasses.asdict(found.law), "misfit": found.misfit}


def _text(report: dict[str, Any]) -> str:
    from mechsym.forces.summary import quantities

    rows = [{"quantity": n, "max": report["max"][n], "min": report["min"][n]} for n in quantities(report)]
    lines = [f"{report['case']}: {report['mechanism']} at {report['speed_rpm']:.6g} rpm, SI units", ""]
    lines += [table(rows, ["quantity", "max", "min"]), "", f"power residual {report['power_residual']:.2g}"]
    weight = report["shaking"]["counterweight"]
    if weight["rms_before"] < 1e-6:
        lines.append("no force shakes the frame")
    else:
        lines.append(
            f"counterweight {weight['unbalance']:.4g} kg m at {weight['angle_deg']:.4g} deg: "
            f"shaking force {weight['rms_before']:.4g} -> {weight['rms_after']:.4g} N rms"
        )
    for name, errors in (report["two_mass"] or {}).items():
        found = ", ".join(f"{k} {100 * v:.3g} %" for k, v in errors.items())
        lines.append(f"rod as two masses ({name.replace('_', ' ')}), error of the peak: {found}")
    lines += _friction(report["friction"], report["friction_law"]) + _rodless(report["rodless"])
    lines += [f"balance not reached: {reason}" for reason in report["balance"]["reasons"]]
    if report["comparison"]:
        shown = ["mechanism", "side_force_max", "crank_pin_max", "friction_per_piston", "mechanical_efficiency"]
        lines += ["", table(report["comparison"], shown)]
    lines += [f"note: {fact}" for fact in report["facts"] if fact.startswith(_SHOWN)]
    lines += [f"{row['verdict']}: {row['claim']} ({row['source'][:3]}); {row['note']}" for row in report["claims"]]
    return "\n".join(lines + [f"written: {file}" for file in report["files"]])


def _friction(found: dict[str, Any] | None, law: dict[str, Any] | None) -> list[str]:
    if found is None:
        return []
    places = ", ".join(f"{name.replace('_', ' ')} {power:.4g}" for name, power in found["places"].items())
    efficiency = found["mechanical_efficiency"]
    share = "" if efficiency is None else f", mechanical efficiency {100 * efficiency:.4g} %"
    lines = [f"friction {found['power']:.4g} W{share} ({places})"]
    if law is not None:
        keys = ("constant", "per_peak_pressure", "per_speed", "per_speed_squared")
        lines += [f"[friction_pressure] fitted within {100 * law['misfit']:.2g} %:", 'law = "chen_flynn"']
        lines += [f"{key} = {law[key]:.6g}" for key in keys]
    return lines


def _rodless(found: dict[str, Any] | None) -> list[str]:
    if found is None:
        return []
    return [
        f"constraints: rank {found['constraint_rank']} of {found['constraint_count']}; guide and pin forces hold for "
        f"the closing rule {found['closing_rule']}",
        f"inertia resultant {found['inertia_resultant_min']:.6g} to {found['inertia_resultant_max']:.6g} N, at most "
        f"{found['resultant_off_crank_deg']:.2g} deg off the crank",
    ]

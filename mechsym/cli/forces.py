"""`mechsym forces`: the force chain over one cycle."""

import dataclasses
from pathlib import Path
from typing import Any

import click

from mechsym.cli.common import case_of, emit, in_rows, json_option, out_option, pairs, set_option, table
from mechsym.cli.speeds import parse_speeds
from mechsym.files import SUMMARY
from mechsym.quantities.display import SMALLEST, figure, quantity_text, ratio_text
from mechsym.quantities.names import stem_and_unit

_SHOWN = ("friction", "natural", "order", "no order")  # facts for the terminal; the page has them all
_SPLITS = {"two_mass": "its centre of mass kept", "terskih": "after Terskih"}
_LETTERS = {"N": "side force", "Z": "force towards the shaft", "T": "tangential force", "M": "torque"}


@click.command(short_help="Force chain over one cycle at constant speed.")
@click.argument("case")
@click.option("--diagram", type=click.Path(dir_okay=False), help="CSV of a measured diagram in place of the cycle.")
@click.option("--comparison", is_flag=True, help="Put slider crank, hypocycloid and rodless side by side.")
@click.option("--law", metavar="A:B:STEP", help="Fit the friction over these speeds (rpm) for [friction_pressure].")
@set_option
@out_option
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
    report["doubts"] = of_forces(loaded, found) + (train.doubts(shaking) if shaking else ())
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
    rows = [
        {
            "quantity": n,
            "max": v,
            "min": report["min"][n],
            "of": acts.get(n, ""),
            "unit": report["units"].get(n) or stem_and_unit(n)[1],
        }
        for n, v in report["max"].items()
    ]
    lines = [f"{report['case']}: {report['mechanism']} at {report['speed_rpm']:.6g} rpm; SI where no unit stands", ""]
    lines += [table(in_rows(rows, ("max", "min")), ["quantity", "max", "min", "unit", "of"]), ""]
    lines.append(f"power residual {ratio_text(report['power_residual'])}")
    if (lost := report["friction"]) is not None:
        places = ", ".join(f"{name} {power:.4g}" for name, power in lost["places"].items())
        lines.append(f"friction takes {lost['power']:.4g} W: {places or lost['note']}")
    if (shaken := report["shaking"]) is not None:
        weight = shaken["counterweight"]
        lines.append(
            f"shaking force {weight['rms_before']:.4g} N rms; {weight['rms_after']:.4g} N with a counterweight of "
            f"{weight['unbalance']:.4g} kg*m at {weight['angle_deg']:.4g} deg from the crank"
        )
    return "\n".join(lines + [f"written: {file}" for file in report["files"]])


def _law(case: Any, speeds: str) -> dict[str, Any]:
    from mechsym.jobs.turn import fitted_law

    found = fitted_law(case, parse_speeds(speeds, "--law"))
    return {"law": "chen_flynn", **dataclasses.asdict(found.law), "misfit": found.misfit}


def _text(report: dict[str, Any]) -> str:
    lines = [f"{report['case']}: {report['mechanism']} at {report['speed_rpm']:.6g} rpm", ""]
    lines += [_loads(report), "", f"power residual {ratio_text(report['power_residual'])}"]
    weight, largest = report["shaking"]["counterweight"], max(abs(v) for v in report["max"].values())
    if weight["rms_before"] < SMALLEST * largest:
        lines.append("no force shakes the frame")
    elif weight["rms_before"] - weight["rms_after"] < SMALLEST * weight["rms_before"]:
        before = quantity_text(weight["rms_before"], "N", 4)
        lines.append(f"a counterweight on the shaft cannot lessen the shaking force of {before} rms")
    else:
        before, after = (quantity_text(weight[key], "N", 4) for key in ("rms_before", "rms_after"))
        lines.append(
            f"counterweight {figure(weight['unbalance'], 4)} kg*m at {figure(weight['angle_deg'], 4)} deg: "
            f"shaking force {before} -> {after} rms"
        )
    for name, errors in (report["two_mass"] or {}).items():
        named = {_LETTERS.get(k, k.replace("_", " ")): v for k, v in errors.items() if v > SMALLEST}
        told = ", ".join(f"{k} {figure(100 * v, 3)} %" for k, v in named.items())
        lines.append(f"rod as two masses, {_SPLITS[name]}: the peak is wrong by {told or 'nothing'}")
    lines += _friction(report["friction"], report["friction_law"]) + _overconstrained(report.get(report["mechanism"]))
    lines += [f"balance not reached: {reason}" for reason in report["balance"]["reasons"]]
    if report["comparison"]:
        shown = ["mechanism", "side_force_max", "crank_pin_max", "friction_per_piston", "mechanical_efficiency"]
        lines += ["", table(report["comparison"], shown)]
    lines += [f"note: {fact}" for fact in report["facts"] if fact.startswith(_SHOWN)]
    lines += [f"{row['verdict']}: {row['claim']} ({_named(row['source'])}); {row['note']}" for row in report["claims"]]
    return "\n".join(lines + [f"written: {file}" for file in report["files"]])


def _loads(report: dict[str, Any]) -> str:
    from mechsym.forces.borne import borne

    rows = borne(report)
    several = ["of"] if any(row["of"] for row in rows) else []
    return table(in_rows(rows, ("max", "min")), ["quantity", *several, "max", "min", "unit", "on"])


def _named(stem: str) -> str:
    from mechsym.papers.sources import sources

    return sources(stem)[0].title.partition(",")[0]


def _friction(found: dict[str, Any] | None, law: dict[str, Any] | None) -> list[str]:
    if found is None:
        return []
    places = ", ".join(f"{name.replace('_', ' ')} {quantity_text(v, 'W', 4)}" for name, v in found["places"].items())
    efficiency = found["mechanical_efficiency"]
    share = "" if efficiency is None else f", mechanical efficiency {100 * efficiency:.4g} %"
    lines = [f"friction {quantity_text(found['power'], 'W', 4)}{share} ({places})"]
    if law is not None:
        keys = ("constant", "per_peak_pressure", "per_speed", "per_speed_squared")
        lines += [f"[friction_pressure] fitted within {100 * law['misfit']:.2g} %:", 'law = "chen_flynn"']
        lines += [f"{key} = {law[key]:.6g}" for key in keys]
    return lines


def _overconstrained(found: dict[str, Any] | None) -> list[str]:
    if found is None:
        return []
    return [
        f"constraints: rank {found['constraint_rank']} of {found['constraint_count']}; guide and pin forces hold for "
        f"the closing rule {found['closing_rule']}",
        f"inertia resultant {quantity_text(found['inertia_resultant_min'], 'N')} to "
        f"{quantity_text(found['inertia_resultant_max'], 'N')}, at most "
        f"{ratio_text(found['resultant_off_crank_deg'], 2)} deg off the crank",
    ]

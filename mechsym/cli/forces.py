"""`mechsym forces`: the force chain over one cycle."""

import re
from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym.cli.common import (
    case_of,
    emit,
    heads,
    in_rows,
    json_option,
    out_option,
    pairs,
    parse_speeds,
    set_option,
    table,
)
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.quantities.display import SMALLEST, figure, quantity_text, ratio_text
from mechsym.quantities.results import tell

if TYPE_CHECKING:
    from mechsym.cases import Case
    from mechsym.forces.driven import DrivenNumbers
    from mechsym.forces.result import Forces

_SHOWN = ("friction", "film", "natural", "order", "no order")  # facts for the terminal; the page has them all
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

    With [motion] in the case: driving forces, reactions and power over time, of any coordinates that it drives.

    Exit status 1 when the balance that the case asks for in [shaking] is not reached.

    \b
    Examples: mechsym forces moroianu --comparison --out forces
              mechsym forces generator --diagram measured.csv
              mechsym forces nunes-hypocycloid --law 1000:8000:1000
    """
    from mechsym.cases.outcomes import of_forces
    from mechsym.jobs.forces import forces as run
    from mechsym.jobs.forces import told, write
    from mechsym.jobs.gas import measured
    from mechsym.page import ranked
    from mechsym.torsion import twist
    from mechsym.torsion.shown import criticals

    loaded = case_of(case, pairs(overrides))
    if "motion" in loaded.sections:
        if unused := [
            option for option, value in (("--diagram", diagram), ("--comparison", comparison), ("--law", law)) if value
        ]:
            raise BadInput(f"{unused[0]}: is for a turn at constant speed; leave it, or [motion], out")
        return _motion(loaded, out, as_json)
    loaded = loaded if diagram is None else measured(loaded, diagram)
    found = run(loaded, comparison)
    numbers = told(loaded, found, parse_speeds(law, "--law") if law else None)
    report = tell(numbers)
    doubts = of_forces(loaded, found) + (twist.doubts(numbers.vibration) if numbers.vibration else ())
    report["doubts"] = doubts
    findings = ranked([*found.view.findings(), *criticals(numbers.vibration)])
    report["files"] = [] if out is None else [str(file) for file in write(loaded, found, report, out, findings)]
    beside = {"doubts": doubts, "files": report["files"]}
    said = {one.words for one in findings}
    emit(numbers, as_json, lambda: _text(report, found, said), beside=beside, files=report["files"], findings=findings)
    ctx.exit(1 if found.unbalanced else 0)


def _motion(case: "Case", out: Path | None, as_json: bool) -> None:
    from mechsym.cases.outcomes import of_motion
    from mechsym.forces.driven import numbers
    from mechsym.jobs.forces import motion, write_motion

    found = motion(case)
    told = numbers(found, case.name)
    files = [] if out is None else [str(file) for file in write_motion(found, tell(told), out)]
    beside = {"doubts": of_motion(case, found), "files": files}
    emit(told, as_json, lambda: _over_time(told), beside=beside, files=files)


def _over_time(report: "DrivenNumbers") -> str:
    units, slopes = report.max.units, re.compile(r"d2?\w+_d\w+")
    rows = [
        {"quantity": name, "max": high, "min": report.min[name], "unit": units[name]}
        for name, high in report.max.items() if not slopes.fullmatch(name)
    ]  # fmt: skip
    free = f"; {', '.join(report.free)} free" if report.free else ""
    lines = [f"{report.case}: {', '.join(report.driven)} driven{free}, {report.t_end:.6g} s", ""]
    lines.append(table(in_rows(rows, ("max", "min")), ["quantity", "max", "min", "unit"], named=["quantity"]))
    if report.power_residual is not None:
        lines.append(f"power residual {ratio_text(report.power_residual)}")
    return "\n".join(lines)


def _text(report: Json, found: "Forces", said: set[str]) -> str:
    from mechsym.forces.result import ComparedFriction, ComparedMechanism

    lines = [f"{report['case']}: {report['mechanism']} at {report['speed_rpm']:.6g} rpm", ""]
    lines += [
        _loads(found),
        "",
        *_journals(report["journals"]),
        f"power residual {ratio_text(report['power_residual'])}",
    ]
    if report["shaking"] is not None:
        lines.append(_shaking(report["shaking"]["counterweight"], max(abs(v) for v in report["max"].values())))
    for name, errors in (report["two_mass"] or {}).items():
        named = {_LETTERS.get(k, k.replace("_", " ")): v for k, v in errors.items() if v > SMALLEST}
        told = ", ".join(f"{k} {figure(100 * v, 3)} %" for k, v in named.items())
        lines.append(f"rod as two masses, {_SPLITS[name]}: the peak is wrong by {told or 'nothing'}")
    lines += _friction(report["friction"], report["friction_law"]) + _overconstrained(report.get(report["mechanism"]))
    lines += [f"balance not reached: {reason}" for reason in report["balance"]["reasons"]]
    if report["comparison"]:
        shown = ["mechanism", "side_force_max", "crank_pin_max", "friction_per_piston", "mechanical_efficiency"]
        lines += ["", table(report["comparison"], shown, heads(ComparedMechanism) | heads(ComparedFriction))]
    lines += [f"note: {fact}" for fact in report["facts"] if fact.startswith(_SHOWN) and fact not in said]
    lines += [f"{row['verdict']}: {row['claim']} ({_named(row['source'])}); {row['note']}" for row in report["claims"]]
    return "\n".join(lines)


def _shaking(weight: Json, largest: float) -> str:
    before, after = (quantity_text(weight[key], "N", 4) for key in ("rms_before", "rms_after"))
    if weight["rms_before"] < SMALLEST * largest:
        return "no force shakes the frame"
    if weight["rms_before"] - weight["rms_after"] < SMALLEST * weight["rms_before"]:
        return f"a counterweight on the shaft cannot lessen the shaking force of {before} rms"
    at = f"{figure(weight['unbalance'], 4)} kg*m at {figure(weight['angle_deg'], 4)} deg"
    return f"counterweight {at}: shaking force {before} -> {after} rms"


def _loads(found: "Forces") -> str:
    from mechsym.forces.shown import borne

    rows = [row | {"quantity": row["quantity"].replace("_*", "").replace("*", "")} for row in borne(found)]
    several = ["of"] if any(row["of"] for row in rows) else []
    return table(in_rows(rows, ("max", "min")), ["quantity", *several, "max", "min", "unit", "on"], named=["quantity"])


def _journals(rows: list[Json]) -> list[str]:
    if not rows:
        return []
    names = {
        "z": ("main bearing at z", "m"), "load_max": ("largest", "N"), "angle_of_max_deg": ("at", "deg"),
        "load_mean": ("mean", "N"), "specific_load": ("specific", "Pa"), "film_min": ("least film", "m"),
    }  # fmt: skip
    told = {name: unit for key, (name, unit) in names.items() if rows[0][key] is not None}
    return [table([{name: row[key] for key, (name, _) in names.items()} for row in rows], [*told], told), ""]


def _named(stem: str) -> str:
    from mechsym.papers.sources import sources

    return sources(stem)[0].title.partition(",")[0]


def _friction(found: Json | None, law: Json | None) -> list[str]:
    if found is None:
        return []
    if found["note"] is not None:
        return [f"friction {quantity_text(found['power'], 'W', 4)}: {found['note']}"]
    places = ", ".join(f"{name.replace('_', ' ')} {quantity_text(v, 'W', 4)}" for name, v in found["places"].items())
    efficiency = found["mechanical_efficiency"]
    share = "" if efficiency is None else f", mechanical efficiency {100 * efficiency:.4g} %"
    lines = [f"friction {quantity_text(found['power'], 'W', 4)}{share} ({places})"]
    if law is not None:
        keys = ("constant", "per_peak_pressure", "per_speed", "per_speed_squared")
        lines += [f"[friction_pressure] fitted within {100 * law['misfit']:.2g} %:", 'law = "chen_flynn"']
        lines += [f"{key} = {law[key]:.6g}" for key in keys]
    return lines


def _overconstrained(found: Json | None) -> list[str]:
    if found is None:
        return []
    return [
        f"constraints: rank {found['constraint_rank']} of {found['constraint_count']}; guide and pin forces hold for "
        f"the closing rule {found['closing_rule']}",
        f"inertia resultant {quantity_text(found['inertia_resultant_min'], 'N')} to "
        f"{quantity_text(found['inertia_resultant_max'], 'N')}, at most "
        f"{ratio_text(found['resultant_off_crank_deg'], 2)} deg off the crank",
    ]

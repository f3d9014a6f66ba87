"""`mechsym forces`: the force chain over one cycle."""

import re
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

from mechsym.cases import Case
from mechsym.cli import common
from mechsym.cli.common import emit, heads, in_rows, parse_speeds, table
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.quantities.display import SMALLEST, figure, quantity_text, ratio_text, residual_text, without_rounding
from mechsym.quantities.results import tell

if TYPE_CHECKING:
    from mechsym.forces.driven import DrivenNumbers
    from mechsym.forces.result import Forces

_SHOWN = ("friction", "film", "natural", "order", "no order")  # facts for the terminal; the page has them all
_SPLITS = {"two_mass": "its centre of mass kept", "terskih": "after Terskih"}
_LETTERS = {"N": "side force", "Z": "force towards the shaft", "T": "tangential force", "M": "torque"}


@common.case_command("Force chain over one cycle at constant speed.", common.out_option)
@common.diagram_option
@click.option("--comparison", is_flag=True, help="Put slider crank, hypocycloid and rodless side by side.")
@click.option("--law", metavar="A:B:STEP", help="Fit the friction over these speeds (rpm) for [friction_pressure].")
def forces(case: Case, diagram: str | None, comparison: bool, law: str | None, out: Path | None) -> None:
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
    from mechsym.jobs.forces import reported, write
    from mechsym.jobs.gas import measured
    from mechsym.page import ranked
    from mechsym.torsion import twist
    from mechsym.torsion.shown import criticals

    if "motion" in case.sections:
        others = {"--diagram": diagram, "--comparison": comparison, "--law": law}
        if unused := [option for option, value in others.items() if value]:
            raise BadInput(f"{unused[0]}: is for a turn at constant speed; leave it, or [motion], out")
        return _motion(case, out)
    case = case if diagram is None else measured(case, diagram)
    result = run(case, comparison)
    numbers = reported(case, result, parse_speeds(law, "--law") if law else None)
    report = tell(numbers)
    doubts = of_forces(case, result) + (twist.doubts(numbers.vibration) if numbers.vibration else ())
    report["doubts"] = doubts
    findings = ranked([*result.view.findings(), *criticals(numbers.vibration)])
    report["files"] = files = [] if out is None else [str(file) for file in write(case, result, report, out, findings)]
    said, beside = {one.words for one in findings}, {"doubts": doubts, "files": files}
    emit(numbers, lambda: _text(report, result, said), beside=beside, files=files, findings=findings)
    if result.unbalanced:
        sys.exit(1)


def _motion(case: Case, out: Path | None) -> None:
    from mechsym.cases.outcomes import of_motion
    from mechsym.forces.driven import numbers, write
    from mechsym.jobs.export import turning
    from mechsym.jobs.forces import motion
    from mechsym.mechanisms import roles_of

    driven = motion(case)
    summary = numbers(driven, case.name)
    files = []
    if out is not None:
        about = case.about or case.name
        files = [str(file) for file in write(driven, tell(summary), out, about, turning(case))]
    beside = {"doubts": of_motion(case, driven), "files": files}
    emit(summary, lambda: _over_time(summary, roles_of(case.mechanism).joints), beside=beside, files=files)


def _over_time(report: "DrivenNumbers", joints: Mapping[str, str]) -> str:
    units, slopes = report.max.units, re.compile(r"d2?\w+_d\w+")
    rows: list[Json] = [
        {"quantity": name, "max": high, "min": report.min[name], "unit": units[name], "on": joints.get(name, "")}
        for name, high in report.max.items()
        if not slopes.fullmatch(name)
    ]
    rows = without_rounding(rows, ("max", "min"))
    free = f"; {', '.join(report.free)} free" if report.free else ""
    lines = [f"{report.case}: {', '.join(report.driven)} driven{free}, {report.t_end:.6g} s", ""]
    lines.append(table(in_rows(rows, ("max", "min")), ["quantity", "max", "min", "unit", "on"], named=["quantity"]))
    lines += [f"work of the drive of {q}: {quantity_text(work, 'J', 4)}" for q, work in report.work.items()]
    if report.power_residual is not None:
        lines.append(f"power residual {residual_text(report.power_residual)}")
    return "\n".join(lines)


def _text(report: Json, result: "Forces", said: set[str]) -> str:
    from mechsym.forces.result import ComparedFriction, ComparedMechanism
    from mechsym.forces.shown import borne, named

    lines = [f"{report['case']}: {report['mechanism']} at {report['speed_rpm']:.6g} rpm", ""]
    rows = [row | {"quantity": named(row)} for row in borne(result)]
    columns = ["quantity", *(["of"] if any(row["of"] for row in rows) else []), "max", "min", "unit", "on"]
    lines += [table(in_rows(rows, ("max", "min")), columns, named=["quantity"]), "", *_journals(report["journals"])]
    lines.append(f"power residual {residual_text(report['power_residual'])}")
    if report["shaking"] is not None:
        lines.append(_shaking(report["shaking"]["counterweight"], max(abs(v) for v in report["max"].values())))
        for name, of in report["shaking"]["orders"].items():
            if name.startswith("moment"):
                size = max((a for k, a in zip(of["order"], of["amplitude"], strict=True) if k), default=0.0)
                lines.append(
                    f"{name.replace('_', ' about ')} on the frame: largest order {quantity_text(size, 'N*m', 4)}"
                )
    for name, errors in (report["two_mass"] or {}).items():
        beyond = {_LETTERS.get(k, k.replace("_", " ")): v for k, v in errors.items() if v > SMALLEST}
        words = ", ".join(f"{k} {figure(100 * v, 3)} %" for k, v in beyond.items())
        lines.append(f"rod as two masses, {_SPLITS[name]}: the peak is wrong by {words or 'nothing'}")
    lines += _friction(report["friction"], report["friction_law"]) + _overconstrained(report.get(report["mechanism"]))
    lines += [f"balance not reached: {reason}" for reason in report["balance"]["reasons"]]
    if report["comparison"]:
        shown = ["mechanism", "side_force_max", "crank_pin_max", "friction_per_piston", "mechanical_efficiency"]
        lines += ["", table(report["comparison"], shown, heads(ComparedMechanism) | heads(ComparedFriction))]
    lines += [f"note: {fact}" for fact in report["facts"] if fact.startswith(_SHOWN) and fact not in said]
    for row in report["claims"]:
        from mechsym.papers.sources import sources

        authors = sources(row["source"])[0].title.partition(",")[0]
        lines.append(f"{row['verdict']}: {row['claim']} ({authors}); {row['note']}")
    return "\n".join(lines)


def _shaking(weight: Json, largest: float) -> str:
    before, after = (quantity_text(weight[key], "N", 4) for key in ("rms_before", "rms_after"))
    if weight["rms_before"] < SMALLEST * largest:
        return "no force shakes the frame"
    if weight["rms_before"] - weight["rms_after"] < SMALLEST * weight["rms_before"]:
        return f"a counterweight on the shaft cannot lessen the shaking force of {before} rms"
    at = f"{figure(weight['unbalance'], 4)} kg*m at {figure(weight['angle_deg'], 4)} deg"
    return f"counterweight {at}: shaking force {before} -> {after} rms"


def _journals(rows: list[Json]) -> list[str]:
    if not rows:
        return []
    names = {
        "z": ("main bearing at z", "m"), "load_max": ("largest", "N"), "angle_of_max_deg": ("at", "deg"),
        "load_mean": ("mean", "N"), "specific_load": ("specific", "Pa"), "film_min": ("least film", "m"),
    }  # fmt: skip
    columns = {name: unit for key, (name, unit) in names.items() if rows[0][key] is not None}
    return [table([{name: row[key] for key, (name, _) in names.items()} for row in rows], [*columns], columns), ""]


def _friction(data: Json | None, law: Json | None) -> list[str]:
    if data is None:
        return []
    if data["note"] is not None:
        return [f"friction {quantity_text(data['power'], 'W', 4)}: {data['note']}"]
    places = ", ".join(f"{name.replace('_', ' ')} {quantity_text(v, 'W', 4)}" for name, v in data["places"].items())
    efficiency = data["mechanical_efficiency"]
    share = "" if efficiency is None else f", mechanical efficiency {100 * efficiency:.4g} %"
    lines = [f"friction {quantity_text(data['power'], 'W', 4)}{share} ({places})"]
    if law is not None:
        keys = ("constant", "per_peak_pressure", "per_speed", "per_speed_squared")
        many, near = law["speeds"], f"within {100 * law['misfit']:.2g} %"
        close = near if many > len(keys) else f"{near}, no more than it has constants: how well it fits is open"
        lines += [f"[friction_pressure] fitted to {many} speed{'s' * (many > 1)} {close}:", 'law = "chen_flynn"']
        lines += [f"{key} = {law[key]:.6g}" for key in keys]
    return lines


def _overconstrained(data: Json | None) -> list[str]:
    if data is None:
        return []
    return [
        f"constraints: rank {data['constraint_rank']} of {data['constraint_count']}; guide and pin forces hold for "
        f"the closing rule {data['closing_rule']}",
        f"inertia resultant {quantity_text(data['inertia_resultant_min'], 'N')} to "
        f"{quantity_text(data['inertia_resultant_max'], 'N')}, at most "
        f"{ratio_text(data['resultant_off_crank_deg'], 2)} deg off the crank",
    ]

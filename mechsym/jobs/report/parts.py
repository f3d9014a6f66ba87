"""The parts of a report, each by the job of its command."""

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from mechsym.cases import Case, written
from mechsym.cases.needs import lacking
from mechsym.cycle.kinds import kind_of
from mechsym.errors import BadInput, MissingSection
from mechsym.hinge.result import complete
from mechsym.hinge.summary import summary as hinge_summary
from mechsym.jobs.cycle import cycle
from mechsym.jobs.forces import forces
from mechsym.jobs.gas import gas
from mechsym.jobs.hinge import hinge
from mechsym.jobs.judged import of_cycle, of_forces, of_gas
from mechsym.jobs.measured import measured_combustion, summary
from mechsym.jobs.own import is_own
from mechsym.jobs.report.force_part import force_part
from mechsym.jobs.report.own_force_part import own_force_part
from mechsym.jobs.report.part import DONE, INFEASIBLE, LEFT_OUT, REFUSED, ReportPart
from mechsym.jobs.run import run
from mechsym.jobs.shown import span, tightest
from mechsym.jobs.size import check_printed, size
from mechsym.machine.record import gas_of
from mechsym.mechanisms.traits import rules_of
from mechsym.page import grid
from mechsym.plausible import results
from mechsym.quantities.display import figure, quantity_text, ratio_text, shown_in

TITLES = {
    "cycle": "Engine cycle",
    "hinge": "Hinge, guide and spring",
    "forces": "Forces on bearings, pins and guides",
    "size": "Sizes and safety factors",
    "simulate": "Run in time",
}
_MODEL, _CLOSED = "the cycle is a model: ", "the closed period only, gas exchange at constant pressure"
_BRAKE = (
    "brake power is after all losses of a whole engine, by [friction_pressure], auxiliaries and pumping among them; "
    "the friction of bearings, guides and rings that is counted part by part is less"
)
_HINGE = (
    "the ripple is that of an ideal hinge at one speed and one load; friction, heat and a lost combustion stand beside "
    "it, with assumed data",
    "rigid links, massless rollers, no play",
)
_SAID = {"torque_avg": "mean_torque", "torque_max": "largest_torque"}
_ENDS = {"turns": "did its turns", "t_end": "came to its end"}


def part(name: str, case: Case) -> ReportPart:
    """A part of the report of a case; bad input and what is missing are told in it."""
    missing = lacking(case.mechanism, written(case))[name]
    if missing:
        return ReportPart(name=name, title=TITLES[name], state=LEFT_OUT, reason=f"the case lacks {'; '.join(missing)}")
    try:
        return _MADE[name](case)
    except BadInput as error:
        state = LEFT_OUT if isinstance(error, MissingSection) else REFUSED
        return ReportPart(name=name, title=TITLES[name], state=state, reason=" ".join(str(error).split()))


def _cycle(case: Case) -> ReportPart:
    if kind_of(case.need("cycle")).measured:
        return _measured(case)
    found = cycle(case)
    view, acting = found.view, None if is_own(case.mechanism) else gas(case)
    pictures = () if acting is None else acting.view.pictures
    power, rpm = float(found["power_kw"][0]), float(found["speed_rpm"][0])
    many, each = found.get("cylinders", 1), found.get("each", "cylinder")
    verdict = f"The gas {'takes' if power < 0 else 'gives'} {quantity_text(1e3 * abs(power), 'W', 4)} at " + (
        f"{figure(rpm, 4)} rpm" + (f", {many} {each}s" if many > 1 else "")
    )
    rubs = bool(np.any(found.get("friction_mep_kpa", 0.0)))
    one = {k: v for k, v in (found.get("per_cylinder") or {}).items() if rubs or not k.startswith("brake")}
    rows = [{"of": "engine", **{_SAID.get(k, k): float(found[k][0]) for k in one}}]
    rows += [{"of": f"one {each}", **{_SAID.get(k, k): float(v[0]) for k, v in one.items()}}] if many > 1 else []
    facts = () if acting is None else tuple(acting.pressure.facts)
    given = kind_of(case.need("cycle")).given
    return ReportPart(
        name="cycle", title=TITLES["cycle"], view=dataclasses.replace(view, pictures=(*view.pictures, *pictures)),
        verdict=f"{verdict}.", facts=facts,
        grids=(grid("Torque and power", rows, list(rows[0])),) if one else (),
        silent=(_MODEL + (_CLOSED if given == "engine" else "what it assumes stands with its figure"),
                *([_BRAKE] if rubs and "friction_pressure" in case.sections else [])),
        numbers=dict(found), doubts=(*of_cycle(case, found), *of_gas(case, acting)),
    )  # fmt: skip


def _measured(case: Case) -> ReportPart:
    acting, found = gas(case), measured_combustion(case)
    numbers = summary(found)
    mean = f"{figure(numbers['mep_bar'], 3)} bar indicated at {figure(numbers['speed_rpm'], 4)} rpm"
    return ReportPart(
        name="cycle", title=TITLES["cycle"], view=None if acting is None else acting.view,
        verdict=f"The measured cycles give {mean}.", facts=() if acting is None else tuple(acting.pressure.facts),
        grids=(grid("Cycle by cycle", numbers["cycles"], list(numbers["cycles"][0])),),
        silent=("the gas is what was measured, at its speed and load",), numbers=numbers, doubts=found.doubts,
    )  # fmt: skip


def _hinge(case: Case) -> ReportPart:
    design = complete(hinge(case))
    numbers, verdict = hinge_summary(design), design.verdict
    checks = sorted((c for c in verdict.checks if c.margin is not None), key=lambda c: c.margin or 0.0)
    rows = [{"check": c.name.replace("_", " "), "value and limit": c.text, "kept": "yes" if c.kept else "NO",
             "margin": _per_cent(c.shown_margin)} for c in verdict.checks]  # fmt: skip
    runs = [
        {"run": t.about, "ripple": ratio_text(t.speed_ripple), "end": _ENDS.get(t.result.end, t.result.end)}
        for t in design.trials
    ]
    saved = quantity_text(numbers["flywheel_inertia_saved"], "kg*m^2", 4)
    decide, told = [], f"The hinge {'can' if verdict.feasible else 'CANNOT'} be built: {verdict.reason}."
    if not verdict.feasible:
        decide.append(f"the hinge as it stands cannot be built: {verdict.reason}; change spring, guide or limits")
    if numbers["misfire_speed_share"] == 0:
        decide.append("the flywheel beside the hinge: with the one that is kept a single misfire stops the shaft "
                      "('mechsym codesign' gives one that does not)")  # fmt: skip
    if numbers["losses"] is not None:
        share = figure(100 * numbers["losses"]["share"], 3)
        decide.append(f"whether the flywheel that the hinge saves pays for {share} % of the load torque lost in it")
    limits = [c.text for c in checks if not c.kept] or [f"{c.text} (margin {figure(100 * (c.margin or 0), 3)} %)"
                                                        for c in checks[:3]]  # fmt: skip
    return ReportPart(
        name="hinge", title=TITLES["hinge"], view=design.view, state=DONE if verdict.feasible else INFEASIBLE,
        reason="" if verdict.feasible else verdict.reason,
        verdict=f"{told} It saves a flywheel of {saved}." if verdict.feasible else told,
        grids=(grid("Limits of the guide", rows, ["check", "value and limit", "kept", "margin"]),
               grid("Runs in time", runs, ["run", "ripple", "end"])),
        limits=tuple(limits), decide=tuple(decide), numbers=numbers, doubts=of_gas(case, gas_of(design.machine)),
        silent=_HINGE,
    )  # fmt: skip


def _per_cent(share: float | None) -> str:
    return "–" if share is None else f"{figure(100 * share, 3)} %"


def _forces(case: Case) -> ReportPart:
    if is_own(case.mechanism):
        return own_force_part(TITLES["forces"], case)
    found = forces(case)
    return force_part(TITLES["forces"], case, found, of_forces(case, found))


def _size(case: Case) -> ReportPart:
    printed = rules_of(case.mechanism) == "slider crank" and "part_crosshead" in case.sections
    found = check_printed(case) if printed else size(case)
    sizes = [_sized(row) for row in found.rows if row["limit"] is None]
    checks = [_sized(row) | {"": "" if row["holds"] else "BELOW"} for row in found.rows if row["limit"] is not None]
    tight = [_tight(row) for row in tightest(found)[:3]]
    bad = bool(found.failing) or not found.converged
    state = f"{len(found.failing)} of {len(checks)} safety factors are too low" if found.failing else \
        f"All {len(checks)} safety factors hold" if checks else "Loads only: no rule sizes its parts"  # fmt: skip
    shown = ["component", "quantity", "value", "limit", "unit", "safety_factor", "wanted", "rule", ""]
    return ReportPart(
        name="size", title=TITLES["size"], view=found.view, state=INFEASIBLE if bad else DONE, verdict=f"{state}.",
        reason="" if not bad else state if found.failing else "masses and loads do not agree",
        grids=(grid("Sizes", sizes, ["component", "quantity", "value", "unit", "note"]), grid("Checks", checks, shown)),
        limits=tuple(tight), numbers=found.rows,
        silent=("sizes follow standards; no finite elements",) if checks else (),
        decide=tuple(f"{c.component}: {c.quantity} is below the wanted factor" for c in found.failing),
    )  # fmt: skip


def _sized(row: Mapping[str, Any]) -> dict[str, Any]:
    """A row with value and limit in the unit that suits them."""
    if row["unit"] in ("", "-"):
        return {**row, "unit": ""}
    values, unit = shown_in([row["value"], row["limit"]], str(row["unit"]))
    return {**row, "value": values[0], "limit": values[1], "unit": unit}


def _tight(row: Mapping[str, Any]) -> str:
    """A check with its limit, where that is more than the factor itself."""
    factor = f"factor {figure(row['safety_factor'], 3)} of at least {figure(row['wanted'], 3)}"
    shown = _sized(row)
    value, limit = (figure(shown[key], 4) for key in ("value", "limit"))
    beside = f"{value} beside a limit of {limit} {shown['unit']}, " if shown["unit"] else ""
    return f"{row['component']}, {row['quantity']}: {beside}{factor}"


def _simulate(case: Case) -> ReportPart:
    found = run(case)
    bad = found.summary["status"] in ("failed", "not converged", "chaotic")
    told = found.summary
    of = f" of the {found.engine.words}" if found.engine and found.engine.words else ""
    speed = f"over the last period the speed{of} is {span(found.speed['min'], found.speed['max'])}"
    numbers = {k: v for k, v in told.items() if k != "wall_s"}  # another each time
    end = f"{_ENDS.get(told['end'], 'ended by ' + told['end'])} in {figure(told['t_end'], 3)} s"
    stall = tuple(text for text in found.findings if text.startswith("the shaft stops"))
    return ReportPart(
        name="simulate", title=TITLES["simulate"], view=found.view, state=INFEASIBLE if bad else DONE,
        reason=told["reason"] if bad else "", facts=found.findings, decide=stall, numbers=numbers,
        verdict=f"The run {end}" + (", the shaft stands." if stall else f"; {speed}."),
        silent=("the load of the run is the case's, or a propeller that takes the mean torque",), doubts=found.doubts,
    )  # fmt: skip


_MADE: Mapping[str, Callable[[Case], ReportPart]] = {
    "cycle": _cycle, "hinge": _hinge, "forces": _forces, "size": _size, "simulate": _simulate,
}  # fmt: skip


def doubts_of(found: ReportPart) -> tuple:
    """Doubts of a part: its own, and those that its numbers show."""
    return (*found.doubts, *results(found.numbers or {}))

"""The parts of a report, each by the job of its command, and its answer, which stands before them."""

import dataclasses
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from mechsym.cases import Case
from mechsym.cases.facts import facts_of
from mechsym.cases.needs import in_words, lacking
from mechsym.cases.outcomes import of_cycle, of_forces, of_gas
from mechsym.cycle.columns import AFTER_FRICTION, WORDS, CycleColumns, CycleFigures
from mechsym.cycle.kinds import kind_of
from mechsym.cycle.measured.shown import bars
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.forces.friction import AUXILIARIES, NO_PLACE
from mechsym.forces.result import Forces
from mechsym.forces.shown import borne, named
from mechsym.forces.summary import half
from mechsym.hinge.result import complete, ripple_text
from mechsym.hinge.shown import scenes
from mechsym.hinge.summary import HingeNumbers
from mechsym.jobs.cycle import cycle
from mechsym.jobs.forces import forces, reported
from mechsym.jobs.gas import gas, source
from mechsym.jobs.hinge import hinge
from mechsym.jobs.measured import MeasuredCycle, MeasuredDiagram, RecordAmongOthers, measured_combustion
from mechsym.jobs.run import run
from mechsym.jobs.size import check_printed, size
from mechsym.mechanisms import roles_of
from mechsym.page import Card, Finding, Grid, card, grid, ranked
from mechsym.plausible import Doubt, results, sifted
from mechsym.quantities import record
from mechsym.quantities.display import figure, key_words, quantity_text, shown_in
from mechsym.quantities.results import some, tell, units_of
from mechsym.report.part import DONE, INFEASIBLE, LEFT_OUT, REFUSED, ReportPart, over_time
from mechsym.sizing.rows import tightest
from mechsym.torsion import twist
from mechsym.torsion.shown import criticals, span

_GIVES = "The engine gives"  # with which a sentence on the power at the shaft begins: it stands first


def force_part(title: str, case: Case, result: Forces, doubts: tuple[Doubt, ...]) -> ReportPart:
    """The part of a force analysis."""
    numbers = reported(case, result)
    doubts += twist.doubts(numbers.vibration) if numbers.vibration else ()
    reasons = tuple(result.unbalanced)
    return ReportPart(
        name="forces", title=title, view=result.view, state=INFEASIBLE if reasons else DONE, reason="; ".join(reasons),
        verdict=f"{_friction(result)}.", facts=tuple(numbers.numbers.facts), grids=(_borne(result),),
        decide=reasons, doubts=doubts, silent=("rigid links at constant speed; friction of the first order",),
        numbers=numbers, beside=tuple(criticals(numbers.vibration)),
    )  # fmt: skip


def _friction(result: Forces) -> str:
    if result.losses is None:
        return "Bearings and guides are without friction: the case has no [friction]"
    if not result.losses.places.keys() - {"rings"}:
        return f"Friction is {NO_PLACE}"
    power, share = quantity_text(sum(result.losses.places.values()), "W", 4), result.losses.mechanical_efficiency
    share_text = "" if share is None else f": mechanical efficiency {figure(100 * share, 3)} %"
    if share is not None and not half(result):
        brake = quantity_text(share * result.losses.indicated_power, "W", 4)
        return f"{_GIVES} {brake} at its shaft (brake), friction takes {power}{share_text}"
    of = " of one piston" if half(result) else ""
    whole = AUXILIARIES in result.losses.places
    what = "Friction, that of auxiliaries included," if whole else "Friction of bearings and guides"
    return f"{what}{of} takes {power}{share_text}"


def _borne(result: Forces) -> Grid:
    rows = borne(result)
    several = any(row["of"] for row in rows)
    cells = [
        (named(row), *([row["of"]] if several else []), *_extremes(row), row["on"])
        for row in rows
    ]  # fmt: skip
    headings = ("quantity", *(["of"] if several else []), "largest", "smallest", "on")
    right = tuple(name in ("largest", "smallest") for name in headings)
    return Grid(title="What bears what", headings=headings, rows=tuple(cells), numbers=right)


def _extremes(row: Json) -> list[str]:
    """Largest and smallest in one unit, that of the larger."""
    values, unit = shown_in([row["max"], row["min"]], row["unit"])
    least = 10.0 ** (math.floor(math.log10(max(map(abs, values)) or 1.0)) - 4)  # a digit beyond the last of the larger
    texts = [figure(round(value / least) * least, 4) for value in values]
    return [text if unit in ("", "-") else f"{text} {unit}" for text in texts]


_MODEL, _CLOSED = "the cycle is a model: ", "the closed period only, gas exchange at constant pressure"
_ASSUMES = "what it assumes stands with its figure"
_FIRST = ("speed", "brake power", "BMEP", "BSFC", "indicated power", "power", "p_max", "IMEP net", "COV of net IMEP",
          "CA50", "largest pressure", "rate of rise")  # fmt: skip
_HINGE = (
    "the ripple is that of an ideal hinge at one speed and one load; friction, heat and a lost combustion stand beside "
    "it, with assumed data",
    "rigid links, massless rollers, no play",
)
# a figure after friction and the same without
_PAIRS = {
    "mean effective pressure": ("brake_mep_kpa", "mep_kpa"), "power": ("brake_power_kw", "power_kw"),
    "mean torque": ("brake_torque", "torque_avg"), "fuel consumption": ("brake_sfc_g_kwh", "sfc_g_kwh"),
    "efficiency": ("brake_efficiency", "efficiency"),
}  # fmt: skip
_BESIDE = ("gross_mep_kpa", "pumping_mep_kpa", "friction_mep_kpa", "mechanical_efficiency", "ca10_deg", "ca50_deg",
           "ca90_deg", "p_max_mpa", "p_max_angle_deg", "volumetric_efficiency")  # fmt: skip
_LOADED = ("the load of the run is the case's, or a propeller that takes the mean torque",)
_ENDS = {"turns": "did its turns", "t_end": "came to its end"}


def part(name: str, case: Case) -> ReportPart:
    """A part of the report of a case; bad input and what is missing are told in it."""
    kind, facts = PARTS[name], facts_of(case.mechanism, case.sections)
    if missing := in_words(facts, lacking(facts).get(name, [])):
        lacks = [f"the case lacks {what}" if what.startswith(("[", "drive.")) else what for what in missing]
        return ReportPart(name=name, title=kind.title, state=LEFT_OUT, reason="; ".join(lacks))
    try:
        return kind.made_of(case)
    except BadInput as error:
        return ReportPart(name=name, title=kind.title, state=REFUSED, reason=" ".join(str(error).split()))


def _cycle(case: Case) -> ReportPart:
    if kind_of(case.need("cycle")).measured:
        return combustion_part(measured_combustion(case))
    figures = cycle(case)
    view, acting = figures.view, gas(case)
    pictures = () if acting is None else acting.view.pictures
    power, rpm = float(figures["power_kw"][0]), float(figures["speed_rpm"][0])
    many, each = figures.get("cylinders", 1), figures.get("each", "cylinder")
    rubs = bool(np.any(figures.get("friction_mep_kpa", 0.0)))
    at = f"at {figure(rpm, 4)} rpm" + (f", {many} {each}s" if many > 1 else "")
    gas_power = quantity_text(1e3 * abs(power), "W", 4)
    verdict = f"The gas {'takes' if power < 0 else 'gives'} {gas_power} (indicated) {at}"
    if rubs:
        shaft = quantity_text(1e3 * float(figures["brake_power_kw"][0]), "W", 4)
        verdict = f"{_GIVES} {shaft} at its shaft (brake), {gas_power} in its cylinders (indicated), {at}"
    shown = CycleFigures({k: v for k, v in figures.items() if rubs or k not in AFTER_FRICTION})
    facts = () if acting is None else tuple(acting.pressure.facts)
    return ReportPart(
        name="cycle", title=PARTS["cycle"].title, view=dataclasses.replace(view, pictures=(*view.pictures, *pictures)),
        verdict=f"{verdict}.", facts=facts, grids=(_work_grid(shown, each, many), _beside(shown)),
        silent=(_MODEL + (_CLOSED if kind_of(case.need("cycle")).closed else _ASSUMES),),
        numbers=figures, doubts=(*of_cycle(case, figures, source(case).bound), *of_gas(case, acting)),
    )  # fmt: skip


def _work_grid(figures: CycleFigures, each: str, many: int) -> Grid:
    """Brake figures beside the indicated ones, of the engine and of one cylinder."""
    rubs = "brake_mep_kpa" in figures
    rows = [(name, *(_value(figures, key) for key in keys)) for name, keys in _PAIRS.items() if keys[1] in figures]
    if many > 1:
        one = dict(figures.get("per_cylinder") or {})
        rows += [(f"{name} of one {each}", *(_value(one, key) for key in keys))
                 for name, keys in _PAIRS.items() if keys[1] in one]  # fmt: skip
    heads = ("", "brake", "indicated, net") if rubs else ("", "indicated, net")
    cells = tuple(row if rubs else (row[0], row[2]) for row in rows)
    return Grid(title="Brake and indicated" if rubs else "Indicated", headings=heads, rows=cells,
                numbers=tuple(head != "" for head in heads))  # fmt: skip


def _beside(figures: CycleFigures) -> Grid:
    rows = tuple((WORDS[key], _value(figures, key)) for key in _BESIDE if key in figures)
    return Grid(title="Mean pressures, combustion and peak", headings=("", "value"), rows=rows, numbers=(False, True))


def _value(figures: Json, key: str) -> str:
    value = float(np.ravel(figures.get(key, math.nan))[0])
    return "–" if math.isnan(value) else card(CycleColumns, key, value).value


def combustion_part(measured: MeasuredDiagram) -> ReportPart:
    """The part of a measured diagram: a combustion analysis."""
    numbers, figures = tell(measured), measured.figures
    heads = {name: unit for name, unit in units_of(MeasuredCycle).items() if unit != "-"}
    rows, each = numbers["cycles"], units_of(RecordAmongOthers)
    beside = [{**row, "file": Path(row["file"]).name, "imep_interval_bar": bars(*row["imep_interval_bar"])}
              for row in numbers["records"]]  # fmt: skip
    view, centre, (low, high) = measured.combustion.view, measured.dead_centre, measured.dead_centre.interval_deg
    cards = (
        Card(name="exponent of compression", value=figure(measured.n_compression, 4), about="-90 to -30 deg"),
        Card(name="exponent of expansion", value=figure(measured.n_expansion, 4), about="60 to 110 deg"),
        Card(name="dead centre of the file", value=f"{centre.deg:.2f} deg", about=f"95 %: {low:.2f} to {high:.2f} deg"),
    )
    mean = f"a net IMEP of {bars(figures.imep_bar)}, 19 times in 20 within {bars(*figures.imep_interval_bar)}"
    return ReportPart(
        name="cycle", title="Combustion of the measured cycles",
        view=dataclasses.replace(view, cards=(*view.cards, *cards)),
        verdict=f"The measured cycles give {mean}, at {figure(measured.speed_rpm, 4)} rpm.", facts=measured.facts,
        grids=(grid("Records of one encoder", beside, list(beside[0]) if beside else [], each),
               grid("Cycle by cycle", rows, list(rows[0]), heads)),
        silent=("the gas is what was measured, at its speed and load",), numbers=measured, doubts=measured.doubts,
    )  # fmt: skip


def _hinge(case: Case) -> ReportPart:
    design = complete(hinge(case))
    numbers, verdict = HingeNumbers(judged=design), design.verdict
    checks = sorted((c for c in verdict.checks if c.margin is not None), key=lambda c: c.margin or 0.0)
    rows = [{"check": c.name.replace("_", " "), "value and limit": c.text, "kept": "yes" if c.kept else "NO",
             "margin": _per_cent(c.shown_margin)} for c in verdict.checks]  # fmt: skip
    runs = [
        {"run": t.about, "ripple": ripple_text(t.speed_ripple), "end": _ENDS.get(t.result.end, t.result.end)}
        for t in design.trials
    ]
    saved = quantity_text(numbers.flywheel_inertia_saved, "kg*m^2", 4)
    decide, answer = [], f"The {design.answer}."
    if verdict.feasible and not design.target.met:
        decide.append(f"{design.target.words} ('mechsym codesign --losses inside' designs with them)")
    if not verdict.feasible:
        decide.append(f"the hinge as it stands cannot be built: {verdict.reason}; change spring, guide or limits")
    if numbers.misfire_speed_share == 0:
        decide.append("the flywheel beside the hinge: with the one that is kept a single misfire stops the shaft "
                      "('mechsym codesign' gives one that does not)")  # fmt: skip
    if numbers.losses is not None and numbers.losses.share is not None:
        share = figure(100 * numbers.losses.share, 3)
        decide.append(f"whether the flywheel that the hinge saves pays for {share} % of the load torque lost in it")
    limits = [c.text for c in checks if not c.kept] or [f"{c.text} (margin {figure(100 * (c.margin or 0), 3)} %)"
                                                        for c in checks[:3]]  # fmt: skip
    return ReportPart(
        name="hinge", title=PARTS["hinge"].title, view=design.view, state=DONE if verdict.feasible else INFEASIBLE,
        reason="" if verdict.feasible else verdict.reason,
        verdict=f"{answer} An ideal hinge saves a flywheel of {saved}." if verdict.feasible else answer,
        grids=(grid("Limits of the guide", rows, ["check", "value and limit", "kept", "margin"]),
               grid("Runs in time", runs, ["run", "ripple", "end"])),
        limits=tuple(limits), decide=tuple(decide), numbers=numbers, doubts=of_gas(case, design.machine.gas),
        silent=_HINGE, turning=lambda: scenes(design),
    )  # fmt: skip


def _per_cent(share: float | None) -> str:
    return "–" if share is None else f"{figure(100 * share, 3)} %"


def _forces(case: Case) -> ReportPart:
    if "motion" in case.sections:
        return over_time(PARTS["forces"].title, case)
    result = forces(case)
    return force_part(PARTS["forces"].title, case, result, of_forces(case, result))


def _size(case: Case) -> ReportPart:
    printed = roles_of(case.mechanism).rules == "slider crank" and "part_crosshead" in case.sections
    sizing = check_printed(case) if printed else size(case)
    # a reaction keeps its letter with the index
    rows = [{**row, "component": row["component"] if row["component"][:2] == "R_" else key_words(row["component"])}
            for row in sizing.rows]  # fmt: skip
    sizes = [_sized(row) for row in rows if row["limit"] is None]
    checks = [_sized(row) | {"": "" if row["holds"] else "BELOW"} for row in rows if row["limit"] is not None]
    tight = [_tight(row) for row in tightest(sizing)[:3]]
    bad = bool(sizing.failing) or not sizing.converged
    state = f"{len(sizing.failing)} of {len(checks)} safety factors are too low" if sizing.failing else \
        f"All {len(checks)} safety factors hold" if checks else "Loads only: no rule sizes its parts"  # fmt: skip
    shown = ["component", "quantity", "value", "limit", "unit", "safety_factor", "wanted", "rule", ""]
    return ReportPart(
        name="size", title=PARTS["size"].title, view=sizing.view, state=INFEASIBLE if bad else DONE,
        verdict=f"{state}.", reason="" if not bad else state if sizing.failing else "masses and loads do not agree",
        grids=(grid("Sizes", sizes, ["component", "quantity", "value", "unit", "note"]), grid("Checks", checks, shown)),
        limits=tuple(tight), numbers=sizing.rows,
        silent=("sizes follow standards; no finite elements",) if checks else (),
        decide=tuple(f"{key_words(c.component)}: {c.quantity} is below the wanted factor" for c in sizing.failing),
    )  # fmt: skip


def _sized(row: Json) -> Json:
    """A row with value and limit in the unit that suits them."""
    if row["unit"] in ("", "-"):
        return {**row, "unit": ""}
    values, unit = shown_in([row["value"], row["limit"]], str(row["unit"]))
    return {**row, "value": values[0], "limit": values[1], "unit": unit}


def _tight(row: Json) -> str:
    """A check with its limit, where that is more than the factor itself."""
    factor = f"factor {figure(row['safety_factor'], 3)} of at least {figure(row['wanted'], 3)}"
    shown = _sized(row)
    value, limit = (figure(shown[key], 4) for key in ("value", "limit"))
    beside = f"{value} beside a limit of {limit} {shown['unit']}, " if shown["unit"] else ""
    return f"{key_words(row['component'])}, {row['quantity']}: {beside}{factor}"


def _simulate(case: Case) -> ReportPart:
    result = run(case)
    run_numbers = result.summary
    bad = run_numbers.status in ("failed", "not converged", "chaotic")
    of = f" of the {result.engine.words}" if result.engine and result.engine.words else ""
    speed = f"over the last period the speed{of} is {span(result.speed)}"
    if result.alone:
        each = ", that ".join(f"of {q} is {span(of_one)}" for q, of_one in run_numbers.speeds.items())
        speed = f"over the last {quantity_text(run_numbers.window, 's')} the speed {each}"
    numbers = some(run_numbers, tell(run_numbers).keys() - {"wall_s"})  # another each time
    end = f"{_ENDS.get(run_numbers.end, 'ended by ' + run_numbers.end)} in {figure(run_numbers.t_end, 3)} s"
    stall = tuple(text for text in result.findings if text.startswith("the shaft stops"))
    return ReportPart(
        name="simulate", title=PARTS["simulate"].title, view=result.view, state=INFEASIBLE if bad else DONE,
        reason=run_numbers.reason if bad else "", facts=result.findings, decide=stall, numbers=numbers,
        verdict=f"The run {end}" + (", the shaft stands." if stall else f"; {speed}."),
        silent=() if result.alone else _LOADED, doubts=result.doubts,
    )  # fmt: skip


class PartKind(NamedTuple):
    """A part that a report may have."""

    title: str
    made_of: Callable[[Case], ReportPart]
    first: tuple[str, ...] | None = None  # its cards on the first page, each also "of" something; None: all


PARTS: dict[str, PartKind] = {
    "cycle": PartKind("Engine cycle", _cycle, _FIRST),
    "hinge": PartKind("Hinge, guide and spring", _hinge),
    "forces": PartKind("Forces on bearings, pins and guides", _forces, ("crank pin", "main bearing", "friction")),
    "size": PartKind("Sizes and safety factors", _size, ("safety factors",)),
    "simulate": PartKind("Run in time", _simulate, ("mean speed", "run", "speed")),
}


def doubts_of(one: ReportPart) -> tuple[Doubt, ...]:
    """Doubts of a part: its own, and those that its numbers show."""
    return (*one.doubts, *results(tell(one.numbers) or {}))


@record
class FirstPage:
    """The first page of a case."""

    findings: tuple[Finding, ...]  #: What has to be known first, the worst first
    verdicts: tuple[tuple[str, str], ...]  #: Class and sentence
    cards: tuple[Card, ...]
    limits: tuple[str, ...]
    decide: tuple[str, ...]
    silent: tuple[str, ...]
    absent: tuple[str, ...]  #: Parts that are not in the report, and why
    accepted: tuple[str, ...]


def answer(case: Case, parts: Sequence[ReportPart]) -> FirstPage:
    """The first page of a case."""
    doubts, accepted = sifted(tuple(dict.fromkeys([*case.doubts, *(d for p in parts for d in doubts_of(p))])),
                              case.acceptances)  # fmt: skip
    notes = [f"{d.quantity} = {figure(d.value, 4)}, usual is {d.usual}: {d.why}" for d in doubts]
    computed = [p for p in parts if p.view is not None]
    return FirstPage(
        findings=ranked(one for p in parts for one in p.findings),
        verdicts=tuple(("" if p.state == DONE else "no", _verdict(p)) for p in sorted(
            (p for p in parts if p.state != LEFT_OUT), key=lambda p: not p.verdict.startswith(_GIVES))),
        cards=tuple(card for p in computed for card in _cards(p)),
        limits=tuple(text for p in computed for text in p.limits),
        decide=(*(text for p in computed for text in p.decide), *notes),
        silent=tuple(dict.fromkeys(text for p in computed for text in p.silent)),
        absent=tuple(f"{'; '.join(p.title for p in parts if p.state == LEFT_OUT and p.reason == why)}: {why}"
                     for why in dict.fromkeys(p.reason for p in parts if p.state == LEFT_OUT)),
        accepted=tuple(f"{d.quantity} = {figure(d.value, 4)}, usual is {d.usual}; accepted: "
                       f"{case.acceptances[d.code].why}" for d in accepted),
    )  # fmt: skip


def _verdict(part: ReportPart) -> str:
    if part.view is None:
        return f"{part.title} could not be computed: {part.reason}."
    missed = part.state == INFEASIBLE and part.reason and part.reason not in part.verdict
    return f"{part.verdict} Not met: {part.reason}." if missed else part.verdict


def _cards(part: ReportPart) -> tuple[Card, ...]:
    cards = part.view.cards if part.view is not None else ()
    first = PARTS[part.name].first
    return tuple(card for card in cards if first is None or {card.name, card.name.partition(" of ")[0]} & {*first})


def side_by_side(reports: Sequence[tuple[str, Sequence[ReportPart]]]) -> list[Json]:
    """Rows of a quantity and its value in each case, for the first page of several."""
    cards = [{(p.title, c.name): c.value for p in parts for c in _cards(p)} for _, parts in reports]
    keys = dict.fromkeys(key for shown in cards for key in shown)
    return [{"part": key[0], "name": key[1], "values": [shown.get(key, "–") for shown in cards]} for key in keys]

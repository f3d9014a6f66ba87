"""Forces in a report: what bears what once, friction, shaking, and what limits."""

import dataclasses
import math

from mechsym.cases import Case
from mechsym.forces.borne import borne
from mechsym.forces.result import Forces
from mechsym.forces.summary import half, summary
from mechsym.jobs.report.part import DONE, INFEASIBLE, ReportPart
from mechsym.jobs.vibration import vibration
from mechsym.page import Grid
from mechsym.plausible import Doubt
from mechsym.quantities.display import figure, quantity_text, shown_in
from mechsym.torsion import train

_LETTERS = {"p": "gas pressure p", "F": "gas force F", "F a": "gas force F_a", "F b": "gas force F_b"}


def force_part(title: str, case: Case, found: Forces, doubts: tuple[Doubt, ...]) -> ReportPart:
    """The part of a force analysis."""
    numbers, shaking = summary(found, case.name, case.source), vibration(case, found.turn)
    doubts += train.doubts(shaking) if shaking else ()
    facts = tuple(train.words(shaking)) if shaking else ()
    reasons = tuple(numbers["balance"]["reasons"])
    told = _friction(found)
    return ReportPart(
        name="forces", title=title, view=found.view, state=INFEASIBLE if reasons else DONE, reason="; ".join(reasons),
        verdict=f"{told}.", facts=(*numbers["facts"], *facts), grids=(_borne(numbers),),
        decide=reasons, doubts=doubts, silent=("rigid links at constant speed; friction of the first order",),
        numbers=numbers | {"vibration": None if shaking is None else dataclasses.asdict(shaking)},
    )  # fmt: skip


def _friction(found: Forces) -> str:
    if found.losses is None:
        return "Bearings and guides are without friction: the case has no [friction]"
    power, share = quantity_text(sum(found.losses.places.values()), "W", 4), found.losses.mechanical_efficiency
    told = "" if share is None else f", mechanical efficiency {figure(100 * share, 4)} %"
    of = " of one piston" if half(found) else ""
    return f"Friction of bearings and guides{of} takes {power}{told}"


def _borne(numbers: dict) -> Grid:
    rows = borne(numbers)
    several = any(row["of"] for row in rows)
    cells = [
        (_named(row), *([row["of"]] if several else []), *_extremes(row), row["on"])
        for row in rows
    ]  # fmt: skip
    headings = ("quantity", *(["of"] if several else []), "largest", "smallest", "on")
    right = tuple(name in ("largest", "smallest") for name in headings)
    return Grid(title="What bears what", headings=headings, rows=tuple(cells), numbers=right)


def _named(row: dict) -> str:
    """A load's name as people say it; which cylinders it is of stands beside it."""
    name = row["quantity"].replace("_", " ").replace("*", "").replace("  ", " ").strip()
    return _LETTERS.get(name, name)


def _extremes(row: dict) -> list[str]:
    """Largest and smallest in one unit, that of the larger."""
    values, unit = shown_in([row["max"], row["min"]], row["unit"])
    least = 10.0 ** (math.floor(math.log10(max(map(abs, values)) or 1.0)) - 4)  # a digit beyond the last of the larger
    told = [figure(round(value / least) * least, 4) for value in values]
    return [text if unit in ("", "-") else f"{text} {unit}" for text in told]

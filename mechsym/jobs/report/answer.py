"""The first page: what holds, the numbers a builder asks for, what limits, what is to be decided, what is not said."""

from collections.abc import Sequence
from typing import Any

from mechsym.cases import Case
from mechsym.jobs.report.part import DONE, INFEASIBLE, LEFT_OUT, ReportPart
from mechsym.jobs.report.parts import doubts_of
from mechsym.page import Card
from mechsym.plausible import sifted
from mechsym.quantities import record
from mechsym.quantities.display import figure

# cards of each part that belong on the first page; of the hinge all
_FIRST = {
    "cycle": ("speed", "power", "brake power", "mean torque", "peak pressure"),
    "forces": ("crank pin", "main bearing", "friction"),
    "size": ("safety factors",),
    "simulate": ("mean speed", "run"),
}


@record
class FirstPage:
    """The first page of a case."""

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
    told = [f"{d.quantity} = {figure(d.value, 4)}, usual is {d.usual}: {d.why}" for d in doubts]
    made = [p for p in parts if p.view is not None]
    return FirstPage(
        verdicts=tuple(("" if p.state == DONE else "no", _verdict(p)) for p in parts if p.state != LEFT_OUT),
        cards=tuple(card for p in made for card in _cards(p)),
        limits=tuple(text for p in made for text in p.limits),
        decide=(*(text for p in made for text in p.decide), *told),
        silent=tuple(dict.fromkeys(text for p in made for text in p.silent)),
        absent=tuple(f"{p.title}: {p.reason}" for p in parts if p.state == LEFT_OUT),
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
    return tuple(c for c in cards if part.name not in _FIRST or c.name in _FIRST[part.name])


def side_by_side(reports: Sequence[tuple[str, Sequence[ReportPart]]]) -> list[dict[str, Any]]:
    """Rows of a quantity and its value in each case, for the first page of several."""
    cards = [{(p.title, c.name): c.value for p in parts for c in _cards(p)} for _, parts in reports]
    keys = dict.fromkeys(key for found in cards for key in found)
    return [{"part": key[0], "name": key[1], "values": [found.get(key, "–") for found in cards]} for key in keys]

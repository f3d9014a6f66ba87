"""A case -> the parts of its report; reports of one or more cases -> one page."""

import hashlib
from collections.abc import Callable, Mapping, Sequence

import mechsym
from mechsym import cases
from mechsym.cases import Case
from mechsym.cases.facts import facts_of
from mechsym.cases.provenance import SourcedValue, sourced
from mechsym.files import Json, inputs
from mechsym.jobs.export import loaded, turning
from mechsym.jobs.measured import MeasuredDiagram
from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.record import listing
from mechsym.mechanisms.turning import rules
from mechsym.page import page, title_mark
from mechsym.quantities import record
from mechsym.report.part import INFEASIBLE, LEFT_OUT, REFUSED, ReportPart
from mechsym.report.parts import PARTS, answer, combustion_part, part, side_by_side
from mechsym.style import svg


@record
class CaseReport:
    """What a report says of one case."""

    case: Case
    parts: tuple[ReportPart, ...]
    values: tuple[SourcedValue, ...]  #: Every value with where it comes from
    digest: str  #: Of the case's text with what is overridden
    source: str  #: Whose engine it is, by name and year

    @property
    def infeasible(self) -> tuple[ReportPart, ...]:
        """Parts whose design does not hold."""
        return tuple(p for p in self.parts if p.state == INFEASIBLE)

    @property
    def refused(self) -> tuple[ReportPart, ...]:
        """Parts that bad input kept from being computed."""
        return tuple(p for p in self.parts if p.state == REFUSED)


_LONG = 4000  # letters of a formula that nobody reads on paper


def case_report(
    case: Case, names: Sequence[str] | None = None, source: str = "", progress: Callable[[], object] = lambda: None
) -> CaseReport:
    """The report of a case.

    names: parts that are wanted, of `PARTS`, all without a word; source: whose engine it is, by name and year.
    """
    parts = []
    with inputs.reads() as read:
        for name in PARTS if names is None else names:
            parts.append(part(name, case))
            progress()
    return CaseReport(
        case=case, parts=tuple(parts), values=tuple(sourced(case)), digest=digest(case, read), source=source
    )  # fmt: skip


def combustion_html(case: Case, diagram: MeasuredDiagram) -> str:
    """The page of a combustion analysis as text."""
    with inputs.reads() as read:
        values = tuple(sourced(case))
    seen = {"cycle", "parameters", "operation", "combustion", "measured"}
    one = CaseReport(
        case=case, parts=(combustion_part(diagram),),
        values=tuple(v for v in values if v.key.partition(".")[0] in seen),
        digest=digest(case, read), source="",
    )  # fmt: skip
    return html([one])


def digest(case: Case, read: Mapping[str, str]) -> str:
    """Twelve hex digits that change with every value of a case, and with what was in the files `read` for it."""
    lines = [cases.text(case.path), *(f"{key}={value}" for key, value in sorted(case.overrides.items()))]
    lines += sorted(content for name, content in read.items() if name != case.path)
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:12]


def html(reports: Sequence[CaseReport], date: str = "") -> str:
    """The page as text; the same reports give the same page.

    date: printed in the title block; without one `[report] date`, or none.
    """
    shown, number = [], 0
    for place, one in enumerate(reports, 1):
        parts, said, scenes = [], list[str](), _turning(one)
        seen = {"mechanism", "elastic_hinge"} if scenes else set()  # they turn at the head
        # the diagram of the gas once, with its events where it has them
        shown_of = (p for made in one.parts if made.view for p in made.view.pictures)
        of_gas = dict(zip(("indicator",), (p for p in shown_of if p.name == "pressure"), strict=False))
        for section in one.parts:
            if section.state in (LEFT_OUT, REFUSED) or section.view is None:
                continue
            figures = []
            for picture in (of_gas.get(drawn.name, drawn) for drawn in section.view.pictures if drawn.name not in seen):
                number, seen = number + 1, seen | {picture.name}
                drawn = picture.draw()
                width, height = drawn.get_size_inches()
                high, one_panel = height > 0.75 * width, len(drawn.axes) == 1
                shape = "narrow" if high and one_panel else "tall" if high else ""
                figures.append({"number": number, "see": picture.see, "svg": svg(drawn, str(number)), "shape": shape})
            facts = [fact for fact in section.facts if fact not in said]
            said += facts
            parts.append({"part": section, "facts": facts, "figures": figures, "id": f"{section.name}-{place}"})
        first = answer(one.case, one.parts)
        derived = listing(plan_of(one.case.mechanism).theory).get("equations", ())
        equations = [row for row in derived if len(row["mathml"]) < _LONG]
        shown.append({"report": one, "scenes": scenes, "answer": first, "parts": parts, "equations": equations,
                      "id": f"case-{place}", "called": called(one.case)})  # fmt: skip
    return page(
        "report.html", shown=shown, rows=side_by_side([(r.case.name, r.parts) for r in reports]), title=_title(reports),
        block=[_block(one, date) for one in reports], many=len(reports) > 1,
        rules=rules(), mark=title_mark([finding for one in reports for part in one.parts for finding in part.findings]),
    )  # fmt: skip


def _turning(one: CaseReport) -> list[Json]:
    """What turns at the head of a report: the engine with its hinge, or the machine alone, and what presses in it."""
    of_parts = next((scenes for section in one.parts if (scenes := section.turning())), None)
    return loaded(of_parts, one.case) if of_parts else turning(one.case)


def _title(reports: Sequence[CaseReport]) -> str:
    return " and ".join(_engine(one.case) for one in reports)


def _engine(case: Case) -> str:
    wanted = case.sections.get("report")
    return getattr(wanted, "engine", "") or case.name


def called(case: Case) -> str:
    """Engine or machine."""
    return facts_of(case.mechanism, case.sections).called


def _block(one: CaseReport, date: str) -> dict[str, str]:
    wanted = one.case.sections.get("report")
    overrides = ", ".join(f"{key} = {value}" for key, value in one.case.overrides.items())
    rows = {
        "project": getattr(wanted, "project", ""),
        called(one.case): f"{_engine(one.case)}: {one.case.about}" if one.case.about else _engine(one.case),
        "data from": one.source,
        "changed for this report": overrides,
        "prepared by": getattr(wanted, "author", ""),
        "date": date or getattr(wanted, "date", ""),
        "made with": f"mechsym {mechsym.__version__}",
        "case": f"{one.case.name}, sha256 {one.digest}",
    }
    return {key: value for key, value in rows.items() if value}


__all__ = ["CaseReport", "case_report", "digest", "html"]
